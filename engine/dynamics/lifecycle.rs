//! The life cycle: the only way for bodies and colliders to enter and leave the simulation.
//!
//! Observers only record *which* entities may have changed, and which ids lost their component. Once per step
//! the queue is drained: the components of each queued entity are compared with the tables, and differences
//! are applied. Therefore the order of changes does not matter, and changes that cancel each other cost
//! nothing.
//!
//! ```text
//!   body       absent ──enters──▶ awake ⇄ asleep ──leaves──▶ absent        (static: neither awake nor asleep)
//!   collider   absent ──enters──▶ in its body's tree ──leaves──▶ absent
//!   enters     RigidBody (Collider) is there, and neither Disabled nor, for colliders, ColliderDisabled
//!   leaves     despawned, component removed, disabled
//!   retyped    RigidBody is another value: contacts stay, colours, islands and tree change
//!   rebodied   ColliderOf names another body, or that body entered, left or is RigidBodyDisabled: leaves, enters
//! ```

use bevy_app::App;
use bevy_ecs::{
    change_detection::Tick,
    entity::{EntityHashSet, EntityIndexSet},
    entity_disabling::Disabled,
    prelude::*,
    system::SystemChangeTick,
};
use kernel::table::NONE;

use crate::{
    collision::{
        collider::{
            Collider, ColliderDisabled, CollidingEntities, CollisionLayers, Sensor,
            collider_hierarchy::ColliderOf, collider_transform::ColliderTransform, custom::CustomShape,
        },
        collision_events::CollisionEventsEnabled,
        collision_hits::CollisionHitsEnabled,
        hooks::ActiveCollisionHooks,
    },
    dynamics::{
        ids::{BodyId, ColliderId},
        rigid_body::{
            AngularVelocity, LinearVelocity, RigidBody, RigidBodyDisabled,
            mass_properties::components::{ComputedAngularInertia, ComputedCenterOfMass, ComputedMass},
        },
    },
    noted::Noted,
    physics_transform::{Position, Rotation},
    scan::{IN_TABLES, Since},
};

/// Entities that may have changed since the last step.
#[derive(Resource, Clone, Debug, Default)]
pub(crate) struct LifecycleQueue {
    /// Entities whose body may enter, leave or be retyped.
    pub(crate) bodies: Noted,
    /// Entities whose collider may enter, leave or be redefined.
    pub(crate) colliders: Noted,
    /// Body ids whose component was removed or whose entity was despawned.
    pub(crate) lost_bodies: Vec<u32>,
    /// Collider ids whose component was removed or whose entity was despawned.
    pub(crate) lost_colliders: Vec<u32>,
    /// All notes since the queue was last drained, for queries that read the queue.
    pub(crate) log: NoteLog,
    /// Entities that are about to lose a component. They are recorded before the removal and logged after it.
    pub(crate) leaving: Vec<Note>,
    /// Colliders that were refused and reported because their pose is not finite.
    pub(crate) refused: EntityIndexSet,
    /// Colliders of bodies that are not in the simulation. They use their own pose.
    pub(crate) detached: EntityIndexSet,
    /// Colliders whose body left the simulation in this step.
    pub(crate) bereft: EntityHashSet,
    /// Colliders that enter in the next step.
    pub(crate) later: Vec<Entity>,
    /// Tick of the last scan for mutated colliders.
    pub(crate) drained: Tick,
    /// Whether a step is between its drain and its final removals. Contacts stay in the tables during that
    /// time.
    pub(crate) is_within_step: bool,
    /// Colliders that lost their shape since the drain. The final removals end their contacts.
    pub(crate) shapeless: Vec<u32>,
}

/// An entity that was queued.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Note {
    Body(Entity),
    Collider(Entity),
}

/// Notes in chronological order. An entity may be noted several times.
#[derive(Clone, Debug, Default)]
pub(crate) struct NoteLog {
    notes: Vec<Note>,
    number: u64,
}

/// Logs with fewer entries are not restarted.
const SHORT: usize = 1024;

/// A log is restarted when it has this number of entries per entity in the queue. A smaller value makes
/// queries read the queue more often, a larger value takes more memory while physics is paused.
const NOTES: usize = 8;

impl NoteLog {
    /// The notes since the log was started.
    pub(crate) fn notes(&self) -> &[Note] {
        &self.notes
    }

    /// The number of restarts of the log. Earlier notes are only in the queue.
    pub(crate) fn number(&self) -> u64 {
        self.number
    }

