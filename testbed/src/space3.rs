//! 3D parts of the testbed.

use avian3d::math::{Scalar, Vector};
use avian3d::parry::math::Pose;
use avian3d::parry::shape::{Shape, TypedShape};
use avian3d::prelude::*;
use bevy_math::Vec3;
use bevy_transform::components::GlobalTransform;

use crate::draw::Form;
use crate::draw::form::Solid;

/// Number of dimensions.
pub const DIMENSION: u32 = 3;
/// Keeps a point as it is.
pub const PLANE: Vec3 = Vec3::ONE;
/// How far a half-space is drawn, in metres.
const HORIZON: f32 = 500.0;

/// A point of space is one already.
pub fn lifted(point: Vector) -> Vec3 {
    point
}

/// Parry's pose of an entity.
pub fn pose(transform: &GlobalTransform) -> Pose {
    let (_, rotation, translation) = transform.to_scale_rotation_translation();
    Pose::from_parts(translation, rotation)
}

/// Energy of turning, ½ ω·(I ω), in joules, with ω brought into the body's frame.
pub fn spin_energy(inertia: ComputedAngularInertia, spin: AngularVelocity, rotation: Rotation) -> Scalar {
    let local = rotation.0.inverse() * spin.0;
    if inertia.is_finite() { 0.5 * local.dot(inertia.tensor().mul_vec3(local)) } else { 0.0 }
}

/// The geometry of a shape.
pub fn form(shape: &dyn Shape) -> Form {
    let mut solid = Solid::default();
    add(shape, &Pose::IDENTITY, &mut solid);
    Form::Solid(solid)
}

fn add(shape: &dyn Shape, pose: &Pose, solid: &mut Solid) {
    let part = match shape.as_typed_shape() {
        TypedShape::Cuboid(cuboid) => Solid::cuboid(cuboid.half_extents),
        TypedShape::Cylinder(cylinder) => {
            Solid::frustum(cylinder.radius, cylinder.radius, cylinder.half_height)
        }
        TypedShape::Cone(cone) => Solid::frustum(cone.radius, 0.0, cone.half_height),
        TypedShape::ConvexPolyhedron(hull) => meshed(hull.to_trimesh()),
        TypedShape::TriMesh(mesh) => meshed((mesh.vertices().to_vec(), mesh.indices().to_vec())),
        TypedShape::HeightField(field) => meshed(field.to_trimesh()),
        TypedShape::Voxels(voxels) => meshed(voxels.to_trimesh()),
        TypedShape::Triangle(t) => meshed((vec![t.a, t.b, t.c], vec![[0, 1, 2], [0, 2, 1]])),
        TypedShape::HalfSpace(half_space) => floor(half_space.normal),
        TypedShape::RoundCuboid(round) => rounded(round.border_radius, &round.inner_shape),
        TypedShape::RoundTriangle(round) => rounded(round.border_radius, &round.inner_shape),
        TypedShape::RoundCylinder(round) => rounded(round.border_radius, &round.inner_shape),
        TypedShape::RoundCone(round) => rounded(round.border_radius, &round.inner_shape),
        TypedShape::RoundConvexPolyhedron(round) => rounded(round.border_radius, &round.inner_shape),
        TypedShape::Ball(_) | TypedShape::Capsule(_) | TypedShape::Custom(_) => rounded(0.0, shape),
        TypedShape::Compound(compound) => {
            for (place, part) in compound.shapes() {
                add(&**part, &(*pose * *place), solid);
            }
            return;
        }
        // Lines have no surface to shade.
        TypedShape::Segment(_) | TypedShape::Polyline(_) => return,
    };
    solid.append(&part, |p| pose.transform_point(p), |n| pose.rotation * n);
}

fn meshed((positions, triangles): (Vec<Vector>, Vec<[u32; 3]>)) -> Solid {
    Solid::faceted(&positions, triangles)
}

fn floor(normal: Vec3) -> Solid {
    let (u, v) = normal.any_orthonormal_pair();
    let corners =
        [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(s, t)| (u * s + v * t) * HORIZON);
    Solid::faceted(&corners, [[0, 1, 2], [0, 2, 3]])
}

fn rounded(radius: f32, inner: &dyn Shape) -> Solid {
    match inner.as_support_map() {
        Some(map) => Solid::from_support(|direction| map.local_support_point(direction) + radius * direction),
        None => Solid::default(),
    }
}
