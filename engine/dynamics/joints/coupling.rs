//! Joints that couple a coordinate of one body to a coordinate of another: gears, racks, pulleys. Converts
//! them to couplings of the kernel.

use kernel::{
    math as k,
    solver::{CouplingDef, CouplingEnd, EndCoordinate, JointFrame},
};

use super::{
    laws::give,
    space::{turn_about, turn_to},
};
use crate::{
    math::{Scalar, Vector, to_f32, vector_to_kernel, world_to_kernel},
    physics_transform::Rotation,
};

/// One end of a coupling: the coordinate of one body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum CoupledEnd {
    /// The rotation about a world axis. The axis is ignored in 2D.
    Turn(Vector),
    /// The displacement along a world axis.
    Shift(Vector),
    /// The distance between a point on the body and a point in the world.
    Distance([Vector; 2]),
}

/// The settings of a coupling: the coordinate of the first body plus `ratio` times the coordinate of the
/// second is constant, or bounded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Coupling {
    pub(crate) ends: [CoupledEnd; 2],
    pub(crate) ratio: Scalar,
    pub(crate) sum: Sum,
    pub(crate) compliance: Scalar,
}

/// The constraint on the sum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Sum {
    /// The sum keeps the value that it has when the coupling starts.
    Kept,
    /// The sum is at most this value.
    AtMost(Scalar),
    /// The sum is at most the value that it has when the coupling starts.
    AtMostNow,
}

impl CoupledEnd {
    /// The current coordinate.
    fn value(self, position: Vector, rotation: Rotation) -> Scalar {
        match self {
            Self::Turn(_) | Self::Shift(_) => 0.0,
            Self::Distance([anchor, point]) => (position + rotation * anchor - point).length(),
        }
    }

    /// The kernel's end for a body at a pose. Rotations and displacements are counted from this pose.
    fn to_kernel(self, position: Vector, rotation: Rotation) -> CouplingEnd {
        let frame = |anchor, basis| JointFrame { anchor, basis };
        let ground = |position, rotation| k::WorldPose { position: world_to_kernel(position), rotation };
        match self {
            Self::Turn(axis) => {
                let axes = turn_about(axis);
                let basis = rotation.to_kernel().admitted().inverse().mul(axes);
                let (frame, ground) = (frame(k::Vector::ZERO, basis), ground(position, axes));
                CouplingEnd { coordinate: EndCoordinate::Turn, frame, ground }
            }
            Self::Shift(axis) => {
                let axes = turn_to(axis);
                let frame = frame(k::Vector::ZERO, k::Rot::IDENTITY);
                CouplingEnd { coordinate: EndCoordinate::Shift, frame, ground: ground(position, axes) }
            }
            Self::Distance([anchor, point]) => {
                let frame = frame(vector_to_kernel(anchor), k::Rot::IDENTITY);
                let ground = ground(point, k::Rot::IDENTITY);
                CouplingEnd { coordinate: EndCoordinate::Distance, frame, ground }
            }
        }
    }
}

impl Coupling {
    /// The kernel's coupling of two bodies at these poses.
    pub(crate) fn definition(&self, bodies: [u32; 2], poses: [(Vector, Rotation); 2]) -> CouplingDef {
        let ends = core::array::from_fn(|side| {
            let (position, rotation) = poses[side];
            self.ends[side].to_kernel(position, rotation)
        });
        let [a, b]: [Scalar; 2] =
            core::array::from_fn(|side| self.ends[side].value(poses[side].0, poses[side].1));
        let now = a + self.ratio * b;
        let limits = match self.sum {
            Sum::Kept => [to_f32(now); 2],
            Sum::AtMost(most) => [f32::NEG_INFINITY, to_f32(most)],
            Sum::AtMostNow => [f32::NEG_INFINITY, to_f32(now)],
        };
        CouplingDef { bodies, ends, ratio: to_f32(self.ratio), limits, give: give(self.compliance) }
    }
}
