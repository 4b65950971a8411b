//! Outlines of colliders, in their own frames.

use super::{
    dim::{
        edges,
        outline::{add_of_dimension, place},
        point,
    },
    lines::Strips,
    voxels::add_voxels,
};
use crate::{
    collision::collider::Collider,
    parry::shape::{Shape, TypedShape},
};

/// The outline of a collider, with its scale.
pub(super) fn outline(collider: &Collider) -> Strips {
    let mut lines = Strips::default();
    add(&**collider.shape_scaled(), &mut lines);
    lines
}

fn add(shape: &dyn Shape, lines: &mut Strips) {
    match shape.as_typed_shape() {
        TypedShape::Segment(s) => lines.push([s.a, s.b].map(point)),
        TypedShape::Polyline(line) => line.segments().for_each(|s| lines.push([s.a, s.b].map(point))),
        TypedShape::TriMesh(mesh) => {
            mesh.triangles().for_each(|t| lines.push_closed([t.a, t.b, t.c].map(point)));
        }
        TypedShape::Voxels(shape) => add_voxels(shape, lines),
        TypedShape::Compound(compound) => {
            for (pose, part) in compound.shapes() {
                let mut own = Strips::default();
                add(&**part, &mut own);
                lines.push_placed(&own, &place(pose));
            }
        }
        other => {
            if !add_of_dimension(&other, lines) {
                let aabb = shape.compute_local_aabb();
                lines.push(edges(point(aabb.mins), point(aabb.maxs)));
            }
        }
    }
}
