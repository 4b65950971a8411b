//! Triangles of surfaces against the general search for two polyhedra, and against brute force.

use super::facet::{borders, face_normal, with_convex};
use super::oracle::Solid;
use super::tests::{deepest, fresh};
use crate::manifold::tests_pairs::Dice;
use crate::manifold::{
    CompositeBuffers, FeatureCache, LocalManifold, ManifoldQuery, PairInput, collide_composite,
};
use crate::math::{Pose, Vector};
use crate::shape::{Capsule, Composite, Cuboid, Hull, Segment, Shape, Surface, Triangle};
use core::cell::Cell;
use std::sync::Arc;

/// Sizes of triangles in metres, beside shapes of about a metre.
const SIZES: [f32; 5] = [0.02, 0.3, 1.0, 4.0, 300.0];
/// Poses of each shape and size.
const POSES: usize = 3_000;
/// A prediction distance that finds every contact.
const FAR: f32 = 1000.0;
/// The share of poses that may be off, as in the test of all pairs.
const OUTLIERS: usize = POSES / 500;

/// Polyhedra with and without radii.
fn shapes(dice: &mut Dice) -> Vec<(&'static str, Shape)> {
    let points: Vec<Vector> = (0..12).map(|_| dice.direction() * 0.5).collect();
    let ring = |i: usize| {
        let angle = (i % 12) as f32 * core::f32::consts::TAU / 12.0;
        Vector { x: 0.4 * angle.cos(), y: if i < 12 { -0.3 } else { 0.3 }, z: 0.4 * angle.sin() }
    };
    let hull = |points: &[Vector]| Hull::convex_hull_of(points).expect("a solid");
    let rounded = hull(&points).rounded(0.1).expect("a good radius");
    let ends = [dice.vector(0.5), dice.vector(0.5)];
    vec![
        ("cuboid", Shape::Cuboid(Cuboid { half: Vector { x: 0.5, y: 0.2, z: 0.35 } })),
        ("hull", Shape::Hull(Arc::new(hull(&points)))),
        ("prism", Shape::Hull(Arc::new(hull(&(0..24).map(ring).collect::<Vec<_>>())))),
        ("rounded hull", Shape::Hull(Arc::new(rounded))),
        ("capsule", Shape::Capsule(Capsule { a: ends[0], b: ends[1], radius: 0.2 })),
        ("segment", Shape::Segment(Segment { a: ends[1], b: ends[0] })),
    ]
}

/// A triangle of a size; one in four is a sliver.
fn triangle(size: f32, dice: &mut Dice) -> [Vector; 3] {
    loop {
        let [a, b, mut c] = [0; 3].map(|_| dice.vector(size));
        if dice.below(4) == 0 {
            c = a + (b - a) * dice.between(0.1, 0.9) + dice.direction() * (0.02 * size);
        }
        if (b - a).cross(c - a).length() > 0.005 * size * size {
            return [a, b, c];
        }
    }
}

/// A pose at which the shape is near a point of the triangle: apart, touching, deep, or standing on it.
fn pose(corners: [Vector; 3], shape: &Shape, dice: &mut Dice) -> Pose {
    let [a, b, c] = corners;
    let (s, t) = (dice.between(-0.2, 1.2), dice.between(-0.2, 1.2));
    let on = a + (b - a) * s + (c - a) * (t * (1.0 - s));
    let rotation = super::tests_pairs::rotation(dice);
    let way = match face_normal(corners) {
        Some(normal) if dice.below(2) == 0 => normal * if dice.below(2) == 0 { 1.0 } else { -1.0 },
        _ => dice.direction(),
    };
    let low = shape.support(rotation.inverse_rotate(-way)).expect("bounded");
    let height = -rotation.rotate(low).dot(way);
    let overlap = [0.0, 0.002, 0.1, -0.015, -0.3][dice.below(5)];
    Pose::new(on + way * (height - overlap), rotation)
}

fn of_facet(corners: [Vector; 3], shape: &Shape, pose: &Pose, prediction: f32) -> LocalManifold {
    let mut out = LocalManifold::default();
    let cache = &Cell::new(FeatureCache::NONE);
    let input = PairInput { pose, prediction, cache };
    with_convex(shape, |convex| convex.collide_facet(corners, input, &mut out));
    out
}

/// Compares one pose.
fn check(corners: [Vector; 3], shape: &Shape, pose: &Pose, is_exact: bool) -> Result<(), String> {
    let [a, b, c] = corners;
    let facet = Shape::Triangle(Triangle { a, b, c });
    let (is, was) = (of_facet(corners, shape, pose, FAR), fresh(&facet, shape, pose, FAR));
    if is.count == 0 || was.count == 0 {
        return Err(format!("{} points, and {}", is.count, was.count));
    }
    let size = corners.iter().fold(1.0, |most: f32, c| most.max((*c - pose.position).length()));
    let room = 0.003 + 2.0e-5 * size;
    let (depth, other) = (deepest(&is), deepest(&was));
    if !((depth - other).abs() <= room) {
        return Err(format!("a depth of {depth}, and {other}: {is:?}, {was:?}"));
    }
    let (of_a, of_b) = (Solid::new(&facet), Solid::new(shape).at(pose));
    let [along, before] = [&is, &was].map(|m| of_a.separation_along(&of_b, m.normal) as f32);
    if !(along >= before - room) {
        return Err(format!("the normal separates by {along}, that of the search by {before}"));
    }
    if is_exact {
        let best = of_a.signed_distance(&of_b) as f32;
        let most = room + 0.003 + 0.04 * (-along).max(0.0);
        if !(depth <= best.max(along) + most && along >= best - most) {
            return Err(format!("a depth of {depth}, {along} along the normal, the oracle has {best}"));
        }
    }
    // Gaps are lower bounds.
    let near = of_facet(corners, shape, pose, 0.02);
    if near.count == 0 && !(near.gap <= depth + room && depth >= 0.02 - room) {
        return Err(format!("a gap of {} at a depth of {depth}", near.gap));
    }
    Ok(())
}