    /// Restarts the log.
    pub(crate) fn restart(&mut self) {
        self.notes.clear();
        self.number += 1;
    }
}

impl LifecycleQueue {
    /// Queues an entity.
    fn note(&mut self, note: Note) {
        self.queue(note);
        self.record(note);
    }

    /// Queues an entity that still has the component that it is about to lose.
    fn note_leaving(&mut self, note: Note, commands: &mut Commands) {
        self.queue(note);
        if self.leaving.is_empty() {
            commands.queue(log_leaving);
        }
        self.leaving.push(note);
    }

    /// Restarts the log.
    pub(crate) fn restart_log(&mut self) {
        self.log.restart();
        self.leaving.clear();
    }

    fn record(&mut self, note: Note) {
        if self.log.notes.len() >= SHORT.max(NOTES * (self.bodies.len() + self.colliders.len())) {
            self.log.restart();
        }
        self.log.notes.push(note);
    }

    fn queue(&mut self, note: Note) {
        match note {
            Note::Body(entity) => _ = self.bodies.note(entity),
            Note::Collider(entity) => {
                if let Some(gone) = self.colliders.note(entity) {
                    self.refused.swap_remove(&gone);
                    self.detached.swap_remove(&gone);
                }
            }
        }
    }
}

/// Components that a body needs. They are required components, but an app may remove them.
pub(crate) type BodyEssentials = (
    Position,
    Rotation,
    LinearVelocity,
    AngularVelocity,
    ComputedMass,
    ComputedAngularInertia,
    ComputedCenterOfMass,
);

/// The filter for bodies with all of these components.
pub(crate) type IsComplete = (
    With<Position>,
    With<Rotation>,
    With<LinearVelocity>,
    With<AngularVelocity>,
    With<ComputedMass>,
    With<ComputedAngularInertia>,
    With<ComputedCenterOfMass>,
);

/// Adds the observers, and queues entities that were spawned before.
pub(crate) fn watch(app: &mut App) {
    if app.world().contains_resource::<LifecycleQueue>() {
        return;
    }
    app.init_resource::<LifecycleQueue>();
    follow::<Insert, OfBodies>(app, Note::Body);
    follow::<Insert, OfColliders>(app, Note::Collider);
    follow::<Add, BodyEssentials>(app, Note::Body);
    follow::<Add, BodyEssentials>(app, Note::Collider);
    app.add_observer(lose_body).add_observer(lose_collider);

    let world = app.world_mut();
    let mut bodies = world.query_filtered::<Entity, With<RigidBody>>();
    let mut colliders = world.query_filtered::<Entity, Or<(With<Collider>, With<CustomShape>)>>();
    let (bodies, colliders): (Vec<_>, Vec<_>) =
        (bodies.iter(world).collect(), colliders.iter(world).collect());
    let mut queue = world.resource_mut::<LifecycleQueue>();
    queue.bodies.extend(bodies);
    queue.colliders.extend(colliders);
}

/// Components whose insertion or removal may change a body.
type OfBodies = (RigidBody, RigidBodyDisabled, Disabled);

/// Components whose insertion or removal may change a collider.
type OfColliders = (
    Collider,
    CustomShape,
    ColliderOf,
    ColliderDisabled,
    CollisionLayers,
    Sensor,
    CollisionEventsEnabled,
    CollidingEntities,
    ActiveCollisionHooks,
    CollisionHitsEnabled,
    Disabled,
);

/// Queues entities that get or lose a component of `B`. One observer serves many components, because each
/// observer is compiled like a system.
fn follow<Come: EntityEvent, B: Bundle>(app: &mut App, note: fn(Entity) -> Note) {
    app.add_observer(move |on: On<Come, B>, mut queue: ResMut<LifecycleQueue>| {
        queue.note(note(on.event_target()));
    })
    .add_observer(
        move |on: On<Remove, B>, mut queue: ResMut<LifecycleQueue>, mut commands: Commands| {
            queue.note_leaving(note(on.entity), &mut commands);
        },
    );
}

/// Logs entities that lost components.
fn log_leaving(world: &mut World) {
    if let Some(mut queue) = world.get_resource_mut::<LifecycleQueue>() {
        for note in core::mem::take(&mut queue.leaving) {
            queue.record(note);
        }
    }
}

