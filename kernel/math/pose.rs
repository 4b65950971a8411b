//! Poses: relative poses in `f32`, world poses with a position in [`Scalar`] precision. Differences of world
//! positions are formed in full precision, then rounded to `f32`.

use super::{Rot, Scalar, Vector};

/// A position in the world.
pub type WorldVector = Vector<Scalar>;

/// A world position in `f64`.
#[cfg(feature = "f64")]
#[inline(always)]
pub(crate) fn wide_position(position: WorldVector) -> Vector<f64> {
    position
}

/// A world position in `f64`.
#[cfg(not(feature = "f64"))]
#[inline(always)]
pub(crate) fn wide_position(position: WorldVector) -> Vector<f64> {
    position.widen()
}

/// A world position rounded from `f64`.
#[cfg(feature = "f64")]
#[inline(always)]
pub(crate) fn world_position(position: Vector<f64>) -> WorldVector {
    position
}

/// A world position rounded from `f64`.
#[cfg(not(feature = "f64"))]
#[inline(always)]
pub(crate) fn world_position(position: Vector<f64>) -> WorldVector {
    position.narrow()
}

/// A pose relative to another body or shape: rotate, then translate.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pose {
    /// The origin of the inner frame, in metres.
    pub position: Vector,
    /// The rotation of the inner frame.
    pub rotation: Rot,
}

/// A pose in the world: rotate, then translate.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WorldPose {
    /// The origin of the inner frame, in metres.
    pub position: WorldVector,
    /// The rotation of the inner frame.
    pub rotation: Rot,
}

impl Pose {
    /// No translation and no rotation.
    pub const IDENTITY: Self = Self { position: Vector::ZERO, rotation: Rot::IDENTITY };

    /// The pose that rotates by `rotation`, then translates by `position`.
    #[inline]
    pub fn new(position: Vector, rotation: Rot) -> Self {
        Self { position, rotation }
    }

    /// Transforms a point from the inner frame to the outer one.
    #[inline]
    pub fn transform(&self, point: Vector) -> Vector {
        self.rotation.rotate(point) + self.position
    }

    /// Transforms a point from the outer frame to the inner one.
    #[inline]
    pub fn inverse_transform(&self, point: Vector) -> Vector {
        self.rotation.inverse_rotate(point - self.position)
    }

    /// The pose of the outer frame in the inner one.
    #[inline]
    pub fn inverse(&self) -> Self {
        Self { position: self.rotation.inverse_rotate(-self.position), rotation: self.rotation.inverse() }
    }

    /// The pose of `inner`'s frame in this pose's outer frame.
    #[inline]
    pub fn then(&self, inner: &Pose) -> Self {
        Self { position: self.transform(inner.position), rotation: self.rotation.mul(inner.rotation) }
    }
}

impl WorldPose {
    /// The origin of the world, without rotation.
    pub const IDENTITY: Self = Self { position: WorldVector::ZERO, rotation: Rot::IDENTITY };

    /// The pose that rotates by `rotation`, then translates by `position`.
    #[inline]
    pub fn new(position: WorldVector, rotation: Rot) -> Self {
        Self { position, rotation }
    }

    /// The world pose of a frame given relative to this pose.
    #[inline]
    pub fn then(&self, inner: &Pose) -> Self {
        Self {
            position: self.position + self.rotation.rotate(inner.position).to_world(),
            rotation: self.rotation.mul(inner.rotation),
        }
    }

    /// The pose of `other` in this pose's frame. The positions are subtracted in full precision.
    #[inline]
    pub fn relative(&self, other: &WorldPose) -> Pose {
        let offset = (other.position - self.position).to_local();
        Pose {
            position: self.rotation.inverse_rotate(offset),
            rotation: self.rotation.inverse().mul(other.rotation),
        }
    }

    /// Transforms a point from this frame to the world.
    #[inline]
    pub fn transform(&self, point: Vector) -> WorldVector {
        self.position + self.rotation.rotate(point).to_world()
    }

    /// Transforms a world point to this frame.
    #[inline]
    pub fn inverse_transform(&self, point: WorldVector) -> Vector {
        self.rotation.inverse_rotate((point - self.position).to_local())
    }
}
