//! Contacts of the kernel in the public format, built when they are read.

use bevy_ecs::prelude::*;
use kernel::{
    contact::{Contact, ContactFlags, Manifold, ManifoldPoint, ManifoldSurface},
    math as k,
    table::{BodyKind, NONE, Velocity},
};
use std::sync::OnceLock;

use super::{
    contact_graph::ContactGraph,
    dim::{ContactManifold, tangent_impulse},
    feature_id::PackedFeatureId,
    pair::{ContactEdge, ContactEdgeFlags, ContactId, ContactPair, ContactPairFlags},
    point::ContactPoint,
};
use crate::{
    asked::Asked,
    dynamics::tables::{Bodies, Colliders, Contacts},
    math::{AdjustPrecision, Scalar, to_f32, vector_from_kernel, vector_to_kernel, world_from_kernel},
};

/// The contacts that were read since contacts last changed.
///
/// Readers share the tables, so each contact is built once, by its first reader. Without reads nothing is
/// allocated.
#[derive(Resource, Default)]
pub(crate) struct ContactViews {
    /// By contact id.
    pairs: OnceLock<Box<[OnceLock<Box<ContactPair>>]>>,
    graph: OnceLock<Box<ContactGraph>>,
    /// Whether any system ever read contacts.
    asked: Asked,
}

/// Drops the contacts that were read. Piped behind each system that changes contacts, so that no system of
/// the app reads in between.
pub(crate) fn forget_views(mut views: ResMut<ContactViews>) {
    views.bypass_change_detection().forget();
}

/// The tables from which contacts are built.
#[derive(Clone, Copy)]
pub(crate) struct Source<'a> {
    pub(crate) bodies: &'a Bodies,
    pub(crate) colliders: &'a Colliders,
    pub(crate) contacts: &'a Contacts,
    /// The number of substeps.
    pub(crate) substeps: u32,
}

impl ContactViews {
    /// Drops the contacts that were read.
    pub(crate) fn forget(&mut self) {
        if self.pairs.get().is_some() || self.graph.get().is_some() {
            (self.pairs, self.graph) = Default::default();
        }
    }

    /// Records that a system reads contacts: from the next step on, impulses are summed over the substeps.
    pub(crate) fn note_reader(&self) {
        self.asked.note();
    }

    /// Whether any system ever read contacts.
    pub(crate) fn has_readers(&self) -> bool {
        self.asked.is_set()
    }

    /// A contact in use.
    pub(super) fn pair(&self, id: u32, source: Source) -> &ContactPair {
        let capacity = source.contacts.table.capacity();
        let pairs = self.pairs.get_or_init(|| (0..capacity).map(|_| OnceLock::new()).collect());
        pairs[id as usize].get_or_init(|| Box::new(source.pair(id)))
    }

    /// All contacts.
    pub(crate) fn graph(&self, source: Source) -> &ContactGraph {
        self.graph.get_or_init(|| {
            let mut graph = ContactGraph::default();
            for (id, _) in source.contacts.table.iter() {
                graph.push(source.edge(id), self.pair(id, source).clone());
            }
            Box::new(graph)
        })
    }
}

impl<'a> Source<'a> {
    /// The contact of two colliders, if they touch.
    pub(super) fn find(self, entity1: Entity, entity2: Entity) -> Option<u32> {
        let [a, b] = [self.colliders.find(entity1)?, self.colliders.find(entity2)?];
        self.contacts.table.find(a, b).filter(|id| self.is_touching(*id))
    }

    /// Whether the colliders of a contact touch.
    pub(super) fn is_touching(self, id: u32) -> bool {
        self.contacts.touches(id)
    }

    /// The contacts of a collider that touch, by id.
    pub(super) fn touching(self, entity: Entity) -> Vec<u32> {
        let Some(collider) = self.colliders.find(entity) else { return Vec::new() };
        let all = self.contacts.table.of_collider(collider, &self.colliders.table);
        let mut ids: Vec<u32> = all.filter(|id| self.is_touching(*id)).collect();
        ids.sort_unstable();
        ids
    }

