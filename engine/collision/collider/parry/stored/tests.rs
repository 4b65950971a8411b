use super::*;
use crate::{
    collision::collider::TrimeshFlags,
    math::{ComputeMassProperties, DIM, PI, Scalar, Vector},
    parry::{
        bounding_volume::{Aabb, BoundingSphere},
        mass_properties::MassProperties,
        math::{IVector, Pose},
        query::{PointProjection, PointQuery, Ray, RayCast, RayIntersection},
        shape::{Ball, FeatureId, Shape, ShapeType},
    },
    physics_transform::Rotation,
};
use proptest::prelude::*;
use serde_json::{Value, json};

use super::dim::tests::{shapes_of_dimension, turned};

/// Pseudo-random numbers between 0.05 and 1.
pub(super) struct Numbers(pub u64);

impl Numbers {
    pub fn next(&mut self) -> Scalar {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        0.05 + 0.95 * (self.0 >> 40) as Scalar / (1u64 << 24) as Scalar
    }

    pub fn point(&mut self) -> Vector {
        Vector::from_array([(); DIM].map(|()| 4.0 * self.next() - 2.0))
    }

    pub fn points(&mut self, count: usize) -> Vec<Vector> {
        (0..count).map(|_| self.point()).collect()
    }

    pub fn index(&mut self, count: u32) -> u32 {
        ((self.next() - 0.05) * count as Scalar) as u32 % count
    }
}

fn mesh(n: &mut Numbers, flags: TrimeshFlags) -> Collider {
    let mut vertices = n.points(12);
    // Vertices that will be merged.
    vertices.extend_from_within(..4);
    let indices = (0..20).map(|_| [(); 3].map(|()| n.index(16))).collect();
    Collider::trimesh_with_config(vertices, indices, flags)
}

/// One collider of each kind.
fn shapes(n: &mut Numbers) -> Vec<Collider> {
    let mut all = vec![
        Collider::capsule(n.next(), n.next()),
        Collider::capsule_endpoints(n.next(), n.point(), n.point()),
        Collider::segment(n.point(), n.point()),
        Collider::triangle(n.point(), n.point(), n.point()),
        Collider::half_space(n.point()),
        SharedShape::ball(n.next()).into(),
        SharedShape::new(crate::parry::shape::RoundShape {
            inner_shape: crate::parry::shape::Triangle::new(n.point(), n.point(), n.point()),
            border_radius: n.next(),
        })
        .into(),
        Collider::polyline(n.points(7), None),
        Collider::polyline(n.points(4), Some(vec![[0, 1], [2, 3], [3, 0]])),
        Collider::voxels_from_points(Vector::splat(0.1), &n.points(40)),
        mesh(n, TrimeshFlags::empty()),
        mesh(n, TrimeshFlags::FIX_INTERNAL_EDGES),
        // Vertices that no triangle uses are left out.
        again(&mesh(n, TrimeshFlags::all())),
    ];
    all.extend((0..4).filter_map(|_| Collider::convex_hull(n.points(20))));
    all.extend(shapes_of_dimension(n));
    let parts: Vec<_> = all
        .iter()
        .filter(|c| c.shape().as_composite_shape().is_none())
        .map(|c| (n.point(), turned(n), c.clone()))
        .collect();
    all.push(Collider::compound(parts));
    let mut scaled = all.clone();
    scaled.iter_mut().for_each(|c| c.set_scale(n.point(), 6));
    all.extend(scaled);
    all
}

fn text(collider: &Collider) -> String {
    serde_json::to_string(collider).expect("every collider can be stored")
}

fn again(collider: &Collider) -> Collider {
    serde_json::from_str(&text(collider)).unwrap_or_else(|error| panic!("{error}: {}", text(collider)))
}

#[test]
fn vertices_that_no_triangle_uses_are_left_out_of_a_mended_mesh() {
    let corners = |collider: &Collider| {
        let mesh = collider.shape().as_trimesh().expect("a mesh");
        let triangles: Vec<_> = mesh.triangles().collect();
        let tree = serde_json::to_string(mesh.bvh()).expect("a tree");
        format!("{triangles:?} {:?} {tree}", mesh.flags())
    };
    for seed in 0..100 {
        let mesh = mesh(&mut Numbers(seed), TrimeshFlags::all());
        assert_eq!(corners(&mesh), corners(&again(&mesh)));
    }
}

