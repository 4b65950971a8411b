//! Levers of rolling and torsional resistance of contacts.
//!
//! The maximum torque is a lever times the normal force times the friction coefficient. Between two round
//! surfaces, the lever is a share of the smaller radius: a marble on a boulder rolls as on a plane, whose
//! radius counts as infinite.

use crate::math::Lane;
use crate::tuning::solver::ROLL_LEVER;

/// The levers of spinning and of rolling, in metres. `radii` are the radii of both surfaces, 0 for a face
/// or a corner; `arm` is the distance from the contact to the nearer centre of mass of a body that can
/// rotate.
#[inline(always)]
pub(super) fn levers<N: Lane>([a, b]: [N; 2], arm: N) -> [N; 2] {
    let are_round = N::and(N::ZERO.lt(a), N::ZERO.lt(b));
    let radius = N::select(are_round, a.min(b), a.max(b));
    let of_corner = arm * N::splat(0.2 * ROLL_LEVER);
    // A patch whose lever resists rolling has about twice that lever against spin.
    [(radius * N::splat(2.0 * ROLL_LEVER)).max(of_corner), (radius * N::splat(ROLL_LEVER)).max(of_corner)]
}
