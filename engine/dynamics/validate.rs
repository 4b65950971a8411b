//! Checks at the end of every step that tables and components agree, with the feature `validate`. The checks
//! scan all tables.

use bevy_app::App;
use bevy_ecs::{entity_disabling::Disabled, prelude::*, system::SystemParam};
use kernel::{
    bvh::TreeKind,
    graph::ConstraintKind,
    table::{BodyKind, NONE},
};

use crate::{
    collision::collider::{Collider, ColliderDisabled, collider_hierarchy::ColliderOf, custom::CustomShape},
    dynamics::{
        drain::{kind_of, tree_of},
        ids::{BodyId, ColliderId},
        joints::{JointDisabled, dim::IsJoint, table::Joints},
        lifecycle::{IsComplete, LifecycleQueue},
        rigid_body::{RigidBody, RigidBodyDisabled, sleeping::Sleeping},
        sleep::SleepRequests,
        tables::Tables,
    },
    physics_transform::{Position, Rotation},
    schedule::{PhysicsSchedule, PhysicsStepSystems},
};

type BodyWorld<'a> = (
    Entity,
    &'a BodyId,
    Option<&'a RigidBody>,
    Has<RigidBodyDisabled>,
    Has<Disabled>,
    Has<Sleeping>,
    Option<&'a Position>,
);

type ColliderWorld<'a> = (
    Entity,
    &'a ColliderId,
    (Has<Collider>, Has<CustomShape>),
    Option<&'a ColliderOf>,
    Has<ColliderDisabled>,
    Has<Disabled>,
    Option<(&'a Position, &'a Rotation)>,
);

/// Queries of the checks.
#[derive(SystemParam)]
struct Audit<'w, 's> {
    bodies: Query<'w, 's, BodyWorld<'static>, Allow<Disabled>>,
    colliders: Query<'w, 's, ColliderWorld<'static>, Allow<Disabled>>,
    complete: Query<'w, 's, (), (IsComplete, Allow<Disabled>)>,
    queue: Res<'w, LifecycleQueue>,
    requests: Option<Res<'w, SleepRequests>>,
    known: Query<'w, 's, Entity, (IsJoint, Without<JointDisabled>)>,
    joints: Res<'w, Joints>,
    tables: Tables<'w>,
}

/// Adds the checks to the step.
pub(crate) fn install(app: &mut App) {
    app.add_systems(PhysicsSchedule, validate.in_set(PhysicsStepSystems::Last).ambiguous_with_all());
}

fn validate(mut audit: Audit) {
    audit.tables.contact_manager().validate();
    audit.check_bodies();
    audit.check_colliders();
    audit.check_trees();
    audit.check_joints();
}

impl Audit<'_, '_> {
    /// Checks that every id belongs to its entity, and that every entity that should be a simulated body is
    /// in the table with its type. Entities that changed since the queue was drained are skipped: the next
    /// step handles them.
    fn check_bodies(&self) {
        let bodies = &*self.tables.bodies;
        let mut found = 0;
        for (entity, id, body, body_disabled, disabled, sleeping, position) in &self.bodies {
            let id = id.0;
            if id != NONE {
                found += 1;
                assert!(bodies.table.ids.is_live(id), "{entity} has the body id {id}, which is not in use");
                assert_eq!(bodies.entities[id as usize], entity, "body {id} is another entity's");
            }
            if self.queue.bodies.contains(entity) {
                continue;
            }
            let placed =
                self.complete.contains(entity) && position.is_some_and(|p| *p != Position::PLACEHOLDER);
            let wanted = body.filter(|_| !body_disabled && !disabled && placed);
            assert_eq!(wanted.is_some(), id != NONE, "{entity} with {body:?} at {position:?} takes part");
            let Some(body) = wanted else { continue };
            let record = &bodies.table[id];
            assert_eq!(record.kind, kind_of(body), "{entity} is the body it says");
            if let Some(requests) = &self.requests
                && record.kind == BodyKind::Dynamic
                && !requests.concern(entity)
                && !bodies.table.flipped.contains(&id)
            {
                assert_eq!(sleeping, !record.awake, "{entity} says whether it sleeps");
            }
        }
        let lost = self.queue.lost_bodies.len();
        let live = bodies.table.ids.len();
        assert_eq!(live, found + lost, "{live} bodies, of {found} entities and {lost} that are gone");
        for id in bodies.table.awake_kinematic().chain(bodies.table.awake_dynamic()) {
            assert!(bodies.table.ids.is_live(id) && bodies.table[id].awake, "body {id} is listed awake");
        }
        if let Some(islands) = &self.tables.islands {
            for id in bodies.table.ids.iter() {
                let is_dynamic = bodies.table[id].kind == BodyKind::Dynamic;
                assert_eq!(islands.0.island_of(id).is_some(), is_dynamic, "dynamic bodies are in islands");
            }
        }
    }

