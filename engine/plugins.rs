//! [`PhysicsPlugins`]: all plugins of the engine, in the order in which they are added.

use bevy_app::{FixedPostUpdate, PluginGroup, PluginGroupBuilder};
use bevy_ecs::{intern::Interned, schedule::ScheduleLabel, system::SystemParamItem};
use core::marker::PhantomData;

#[cfg(feature = "default-collider")]
use crate::{
    collider_tree::ColliderTreePlugin,
    collision::{
        collider::{Collider, ColliderBackendPlugin, ColliderConstructorPlugin},
        narrow_phase::NarrowPhasePlugin,
    },
};
use crate::{
    collision::{
        broad_phase::{BroadPhaseCorePlugin, BvhBroadPhasePlugin},
        collider::{
            collider_hierarchy::ColliderHierarchyPlugin, collider_transform::ColliderTransformPlugin,
        },
        hooks::CollisionHooks,
    },
    dynamics::{
        joints::JointPlugin,
        rigid_body::{forces::ForcePlugin, mass_properties::MassPropertyPlugin},
        solver::SolverPlugins,
    },
    interpolation::PhysicsInterpolationPlugin,
    math::Scalar,
    physics_transform::PhysicsTransformPlugin,
    schedule::PhysicsSchedulePlugin,
    spatial_query::SpatialQueryPlugin,
    type_registration::PhysicsTypeRegistrationPlugin,
};

/// All plugins of the engine.
///
/// | Plugin | Gives |
/// | --- | --- |
/// | [`PhysicsSchedulePlugin`] | the schedule of a step, its clocks, and the system that takes it |
/// | [`PhysicsTypeRegistrationPlugin`] | reflection of components and resources |
/// | [`MassPropertyPlugin`] | mass, inertia and centre of mass from colliders |
/// | [`ForcePlugin`] | forces, torques and accelerations |
/// | [`ColliderHierarchyPlugin`] | which colliders belong to which body |
/// | [`ColliderTransformPlugin`] | where they are on it |
/// | `ColliderCachePlugin` | colliders shared by entities with the same mesh |
/// | [`ColliderConstructorPlugin`](crate::collision::collider::ColliderConstructorPlugin) | colliders from `ColliderConstructor`s |
/// | [`ColliderBackendPlugin`](crate::collision::collider::ColliderBackendPlugin) | boxes, scale and mass of `Collider`s |
/// | [`ColliderTreePlugin`](crate::collider_tree::ColliderTreePlugin) | the trees over them |
/// | [`NarrowPhasePlugin`](crate::collision::narrow_phase::NarrowPhasePlugin) | contacts between them |
/// | [`SolverPlugins`] | motion, contact response, sleep |
/// | [`BroadPhaseCorePlugin`], [`BvhBroadPhasePlugin`] | pairs that might touch |
/// | [`JointPlugin`] | joints |
/// | `CharacterControllerPlugin` | characters that walk |
/// | [`SpatialQueryPlugin`] | ray casters and shape casters |
/// | [`PhysicsTransformPlugin`] | `Transform` to `Position` and `Rotation`, and back |
/// | [`PhysicsInterpolationPlugin`] | smooth transforms between steps, for those who ask |
///
/// Plugins for `Collider` need feature `default-collider`, and the cache also needs `collider-from-mesh`.
///
/// ```
/// # use avian::prelude::*;
/// # use bevy_app::prelude::*;
/// # use bevy_transform::TransformPlugin;
/// # let mut app = App::new();
/// # app.add_plugins(TransformPlugin);
/// // In `FixedUpdate`, a metre being 20 units, and nothing ever falling asleep:
/// app.add_plugins(
///     PhysicsPlugins::new(FixedUpdate).with_length_unit(20.0).build().disable::<IslandSleepingPlugin>(),
/// );
/// ```
pub struct PhysicsPlugins {
    schedule: Interned<dyn ScheduleLabel>,
    length_unit: Option<Scalar>,
}

impl PhysicsPlugins {
    /// Hosts physics in `schedule`: each run takes one step, by the delta of `Time`. The default is
    /// [`FixedPostUpdate`].
    pub fn new(schedule: impl ScheduleLabel) -> Self {
        Self { schedule: schedule.intern(), length_unit: None }
    }

