//! The point nearest to a given one that is above all given planes.
//!
//! Planes are taken one after the other, as in R. Seidel, "Small-dimensional linear programming and convex
//! hulls made easy" (1991). The nearest point is kept until it is below a plane. The new point then lies on
//! that plane, so that it is the same problem with the planes before, in one dimension less.

use crate::math::{DIM, Scalar, Vector};

/// Planes that meet at less than this angle, in radians, have no common line: its position is below the
/// precision of f32.
const PARALLEL: Scalar = 1.0e-5;

/// The half-space of points `x` with `normal · x >= offset`. The normal has unit length.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plane {
    pub(super) normal: Vector,
    pub(super) offset: Scalar,
}

impl Plane {
    /// A plane through zero.
    pub(super) fn facing(normal: Vector) -> Self {
        Self { normal, offset: 0.0 }
    }
}

/// Adds a plane through zero to planes that a velocity must not point into. Of planes whose normals have a
/// dot product above `similarity`, only the one that the velocity points into most is kept: the intersection
/// line of nearly parallel planes is noise.
pub(super) fn add_facing(planes: &mut Vec<Plane>, normal: Vector, velocity: Vector, similarity: Scalar) {
    match planes.iter_mut().find(|plane| plane.normal.dot(normal) > similarity) {
        Some(plane) if normal.dot(velocity) < plane.normal.dot(velocity) => plane.normal = normal,
        Some(_) => {}
        None => planes.push(Plane::facing(normal)),
    }
}

/// The intersection of several planes, as orthogonal planes with the same intersection.
#[derive(Clone, Copy, Default)]
struct Flat {
    planes: [Option<Plane>; DIM],
}

impl Flat {
    /// The part of a plane's normal along the flat, and the offset along this part.
    fn reduced(&self, plane: Plane) -> (Vector, Scalar) {
        let Plane { mut normal, mut offset } = plane;
        // The second round removes the rounding errors of the first.
        for _ in 0..2 {
            for own in self.planes.iter().flatten() {
                let share = normal.dot(own.normal);
                normal -= own.normal * share;
                offset -= own.offset * share;
            }
        }
        (normal, offset)
    }

    /// The intersection with one more plane; `None` if the plane is parallel.
    fn with(mut self, plane: Plane) -> Option<Self> {
        let (normal, offset) = self.reduced(plane);
        let length = normal.length();
        let free = self.planes.iter_mut().find(|plane| plane.is_none())?;
        *free = (length > PARALLEL).then(|| Plane { normal: normal / length, offset: offset / length });
        free.is_some().then_some(self)
    }

    /// The nearest point of the flat.
    fn nearest(&self, from: Vector) -> Vector {
        let mut x = from;
        for _ in 0..2 {
            for own in self.planes.iter().flatten() {
                x += own.normal * (own.offset - x.dot(own.normal));
            }
        }
        x
    }
}

/// The longest displacement out of an overlap, as a multiple of its depth, as in a wedge of 11 degrees. A
/// larger value moves a shape metres along two walls that are nearly parallel; a smaller one leaves it in
/// sharp corners.
const LONGEST: Scalar = 10.0;

/// The shortest displacement that moves a shape above all planes, and whether it does. Without enough room it
/// leads to the middle.
pub(super) fn way_out(planes: &[Plane], tolerance: Scalar) -> (Vector, bool) {
    let deepest = planes.iter().map(|plane| plane.offset).fold(0.0, Scalar::max);
    let out = nearest(planes, Vector::ZERO, tolerance).filter(|way| way.length() <= LONGEST * deepest);
    out.map_or_else(|| (compromise(planes), false), |way| (way, true))
}

/// The point nearest to `from` that is above all planes, or below them by at most `tolerance`. `None` if
/// there is none.
pub(super) fn nearest(planes: &[Plane], from: Vector, tolerance: Scalar) -> Option<Vector> {
    nearest_on(Flat::default(), planes, from, tolerance)
}

fn nearest_on(flat: Flat, planes: &[Plane], from: Vector, tolerance: Scalar) -> Option<Vector> {
    let mut x = flat.nearest(from);
    for (i, plane) in planes.iter().enumerate() {
        if plane.normal.dot(x) - plane.offset < -tolerance {
            x = nearest_on(flat.with(*plane)?, &planes[..i], from, tolerance)?;
        }
    }
    Some(x)
}

/// The rounds of [`compromise`]. Each leaves at most `1 - 1 / planes` of the difference between
/// parallel planes.
const ROUNDS: usize = 64;

/// The point with the least sum of squared depths below planes that have no common point: midway between two
/// that face each other.
fn compromise(planes: &[Plane]) -> Vector {
    let mut x = Vector::ZERO;
    let share = 1.0 / planes.len().max(1) as Scalar;
    for _ in 0..ROUNDS {
        let below = |plane: &Plane| plane.normal * (plane.offset - plane.normal.dot(x)).max(0.0);
        x += planes.iter().map(below).sum::<Vector>() * share;
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plane(normal: Vector, offset: Scalar) -> Plane {
        Plane { normal, offset }
    }

    #[test]
    fn a_corner_is_the_nearest_point_of_its_planes() {
        let planes = [plane(Vector::X, 1.0), plane(Vector::Y, 2.0)];
        let x = nearest(&planes, Vector::ZERO, 1.0e-6).expect("they meet");
        assert!((x - Vector::X - Vector::Y * 2.0).length() < 1.0e-6, "{x}");
        assert_eq!(nearest(&planes, Vector::ONE * 3.0, 0.0), Some(Vector::ONE * 3.0));
    }

    #[test]
    fn planes_without_a_common_point_are_missed_by_the_same_depth() {
        let planes = [plane(Vector::X, 1.0), plane(-Vector::X, 0.0), plane(Vector::Y, 0.5)];
        assert_eq!(nearest(&planes, Vector::ZERO, 1.0e-6), None);
        let (x, is_out) = way_out(&planes, 1.0e-6);
        assert!(!is_out);
        assert!((x - Vector::X * 0.5 - Vector::Y * 0.5).length() < 1.0e-4, "{x}");
    }

    #[test]
    fn the_way_out_of_a_narrow_wedge_is_short() {
        for (tilt, is_wide) in [(0.4 as Scalar, true), (0.01, false)] {
            let planes = [plane(Vector::X, 0.01), plane((Vector::Y * tilt - Vector::X).normalize(), 0.01)];
            let (way, is_out) = way_out(&planes, 1.0e-6);
            assert_eq!(is_out, is_wide);
            assert!(way.length() < 0.1, "{way}");
        }
    }
}