    fn check_colliders(&self) {
        let colliders = &*self.tables.colliders;
        let mut found = 0;
        for (entity, id, (is_default, is_custom), of, collider_disabled, disabled, pose) in &self.colliders {
            let id = id.0;
            if id != NONE {
                found += 1;
                assert!(colliders.table.ids.is_live(id), "{entity} has the unused collider id {id}");
                assert_eq!(colliders.entities[id as usize], entity, "collider {id} is another entity's");
            }
            // A body that leaves queues its colliders in the next step.
            let is_of_queued = of.is_some_and(|of| self.queue.bodies.contains(of.body));
            if self.queue.colliders.contains(entity) || is_of_queued {
                continue;
            }
            let body = of.and_then(|of| self.bodies.get(of.body).ok());
            let placed = pose.is_some_and(|(p, _)| *p != Position::PLACEHOLDER)
                || body.is_some_and(|(_, body, ..)| body.0 != NONE);
            let refused = self.queue.refused.contains(&entity);
            let wanted = (is_default || is_custom) && !collider_disabled && !disabled && placed && !refused;
            assert_eq!(wanted, id != NONE, "{entity} with a collider takes part");
            if !wanted {
                continue;
            }
            let body = body.map_or(NONE, |(_, id, ..)| id.0);
            let held = colliders.table[id].def.body;
            let lost = self.queue.lost_bodies.contains(&held);
            assert!(held == body || lost, "{entity} is on body {held} instead of {body}");
        }
        let lost = self.queue.lost_colliders.len();
        let live = colliders.table.ids.len();
        assert_eq!(live, found + lost, "{live} colliders, of {found} entities and {lost} that are gone");
        let listed = self.tables.bodies.table.ids.iter().map(|body| {
            let of_body = colliders.table.of_body(body, &self.tables.bodies.table);
            of_body
                .filter(|c| colliders.table.ids.is_live(*c) && colliders.table[*c].def.body == body)
                .count()
        });
        let attached = colliders.table.ids.iter().filter(|c| colliders.table[*c].def.body != NONE).count();
        assert_eq!(listed.sum::<usize>(), attached, "bodies list their colliders");
    }

    /// Checks that joints in the kernel belong to entities, and hold the bodies that these entities name. A
    /// joint that is not in the kernel waits for a body that is not in the simulation, or was reported.
    /// Joints that changed since the queue was drained are skipped.
    fn check_joints(&self) {
        let (bodies, joints) = (&*self.tables.bodies, &*self.joints);
        let constraints = bodies.table.constraints(ConstraintKind::Joint);
        let mut count = 0;
        for (entity, record) in joints.iter() {
            let is_queued = joints.is_queued(entity);
            assert!(is_queued || self.known.contains(entity), "{entity} is a joint");
            let Some(held) = record.held else {
                let is_there = |body: &Entity| self.bodies.get(*body).is_ok_and(|(_, id, ..)| id.0 != NONE);
                let waits = record.told.is_some() || !record.bodies.iter().all(is_there);
                assert!(is_queued || waits, "{entity} waits for nothing");
                continue;
            };
            count += 1;
            assert!(constraints.is_live(held.id), "{entity} has the joint {}, which is not in use", held.id);
            assert_eq!(constraints.get(held.id).bodies, held.bodies, "{entity} holds these bodies");
            let entities = held.bodies.map(|body| bodies.entities[body as usize]);
            assert_eq!(entities, record.bodies, "{entity} holds the bodies that it says");
            let [a, b] = held.bodies;
            assert!(
                !held.is_apart || bodies.apart.contains(a, b),
                "{entity} keeps its bodies from colliding"
            );
        }
        assert_eq!(constraints.len(), count, "joints in the kernel are those of entities");
        for entity in &self.known {
            let is_known = joints.get(entity).is_some() || joints.is_queued(entity);
            assert!(is_known || !joints.is_watched, "{entity} is known");
        }
        for (_, contact) in self.tables.contacts.table.iter() {
            let [a, b] = contact.bodies;
            assert!(a == b || !bodies.apart.contains(a, b), "joints let bodies {a} and {b} pass");
        }
    }

    fn check_trees(&self) {
        let colliders = &*self.tables.colliders;
        let mut counts = [0; 4];
        for id in 0..colliders.table.ids.capacity() as u32 {
            let kind = colliders.trees.kind(id);
            if !colliders.table.ids.is_live(id) {
                assert_eq!(kind, None, "collider {id} is gone, but not from its tree");
                continue;
            }
            let expected = match colliders.table[id].def.body {
                NONE => TreeKind::Standalone,
                body => {
                    assert!(self.tables.bodies.table.ids.is_live(body), "collider {id} is on a body");
                    tree_of(self.tables.bodies.table[body].kind)
                }
            };
            assert_eq!(kind, Some(expected), "the tree of collider {id}");
            counts[expected as usize] += usize::from(!colliders.trees.is_new(id));
        }
        for kind in TreeKind::ALL {
            let tree = &colliders.trees.trees[kind];
            tree.validate();
            assert_eq!(tree.len(), counts[kind as usize], "leaves of the tree of {kind:?} colliders");
        }
    }
}
