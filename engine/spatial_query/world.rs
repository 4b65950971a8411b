//! A system parameter with the tables and the components that they follow, and the changes since the last
//! step.
//!
//! Changes are known from the life-cycle queue and its log, and by a scan of change ticks. All systems and
//! observers share the result. The first query of a run reads only colliders that changed since the last run
//! with a query. Without queries nothing is read.

use bevy_ecs::{change_detection::Tick, prelude::*, system::SystemChangeTick, system::SystemParam};
use kernel::{math::Pose, table::NONE};
use std::sync::{Arc, PoisonError, RwLock};

use super::recent::{Recent, RecentCollider, Seen};
use crate::{
    collision::collider::{
        Collider, ColliderDisabled, CollisionLayers,
        collider_hierarchy::{ColliderOf, RigidBodyColliders},
        collider_transform::ColliderTransform,
    },
    dynamics::{
        drain::local_pose,
        ids::{BodyId, ColliderId},
        lifecycle::{LifecycleQueue, Note},
        quarantine::is_finite,
        rigid_body::{RigidBody, RigidBodyDisabled},
        tables::{Bodies, Colliders},
    },
    physics_transform::{Position, Rotation, said_pose, world_pose},
    scan::{IN_TABLES, Since},
};

/// The changes that the runs of systems know so far.
#[derive(Default)]
struct Known {
    recent: Arc<Recent>,
    /// The moment up to which changes are known. `None` before the first query.
    progress: Option<Progress>,
    /// The number of entities that were read.
    reads: usize,
}

/// A moment up to which changes are known.
#[derive(Clone, Copy)]
struct Progress {
    base: Base,
    /// The tick of the last run that searched for changes.
    tick: Tick,
    /// The lengths of the queue's lists at that time.
    notes: usize,
    lost_bodies: usize,
    lost_colliders: usize,
}

/// The state of the tables from which recent colliders differ.
#[derive(Clone, Copy, PartialEq)]
struct Base {
    drained: Tick,
    written: Tick,
    log: u64,
    /// The ticks at which the tables became resources: they may be replaced by others.
    added: [Tick; 3],
    is_within_step: bool,
}

impl Known {
    /// Whether a run of this tick has no changes to add. The run holds its data, so no data is written while
    /// it runs.
    fn is_of(&self, now: Tick) -> bool {
        self.progress.is_some_and(|last| now.get().wrapping_sub(last.tick.get()) as i32 <= 0)
    }
}

/// [`Known`] of all systems of a world.
#[derive(Resource, Clone, Default)]
struct SharedKnown(Arc<RwLock<Known>>);

/// A handle to the changes that all systems of a world know.
pub(super) struct Shared(Arc<RwLock<Known>>);

impl FromWorld for Shared {
    fn from_world(world: &mut bevy_ecs::world::World) -> Self {
        Self(world.get_resource_or_init::<SharedKnown>().0.clone())
    }
}

type State = (
    &'static Collider,
    Option<&'static ColliderOf>,
    Option<&'static ColliderTransform>,
    Option<(&'static Position, &'static Rotation)>,
    Option<&'static CollisionLayers>,
    Has<ColliderDisabled>,
);

type Body = (&'static Position, &'static Rotation, Has<RigidBodyDisabled>);

