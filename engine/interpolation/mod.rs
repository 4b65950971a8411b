//! Smooth motion between steps: transforms are eased from one step to the next, or ahead of the last, by `bevy_transform_interpolation`.

#[cfg_attr(feature = "2d", path = "dim2.rs")]
#[cfg_attr(feature = "3d", path = "dim3.rs")]
mod dim;

#[expect(deprecated, reason = "former names stay importable")]
pub use bevy_transform_interpolation::TransformEasingSet;
pub use bevy_transform_interpolation::{
    TransformEasingSystems,
    prelude::{
        NoRotationEasing, NoScaleEasing, NoTransformEasing, NoTranslationEasing, RotationExtrapolation,
        RotationHermiteEasing, RotationInterpolation, ScaleInterpolation, TransformExtrapolation,
        TransformHermiteEasing, TransformInterpolation, TranslationExtrapolation, TranslationHermiteEasing,
        TranslationInterpolation,
    },
};

use bevy_app::{App, FixedFirst, FixedLast, Plugin, RunFixedMainLoop};
use bevy_ecs::{
    prelude::*,
    query::QueryData,
    schedule::{ConditionWithAccess, ScheduleLabel, SystemKey},
};
use bevy_math::Vec3;
use bevy_platform::collections::HashSet;
use bevy_time::{Fixed, Time};
use bevy_transform_interpolation::{
    RotationEasingState, ScaleEasingState, TransformEasingPlugin, TranslationEasingState, VelocitySource,
    extrapolation::TransformExtrapolationPlugin, hermite::TransformHermiteEasingPlugin,
    interpolation::TransformInterpolationPlugin,
};

use crate::dynamics::rigid_body::{AngularVelocity, LinearVelocity, RigidBody};

/// Eases the transforms of rigid bodies between steps, where physics runs in a fixed schedule and frames are drawn more often.
///
/// *Interpolation* draws bodies on their way from the step before to the last: smooth and correct, one step late. *Extrapolation* draws them
/// on their way beyond the last, by their velocity: no delay, but they jump where they hit something. Both are off unless an entity has
/// [`TransformInterpolation`] or [`TransformExtrapolation`], or a constructor of this plugin switches them on for all bodies;
/// [`NoTransformEasing`] and its kin then except an entity. [`TransformHermiteEasing`] follows the velocity as well as the positions.
///
/// ```
/// # use avian::prelude::*;
/// # use bevy_app::prelude::*;
/// # use bevy_transform::TransformPlugin;
/// App::new().add_plugins((
///     TransformPlugin,
///     PhysicsPlugins::default().build().set(PhysicsInterpolationPlugin::interpolate_all()),
/// ));
/// ```
#[derive(Debug, Default)]
pub struct PhysicsInterpolationPlugin {
    interpolate_translation: bool,
    interpolate_rotation: bool,
    extrapolate_translation: bool,
    extrapolate_rotation: bool,
}

impl PhysicsInterpolationPlugin {
    /// Nothing eased but what asks for it; `Default`, as a constant to build on.
    const NONE: Self = Self {
        interpolate_translation: false,
        interpolate_rotation: false,
        extrapolate_translation: false,
        extrapolate_rotation: false,
    };

    /// Interpolates translation and rotation of all rigid bodies.
    pub const fn interpolate_all() -> Self {
        Self { interpolate_translation: true, interpolate_rotation: true, ..Self::NONE }
    }

    /// Interpolates the translation of all rigid bodies.
    pub const fn interpolate_translation_all() -> Self {
        Self { interpolate_translation: true, ..Self::NONE }
    }

    /// Interpolates the rotation of all rigid bodies.
    pub const fn interpolate_rotation_all() -> Self {
        Self { interpolate_rotation: true, ..Self::NONE }
    }

    /// Extrapolates translation and rotation of all rigid bodies.
    pub const fn extrapolate_all() -> Self {
        Self { extrapolate_translation: true, extrapolate_rotation: true, ..Self::NONE }
    }

    /// Extrapolates the translation of all rigid bodies.
    pub const fn extrapolate_translation_all() -> Self {
        Self { extrapolate_translation: true, ..Self::NONE }
    }

    /// Extrapolates the rotation of all rigid bodies.
    pub const fn extrapolate_rotation_all() -> Self {
        Self { extrapolate_rotation: true, ..Self::NONE }
    }
}

