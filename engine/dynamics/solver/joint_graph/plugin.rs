//! The plugin that keeps [`JointGraph`] up to date.

use bevy_app::{App, Plugin};
use bevy_ecs::{component::ComponentId, entity_disabling::Disabled, prelude::*, system::SystemParam};
use bevy_log::warn;
use core::marker::PhantomData;

use super::{JointComponentId, JointGraph, JointGraphEdge, SyncEdges};
use crate::{
    dynamics::joints::{EntityConstraint, JointCollisionDisabled, JointDisabled},
    schedule::PhysicsSchedule,
    step::{self, Stage},
};

/// Keeps the joints of a type in [`JointGraph`], and ensures that an entity has only one joint: the last
/// joint that was inserted stays.
///
/// [`SolverPlugins`](crate::dynamics::solver::SolverPlugins) includes this plugin for all joints of the
/// engine. Add it for your own type to include the type in the graph.
pub struct JointGraphPlugin<T: Component + EntityConstraint<2>>(PhantomData<fn() -> T>);

impl<T: Component + EntityConstraint<2>> Default for JointGraphPlugin<T> {
    fn default() -> Self {
        Self(PhantomData)
    }
}

impl<T: Component + EntityConstraint<2>> Plugin for JointGraphPlugin<T> {
    fn build(&self, app: &mut App) {
        step::install(app);
        app.init_resource::<JointGraph>().init_resource::<Places>();
        // Registration fails only if the requirement exists already.
        let _ = app.try_register_required_components::<T, JointComponentId>();
        let own = app.world_mut().register_component::<T>();
        app.add_observer(move |on: On<Insert, T>, mut edges: Edges<T>, commands: Commands| {
            edges.claim(on.entity, own, commands);
            edges.refresh(on.entity, own);
        })
        .add_observer(move |on: On<Discard, T>, mut edges: Edges<T>| {
            if edges.is_own(on.entity, own) {
                edges.graph.remove_joint(on.entity);
            }
        })
        .add_observer(move |on: On<Remove, T>, edges: Edges<T>, mut commands: Commands| {
            if edges.is_own(on.entity, own) {
                commands.entity(on.entity).try_remove::<JointComponentId>();
            }
        });
        app.add_observer(move |on: On<Insert, Settings>, mut edges: Edges<T>| edges.refresh(on.entity, own))
            // The component still exists here, and the joint may be removed with it. The edge is refreshed
            // after both.
            .add_observer(move |on: On<Remove, Settings>, mut commands: Commands| {
                commands.run_system_cached_with(refresh::<T>, (on.entity, own));
            });

        // Plugins are built in order, and their systems run in the same order: edges get the same ids in
        // every run.
        let place = app.world().resource::<Places>().0;
        app.world_mut().resource_mut::<Places>().0 += 1;
        let sync = move |changed: Query<Entity, Changed<T>>, mut edges: Edges<T>| {
            changed.iter().for_each(|joint| edges.refresh(joint, own));
        };
        let system = sync.in_set(Place(place)).in_set(SyncEdges).in_set(Stage::SettleJoints);
        step::add_systems(app, PhysicsSchedule, system);
        if place > 0 {
            app.configure_sets(PhysicsSchedule, Place(place).after(Place(place - 1)));
        }
    }
}

/// Components beside a joint that determine its edge.
type Settings = (JointDisabled, Disabled, JointCollisionDisabled);

/// Refreshes the edge of a joint.
fn refresh<T: Component + EntityConstraint<2>>(
    In((joint, own)): In<(Entity, ComponentId)>,
    mut edges: Edges<T>,
) {
    edges.refresh(joint, own);
}

/// The number of these plugins.
#[derive(Resource, Default)]
struct Places(usize);

/// The system of one of these plugins, by number.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
struct Place(usize);

/// Components that determine an edge.
type EdgeState<T> = (
    &'static T,
    &'static mut JointComponentId,
    Has<JointDisabled>,
    Has<Disabled>,
    Has<JointCollisionDisabled>,
);

/// The joints of a type, and the graph.
#[derive(SystemParam)]
struct Edges<'w, 's, T: Component + EntityConstraint<2>> {
    joints: Query<'w, 's, EdgeState<T>, Allow<Disabled>>,
    graph: ResMut<'w, JointGraph>,
}

impl<T: Component + EntityConstraint<2>> Edges<'_, '_, T> {
    /// Whether the joint of an entity is of the type with this id.
    fn is_own(&self, joint: Entity, own: ComponentId) -> bool {
        self.joints.get(joint).is_ok_and(|(_, id, ..)| id.0 == Some(own))
    }

    /// Makes an inserted joint the only joint of its entity.
    fn claim(&mut self, joint: Entity, own: ComponentId, mut commands: Commands) {
        let Ok((_, mut id, ..)) = self.joints.get_mut(joint) else { return };
        if let Some(other) = id.0.replace(own)
            && other != own
        {
            warn!("the entity {joint} got a second joint, which replaces the first: an entity has one");
            commands.entity(joint).remove_by_id(other);
        }
    }

    /// Adds, changes or removes the edge of a joint.
    fn refresh(&mut self, joint: Entity, own: ComponentId) {
        let Ok((constraint, id, is_off, is_disabled, is_apart)) = self.joints.get(joint) else { return };
        if id.0 != Some(own) {
            return;
        }
        if is_off || is_disabled {
            self.graph.remove_joint(joint);
            return;
        }
        let [body1, body2] = constraint.entities();
        match self.graph.get_mut(joint) {
            Some(edge) if [edge.body1, edge.body2] == [body1, body2] => edge.collision_disabled = is_apart,
            _ => _ = self.graph.add_joint(body1, body2, JointGraphEdge::new(joint, body1, body2, is_apart)),
        }
    }
}
