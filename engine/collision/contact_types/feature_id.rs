//! [`PackedFeatureId`]: the vertex, edge or face of a shape that makes a contact point.

use bevy_reflect::Reflect;
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};

/// A feature of a shape: its kind in the two highest bits, its number in the others.
///
/// The engine only compares features of two steps, and has one number for both shapes of a point.
/// [`ContactPoint::feature_id1`](super::ContactPoint::feature_id1) contains this number; the kind bits mean
/// nothing there.
#[derive(Copy, Clone, Debug, Hash, PartialEq, Eq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Debug, Hash, PartialEq)]
pub struct PackedFeatureId(pub u32);

impl PackedFeatureId {
    /// No known feature.
    pub const UNKNOWN: Self = Self(0);

    const CODE: u32 = !Self::KIND;
    const KIND: u32 = 0b11 << 30;
    const VERTEX: u32 = 0b01 << 30;
    const EDGE: u32 = 0b10 << 30;
    const FACE: u32 = 0b11 << 30;

    /// The vertex with a number below 2³⁰.
    pub fn vertex(code: u32) -> Self {
        Self::of_kind(Self::VERTEX, code)
    }

    /// The edge with a number below 2³⁰. Shapes in 2D have vertices and faces only.
    pub fn edge(code: u32) -> Self {
        Self::of_kind(Self::EDGE, code)
    }

    /// The face with a number below 2³⁰.
    pub fn face(code: u32) -> Self {
        Self::of_kind(Self::FACE, code)
    }

    fn of_kind(kind: u32, code: u32) -> Self {
        debug_assert_eq!(code & Self::KIND, 0, "the number of a feature has 30 bits");
        Self(kind | code & Self::CODE)
    }

    /// Whether it is a face.
    pub fn is_face(self) -> bool {
        self.0 & Self::KIND == Self::FACE
    }

    /// Whether it is a vertex.
    pub fn is_vertex(self) -> bool {
        self.0 & Self::KIND == Self::VERTEX
    }

    /// Whether it is an edge.
    pub fn is_edge(self) -> bool {
        self.0 & Self::KIND == Self::EDGE
    }

    /// Whether it is [`UNKNOWN`](Self::UNKNOWN).
    pub fn is_unknown(self) -> bool {
        self == Self::UNKNOWN
    }
}

impl From<u32> for PackedFeatureId {
    fn from(code: u32) -> Self {
        Self(code)
    }
}

#[cfg(any(feature = "parry-f32", feature = "parry-f64"))]
impl From<crate::parry::shape::PackedFeatureId> for PackedFeatureId {
    fn from(id: crate::parry::shape::PackedFeatureId) -> Self {
        Self(id.0)
    }
}
