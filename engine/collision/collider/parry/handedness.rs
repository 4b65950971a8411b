//! The effect of a scale on windings and on rounded edges.

use crate::math::{Scalar, Vector};

/// Whether a scale reverses windings: it mirrors an odd number of axes.
pub(super) fn turns_winding(scale: Vector) -> bool {
    scale.to_array().into_iter().filter(|s| *s < 0.0).count() % 2 == 1
}

/// The radius of a rounded edge. The edge stays round, so the radius follows the smallest scale.
pub(super) fn stretched_border(radius: Scalar, size: Vector) -> Scalar {
    radius * size.min_element()
}
