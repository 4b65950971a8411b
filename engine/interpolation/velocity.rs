//! Velocities for extrapolation and Hermite easing, in the space of `Transform`: relative to the parent.

use bevy_app::{App, FixedFirst, FixedLast};
use bevy_ecs::{prelude::*, query::QueryData, system::SystemParam};
use bevy_math::{DVec3, Vec3};
use bevy_time::{Fixed, Time};
use bevy_transform::components::Transform;
use bevy_transform_interpolation::{
    NoRotationEasing, NoTranslationEasing, RotationEasingState, TransformEasingSystems,
    TranslationEasingState, VelocitySource,
    hermite::{RotationHermiteEasing, TranslationHermiteEasing},
    prelude::{RotationExtrapolation, TranslationExtrapolation},
};

use super::dim;
use crate::{
    dynamics::rigid_body::{AngularVelocity, LinearVelocity, RigidBody},
    physics_transform::{frame::Frame, sync::parent_frame, tree::Parents},
    schedule::Physics,
};

/// Linear velocity relative to the parent, at the start of the tick or at its end.
#[derive(Component, Default)]
pub(super) struct LocalLinear<const END: bool>(Vec3);

/// Angular velocity relative to the parent, at the start of the tick or at its end.
#[derive(Component, Default)]
pub(super) struct LocalAngular<const END: bool>(Vec3);

/// Adds the systems that store the velocities.
pub(super) fn add_systems(app: &mut App) {
    // Registration fails only if the requirement exists already.
    let _ = app.try_register_required_components::<TranslationExtrapolation, LocalLinear<true>>();
    let _ = app.try_register_required_components::<RotationExtrapolation, LocalAngular<true>>();
    let _ = app.try_register_required_components::<TranslationHermiteEasing, LocalLinear<false>>();
    let _ = app.try_register_required_components::<TranslationHermiteEasing, LocalLinear<true>>();
    let _ = app.try_register_required_components::<RotationHermiteEasing, LocalAngular<false>>();
    let _ = app.try_register_required_components::<RotationHermiteEasing, LocalAngular<true>>();
    app.add_systems(FixedFirst, store_velocities::<false>.in_set(TransformEasingSystems::UpdateStart))
        .add_systems(FixedLast, store_velocities::<true>.before(TransformEasingSystems::UpdateEnd));
}

/// Queries for the motion of parents.
#[derive(SystemParam)]
struct Above<'w, 's> {
    parents: Parents<'w, 's>,
    transforms: Query<'w, 's, &'static Transform>,
    bodies: Query<'w, 's, (), With<RigidBody>>,
    moving:
        Query<'w, 's, &'static LinearVelocity, (With<TranslationEasingState>, Without<NoTranslationEasing>)>,
    turning: Query<'w, 's, &'static AngularVelocity, (With<RotationEasingState>, Without<NoRotationEasing>)>,
}

impl Above<'_, '_> {
    fn parent(&self, entity: Entity) -> Option<Frame> {
        parent_frame(entity, &self.parents, |at| self.transforms.get(at).ok().copied())
    }

    fn origin(&self, entity: Entity) -> DVec3 {
        let Ok(transform) = self.transforms.get(entity) else { return DVec3::ZERO };
        self.parent(entity).unwrap_or(Frame::IDENTITY).child(transform).translation().into()
    }

    /// The nearest body above an entity. Parents of a body do not move it.
    fn body(&self, entity: Entity) -> Option<Entity> {
        self.parents.iter_ancestors(entity).find(|&above| self.bodies.contains(above))
    }

    /// A linear velocity in the parent's frame, relative to the nearest body above if that body is also
    /// eased.
    fn linear(&self, entity: Entity, velocity: Vec3) -> Vec3 {
        let Some(parent) = self.parent(entity) else { return velocity };
        let mut relative = velocity.as_dvec3();
        if let Some(body) = self.body(entity) {
            if let Ok(above) = self.moving.get(body) {
                relative -= dim::linear_vec3(*above).as_dvec3();
            }
            if let Ok(above) = self.turning.get(body) {
                let arm = self.origin(entity) - self.origin(body);
                relative -= dim::angular_vec3(*above).as_dvec3().cross(arm);
            }
        }
        parent.local_vector(relative.into()).map_or(Vec3::ZERO, |local| DVec3::from(local).as_vec3())
    }

    /// An angular velocity in the parent's frame, relative to the nearest body above if that body is also
    /// eased.
    fn angular(&self, entity: Entity, velocity: Vec3) -> Vec3 {
        let Some(parent) = self.parent(entity) else { return velocity };
        let above = self.body(entity).and_then(|body| self.turning.get(body).ok());
        let relative = velocity - above.map_or(Vec3::ZERO, |above| dim::angular_vec3(*above));
        let local = parent.local_spin(relative.as_dvec3().into());
        local.map_or(Vec3::ZERO, |local| DVec3::from(local).as_vec3())
    }
}

/// Stores the velocities by the tick clock: zero while physics is paused, and smaller in slow motion.
fn store_velocities<const END: bool>(
    mut linear: Query<(Entity, &LinearVelocity, &mut LocalLinear<END>)>,
    mut angular: Query<(Entity, &AngularVelocity, &mut LocalAngular<END>)>,
    above: Above,
    physics: Option<Res<Time<Physics>>>,
    ticks: Res<Time<Fixed>>,
) {
    let pace = physics.map_or(1.0, |physics| physics.delta_secs() / ticks.timestep().as_secs_f32());
    for (entity, velocity, mut local) in &mut linear {
        local.0 = above.linear(entity, dim::linear_vec3(*velocity)) * pace;
    }
    for (entity, velocity, mut local) in &mut angular {
        local.0 = above.angular(entity, dim::angular_vec3(*velocity)) * pace;
    }
}

/// Linear velocities for easing.
#[derive(QueryData)]
pub(super) struct LinVelSource;

impl VelocitySource for LinVelSource {
    type Previous = LocalLinear<false>;
    type Current = LocalLinear<true>;

    fn previous(start: &Self::Previous) -> Vec3 {
        start.0
    }

    fn current(end: &Self::Current) -> Vec3 {
        end.0
    }
}

/// Angular velocities for easing.
#[derive(QueryData)]
pub(super) struct AngVelSource;

impl VelocitySource for AngVelSource {
    type Previous = LocalAngular<false>;
    type Current = LocalAngular<true>;

    fn previous(start: &Self::Previous) -> Vec3 {
        start.0
    }

    fn current(end: &Self::Current) -> Vec3 {
        end.0
    }
}
