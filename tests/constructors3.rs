//! 3D parts of the constructors. `constructors2.rs` has those of 2D.

use avian::{
    math::{Scalar, Vector},
    prelude::{ColliderConstructor as C, *},
};
use bevy_asset::RenderAssetUsages;
use bevy_math::{IVec3, Quat, primitives};
use bevy_mesh::{Indices, Mesh, MeshBuilder, Meshable, PrimitiveTopology};

pub use bevy_mesh::Mesh3d as MeshComponent;

fn corners() -> Vec<Vector> {
    (0..8).map(|i| Vector::new((i & 1) as _, (i >> 1 & 1) as _, (i >> 2) as _)).collect()
}

/// The surface of the cube of `corners`.
fn faces() -> Vec<[u32; 3]> {
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    quads.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect()
}

/// Each constructor with the collider of its function.
pub fn describes() -> Vec<(C, Collider)> {
    let (a, b, c) = (Vector::ZERO, Vector::X, Vector::new(0.3, 1.0, 0.2));
    let (vertices, indices) = (corners(), faces());
    let flags = TrimeshFlags::FIX_INTERNAL_EDGES;
    let params = VhacdParameters { resolution: 16, ..Default::default() };
    let cells = vec![IVec3::ZERO, IVec3::new(1, 2, 3)];
    let heights = vec![vec![0.0, 1.0, 0.5], vec![0.2, 0.1, 0.3]];
    let scale = Vector::new(3.0, 1.0, 2.0);
    let fill_mode = FillMode::FloodFill { detect_cavities: false };
    let (at, turned) = (Position(Vector::Y), Rotation(Quat::from_rotation_x(0.5)));
    let mesh = || (vertices.clone(), indices.clone());
    vec![
        (C::Sphere { radius: 0.7 }, Collider::sphere(0.7)),
        (C::Cuboid { x_length: 1.0, y_length: 2.0, z_length: 3.0 }, Collider::cuboid(1.0, 2.0, 3.0)),
        (
            C::RoundCuboid { x_length: 1.0, y_length: 2.0, z_length: 3.0, border_radius: 0.1 },
            Collider::round_cuboid(1.0, 2.0, 3.0, 0.1),
        ),
        (C::Cylinder { radius: 0.5, height: 2.0 }, Collider::cylinder(0.5, 2.0)),
        (C::Cone { radius: 0.5, height: 2.0 }, Collider::cone(0.5, 2.0)),
        (C::Capsule { radius: 0.5, height: 2.0 }, Collider::capsule(0.5, 2.0)),
        (C::CapsuleEndpoints { radius: 0.5, a, b }, Collider::capsule_endpoints(0.5, a, b)),
        (C::HalfSpace { outward_normal: c }, Collider::half_space(c)),
        (C::Segment { a, b }, Collider::segment(a, b)),
        (C::Triangle { a, b, c }, Collider::triangle(a, b, c)),
        (C::Polyline { vertices: mesh().0, indices: None }, Collider::polyline(mesh().0, None)),
        (
            C::Polyline { vertices: mesh().0, indices: Some(vec![[0, 3], [2, 5]]) },
            Collider::polyline(mesh().0, Some(vec![[0, 3], [2, 5]])),
        ),
        (C::Trimesh { vertices: mesh().0, indices: mesh().1 }, Collider::trimesh(mesh().0, mesh().1)),
        (
            C::TrimeshWithConfig { vertices: mesh().0, indices: mesh().1, flags },
            Collider::trimesh_with_config(mesh().0, mesh().1, flags),
        ),
        (
            C::ConvexDecomposition { vertices: mesh().0, indices: mesh().1 },
            Collider::convex_decomposition(mesh().0, mesh().1),
        ),
        (
            C::ConvexDecompositionWithConfig {
                vertices: mesh().0,
                indices: mesh().1,
                params: params.clone(),
            },
            Collider::convex_decomposition_with_config(mesh().0, mesh().1, params),
        ),
        (C::ConvexHull { points: mesh().0 }, Collider::convex_hull(mesh().0).expect("a cube")),
        (C::Voxels { voxel_size: scale, grid_coordinates: cells.clone() }, Collider::voxels(scale, &cells)),
        (
            C::VoxelizedTrimesh { vertices: mesh().0, indices: mesh().1, voxel_size: 0.25, fill_mode },
            Collider::voxelized_trimesh(&vertices, &indices, 0.25, fill_mode),
        ),
        (C::Heightfield { heights: heights.clone(), scale }, Collider::heightfield(heights, scale)),
        (
            C::Compound(vec![(at, turned, C::Sphere { radius: 0.5 })]),
            Collider::compound(vec![(at, turned, Collider::sphere(0.5))]),
        ),
    ]
}

