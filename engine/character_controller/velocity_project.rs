//! Projection of a velocity so that it points into none of several planes.

use super::planes::{Plane, nearest};
use crate::math::{AdjustPrecision, DIM, Dir, Scalar, Vector, VectorF32};

/// The share of a velocity that may point into a plane: the rounding errors of normals.
const TOLERANCE: Scalar = 2.0e-6;

/// The velocity nearest to `v` that points into none of the planes with the given outward normals. Zero if
/// there is no other, or if a component of `v` is infinite or NaN.
///
/// So a velocity slides along one plane or along the line of two planes, and stops in a corner of three.
///
/// ```
/// # use avian::{character_controller::move_and_slide::project_velocity, math::*};
/// let v = project_velocity(Vector::X * 3.0 - Vector::Y, &[Dir::Y]);
/// assert_eq!(v, Vector::X * 3.0);
/// assert_eq!(project_velocity(v, &[Dir::Y, Dir::NEG_X]), Vector::ZERO);
/// ```
#[must_use]
pub fn project_velocity(v: Vector, normals: &[Dir]) -> Vector {
    let planes: Vec<Plane> = normals.iter().map(|n| Plane { normal: vector(*n), offset: 0.0 }).collect();
    along(v, &planes)
}

/// As [`project_velocity`], for planes through zero.
pub(super) fn along(v: Vector, planes: &[Plane]) -> Vector {
    let speed = v.length();
    if !(speed.is_finite() && speed > 0.0) {
        return Vector::ZERO;
    }
    // Zero is above all planes. If rounding finds none, there is no other.
    nearest(planes, v, TOLERANCE * speed).unwrap_or(Vector::ZERO)
}

/// As [`project_velocity`], by trying each face of the cone of free velocities. Its time grows with the third
/// power of the number of planes; it tests the faster function.
#[must_use]
pub fn project_velocity_bruteforce(v: Vector, normals: &[Dir]) -> Vector {
    let speed = v.length();
    if !(speed.is_finite() && speed > 0.0) {
        return Vector::ZERO;
    }
    let normals: Vec<Vector> = normals.iter().map(|n| vector(*n)).collect();
    let is_free = |x: Vector| normals.iter().all(|n| n.dot(x) >= -4.0 * TOLERANCE * speed);
    let mut best = Vector::ZERO;
    let mut offer = |x: Vector| {
        if is_free(x) && (x - v).length_squared() < (best - v).length_squared() {
            best = x;
        }
    };
    offer(v);
    for (i, n) in normals.iter().enumerate() {
        let on_plane = v - *n * v.dot(*n);
        offer(on_plane);
        // In the plane, a second normal leaves only the apex.
        for m in normals[..i].iter().filter(|_| DIM == 3) {
            let across = *m - *n * m.dot(*n);
            let across = across.normalize_or_zero();
            if across != Vector::ZERO {
                offer(on_plane - across * on_plane.dot(across));
            }
        }
    }
    best
}

/// A direction in the public precision.
pub(super) fn vector(direction: Dir) -> Vector {
    VectorF32::from(direction).adjust_precision()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::AsF32;
    use proptest::prelude::*;

    /// A vector from numbers.
    fn of(numbers: &[f32]) -> Vector {
        let axes = Vector::AXES.into_iter();
        axes.zip(numbers).map(|(axis, x)| axis * x.adjust_precision()).sum()
    }

    proptest! {
        #[test]
        fn both_ways_agree(v in prop::array::uniform3(-1.0f32..1.0), planes in prop::collection::vec(prop::array::uniform3(-1.0f32..1.0), 0..7)) {
            let normals: Vec<Dir> = planes.iter().filter_map(|p| Dir::new(of(p).f32()).ok()).collect();
            // Rounding decides the line of planes that are nearly parallel.
            let apart = |(i, n): (usize, &Dir)| normals[..i].iter().all(|m| vector(*m).dot(vector(*n)).abs() < 0.999);
            prop_assume!(normals.iter().enumerate().all(apart));
            let v = of(&v);
            let fast = project_velocity(v, &normals);
            let slow = project_velocity_bruteforce(v, &normals);
            let (a, b) = ((fast - v).length(), (slow - v).length());
            prop_assert!((a - b).abs() < 1.0e-4, "{fast} {slow}");
            prop_assert!(normals.iter().all(|n| vector(*n).dot(fast) > -1.0e-5));
        }
    }

    #[test]
    fn no_velocity_comes_out_of_none() {
        let nan = Vector::splat(Scalar::NAN);
        for v in [Vector::ZERO, nan, Vector::splat(Scalar::INFINITY)] {
            assert_eq!(project_velocity(v, &[Dir::Y]), Vector::ZERO);
            assert_eq!(project_velocity_bruteforce(v, &[]), Vector::ZERO);
        }
    }
}
