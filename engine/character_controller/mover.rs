//! A shape among the colliders: what it touches, how far it can move, and how it gets out of
//! what it overlaps.
//!
//! A shape keeps a distance from colliders, its skin. The skin has a slack: a shape that stands at the
//! distance of the skin moves along a surface with rounding errors, and sweeps must not stop at those. So a
//! sweep stops short of the skin, and a shape is touching up to a little more than the skin.

use bevy_ecs::prelude::*;

use super::planes::{Plane, way_out};
use crate::{
    collision::collider::Collider,
    math::{AsF32, Dir, RotationValue, Scalar, Vector},
    spatial_query::{NearPart, ShapeCastConfig, SpatialQuery, SpatialQueryFilter},
};

/// The slack, as a share of the skin. More keeps a worse distance; less stops at rounding errors.
const SLACK: Scalar = 0.02;

/// The least slack of a thin skin, in lengths of a metre.
const LEAST_SLACK: Scalar = 1.0e-5;

/// Normals with a smaller difference are one. More lets the edges of tiles lift what runs over them; less
/// asks more about edges.
const SAME_NORMAL: Scalar = 3.0e-4;

/// Of the parts of one collider whose normals have a greater dot product, the nearest stands for all: the
/// cosine of 2.5 degrees. A sweep finds the others. More stops at facets that are found late; less asks about
/// edges of facets that are all alike.
const SIMILAR_PART: Scalar = 0.999_048_2;

/// The least share of `up` in the normal of an edge that carries a character, and of what lifts it out
/// of an overlap.
pub(super) const EDGE: Scalar = 0.05;

/// What stops a shape is not the edge that is asked about if its normal is farther from it than this: the
/// cosine of 10 degrees.
const SIMILAR_NORMAL: Scalar = 0.984_807_7;

/// The least rate at which a shape closes with what stops it, as a share of its speed, in the
/// pull-back from it.
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
    /// In metres, as all lengths here.
    pub(super) skin: Scalar,
    /// The length of a metre.
    pub(super) unit: Scalar,
}

/// The first collider on the way of a shape.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sweep {
    pub(super) part: NearPart,
    /// The way to where the part is at the distance of the skin.
    pub(super) distance: Scalar,
    /// The way to where the shapes themselves meet, if the part is a plane.
    pub(super) collision_distance: Scalar,
}

/// How a shape gets out of what it overlaps.
#[derive(Clone, Copy, Debug)]
pub(super) struct Recovery {
    pub(super) rounds: usize,
    /// What may be left.
    pub(super) error: Scalar,
    /// Deeper overlaps stay.
    pub(super) deepest: Scalar,
    /// Walls do not lift along this.
    pub(super) up: Vector,
}

impl Recovery {
    /// The normal that a part pushes along.
    fn push_of(&self, normal: Vector) -> Vector {
        let rise = normal.dot(self.up);
        if rise == 0.0 || rise.abs() > EDGE { normal } else { (normal - self.up * rise).normalize_or_zero() }
    }
}

impl Mover<'_> {
    /// How much less than the skin is no hit of a sweep, and how much more is a touch.
    pub(super) fn slack(&self) -> Scalar {
        (SLACK * self.skin).max(LEAST_SLACK * self.unit)
    }

    fn takes(&self, entity: Entity) -> bool {
        (self.is_solid)(entity) && !self.ignored.contains(&entity)
    }

    /// The first hit on the way. What the shape is within the skin of is no hit if the way leads along
    /// it or off it.
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

    /// The parts that the shape touches, nearest first, and one more that stopped it. Edges between parts
    /// that are flush are none.
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

    /// The parts within a distance, one of each collider with about the same normal: the nearest.
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

    /// Whether the shape has room: nothing is nearer than its skin.
    pub(super) fn fits(&self, position: Vector) -> bool {
        let least = self.skin - self.slack();
        position.is_finite() && self.near(position, self.skin).iter().all(|part| part.distance >= least)
    }

    /// Whether a part is met at an edge that is flush with the plane of another: the shape moves over it
    /// along that plane.
    ///
    /// The union of both has no such edge there. Each of two parts with about the same normal may seem flush
    /// with the plane of the other. So the shape moves so far that a part which rises from the plane by the
    /// angle of the normals stops it.
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

    /// The shortest way out of what the shape overlaps with its skin, as a displacement.
    ///
    /// The deepest overlap is solved first, and looked at again: a box that sank into tiles is no longer in
    /// those beside when it is above one. Between two walls that lean apart there may be no way but a long
    /// one up: along `up` walls do not lift. `share` gives the fraction of an overlap with a part that the
    /// shape resolves.
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
