//! Tests that lines lie on the surfaces of shapes, and reach as far as the shapes.

use super::{
    dim::{
        point,
        shapes::{core_of, shapes},
    },
    outline::outline,
};
use crate::{collision::collider::Collider, math::Vector, parry::math::IVector, physics_transform::Rotation};
use bevy_math::Vec3;
use kernel::math::DIM;

/// The points of an outline, without the ends of lines.
fn points(collider: &Collider) -> Vec<Vec3> {
    outline(collider).points().iter().copied().filter(|point| !point.is_nan()).collect()
}

/// Checks an outline, which may end up to `open` metres inside the box of the shape.
fn check(name: &str, collider: &Collider, tolerance: f32, open: f32) {
    let points = points(collider);
    assert!(!points.is_empty(), "{name} has no outline");
    let aabb = collider.shape_scaled().compute_local_aabb();
    let (low, high) = points.iter().fold((points[0], points[0]), |(l, h), p| (l.min(*p), h.max(*p)));
    let (min, max) = (point(aabb.mins), point(aabb.maxs));
    let apart = (low - min).abs().max((high - max).abs()).max_element();
    assert!(apart <= tolerance + open, "{name}: the outline ends {apart} m from the box of the shape");
    let (core, radius) = core_of(collider);
    for p in points {
        let at = Vector::from_slice(&p.to_array().map(Into::into)[..DIM]);
        let distance = core.distance_to_point(Vector::ZERO, Rotation::default(), at, false) - radius;
        assert!(distance.abs() as f32 <= tolerance, "{name}: {p} is {distance} m from the surface");
    }
}

#[test]
fn outlines_lie_on_surfaces_and_reach_their_ends() {
    for (name, collider, open) in shapes() {
        check(name, &collider, 2.0e-3, open);
        let mut scaled = collider.clone();
        scaled.set_scale(Vector::splat(3.0), 10);
        check(name, &scaled, 6.0e-3, 3.0 * open);
    }
}

#[test]
fn parts_are_drawn_at_their_places() {
    let at = Vector::ONE * 3.0;
    let compound = Collider::compound(vec![
        (Vector::ZERO, Rotation::default(), Collider::default()),
        (at, Rotation::default(), Collider::default()),
    ]);
    let all = points(&compound);
    let alone = points(&Collider::default());
    let moved = alone.iter().map(|p| *p + point(at));
    let expected: Vec<Vec3> = alone.iter().copied().chain(moved).collect();
    assert!(all.iter().zip(&expected).all(|(a, b)| a.distance(*b) < 1.0e-5) && all.len() == expected.len());
}

#[test]
fn voxels_have_no_lines_on_flat_walls_and_inside() {
    let cells: Vec<_> = (0..27)
        .map(|i| {
            IVector::from_array(core::array::from_fn(|axis| i / 3_i32.pow(axis as u32) % 3).map(Into::into))
        })
        .collect();
    let voxels = Collider::voxels(Vector::ONE, &cells);
    // A block has the edges of a box: each is one line.
    let lines = outline(&voxels).points().iter().filter(|point| point.is_nan()).count();
    assert_eq!(lines, if DIM == 2 { 4 } else { 12 });
}