/// All data of a shape, by parry's own serialization, which includes trees, topology and normals.
fn exact(shape: &SharedShape) -> String {
    match shape.as_typed_shape() {
        // Parry keeps the chunks of voxels in a hash map, and its tree has the order of the map.
        TypedShape::Voxels(_) | TypedShape::Custom(_) => {
            serde_json::to_string(&Part::of(shape).expect("ours")).expect("a part")
        }
        TypedShape::Compound(compound) => {
            let parts = compound.shapes().iter().map(|(pose, part)| format!("{pose:?} {}", exact(part)));
            let tree = serde_json::to_string(compound.bvh()).expect("a tree");
            parts.chain([tree]).collect()
        }
        _ => serde_json::to_string(shape).expect("a shape"),
    }
}

fn assert_same(a: &Collider, b: &Collider) {
    assert_eq!((a.scale, a.detail), (b.scale, b.detail));
    assert_eq!(exact(a.shape()), exact(b.shape()));
    assert_eq!(exact(a.shape_scaled()), exact(b.shape_scaled()));
    assert_eq!(format!("{:?}", a.native()), format!("{:?}", b.native()));
    assert_eq!(text(a), text(b));
    // Parry sums the mass of voxels in the order of its hash map.
    if !text(a).contains("Voxels") {
        let mass = |c: &Collider| format!("{:?}", c.mass_properties(1.5));
        assert_eq!(mass(a), mass(b));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn a_collider_comes_back_with_the_same_bits(seed: u64) {
        for collider in shapes(&mut Numbers(seed)) {
            assert_same(&collider, &again(&collider));
        }
    }
}

#[test]
fn a_shape_changed_below_its_scale_comes_back() {
    let mut collider: Collider = SharedShape::ball(0.5).into();
    let mut scale = Vector::ONE;
    scale.x = 2.0;
    collider.set_scale(scale, 7);
    *collider.shape_mut() = SharedShape::ball(0.75);
    assert_same(&collider, &again(&collider));
}

/// Calls the functions of a collider.
fn exercise(collider: &Collider) {
    let shape = collider.shape_scaled();
    let _ = (shape.compute_local_aabb(), shape.compute_local_bounding_sphere());
    let _ = (collider.native().clone(), collider.mass_properties(1.0));
    let ray = Ray::new(Vector::splat(3.0), Vector::splat(-1.0));
    let _ = shape.cast_local_ray_and_get_normal(&ray, 10.0, true);
    let _ = shape.project_local_point_and_get_feature(Vector::splat(0.3));
    if let Some(map) = shape.as_support_map() {
        let _ = map.local_support_point(Vector::X);
    }
    if let Some((map, _)) = shape.as_polygonal_feature_map() {
        map.local_support_feature(Vector::Y, &mut Default::default());
    }
    assert!(has_extent(shape));
}

/// Runs a function with copies of a document in which one place after the other is replaced.
fn spoil(document: &Value, place: &mut dyn FnMut(&Value) -> Vec<Value>, run: &mut dyn FnMut(Value)) {
    let paths = paths(document);
    for path in paths {
        let found = document.pointer(&path).expect("a path of the document").clone();
        for other in place(&found) {
            let mut spoiled = document.clone();
            *spoiled.pointer_mut(&path).expect("the same path") = other;
            run(spoiled);
        }
    }
}

fn paths(value: &Value) -> Vec<String> {
    let below = |(key, value): (String, &Value)| {
        let inner = paths(value).into_iter().map(move |rest| format!("/{key}{rest}"));
        inner.collect::<Vec<_>>()
    };
    let mut found = vec![String::new()];
    match value {
        Value::Array(items) => {
            found.extend(items.iter().enumerate().map(|(i, v)| (i.to_string(), v)).flat_map(below));
        }
        Value::Object(fields) => found.extend(fields.iter().map(|(k, v)| (k.clone(), v)).flat_map(below)),
        _ => {}
    }
    found
}

#[test]
fn no_spoiled_collider_panics() {
    let mut worse = |found: &Value| match found {
        Value::Number(_) => {
            vec![json!(null), json!(-1), json!(0), json!(1.0e30), json!(-1.0e300), json!(u32::MAX)]
        }
        Value::Array(items) => vec![json!([]), json!(items[..items.len() / 2]), json!("no list")],
        Value::Bool(flag) => vec![json!(!flag), json!(2)],
        _ => vec![json!(null), json!({}), json!([])],
    };
    let (mut refused, mut read) = (0, 0);
    // One of each kind: the second half is the first with a scale.
    let all = shapes(&mut Numbers(7));
    for collider in &all[..all.len() / 2] {
        let document = serde_json::to_value(collider).expect("can be stored");
        spoil(&document, &mut worse, &mut |spoiled| match serde_json::from_value::<Collider>(spoiled) {
            Ok(collider) => {
                exercise(&collider);
                read += 1;
            }
            Err(_) => refused += 1,
        });
    }
    assert!(refused > 1000 && read > 100, "{refused} refused, {read} read");
}

/// Documents that describe no shape.
fn shapeless() -> Vec<Value> {
    let zero = json!(Vector::ZERO);
    let ones = json!(Vector::ONE);
    let mut nan = vec![Value::Null; DIM];
    nan[0] = json!(1.0);
    let points = json!([Vector::ZERO, Vector::X, Vector::Y]);
    let triangles =
        |indices: Value| json!({ "Trimesh": { "vertices": points, "indices": indices, "flags": 0 } });
    vec![
        json!({ "Single": { "Ball": { "radius": -1.0 } } }),
        json!({ "Single": { "Ball": { "radius": null } } }),
        json!({ "Single": { "Ball": {} } }),
        json!({ "Single": { "Cube": { "radius": 1.0 } } }),
        json!({ "Single": { "Cuboid": { "half_extents": nan } } }),
        json!({ "Single": { "Cuboid": { "half_extents": json!(Vector::NEG_ONE) } } }),
        json!({ "Single": { "RoundCuboid": { "half_extents": ones, "border_radius": -0.1 } } }),
        json!({ "Single": { "Capsule": { "a": nan, "b": ones, "radius": 0.1 } } }),
        json!({ "Single": { "Capsule": { "a": zero, "b": ones, "radius": -0.1 } } }),
        json!({ "Single": { "HalfSpace": { "normal": zero } } }),
        json!({ "Single": { "HalfSpace": { "normal": ones } } }),
        json!({ "Single": { "Voxels": { "size": ones, "cells": [] } } }),
        json!({ "Single": { "Voxels": { "size": zero, "cells": [IVector::ONE] } } }),
        json!({ "Single": { "Voxels": { "size": ones, "cells": [IVector::MAX] } } }),
        json!({ "Compound": [] }),
        json!({ "Trimesh": { "vertices": [], "indices": [], "flags": 0 } }),
        json!({ "Trimesh": { "vertices": [], "indices": [[0, 1, 2]], "flags": 0 } }),
        triangles(json!([])),
        triangles(json!([[0, 1, 3]])),
        triangles(json!([[0, 1, u32::MAX]])),
        triangles(json!([[0, 1, -1]])),
        json!({ "Trimesh": { "vertices": points, "indices": [[0, 1, 2]], "flags": 65535 } }),
        json!({ "Trimesh": { "vertices": points, "indices": [[0, 0, 0]], "flags": 32 } }),
        json!({ "Polyline": { "vertices": points, "indices": [[0, 3]], "flags": 0 } }),
        json!({ "Polyline": { "vertices": points, "indices": [], "flags": 0 } }),
        json!({ "Polyline": { "vertices": points, "indices": [[0, 1]], "flags": 255 } }),
    ]
}

#[test]
fn what_is_no_shape_is_an_error() {
    let read = |shape: Value, scale: Value, detail: Value| {
        serde_json::from_value::<Collider>(json!({ "shape": shape, "scale": scale, "detail": detail }))
    };
    for shape in shapeless().into_iter().chain(super::dim::tests::shapeless()) {
        let result = read(shape.clone(), json!(Vector::ONE), json!(10));
        assert!(result.is_err(), "{shape} became {result:?}");
    }
    let ball = || json!({ "Single": { "Ball": { "radius": 1.0 } } });
    assert!(read(ball(), json!(Vector::ONE), json!(10)).is_ok());
    assert!(read(ball(), json!(Vector::ZERO), json!(10)).is_err(), "no scale");
    assert!(read(ball(), json!(Vector::NAN.to_array()), json!(10)).is_err(), "NaN is null in JSON");
    assert!(read(ball(), json!(Vector::ONE), json!(u32::MAX)).is_err(), "too fine");
    assert!(read(ball(), json!(Vector::X + Vector::ONE), json!(u32::MAX)).is_err(), "too fine");
}

#[test]
fn parts_of_compounds_need_a_pose() {
    let compound = Collider::compound(vec![(Vector::X, Rotation::default(), Collider::capsule(PI, 1.0))]);
    let stored = serde_json::to_value(&compound).expect("can be stored");
    let part = |field: &str, value: Value| {
        let mut spoiled = stored.clone();
        spoiled["shape"]["Compound"][0][field] = value;
        serde_json::from_value::<Collider>(spoiled).is_ok()
    };
    let rotation = stored["shape"]["Compound"][0]["rotation"].clone();
    assert!(part("rotation", rotation.clone()));
    let doubled: Vec<_> =
        rotation.as_array().expect("a list").iter().map(|v| 2.0 * v.as_f64().unwrap_or(1.0)).collect();
    assert!(!part("rotation", json!(doubled)) && !part("position", json!(vec![Value::Null; DIM])));
    // A compound in a compound would recurse.
    assert!(!part("shape", stored["shape"].clone()));
}

#[test]
fn a_shape_of_the_apps_own_cannot_be_stored() {
    let own: Collider = SharedShape::new(Own(Ball::new(1.0))).into();
    let error = serde_json::to_string(&own).expect_err("no way to store it");
    assert!(error.to_string().contains("app's own"), "{error}");
}

/// A custom ball without serialization.
#[derive(Clone, Debug)]
struct Own(Ball);

impl RayCast for Own {
    fn cast_local_ray_and_get_normal(&self, ray: &Ray, most: Scalar, solid: bool) -> Option<RayIntersection> {
        self.0.cast_local_ray_and_get_normal(ray, most, solid)
    }
}

impl PointQuery for Own {
    fn project_local_point(&self, point: Vector, solid: bool) -> PointProjection {
        self.0.project_local_point(point, solid)
    }

    fn project_local_point_and_get_feature(&self, point: Vector) -> (PointProjection, FeatureId) {
        self.0.project_local_point_and_get_feature(point)
    }
}

impl Shape for Own {
    fn clone_dyn(&self) -> Box<dyn Shape> {
        Box::new(self.clone())
    }

    fn scale_dyn(&self, _: Vector, _: u32) -> Option<Box<dyn Shape>> {
        None
    }

    fn compute_local_aabb(&self) -> Aabb {
        self.0.compute_local_aabb()
    }

    fn compute_local_bounding_sphere(&self) -> BoundingSphere {
        self.0.compute_local_bounding_sphere()
    }

    fn compute_aabb(&self, position: &Pose) -> Aabb {
        Shape::compute_aabb(&self.0, position)
    }

    fn mass_properties(&self, density: Scalar) -> MassProperties {
        Shape::mass_properties(&self.0, density)
    }

    fn shape_type(&self) -> ShapeType {
        ShapeType::Custom
    }

    fn as_typed_shape(&self) -> TypedShape<'_> {
        TypedShape::Custom(self)
    }

    fn ccd_thickness(&self) -> Scalar {
        1.0
    }

    fn ccd_angular_thickness(&self) -> Scalar {
        PI
    }
}
