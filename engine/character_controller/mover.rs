//! A shape among the colliders: the parts that it touches, how far it can move, and how it gets out of
//! overlaps.
//!
//! A shape keeps a distance from colliders, its skin. The skin has a slack: a shape at the distance of the
//! skin moves along a surface with rounding errors, and sweeps must not stop at these errors. So a sweep
//! stops slightly inside the skin, and a shape touches up to slightly more than the skin.

use bevy_ecs::prelude::*;

use super::planes::{Plane, way_out};
use crate::{
    collision::collider::Collider,
    math::{AsF32, Dir, RotationValue, Scalar, Vector},
    spatial_query::{NearPart, ShapeCastConfig, SpatialQuery, SpatialQueryFilter},
};

/// The slack, as a share of the skin. A larger value keeps the distance less precisely; a smaller one stops
/// at rounding errors.
const SLACK: Scalar = 0.02;

/// The minimum slack of a thin skin, in lengths of a metre.
const LEAST_SLACK: Scalar = 1.0e-5;

/// Normals with a smaller difference count as equal. A larger value lets the edges of tiles lift a shape that
/// moves over them; a smaller one needs more tests of edges.
const SAME_NORMAL: Scalar = 3.0e-4;

/// Of the parts of one collider whose normals have a larger dot product, only the nearest counts: the cosine
/// of 2.5 degrees. A sweep finds the others. A larger value tests edges of facets that are all alike; a
/// smaller one stops at facets that are found late.
const SIMILAR_PART: Scalar = 0.999_048_2;

/// The minimum component along `up` of the normal of an edge that carries a character, and of a normal along
/// which recovery lifts it out of an overlap.
pub(super) const EDGE: Scalar = 0.05;

/// If the dot product of normals is less than this, the shape is stopped by something other than the tested
/// edge: the cosine of 10 degrees.
const SIMILAR_NORMAL: Scalar = 0.984_807_7;

/// The minimum rate at which a shape approaches an obstacle, as a share of its speed, when the shape is moved
/// back from it.
const LEAST_RATE: Scalar = 1.0e-3;

fn is_same(a: Vector, b: Vector) -> bool {
    (a - b).length_squared() < SAME_NORMAL * SAME_NORMAL
}

/// A shape that moves without turning.
pub(super) struct Mover<'a> {
    pub(super) queries: &'a SpatialQuery<'a, 'a>,
    /// Whether a collider stops the shape.
    pub(super) is_solid: &'a dyn Fn(Entity) -> bool,
    /// Colliders that the shape passes by.
    pub(super) ignored: Vec<Entity>,
    pub(super) shape: &'a Collider,
    pub(super) rotation: RotationValue,
    pub(super) filter: &'a SpatialQueryFilter,
    /// The skin in metres, as all lengths here.
    pub(super) skin: Scalar,
    /// The length of a metre.
    pub(super) unit: Scalar,
}

/// The first collider that a moving shape hits.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sweep {
    pub(super) part: NearPart,
    /// The movement until the part is at the distance of the skin.
    pub(super) distance: Scalar,
    /// The movement until the shapes themselves touch, if the part is a plane.
    pub(super) collision_distance: Scalar,
}

/// Settings for moving a shape out of overlaps.
#[derive(Clone, Copy, Debug)]
pub(super) struct Recovery {
    pub(super) rounds: usize,
    /// The overlap that may be left.
    pub(super) error: Scalar,
    /// Deeper overlaps are left unresolved.
    pub(super) deepest: Scalar,
    /// Walls do not lift the shape along this direction.
    pub(super) up: Vector,
}

impl Recovery {
    /// The direction in which a part pushes.
    fn push_of(&self, normal: Vector) -> Vector {
        let rise = normal.dot(self.up);
        if rise == 0.0 || rise.abs() > EDGE { normal } else { (normal - self.up * rise).normalize_or_zero() }
    }
}