    /// Sets [`PhysicsLengthUnit`](crate::dynamics::solver::PhysicsLengthUnit), the approximate length of a
    /// metre in units of the app. An invalid length counts as 1, with a warning.
    pub fn with_length_unit(mut self, unit: Scalar) -> Self {
        self.length_unit = Some(unit);
        self
    }

    /// Adds the app's [`CollisionHooks`].
    pub fn with_collision_hooks<H: CollisionHooks + 'static>(self) -> PhysicsPluginsWithHooks<H>
    where
        for<'w, 's> SystemParamItem<'w, 's, H>: CollisionHooks,
    {
        PhysicsPluginsWithHooks { plugins: self, hooks: PhantomData }
    }

    /// The plugins, in order.
    fn group<G: PluginGroup, H: CollisionHooks + 'static>(self) -> PluginGroupBuilder
    where
        for<'w, 's> SystemParamItem<'w, 's, H>: CollisionHooks,
    {
        let builder = PluginGroupBuilder::start::<G>()
            .add(PhysicsSchedulePlugin::new(self.schedule))
            .add(PhysicsTypeRegistrationPlugin)
            .add(MassPropertyPlugin::new(self.schedule))
            .add(ForcePlugin)
            .add(ColliderHierarchyPlugin)
            .add(ColliderTransformPlugin::new(self.schedule));

        #[cfg(all(feature = "collider-from-mesh", feature = "default-collider"))]
        let builder = builder.add(crate::collision::collider::ColliderCachePlugin);
        #[cfg(feature = "default-collider")]
        let builder = builder
            .add(ColliderConstructorPlugin)
            .add(ColliderBackendPlugin::<Collider>::new(self.schedule))
            .add(ColliderTreePlugin::<Collider>::default())
            .add(NarrowPhasePlugin::<Collider, H>::default());

        #[cfg(feature = "default-collider")]
        let builder = builder.add(crate::character_controller::plugin::CharacterControllerPlugin);
        builder
            .add_group(
                self.length_unit.map_or_else(SolverPlugins::default, SolverPlugins::new_with_length_unit),
            )
            .add(BroadPhaseCorePlugin)
            .add(BvhBroadPhasePlugin::<H>::default())
            .add(JointPlugin)
            .add(SpatialQueryPlugin::new(self.schedule))
            .add(PhysicsTransformPlugin::new(self.schedule))
            .add(PhysicsInterpolationPlugin::default())
    }
}

impl Default for PhysicsPlugins {
    fn default() -> Self {
        Self::new(FixedPostUpdate)
    }
}

impl PluginGroup for PhysicsPlugins {
    fn build(self) -> PluginGroupBuilder {
        self.group::<Self, ()>()
    }
}

/// [`PhysicsPlugins`] with the app's [`CollisionHooks`].
pub struct PhysicsPluginsWithHooks<H: CollisionHooks> {
    plugins: PhysicsPlugins,
    hooks: PhantomData<fn() -> H>,
}

impl<H: CollisionHooks> PhysicsPluginsWithHooks<H> {
    /// Hosts physics in `schedule`, like [`PhysicsPlugins::new`].
    pub fn new(schedule: impl ScheduleLabel) -> Self {
        Self { plugins: PhysicsPlugins::new(schedule), hooks: PhantomData }
    }

    /// Sets the length of a metre, like [`PhysicsPlugins::with_length_unit`].
    pub fn with_length_unit(self, unit: Scalar) -> Self {
        Self { plugins: self.plugins.with_length_unit(unit), ..self }
    }
}

impl<H: CollisionHooks> Default for PhysicsPluginsWithHooks<H> {
    fn default() -> Self {
        Self { plugins: PhysicsPlugins::default(), hooks: PhantomData }
    }
}

impl<H: CollisionHooks + 'static> PluginGroup for PhysicsPluginsWithHooks<H>
where
    for<'w, 's> SystemParamItem<'w, 's, H>: CollisionHooks,
{
    fn build(self) -> PluginGroupBuilder {
        self.plugins.group::<Self, H>()
    }
}
