//! Values that parry's convex hulls are deserialized from. Their fields are private, and their
//! constructors recompute some of them from other data, so deserializing checked values is the only way to
//! restore all bits.

use serde::{
    Deserialize, Deserializer,
    de::{IntoDeserializer, Visitor, value::SeqDeserializer},
    forward_to_deserialize_any,
};

use super::check::Fault;
use crate::math::{Scalar, Vector};

/// A value in memory. A structure is the list of its fields.
#[allow(dead_code, reason = "polygons have neither flags nor indices")]
pub(super) enum Piece {
    /// A truth value.
    Flag(bool),
    /// An index or a count.
    Index(u32),
    /// A number. An `f32` is stored as an `f64` and restored exactly.
    Number(Scalar),
    /// A list or structure.
    List(Vec<Piece>),
}

impl Piece {
    /// A list.
    pub fn list<T>(items: impl IntoIterator<Item = T>, piece: impl Fn(T) -> Self) -> Self {
        Self::List(items.into_iter().map(piece).collect())
    }

    /// A list of vectors.
    pub fn vectors(vectors: &[Vector]) -> Self {
        Self::list(vectors, |v| Self::vector(*v))
    }

    /// A vector.
    pub fn vector(vector: Vector) -> Self {
        Self::list(vector.to_array(), Self::Number)
    }

    /// Deserializes a value from the list of its fields.
    pub fn build<T: for<'de> Deserialize<'de>>(self) -> Result<T, Fault> {
        T::deserialize(self).map_err(|_| "parry has other fields")
    }
}

impl<'de> Deserializer<'de> for Piece {
    type Error = serde::de::value::Error;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Self::Error> {
        match self {
            Self::Flag(flag) => visitor.visit_bool(flag),
            Self::Index(index) => visitor.visit_u32(index),
            Self::Number(number) => visitor.visit_f64(number as f64),
            Self::List(pieces) => visitor.visit_seq(SeqDeserializer::new(pieces.into_iter())),
        }
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf option unit unit_struct
        newtype_struct seq tuple tuple_struct map struct enum identifier ignored_any
    }
}

impl IntoDeserializer<'_> for Piece {
    type Deserializer = Self;

    fn into_deserializer(self) -> Self {
        self
    }
}