impl Mover<'_> {
    /// The slack of the skin: sweeps ignore overlaps with the skin up to this depth, and parts up to this
    /// distance beyond the skin are touched.
    pub(super) fn slack(&self) -> Scalar {
        (SLACK * self.skin).max(LEAST_SLACK * self.unit)
    }

    fn takes(&self, entity: Entity) -> bool {
        (self.is_solid)(entity) && !self.ignored.contains(&entity)
    }

    /// The first hit of a movement. A part that is within the skin at the start is no hit if the movement
    /// leads along it or away from it.
    pub(super) fn sweep(&self, position: Vector, movement: Vector) -> Option<Sweep> {
        self.sweep_at(position, movement, &|_| true)
    }

    fn sweep_at(
        &self,
        position: Vector,
        movement: Vector,
        predicate: &dyn Fn(Entity) -> bool,
    ) -> Option<Sweep> {
        let direction = Dir::new(movement.f32()).ok()?;
        let length = movement.length();
        let slack = self.slack();
        let target = (self.skin - slack).max(0.0);
        let config = ShapeCastConfig {
            max_distance: length,
            target_distance: target,
            ignore_origin_penetration: true,
            compute_contact_on_penetration: true,
        };
        let takes = |entity| self.takes(entity) && predicate(entity);
        let (shape, rotation) = (self.shape, self.rotation);
        let hit = self.queries.cast_shape_predicate(
            shape,
            position,
            rotation,
            direction,
            &config,
            self.filter,
            &takes,
        )?;
        let normal = hit.normal1;
        let rate = (-normal.dot(movement) / length).max(LEAST_RATE);
        let gap = if hit.distance > 0.0 { target } else { (hit.point2 - hit.point1).dot(normal) };
        let points = [hit.point1, hit.point2];
        Some(Sweep {
            part: NearPart { entity: hit.entity, points, normal, distance: gap },
            distance: (hit.distance - (self.skin - target) / rate).max(0.0),
            collision_distance: if gap > 0.0 { hit.distance + gap / rate } else { 0.0 },
        })
    }

    /// The parts that the shape touches, nearest first, and one more part that stopped it. Edges between
    /// flush parts are left out.
    pub(super) fn touching(&self, position: Vector, stopped_by: Option<NearPart>) -> Vec<NearPart> {
        let mut near = self.near(position, self.skin + self.slack());
        near.sort_by(|a, b| a.distance.total_cmp(&b.distance));
        let mut parts: Vec<NearPart> = Vec::new();
        for part in near {
            let stands_for_it =
                |p: &NearPart| p.entity == part.entity && p.normal.dot(part.normal) > SIMILAR_PART;
            if !parts.iter().any(stands_for_it) {
                parts.push(part);
            }
        }
        if let Some(hit) = stopped_by {
            let is_it = |part: &NearPart| part.entity == hit.entity && is_same(part.normal, hit.normal);
            if !parts.iter().any(is_it) {
                parts.push(hit);
                parts.sort_by(|a, b| a.distance.total_cmp(&b.distance));
            }
        }
        let mut i = 0;
        while i < parts.len() {
            let is_inner =
                |(j, other): (usize, &NearPart)| j != i && self.is_inner_edge(position, &parts[i], other);
            if parts.iter().enumerate().any(is_inner) {
                parts.remove(i);
            } else {
                i += 1;
            }
        }
        parts
    }

    /// The parts within a distance. Of parts of one collider with about the same normal, only the nearest.
    pub(super) fn near(&self, position: Vector, reach: Scalar) -> Vec<NearPart> {
        let takes = |entity| self.takes(entity);
        let mut parts: Vec<NearPart> = Vec::new();
        for part in self.queries.near_parts(self.shape, (position, self.rotation), reach, self.filter, &takes)
        {
            let is_it = |p: &&mut NearPart| p.entity == part.entity && is_same(p.normal, part.normal);
            match parts.iter_mut().find(is_it) {
                Some(known) if part.distance < known.distance => *known = part,
                Some(_) => {}
                None => parts.push(part),
            }
        }
        parts
    }

    /// Whether the shape has room: no part is nearer than the skin.
    pub(super) fn fits(&self, position: Vector) -> bool {
        let least = self.skin - self.slack();
        position.is_finite() && self.near(position, self.skin).iter().all(|part| part.distance >= least)
    }

    /// Whether a part is touched at an edge that is flush with the plane of another: the shape moves over the
    /// edge along that plane.
    ///
    /// The union of both parts has no such edge. Each of two parts with about the same normal may seem flush
    /// with the plane of the other. So the test moves the shape far enough that a part rising from the plane
    /// by the angle between the normals would stop it.
    fn is_inner_edge(&self, position: Vector, edge: &NearPart, plane: &NearPart) -> bool {
        let cosine = edge.normal.dot(plane.normal);
        let height = (edge.points[0] - plane.points[0]).dot(plane.normal);
        let into = plane.normal * cosine - edge.normal;
        let sine = into.length();
        if !(cosine > 0.0 && sine > SAME_NORMAL && height <= self.slack()) {
            return false;
        }
        let start = position + plane.normal * (self.skin - plane.distance).max(0.0);
        let way = into / sine * (2.0 * self.skin).max(4.0 * self.slack() / sine);
        let is_it = |entity| entity == edge.entity;
        let met = self.sweep_at(start, way, &is_it);
        met.is_none_or(|hit| hit.part.normal.dot(edge.normal) < SIMILAR_NORMAL)
    }

    /// The shortest displacement that moves the shape and its skin out of overlaps.
    ///
    /// The deepest overlap is resolved first, and then overlaps are found again: a box that sank into tiles
    /// and is now above one of them does not overlap the adjacent ones any more. Between two walls that lean
    /// outward, the only way out may be a long one upward; so walls do not lift along `up`. `share` gives the
    /// fraction of an overlap with a part that the shape resolves.
    pub(super) fn recovery(
        &self,
        position: Vector,
        how: &Recovery,
        share: &dyn Fn(&NearPart) -> Scalar,
    ) -> Vector {
        let error = how.error.min(0.5 * self.slack());
        let mut planes: Vec<Plane> = Vec::new();
        let mut way = Vector::ZERO;
        for _ in 0..how.rounds {
            let parts = self.near(position + way, self.skin);
            let overlaps = parts.iter().filter(|part| part.distance >= -how.deepest).filter_map(|part| {
                let (normal, share) = (how.push_of(part.normal), share(part));
                let gone = way.dot(normal);
                let offset = share * (gone + self.skin - part.distance);
                (share > 0.0).then_some((gone - offset, Plane { normal, offset }))
            });
            let deepest = overlaps.min_by(|a, b| a.0.total_cmp(&b.0));
            let Some((_, plane)) = deepest.filter(|(gap, _)| *gap < -error) else { break };
            planes.push(plane);
            let (out, is_out) = way_out(&planes, 0.1 * error);
            way = out;
            if !is_out {
                break;
            }
        }
        way
    }
}
