//! Coordinate frames of the transform hierarchy, in `f64` scalars, and conversions of poses between them.
//!
//! `GlobalTransform` is not suitable: it is an `Affine3A`, whose sums run in another order on other
//! instruction sets, and inside a fixed step it is a frame old. The inputs are `f32`, so with `f64` there is
//! only one rounding, at the end. A pose that is written to a nested body's `Transform` is read back with the
//! same bits, except for rare ties.

use bevy_math::Vec3;
use bevy_transform::components::Transform;

use super::{
    Rotation, dim,
    rotation64::{Columns, Rotation64, cross},
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

/// The inverse by cofactors; `None` for a singular matrix.
fn inverse(m: &Columns) -> Option<Columns> {
    let d = determinant(m);
    if d == 0.0 || !d.is_finite() {
        return None;
    }
    let rows = [cross(m[1], m[2]), cross(m[2], m[0]), cross(m[0], m[1])];
    Some([0, 1, 2].map(|column| [0, 1, 2].map(|row| rows[row][column] / d)))
}

/// The rotation with axes along the first and second column, orthonormalised (Gram–Schmidt). `None` if the
/// columns are parallel or zero.
fn orthonormal(first: [f64; 3], second: [f64; 3]) -> Option<Rotation64> {
    let unit = |v: [f64; 3]| {
        let length = dot(v, v).sqrt();
        (length > 0.0 && length.is_finite()).then(|| v.map(|c| c / length))
    };
    let x = unit(first)?;
    let along = dot(x, second);
    let y = unit([0, 1, 2].map(|i| second[i] - along * x[i]))?;
    Some(Rotation64::from_columns([x, y, cross(x, y)]))
}

/// The linear part of a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Linear {
    /// Scaling along the frame's axes, then a rotation.
    Scaled([f64; 3]),
    /// Any other matrix: a rotation below an uneven scale.
    Sheared(Columns),
}

/// The frame of an entity in the world, or in a body's space.
///
/// Rotation and scale are stored separately if they commute, which is true except for a rotation below an
/// uneven or mirroring scale. Otherwise the frame is a matrix M, and its rotation is defined by the QR
/// factors of M: its x axis is the image of the x axis (negated if M mirrors, as in Bevy), and its xy plane
/// is the image of the xy plane. This definition has an exact inverse: a rotation written below a sheared
/// parent is read back unchanged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Frame {
    translation: [f64; 3],
    rotation: Rotation64,
    linear: Linear,
}

impl Frame {
    /// The world frame.
    pub(crate) const IDENTITY: Self =
        Self { translation: [0.0; 3], rotation: Rotation64::IDENTITY, linear: Linear::Scaled([1.0; 3]) };

    /// The frame of a child with the transform `t`.
    pub(crate) fn child(&self, t: &Transform) -> Self {
        let translation = self.point(xyz(t.translation));
        let (turn, scale) = (Rotation64::from_quat(t.rotation).normalized(), xyz(t.scale));
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

    /// The frame without translation and rotation, with its scale only.
    pub(crate) fn unposed(&self) -> Self {
        let linear = match self.linear {
            Linear::Scaled(_) => self.linear,
            Linear::Sheared(m) => Linear::Sheared(m.map(|column| self.rotation.inverse().rotate(column))),
        };
        Self { translation: [0.0; 3], rotation: Rotation64::IDENTITY, linear }
    }

    /// The origin.
    pub(crate) fn translation(&self) -> [f64; 3] {
        self.translation
    }

    /// The rotation.
    pub(crate) fn rotation(&self) -> Rotation64 {
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

    /// Transforms a point from this frame to the outer space.
    fn point(&self, v: [f64; 3]) -> [f64; 3] {
        let turned = match self.linear {
            Linear::Scaled(scale) => self.rotation.rotate([0, 1, 2].map(|i| v[i] * scale[i])),
            Linear::Sheared(m) => apply(&m, v),
        };
        [0, 1, 2].map(|i| turned[i] + self.translation[i])
    }

    /// Transforms a point from the outer space to this frame; `None` if the frame is singular.
    fn local_point(&self, v: [f64; 3]) -> Option<[f64; 3]> {
        self.local_vector([0, 1, 2].map(|i| v[i] - self.translation[i]))
    }

    /// Transforms a vector, such as a velocity, from the outer space to this frame; `None` if the
    /// frame is singular.
    pub(crate) fn local_vector(&self, v: [f64; 3]) -> Option<[f64; 3]> {
        match self.linear {
            Linear::Scaled(scale) => {
                let turned = self.rotation.inverse().rotate(v);
                let local = [0, 1, 2].map(|i| turned[i] / scale[i]);
                local.iter().all(|c| c.is_finite()).then_some(local)
            }
            Linear::Sheared(m) => inverse(&m).map(|inverse| apply(&inverse, v)),
        }
    }

    /// Transforms an angular velocity from the outer space to this frame: the axis is transformed as a
    /// vector, the speed is kept, and the sense is reversed if the frame mirrors. `None` if the frame is
    /// singular or the angular velocity is zero.
    pub(crate) fn local_spin(&self, spin: [f64; 3]) -> Option<[f64; 3]> {
        let axis = self.local_vector(spin)?;
        let factor = (dot(spin, spin) / dot(axis, axis)).sqrt() * determinant(&self.matrix()).signum();
        factor.is_finite().then(|| axis.map(|c| c * factor))
    }

    /// The local rotation of a child with the rotation `world` in the outer space.
    fn local_rotation(&self, world: Rotation64) -> Rotation64 {
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

/// Whether rotation and scale commute: no rotation, one positive factor for all axes, or a rotation about z
/// with one factor in the plane. The result is false for every mirrored frame, which gives its rotation one
/// definition.
fn commute(scale: [f64; 3], turn: Rotation64) -> bool {
    let [x, y, z] = scale;
    let positive = x > 0.0 && y > 0.0 && z > 0.0;
    let planar = turn.x == 0.0 && turn.y == 0.0;
    positive && ((x == y && (y == z || planar)) || (planar && turn.z == 0.0))
}

fn xyz(v: Vec3) -> [f64; 3] {
    v.to_array().map(f64::from)
}

/// The pose that a `Transform` gives in the parent's frame (`None`: the world). The rotation is `None` if the
/// quaternion has no direction.
pub(crate) fn read_pose(parent: Option<&Frame>, t: &Transform) -> (Vector, Option<Rotation>) {
    match parent {
        None => (vector_from_xyz(xyz(t.translation)), Rotation::from_f64(Rotation64::from_quat(t.rotation))),
        Some(frame) => {
            let world = frame.child(t);
            let is_turn = Rotation64::from_quat(t.rotation).dot(Rotation64::from_quat(t.rotation));
            let rotation = (is_turn > 0.0).then(|| Rotation::from_f64(world.rotation)).flatten();
            (vector_from_xyz(world.translation), rotation)
        }
    }
}

/// The `Transform` that moves an entity with the transform `t` to a world pose. Translation and rotation are
/// replaced, scale is kept, in 2D also the depth and any tilt. In a flat parent `t` is unchanged.
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
        written.rotation = dim::world_rotation(rotation, Rotation64::from_quat(t.rotation)).to_quat();
        return written;
    };
    let now = frame.child(t);
    let Some(local) = frame.local_point(dim::xyz_with(position, now.translation)) else { return *t };
    let kept = xyz(t.translation);
    written.translation =
        Vec3::from_array([0, 1, 2].map(|i| if i < DIM { local[i] } else { kept[i] } as f32));
    written.rotation = frame.local_rotation(dim::world_rotation(rotation, now.rotation)).to_quat();
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
