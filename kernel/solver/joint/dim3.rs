//! The coordinates of a joint in 3D.

use crate::math::{Angular, InvInertia, Lane, Rot, Vector, atan2_lanes, inverse_of_positive};

/// Numbers of coordinates of B's frame in A's.
pub mod coordinate {
    /// Along A's x axis, m.
    pub const X: usize = 0;
    /// Along A's y axis, m.
    pub const Y: usize = 1;
    /// Along A's z axis, m.
    pub const Z: usize = 2;
    /// The angle about the x axes, rad.
    pub const TWIST: usize = 3;
    /// The component about A's y axis of the rotation vector from A's x axis to B's, rad.
    pub const SWING_Y: usize = 4;
    /// The component about A's z axis of the rotation vector from A's x axis to B's, rad.
    pub const SWING_Z: usize = 5;
    /// The distance between the two anchors, m.
    pub const DISTANCE: usize = 6;
    /// The angle between the x axes, rad.
    pub const CONE: usize = 7;
}

/// Number of coordinates.
pub const AXES: usize = 8;
/// Number of coordinates that describe a frame in another; they come first.
pub(super) const BLOCK: usize = 6;
/// Number of angles, including angles outside the block.
pub(super) const ANGLES: usize = 4;
/// Number, among the angles, of the angle that counts whole turns.
pub(super) const TURNING: usize = 0;

/// The coordinate of each angle.
pub(super) const ANGLE_AXES: [usize; ANGLES] =
    [coordinate::TWIST, coordinate::SWING_Y, coordinate::SWING_Z, coordinate::CONE];

/// Squared sine of half the swing angle below which a swing has no axis.
const NO_SWING: f32 = 1.0e-12;

/// The angles of B's frame in A's. Each has the axis about which it grows, as a change of B's angular
/// velocity.
///
/// The rotation is a twist about x, then a swing about an axis perpendicular to x. Twist grows with the
/// angular velocity along the mean of the two x axes. Swings grow with the angular velocity along A's y and
/// z axes turned by the swing: y − m (y · b), with B's x axis b and m = (x + b) / (1 + x · b). The factor θ
/// / sin θ that a swing θ about the other axis adds is left out.
#[inline(always)]
pub(super) fn angles<N: Lane>([a, b]: [Rot<N>; 2]) -> [(N, Angular<N>); ANGLES] {
    let [x, y, z] = turn_axes(a);
    let q = a.inverse().mul(b);
    let sign = N::select(q.w.lt(N::ZERO), -N::ONE, N::ONE);
    let (qx, qy, qz, qw) = (q.x * sign, q.y * sign, q.z * sign, q.w * sign);
    let two = N::splat(2.0);
    let twist = two * atan2_lanes(qx, qw);
    // The swing is q times the inverse of the twist.
    let n = (qx * qx + qw * qw).sqrt();
    let has_twist = N::ZERO.lt(n);
    let inverse = N::ONE / N::select(has_twist, n, N::ONE);
    let (tx, tw) = (qx * inverse, N::select(has_twist, qw * inverse, N::ONE));
    let (sy, sz) = (tw * qy - tx * qz, tw * qz + tx * qy);
    let square = sy * sy + sz * sz;
    let swings = N::splat(NO_SWING).lt(square);
    let s = N::select(swings, square, N::ONE).sqrt();
    let cone = two * atan2_lanes(s, n);
    let factor = N::select(swings, cone / s, two);
    let axis = Vector::select(swings, y * (sy / s) + z * (sz / s), y);
    let bx = b.rotate(Vector::splat(Vector::X));
    let mean = x + bx;
    // The x axes are opposite after half a turn: twist is undefined there, and A's x axis is used.
    let along = N::ONE + x.dot(bx);
    let is_defined = N::splat(NO_SWING).lt(along);
    let twist_axis = Vector::select(is_defined, mean * (N::ONE / N::select(is_defined, along, N::ONE)), x);
    // Rotation of B about its own x axis does not change swings.
    let swung_y = y - twist_axis * N::select(is_defined, y.dot(bx), N::ZERO);
    let swung_z = z - twist_axis * N::select(is_defined, z.dot(bx), N::ZERO);
    [
        (twist, twist_axis),
        (sy * factor, swung_y),
        (sz * factor, swung_z),
        (N::select(swings, cone, N::ZERO), axis),
    ]
}