    /// Both colliders of a contact.
    pub(super) fn entities(self, id: u32) -> [Entity; 2] {
        self.contacts.table.get(id).colliders.map(|collider| self.colliders.entities[collider as usize])
    }

    fn kind(self, body: u32) -> Option<BodyKind> {
        (body != NONE).then(|| self.bodies.table[body].kind)
    }

    fn body_entities(self, contact: &Contact) -> [Option<Entity>; 2] {
        contact.bodies.map(|body| (body != NONE).then(|| self.bodies.entities[body as usize]))
    }

    /// The contact without its manifolds.
    fn edge(self, id: u32) -> ContactEdge {
        let contact = self.contacts.table.get(id);
        let [collider1, collider2] = self.entities(id);
        let [body1, body2] = self.body_entities(contact);
        let can_sleep = contact.bodies.iter().any(|body| self.kind(*body) == Some(BodyKind::Dynamic));
        let sleeps = can_sleep && !self.contacts.table.is_active(id);
        let reports = contact.colliders.iter().any(|collider| self.colliders.reporting.contains(*collider));
        let mut flags = ContactEdgeFlags::empty();
        flags.set(ContactEdgeFlags::TOUCHING, self.is_touching(id));
        flags.set(ContactEdgeFlags::SLEEPING, sleeps);
        flags.set(ContactEdgeFlags::CONTACT_EVENTS, reports);
        ContactEdge { id: ContactId(id), collider1, collider2, body1, body2, pair_index: 0, flags }
    }

    /// The contact with its manifolds.
    pub(crate) fn pair(self, id: u32) -> ContactPair {
        let table = &self.contacts.table;
        let contact = table.get(id);
        let [collider1, collider2] = self.entities(id);
        let [body1, body2] = self.body_entities(contact);
        let all = core::iter::once(&contact.manifold).chain(table.extra_of(contact)).enumerate();
        let shown = all.filter(|(_, m)| m.count > 0).map(|(index, m)| {
            let mut shown = self.manifold(contact, m);
            if contact.flags.has(ContactFlags::CHANGED)
                && let Some(surface) = table.changed_surface(id, index as u32)
            {
                shown.friction = surface.friction.adjust_precision();
                shown.restitution = surface.restitution.adjust_precision();
                shown.set_surface_velocity(vector_from_kernel(surface.velocity));
            }
            shown
        });
        let manifolds = shown.collect();
        let flags = self.pair_flags(id, contact);
        ContactPair { contact_id: ContactId(id), collider1, collider2, body1, body2, manifolds, flags }
    }

    fn pair_flags(self, id: u32, contact: &Contact) -> ContactPairFlags {
        let responds = !contact.is_inert();
        let started = self.contacts.started(id);
        let [a, b] = contact.bodies.map(|body| self.kind(body) == Some(BodyKind::Static));
        let mut flags = ContactPairFlags::empty();
        flags.set(ContactPairFlags::TOUCHING, self.is_touching(id));
        flags.set(ContactPairFlags::DISJOINT_AABB, contact.flags.has(ContactFlags::SEPARATED));
        flags.set(ContactPairFlags::STARTED_TOUCHING, started);
        flags.set(ContactPairFlags::STOPPED_TOUCHING, self.contacts.parted.contains(id));
        flags.set(ContactPairFlags::GENERATE_CONSTRAINTS, responds);
        flags.set(ContactPairFlags::STARTED_GENERATING_CONSTRAINTS, responds && started);
        flags.set(ContactPairFlags::STATIC1, a);
        flags.set(ContactPairFlags::STATIC2, b);
        let is_hooked = |collider: &u32| self.colliders.modifying.contains(*collider);
        flags.set(ContactPairFlags::MODIFY_CONTACTS, contact.colliders.iter().any(is_hooked));
        flags
    }

