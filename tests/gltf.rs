//! A level that is loaded from a glTF file: its colliders against its meshes, triangle by triangle.

use avian::prelude::*;
use bevy_asset::{AssetPlugin, AssetServer};
use bevy_camera::{
    primitives::Aabb,
    visibility::{InheritedVisibility, ViewVisibility, Visibility},
};
use bevy_ecs::prelude::*;
use bevy_gltf::{GltfAssetLabel, GltfMaterialName, GltfMeshName, GltfPlugin};
use bevy_mesh::MeshPlugin;
use bevy_transform::components::{GlobalTransform, Transform, TransformTreeChanged};
use bevy_world_serialization::{WorldAssetRoot, WorldSerializationPlugin};
use core::{f32::consts::TAU, fmt::Write, time::Duration};
use std::{fs, path::PathBuf};

use super::constructors::{Said::AllMade, frames, headless, said, start};
use super::constructors_dim::MeshComponent;
use super::levels::compare;

/// Positions, indices and the mode of a primitive: 4 are triangles, 5 is a strip. Bevy loads no fans.
type Primitive = (Vec<[f32; 3]>, Vec<u16>, u32);

/// A box that is no cube, without indices; a wavy strip; a cone.
fn primitives() -> Vec<Primitive> {
    let corner = |i: usize| [(i & 1) as f32 * 2.0, (i >> 1 & 1) as f32, (i >> 2) as f32 * 3.0];
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let cuboid = faces.iter().flat_map(|[a, b, c, d]| [a, b, c, a, c, d]).map(|i| corner(*i)).collect();
    let strip = (0..16).map(|i| [(i / 2) as f32, (i as f32).sin(), (i % 2) as f32]).collect();
    let rim = (0..9).map(|i| (i % 8) as f32 / 8.0 * TAU).map(|a| [a.cos(), 0.0, a.sin()]);
    let cone = core::iter::once([0.0, 2.0, 0.0]).chain(rim).collect();
    let sides = (1..9).flat_map(|i| [0, i, i + 1]).collect();
    vec![(cuboid, Vec::new(), 4), (strip, (0..16).collect(), 5), (cone, sides, 4)]
}

/// Nodes: rotation, scale and translation or a matrix; mesh; children.
const NODES: &str = r#"[
    {"name": "Level", "children": [1, 2, 7], "rotation": [0.0, 0.38268343, 0.0, 0.92387953], "translation": [1.0, 2.0, -3.0]},
    {"name": "Plain", "mesh": 0, "translation": [0.0, -1.0, 0.0]},
    {"name": "Scaled", "mesh": 1, "scale": [2.0, 0.5, 1.5], "children": [3, 4]},
    {"name": "Mirrored", "mesh": 0, "scale": [-1.0, 1.0, 1.0], "translation": [4.0, 0.0, 0.0], "children": [5]},
    {"name": "Turned below a scale", "mesh": 2, "rotation": [0.70710677, 0.0, 0.0, 0.70710677]},
    {"name": "Mirrored twice", "mesh": 1, "scale": [-2.0, 2.0, 2.0], "children": [6]},
    {"name": "Deep", "mesh": 2, "rotation": [0.0, 0.0, 0.70710677, 0.70710677], "translation": [0.5, 0.5, 0.5]},
    {"name": "Two meshes in one, by a matrix", "mesh": 3,
     "matrix": [0.0, 2.0, 0.0, 0.0, -2.0, 0.0, 0.0, 0.0, 0.0, 0.0, 2.0, 0.0, 7.0, 8.0, 9.0, 1.0]}
]"#;

/// A folder with the level, removed when dropped.
struct Level(PathBuf);

