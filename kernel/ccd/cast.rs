//! When two moving shapes meet, by conservative [advancement](crate::distance::advance()).
//!
//! A manifold's normal and least separation are a slab between the shapes. Time advances by what the slab takes to be
//! crossed at least, until the shapes are as near as they may come.

use super::path::Path;
use crate::contact::ManifoldSource;
use crate::distance::{Approach, advance};
use crate::manifold::{self, CompositeBuffers, FeatureCache, LocalManifold, Look};
use crate::math::{Pose, Vector, WorldPose, max, min};
use crate::shape::{Ball, Shape};
use crate::tuning::sweeps::{MET, ROUNDS, VIEW};

/// A collider that takes part in a cast.
#[derive(Clone, Copy, Debug)]
pub(super) struct Side<'a> {
    pub(super) collider: u32,
    pub(super) shape: &'a Shape,
    /// The shape's frame in the body's.
    pub(super) local: Pose,
    /// The body's motion; a collider without a body has its own pose as that of a body.
    pub(super) path: Path,
    /// How far normals of the shape pass from the centre of mass at most.
    pub(super) arm: f32,
}

impl Side<'_> {
    pub(super) fn pose(&self, fraction: f32) -> WorldPose {
        self.path.frame(fraction).then(&self.local)
    }

    /// How far turning moves the surface along its normals at most.
    fn turning(&self) -> f32 {
        self.arm * self.path.spin.length()
    }
}

/// What of a moving collider is cast.
#[derive(Clone, Copy, Debug)]
pub(super) enum Caster {
    /// The shape.
    Whole,
    /// A ball within it: its place in the shape's frame, and its radius.
    Ball(Vector, f32),
}

/// How a cast ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Cast {
    /// The shapes do not meet.
    Miss,
    /// They are too near when the step begins.
    Touching,
    /// They meet after this fraction of the step.
    Hit(f32),
}

/// The rest of a motion.
#[derive(Clone, Copy)]
struct Rest {
    /// The way of the moving shape against the other.
    way: Vector,
    /// How far turning may close as well, with some room, in metres.
    turning: f32,
}

/// Buffers of a cast, kept for their memory.
#[derive(Clone, Debug, Default)]
pub(super) struct CastBuffers {
    found: Vec<LocalManifold>,
    parts: CompositeBuffers,
}

/// Two colliders, one cast against the other.
pub(super) struct Pair<'a> {
    pub(super) source: &'a dyn ManifoldSource,
    pub(super) moving: Side<'a>,
    pub(super) other: Side<'a>,
    /// The sum of the collision margins.
    pub(super) margin: f32,
    /// As near as the shapes may come, margins subtracted.
    pub(super) target: f32,
    /// How far the moving shape reaches.
    pub(super) extent: f32,
}

impl Pair<'_> {
    /// Casts the moving collider, or a ball within it.
    pub(super) fn cast(&self, caster: Caster, buffers: &mut CastBuffers) -> Cast {
        // Balls that stopped are not free to go on in the next step.
        let (way, turning, touching) = match caster {
            Caster::Whole => (self.moving.path.way, self.moving.turning(), self.target),
            Caster::Ball(center, _) => (self.chord(center), 0.0, MET * self.target),
        };
        let (way, turning) = (way - self.other.path.way, turning + self.other.turning());
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
            let gap = self.look(caster, &other, fraction, rest, buffers);
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
                // So that the shapes stop apart.
                let left = gap - 0.5 * self.target;
                apart = min(apart, left / rate);
            }
            let later = fraction + max(apart, 0.5 * self.target / fastest);
            // What is still apart after the last look counts as a hit: it stops early rather than passes.
            let is_hit = round == ROUNDS && later < 1.0;
            Some(if is_hit { Approach::Met(Cast::Hit(later)) } else { Approach::ApartUntil(later) })
        });
        cast.unwrap_or(Cast::Miss)
    }

    /// The way of a point of the moving shape over the step.
    fn chord(&self, point: Vector) -> Vector {
        let [start, end] = [0.0, 1.0].map(|fraction| self.moving.pose(fraction).transform(point));
        (end - start).to_local()
    }

    /// Finds the manifolds after a fraction of the step, as far as the rest of the motion may close. Returns a lower bound of
    /// the distance to all else that may be met.
    fn look(
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
        let look = Look { motion, ..Look::up_to(rest.turning + self.margin) };
        let ball;
        let (shape, pose) = match caster {
            Caster::Whole => (b.shape, b.pose(fraction)),
            Caster::Ball(center, radius) => {
                let mut position = b.pose(0.0).transform(center);
                position += (self.chord(center) * fraction).to_world();
                ball = Shape::Ball(Ball { radius });
                (&ball, WorldPose { position, rotation: other.rotation })
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
            manifold::collide_each_part(a.shape, shape, &pose, look, parts, found);
            return f32::INFINITY;
        }
        let mut local = LocalManifold::default();
        manifold::collide(a.shape, shape, &pose, reach, &mut FeatureCache::NONE.clone(), &mut local);
        // Beyond the distance there is nothing that may be met.
        found.extend((local.count > 0).then_some(local));
        f32::INFINITY
    }

    /// The gap between the shapes when the step begins, negative where they overlap; infinite if it is wider than a distance.
    pub(super) fn gap_at_start(&self, distance: f32, buffers: &mut CastBuffers) -> f32 {
        let rest = Rest { way: Vector::ZERO, turning: distance };
        self.look(Caster::Whole, &self.other.pose(0.0), 0.0, rest, buffers);
        buffers.found.iter().map(|local| local.lower_bound() - self.margin).fold(f32::INFINITY, min)
    }

    /// How far the shapes overlap when the step ends; 0 if they do not.
    pub(super) fn depth_at_end(&self, buffers: &mut CastBuffers) -> f32 {
        let rest = Rest { way: Vector::ZERO, turning: 0.0 };
        self.look(Caster::Whole, &self.other.pose(1.0), 1.0, rest, buffers);
        let depths = buffers.found.iter().map(|local| self.margin - local.lower_bound());
        depths.fold(0.0, max)
    }
}
