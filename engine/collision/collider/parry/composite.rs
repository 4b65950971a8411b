//! Composite shapes: compounds are flat lists.

use super::dim;
use crate::parry::math::Pose;
use crate::parry::shape::{SharedShape, TypedShape};

/// Appends the convex parts of a shape at a pose. Parry's compounds cannot contain composite shapes, so these
/// are decomposed into triangles, segments and boxes.
pub(super) fn flatten(pose: Pose, shape: &SharedShape, out: &mut Vec<(Pose, SharedShape)>) {
    match shape.as_typed_shape() {
        TypedShape::Compound(compound) => {
            for (inner, part) in compound.shapes() {
                flatten(pose * *inner, part, out);
            }
        }
        TypedShape::TriMesh(mesh) => out.extend(mesh.triangles().map(|t| (pose, SharedShape::new(t)))),
        TypedShape::Polyline(line) => out.extend(line.segments().map(|s| (pose, SharedShape::new(s)))),
        TypedShape::HeightField(field) => {
            out.extend(dim::height_field_elements(field).map(|s| (pose, s)));
        }
        TypedShape::Voxels(voxels) => {
            let cell = dim::cuboid_shape(voxels.voxel_size() * 0.5);
            let full = voxels.voxels().filter(|v| !v.state.is_empty());
            out.extend(full.map(|v| {
                let mut at = pose;
                at.translation = pose * v.center;
                (at, cell.clone())
            }));
        }
        _ => out.push((pose, shape.clone())),
    }
}