#[test]
fn facets_have_the_contacts_that_any_two_polyhedra_have() {
    let mut dice = Dice::new(5);
    let mut failures = Vec::new();
    for size in SIZES {
        for (name, shape) in shapes(&mut dice) {
            let (mut count, mut first) = (0, None);
            for i in 0..POSES {
                let corners = triangle(size, &mut dice);
                let pose = pose(corners, &shape, &mut dice);
                if let Err(what) = check(corners, &shape, &pose, i % 8 == 0) {
                    count += 1;
                    first.get_or_insert_with(|| {
                        format!("{what}\n    {corners:?}\n    {shape:?}\n    {pose:?}")
                    });
                }
            }
            if let Some(first) = first.filter(|_| count > OUTLIERS) {
                failures.push(format!(
                    "{name} at a triangle of {size} m: {count} of {POSES}, the first: {first}"
                ));
            }
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

#[test]
fn a_face_alone_has_points_between_it_and_the_shape_over_it() {
    let mut dice = Dice::new(6);
    for size in SIZES {
        for (name, shape) in shapes(&mut dice) {
            for _ in 0..POSES / 4 {
                let corners = triangle(size, &mut dice);
                let pose = pose(corners, &shape, &mut dice);
                let mut normal = face_normal(corners).expect("an area");
                let sides = borders(corners, normal);
                if dice.below(2) == 0 {
                    normal = -normal;
                }
                let mut out = LocalManifold::default();
                let cache = &Cell::new(FeatureCache::NONE);
                let input = PairInput { pose: &pose, prediction: 0.02, cache };
                with_convex(&shape, |convex| convex.collide_face(corners, normal, input, &mut out));
                let reach = corners.iter().fold(1.0, |most: f32, c| most.max((*c - pose.position).length()));
                let room = 2.0e-3 + 2.0e-5 * reach;
                for p in out.points() {
                    assert!(
                        p.separation <= 0.02 && (out.normal - normal).length() < 1.0e-5,
                        "{name}: {out:?}"
                    );
                    let on_face = p.point - normal * (0.5 * p.separation);
                    let height = (on_face - corners[0]).dot(normal);
                    let beyond = sides.iter().map(|b| (on_face - b.corner).dot(b.outward));
                    let beyond = beyond.fold(f32::NEG_INFINITY, f32::max);
                    assert!(height.abs() < room && beyond < room, "{name}: {height} over, {beyond} beside");
                }
            }
        }
    }
}

#[test]
fn a_swapped_facet_has_the_same_contact() {
    let mut dice = Dice::new(7);
    let mut buffers = CompositeBuffers::default();
    let query = ManifoldQuery::up_to(0.05);
    for (name, shape) in shapes(&mut dice) {
        for _ in 0..POSES / 4 {
            let corners = triangle(1.0, &mut dice);
            let surface = Surface::new(corners.to_vec(), vec![[0, 1, 2]]).expect("a surface");
            let surface = Shape::Composite(Arc::new(Composite::of_surface(surface, None)));
            let pose = pose(corners, &shape, &mut dice);
            let (mut found, mut swapped) = (Vec::new(), Vec::new());
            collide_composite(&surface, &shape, &pose, query, &mut buffers, &mut found);
            let inverse = pose.inverse();
            collide_composite(&shape, &surface, &inverse, query, &mut buffers, &mut swapped);
            let depths = [&found, &swapped].map(|all| all.iter().map(deepest).fold(0.05, f32::min));
            assert!((depths[0] - depths[1]).abs() < 0.003, "{name}: {depths:?}");
        }
    }
}

/// The proof that the face is the best axis holds for a box that stands on a triangle, and fails for a corner
/// that pokes through a side.
#[test]
fn only_what_stands_inside_of_a_triangle_is_on_its_face_without_a_search() {
    let corner = |x, z| Vector { x, y: 0.0, z };
    let corners = [corner(-1.0, 1.0), corner(1.0, 1.0), corner(0.0, -1.0)];
    let shape = Shape::Cuboid(Cuboid { half: Vector::ONE * 0.1 });
    let tilt = crate::math::Rot::from_axis_angle(Vector { x: 0.6, y: 0.0, z: 0.8 }, 0.3);
    for (x, is_face) in [(0.0, true), (1.05, false)] {
        let low = shape.support(tilt.inverse_rotate(-Vector::Y)).expect("bounded");
        let height = -tilt.rotate(low).y - 0.05;
        let pose = Pose::new(Vector { x, y: height, z: 0.9 }, tilt);
        let out = of_facet(corners, &shape, &pose, 0.02);
        assert!(out.count > 0);
        assert_eq!(out.normal.y.abs() > 0.999, is_face, "{out:?}");
    }
}
