//! Coordinate frames of the transform hierarchy, in `f64` scalars: from a parent's space to the world
//! and back.
//!
//! Why not `GlobalTransform`: it is an `Affine3A`, whose sums run in another order on another
//! instruction set, and inside a fixed step it is a frame old. The inputs are `f32`, so `f64` leaves one
//! rounding at the end, and what was written to a nested body's `Transform` reads back as its position
//! to the last bit but for rare ties.

use bevy_math::Vec3;
use bevy_transform::components::Transform;

use super::{
    Rotation, dim,
    turn::{Columns, Turn, cross},
};
use crate::math::{DIM, Vector, vector_from_xyz};

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn apply(m: &Columns, v: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|i| m[0][i] * v[0] + m[1][i] * v[1] + m[2][i] * v[2])
}

fn determinant(m: &Columns) -> f64 {
    dot(cross(m[0], m[1]), m[2])
}

/// The inverse by cofactors; `None` for a matrix that flattens space.
fn inverse(m: &Columns) -> Option<Columns> {
    let d = determinant(m);
    if d == 0.0 || !d.is_finite() {
        return None;
    }
    let rows = [cross(m[1], m[2]), cross(m[2], m[0]), cross(m[0], m[1])];
    Some([0, 1, 2].map(|column| [0, 1, 2].map(|row| rows[row][column] / d)))
}

/// The rotation nearest the first, then the second column (Gram–Schmidt); `None` where they are parallel
/// or vanish.
fn orthonormal(first: [f64; 3], second: [f64; 3]) -> Option<Turn> {
    let unit = |v: [f64; 3]| {
        let length = dot(v, v).sqrt();
        (length > 0.0 && length.is_finite()).then(|| v.map(|c| c / length))
    };
    let x = unit(first)?;
    let along = dot(x, second);
    let y = unit([0, 1, 2].map(|i| second[i] - along * x[i]))?;
    Some(Turn::from_columns([x, y, cross(x, y)]))
}

/// What a frame does to directions.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Linear {
    /// Scaled along its axes, then turned.
    Scaled([f64; 3]),
    /// Anything else: a turn below a scale that differs by axis.
    Sheared(Columns),
}

/// From a local space to the world (or to a body's space).
///
/// Turns and scales are kept apart as long as they commute, which is always but for a turn below a scale
/// that differs by axis or mirrors. There the frame is a matrix M, and its rotation is defined by the QR
/// factors of M: the x axis goes where M takes it (against it, where M mirrors, as Bevy reads it), the xy
/// plane where M takes that. This is the definition whose inverse is exact: a rotation written into a
/// sheared parent reads back as itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Frame {
    translation: [f64; 3],
    rotation: Turn,
    linear: Linear,
}

impl Frame {
    /// The world.
    pub(crate) const IDENTITY: Self =
        Self { translation: [0.0; 3], rotation: Turn::IDENTITY, linear: Linear::Scaled([1.0; 3]) };

    /// The frame of a child with the transform `t`.
    pub(crate) fn child(&self, t: &Transform) -> Self {
        let translation = self.point(xyz(t.translation));
        let (turn, scale) = (Turn::from_quat(t.rotation).normalized(), xyz(t.scale));
        if let Linear::Scaled(s) = self.linear
            && commute(s, turn)
        {
            let rotation = self.rotation.mul(turn).normalized();
            return Self {
                translation,
                rotation,
                linear: Linear::Scaled([0, 1, 2].map(|i| s[i] * scale[i])),
            };
        }
        let m = self.matrix();
        let turned = turn.columns().map(|column| apply(&m, column));
        let sign = if determinant(&m) < 0.0 { -1.0 } else { 1.0 };
        let rotation = orthonormal(turned[0].map(|c| c * sign), turned[1])
            .unwrap_or_else(|| self.rotation.mul(turn).normalized());
        let linear = Linear::Sheared([0, 1, 2].map(|i| turned[i].map(|c| c * scale[i])));
        Self { translation, rotation, linear }
    }

    /// The same frame seen from its own origin and rotation: only its scale is left.
    pub(crate) fn unposed(&self) -> Self {
        let linear = match self.linear {
            Linear::Scaled(_) => self.linear,
            Linear::Sheared(m) => Linear::Sheared(m.map(|column| self.rotation.inverse().rotate(column))),
        };
        Self { translation: [0.0; 3], rotation: Turn::IDENTITY, linear }
    }

    /// The origin.
    pub(crate) fn translation(&self) -> [f64; 3] {
        self.translation
    }

    /// The rotation.
    pub(crate) fn rotation(&self) -> Turn {
        self.rotation
    }

    /// The scale along the frame's own axes: the diagonal of R in M = Q R.
    pub(crate) fn scale(&self) -> [f64; 3] {
        match self.linear {
            Linear::Scaled(scale) => scale,
            Linear::Sheared(m) => {
                let axes = self.rotation.columns();
                [0, 1, 2].map(|i| dot(axes[i], m[i]))
            }
        }
    }