impl Drop for Level {
    fn drop(&mut self) {
        // A panic here would hide that of the test.
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// Writes the level to a folder of this process.
fn write_level() -> Level {
    let (mut bytes, mut views, mut accessors) = (Vec::<u8>::new(), Vec::new(), Vec::new());
    let mut of_meshes = Vec::new();
    let mut add = |data: Vec<u8>, target: u32, accessor: String| {
        bytes.resize(bytes.len().next_multiple_of(4), 0);
        let (offset, length) = (bytes.len(), data.len());
        views.push(format!(
            r#"{{"buffer": 0, "byteOffset": {offset}, "byteLength": {length}, "target": {target}}}"#
        ));
        bytes.extend(data);
        accessors.push(format!(r#"{{"bufferView": {}, {accessor}}}"#, views.len() - 1));
        accessors.len() - 1
    };
    for (positions, indices, mode) in primitives() {
        let (mut low, mut high) = ([f32::MAX; 3], [f32::MIN; 3]);
        for position in &positions {
            (0..3).for_each(|i| (low[i], high[i]) = (low[i].min(position[i]), high[i].max(position[i])));
        }
        let data = positions.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
        let count = positions.len();
        let accessor = format!(
            r#""componentType": 5126, "count": {count}, "type": "VEC3", "min": {low:?}, "max": {high:?}"#
        );
        let mut text = format!(r#"{{"attributes": {{"POSITION": {}}}"#, add(data, 34962, accessor));
        if !indices.is_empty() {
            let data = indices.iter().flat_map(|i| i.to_le_bytes()).collect();
            let accessor = format!(r#""componentType": 5123, "count": {}, "type": "SCALAR""#, indices.len());
            write!(text, r#", "indices": {}"#, add(data, 34963, accessor)).expect("it is a string");
        }
        of_meshes.push(format!(r#"{text}, "mode": {mode}}}"#));
    }
    let both = format!("{}, {}", of_meshes[0], of_meshes[2]);
    let meshes = of_meshes.iter().chain([&both]);
    let meshes: Vec<_> = meshes.map(|primitives| format!(r#"{{"primitives": [{primitives}]}}"#)).collect();
    let level = format!(
        r#"{{"asset": {{"version": "2.0"}}, "scene": 0, "scenes": [{{"nodes": [0]}}], "nodes": {NODES},
            "meshes": [{}], "accessors": [{}], "bufferViews": [{}],
            "buffers": [{{"byteLength": {}, "uri": "level.bin"}}]}}"#,
        meshes.join(", "),
        accessors.join(", "),
        views.join(", "),
        bytes.len(),
    );
    let folder = Level(std::env::temp_dir().join(format!("avian_gltf_{}", std::process::id())));
    fs::create_dir_all(&folder.0).expect("a folder for the test");
    fs::write(folder.0.join("level.bin"), bytes).expect("its buffer");
    fs::write(folder.0.join("level.gltf"), level).expect("its file");
    folder
}

#[test]
fn a_gltf_level_has_the_triangles_of_its_meshes() {
    let level = write_level();
    let mut app = headless();
    let file_path = level.0.to_str().expect("a path of text").to_owned();
    app.add_plugins((
        AssetPlugin { file_path, ..Default::default() },
        MeshPlugin,
        WorldSerializationPlugin,
        GltfPlugin::default(),
    ))
    .register_type::<Transform>()
    .register_type::<GlobalTransform>()
    .register_type::<TransformTreeChanged>()
    .register_type::<Visibility>()
    .register_type::<InheritedVisibility>()
    .register_type::<ViewVisibility>()
    .register_type::<Aabb>()
    .register_type::<Name>()
    .register_type::<ChildOf>()
    .register_type::<Children>()
    .register_type::<GltfMeshName>()
    .register_type::<GltfMaterialName>()
    .register_type::<MeshComponent>();
    start(&mut app);
    let scene = app.world().resource::<AssetServer>().load(GltfAssetLabel::Scene(0).from_asset("level.gltf"));
    let root = (
        RigidBody::Static,
        Transform::from_xyz(5.0, -3.0, 0.0),
        WorldAssetRoot(scene.clone()),
        ColliderConstructorHierarchy::new(ColliderConstructor::TrimeshFromMesh),
    );
    let root = app.world_mut().spawn(root).id();
    let mut told = Vec::new();
    for _ in 0..3000 {
        frames(&mut app, 1);
        told.extend(said(&mut app));
        if told.contains(&AllMade(root)) {
            break;
        }
        let state = app.world().resource::<AssetServer>().load_state(&scene);
        assert!(!state.is_failed(), "{state:?}");
        // Files are read by other threads.
        std::thread::sleep(Duration::from_millis(10));
    }
    frames(&mut app, 2);
    // Seven nodes with meshes, one of them with two.
    assert_eq!((told.len(), told.last()), (9, Some(&AllMade(root))), "{told:?}");
    assert_eq!(compare(&mut app), 3 * 12 + 2 * 14 + 3 * 8);
}
