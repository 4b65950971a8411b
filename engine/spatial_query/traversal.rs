//! Searches of all colliders: colliders in the tables, and colliders that changed since the last step.

use bevy_ecs::prelude::*;
use kernel::{
    bvh::Trees,
    math::{Scalar, WorldPose, WorldVector},
    query::{Hit, Nearest, Ray, ShapeCast, sort_hits, visit_near, visit_touching},
    shape::{Aabb, Shape},
};

use super::recent::Recent;
use crate::{
    collision::collider::CollisionLayers,
    dynamics::tables::Colliders,
    physics_transform::{Position, Rotation, pose_from_kernel},
};

/// A collider near the path of a search.
#[derive(Clone, Copy)]
pub(super) struct Candidate<'a> {
    pub(super) entity: Entity,
    /// The id of the collider, or a number above all ids if it has none. Orders hits at the same distance.
    pub(super) order: u32,
    pub(super) shape: &'a Shape,
    pub(super) pose: WorldPose,
    pub(super) layers: CollisionLayers,
}

impl Candidate<'_> {
    /// The pose in the types of the components.
    pub(super) fn components(&self) -> (Position, Rotation) {
        pose_from_kernel(self.pose)
    }
}

/// A hit of an entity.
#[derive(Clone, Copy, Debug)]
pub(super) struct Found<T> {
    pub(super) entity: Entity,
    order: u32,
    distance: Scalar,
    pub(super) data: T,
}

impl<T> Found<T> {
    pub(super) fn new(of: &Candidate, distance: Scalar, data: T) -> Self {
        Self { entity: of.entity, order: of.order, distance, data }
    }
}

impl<T: Copy> Hit for Found<T> {
    fn distance(&self) -> Scalar {
        self.distance
    }

    fn collider(&self) -> u32 {
        self.order
    }
}

/// All present colliders.
pub(super) struct Scene<'a> {
    pub(super) tables: &'a Colliders,
    pub(super) recent: &'a Recent,
}

impl Scene<'_> {
    fn of_id(&self, id: u32) -> Option<Candidate<'_>> {
        if self.recent.replaced.contains(id) {
            return None;
        }
        let def = &self.tables.table[id].def;
        Some(Candidate {
            entity: self.tables.entities[id as usize],
            order: id,
            shape: &def.shape,
            pose: self.tables.table.poses[id as usize],
            layers: CollisionLayers::from_bits(def.layers.memberships, def.layers.filters),
        })
    }

    fn of_recent(&self, place: u32) -> Option<Candidate<'_>> {
        self.recent.collider(place).map(|collider| Candidate {
            entity: collider.entity,
            order: collider.order(),
            shape: &collider.shape,
            pose: collider.pose,
            layers: collider.layers,
        })
    }

    /// Visits both trees in one walk. `visit` returns the new limit.
    fn both(
        &self,
        limit: Scalar,
        walk: impl Fn(&Trees, &mut dyn FnMut(u32, Scalar) -> Scalar),
        mut visit: impl FnMut(&Candidate, Scalar) -> Scalar,
    ) {
        let mut least = limit;
        let narrow = |given: Scalar, limit: Scalar| if given < limit { given } else { limit };
        walk(&self.tables.trees.trees, &mut |id, limit| {
            if let Some(candidate) = self.of_id(id) {
                least = narrow(visit(&candidate, narrow(least, limit)), least);
            }
            least
        });
        walk(&self.recent.trees, &mut |place, limit| {
            if let Some(candidate) = self.of_recent(place) {
                least = narrow(visit(&candidate, narrow(least, limit)), least);
            }
            least
        });
    }

    /// The colliders near a ray.
    pub(super) fn along_ray(&self, ray: &Ray, visit: impl FnMut(&Candidate, Scalar) -> Scalar) {
        self.both(ray.max_distance(), |trees, visit| ray.visit(trees, visit), visit);
    }

    /// The colliders near a cast shape.
    pub(super) fn along_cast(&self, cast: &ShapeCast, visit: impl FnMut(&Candidate, Scalar) -> Scalar) {
        self.both(cast.max_distance(), |trees, visit| cast.visit(trees, visit), visit);
    }

    /// The colliders by the distance of their boxes from a point.
    pub(super) fn near(&self, point: WorldVector, visit: impl FnMut(&Candidate, Scalar) -> Scalar) {
        self.both(Scalar::MAX, |trees, visit| visit_near(trees, point, Scalar::MAX, visit), visit);
    }

    /// The colliders whose boxes may touch a box and that pass a test, in order.
    pub(super) fn touching(&self, aabb: &Aabb, mut test: impl FnMut(&Candidate) -> bool) -> Vec<Entity> {
        let mut found = Vec::new();
        let mut note = |candidate: &Candidate| {
            if test(candidate) {
                found.push((candidate.order, candidate.entity));
            }
        };
        visit_touching(&self.tables.trees.trees, aabb, |id| {
            self.of_id(id).iter().for_each(&mut note);
            true
        });
        visit_touching(&self.recent.trees, aabb, |place| {
            self.of_recent(place).iter().for_each(&mut note);
            true
        });
        found.sort_unstable();
        found.into_iter().map(|(_, entity)| entity).collect()
    }
}

/// Visits candidates, and tests each within a limit.
pub(super) trait Walk<T> {
    /// Visits candidates. `visit` gets a candidate and the present limit, and returns the new limit.
    fn walk(&self, visit: &mut dyn FnMut(&Candidate, Scalar) -> Scalar);
    /// The hit of a candidate within a limit.
    fn hit(&self, candidate: &Candidate, limit: Scalar) -> Option<Found<T>>;
}

/// The nearest hit.
pub(super) fn nearest<T: Copy>(walk: &impl Walk<T>, predicate: &dyn Fn(Entity) -> bool) -> Option<Found<T>> {
    let mut nearest = Nearest::default();
    walk.walk(&mut |candidate, limit| {
        let hit = walk.hit(candidate, limit).filter(|hit| predicate(hit.entity));
        nearest.offer(hit, limit)
    });
    nearest.best()
}

/// All hits, nearest first.
pub(super) fn all<T: Copy>(walk: &impl Walk<T>, predicate: &dyn Fn(Entity) -> bool) -> Vec<Found<T>> {
    let mut hits = Vec::new();
    walk.walk(&mut |candidate, limit| {
        hits.extend(walk.hit(candidate, limit).filter(|hit| predicate(hit.entity)));
        limit
    });
    sort_hits(&mut hits);
    hits
}

/// The nearest hits, at most `max`.
pub(super) fn some<T: Copy>(
    walk: &impl Walk<T>,
    max: u32,
    predicate: &dyn Fn(Entity) -> bool,
) -> Vec<Found<T>> {
    match max {
        0 => Vec::new(),
        1 => nearest(walk, predicate).into_iter().collect(),
        max => {
            let mut hits = all(walk, predicate);
            hits.truncate(max as usize);
            hits
        }
    }
}
