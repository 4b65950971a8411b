//! 2D parts of the constructors. `constructors3.rs` has those of 3D.

use avian::{
    math::{Scalar, Vector},
    prelude::{ColliderConstructor as C, *},
};
use bevy_asset::RenderAssetUsages;
use bevy_math::{IVec2, Quat, primitives};
use bevy_mesh::{Indices, Mesh, PrimitiveTopology};

pub use bevy_mesh::Mesh2d as MeshComponent;

fn corners() -> Vec<Vector> {
    vec![Vector::ZERO, Vector::X, Vector::ONE, Vector::Y]
}

/// The outline of the square of `corners`.
fn sides() -> Vec<[u32; 2]> {
    vec![[0, 1], [1, 2], [2, 3], [3, 0]]
}

/// Each constructor with the collider of its function.
pub fn describes() -> Vec<(C, Collider)> {
    let (a, b, c) = (Vector::ZERO, Vector::X, Vector::new(0.3, 1.0));
    let (vertices, indices) = (corners(), sides());
    let triangles = || vec![[0, 1, 2], [0, 2, 3]];
    let flags = TrimeshFlags::MERGE_DUPLICATE_VERTICES;
    let params = VhacdParameters { resolution: 32, ..Default::default() };
    let cells = vec![IVec2::ZERO, IVec2::new(1, 2)];
    let heights = vec![0.0, 1.0, 0.5];
    let scale = Vector::new(3.0, 1.0);
    let fill_mode = FillMode::FloodFill { detect_cavities: false, detect_self_intersections: false };
    let (at, turned) = (Position(Vector::Y), Rotation::radians(0.5));
    let outline = || (vertices.clone(), indices.clone());
    vec![
        (C::Circle { radius: 0.7 }, Collider::circle(0.7)),
        (C::Rectangle { x_length: 1.0, y_length: 2.0 }, Collider::rectangle(1.0, 2.0)),
        (
            C::RoundRectangle { x_length: 1.0, y_length: 2.0, border_radius: 0.1 },
            Collider::round_rectangle(1.0, 2.0, 0.1),
        ),
        (C::Ellipse { half_width: 0.5, half_height: 2.0 }, Collider::ellipse(0.5, 2.0)),
        (C::RegularPolygon { circumradius: 0.5, sides: 7 }, Collider::regular_polygon(0.5, 7)),
        (C::Capsule { radius: 0.5, height: 2.0 }, Collider::capsule(0.5, 2.0)),
        (C::CapsuleEndpoints { radius: 0.5, a, b }, Collider::capsule_endpoints(0.5, a, b)),
        (C::HalfSpace { outward_normal: c }, Collider::half_space(c)),
        (C::Segment { a, b }, Collider::segment(a, b)),
        (C::Triangle { a, b, c }, Collider::triangle(a, b, c)),
        (C::Polyline { vertices: outline().0, indices: None }, Collider::polyline(outline().0, None)),
        (
            C::Polyline { vertices: outline().0, indices: Some(vec![[0, 3], [2, 1]]) },
            Collider::polyline(outline().0, Some(vec![[0, 3], [2, 1]])),
        ),
        (
            C::Trimesh { vertices: outline().0, indices: triangles() },
            Collider::trimesh(outline().0, triangles()),
        ),
        (
            C::TrimeshWithConfig { vertices: outline().0, indices: triangles(), flags },
            Collider::trimesh_with_config(outline().0, triangles(), flags),
        ),
        (
            C::ConvexDecomposition { vertices: outline().0, indices: outline().1 },
            Collider::convex_decomposition(outline().0, outline().1),
        ),
        (
            C::ConvexDecompositionWithConfig {
                vertices: outline().0,
                indices: outline().1,
                params: params.clone(),
            },
            Collider::convex_decomposition_with_config(outline().0, outline().1, &params),
        ),
        (C::ConvexHull { points: outline().0 }, Collider::convex_hull(outline().0).expect("a square")),
        (
            C::ConvexPolyline { points: outline().0 },
            Collider::convex_polyline(outline().0).expect("a square"),
        ),
        (C::Voxels { voxel_size: scale, grid_coordinates: cells.clone() }, Collider::voxels(scale, &cells)),
        (
            C::VoxelizedPolyline { vertices: outline().0, indices: outline().1, voxel_size: 0.25, fill_mode },
            Collider::voxelized_polyline(&vertices, &indices, 0.25, fill_mode),
        ),
        (C::Heightfield { heights: heights.clone(), scale }, Collider::heightfield(heights, scale)),
        (
            C::Compound(vec![(at, turned, C::Circle { radius: 0.5 })]),
            Collider::compound(vec![(at, turned, Collider::circle(0.5))]),
        ),
    ]
}