impl Plugin for PhysicsInterpolationPlugin {
    fn build(&self, app: &mut App) {
        // Easing reads how far the frame is past the last fixed tick; apps without `TimePlugin` have no such clock.
        app.init_resource::<Time<Fixed>>();
        skip_while_nothing_eases(app, |app| {
            app.add_plugins((
                TransformInterpolationPlugin::default(),
                TransformExtrapolationPlugin::<LinVelSource, AngVelSource>::default(),
                TransformHermiteEasingPlugin::<LinVelSource, AngVelSource>::default(),
            ))
            .add_systems(FixedFirst, store_previous_velocities.in_set(TransformEasingSystems::UpdateStart));
        });

        // Registering a requirement twice is the one error, and then there is nothing left to do.
        if self.interpolate_translation {
            let _ = app.try_register_required_components::<RigidBody, TranslationInterpolation>();
        }
        if self.interpolate_rotation {
            let _ = app.try_register_required_components::<RigidBody, RotationInterpolation>();
        }
        if self.extrapolate_translation {
            let _ = app.try_register_required_components::<RigidBody, TranslationExtrapolation>();
        }
        if self.extrapolate_rotation {
            let _ = app.try_register_required_components::<RigidBody, RotationExtrapolation>();
        }
        let _ = app.try_register_required_components::<TranslationHermiteEasing, PreviousLinearVelocity>();
        let _ = app.try_register_required_components::<RotationHermiteEasing, PreviousAngularVelocity>();
    }

    fn finish(&self, app: &mut App) {
        // The plugins above would add it next, without the condition.
        if !app.is_plugin_added::<TransformEasingPlugin>() {
            skip_while_nothing_eases(app, |app| {
                app.add_plugins(TransformEasingPlugin);
            });
        }
    }
}

/// Adds systems that are left out of a frame as long as no entity is eased: handing two dozen of them from thread to
/// thread would be most of what physics costs an empty world.
fn skip_while_nothing_eases(app: &mut App, add_systems: impl FnOnce(&mut App)) {
    let eased = [FixedFirst.intern(), FixedLast.intern(), RunFixedMainLoop.intern()];
    let keys = |app: &App| {
        let systems = |schedule: &Schedule| schedule.graph().systems.iter().map(|(key, ..)| key).collect();
        eased.map(|label| app.get_schedule(label).map_or_else(HashSet::<SystemKey>::default, systems))
    };
    let before = keys(app);
    add_systems(app);
    let after = keys(app);
    for ((label, before), after) in eased.into_iter().zip(before).zip(after) {
        app.edit_schedule(label, |schedule| {
            for key in after.difference(&before) {
                if let Some(conditions) = schedule.graph_mut().systems.get_conditions_mut(*key) {
                    let condition = IntoSystem::into_system(anything_eases);
                    conditions.push(ConditionWithAccess::new(Box::new(condition)));
                }
            }
        });
    }
}

fn anything_eases(
    eased: Query<(), Or<(With<TranslationEasingState>, With<RotationEasingState>, With<ScaleEasingState>)>>,
) -> bool {
    !eased.is_empty()
}

/// The linear velocity at the start of the fixed tick, where Hermite easing starts from.
#[derive(Component, Default)]
struct PreviousLinearVelocity(LinearVelocity);

/// The angular velocity at the start of the fixed tick, where Hermite easing starts from.
#[derive(Component, Default)]
struct PreviousAngularVelocity(AngularVelocity);

fn store_previous_velocities(
    mut linear: Query<(&LinearVelocity, &mut PreviousLinearVelocity)>,
    mut angular: Query<(&AngularVelocity, &mut PreviousAngularVelocity)>,
) {
    for (current, mut previous) in &mut linear {
        previous.0 = *current;
    }
    for (current, mut previous) in &mut angular {
        previous.0 = *current;
    }
}

/// Where easing finds linear velocities, in the three dimensions of `Transform`.
#[derive(QueryData)]
struct LinVelSource;

impl VelocitySource for LinVelSource {
    type Previous = PreviousLinearVelocity;
    type Current = LinearVelocity;

    fn previous(start: &Self::Previous) -> Vec3 {
        dim::linear_vec3(start.0)
    }

    fn current(end: &Self::Current) -> Vec3 {
        dim::linear_vec3(*end)
    }
}

/// Where easing finds angular velocities, in the three dimensions of `Transform`.
#[derive(QueryData)]
struct AngVelSource;

impl VelocitySource for AngVelSource {
    type Previous = PreviousAngularVelocity;
    type Current = AngularVelocity;

    fn previous(start: &Self::Previous) -> Vec3 {
        dim::angular_vec3(start.0)
    }

    fn current(end: &Self::Current) -> Vec3 {
        dim::angular_vec3(*end)
    }
}