/// The component coordinates of a coordinate outside the block: shifts for the distance, swings for the
/// angle.
pub(super) fn parts_of(number: usize) -> core::ops::RangeInclusive<usize> {
    match number {
        coordinate::DISTANCE => coordinate::X..=coordinate::Z,
        _ => coordinate::SWING_Y..=coordinate::SWING_Z,
    }
}

/// Number of degrees of freedom of a body: translations, then rotations.
pub(super) const DOF: usize = 6;

/// The numbers of a motion, or of an impulse and its moment.
#[inline(always)]
pub(super) fn numbers<N: Lane>((v, w): (Vector<N>, Angular<N>)) -> [N; DOF] {
    [v.x, v.y, v.z, w.x, w.y, w.z]
}

/// The motion with these numbers.
#[inline(always)]
pub(super) fn of_numbers<N: Lane>(numbers: [N; DOF]) -> (Vector<N>, Angular<N>) {
    let [x, y, z, a, b, c] = numbers;
    (Vector { x, y, z }, Vector { x: a, y: b, z: c })
}

/// M⁻¹ of a body.
#[inline(always)]
pub(super) fn inverse_of<N: Lane>(mass: Vector<N>, i: InvInertia<N>) -> [[N; DOF]; DOF] {
    let diagonal = numbers((mass, Vector { x: i.xx, y: i.yy, z: i.zz }));
    let mut inverse = [[N::ZERO; DOF]; DOF];
    for k in 0..DOF {
        inverse[k][k] = diagonal[k];
    }
    for (row, column, number) in [(3, 4, i.xy), (3, 5, i.xz), (4, 5, i.yz)] {
        (inverse[row][column], inverse[column][row]) = (number, number);
    }
    inverse
}

/// Number of axes about which bodies rotate.
pub(super) const TURNS: usize = 3;

/// The unit rotations.
#[inline(always)]
pub(super) fn units<N: Lane>() -> [Angular<N>; TURNS] {
    let [x, y, z] = Vector::AXES;
    [Vector::splat(x), Vector::splat(y), Vector::splat(z)]
}

/// The axes of a frame about which bodies rotate.
#[inline(always)]
pub(super) fn turn_axes<N: Lane>(basis: Rot<N>) -> [Angular<N>; TURNS] {
    let [x, y, z] = units();
    [basis.rotate(x), basis.rotate(y), basis.rotate(z)]
}

/// The angle of a rotation, up to π, along its axis.
#[inline(always)]
pub(super) fn rotation_vector<N: Lane>(turn: Rot<N>) -> Angular<N> {
    let sign = N::select(turn.w.lt(N::ZERO), -N::ONE, N::ONE);
    let axis = Vector { x: turn.x, y: turn.y, z: turn.z } * sign;
    let square = axis.length_squared();
    let turns = N::splat(NO_SWING).lt(square);
    let sine = N::select(turns, square, N::ONE).sqrt();
    let angle = N::splat(2.0) * atan2_lanes(sine, turn.w * sign);
    axis * N::select(turns, angle / sine, N::splat(2.0))
}

/// The inverse of each component; 0 for components that are not positive.
#[inline(always)]
pub(super) fn inverses<N: Lane>(v: Vector<N>) -> Vector<N> {
    Vector { x: inverse_of_positive(v.x), y: inverse_of_positive(v.y), z: inverse_of_positive(v.z) }
}

/// The smallest component.
#[inline(always)]
pub(super) fn least_element<N: Lane>(v: Vector<N>) -> N {
    v.x.min(v.y).min(v.z)
}

/// The inertia to add to a body, so that its smallest moment is about `least`, kg·m². 0 if it has that
/// much.
#[inline(always)]
pub(super) fn lacking<N: Lane>(inverse: InvInertia<N>, least: N) -> N {
    (least - N::ONE / inverse.trace()).max(N::ZERO)
}

/// The inverse inertia of a body after adding the inertia that it [lacks](lacking) about all axes.
#[inline(always)]
pub(super) fn with_inertia<N: Lane>(inverse: InvInertia<N>, lacking: N) -> InvInertia<N> {
    let mut with = inverse;
    let lacks = N::bits(N::ZERO.lt(lacking));
    for lane in (0..N::WIDTH).filter(|lane| lacks >> lane & 1 != 0) {
        let (more, lacking) = (inverse.get(lane).inverse(), lacking.get(lane));
        // Inertia cannot be added to a body that does not rotate about some axis.
        if more != InvInertia::ZERO {
            let [xx, yy, zz] = [more.xx, more.yy, more.zz].map(|moment| moment + lacking);
            with.set(lane, InvInertia { xx, yy, zz, ..more }.inverse());
        }
    }
    with
}
