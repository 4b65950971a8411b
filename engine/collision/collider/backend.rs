//! The plugin that makes a component type a collider of the engine.

use super::{
    AnyCollider, ColliderAabb, ColliderMarker, CollisionLayers, EnlargedAabb, ScalableCollider, Sensor,
    collider_hierarchy::ColliderOf,
    collider_transform::UpdateColliderTransforms,
    custom::{is_custom, watch_shapes},
    scale::{TransformScale, scale_is_followed, update_collider_scale},
};
use crate::dynamics::ids::ColliderId;
use crate::dynamics::rigid_body::mass_properties::{
    MassPropertyQueue, MassPropertySystems,
    components::{ColliderDensity, ColliderMassProperties},
};
use crate::physics_transform::{PhysicsTransformSystems, tree::FollowsBody};
use crate::scan::Since;
use crate::schedule::OnThisThread;
use bevy_app::{App, FixedPostUpdate, Plugin};
use bevy_ecs::change_detection::{DetectChanges, DetectChangesMut};
use bevy_ecs::entity_disabling::Disabled;
use bevy_ecs::intern::Interned;
use bevy_ecs::prelude::{
    Add, Allow, Commands, Discard, Entity, EntityRef, In, IntoScheduleConfigs, On, ParamSet, Query, Ref,
    Remove, With, Without, World,
};
use bevy_ecs::schedule::ScheduleLabel;
use bevy_ecs::system::{SystemChangeTick, SystemParam};
use core::marker::PhantomData;

/// Makes components of type `C` colliders: adds the components that every collider has, applies the scale of
/// transforms to colliders, and updates mass properties.
///
/// The plugin for [`Collider`](super::Collider) is part of `PhysicsPlugins`. Add one for each custom collider
/// type.
pub struct ColliderBackendPlugin<C: ScalableCollider> {
    schedule: Interned<dyn ScheduleLabel>,
    _collider: PhantomData<C>,
}

impl<C: ScalableCollider> ColliderBackendPlugin<C> {
    /// Runs the systems in `schedule`, the schedule in which physics runs.
    pub fn new(schedule: impl ScheduleLabel) -> Self {
        Self { schedule: schedule.intern(), _collider: PhantomData }
    }
}

impl<C: ScalableCollider> Default for ColliderBackendPlugin<C> {
    /// Runs in `FixedPostUpdate`.
    fn default() -> Self {
        Self::new(FixedPostUpdate)
    }
}

impl<C: ScalableCollider> Plugin for ColliderBackendPlugin<C> {
    fn build(&self, app: &mut App) {
        // Registration fails only if `C` already requires the component. That requirement then stays.
        let _ = app.try_register_required_components::<C, ColliderMarker>();
        let _ = app.try_register_required_components::<C, ColliderAabb>();
        let _ = app.try_register_required_components::<C, CollisionLayers>();
        let _ = app.try_register_required_components::<C, EnlargedAabb>();
        let _ = app.try_register_required_components::<C, ColliderDensity>();
        let _ = app.try_register_required_components::<C, ColliderMassProperties>();
        let _ = app.try_register_required_components::<C, ColliderId>();

        if is_custom::<C>() {
            watch_shapes::<C>(app);
        }
        app.add_observer(enter_added::<C>)
            .add_observer(enter_replaced::<C>)
            .add_observer(weigh_former_sensor::<C>)
            .add_observer(strip::<C>)
            .add_systems(
                self.schedule,
                (
                    update_collider_scale::<C>
                        .run_if(scale_is_followed)
                        .in_set(PhysicsTransformSystems::TransformToPosition)
                        .after(UpdateColliderTransforms)
                        .before(MassPropertySystems::UpdateColliderMassProperties),
                    update_collider_mass_properties::<C>
                        .in_set(MassPropertySystems::UpdateColliderMassProperties),
                ),
            );
    }
}

/// Computes mass properties of colliders, and queues their bodies to be recomputed.
#[derive(SystemParam)]
pub struct Weigher<'w, 's, C: AnyCollider> {
    colliders: Query<
        'w,
        's,
        (&'static C, &'static ColliderDensity, &'static mut ColliderMassProperties),
        Allow<Disabled>,
    >,
    queue: MassPropertyQueue<'w, 's>,
}

impl<C: AnyCollider> Weigher<'_, '_, C> {
    /// Recomputes the mass of a collider, and the mass of its body when the command ends.
    fn weigh(&mut self, entity: Entity) {
        if self.update(entity) {
            self.queue.push(entity);
        }
    }

