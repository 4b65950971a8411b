//! Scales of shapes that only 2D has, or that differ from 3D. `shapes3` exports the same names.

use super::super::handedness::{stretched_border, turns_winding};
use crate::math::Vector;
use crate::parry::math::Rot2;
use crate::parry::shape::{ConvexPolygon, HeightField, Polyline, RoundShape, SharedShape, TypedShape};

/// The rotation M R M of a part, with the mirror M.
pub(in super::super) fn mirrored_rotation(rotation: Rot2, signs: Vector) -> Rot2 {
    let im = if turns_winding(signs) { -rotation.im } else { rotation.im };
    Rot2::from_cos_sin_unchecked(rotation.re, im)
}

/// A shape with axes mirrored; `None` to leave it to parry.
pub(in super::super) fn mirrored(shape: TypedShape<'_>, signs: Vector) -> Option<SharedShape> {
    match shape {
        TypedShape::ConvexPolygon(polygon) => Some(SharedShape::new(scaled_polygon(polygon, signs)?)),
        TypedShape::RoundConvexPolygon(round) => {
            let inner_shape = scaled_polygon(&round.inner_shape, signs)?;
            Some(SharedShape::new(RoundShape { inner_shape, border_radius: round.border_radius }))
        }
        TypedShape::Polyline(line) => Some(mirrored_polyline(line, signs)),
        TypedShape::HeightField(field) => Some(mirrored_heights(field, signs)),
        _ => None,
    }
}

/// A shape with positive scales along its axes; `None` to leave it to parry.
pub(in super::super) fn stretched(shape: TypedShape<'_>, size: Vector) -> Option<SharedShape> {
    match shape {
        TypedShape::ConvexPolygon(polygon) if size.x != size.y => {
            Some(SharedShape::new(scaled_polygon(polygon, size)?))
        }
        TypedShape::RoundConvexPolygon(round) => {
            let inner_shape = scaled_polygon(&round.inner_shape, size)?;
            let border_radius = stretched_border(round.border_radius, size);
            Some(SharedShape::new(RoundShape { inner_shape, border_radius }))
        }
        _ => None,
    }
}

/// A polygon with its corners scaled, counter-clockwise.
fn scaled_polygon(polygon: &ConvexPolygon, scale: Vector) -> Option<ConvexPolygon> {
    let mut corners: Vec<Vector> = polygon.points().iter().map(|corner| *corner * scale).collect();
    if turns_winding(scale) {
        corners.reverse();
    }
    ConvexPolygon::from_convex_polyline_unmodified(corners)
}

/// Mirrored segments are reversed, so that the inside of an oriented line stays on the same side of it.
fn mirrored_polyline(line: &Polyline, signs: Vector) -> SharedShape {
    let vertices = line.vertices().iter().map(|v| *v * signs).collect();
    let mut segments = line.indices().to_vec();
    if turns_winding(signs) {
        segments.iter_mut().for_each(|segment| segment.reverse());
    }
    SharedShape::new(Polyline::with_flags(vertices, Some(segments), line.flags()))
}

fn mirrored_heights(field: &HeightField, signs: Vector) -> SharedShape {
    let mut heights: Vec<_> = field.heights().iter().map(|height| height * signs.y).collect();
    let mut removed: Vec<bool> = (0..field.num_cells()).map(|cell| field.is_segment_removed(cell)).collect();
    if signs.x < 0.0 {
        heights.reverse();
        removed.reverse();
    }
    let mut mirrored = HeightField::new(heights, field.scale());
    removed.into_iter().enumerate().for_each(|(cell, removed)| mirrored.set_segment_removed(cell, removed));
    SharedShape::new(mirrored)
}
