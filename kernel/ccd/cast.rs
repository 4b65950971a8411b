//! The time of impact of two moving shapes, by conservative [advancement](crate::distance::advance()).
//!
//! A manifold's normal and least separation describe a slab between the shapes. Time advances by the least
//! time that the shapes need to cross the slab, until they are at the target distance.

use super::path::Path;
use crate::contact::ManifoldSource;
use crate::distance::{Approach, advance};
use crate::manifold::{self, CompositeBuffers, FeatureCache, LocalManifold, ManifoldQuery};
use crate::math::{Pose, Vector, WorldPose, max, min};
use crate::shape::{Ball, Shape};
use crate::tuning::sweeps::{CORE_SHARE, MET, ROUNDS, VIEW};

/// The radii of the balls that are cast if the shapes touch already, as shares of the largest ball within the
/// shape. The first ball that does not touch at the start of the step decides.
const BALLS: [f32; 3] = [CORE_SHARE, MET, 0.0];

/// A collider that takes part in a cast.
#[derive(Clone, Copy, Debug)]
pub(super) struct Side<'a> {
    pub(super) collider: u32,
    pub(super) shape: &'a Shape,
    /// The frame of the shape in the body's frame.
    pub(super) local: Pose,
    /// The motion of the body. A collider without a body uses its own pose as the body's pose.
    pub(super) path: Path,
    /// Maximum distance between a normal of the surface and the centre of mass.
    pub(super) arm: f32,
}

impl Side<'_> {
    pub(super) fn pose(&self, fraction: f32) -> WorldPose {
        self.path.frame(fraction).then(&self.local)
    }

    /// The distance from a point of the shape to the centre of mass.
    fn arm_of(&self, point: Vector) -> f32 {
        (self.local.transform(point) - self.path.local_center).length()
    }

    /// Maximum distance that rotation moves the surface along its normals, or a point with this arm.
    fn turning(&self, arm: f32) -> f32 {
        arm * self.path.spin.length()
    }
}

/// The geometry of a moving collider that is cast.
#[derive(Clone, Copy, Debug)]
pub(super) enum Caster {
    /// The shape.
    Whole,
    /// A ball within the shape: its centre in the shape's frame, and its radius.
    Ball(Vector, f32),
}

/// The result of a cast.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Cast {
    /// The shapes do not meet.
    Miss,
    /// The shapes are already too close at the start of the step.
    Touching,
    /// They meet after this fraction of the step.
    Hit(f32),
}

/// The remaining motion.
#[derive(Clone, Copy)]
struct Rest {
    /// The displacement of the moving shape relative to the other shape.
    way: Vector,
    /// Maximum distance that rotation may close in addition, plus a margin, in metres.
    turning: f32,
}

/// Buffers of a cast, kept for their memory.
#[derive(Clone, Debug, Default)]
pub(super) struct CastBuffers {
    found: Vec<LocalManifold>,
    parts: CompositeBuffers,
}

/// Two colliders, one cast against the other.
#[derive(Clone, Copy)]
pub(super) struct Pair<'a> {
    pub(super) source: &'a dyn ManifoldSource,
    pub(super) moving: Side<'a>,
    pub(super) other: Side<'a>,
    /// The sum of the collision margins.
    pub(super) margin: f32,
    /// The distance at which the shapes have met, after subtracting the margins.
    pub(super) target: f32,
    /// The distance from the body's centre of mass to the farthest point of the moving shape.
    pub(super) extent: f32,
}

