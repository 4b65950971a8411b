//! Serialization of a [`Collider`]: the definition of its shape, its scale, and its number of subdivisions.
//!
//! Trees of boxes, topology and all other derived data are computed again, to the same bits. Only parry's
//! tree over voxels depends on the order of a hash map, as it does without serialization. A definition that
//! makes no shape is an error of the deserializer.

mod check;
#[cfg_attr(feature = "2d", path = "dim2.rs")]
#[cfg_attr(feature = "3d", path = "dim3.rs")]
mod dim;
mod part;
mod piece;
#[cfg(test)]
mod tests;

use serde::{Deserialize, Deserializer, Serialize, Serializer, de, ser};

use super::{
    Collider, has_extent,
    input::{MAX_LENGTH, MIN_LENGTH, without_panic},
};
use crate::{
    math::{Scalar, Vector},
    parry::{
        math::Pose,
        shape::{Compound, SharedShape, TriMesh, TriMeshFlags, TypedShape},
    },
};
use check::{Fault, check_elements};
use part::Part;

/// Maximum number of subdivisions that is read: the number of points is up to its square.
const MAX_DETAIL: u32 = 1024;

/// Stored format of a collider.
#[derive(Serialize, Deserialize)]
#[serde(rename = "Collider")]
struct StoredCollider {
    shape: StoredShape,
    scale: Vector,
    /// As in [`Collider::set_scale`].
    detail: u32,
}

/// Stored format of a shape. Compounds contain no compounds or meshes, so there is no recursion.
#[derive(Serialize, Deserialize)]
enum StoredShape {
    /// One shape.
    Single(Part),
    /// A compound of parts.
    Compound(Vec<PlacedPart>),
    /// A triangle mesh.
    Trimesh {
        /// The corners of the triangles.
        vertices: Vec<Vector>,
        /// Three indices per triangle.
        indices: Vec<[u32; 3]>,
        /// The bits of parry's `TriMeshFlags`.
        flags: u16,
    },
    /// A polyline.
    Polyline {
        /// The ends of the segments.
        vertices: Vec<Vector>,
        /// Two indices per segment.
        indices: Vec<[u32; 2]>,
        /// The bits of parry's `PolylineFlags`; none in 3D.
        flags: u8,
    },
}

/// A part of a compound.
#[derive(Serialize, Deserialize)]
struct PlacedPart {
    position: Vector,
    rotation: dim::StoredRotation,
    shape: Part,
}

impl Serialize for Collider {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let shape = StoredShape::of(&self.shape).map_err(ser::Error::custom)?;
        StoredCollider { shape, scale: self.scale, detail: self.detail }.serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Collider {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let stored = StoredCollider::deserialize(deserializer)?;
        // Parry's algorithms may assert conditions that cannot be checked earlier.
        let collider = without_panic(|| stored.collider());
        collider.unwrap_or(Err("a collider's shape is degenerate")).map_err(de::Error::custom)
    }
}

impl StoredCollider {
    fn collider(self) -> Result<Collider, Fault> {
        let usable = |s: Scalar| (MIN_LENGTH..=MAX_LENGTH).contains(&s.abs());
        if !self.scale.to_array().into_iter().all(usable) {
            return Err("a collider's scale is zero, too large or not a number");
        }
        if self.detail > MAX_DETAIL {
            return Err("a collider's scale is resolved too finely");
        }
        let shape = self.shape.shape()?;
        if !has_extent(&shape) {
            return Err("a collider's shape has no finite extent");
        }
        let mut collider = Collider::from(shape);
        collider.set_scale(self.scale, self.detail);
        collider.detail = self.detail;
        if !dim::has_faces(collider.shape_scaled()) {
            return Err("a collider's shape has no faces at its scale");
        }
        Ok(collider)
    }
}

impl StoredShape {
    fn of(shape: &SharedShape) -> Result<Self, Fault> {
        Ok(match shape.as_typed_shape() {
            TypedShape::Compound(compound) => {
                let placed = |(pose, part): &(Pose, SharedShape)| {
                    let (position, rotation) = (pose.translation, dim::stored_rotation(pose.rotation));
                    Ok(PlacedPart { position, rotation, shape: Part::of(part)? })
                };
                Self::Compound(compound.shapes().iter().map(placed).collect::<Result<_, Fault>>()?)
            }
            TypedShape::TriMesh(mesh) => Self::Trimesh {
                vertices: mesh.vertices().to_vec(),
                indices: mesh.indices().to_vec(),
                flags: mesh.flags().bits(),
            },
            TypedShape::Polyline(line) => Self::Polyline {
                vertices: line.vertices().to_vec(),
                indices: line.indices().to_vec(),
                flags: dim::polyline_flags(line),
            },
            _ => Self::Single(Part::of(shape)?),
        })
    }

    fn shape(self) -> Result<SharedShape, Fault> {
        Ok(match self {
            Self::Single(part) => part.shape()?,
            Self::Compound(parts) if parts.is_empty() => return Err("a compound has no parts"),
            Self::Compound(parts) => {
                let placed = parts.into_iter().map(|part| Ok((part.pose()?, part.shape.shape()?)));
                SharedShape::new(Compound::new(placed.collect::<Result<_, Fault>>()?))
            }
            Self::Trimesh { vertices, indices, flags } => {
                check_elements(&vertices, &indices)?;
                let flags = TriMeshFlags::from_bits(flags).ok_or("a mesh has unknown flags")?;
                let mesh = TriMesh::with_flags(vertices, indices, flags);
                let usable = mesh.ok().filter(|mesh| !mesh.indices().is_empty());
                SharedShape::new(usable.ok_or("a mesh has no triangles")?)
            }
            Self::Polyline { vertices, indices, flags } => {
                check_elements(&vertices, &indices)?;
                SharedShape::new(dim::polyline(vertices, indices, flags)?)
            }
        })
    }
}

impl PlacedPart {
    fn pose(&self) -> Result<Pose, Fault> {
        let rotation = dim::rotation(self.rotation);
        // The tolerance covers rounding.
        let is_rotation = (rotation.length() - 1.0).abs() < 1.0e-3;
        if !self.position.is_finite() || !is_rotation {
            return Err("a part of a compound has no pose");
        }
        Ok(Pose::from_parts(self.position, rotation))
    }
}
