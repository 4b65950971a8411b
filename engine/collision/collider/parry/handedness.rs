//! What a scale does to windings and to rounded edges.

use crate::math::{Scalar, Vector};

/// Whether a scale turns counter-clockwise into clockwise: it mirrors an odd number of axes.
pub(super) fn turns_winding(scale: Vector) -> bool {
    scale.to_array().into_iter().filter(|s| *s < 0.0).count() % 2 == 1
}

/// The radius of a rounded edge, which stays round: it follows the smallest scale.
pub(super) fn stretched_border(radius: Scalar, size: Vector) -> Scalar {
    radius * size.min_element()
}
