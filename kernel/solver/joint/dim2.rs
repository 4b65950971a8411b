//! The coordinates of a joint in 2D.

use crate::math::{Angular, InvInertia, Lane, Rot, Vector, atan2_lanes};

/// Numbers of coordinates of B's frame in A's.
pub mod coordinate {
    /// Along A's x axis, m.
    pub const X: usize = 0;
    /// Along A's y axis, m.
    pub const Y: usize = 1;
    /// The angle from A's frame to B's, rad.
    pub const ANGLE: usize = 2;
    /// The distance of the two anchors, m.
    pub const DISTANCE: usize = 3;
}

/// Number of coordinates.
pub const AXES: usize = 4;
/// Number of coordinates that a frame has in another; they come first.
pub(super) const BLOCK: usize = 3;
/// Number of angles, those outside of the block included.
pub(super) const ANGLES: usize = 1;
/// The angle, by number among angles, that counts turns.
pub(super) const TURNING: usize = 0;

/// The coordinate of each angle.
pub(super) const ANGLE_AXES: [usize; ANGLES] = [coordinate::ANGLE];

/// The angles of B's frame in A's, and the axes about which each grows, as a change of B's angular velocity.
#[inline(always)]
pub(super) fn angles<N: Lane>([a, b]: [Rot<N>; 2]) -> [(N, Angular<N>); ANGLES] {
    let turn = a.inverse().mul(b);
    [(atan2_lanes(turn.sin, turn.cos), Angular { z: N::ONE })]
}

/// Number of axes about which bodies turn.
pub(super) const TURNS: usize = 1;

/// The unit turns.
#[inline(always)]
pub(super) fn units<N: Lane>() -> [Angular<N>; TURNS] {
    [Angular { z: N::ONE }]
}

/// A vector of a function of each component.
#[inline(always)]
pub(super) fn each<N: Lane>(v: Vector<N>, f: impl Fn(N) -> N) -> Vector<N> {
    Vector { x: f(v.x), y: f(v.y) }
}

/// An inverse of inertia with no less inertia than given, in kg·m².
pub(super) fn with_least_inertia(inverse: InvInertia, least: f32) -> InvInertia {
    let most = 1.0 / least;
    InvInertia { zz: if inverse.zz > most { most } else { inverse.zz } }
}
