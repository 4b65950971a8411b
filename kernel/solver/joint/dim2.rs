//! The coordinates of a joint in 2D.

use crate::math::{Angular, InvInertia, Lane, Rot, Vector, atan2_lanes, inverse_of_positive};

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

/// The coordinates of which one outside of the block is made: the shifts of the distance.
pub(super) fn parts_of(_number: usize) -> core::ops::RangeInclusive<usize> {
    coordinate::X..=coordinate::Y
}

/// Number of coordinates in which a body moves: shifts, then turns.
pub(super) const DOF: usize = 3;

/// A motion, or an impulse and its moment, as numbers.
pub(super) fn numbers((v, w): (Vector, Angular)) -> [f32; DOF] {
    [v.x, v.y, w.z]
}

/// The motion of which these are the numbers.
pub(super) fn of_numbers(numbers: [f32; DOF]) -> (Vector, Angular) {
    let [x, y, z] = numbers;
    (Vector { x, y }, Angular { z })
}

/// As [`numbers`], in the precision of elimination.
pub(super) fn screw(v: Vector, w: Angular) -> [f64; DOF] {
    numbers((v, w)).map(f64::from)
}

/// As [`of_numbers`], from the precision of elimination.
pub(super) fn motion(screw: &[f64; DOF]) -> (Vector, Angular) {
    of_numbers(screw.map(|number| number as f32))
}

/// M⁻¹ of a body.
pub(super) fn inverse_of(mass: Vector, inertia: InvInertia) -> [[f32; DOF]; DOF] {
    let diagonal = numbers((mass, Angular { z: inertia.zz }));
    core::array::from_fn(|i| core::array::from_fn(|j| if i == j { diagonal[i] } else { 0.0 }))
}

/// Number of axes about which bodies turn.
pub(super) const TURNS: usize = 1;

/// The unit turns.
#[inline(always)]
pub(super) fn units<N: Lane>() -> [Angular<N>; TURNS] {
    [Angular { z: N::ONE }]
}

/// The axes of a frame about which bodies turn.
#[inline(always)]
pub(super) fn turn_axes<N: Lane>(_basis: Rot<N>) -> [Angular<N>; TURNS] {
    units()
}

/// The angle of a rotation, from −π to π, about its axis.
#[inline(always)]
pub(super) fn rotation_vector<N: Lane>(turn: Rot<N>) -> Angular<N> {
    Angular { z: atan2_lanes(turn.sin, turn.cos) }
}

/// The inverse of each component, 0 where that is not positive.
#[inline(always)]
pub(super) fn inverses<N: Lane>(v: Vector<N>) -> Vector<N> {
    Vector { x: inverse_of_positive(v.x), y: inverse_of_positive(v.y) }
}

/// An inverse of inertia with no less inertia than given, in kg·m².
pub(super) fn with_least_inertia(inverse: InvInertia, least: f32) -> InvInertia {
    let most = 1.0 / least;
    InvInertia { zz: if inverse.zz > most { most } else { inverse.zz } }
}
