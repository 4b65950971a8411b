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
    /// The distance between the two anchors, m.
    pub const DISTANCE: usize = 3;
}

/// Number of coordinates.
pub const AXES: usize = 4;
/// Number of coordinates that describe a frame in another; they come first.
pub(super) const BLOCK: usize = 3;
/// Number of angles, including angles outside the block.
pub(super) const ANGLES: usize = 1;
/// Number, among the angles, of the angle that counts whole turns.
pub(super) const TURNING: usize = 0;

/// The coordinate of each angle.
pub(super) const ANGLE_AXES: [usize; ANGLES] = [coordinate::ANGLE];

/// The angles of B's frame in A's. Each has the axis about which it grows, as a change of B's angular
/// velocity.
#[inline(always)]
pub(super) fn angles<N: Lane>([a, b]: [Rot<N>; 2]) -> [(N, Angular<N>); ANGLES] {
    let turn = a.inverse().mul(b);
    [(atan2_lanes(turn.sin, turn.cos), Angular { z: N::ONE })]
}

/// The component coordinates of a coordinate outside the block: the shifts of the distance.
pub(super) fn parts_of(_number: usize) -> core::ops::RangeInclusive<usize> {
    coordinate::X..=coordinate::Y
}

/// Number of degrees of freedom of a body: translations, then rotations.
pub(super) const DOF: usize = 3;

/// The numbers of a motion, or of an impulse and its moment.
#[inline(always)]
pub(super) fn numbers<N: Lane>((v, w): (Vector<N>, Angular<N>)) -> [N; DOF] {
    [v.x, v.y, w.z]
}

/// The motion with these numbers.
#[inline(always)]
pub(super) fn of_numbers<N: Lane>(numbers: [N; DOF]) -> (Vector<N>, Angular<N>) {
    let [x, y, z] = numbers;
    (Vector { x, y }, Angular { z })
}

/// M⁻¹ of a body.
#[inline(always)]
pub(super) fn inverse_of<N: Lane>(mass: Vector<N>, inertia: InvInertia<N>) -> [[N; DOF]; DOF] {
    let diagonal = numbers((mass, Angular { z: inertia.zz }));
    let mut inverse = [[N::ZERO; DOF]; DOF];
    for i in 0..DOF {
        inverse[i][i] = diagonal[i];
    }
    inverse
}

/// Number of axes about which bodies rotate.
pub(super) const TURNS: usize = 1;

/// The unit rotations.
#[inline(always)]
pub(super) fn units<N: Lane>() -> [Angular<N>; TURNS] {
    [Angular { z: N::ONE }]
}

/// The axes of a frame about which bodies rotate.
#[inline(always)]
pub(super) fn turn_axes<N: Lane>(_basis: Rot<N>) -> [Angular<N>; TURNS] {
    units()
}

/// The angle of a rotation, from −π to π, about its axis.
#[inline(always)]
pub(super) fn rotation_vector<N: Lane>(turn: Rot<N>) -> Angular<N> {
    Angular { z: atan2_lanes(turn.sin, turn.cos) }
}

/// The inverse of each component; 0 for components that are not positive.
#[inline(always)]
pub(super) fn inverses<N: Lane>(v: Vector<N>) -> Vector<N> {
    Vector { x: inverse_of_positive(v.x), y: inverse_of_positive(v.y) }
}

/// The smallest component.
#[inline(always)]
pub(super) fn least_element<N: Lane>(v: Vector<N>) -> N {
    v.x.min(v.y)
}

/// The inertia to which a body must be raised to have at least `least`, kg·m². 0 if it has that much.
#[inline(always)]
pub(super) fn lacking<N: Lane>(inverse: InvInertia<N>, least: N) -> N {
    N::select((N::ONE / least).lt(inverse.zz), least, N::ZERO)
}

/// The inverse inertia of a body raised to the inertia that it [lacks](lacking).
#[inline(always)]
pub(super) fn with_inertia<N: Lane>(inverse: InvInertia<N>, lacking: N) -> InvInertia<N> {
    InvInertia { zz: N::select(N::ZERO.lt(lacking), N::ONE / lacking, inverse.zz) }
}