/// Constructors from a mesh with the colliders of their functions.
pub fn made_of(mesh: &Mesh) -> Vec<(C, Collider)> {
    let fill_mode = FillMode::SurfaceOnly;
    let made = |collider: Option<Collider>| collider.expect("a mesh of triangles");
    vec![
        (C::TrimeshFromMesh, made(Collider::trimesh_from_mesh(mesh))),
        (C::ConvexHullFromMesh, made(Collider::convex_hull_from_mesh(mesh))),
        (C::ConvexDecompositionFromMesh, made(Collider::convex_decomposition_from_mesh(mesh))),
        (
            C::VoxelizedTrimeshFromMesh { voxel_size: 0.25, fill_mode },
            made(Collider::voxelized_trimesh_from_mesh(mesh, 0.25, fill_mode)),
        ),
    ]
}

/// Flat meshes, with and without indices.
pub fn shape_of_mesh() -> Vec<Mesh> {
    let square = Mesh::from(primitives::Rectangle::new(1.0, 2.0));
    let unindexed = square.clone().with_duplicated_vertices();
    vec![square, unindexed, Mesh::from(primitives::Circle::new(1.0))]
}

/// Constructors that make no shape.
pub fn wrong() -> Vec<C> {
    let (nan, fill_mode) = (Scalar::NAN, FillMode::SurfaceOnly);
    vec![
        C::Circle { radius: nan },
        C::Rectangle { x_length: 1.0, y_length: 0.0 },
        C::RoundRectangle { x_length: 1.0, y_length: 1.0, border_radius: -0.1 },
        C::Ellipse { half_width: 1.0, half_height: nan },
        C::RegularPolygon { circumradius: 1.0, sides: 2 },
        C::RegularPolygon { circumradius: 1.0, sides: u32::MAX },
        C::RegularPolygon { circumradius: f32::NAN, sides: 5 },
        C::ConvexPolyline { points: vec![Vector::ZERO, Vector::X, Vector::X * 2.0] },
        C::ConvexDecomposition { vertices: vec![], indices: vec![] },
        C::ConvexDecomposition { vertices: vec![Vector::splat(nan); 3], indices: vec![[0, 1]] },
        C::VoxelizedPolyline { vertices: corners(), indices: sides(), voxel_size: 0.0, fill_mode },
        C::VoxelizedPolyline { vertices: corners(), indices: sides(), voxel_size: 2.0e-5, fill_mode },
        C::VoxelizedPolyline { vertices: corners(), indices: vec![[0, 8]], voxel_size: 0.1, fill_mode },
        C::Heightfield { heights: vec![1.0], scale: Vector::ONE },
        C::Heightfield { heights: vec![1.0; 5], scale: Vector::splat(nan) },
        C::compound(vec![(Vector::ZERO, Rotation { cos: 0.0, sin: 0.0 }, C::Circle { radius: 1.0 })]),
    ]
}

/// The outline of a mesh is what encloses its triangles, not the sides between them.
#[test]
fn a_flat_mesh_is_decomposed_within_its_outline() {
    // An L of three squares, each of two triangles with corners of their own.
    let square = |x: f32, y: f32| {
        let at = |dx: f32, dy: f32| [x + dx, y + dy, 0.0];
        [at(0.0, 0.0), at(1.0, 0.0), at(1.0, 1.0), at(0.0, 0.0), at(1.0, 1.0), at(0.0, 1.0)]
    };
    let points: Vec<_> =
        [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)].into_iter().flat_map(|(x, y)| square(x, y)).collect();
    let mesh = Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default())
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, points);
    let fill_mode = FillMode::FloodFill { detect_cavities: false, detect_self_intersections: false };
    let parts = Collider::convex_decomposition_from_mesh(&mesh).expect("an area");
    let voxels = Collider::voxelized_trimesh_from_mesh(&mesh, 0.05, fill_mode).expect("an area");
    let triangles = Collider::trimesh_from_mesh(&mesh).expect("triangles");
    let origin = (Position::default(), Rotation::default());
    for (x, y, inside) in [(0.5, 0.5, true), (1.7, 0.5, true), (0.5, 1.7, true), (1.5, 1.5, false)] {
        for shape in [&parts, &voxels, &triangles] {
            assert_eq!(
                shape.contains_point(origin.0, origin.1, Vector::new(x, y)),
                inside,
                "{x} {y} {shape:?}"
            );
        }
    }
}

/// A turn of the frame of a node.
pub fn turn(angle: f32) -> Quat {
    Quat::from_rotation_z(angle)
}

/// Meshes of a level. Their triangles all have an area.
pub fn level_meshes() -> Vec<Mesh> {
    let strip: Vec<[f32; 3]> = (0..20).map(|i| [(i / 2) as f32, (i % 2) as f32, 0.0]).collect();
    vec![
        Mesh::from(primitives::Rectangle::new(4.0, 1.0)),
        Mesh::from(primitives::Circle::new(2.0)),
        Mesh::from(primitives::RegularPolygon::new(1.0, 5)),
        Mesh::new(PrimitiveTopology::TriangleStrip, RenderAssetUsages::default())
            .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, strip)
            .with_inserted_indices(Indices::U32((0..20).collect())),
    ]
}

/// A point in the engine's type.
pub fn point(point: bevy_math::Vec3) -> Vector {
    Vector::new(point.x as _, point.y as _)
}
