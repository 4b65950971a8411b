//! Validates the input of constructors: no NaN, no infinity, no sizes that make no shape.
//!
//! Constructors without a `Result` repair their input and warn, once per constructor. A game then continues
//! with a tiny collider, and no NaN enters the engine.

use crate::math::{Scalar, Vector};

/// Minimum size of a shape, in metres. Smaller sizes and NaN become this.
pub(super) const MIN_LENGTH: Scalar = 1.0e-5;

/// Maximum size and coordinate, in metres. Moments of inertia grow with the fifth power of lengths and are
/// squared: larger values would overflow `f32`.
pub(super) const MAX_LENGTH: Scalar = 1.0e7;

/// Checks the input of one constructor, and records whether a value was repaired.
#[derive(Default)]
pub(super) struct Input {
    /// Whether a value was changed.
    pub repaired: bool,
}

impl Input {
    /// Records a repair.
    pub fn repair<T>(&mut self, value: T) -> T {
        self.repaired = true;
        value
    }

    /// A size: its absolute value, within the limits. NaN becomes the minimum.
    pub fn length(&mut self, value: Scalar) -> Scalar {
        if (MIN_LENGTH..=MAX_LENGTH).contains(&value) {
            value
        } else if value.is_nan() {
            self.repair(MIN_LENGTH)
        } else {
            self.repair(value.abs().clamp(MIN_LENGTH, MAX_LENGTH))
        }
    }

    /// A size that may be zero: its absolute value, at most the maximum. NaN becomes zero.
    pub fn length_or_zero(&mut self, value: Scalar) -> Scalar {
        if (0.0..=MAX_LENGTH).contains(&value) {
            value
        } else if value.is_nan() {
            self.repair(0.0)
        } else {
            self.repair(value.abs().min(MAX_LENGTH))
        }
    }

    /// A point with components within the limits. NaN becomes zero.
    pub fn point(&mut self, point: Vector) -> Vector {
        if is_usable(point) {
            return point;
        }
        let limit = Vector::splat(MAX_LENGTH);
        let finite = Vector::from_array(point.to_array().map(|v| if v.is_nan() { 0.0 } else { v }));
        self.repair(finite.clamp(-limit, limit))
    }

    /// Heights and their factor, which becomes positive, as parry needs it.
    pub fn heights(
        &mut self,
        heights: impl Iterator<Item = Scalar>,
        factor: Scalar,
    ) -> (Vec<Scalar>, Scalar) {
        let mut coordinate = |v: Scalar| self.point(Vector::splat(v)).x;
        let factor = coordinate(factor);
        let sign = if factor < 0.0 { -1.0 } else { 1.0 };
        (heights.map(|h| coordinate(h) * sign).collect(), factor.abs())
    }

    /// Two points at least the minimum length apart.
    pub fn segment(&mut self, a: Vector, b: Vector) -> (Vector, Vector) {
        let (a, b) = (self.point(a), self.point(b));
        // Far from the origin the minimum length may be below the resolution of coordinates.
        let step = MIN_LENGTH.max(a.abs().max_element() * 4.0 * Scalar::EPSILON);
        if a.distance_squared(b) >= MIN_LENGTH * MIN_LENGTH {
            (a, b)
        } else {
            (a, self.repair(a + Vector::X * step))
        }
    }

    /// The unit vector of a direction; the Y axis if it has none.
    pub fn direction(&mut self, direction: Vector) -> Vector {
        // Dividing by the largest component first keeps squares from overflow and underflow.
        let scaled = direction / direction.abs().max_element();
        scaled.try_normalize().filter(|d| d.is_finite()).unwrap_or_else(|| self.repair(Vector::Y))
    }

    /// The elements whose indices are valid and distinct, and refer to usable points.
    pub fn elements<const N: usize>(
        &mut self,
        vertices: &[Vector],
        elements: Vec<[u32; N]>,
    ) -> Vec<[u32; N]> {
        let count = elements.len();
        let kept: Vec<_> = elements.into_iter().filter(|e| is_element_usable(vertices, e)).collect();
        self.repaired |= kept.len() != count;
        kept
    }
}

/// Maximum number of voxels around a voxelised shape. Each voxel takes 12 bytes during voxelisation.
const MAX_VOXELS: f64 = 8_388_608.0;

/// Whether the voxel size is positive and the box of the usable points does not have too many voxels.
pub(super) fn voxels_fit(points: &[Vector], voxel_size: Scalar) -> bool {
    let usable = || points.iter().copied().filter(|p| is_usable(*p));
    let (low, high) = (usable().reduce(Vector::min), usable().reduce(Vector::max));
    let extents = high.unwrap_or_default() - low.unwrap_or_default();
    let count = |extent: Scalar| (extent as f64 / voxel_size as f64).ceil().max(2.0) + 1.0;
    extents.to_array().into_iter().map(count).product::<f64>() <= MAX_VOXELS
}

/// Whether a point is finite and within the limits.
pub(super) fn is_usable(point: Vector) -> bool {
    point.abs().cmple(Vector::splat(MAX_LENGTH)).all()
}

/// Whether the indices of a segment or triangle exist, differ, and refer to usable points.
pub(super) fn is_element_usable<const N: usize>(vertices: &[Vector], element: &[u32; N]) -> bool {
    let distinct = (1..N).all(|i| !element[..i].contains(&element[i]));
    distinct && element.iter().all(|i| vertices.get(*i as usize).is_some_and(|v| is_usable(*v)))
}

/// Evaluates the body of a constructor with an [`Input`], and warns once if it repaired a value.
macro_rules! checked {
    ($name:literal, |$input:ident| $body:expr) => {{
        let mut $input = $crate::collision::collider::parry::input::Input::default();
        let shape = $body;
        if $input.repaired {
            bevy_log::warn_once!(
                "`Collider::{}` got values that make no shape (NaN, infinite, zero or negative sizes, indices \
                 out of range); the collider was made from what is usable of them. Check what is passed to it.",
                $name
            );
        }
        shape
    }};
}
pub(super) use checked;

/// Runs a routine of parry that may panic. `None` if it panics.
///
/// Earlier checks reject all invalid input that can be detected. Assertions within parry's algorithms remain.
/// With `panic = "abort"` a panic still aborts.
pub(super) fn without_panic<T>(routine: impl FnOnce() -> T) -> Option<T> {
    // The closure's values are dropped or returned as a whole, so no panic leaves one half changed.
    std::panic::catch_unwind(std::panic::AssertUnwindSafe(routine)).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_come_out_positive_and_finite() {
        for bad in [0.0, -0.0, Scalar::NAN, Scalar::INFINITY, Scalar::NEG_INFINITY, -2.0, Scalar::MAX] {
            let mut input = Input::default();
            let length = input.length(bad);
            assert!(input.repaired && (MIN_LENGTH..=MAX_LENGTH).contains(&length), "{bad} became {length}");
        }
        let mut input = Input::default();
        assert_eq!((input.length(2.0), input.length_or_zero(0.0)), (2.0, 0.0));
        assert!(!input.repaired);
        assert_eq!((input.length(-2.0), input.length_or_zero(-3.0)), (2.0, 3.0));
    }

    #[test]
    fn segments_have_two_ends() {
        for far in [0.0, 1.0, 1.0e6, 1.0e30, Scalar::NAN] {
            let (a, b) = Input::default().segment(Vector::splat(far), Vector::splat(far));
            assert!(a != b && is_usable(a) && b.is_finite(), "{far}");
        }
    }
}
