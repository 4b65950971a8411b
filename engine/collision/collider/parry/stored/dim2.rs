//! Stored formats of 2D shapes. `dim3.rs` exports the same names.

#[cfg(test)]
#[path = "tests2d.rs"]
pub(super) mod tests;

use bevy_math::primitives::{Ellipse, RegularPolygon};
use serde::{Deserialize, Serialize};

use super::{
    check::{Fault, check_heights, check_lengths, check_normals, check_points, round},
    piece::Piece,
};
use crate::{
    collision::collider::parry::{EllipseColliderShape, RegularPolygonColliderShape},
    math::{Scalar, Vector},
    parry::{
        math::Rotation,
        shape::{ConvexPolygon, HeightField, Polyline, PolylineFlags, RoundShape, SharedShape, TypedShape},
    },
};

/// Whether a shape has its faces. True in 2D, where shapes have no faces.
pub(super) fn has_faces(_: &SharedShape) -> bool {
    true
}

/// Stored format of a rotation: cosine and sine.
pub(super) type StoredRotation = [Scalar; 2];

/// The stored format of a rotation.
pub(super) fn stored_rotation(rotation: Rotation) -> StoredRotation {
    [rotation.re, rotation.im]
}

/// The rotation of a stored format.
pub(super) fn rotation([re, im]: StoredRotation) -> Rotation {
    Rotation { re, im }
}

/// The bits of a polyline's flags.
pub(super) fn polyline_flags(line: &Polyline) -> u8 {
    line.flags().bits()
}

/// A polyline.
pub(super) fn polyline(vertices: Vec<Vector>, indices: Vec<[u32; 2]>, flags: u8) -> Result<Polyline, Fault> {
    let flags = PolylineFlags::from_bits(flags).ok_or("a polyline has unknown flags")?;
    Ok(Polyline::with_flags(vertices, Some(indices), flags))
}

/// Stored format of a height field.
#[derive(Serialize, Deserialize)]
#[serde(rename = "HeightField")]
pub(super) struct StoredHeights {
    heights: Vec<Scalar>,
    /// Whether the segment after each height exists.
    cells: Vec<bool>,
    scale: Vector,
}

impl StoredHeights {
    /// The stored format of a height field.
    pub fn of(field: &HeightField) -> Self {
        let cells = (0..field.num_cells()).map(|i| !field.is_segment_removed(i)).collect();
        Self { heights: field.heights().clone(), cells, scale: field.scale() }
    }

    /// The height field of a stored format.
    pub fn shape(self) -> Result<SharedShape, Fault> {
        if self.heights.len() < 2 || self.cells.len() != self.heights.len() - 1 {
            return Err("a height field has no cells, or others than heights");
        }
        check_lengths([self.scale.x])?;
        check_heights(&self.heights, self.scale.y)?;
        if self.scale.x == 0.0 {
            return Err("a height field has no size");
        }
        let mut field = HeightField::new(self.heights, self.scale);
        for (i, there) in self.cells.into_iter().enumerate() {
            field.set_segment_removed(i, !there);
        }
        Ok(SharedShape::new(field))
    }
}

/// Stored formats of shapes that only 2D has.
#[derive(Serialize, Deserialize)]
pub(super) enum StoredSpecial {
    ConvexPolygon(StoredPolygon),
    RoundConvexPolygon { polygon: StoredPolygon, border_radius: Scalar },
    Ellipse { half_size: [f32; 2] },
    RegularPolygon { circumradius: f32, sides: u32 },
}

impl StoredSpecial {
    /// The stored format of a shape.
    pub fn of(shape: TypedShape<'_>) -> Result<Self, Fault> {
        let custom = match shape {
            TypedShape::ConvexPolygon(polygon) => return Ok(Self::ConvexPolygon(StoredPolygon::of(polygon))),
            TypedShape::RoundConvexPolygon(RoundShape { inner_shape, border_radius }) => {
                let polygon = StoredPolygon::of(inner_shape);
                return Ok(Self::RoundConvexPolygon { polygon, border_radius: *border_radius });
            }
            TypedShape::Custom(custom) => custom,
            _ => return Err("a shape of this type cannot be stored"),
        };
        if let Some(ellipse) = custom.as_shape::<EllipseColliderShape>() {
            Ok(Self::Ellipse { half_size: ellipse.half_size.to_array() })
        } else if let Some(polygon) = custom.as_shape::<RegularPolygonColliderShape>() {
            Ok(Self::RegularPolygon { circumradius: polygon.circumradius(), sides: polygon.sides })
        } else {
            Err("a shape of a type of the app's own cannot be stored")
        }
    }

    /// The shape of a stored format.
    pub fn shape(self) -> Result<SharedShape, Fault> {
        Ok(match self {
            Self::ConvexPolygon(polygon) => SharedShape::new(polygon.polygon()?),
            Self::RoundConvexPolygon { polygon, border_radius } => {
                round(polygon.polygon()?, border_radius, SharedShape::new)?
            }
            Self::Ellipse { half_size } => {
                check_lengths(half_size.map(|v| v as Scalar))?;
                SharedShape::new(EllipseColliderShape(Ellipse { half_size: half_size.into() }))
            }
            Self::RegularPolygon { circumradius, sides } => {
                check_lengths([circumradius.abs() as Scalar])?;
                if circumradius.is_sign_negative() || sides < 3 {
                    return Err("a regular polygon has a negative radius or fewer than three sides");
                }
                let polygon = RegularPolygon::new(circumradius, sides);
                SharedShape::new(RegularPolygonColliderShape(polygon))
            }
        })
    }
}

/// Stored format of a convex polygon. Parry's normals may belong to edges that it has shortened since.
#[derive(Serialize, Deserialize)]
#[serde(rename = "ConvexPolygon")]
pub(super) struct StoredPolygon {
    points: Vec<Vector>,
    normals: Vec<Vector>,
}

impl StoredPolygon {
    fn of(polygon: &ConvexPolygon) -> Self {
        Self { points: polygon.points().to_vec(), normals: polygon.normals().to_vec() }
    }

    fn polygon(self) -> Result<ConvexPolygon, Fault> {
        if self.points.len() < 3 || self.normals.len() != self.points.len() {
            return Err("a convex polygon has too few points, or other normals than points");
        }
        check_points(&self.points)?;
        check_normals(&self.normals)?;
        Piece::List(vec![Piece::vectors(&self.points), Piece::vectors(&self.normals)]).build()
    }
}
