//! Rules out facets far from a shape, four at a time, by slabs along a few directions.
//!
//! The directions are the axes of the composite, the axes of the other shape's own box, and the normal of
//! each facet. The remaining facets are collided; see [`composite`](super::composite).

use super::dim::facing;
use crate::math::{DIM, F32x4, Lane, Num, Pose, Rot, Vector};
use crate::shape::{Aabb, Shape, Surface};

/// The number of facets side by side.
pub(super) const LANES: usize = 4;

/// The extents of a shape and its motion, for comparison with facets.
pub(super) struct Screen {
    slabs: [Slab; 2 * DIM],
    /// The origin of the shape's frame. Facets are taken relative to this origin, so that rounding is small
    /// for near facets.
    origin: Vector<F32x4>,
    /// The box of the shape's core: its centre from the origin, and its half axes.
    center: Vector<F32x4>,
    halves: [Vector<F32x4>; DIM],
    /// The radius around the core.
    radius: F32x4,
    motion: Vector<F32x4>,
}

/// The extent of the shape along a direction.
#[derive(Clone, Copy)]
struct Slab {
    axis: Vector<F32x4>,
    low: F32x4,
    high: F32x4,
    /// The motion of the shape along the direction, and against it (negative).
    forth: F32x4,
    back: F32x4,
}

/// Lower bounds of the distances between four facets and the shape, in metres; negative if unknown.
pub(super) struct Gaps {
    /// At the shape's pose.
    pub(super) now: F32x4,
    /// At any time of the motion.
    pub(super) ever: F32x4,
}

impl Screen {
    /// A shape at a pose in the composite's frame, with its box there, and its motion.
    pub(super) fn new(shape: &Shape, pose: &Pose, around: &Aabb, motion: Vector) -> Self {
        let (own, axes) = (shape.local_aabb(Rot::IDENTITY), pose.rotation.axes());
        let slab = |axis: Vector, low: f32, high: f32| {
            let along = F32x4::splat(axis.dot(motion));
            Slab {
                axis: Vector::splat(axis),
                low: F32x4::splat(low),
                high: F32x4::splat(high),
                forth: along.max(F32x4::ZERO),
                back: along.min(F32x4::ZERO),
            }
        };
        let (low, high) = (around.min - pose.position, around.max - pose.position);
        let slabs = core::array::from_fn(|k| match k.checked_sub(DIM) {
            None => slab(Vector::AXES[k], low.to_array()[k], high.to_array()[k]),
            Some(i) => slab(axes[i], own.min.to_array()[i], own.max.to_array()[i]),
        });
        let radius = shape.radius();
        let half = (own.half() - Vector::ONE * radius).to_array();
        Self {
            slabs,
            origin: Vector::splat(pose.position),
            center: Vector::splat(pose.rotation.rotate(own.center())),
            halves: core::array::from_fn(|i| Vector::splat(axes[i] * half[i])),
            radius: F32x4::splat(radius),
            motion: Vector::splat(motion),
        }
    }

    /// Bounds of the distances to up to four facets of a surface; the last facet is repeated.
    pub(super) fn gaps(&self, surface: &Surface, facets: &[u32]) -> Gaps {
        let mut corners = [Vector::<F32x4>::ZERO; DIM];
        for lane in 0..LANES {
            let facet = facets[lane.min(facets.len() - 1)];
            for (corner, at) in corners.iter_mut().zip(surface.corners(facet)) {
                corner.set(lane, at);
            }
        }
        corners.iter_mut().for_each(|corner| *corner -= self.origin);
        let mut gaps = self.gaps_of_planes(&corners);
        for slab in &self.slabs {
            let heights = corners.map(|corner| slab.axis.dot(corner));
            let lowest = heights[1..].iter().fold(heights[0], |low, h| h.min(low));
            let highest = heights[1..].iter().fold(heights[0], |high, h| h.max(high));
            let (above, below) = (lowest - slab.high, slab.low - highest);
            gaps.now = above.max(below).max(gaps.now);
            gaps.ever = (above - slab.forth).max(below + slab.back).max(gaps.ever);
        }
        gaps
    }