    fn manifold(self, contact: &Contact, manifold: &Manifold) -> ContactManifold {
        let [a, b] = [0, 1].map(|side| self.center(contact, side));
        let offset = (b - a).to_local();
        let velocities = contact.bodies.map(|body| match body {
            NONE => Velocity::default(),
            body => self.bodies.table.velocities[body as usize],
        });
        let share = 1.0 / f32::from(manifold.count);
        let friction = tangent_impulse(manifold.normal, manifold.friction_impulse * share);
        let points = manifold.points().iter().map(|p| ContactPoint {
            warm_start_tangent_impulse: friction,
            ..self.point(a, offset, velocities, manifold.normal, p)
        });
        let surface = manifold.surface(contact, &self.colliders.table);
        let mut shown = ContactManifold::new(points, vector_from_kernel(manifold.normal));
        shown.friction = surface.friction.adjust_precision();
        shown.restitution = surface.restitution.adjust_precision();
        shown.set_surface_velocity(vector_from_kernel(surface.velocity));
        shown
    }

    /// The centre of mass of a side's body, or the position of a collider without a body.
    fn center(self, contact: &Contact, side: usize) -> k::WorldVector {
        match contact.bodies[side] {
            NONE => self.colliders.table.poses[contact.colliders[side] as usize].position,
            body => self.bodies.table.poses[body as usize].center,
        }
    }

    /// A point without friction.
    fn point(
        self,
        center: k::WorldVector,
        offset: k::Vector,
        [a, b]: [Velocity; 2],
        normal: k::Vector,
        p: &ManifoldPoint,
    ) -> ContactPoint {
        let anchors = [p.anchor, p.anchor - offset];
        let parting = b.linear + b.angular.cross(anchors[1]) - a.linear - a.angular.cross(anchors[0]);
        let [anchor1, anchor2] = anchors.map(vector_from_kernel);
        let impulse = p.impulse.adjust_precision();
        // Sums are kept only after a system first read contacts.
        let total = if p.total_impulse > 0.0 {
            p.total_impulse.adjust_precision()
        } else {
            impulse * self.substeps as Scalar
        };
        let point = ContactPoint {
            normal_impulse: total,
            normal_speed: normal.dot(parting).adjust_precision(),
            warm_start_normal_impulse: impulse,
            ..ContactPoint::new(
                anchor1,
                anchor2,
                world_from_kernel(center) + anchor1,
                (-p.separation).adjust_precision(),
            )
        };
        point.with_feature_ids(PackedFeatureId(p.feature), PackedFeatureId::UNKNOWN)
    }
}

/// Contacts changed by hooks, converted for the kernel.
impl Source<'_> {
    /// The manifolds of a pair that was built from this contact.
    pub(crate) fn manifolds_to_kernel(self, id: u32, pair: &ContactPair) -> Vec<(Manifold, ManifoldSurface)> {
        let contact = self.contacts.table.get(id);
        let old = || core::iter::once(&contact.manifold).chain(self.contacts.table.extra_of(contact));
        let is_solved = pair.flags.contains(ContactPairFlags::GENERATE_CONSTRAINTS);
        let convert = |manifold: &ContactManifold| {
            let normal = vector_to_kernel(manifold.normal);
            // Data that the app cannot see comes from the old manifold with the most similar normal.
            let like = |m: &&Manifold| m.normal.dot(normal);
            let from = old().filter(|m| m.count > 0).max_by(|a, b| like(a).total_cmp(&like(b)));
            let mut to = Manifold { normal, count: 0, ..from.copied().unwrap_or_default() };
            to.is_internal |= !is_solved;
            for (point, slot) in manifold.points.iter().zip(&mut to.points) {
                let separation = -to_f32(point.penetration);
                *slot = ManifoldPoint {
                    anchor: vector_to_kernel(point.anchor1),
                    frozen_separation: separation,
                    separation,
                    impulse: to_f32(point.warm_start_normal_impulse),
                    total_impulse: to_f32(point.normal_impulse),
                    feature: point.feature_id1.0,
                };
                to.count += 1;
            }
            let surface = ManifoldSurface {
                friction: to_f32(manifold.friction),
                restitution: to_f32(manifold.restitution),
                velocity: vector_to_kernel(manifold.surface_velocity()),
            };
            (to, surface)
        };
        pair.manifolds.iter().map(convert).collect()
    }
}