/// Queues mutated colliders, and moved colliders whose body is not in the simulation.
pub(crate) fn note_changed_colliders(
    shapes: Query<(Entity, Ref<Collider>), With<ColliderId>>,
    places: Query<(Entity, Ref<ColliderTransform>), With<ColliderId>>,
    alone: Query<(Entity, Ref<Position>, Ref<Rotation>), (With<ColliderId>, Without<ColliderOf>)>,
    poses: Query<(Ref<Position>, Ref<Rotation>), With<ColliderId>>,
    mut queue: ResMut<LifecycleQueue>,
    system: SystemChangeTick,
) {
    let since = Since::last_run(system);
    queue.drained = system.this_run();
    let LifecycleQueue { colliders: noted, refused, detached, .. } = &mut *queue;
    // Refused colliders enter as soon as their pose is finite, in the order in which they were refused.
    let has_moved = |entity: &Entity| {
        poses.get(*entity).is_ok_and(|(position, rotation)| position.is_changed() || rotation.is_changed())
    };
    noted.extend(refused.iter().chain(detached.iter()).copied().filter(has_moved));
    let mut note = |entity: Entity| _ = noted.note(entity);
    for (entities, shape) in shapes.contiguous_iter().expect(IN_TABLES) {
        since.rows([shape.changed_ticks_slice()], |row| note(entities[row]));
    }
    for (entities, place) in places.contiguous_iter().expect(IN_TABLES) {
        since.rows([place.changed_ticks_slice()], |row| note(entities[row]));
    }
    for (entities, position, rotation) in alone.contiguous_iter().expect(IN_TABLES) {
        let columns = [position.changed_ticks_slice(), rotation.changed_ticks_slice()];
        since.rows(columns, |row| note(entities[row]));
    }
}

/// Removes the id of a body whose component was removed or overwritten. An entity that is still a body
/// enters again.
fn lose_body(
    on: On<Discard, BodyId>,
    ids: Query<&BodyId, Allow<Disabled>>,
    mut queue: ResMut<LifecycleQueue>,
    mut commands: Commands,
) {
    if let Ok(BodyId(id)) = ids.get(on.entity)
        && *id != NONE
    {
        queue.lost_bodies.push(*id);
        queue.note_leaving(Note::Body(on.entity), &mut commands);
    }
}

/// Removes the id of a collider whose component was removed or overwritten. An entity that is still a
/// collider enters again.
fn lose_collider(
    on: On<Discard, ColliderId>,
    ids: Query<&ColliderId, Allow<Disabled>>,
    mut queue: ResMut<LifecycleQueue>,
    mut commands: Commands,
) {
    if let Ok(ColliderId(id)) = ids.get(on.entity)
        && *id != NONE
    {
        queue.lost_colliders.push(*id);
        queue.note_leaving(Note::Collider(on.entity), &mut commands);
    }
}

#[cfg(all(test, feature = "default-collider"))]
mod tests {
    use super::*;
    use crate::{
        PhysicsPlugins,
        collision::collider::collider_transform::Placement,
        dynamics::{rigid_body::sleeping::Sleeping, sleep::SleepRequests},
        physics_transform::{
            spawned::SpawnQueue,
            tree::{HierarchyQueue, TransformTree},
        },
        schedule::{Physics, PhysicsSchedule, PhysicsTime},
    };
    use bevy_app::{App, TaskPoolPlugin, Update};
    use bevy_time::Time;
    use bevy_transform::{TransformPlugin, components::Transform};

    fn ids(app: &App, entity: Entity) -> [Option<u32>; 2] {
        let entity = app.world().entity(entity);
        [entity.get::<BodyId>().map(|id| id.0), entity.get::<ColliderId>().map(|id| id.0)]
    }

    /// Ids from a saved scene belong to another world and are ignored.
    #[test]
    fn ids_from_elsewhere_are_none() {
        let mut app = App::new();
        app.add_plugins((TaskPoolPlugin::default(), TransformPlugin, PhysicsPlugins::new(Update)));
        let loaded = (RigidBody::Dynamic, Collider::default(), BodyId(7), ColliderId(7));
        let first = app.world_mut().spawn(loaded).id();
        assert_eq!(ids(&app, first), [Some(NONE); 2]);
        app.world_mut().run_schedule(crate::schedule::PhysicsSchedule);
        assert_eq!(ids(&app, first), [Some(0); 2]);

        let second = (RigidBody::Dynamic, Collider::default(), BodyId(0), ColliderId(0));
        let second = app.world_mut().spawn(second).id();
        app.world_mut().run_schedule(crate::schedule::PhysicsSchedule);
        assert_eq!([ids(&app, first), ids(&app, second)], [[Some(0); 2], [Some(1); 2]]);

        // Inserted over an existing id: the old id is removed, and a new one assigned.
        app.world_mut().entity_mut(first).insert((BodyId(1), ColliderId(1)));
        app.world_mut().run_schedule(crate::schedule::PhysicsSchedule);
        app.world_mut().run_schedule(crate::schedule::PhysicsSchedule);
        assert_eq!(ids(&app, second), [Some(1); 2]);
        let [body, collider] = ids(&app, first);
        assert!(![Some(1), Some(NONE)].contains(&body) && ![Some(1), Some(NONE)].contains(&collider));
    }

