//! The pose of a joint on a body: a [`JointFrame`] has a [`JointAnchor`] and a [`JointBasis`].

use bevy_reflect::{Reflect, std_traits::ReflectDefault};
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};

use super::space::{Isometry, Rot, basis_of, isometry, parts, rotation_of};
use crate::{math::Vector, physics_transform::Rotation};

/// A frame of a joint on one of its bodies: an anchor point and the directions of the joint's axes.
///
/// A frame given as [`FromGlobal`](JointAnchor::FromGlobal) becomes local at the start of the first step with
/// both bodies. Afterwards the frame moves with its body.
///
/// ```
/// # use avian::{math::Vector, prelude::*};
/// // Half a metre to the right of the body's origin, with the axes of the body.
/// let frame = JointFrame::from(JointAnchor::Local(Vector::X * 0.5));
/// assert_eq!(frame.basis, JointBasis::IDENTITY);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(type_path = false, Debug, Default, PartialEq)]
pub struct JointFrame {
    /// The anchor point.
    pub anchor: JointAnchor,
    /// The directions of the axes.
    pub basis: JointBasis,
}

crate::type_path::type_path!(JointFrame, "dynamics::joints");

impl JointFrame {
    /// The body's origin and axes.
    pub const IDENTITY: Self = Self { anchor: JointAnchor::ZERO, basis: JointBasis::IDENTITY };

    /// A frame relative to the body.
    pub fn local(isometry: impl Into<Isometry>) -> Self {
        let (anchor, basis) = parts(isometry.into());
        Self { anchor: JointAnchor::Local(anchor), basis: JointBasis::Local(basis) }
    }

    /// A frame in the world.
    pub fn global(isometry: impl Into<Isometry>) -> Self {
        let (anchor, basis) = parts(isometry.into());
        Self { anchor: JointAnchor::FromGlobal(anchor), basis: JointBasis::FromGlobal(basis) }
    }

    /// The frame relative to the body, if anchor and basis are local. In `f32`.
    pub fn get_local_isometry(&self) -> Option<Isometry> {
        Some(isometry(self.anchor.local()?, self.basis.local()?))
    }

    /// The frame in the world, if anchor and basis are global. In `f32`.
    pub fn get_global_isometry(&self) -> Option<Isometry> {
        match (self.anchor, self.basis) {
            (JointAnchor::FromGlobal(anchor), JointBasis::FromGlobal(basis)) => Some(isometry(anchor, basis)),
            _ => None,
        }
    }

    /// Both frames relative to their bodies at the given poses.
    pub fn compute_local(
        frame1: Self,
        frame2: Self,
        pos1: Vector,
        pos2: Vector,
        rot1: &Rotation,
        rot2: &Rotation,
    ) -> [JointFrame; 2] {
        [frame1.localized(pos1, *rot1), frame2.localized(pos2, *rot2)]
    }

    /// Whether anchor and basis are local.
    pub(crate) fn is_local(&self) -> bool {
        self.anchor.local().is_some() && self.basis.local().is_some()
    }

    /// The frame relative to a body at a pose.
    pub(crate) fn localized(self, position: Vector, rotation: Rotation) -> Self {
        Self { anchor: self.anchor.localized(position, rotation), basis: self.basis.localized(rotation) }
    }
}

impl From<JointAnchor> for JointFrame {
    fn from(anchor: JointAnchor) -> Self {
        Self { anchor, ..Self::IDENTITY }
    }
}

impl From<JointBasis> for JointFrame {
    fn from(basis: JointBasis) -> Self {
        Self { basis, ..Self::IDENTITY }
    }
}

/// The point at which a joint holds a body, in metres. The body's origin by default.
#[derive(Clone, Copy, Debug, PartialEq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(type_path = false, Debug, Default, PartialEq)]
pub enum JointAnchor {
    /// Relative to the body.
    Local(Vector),
    /// In the world. It becomes [`Local`](Self::Local) in the first step.
    FromGlobal(Vector),
}

crate::type_path::type_path!(JointAnchor, "dynamics::joints");

impl Default for JointAnchor {
    fn default() -> Self {
        Self::ZERO
    }
}

impl JointAnchor {
    /// The body's origin.
    pub const ZERO: Self = Self::Local(Vector::ZERO);

    /// Both anchors relative to their bodies at the given poses.
    pub fn compute_local(
        anchor1: Self,
        anchor2: Self,
        pos1: Vector,
        pos2: Vector,
        rot1: &Rotation,
        rot2: &Rotation,
    ) -> [Self; 2] {
        [anchor1.localized(pos1, *rot1), anchor2.localized(pos2, *rot2)]
    }

    pub(crate) const fn local(&self) -> Option<Vector> {
        match self {
            Self::Local(anchor) => Some(*anchor),
            Self::FromGlobal(_) => None,
        }
    }