/// The tables, and the components that they follow.
#[derive(SystemParam)]
pub(super) struct World<'w, 's> {
    pub(super) colliders: Res<'w, Colliders>,
    bodies: Res<'w, Bodies>,
    queue: Res<'w, LifecycleQueue>,
    states: Query<'w, 's, State>,
    ids: Query<'w, 's, &'static ColliderId>,
    frames: Query<'w, 's, Body, With<RigidBody>>,
    body_ids: Query<'w, 's, &'static BodyId>,
    of_body: Query<'w, 's, &'static RigidBodyColliders>,
    moved: Query<'w, 's, (Entity, &'static BodyId, Ref<'static, Position>, Ref<'static, Rotation>)>,
    alone: Query<
        'w,
        's,
        (Entity, Ref<'static, Position>, Ref<'static, Rotation>),
        (With<ColliderId>, Without<ColliderOf>),
    >,
    poses: Query<'w, 's, (Ref<'static, Position>, Ref<'static, Rotation>), With<ColliderId>>,
    shapes: Query<'w, 's, (Entity, Ref<'static, Collider>), With<ColliderId>>,
    places: Query<'w, 's, (Entity, Ref<'static, ColliderTransform>), With<ColliderId>>,
    known: Local<'s, Shared>,
    tick: SystemChangeTick,
}

impl World<'_, '_> {
    /// The changes since the last step, brought up to date by the first query of a run of a system.
    pub(super) fn recent(&self) -> Arc<Recent> {
        let now = self.tick.this_run();
        let shared = &self.known.0;
        {
            let known = shared.read().unwrap_or_else(PoisonError::into_inner);
            if known.is_of(now) {
                return known.recent.clone();
            }
        }
        let mut known = shared.write().unwrap_or_else(PoisonError::into_inner);
        // Another thread may have been faster.
        if !known.is_of(now) {
            self.follow(&mut known, now);
        }
        known.recent.clone()
    }

    /// The component of a collider.
    pub(super) fn component(&self, entity: Entity) -> Option<&Collider> {
        self.states.get(entity).ok().map(|state| state.0)
    }

    /// The body of a collider.
    pub(super) fn body_of(&self, collider: Entity) -> Option<Entity> {
        self.states.get(collider).ok()?.1.map(|of| of.body)
    }

    /// Adds the changes since the last run.
    fn follow(&self, known: &mut Known, now: Tick) {
        let base = Base {
            drained: self.queue.drained,
            written: self.bodies.written,
            log: self.queue.log.number(),
            added: [self.colliders.added(), self.bodies.added(), self.queue.added()],
            is_within_step: self.queue.is_within_step,
        };
        // Within a step the tables change with each stage.
        let progress = known.progress.filter(|last| last.base == base && !base.is_within_step);
        if progress.is_none() {
            known.recent = Arc::default();
        }
        let mut changed = self.changed(progress.as_ref(), &known.recent);
        changed.sort_unstable();
        changed.dedup();
        let LifecycleQueue { lost_bodies, lost_colliders, log, .. } = &*self.queue;
        let new_lost = progress.map_or(0, |last| last.lost_colliders);
        if !changed.is_empty() || new_lost < lost_colliders.len() {
            // Copied only while a query of another run is in progress.
            let recent = Arc::make_mut(&mut known.recent);
            lost_colliders[new_lost..].iter().for_each(|id| _ = recent.replaced.insert(*id));
            known.reads += changed.len();
            recent.update(changed.into_iter().map(|entity| self.see(entity)));
        }
        known.progress = Some(Progress {
            base,
            tick: now,
            notes: log.notes().len(),
            lost_bodies: lost_bodies.len(),
            lost_colliders: lost_colliders.len(),
        });
    }

    /// An entity as it is now.
    fn see(&self, entity: Entity) -> Seen {
        let id = self.ids.get(entity).map_or(NONE, |id| id.0);
        let is_known = id != NONE && self.colliders.entities.get(id as usize) == Some(&entity);
        let id = if is_known { id } else { NONE };
        Seen { entity, id, collider: self.read(entity, id) }
    }

    /// A collider from its present components, if it takes part in queries.
    fn read(&self, entity: Entity, id: u32) -> Option<RecentCollider> {
        let (collider, of, transform, own, layers, disabled) = self.states.get(entity).ok()?;
        if disabled {
            return None;
        }
        let body = of.and_then(|of| Some((of.body, self.frames.get(of.body).ok()?)));
        let (pose, is_detached) = match (body, own) {
            (Some((body, (position, rotation, false))), _) if *position != Position::PLACEHOLDER => {
                let local = transform.filter(|_| body != entity).map_or(Pose::IDENTITY, local_pose);
                (world_pose(position, rotation).then(&local), false)
            }
            (_, Some((position, rotation))) if *position != Position::PLACEHOLDER => {
                (world_pose(position, rotation), of.is_some())
            }
            _ => return None,
        };
        is_finite(&pose).then(|| RecentCollider {
            entity,
            id,
            shape: collider.native().clone(),
            pose,
            layers: layers.copied().unwrap_or_default(),
            is_detached,
        })
    }

    /// Entities of colliders that may have changed after a moment; without a moment, that may differ from the
    /// tables. Some entities may be listed twice.
    fn changed(&self, after: Option<&Progress>, recent: &Recent) -> Vec<Entity> {
        let LifecycleQueue { bodies, colliders, lost_bodies, log, leaving, refused, detached, .. } =
            &*self.queue;
        let mut found = Vec::new();
        match after {
            None => {
                found.extend(colliders.entities());
                bodies.entities().for_each(|body| self.add_body(body, &mut found));
            }
            Some(last) => {
                for note in log.notes()[last.notes..].iter().chain(leaving) {
                    match *note {
                        Note::Collider(entity) => found.push(entity),
                        Note::Body(body) => self.add_body(body, &mut found),
                    }
                }
            }
        }
        for &id in &lost_bodies[after.map_or(0, |last| last.lost_bodies)..] {
            self.add_colliders_of_id(id, &mut found);
        }
        // Changes with the tick of that run may have been made after its search.
        let since = |step: Tick| {
            let last = after.map_or(step, |last| Tick::new(last.tick.get().wrapping_sub(1)));
            Since::new(last, self.tick)
        };
        self.add_moved(since(self.bodies.written), recent, &mut found);
        let drained = since(self.queue.drained);
        for (entities, shape) in self.shapes.contiguous_iter().expect(IN_TABLES) {
            drained.rows([shape.changed_ticks_slice()], |row| found.push(entities[row]));
        }
        for (entities, place) in self.places.contiguous_iter().expect(IN_TABLES) {
            drained.rows([place.changed_ticks_slice()], |row| found.push(entities[row]));
        }
        for (entities, position, rotation) in self.alone.contiguous_iter().expect(IN_TABLES) {
            let columns = [position.changed_ticks_slice(), rotation.changed_ticks_slice()];
            drained.rows(columns, |row| found.push(entities[row]));
        }
        // These use their own pose, though they have a body.
        let has_moved = |entity: &&Entity| {
            self.poses.get(**entity).is_ok_and(|(position, rotation)| {
                drained.is_new(position.last_changed()) || drained.is_new(rotation.last_changed())
            })
        };
        found.extend(refused.iter().chain(detached).chain(&recent.detached).filter(has_moved));
        found
    }

    /// Adds the colliders of bodies whose pose differs from the last step, or differed before.
    fn add_moved(&self, written: Since, recent: &Recent, found: &mut Vec<Entity>) {
        let mut moved = Vec::new();
        for (entities, ids, position, rotation) in self.moved.contiguous_iter().expect(IN_TABLES) {
            let columns = [position.changed_ticks_slice(), rotation.changed_ticks_slice()];
            written.rows(columns, |row| moved.push((entities[row], ids[row].0)));
        }
        for (entity, id) in moved {
            let Ok((position, rotation, _)) = self.frames.get(entity) else { continue };
            let seen = self.bodies.seen.get(id as usize).filter(|_| id != NONE);
            let is_back = seen == Some(&said_pose(position, rotation));
            let Ok(colliders) = self.of_body.get(entity) else { continue };
            found.extend(colliders.iter().filter(|collider| !is_back || self.differs(*collider, recent)));
        }
    }

    /// Whether a collider is known to differ from the tables.
    fn differs(&self, collider: Entity, recent: &Recent) -> bool {
        recent.holds(collider) || self.ids.get(collider).is_ok_and(|id| recent.replaced.contains(id.0))
    }

    fn add_body(&self, body: Entity, found: &mut Vec<Entity>) {
        self.add_colliders_of(body, found);
        if let Ok(id) = self.body_ids.get(body) {
            self.add_colliders_of_id(id.0, found);
        }
    }

    fn add_colliders_of(&self, body: Entity, found: &mut Vec<Entity>) {
        if let Ok(colliders) = self.of_body.get(body) {
            found.extend(colliders);
        }
    }

    fn add_colliders_of_id(&self, body: u32, found: &mut Vec<Entity>) {
        let bodies = &self.bodies.table;
        if body != NONE && bodies.ids.is_live(body) {
            let ids = self.colliders.table.of_body(body, bodies);
            found.extend(ids.map(|id| self.colliders.entities[id as usize]));
        }
    }
}

#[cfg(all(test, feature = "default-collider"))]
mod tests {
    use super::*;
    use crate::{
        PhysicsPlugins,
        dynamics::rigid_body::LinearVelocity,
        math::{Dir, Scalar, Vector},
        spatial_query::{RayHitData, SpatialQuery, SpatialQueryFilter},
    };
    use bevy_app::{App, TaskPoolPlugin, Update};
    use bevy_time::Time;
    use bevy_transform::{TransformPlugin, components::Transform};

    fn app() -> App {
        let mut app = App::new();
        app.add_plugins((TaskPoolPlugin::default(), TransformPlugin, PhysicsPlugins::new(Update)));
        app.finish();
        app.cleanup();
        app
    }

    fn reads(app: &App) -> usize {
        let shared = app.world().resource::<SharedKnown>();
        shared.0.read().unwrap_or_else(PoisonError::into_inner).reads
    }

    fn at(x: Scalar) -> (Position, Rotation) {
        (Position(Vector::X * x), Rotation::default())
    }

    fn all_along_x(queries: SpatialQuery) -> Vec<RayHitData> {
        let filter = SpatialQueryFilter::default();
        let from = Vector::NEG_X * 1000.0;
        queries.ray_hits(from, Dir::X, 5000.0, u32::MAX, true, &filter)
    }

    #[derive(Resource, Default)]
    struct Hits(usize);

    /// Each observer sees all earlier colliders, and its own.
    fn count_hits(_: On<Add, Collider>, queries: SpatialQuery, mut hits: ResMut<Hits>) {
        hits.0 += all_along_x(queries).len();
    }

    #[test]
    fn issue_each_observer_that_queried_read_all_that_was_spawned_in_the_frame() {
        for (count, is_stepped) in [(300_u16, false), (300, true)] {
            let mut app = app();
            app.init_resource::<Hits>();
            if is_stepped {
                app.world_mut().spawn((RigidBody::Static, Collider::default(), at(-5.0)));
                app.update();
            }
            app.add_observer(count_hits);
            for i in 0..count {
                let place = at(2.0 * Scalar::from(i));
                app.world_mut().spawn((RigidBody::Static, Collider::default(), place));
            }
            let all = usize::from(count);
            let old = if is_stepped { all } else { 0 };
            assert_eq!(app.world().resource::<Hits>().0, all * (all + 1) / 2 + old);
            assert!(reads(&app) <= 4 * all, "{} reads of {all} colliders", reads(&app));
            // Without a change no collider is read, however often a system queries.
            let before = reads(&app);
            for _ in 0..10 {
                let hits = app.world_mut().run_system_cached(all_along_x).expect("it runs");
                assert_eq!(hits.len(), all + usize::from(is_stepped));
            }
            assert!(reads(&app) <= before + 2, "{} reads after {before}", reads(&app));
        }
    }

    #[derive(Resource, Default)]
    struct Last(Option<Entity>);

    fn see<C: Component>(_: On<Remove, C>, queries: SpatialQuery, mut last: ResMut<Last>) {
        last.0 = all_along_x(queries).first().map(|hit| hit.entity);
    }

    /// An observer runs before the component is gone.
    #[test]
    fn what_a_query_saw_as_it_was_removed_is_not_seen_later() {
        let mut app = app();
        app.init_resource::<Last>();
        app.add_observer(see::<Collider>).add_observer(see::<ColliderDisabled>);
        for is_stepped in [false, true] {
            let body = app.world_mut().spawn((RigidBody::Static, Collider::default(), at(0.0))).id();
            if is_stepped {
                app.update();
            }
            app.world_mut().entity_mut(body).insert(ColliderDisabled);
            let hits = |app: &mut App| app.world_mut().run_system_cached(all_along_x).expect("it runs").len();
            assert_eq!(hits(&mut app), 0);
            app.world_mut().entity_mut(body).remove::<ColliderDisabled>();
            assert_eq!((app.world().resource::<Last>().0, hits(&mut app)), (None, 1));
            app.world_mut().despawn(body);
            assert_eq!((app.world().resource::<Last>().0, hits(&mut app)), (Some(body), 0));
        }
    }

    /// The followed changes equal the result of a search from the tables.
    #[test]
    fn what_is_followed_is_what_is_there() {
        let mut seed = 7_u32;
        let mut random = move |below: u32| {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (seed >> 8) % below
        };
        let mut app = app();
        let mut bodies: Vec<Entity> = Vec::new();
        let mut seen = 0;
        for turn in 0..1500 {
            let world = app.world_mut();
            let place = at(Scalar::from(random(500) as u16));
            let any = (!bodies.is_empty()).then(|| random(bodies.len() as u32) as usize);
            match (random(14), any) {
                (0..=2, _) | (_, None) => {
                    let kind =
                        [RigidBody::Static, RigidBody::Dynamic, RigidBody::Kinematic][random(3) as usize];
                    bodies.push(world.spawn((kind, Collider::default(), place, LinearVelocity::ZERO)).id());
                }
                (3, _) => bodies.push(world.spawn((Collider::default(), place)).id()),
                (4, Some(any)) => _ = world.despawn(bodies.swap_remove(any)),
                (5, Some(any)) => _ = world.entity_mut(bodies[any]).insert(RigidBodyDisabled),
                (6, Some(any)) => _ = world.entity_mut(bodies[any]).remove::<RigidBodyDisabled>(),
                (7, Some(any)) => _ = world.entity_mut(bodies[any]).insert(ColliderDisabled),
                (8, Some(any)) => _ = world.entity_mut(bodies[any]).remove::<ColliderDisabled>(),
                (9, Some(any)) => {
                    let child = (Collider::default(), Transform::from_xyz(1.0, 0.0, 0.0));
                    bodies.push(world.spawn((child, ChildOf(bodies[any]))).id());
                }
                (10, Some(any)) => _ = world.entity_mut(bodies[any]).remove::<RigidBody>(),
                (11, Some(any)) => {
                    if let Some(mut shape) = world.get_mut::<Collider>(bodies[any]) {
                        shape.set_scale(Vector::ONE * (0.5 + random(3) as Scalar), 10);
                    }
                }
                (12, Some(any)) => {
                    // Away, and back.
                    let Some(old) = world.get::<Position>(bodies[any]).copied() else { continue };
                    for place in [place.0, old] {
                        if let Some(mut position) = world.get_mut::<Position>(bodies[any]) {
                            *position = place;
                        }
                        _ = world.run_system_cached(all_along_x);
                    }
                }
                (_, Some(any)) => {
                    let is_step = random(10) == 0;
                    if let Some(mut position) = world.get_mut::<Position>(bodies[any]) {
                        *position = if random(20) == 0 { Position(Vector::NAN) } else { place.0 };
                    }
                    if is_step {
                        app.world_mut()
                            .resource_mut::<Time>()
                            .advance_by(core::time::Duration::from_millis(16));
                        app.update();
                    }
                }
            }
            bodies.retain(|body| app.world().get_entity(*body).is_ok());
            let followed = app.world_mut().run_system_cached(all_along_x).expect("it runs");
            let shared = app.world().resource::<SharedKnown>().0.clone();
            shared.write().unwrap_or_else(PoisonError::into_inner).progress = None;
            let found = app.world_mut().run_system_cached(all_along_x).expect("it runs");
            assert_eq!(followed, found, "turn {turn}");
            seen += found.len();
        }
        assert!(seen > 1500, "{seen} hits");
    }
}
