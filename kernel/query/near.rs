//! Searches of all trees: by a box, by the distance from a point, and along a line.
//!
//! Trees are in `f32` and positions may be in `f64`, so boxes are grown by the rounding error.

use crate::bvh::{TreeKind, Trees};
use crate::math::{Scalar, Vector, WorldVector, max, min, wide_position};
use crate::shape::Aabb;

/// Rounding of a unit vector to `f32`, per component.
const DIRECTION_ROUNDING: f32 = 1.2e-7;

/// The length up to which a line is followed in an unbounded tree (with half-spaces), to bound its lateral
/// error by rounding; in metres.
const ENDLESS: f32 = 1.0e6;

/// Calls `visit` with every collider whose box touches a box, until `visit` returns `false`.
pub fn visit_touching(trees: &Trees, aabb: &Aabb, mut visit: impl FnMut(u32) -> bool) {
    for kind in TreeKind::ALL {
        if !trees[kind].query(aabb, &mut visit) {
            return;
        }
    }
}

/// Calls `visit` with the colliders whose boxes are within a limit of a point, nearer branches first, and the
/// current limit. `visit` returns the new limit, negative to stop.
pub fn visit_near(
    trees: &Trees,
    point: WorldVector,
    mut limit: Scalar,
    mut visit: impl FnMut(u32, Scalar) -> Scalar,
) {
    let (center, slack) = rounded(wide_position(point));
    let slack = slack.length();
    let squared = |limit: Scalar| {
        let reach = up(limit) + slack;
        if limit < 0.0 { -1.0 } else { reach * reach * (1.0 + 4.0 * f32::EPSILON) }
    };
    for kind in TreeKind::ALL {
        if !(limit >= 0.0) {
            return;
        }
        trees[kind].query_nearest(center, squared(limit), |id, _| {
            limit = visit(id, limit);
            squared(limit)
        });
    }
}

/// A line in `f64`, prepared for the trees.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line {
    pub(super) origin: Vector<f64>,
    /// The direction, of unit length.
    pub(super) direction: Vector<f64>,
}

impl Line {
    /// `None` if a number is not finite, or the direction zero.
    pub(super) fn new(origin: WorldVector, direction: WorldVector) -> Option<Self> {
        let (origin, direction) = (wide_position(origin), wide_position(direction));
        if !(origin.largest() < f64::INFINITY) {
            return None;
        }
        let square = direction.length_squared();
        if square > 1.0e-200 && square < 1.0e200 {
            return Some(Self { origin, direction: direction * (1.0 / square.sqrt()) });
        }
        let largest = direction.largest();
        if !(largest > 0.0 && largest < f64::INFINITY) {
            return None;
        }
        // Scaled first, since the square of the length is not a normal number.
        let scaled = direction * (1.0 / largest);
        let direction = scaled * (1.0 / scaled.length());
        (direction.largest() < f64::INFINITY).then_some(Self { origin, direction })
    }

    /// Calls `visit` with the colliders whose boxes are met within a limit by a box of half size `half` whose
    /// centre moves along the line, nearer branches first, and the current limit. `visit` returns the new
    /// limit, negative to stop.
    pub(super) fn visit(
        &self,
        trees: &Trees,
        half: Vector,
        mut limit: Scalar,
        mut visit: impl FnMut(u32, Scalar) -> Scalar,
    ) {
        let (origin, slack) = rounded(self.origin);
        let direction = self.direction.narrow();
        for kind in TreeKind::ALL {
            if !(limit >= 0.0) {
                return;
            }
            let tree = &trees[kind];
            if tree.is_empty() {
                continue;
            }
            let bounds = tree.bounds();
            let reach = (bounds.max - origin).abs().max((bounds.min - origin).abs()).length();
            let reach = if reach < 1.0e9 { reach } else { ENDLESS };
            let aside = DIRECTION_ROUNDING * min(reach, max(up(limit), 0.0));
            // The tree adds the half size to the origin, which rounds it.
            let rounding = origin.abs() * (2.0 * f32::EPSILON);
            let grown = half + slack + rounding + Vector::ONE * aside;
            tree.cast_box(grown, origin, direction, up(limit), |id, _| {
                limit = visit(id, limit);
                if limit < 0.0 { -1.0 } else { up(limit) }
            });
        }
    }
}

/// A limit in the trees' `f32`, rounded up.
fn up(limit: Scalar) -> f32 {
    let limit = limit as f32 * (1.0 + 8.0 * f32::EPSILON);
    if limit < f32::MAX { limit.next_up() } else { f32::MAX }
}

/// A position in `f32`, and its maximum distance from the exact position on each axis.
fn rounded(position: Vector<f64>) -> (Vector, Vector) {
    let near = position.narrow();
    let off = (position - near.widen()).narrow().abs();
    (near, off * (1.0 + 2.0 * f32::EPSILON))
}