    fn matrix(&self) -> Columns {
        match self.linear {
            Linear::Scaled(scale) => {
                let axes = self.rotation.columns();
                [0, 1, 2].map(|i| axes[i].map(|c| c * scale[i]))
            }
            Linear::Sheared(m) => m,
        }
    }

    /// Takes a point from this frame to the outer space.
    fn point(&self, v: [f64; 3]) -> [f64; 3] {
        let turned = match self.linear {
            Linear::Scaled(scale) => self.rotation.rotate([0, 1, 2].map(|i| v[i] * scale[i])),
            Linear::Sheared(m) => apply(&m, v),
        };
        [0, 1, 2].map(|i| turned[i] + self.translation[i])
    }

    /// Takes a point from the outer space to this frame; `None` where the frame is flat.
    fn local_point(&self, v: [f64; 3]) -> Option<[f64; 3]> {
        let offset = [0, 1, 2].map(|i| v[i] - self.translation[i]);
        match self.linear {
            Linear::Scaled(scale) => {
                let turned = self.rotation.inverse().rotate(offset);
                let local = [0, 1, 2].map(|i| turned[i] / scale[i]);
                local.iter().all(|c| c.is_finite()).then_some(local)
            }
            Linear::Sheared(m) => inverse(&m).map(|inverse| apply(&inverse, offset)),
        }
    }

    /// The local turn of a child that has the turn `world` in the outer space.
    fn local_turn(&self, world: Turn) -> Turn {
        let plain = self.rotation.inverse().mul(world).normalized();
        if let Linear::Scaled(scale) = self.linear
            && commute(scale, plain)
        {
            return plain;
        }
        let m = self.matrix();
        let sign = if determinant(&m) < 0.0 { -1.0 } else { 1.0 };
        let [x, y, _] = world.columns();
        inverse(&m)
            .and_then(|back| orthonormal(apply(&back, x).map(|c| c * sign), apply(&back, y)))
            .unwrap_or(plain)
    }
}

/// Whether turning and scaling may be swapped: no turn, one positive factor, or about z with one factor in
/// the plane. A mirrored frame never passes, so that its rotation has one definition.
fn commute(scale: [f64; 3], turn: Turn) -> bool {
    let [x, y, z] = scale;
    let positive = x > 0.0 && y > 0.0 && z > 0.0;
    let planar = turn.x == 0.0 && turn.y == 0.0;
    positive && ((x == y && (y == z || planar)) || (planar && turn.z == 0.0))
}

fn xyz(v: Vec3) -> [f64; 3] {
    v.to_array().map(f64::from)
}

/// The pose a `Transform` gives in the parent's frame (`None`: the world). The rotation is `None` where
/// the quaternion has no direction.
pub(crate) fn read_pose(parent: Option<&Frame>, t: &Transform) -> (Vector, Option<Rotation>) {
    match parent {
        None => (vector_from_xyz(xyz(t.translation)), Rotation::from_turn(Turn::from_quat(t.rotation))),
        Some(frame) => {
            let world = frame.child(t);
            let is_turn = Turn::from_quat(t.rotation).dot(Turn::from_quat(t.rotation));
            let rotation = (is_turn > 0.0).then(|| Rotation::from_turn(world.rotation)).flatten();
            (vector_from_xyz(world.translation), rotation)
        }
    }
}

/// The `Transform` that puts the thing now at `t` to a world pose: translation and rotation replaced,
/// scale kept, in 2D also the depth and any tilt. In a parent that is flat, `t` stays.
#[inline]
pub(crate) fn write_pose(
    parent: Option<&Frame>,
    t: &Transform,
    position: Vector,
    rotation: Rotation,
) -> Transform {
    let mut written = *t;
    let Some(frame) = parent else {
        let at = dim::xyz_with(position, xyz(t.translation));
        written.translation = Vec3::from_array(at.map(|c| c as f32));
        written.rotation = dim::world_turn(rotation, Turn::from_quat(t.rotation)).to_quat();
        return written;
    };
    let now = frame.child(t);
    let Some(local) = frame.local_point(dim::xyz_with(position, now.translation)) else { return *t };
    let kept = xyz(t.translation);
    written.translation =
        Vec3::from_array([0, 1, 2].map(|i| if i < DIM { local[i] } else { kept[i] } as f32));
    written.rotation = frame.local_turn(dim::world_turn(rotation, now.rotation)).to_quat();
    written
}

/// Whether two transforms have the same translation, bit for bit.
pub(crate) fn same_translation(a: &Transform, b: &Transform) -> bool {
    a.translation.to_array().map(f32::to_bits) == b.translation.to_array().map(f32::to_bits)
}

/// Whether two transforms have the same rotation, bit for bit.
pub(crate) fn same_rotation(a: &Transform, b: &Transform) -> bool {
    a.rotation.to_array().map(f32::to_bits) == b.rotation.to_array().map(f32::to_bits)
}

/// Whether two transforms have the same translation and rotation, bit for bit.
pub(crate) fn same_pose(a: &Transform, b: &Transform) -> bool {
    same_translation(a, b) && same_rotation(a, b)
}
