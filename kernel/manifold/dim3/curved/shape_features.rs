//! The features of both shapes for contacts: planes, the part that faces the other shape, and lines on the
//! side.

use super::super::clip;
use super::super::gjk::Core;
use super::super::view::View;
use super::patch::{Disc, Face, Patch};
use crate::math::{Vector, max, min};
use crate::shape::Curved;
use crate::tuning::manifold::{ROLLING, SIDEWAYS};

/// The first shape of a pair, in its own frame.
pub(super) trait ShapeFeatures: Core {
    /// The radius around the core.
    fn radius(&self) -> f32;
    /// The distance from the centre to the farthest point, about.
    fn extent(&self) -> f32;
    /// The number of planes.
    fn planes(&self) -> usize;
    /// The outward normal of a plane, and its distance from the origin.
    fn plane(&self, plane: usize) -> (Vector, f32);
    /// The part of the surface in a plane.
    fn part(&self, plane: usize) -> Patch<'_>;
    /// The part at the farthest point that faces a direction most.
    fn facing(&self, direction: Vector) -> Patch<'_>;
    /// The axis of a cylinder, or of a segment with a radius.
    fn axis(&self) -> Option<[Vector; 2]>;
    /// The line of the core that is farthest along a direction, and across it.
    fn line_along(&self, direction: Vector) -> Option<[Vector; 2]>;
    /// The distance from the surface to the axis or centre that it may roll about, along a normal; 0 if it
    /// cannot roll there.
    fn rolling(&self, normal: Vector) -> f32;
    /// The distance from a point in the core to its surface; negative outside.
    fn depth_of(&self, point: Vector) -> f32;
}

impl ShapeFeatures for View<'_> {
    fn radius(&self) -> f32 {
        self.radius
    }

    fn extent(&self) -> f32 {
        self.extent
    }

    fn planes(&self) -> usize {
        self.faces.len()
    }

    fn plane(&self, plane: usize) -> (Vector, f32) {
        (self.faces[plane].normal, self.faces[plane].offset)
    }

    fn part(&self, plane: usize) -> Patch<'_> {
        let face = &self.faces[plane];
        let (normal, offset) = (face.normal, face.offset);
        Patch::Face(Face { vertices: self.vertices, outline: self.outline(plane), normal, offset })
    }

    fn facing(&self, direction: Vector) -> Patch<'_> {
        match clip::incident_face(self, -direction, self.support(direction)) {
            Some(face) => self.part(face),
            None => Patch::Line([self.vertices[0], self.vertices[self.vertices.len() - 1]]),
        }
    }

    fn axis(&self) -> Option<[Vector; 2]> {
        (self.vertices.len() == 2).then(|| [self.vertices[0], self.vertices[1]])
    }

    fn line_along(&self, direction: Vector) -> Option<[Vector; 2]> {
        self.axis().filter(|ends| is_across(ends, direction))
    }

    fn rolling(&self, _: Vector) -> f32 {
        self.radius
    }

    fn depth_of(&self, point: Vector) -> f32 {
        let depths = self.faces.iter().map(|f| f.offset - f.normal.dot(point));
        depths.reduce(min).unwrap_or(f32::NEG_INFINITY)
    }
}

impl ShapeFeatures for Curved {
    fn radius(&self) -> f32 {
        0.0
    }

    fn extent(&self) -> f32 {
        self.extent(Vector::ZERO)
    }

    fn planes(&self) -> usize {
        2
    }

    fn plane(&self, plane: usize) -> (Vector, f32) {
        (Vector::Y * if plane == 0 { -1.0 } else { 1.0 }, self.half_height)
    }

    fn part(&self, plane: usize) -> Patch<'_> {
        Patch::Disc(disc(self, plane))
    }

    fn facing(&self, direction: Vector) -> Patch<'_> {
        let (length, around) = across(direction);
        let end = self.end_along(length, direction.y);
        let (outward, upward) = self.slope();
        let on_side = length * outward + direction.y * upward;
        let on_end = if end == 0 { -direction.y } else { direction.y };
        // A tip has no end to stand on.
        if on_end > on_side && self.radius_of(end) > 0.0 {
            Patch::Disc(disc(self, end))
        } else {
            Patch::Line(side_line(self, around))
        }
    }

    fn axis(&self) -> Option<[Vector; 2]> {
        (self.lower == self.upper).then(|| [Vector::Y * -self.half_height, Vector::Y * self.half_height])
    }

    fn line_along(&self, direction: Vector) -> Option<[Vector; 2]> {
        let ends = side_line(self, across(direction).1);
        (self.half_height > 0.0 && is_across(&ends, direction)).then_some(ends)
    }

    fn rolling(&self, normal: Vector) -> f32 {
        let (length, around) = across(normal);
        let size = (length * length + normal.y * normal.y).sqrt();
        if !(length > ROLLING * size) {
            return 0.0;
        }
        let ends = side_line(self, around);
        let radius = if is_across(&ends, normal) {
            0.5 * (self.lower + self.upper)
        } else {
            self.radius_of(self.end_along(length, normal.y))
        };
        radius * size / max(length, f32::MIN_POSITIVE)
    }

    fn depth_of(&self, point: Vector) -> f32 {
        -self.nearest(point).distance
    }
}

fn is_across(ends: &[Vector; 2], direction: Vector) -> bool {
    let along = ends[1] - ends[0];
    along.dot(direction).abs() <= SIDEWAYS * along.length() * direction.length()
}

/// The part of a direction across the axis, and its unit vector.
pub(super) fn across(direction: Vector) -> (f32, Vector) {
    let length = (direction.x * direction.x + direction.z * direction.z).sqrt();
    if length > 1.0e-15 {
        (length, Vector { x: direction.x / length, y: 0.0, z: direction.z / length })
    } else {
        (0.0, Vector::X)
    }
}

/// The end of a frustum, in its own frame.
fn disc(shape: &Curved, end: usize) -> Disc {
    Disc {
        center: Vector::Y * shape.height_of(end),
        normal: Vector::Y * if end == 0 { -1.0 } else { 1.0 },
        radius: shape.radius_of(end),
        hint: Vector::X,
    }
}

/// The line of the side in a direction across the axis.
fn side_line(shape: &Curved, around: Vector) -> [Vector; 2] {
    [0, 1].map(|end| around * shape.radius_of(end) + Vector::Y * shape.height_of(end))
}