    fn localized(self, position: Vector, rotation: Rotation) -> Self {
        match self {
            Self::Local(_) => self,
            Self::FromGlobal(point) => Self::Local(rotation.inverse() * (point - position)),
        }
    }
}

/// The directions of a joint's axes on a body. By default they are the body's axes.
#[derive(Clone, Copy, Debug, PartialEq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(type_path = false, Debug, Default, PartialEq)]
pub enum JointBasis {
    /// The rotation from the joint's axes to the body's.
    Local(Rot),
    /// The rotation from the joint's axes to the world's. It becomes [`Local`](Self::Local) in
    /// the first step.
    FromGlobal(Rot),
}

crate::type_path::type_path!(JointBasis, "dynamics::joints");

impl Default for JointBasis {
    fn default() -> Self {
        Self::IDENTITY
    }
}

impl JointBasis {
    /// The axes of the body.
    pub const IDENTITY: Self = Self::Local(Rot::IDENTITY);

    /// Both bases relative to their bodies with the given rotations.
    pub fn compute_local(rotation1: Self, rotation2: Self, rot1: &Rot, rot2: &Rot) -> [Self; 2] {
        [rotation1.localized(rotation_of(*rot1)), rotation2.localized(rotation_of(*rot2))]
    }

    pub(crate) const fn local(&self) -> Option<Rot> {
        match self {
            Self::Local(basis) => Some(*basis),
            Self::FromGlobal(_) => None,
        }
    }

    fn localized(self, rotation: Rotation) -> Self {
        match self {
            Self::Local(_) => self,
            Self::FromGlobal(basis) => Self::Local(basis_of(rotation.inverse() * rotation_of(basis))),
        }
    }
}

/// The methods that joints with two frames share.
macro_rules! frame_methods {
    ($joint:ident) => {
        impl $joint {
            /// Sets the frame on the first body, relative to it.
            pub fn with_local_frame1(mut self, frame: impl Into<Isometry>) -> Self {
                self.frame1 = JointFrame::local(frame);
                self
            }

            /// Sets the frame on the second body, relative to it.
            pub fn with_local_frame2(mut self, frame: impl Into<Isometry>) -> Self {
                self.frame2 = JointFrame::local(frame);
                self
            }

            /// Sets both anchors to a point in the world, in metres.
            pub const fn with_anchor(mut self, anchor: Vector) -> Self {
                self.frame1.anchor = JointAnchor::FromGlobal(anchor);
                self.frame2.anchor = JointAnchor::FromGlobal(anchor);
                self
            }

            /// Sets the anchor on the first body, relative to it, in metres.
            pub const fn with_local_anchor1(mut self, anchor: Vector) -> Self {
                self.frame1.anchor = JointAnchor::Local(anchor);
                self
            }

            /// Sets the anchor on the second body, relative to it, in metres.
            pub const fn with_local_anchor2(mut self, anchor: Vector) -> Self {
                self.frame2.anchor = JointAnchor::Local(anchor);
                self
            }

            /// Sets both bases to a rotation in the world.
            pub fn with_basis(mut self, basis: impl Into<Rot>) -> Self {
                let basis = JointBasis::FromGlobal(basis.into());
                (self.frame1.basis, self.frame2.basis) = (basis, basis);
                self
            }

            /// Sets the basis on the first body, relative to it.
            pub fn with_local_basis1(mut self, basis: impl Into<Rot>) -> Self {
                self.frame1.basis = JointBasis::Local(basis.into());
                self
            }

            /// Sets the basis on the second body, relative to it.
            pub fn with_local_basis2(mut self, basis: impl Into<Rot>) -> Self {
                self.frame2.basis = JointBasis::Local(basis.into());
                self
            }

            /// The frame on the first body, if it is local.
            pub fn local_frame1(&self) -> Option<Isometry> {
                self.frame1.get_local_isometry()
            }

            /// The frame on the second body, if it is local.
            pub fn local_frame2(&self) -> Option<Isometry> {
                self.frame2.get_local_isometry()
            }

            /// The anchor on the first body in metres, if it is local.
            pub const fn local_anchor1(&self) -> Option<Vector> {
                self.frame1.anchor.local()
            }

            /// The anchor on the second body in metres, if it is local.
            pub const fn local_anchor2(&self) -> Option<Vector> {
                self.frame2.anchor.local()
            }

            /// The basis on the first body, if it is local.
            pub const fn local_basis1(&self) -> Option<Rot> {
                self.frame1.basis.local()
            }

            /// The basis on the second body, if it is local.
            pub const fn local_basis2(&self) -> Option<Rot> {
                self.frame2.basis.local()
            }
        }
    };
}

pub(super) use frame_methods;
