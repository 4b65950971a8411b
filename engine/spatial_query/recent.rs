//! Colliders that differ from the tables: those that the app spawned, changed, moved or removed since the last step.
//!
//! The tables and trees follow components once per step. Until then a query leaves out the colliders that changed, and
//! looks at their components instead, through a tree of their own. What changed is known from the life-cycle queue, and
//! by a scan of change ticks, both only once in a run of a system, by its first query. Nothing is done where no system
//! asks.

use bevy_ecs::{change_detection::Tick, prelude::*, system::SystemChangeTick, system::SystemParam};
use kernel::{
    bvh::{TreeKind, Trees},
    data::BitSet,
    math::{Pose, WorldPose},
    shape::Shape,
    table::NONE,
};
use std::sync::{Arc, PoisonError, RwLock};

use crate::{
    collision::collider::{
        Collider, ColliderDisabled, CollisionLayers,
        collider_hierarchy::{ColliderOf, RigidBodyColliders},
        collider_transform::ColliderTransform,
    },
    dynamics::{
        drain::local_pose,
        ids::{BodyId, ColliderId},
        lifecycle::LifecycleQueue,
        quarantine::is_finite,
        rigid_body::{RigidBody, RigidBodyDisabled},
        tables::{Bodies, Colliders},
    },
    physics_transform::{Position, Rotation, said_pose, world_pose},
    scan::{IN_TABLES, Since},
};

/// A collider that differs from the tables.
#[derive(Clone, Debug)]
pub(super) struct RecentCollider {
    pub(super) entity: Entity,
    /// Its id in the tables, or [`NONE`].
    pub(super) id: u32,
    pub(super) shape: Shape,
    pub(super) pose: WorldPose,
    pub(super) layers: CollisionLayers,
}

/// All colliders that differ from the tables.
#[derive(Default)]
pub(super) struct Recent {
    /// Ids that the tables are wrong about.
    pub(super) replaced: BitSet,
    pub(super) colliders: Vec<RecentCollider>,
    /// A tree over the colliders, by index.
    pub(super) trees: Trees,
}

/// What changed, as a run of a system saw it.
#[derive(Default)]
pub(super) struct Kept(RwLock<Option<(Tick, Arc<Recent>)>>);

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
    kept: Local<'s, Kept>,
    tick: SystemChangeTick,
}

impl World<'_, '_> {
    /// What changed since the last step, computed by the first query of a run of a system.
    pub(super) fn recent(&self) -> Arc<Recent> {
        let now = self.tick.this_run();
        if let Some((tick, recent)) = &*self.kept.0.read().unwrap_or_else(PoisonError::into_inner)
            && *tick == now
        {
            return recent.clone();
        }
        let mut kept = self.kept.0.write().unwrap_or_else(PoisonError::into_inner);
        // Another thread may have been first.
        if let Some((tick, recent)) = &*kept
            && *tick == now
        {
            return recent.clone();
        }
        let recent = Arc::new(self.find());
        *kept = Some((now, recent.clone()));
        recent
    }

    /// The component of a collider.
    pub(super) fn component(&self, entity: Entity) -> Option<&Collider> {
        self.states.get(entity).ok().map(|state| state.0)
    }

    /// The body of a collider.
    pub(super) fn body_of(&self, collider: Entity) -> Option<Entity> {
        self.states.get(collider).ok()?.1.map(|of| of.body)
    }

    fn find(&self) -> Recent {
        let mut recent = Recent::default();
        for &id in &self.queue.lost_colliders {
            recent.replaced.insert(id);
        }
        let mut changed = self.changed();
        changed.sort_unstable();
        changed.dedup();
        let mut leaves = Vec::new();
        for entity in changed {
            let id = self.ids.get(entity).map_or(NONE, |id| id.0);
            let is_known = id != NONE && self.colliders.entities.get(id as usize) == Some(&entity);
            let id = if is_known { id } else { NONE };
            if is_known {
                recent.replaced.insert(id);
            }
            if let Some(collider) = self.read(entity, id) {
                leaves.push((recent.colliders.len() as u32, collider.shape.aabb(&collider.pose)));
                recent.colliders.push(collider);
            }
        }
        recent.trees[TreeKind::Standalone].insert_many(&leaves, &mut Vec::new());
        recent
    }

    /// A collider as its components are, if it takes part.
    fn read(&self, entity: Entity, id: u32) -> Option<RecentCollider> {
        let (collider, of, transform, own, layers, disabled) = self.states.get(entity).ok()?;
        if disabled {
            return None;
        }
        let body = of.and_then(|of| Some((of.body, self.frames.get(of.body).ok()?)));
        let pose = match (body, own) {
            (Some((body, (position, rotation, false))), _) if *position != Position::PLACEHOLDER => {
                let local = transform.filter(|_| body != entity).map_or(Pose::IDENTITY, local_pose);
                world_pose(position, rotation).then(&local)
            }
            (_, Some((position, rotation))) if *position != Position::PLACEHOLDER => {
                world_pose(position, rotation)
            }
            _ => return None,
        };
        is_finite(&pose).then(|| RecentCollider {
            entity,
            id,
            shape: collider.native().clone(),
            pose,
            layers: layers.copied().unwrap_or_default(),
        })
    }

    /// Entities of colliders that may differ from the tables. Some may be named twice.
    fn changed(&self) -> Vec<Entity> {
        let mut found: Vec<Entity> = self.queue.colliders.entities().collect();
        for body in self.queue.bodies.entities() {
            self.add_colliders_of(body, &mut found);
            if let Ok(id) = self.body_ids.get(body) {
                self.add_colliders_of_id(id.0, &mut found);
            }
        }
        for &id in &self.queue.lost_bodies {
            self.add_colliders_of_id(id, &mut found);
        }
        self.add_moved(&mut found);
        let drained = Since::new(self.queue.drained, self.tick);
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
        found.extend(self.queue.refused.iter().chain(&self.queue.detached).filter(has_moved));
        found
    }

    /// Adds the colliders of bodies whose pose is not that of the last step.
    fn add_moved(&self, found: &mut Vec<Entity>) {
        let written = Since::new(self.bodies.written, self.tick);
        let mut moved = Vec::new();
        for (entities, ids, position, rotation) in self.moved.contiguous_iter().expect(IN_TABLES) {
            let columns = [position.changed_ticks_slice(), rotation.changed_ticks_slice()];
            written.rows(columns, |row| moved.push((entities[row], ids[row].0)));
        }
        for (entity, id) in moved {
            let Ok((position, rotation, _)) = self.frames.get(entity) else { continue };
            let seen = self.bodies.seen.get(id as usize).filter(|_| id != NONE);
            if seen != Some(&said_pose(position, rotation)) {
                self.add_colliders_of(entity, found);
            }
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