    /// Recomputes the mass of a collider. Returns whether it changed.
    fn update(&mut self, entity: Entity) -> bool {
        let Ok((collider, density, mut properties)) = self.colliders.get_mut(entity) else { return false };
        // A NaN or negative density counts as 0. It would reach the solver through sums.
        let density = if density.0.is_finite() && density.0 > 0.0 { density.0 } else { 0.0 };
        properties.set_if_neq(ColliderMassProperties::from_shape(collider, density))
    }
}

/// Gives a new collider the scale of its transform, and then computes its mass.
#[derive(SystemParam)]
pub struct Entrance<'w, 's, C: ScalableCollider> {
    scale: TransformScale<'w, 's>,
    sensors: Query<'w, 's, (), (With<Sensor>, Allow<Disabled>)>,
    queries: ParamSet<'w, 's, (Query<'w, 's, &'static mut C, Allow<Disabled>>, Weigher<'w, 's, C>)>,
}

impl<C: ScalableCollider> Entrance<'_, '_, C> {
    fn enter(&mut self, entity: Entity) {
        if let Ok(collider) = self.queries.p0().get_mut(entity) {
            self.scale.apply_to(entity, collider);
        }
        if !self.sensors.contains(entity) {
            self.queries.p1().weigh(entity);
        }
    }
}

/// Computes scale and mass of a new collider before the mass of its body. Observers of insertion run after
/// all observers of addition.
fn enter_added<C: ScalableCollider>(added: On<Add, C>, mut entrance: Entrance<C>) {
    entrance.enter(added.entity);
}

/// Computes scale and mass of a collider after its shape or density was replaced.
fn enter_replaced<C: ScalableCollider>(replaced: On<Discard, (C, ColliderDensity)>, mut commands: Commands) {
    let entity = replaced.entity;
    commands.queue(move |world: &mut World| {
        let is_collider = |entity: EntityRef| entity.contains::<C>() && entity.contains::<ColliderDensity>();
        if world.get_entity(entity).is_ok_and(is_collider) {
            let enter = |In(entity): In<Entity>, mut entrance: Entrance<C>| entrance.enter(entity);
            let entered = world.run_system_cached_with(enter, entity);
            debug_assert!(entered.is_ok(), "the parameters are there");
        }
    });
}

/// Removes the components that the engine added to a collider, and then recomputes the body's mass. Commands
/// run in the order of the parameters.
fn strip<C: AnyCollider>(removed: On<Remove, C>, mut commands: Commands, mut queue: MassPropertyQueue) {
    let former = removed.entity;
    queue.push(former);
    commands.queue(move |world: &mut World| {
        if let Ok(mut entity) = world.get_entity_mut(former)
            && !entity.contains::<C>()
        {
            entity.remove::<(ColliderOf, FollowsBody)>();
            let Ok(mut entity) = world.get_entity_mut(former) else { return };
            entity.remove::<(ColliderMarker, ColliderAabb, EnlargedAabb, ColliderMassProperties)>();
        }
    });
}

/// Computes the mass of a collider that is no longer a sensor.
fn weigh_former_sensor<C: AnyCollider>(former: On<Remove, Sensor>, mut weigher: Weigher<C>) {
    weigher.weigh(former.entity);
}

/// Recomputes [`ColliderMassProperties`] after the collider or its density was mutated, except for sensors.
pub fn update_collider_mass_properties<C: AnyCollider>(
    all: Query<(Entity, Ref<C>, Ref<ColliderDensity>), Without<Sensor>>,
    mut weigher: Weigher<C>,
    system: SystemChangeTick,
    _: OnThisThread,
) {
    let mut changed: Vec<Entity> = Vec::new();
    let since = Since::last_run(system);
    if let Ok(tables) = all.contiguous_iter() {
        for (entities, shape, density) in tables {
            let columns = [shape.changed_ticks_slice(), density.changed_ticks_slice()];
            since.rows(columns, |row| changed.push(entities[row]));
        }
    } else {
        // `C` has sparse-set storage.
        let is_new = |(_, shape, density): &(Entity, Ref<C>, Ref<ColliderDensity>)| {
            shape.is_changed() || density.is_changed()
        };
        changed.extend(all.iter().filter(is_new).map(|(entity, ..)| entity));
    }
    for entity in changed {
        if weigher.update(entity) {
            weigher.queue.mark(entity);
        }
    }
}

#[cfg(all(test, feature = "default-collider"))]
mod tests {
    use super::*;
    use crate::collision::collider::Collider;
    use bevy_app::Update;

    fn mass(app: &App, entity: Entity) -> f32 {
        app.world().get::<ColliderMassProperties>(entity).map_or(f32::NAN, |p| p.mass)
    }

    #[test]
    fn mass_follows_shape_density_and_sensors() {
        let mut app = App::new();
        app.add_plugins(ColliderBackendPlugin::<Collider>::new(Update));
        let plain = app.world_mut().spawn(Collider::capsule(0.5, 1.0)).id();
        let sensor = app.world_mut().spawn((Collider::capsule(0.5, 1.0), Sensor)).id();
        app.update();
        let unit = mass(&app, plain);
        assert!(unit > 0.5 && mass(&app, sensor) == 0.0);
        assert!(app.world().get::<ColliderMarker>(plain).is_some());

        app.world_mut().entity_mut(plain).insert(ColliderDensity(3.0));
        app.world_mut().entity_mut(sensor).remove::<Sensor>();
        app.update();
        assert!((mass(&app, plain) - 3.0 * unit).abs() < 1.0e-4);
        assert_eq!(mass(&app, sensor), unit);

        for bad in [-1.0, f32::NAN, f32::INFINITY] {
            app.world_mut().entity_mut(plain).insert(ColliderDensity(bad));
            app.update();
            assert_eq!(mass(&app, plain), 0.0);
        }
        app.world_mut().entity_mut(plain).insert((Collider::default(), ColliderDensity(1.0)));
        app.update();
        assert_eq!(mass(&app, plain), crate::math::ComputeMassProperties::mass(&Collider::default(), 1.0));
    }
}
