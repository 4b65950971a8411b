//! How far contacts resist rolling and spinning.
//!
//! The greatest torque is a lever times the normal force and the coefficient of friction. Of two round surfaces, the lever is
//! a share of the smaller radius: a marble on a boulder rolls as on a plane, whose radius counts as infinite.

use crate::math::Lane;

/// Lever of torsional friction of a contact in one point, as a share of the smaller radius. Less lets balls spin on the spot
/// for longer and keeps piles awake.
const SPIN_LEVER: f32 = 0.02;

/// The same for a corner, as a share of its distance from the nearer centre of mass of a body that can turn.
const CORNER_SPIN_LEVER: f32 = 0.002;

/// Lever of rolling resistance, as a share of the smaller radius: at friction 0.6 a ball rolls as if up a slope of 0.6 %. Less
/// keeps round bodies rocking in a pile, more holds them on steeper slopes.
const ROLL_LEVER: f32 = 0.01;

/// The same for corners and edges, as a share of their distance from the nearer centre of mass of a body that can turn.
const CORNER_ROLL_LEVER: f32 = 0.002;

/// Rolling resistance takes friction coefficients for at most this. Apps set high ones against sliding, and balls with
/// them still have to roll down a slope.
pub(super) const ROLL_FRICTION: f32 = 1.0;

/// The levers of spinning and of rolling, in metres. `radii` are those of both surfaces, 0 for a face or a corner; `arm` is
/// the distance from the contact to the nearer centre of mass of a body that can turn.
#[inline(always)]
pub(super) fn levers<N: Lane>([a, b]: [N; 2], arm: N) -> [N; 2] {
    let are_round = N::and(N::ZERO.lt(a), N::ZERO.lt(b));
    let radius = N::select(are_round, a.min(b), a.max(b));
    [(SPIN_LEVER, CORNER_SPIN_LEVER), (ROLL_LEVER, CORNER_ROLL_LEVER)]
        .map(|(round, corner)| (radius * N::splat(round)).max(arm * N::splat(corner)))
}
