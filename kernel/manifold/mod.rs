//! Contact manifolds: points with feature ids, from two shapes and their relative pose.
//!
//! Each pair of native shapes has one function without allocations. All functions work in the frame of shape
//! A, with the normal from A to B; the narrow phase transforms the result to the world. Points lie midway
//! between the two surfaces. Points have separations up to the prediction distance; points with a positive
//! separation are speculative contacts.
//!
//! This file has the types: `PairInput` and [`ManifoldQuery`] are the input, [`FeatureCache`] is kept from
//! step to step, [`LocalManifold`] is the result.

mod border;
mod composite;
#[cfg_attr(feature = "2d", path = "dim2/mod.rs")]
#[cfg_attr(feature = "3d", path = "dim3/mod.rs")]
mod dim;
mod pairs;
mod parts;
mod screen;
#[cfg(test)]
mod tests_pairs;

use crate::math::{MAX_POINTS, Pose, Vector, min};
pub use composite::{CompositeBuffers, collide_composite, collide_each_part};
use core::cell::Cell;
pub use dim::midstep_rims;
pub use pairs::collide;

/// Inputs of the function of a convex pair besides the shapes.
#[derive(Clone, Copy)]
pub(super) struct PairInput<'a> {
    /// The pose of B in A's frame.
    pub pose: &'a Pose,
    /// Points up to this distance are found, in metres.
    pub prediction: f32,
    /// The cache of the pair, from the last step and for the next step.
    pub cache: &'a Cell<FeatureCache>,
}

/// Inputs of a manifold computation besides the shapes: distance, motion, ground and groups.
#[derive(Clone, Copy, Debug)]
pub struct ManifoldQuery<'a> {
    /// Points up to this distance are found, in metres.
    pub prediction: f32,
    /// Motion of B relative to A until the end of the step, in A's frame. Parts that may be passed by are
    /// swept to their time of impact.
    pub motion: Vector,
    /// Parts farther away than this may be passed by. Nearer parts count as met, or may be met by turning.
    pub met: f32,
    /// Whether A and B are ground: not dynamic. Ground is never inside a dynamic shape.
    pub ground: [bool; 2],
    /// The group of each facet of A and of B; facets beyond the list have 0. Manifolds of different groups
    /// are not merged.
    pub groups: [&'a [u8]; 2],
}

impl<'a> ManifoldQuery<'a> {
    /// All facets of both shapes in one group.
    pub const ALIKE: [&'static [u8]; 2] = [&[]; 2];

    /// A query up to a distance, without motion.
    pub fn up_to(prediction: f32) -> Self {
        Self { prediction, motion: Vector::ZERO, met: f32::INFINITY, ground: [false; 2], groups: Self::ALIKE }
    }

    /// The query with A and B swapped. `pose` is B's pose in A's frame.
    pub(super) fn swapped(&self, pose: &Pose) -> Self {
        let ([own, other], [a, b]) = (self.ground, self.groups);
        let motion = pose.rotation.inverse_rotate(-self.motion);
        Self { motion, ground: [other, own], groups: [b, a], ..*self }
    }

    /// The group of a part of one side.
    pub(super) fn group(&self, side: usize, part: u32) -> u8 {
        self.groups[side].get(part as usize).copied().unwrap_or(0)
    }
}

/// The separating axis or reference feature of a pair's last manifold: eight bytes in its contact.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FeatureCache {
    /// The kind of axis: 0 is none; the function of the pair numbers the other kinds.
    pub kind: u8,
    /// A feature of shape A.
    pub a: u8,
    /// A feature of shape B.
    pub b: u8,
    /// The separation along that axis when it was found, in metres.
    pub separation: f32,
}

impl FeatureCache {
    /// An empty cache.
    pub const NONE: Self = Self { kind: 0, a: 0, b: 0, separation: 0.0 };
}

/// One contact point in the frame of shape A.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LocalPoint {
    /// Midway between the two surfaces, in metres.
    pub point: Vector,
    /// The distance between the surfaces along the normal; negative where they overlap.
    pub separation: f32,
    /// Id of the features of both shapes at this point; equal in the next step if the features are equal.
    pub feature: u32,
    /// The distance by which [`ManifoldQuery::motion`] closes the shapes along
    /// the normal until they meet here, in metres; 0 if they are near now. If not 0, the point is the meeting
    /// point, moved back with the moving shape. If both shapes move, it moves back with the shape that is not
    /// composite, or with B, and lies half of the distance above this shape.
    pub closing: f32,
}

impl LocalPoint {
    /// A point of shapes that are near at the present pose.
    pub fn new(point: Vector, separation: f32, feature: u32) -> Self {
        Self { point, separation, feature, closing: 0.0 }
    }
}

/// The contact of two convex shapes in the frame of shape A.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LocalManifold {
    /// The unit normal from A to B.
    pub normal: Vector,
    /// The points; the first `count` are valid.
    pub points: [LocalPoint; MAX_POINTS],
    /// The number of points, 0 if the shapes are farther apart than the prediction distance.
    pub count: usize,
    /// A lower bound of the distance of shapes without points, in metres; 0 if it is not known.
    pub gap: f32,
    /// The depth of each surface's core (centre, axis, centre of curvature) behind the surface, in metres.
    pub radii: [f32; 2],
    /// The groups of the facets of A and B, see [`ManifoldQuery::groups`]; 0
    /// without groups.
    pub groups: [u8; 2],
}

impl LocalManifold {
    /// The valid points.
    pub fn points(&self) -> &[LocalPoint] {
        &self.points[..self.count]
    }

    /// The valid points, to change.
    pub(super) fn points_mut(&mut self) -> impl Iterator<Item = &mut LocalPoint> {
        self.points[..self.count].iter_mut()
    }

    /// Whether the motion has to bring the shapes together at some of the points.
    pub fn is_met_later(&self) -> bool {
        self.points().iter().any(|p| p.closing != 0.0)
    }

    /// A lower bound of the distance between the shapes, in metres.
    pub fn lower_bound(&self) -> f32 {
        match self.points() {
            [] => self.gap,
            points => points.iter().fold(f32::INFINITY, |least, p| min(least, p.separation)),
        }
    }

    /// Moves points that are met later onto the moving shape, if the other shape is ground. This makes the
    /// moving shape's arms exact.
    pub(super) fn place_on_mover(&mut self, ground: [bool; 2]) {
        let side = match ground {
            [true, false] => 1.0,
            [false, true] => -1.0,
            _ => return,
        };
        let half = self.normal * (0.5 * side);
        self.points_mut().for_each(|p| p.point += half * p.closing);
    }

    /// Adds a point of shapes that are near at the present pose.
    pub fn push(&mut self, point: Vector, separation: f32, feature: u32) {
        self.add(LocalPoint::new(point, separation, feature));
    }

    /// Adds a point. Points beyond `MAX_POINTS` are dropped: functions that find more reduce first.
    pub fn add(&mut self, point: LocalPoint) {
        debug_assert!(self.count < MAX_POINTS, "a manifold is reduced before it is filled");
        if self.count < MAX_POINTS {
            self.points[self.count] = point;
            self.count += 1;
        }
    }

    /// The same contact in B's frame, with the normal from B to A. This manifold is in A's frame; `pose` is
    /// B's pose there.
    pub fn flipped(&self, pose: &Pose) -> Self {
        let mut out = *self;
        out.normal = pose.rotation.inverse_rotate(-self.normal);
        out.radii = [self.radii[1], self.radii[0]];
        out.groups = [self.groups[1], self.groups[0]];
        out.points_mut().for_each(|p| p.point = pose.inverse_transform(p.point));
        out
    }
}
