//! Composite shapes: compounds are flat lists, and are scaled part by part.

use super::dim;
use super::input::{is_usable, without_panic};
use crate::math::Vector;
use crate::parry::math::Pose;
use crate::parry::shape::{SharedShape, TypedShape};

/// Appends the convex parts of a shape at a pose. Parry's compounds cannot contain composite shapes, so these are
/// decomposed into triangles, segments and boxes.
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

/// The shape scaled along its axes; `None` if no shape of parry is that.
pub(super) fn scaled(shape: &SharedShape, scale: Vector, subdivisions: u32) -> Option<SharedShape> {
    if scale == Vector::ONE {
        return Some(shape.clone());
    }
    // Curved shapes become hulls, from a triangle up to what still collides fast.
    let subdivisions = subdivisions.clamp(2, 100);
    let scaled = match shape.as_typed_shape() {
        TypedShape::Compound(compound) => {
            let parts = compound.shapes().iter().map(|(pose, part)| {
                let mut pose = *pose;
                pose.translation *= scale;
                Some((pose, scaled(part, dim::scale_in_frame(scale, pose.rotation), subdivisions)?))
            });
            SharedShape::compound(parts.collect::<Option<Vec<_>>>()?)
        }
        TypedShape::Cuboid(cuboid) => dim::cuboid_shape(cuboid.half_extents * scale.abs()),
        _ => SharedShape(without_panic(|| shape.scale_dyn(scale, subdivisions))??.into()),
    };
    let aabb = scaled.compute_local_aabb();
    let endless = matches!(scaled.as_typed_shape(), TypedShape::HalfSpace(_));
    (endless || is_usable(aabb.mins) && is_usable(aabb.maxs)).then_some(scaled)
}