    /// The lengths of all queues that observers fill.
    fn queued(world: &World) -> [usize; 6] {
        let queue = world.resource::<LifecycleQueue>();
        [
            queue.bodies.len(),
            queue.colliders.len(),
            world.resource::<HierarchyQueue>().len(),
            world.resource::<SpawnQueue>().len(),
            world.resource::<SleepRequests>().len(),
            world.resource::<Placement>().len(),
        ]
    }

    /// A hundred bodies with a child collider live for one frame each, for 300 frames without a step. Queues
    /// hold only a few entries per entity alive at one time, with or without the schedule that hosts physics,
    /// and are empty at the end.
    #[test]
    fn issue_queues_grew_with_all_that_lived_while_physics_was_paused() {
        for hosted in [false, true] {
            let mut app = App::new();
            app.add_plugins((TaskPoolPlugin::default(), TransformPlugin, PhysicsPlugins::new(Update)));
            app.world_mut().resource_mut::<Time<Physics>>().pause();
            let root = app.world_mut().spawn(Transform::default()).id();
            for _ in 0..300 {
                let bodies: Vec<Entity> = (0..100)
                    .map(|_| {
                        let body =
                            app.world_mut().spawn((RigidBody::Dynamic, Collider::default(), ChildOf(root)));
                        body.id()
                    })
                    .collect();
                for &body in &bodies {
                    app.world_mut().spawn((Collider::default(), ChildOf(body)));
                    app.world_mut().entity_mut(body).insert(Sleeping).remove::<Sleeping>();
                }
                if hosted {
                    app.update();
                }
                bodies.iter().for_each(|body| _ = app.world_mut().despawn(*body));
                let queued = queued(app.world());
                assert!(queued.iter().all(|length| *length <= 1000), "hosted: {hosted}, {queued:?}");
            }
            app.update();
            app.world_mut().run_schedule(PhysicsSchedule);
            assert_eq!(queued(app.world()), [0; 6], "hosted: {hosted}");
            assert_eq!(app.world().resource::<TransformTree>().len(), 0, "hosted: {hosted}");
        }
    }

    /// Redefining an unchanged collider would recompute its manifolds instead of recycling them.
    #[test]
    fn issue_writing_what_a_collider_is_already_dropped_its_kept_contacts() {
        use crate::dynamics::tables::Contacts;
        use crate::prelude::{CollisionLayers, Friction, SleepingDisabled};

        let mut app = App::new();
        app.add_plugins((TaskPoolPlugin::default(), TransformPlugin, PhysicsPlugins::new(Update)));
        app.finish();
        app.cleanup();
        let step = |app: &mut App| {
            app.world_mut().resource_mut::<Time>().advance_by(core::time::Duration::from_millis(16));
            app.update();
        };
        let floor = Collider::half_space(crate::math::Vector::Y);
        let floor = app.world_mut().spawn((RigidBody::Static, floor)).id();
        let shape = Collider::capsule(0.5, 1.0);
        let surface = Friction::new(0.3);
        let body = (
            RigidBody::Dynamic,
            shape.clone(),
            surface,
            SleepingDisabled,
            Transform::from_xyz(0.0, 1.01, 0.0),
        );
        let body = app.world_mut().spawn(body).id();
        (0..30).for_each(|_| step(&mut app));
        let revisions = |app: &App| {
            let contacts = &app.world().resource::<Contacts>().table;
            contacts.iter().map(|(id, contact)| (id, contact.revisions)).collect::<Vec<_>>()
        };
        let before = revisions(&app);
        assert_eq!(before.len(), 1);
        for _ in 0..5 {
            app.world_mut().entity_mut(body).insert((shape.clone(), surface, CollisionLayers::default()));
            app.world_mut().get_mut::<Collider>(floor).expect("a collider").set_changed();
            step(&mut app);
            assert_eq!(revisions(&app), before);
        }
        app.world_mut().entity_mut(body).insert(Collider::capsule(0.5, 0.9));
        step(&mut app);
        assert_ne!(revisions(&app), before, "another shape is another contact");
    }
}