/// Constructors from a mesh with the colliders of their functions.
pub fn made_of(mesh: &Mesh) -> Vec<(C, Collider)> {
    let flags = TrimeshFlags::FIX_INTERNAL_EDGES;
    let params = VhacdParameters { resolution: 16, ..Default::default() };
    let fill_mode = FillMode::SurfaceOnly;
    let made = |collider: Option<Collider>| collider.expect("a mesh of triangles");
    vec![
        (C::TrimeshFromMesh, made(Collider::trimesh_from_mesh(mesh))),
        (C::TrimeshFromMeshWithConfig(flags), made(Collider::trimesh_from_mesh_with_config(mesh, flags))),
        (C::ConvexHullFromMesh, made(Collider::convex_hull_from_mesh(mesh))),
        (C::ConvexDecompositionFromMesh, made(Collider::convex_decomposition_from_mesh(mesh))),
        (
            C::ConvexDecompositionFromMeshWithConfig(params.clone()),
            made(Collider::convex_decomposition_from_mesh_with_config(mesh, &params)),
        ),
        (
            C::VoxelizedTrimeshFromMesh { voxel_size: 0.25, fill_mode },
            made(Collider::voxelized_trimesh_from_mesh(mesh, 0.25, fill_mode)),
        ),
    ]
}

/// Solid meshes, with and without indices.
pub fn shape_of_mesh() -> Vec<Mesh> {
    let cube = Mesh::from(primitives::Cuboid::new(1.0, 2.0, 3.0));
    let unindexed = cube.clone().with_duplicated_vertices();
    vec![cube, unindexed, Mesh::from(primitives::Sphere::new(1.0))]
}

/// Constructors that make no shape.
pub fn wrong() -> Vec<C> {
    let (nan, fill_mode) = (Scalar::NAN, FillMode::SurfaceOnly);
    vec![
        C::Sphere { radius: nan },
        C::Cuboid { x_length: 1.0, y_length: 0.0, z_length: 1.0 },
        C::RoundCuboid { x_length: 1.0, y_length: 1.0, z_length: 1.0, border_radius: -0.1 },
        C::Cylinder { radius: 1.0, height: nan },
        C::Cone { radius: -1.0, height: 1.0 },
        C::ConvexDecomposition { vertices: vec![], indices: vec![] },
        C::ConvexDecomposition { vertices: vec![Vector::splat(nan); 3], indices: vec![[0, 1, 2]] },
        C::VoxelizedTrimesh { vertices: corners(), indices: faces(), voxel_size: 0.0, fill_mode },
        C::VoxelizedTrimesh { vertices: corners(), indices: faces(), voxel_size: 2.0e-5, fill_mode },
        C::VoxelizedTrimesh { vertices: corners(), indices: vec![[0, 1, 8]], voxel_size: 0.1, fill_mode },
        C::Heightfield { heights: vec![], scale: Vector::ONE },
        C::Heightfield { heights: vec![vec![1.0; 5], vec![1.0]], scale: Vector::ONE },
        C::Heightfield { heights: vec![vec![1.0; 5]; 5], scale: Vector::splat(nan) },
        C::compound(vec![(
            Vector::ZERO,
            Rotation(Quat::from_xyzw(0.0, 0.0, 0.0, 0.0)),
            C::Sphere { radius: 1.0 },
        )]),
    ]
}

/// A turn of the frame of a node.
pub fn turn(angle: f32) -> Quat {
    Quat::from_euler(bevy_math::EulerRot::XYZ, angle, 2.0 * angle, 0.5 - angle)
}

/// Meshes of a level. Their triangles all have an area.
pub fn level_meshes() -> Vec<Mesh> {
    let strip: Vec<[f32; 3]> =
        (0..20).map(|i| [(i / 2) as f32, 0.1 * (i % 3) as f32, (i % 2) as f32]).collect();
    vec![
        Mesh::from(primitives::Cuboid::new(4.0, 1.0, 2.0)),
        primitives::Plane3d::default().mesh().size(10.0, 10.0).subdivisions(3).build(),
        Mesh::from(primitives::Torus::new(0.5, 2.0)),
        Mesh::new(PrimitiveTopology::TriangleStrip, RenderAssetUsages::default())
            .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, strip)
            .with_inserted_indices(Indices::U32((0..20).collect())),
    ]
}

/// A point in the engine's type.
pub fn point(point: bevy_math::Vec3) -> Vector {
    Vector::new(point.x as _, point.y as _, point.z as _)
}