impl Pair<'_> {
    /// Casts the moving collider, or a ball within it.
    pub(super) fn cast(&self, caster: Caster, buffers: &mut CastBuffers) -> Cast {
        // A ball touches only at a smaller distance than it stops at, so a ball that stopped is not free to
        // go on in the next step.
        let (arm, touching) = match caster {
            Caster::Whole => (self.moving.arm, self.target),
            Caster::Ball(center, _) => (self.moving.arm_of(center), MET * self.target),
        };
        let way = self.moving.path.way - self.other.path.way;
        let turning = self.moving.turning(arm) + self.other.turning(self.other.arm);
        let fastest = way.length() + turning;
        if !(fastest > 0.0) {
            return Cast::Miss;
        }
        let cast = advance(0.0, ROUNDS, |fraction, round| {
            // A NaN is a miss.
            if !(fraction < 1.0) {
                return None;
            }
            let other = self.other.pose(fraction);
            let left = 1.0 - fraction;
            let rest = Rest { way: way * left, turning: left * turning + 2.0 * self.target };
            let gap = self.find_manifolds(caster, &other, fraction, rest, buffers);
            let mut apart = gap / fastest;
            for local in &buffers.found {
                let (gap, normal) = (local.lower_bound() - self.margin, other.rotation.rotate(local.normal));
                if round == 1 && gap <= touching {
                    return Some(Approach::Met(Cast::Touching));
                }
                let rate = turning - way.dot(normal);
                if !(rate > 0.0) {
                    continue;
                }
                if gap <= self.target {
                    return Some(Approach::Met(Cast::Hit(fraction)));
                }
                // Half of the target distance is kept, so the shapes stop apart.
                let left = gap - 0.5 * self.target;
                apart = min(apart, left / rate);
            }
            let later = fraction + max(apart, 0.5 * self.target / fastest);
            // Shapes that are still apart after the last round count as a hit: the body stops early rather
            // than passes through.
            let is_hit = round == ROUNDS && later < 1.0;
            Some(if is_hit { Approach::Met(Cast::Hit(later)) } else { Approach::ApartUntil(later) })
        });
        cast.unwrap_or(Cast::Miss)
    }

    /// The fraction of the step at which a ball within the moving shape meets the other shape; 1 if it does
    /// not meet it.
    pub(super) fn pass(&self, center: Vector, core: f32, buffers: &mut CastBuffers) -> f32 {
        let pair = Self { margin: 0.0, ..*self };
        for share in BALLS {
            match pair.cast(Caster::Ball(center, share * core), buffers) {
                Cast::Touching => {}
                Cast::Miss => return 1.0,
                Cast::Hit(fraction) => return fraction,
            }
        }
        1.0
    }

    /// Finds the manifolds after a fraction of the step, up to the distance that the remaining motion may
    /// close. Returns a lower bound of the distance to all geometry without a manifold.
    fn find_manifolds(
        &self,
        caster: Caster,
        other: &WorldPose,
        fraction: f32,
        rest: Rest,
        buffers: &mut CastBuffers,
    ) -> f32 {
        let distance = rest.way.length() + rest.turning;
        let CastBuffers { found, parts } = buffers;
        let [a, b] = [&self.other, &self.moving];
        found.clear();
        let reach = distance + self.margin;
        let near = min(distance, VIEW * self.extent + self.target) + self.margin;
        let is_foreign = |shape: &Shape| matches!(shape, Shape::Foreign(_));
        let is_composite = |shape: &Shape| matches!(shape, Shape::Composite(_));
        let motion = other.rotation.inverse_rotate(rest.way);
        let query = ManifoldQuery { motion, ..ManifoldQuery::up_to(rest.turning + self.margin) };
        let ball;
        let (shape, pose) = match caster {
            Caster::Whole => (b.shape, b.pose(fraction)),
            Caster::Ball(center, radius) => {
                ball = Shape::Ball(Ball { radius });
                (&ball, WorldPose { position: b.pose(fraction).transform(center), rotation: other.rotation })
            }
        };
        let pose = other.relative(&pose);
        if is_foreign(a.shape) || is_foreign(shape) {
            match caster {
                Caster::Whole => {
                    self.source.manifolds([a.collider, b.collider], &pose, near, found);
                }
                Caster::Ball(_, radius) => {
                    self.source.ball_manifolds(a.collider, pose.position, radius, near, found);
                }
            }
            return near - self.margin;
        }
        if is_composite(a.shape) || is_composite(shape) {
            manifold::collide_each_part(a.shape, shape, &pose, query, parts, found);
            return f32::INFINITY;
        }
        let mut local = LocalManifold::default();
        manifold::collide(a.shape, shape, &pose, reach, &mut FeatureCache::NONE.clone(), &mut local);
        // The search covers the whole remaining motion, so no other geometry can be met.
        found.extend((local.count > 0).then_some(local));
        f32::INFINITY
    }

    /// The gap between the shapes at the start of the step; negative if they overlap, infinite if it exceeds
    /// `distance`.
    pub(super) fn gap_at_start(&self, distance: f32, buffers: &mut CastBuffers) -> f32 {
        let rest = Rest { way: Vector::ZERO, turning: distance };
        self.find_manifolds(Caster::Whole, &self.other.pose(0.0), 0.0, rest, buffers);
        buffers.found.iter().map(|local| local.lower_bound() - self.margin).fold(f32::INFINITY, min)
    }

    /// The depth of overlap at the end of the step; 0 if the shapes do not overlap.
    pub(super) fn depth_at_end(&self, buffers: &mut CastBuffers) -> f32 {
        let rest = Rest { way: Vector::ZERO, turning: 0.0 };
        self.find_manifolds(Caster::Whole, &self.other.pose(1.0), 1.0, rest, buffers);
        let depths = buffers.found.iter().map(|local| self.margin - local.lower_bound());
        depths.fold(0.0, max)
    }
}
