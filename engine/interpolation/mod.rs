//! Smooth motion between steps, by `bevy_transform_interpolation`.

#[cfg_attr(feature = "2d", path = "dim2.rs")]
#[cfg_attr(feature = "3d", path = "dim3.rs")]
mod dim;
mod drawn;
mod velocity;

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
    schedule::{ConditionWithAccess, ScheduleLabel, SystemKey},
};
use bevy_platform::collections::HashSet;
use bevy_time::{Fixed, Time};
use bevy_transform_interpolation::{
    RotationEasingState, ScaleEasingState, TransformEasingPlugin, TranslationEasingState,
    extrapolation::TransformExtrapolationPlugin, hermite::TransformHermiteEasingPlugin,
    interpolation::TransformInterpolationPlugin,
};

use self::velocity::{AngVelSource, LinVelSource};
use crate::dynamics::rigid_body::RigidBody;

/// Eases the transforms of rigid bodies between steps, if physics runs in a fixed schedule and frames are
/// drawn more often.
///
/// *Interpolation* draws bodies between the poses of the last two steps: smooth and correct, but one step
/// late. *Extrapolation* draws them ahead of the last step, by their velocity: without delay, but they jump
/// at collisions. Both are off unless an entity has [`TransformInterpolation`] or [`TransformExtrapolation`],
/// or a constructor of this plugin enables them for all bodies. [`NoTransformEasing`] and its siblings
/// exclude an entity. [`TransformHermiteEasing`] uses velocities as well as positions.
///
/// Apps may write to the `Transform` of an eased body in any schedule. Writing `z` in 2D, or the scale, moves
/// no body. Writing the rotation or a spatial axis sets only this part of the pose; the write does not affect
/// the other parts.
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
    /// Eases only entities with an easing component. The default, as a constant.
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
        // Easing reads the time since the last fixed tick. Apps without `TimePlugin` do not have this clock.
        app.init_resource::<Time<Fixed>>();
        skip_while_nothing_eases(app, |app| {
            app.add_plugins((
                TransformInterpolationPlugin::default(),
                TransformExtrapolationPlugin::<LinVelSource, AngVelSource>::default(),
                TransformHermiteEasingPlugin::<LinVelSource, AngVelSource>::default(),
            ));
            velocity::add_systems(app);
        });

        // Registration fails only if the requirement exists already.
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
    }

    fn finish(&self, app: &mut App) {
        // Otherwise the plugins above would add it, without the run condition.
        let mut easing = Vec::new();
        if !app.is_plugin_added::<TransformEasingPlugin>() {
            easing = skip_while_nothing_eases(app, |app| {
                app.add_plugins(TransformEasingPlugin);
            });
        }
        skip_while_nothing_eases(app, |app| drawn::add_systems(app, &easing));
    }
}

/// Adds systems that are skipped while no entity is eased. Scheduling two dozen systems would be most of the
/// cost of an empty world. Returns the systems in [`RunFixedMainLoop`].
fn skip_while_nothing_eases(app: &mut App, add_systems: impl FnOnce(&mut App)) -> Vec<SystemKey> {
    let eased = [FixedFirst.intern(), FixedLast.intern(), RunFixedMainLoop.intern()];
    let keys = |app: &App| {
        let systems = |schedule: &Schedule| schedule.graph().systems.iter().map(|(key, ..)| key).collect();
        eased.map(|label| app.get_schedule(label).map_or_else(HashSet::<SystemKey>::default, systems))
    };
    let before = keys(app);
    add_systems(app);
    let after = keys(app);
    let mut added = Vec::new();
    for ((label, before), after) in eased.into_iter().zip(before).zip(after) {
        added = after.difference(&before).copied().collect();
        app.edit_schedule(label, |schedule| {
            for key in &added {
                if let Some(conditions) = schedule.graph_mut().systems.get_conditions_mut(*key) {
                    let condition = IntoSystem::into_system(anything_eases);
                    conditions.push(ConditionWithAccess::new(Box::new(condition)));
                }
            }
        });
    }
    added
}

fn anything_eases(
    eased: Query<(), Or<(With<TranslationEasingState>, With<RotationEasingState>, With<ScaleEasingState>)>>,
) -> bool {
    !eased.is_empty()
}