    /// Bounds of the distances to the planes of four facets.
    fn gaps_of_planes(&self, corners: &[Vector<F32x4>; DIM]) -> Gaps {
        let normal = facing(corners);
        let length = normal.length();
        let size = |v: F32x4| v.max(-v);
        let height = normal.dot(self.center - corners[0]);
        let reach = self.halves.iter().fold(self.radius * length, |sum, half| sum + size(normal.dot(*half)));
        let above = F32x4::ZERO.lt(height);
        let along = normal.dot(self.motion);
        let closing = F32x4::select(above, -along, along).max(F32x4::ZERO);
        let now = size(height) - reach;
        // Without area there is no plane.
        let is_plane = F32x4::ZERO.lt(length);
        let or_unknown = |gap: F32x4| F32x4::select(is_plane, gap / length, -F32x4::ONE);
        Gaps { now: or_unknown(now), ever: or_unknown(now - closing) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::distance::{Accuracy, Convex, Frame, closest_cores};
    use crate::shape::{Ball, Capsule, Cuboid, Facet};
    use proptest::prelude::*;

    fn vector(v: [f32; 3]) -> Vector {
        Vector::from_array(core::array::from_fn(|i| v[i]))
    }

    fn point(size: f32) -> impl Strategy<Value = Vector> {
        [-size..size, -size..size, -size..size].prop_map(vector)
    }

    /// The distance of a shape from a facet, 0 where they overlap.
    fn distance(corners: [Vector; DIM], shape: &Shape, pose: &Pose) -> f32 {
        let facet = Shape::from(Facet::from(corners));
        let [a, b] = [&facet, shape].map(|shape| Convex::of(shape).expect("convex"));
        let accuracy = Accuracy { tolerance: 1.0e-6, beyond: f64::INFINITY };
        let cores =
            closest_cores(&a, &b, &Frame::from(pose), Vector::ZERO.widen(), accuracy).expect("finite");
        (cores.distance as f32 - b.radius).max(0.0)
    }

    proptest! {
        #[test]
        fn gaps_are_no_larger_than_distances(
            corners in prop::array::uniform12(point(3.0)),
            (size, radius) in (point(1.0), 0.1..1.0f32),
            (at, axes, motion) in (point(4.0), [point(2.0), point(2.0)], point(3.0)),
            share in 0.0..1.0f32,
        ) {
            let half = size.abs() + Vector::ONE * 0.1;
            let shapes = [
                Shape::Ball(Ball { radius }),
                Shape::Capsule(Capsule { a: -half, b: half * 0.5, radius }),
                Shape::Cuboid(Cuboid { half }),
            ];
            let facets: Vec<[u32; DIM]> =
                (0..4).map(|i| core::array::from_fn(|k| (DIM * i + k) as u32)).collect();
            let surface = Surface::new(corners.to_vec(), facets).expect("a surface");
            let pose = Pose::new(at, Rot::IDENTITY.turned_by(axes[0].cross(axes[1])));
            let there = Pose { position: pose.position + motion * share, ..pose };
            for shape in &shapes {
                let gaps = Screen::new(shape, &pose, &shape.local_box(&pose), motion).gaps(&surface, &[0, 1, 2, 3]);
                for facet in 0..4 {
                    let at = surface.corners(facet as u32);
                    let [now, then] = [&pose, &there].map(|pose| distance(at, shape, pose));
                    prop_assert!(gaps.now.get(facet) <= now + 1.0e-5, "{shape:?}: {now}");
                    prop_assert!(gaps.ever.get(facet) <= then + 1.0e-5, "{shape:?}: {then}");
                }
            }
        }

        #[test]
        fn facets_far_from_a_ball_are_ruled_out(away in 2.0..50.0f32, step in 0.0..1.0f32) {
            let corners = Vector::AXES.map(|axis| Vector::X + axis * 3.0).to_vec();
            let surface = Surface::new(corners, vec![core::array::from_fn(|k| k as u32)]).expect("a surface");
            let ball = Shape::Ball(Ball { radius: 0.5 });
            let pose = Pose::new(Vector::X * -away, Rot::IDENTITY);
            let gaps = Screen::new(&ball, &pose, &ball.local_box(&pose), Vector::X * step).gaps(&surface, &[0]);
            prop_assert!(gaps.now.get(0) > away - 0.51 && gaps.ever.get(0) > away - 0.51 - step);
        }
    }
}
