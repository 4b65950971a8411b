//! Hulls: topology, errors, mass against closed forms, rays against brute force.

use super::super::rays::{check_mass_by_rays, check_ray};
use super::{Hull, size_of};
use crate::math::{Inertia, Rot, Vector};
use crate::shape::{Aabb, Ball, Capsule, Cuboid, Shape, ShapeError, Triangle};
use crate::shape::{cast_ray_triangle, mass_of_ball, mass_of_capsule, mass_of_cuboid};
use proptest::prelude::*;

fn v(x: f32, y: f32, z: f32) -> Vector {
    Vector { x, y, z }
}

fn vector(range: f32) -> impl Strategy<Value = Vector> {
    [-range..range, -range..range, -range..range].prop_map(Vector::from_array)
}

fn cloud() -> impl Strategy<Value = Vec<Vector>> {
    prop::collection::vec(vector(1.0), 5..40)
}

fn rotation() -> impl Strategy<Value = Rot> {
    [-1.0f32..1.0, -1.0..1.0, -1.0..1.0, -1.0..1.0]
        .prop_filter("not zero", |q| q.iter().map(|c| c * c).sum::<f32>() > 0.01)
        .prop_map(|[x, y, z, w]| Rot { x, y, z, w }.normalized())
}

fn entries(i: Inertia) -> [f32; 6] {
    [i.xx, i.yy, i.zz, i.xy, i.xz, i.yz]
}

fn close(a: Inertia, b: Inertia, tolerance: f32) -> bool {
    entries(a).iter().zip(entries(b)).all(|(x, y)| (x - y).abs() <= tolerance)
}

/// The inertia tensor of a mass about a point at `r` from its centre (Steiner's theorem).
fn shifted(inertia: Inertia, mass: f32, r: Vector) -> Inertia {
    let s = r.length_squared();
    Inertia {
        xx: inertia.xx + mass * (s - r.x * r.x),
        yy: inertia.yy + mass * (s - r.y * r.y),
        zz: inertia.zz + mass * (s - r.z * r.z),
        xy: inertia.xy - mass * r.x * r.y,
        xz: inertia.xz - mass * r.x * r.z,
        yz: inertia.yz - mass * r.y * r.z,
    }
}

#[test]
fn a_cuboid_has_square_faces() {
    let hull = Hull::cuboid(v(1.0, 2.0, 3.0)).expect("positive");
    assert_eq!((hull.vertices().len(), hull.edges().len(), hull.faces().len()), (8, 12, 6));
    for face in hull.faces() {
        assert_eq!(hull.outline(face).len(), 4);
        assert_eq!(face.normal.abs().max_element(), 1.0);
        assert_eq!(face.offset, face.normal.abs().dot(v(1.0, 2.0, 3.0)));
    }
    for edge in hull.edges() {
        let along = hull.vertices()[edge.head as usize] - hull.vertices()[edge.tail as usize];
        let (l, r) = (hull.faces()[edge.left as usize].normal, hull.faces()[edge.right as usize].normal);
        assert!(l.cross(r).dot(along) > 0.0, "the arc from left to right turns about the edge");
    }
}

proptest! {
    /// Four vertices at a time, with the last block filled up.
    #[test]
    fn boxes_contain_all_vertices_and_no_more(points in cloud(), turn in rotation(), radius in 0.0f32..0.5) {
        let Ok(hull) = Hull::convex_hull_of(&points).and_then(|hull| hull.rounded(radius)) else { return Ok(()) };
        let around = Aabb::around(hull.vertices().iter().map(|v| turn.rotate(*v))).grown(radius);
        prop_assert_eq!(hull.local_aabb(turn), around);
    }
}

#[test]
fn triangles_in_a_plane_become_one_face() {
    let corner = |i: usize| v((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32);
    let mut points: Vec<Vector> = (0..8).map(corner).collect();
    points.push(v(0.5, 0.5, 0.5));
    points.push(v(0.5, 0.5, 1.0));
    points.push(v(0.5, 0.0, 0.0));
    let hull = Hull::convex_hull_of(&points).expect("a cube");
    assert_eq!((hull.vertices().len(), hull.edges().len(), hull.faces().len()), (8, 12, 6));
    assert!((hull.unit_mass().mass - 1.0).abs() < 1e-6);
}

#[test]
fn bad_input_is_refused() {
    let square = [v(0.0, 0.0, 0.0), v(1.0, 0.0, 0.0), v(1.0, 1.0, 0.0), v(0.0, 1.0, 0.0)];
    let line: Vec<Vector> = (0..9).map(|i| v(i as f32, 2.0 * i as f32, 1.0)).collect();
    for points in [&[][..], &[Vector::X], &[Vector::X; 20], &square, &line] {
        assert_eq!(Hull::convex_hull_of(points), Err(ShapeError::Degenerate));
    }
    let mut bad = square.to_vec();
    bad.push(v(f32::NAN, 0.0, 1.0));
    assert_eq!(Hull::convex_hull_of(&bad), Err(ShapeError::NotFinite));
    assert_eq!(Hull::cuboid(v(1.0, -1.0, 1.0)), Err(ShapeError::Negative));
    assert_eq!(Hull::cuboid(v(1.0, 0.0, 1.0)), Err(ShapeError::Degenerate));
    assert_eq!(Hull::cuboid(v(1.0, f32::INFINITY, 1.0)), Err(ShapeError::NotFinite));
    let tetrahedron = vec![Vector::ZERO, Vector::X, Vector::Y, Vector::Z];
    let good = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
    assert!(Hull::from_triangles(tetrahedron.clone(), &good).is_ok());
    let reversed = good.map(|[a, b, c]| [a, c, b]);
    assert_eq!(Hull::from_triangles(tetrahedron.clone(), &reversed), Err(ShapeError::NotConvex));
    assert_eq!(Hull::from_triangles(tetrahedron.clone(), &good[..3]), Err(ShapeError::Degenerate));
    assert_eq!(Hull::from_triangles(tetrahedron, &[[0, 1, 7]; 4]), Err(ShapeError::Degenerate));
    // A dent: the apex of one of two pyramids on a square pushed inward past the middle.
    let mut dented = square.to_vec();
    dented.extend([v(0.5, 0.5, 1.0), v(0.5, 0.5, 0.5)]);
    let faces = [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4], [1, 0, 5], [2, 1, 5], [3, 2, 5], [0, 3, 5]];
    assert_eq!(Hull::from_triangles(dented, &faces), Err(ShapeError::NotConvex));
}

#[test]
fn a_needle_keeps_its_tips() {
    let points = [
        v(0.0, -9e-5, 1e-5),
        v(0.61, -6e-5, 1.3e-4),
        v(0.17, -1e-5, 3e-5),
        v(0.33, 1e-4, -1e-5),
        v(1.0, 0.0, 0.0),
    ];
    let hull = Hull::convex_hull_of(&points).expect("a solid");
    assert_eq!((hull.support(-Vector::X).x, hull.support(Vector::X).x), (0.0, 1.0));
}

#[test]
fn a_fine_ball_keeps_its_faces() {
    // Fibonacci points: the angles between neighbouring faces are small, and no faces may be merged.
    let count = 300;
    let points: Vec<Vector> = (0..count)
        .map(|i| {
            let y = 1.0 - 2.0 * (f64::from(i) + 0.5) / f64::from(count);
            let (s, c) = crate::math::sin_cos(2.399_963_229_728_653 * f64::from(i));
            let r = (1.0 - y * y).sqrt();
            v((c * r) as f32, y as f32, (s * r) as f32)
        })
        .collect();
    let hull = Hull::convex_hull_of(&points).expect("a ball");
    assert_eq!(hull.vertices().len(), 300);
    let mass = hull.unit_mass();
    let exact = mass_of_ball(&Ball { radius: 1.0 });
    assert!(mass.mass < exact.mass && mass.mass > 0.96 * exact.mass);
    assert!(close(mass.inertia, exact.inertia, 0.1 * exact.inertia.xx));
}

#[test]
fn masses_equal_closed_forms() {
    let half = v(0.5, 1.0, 2.0);
    let (hull, cuboid) =
        (Hull::cuboid(half).expect("positive").unit_mass(), mass_of_cuboid(&Cuboid { half }));
    assert!((hull.mass - 8.0).abs() < 1e-5 && (cuboid.mass - 8.0).abs() < 1e-6);
    // I_x = m/12 (b² + c²) with the full sizes 1, 2, 4.
    let expected = Inertia::from_diagonal(v(8.0 / 12.0 * 20.0, 8.0 / 12.0 * 17.0, 8.0 / 12.0 * 5.0));
    assert!(close(hull.inertia, expected, 1e-4) && close(cuboid.inertia, expected, 1e-4));
    // The corner tetrahedron of a cube: V = 1/6, centre (1,1,1)/4, and about the corner ∫x² = 1/60,
    // ∫xy = 1/120, so about the centre I_xx = 1/30 − 2 V/16 and I_xy = −1/120 + V/16.
    let corner = Hull::convex_hull_of(&[Vector::ZERO, Vector::X, Vector::Y, Vector::Z]).expect("solid");
    let m = corner.unit_mass();
    assert!((m.mass - 1.0 / 6.0).abs() < 1e-7 && (m.center - Vector::ONE * 0.25).length() < 1e-7);
    let (on, off) = (1.0 / 30.0 - 1.0 / 48.0, -1.0 / 120.0 + 1.0 / 96.0);
    let expected = Inertia { xx: on, yy: on, zz: on, xy: off, xz: off, yz: off };
    assert!(close(m.inertia, expected, 1e-7), "{:?}", m.inertia);
    // A capsule without length is a ball; a long thin capsule is a rod, I = m h²/12.
    let ball = mass_of_capsule(&Capsule { a: Vector::Y, b: Vector::Y, radius: 0.7 });
    let same = mass_of_ball(&Ball { radius: 0.7 });
    assert!((ball.mass - same.mass).abs() < 1e-6 && close(ball.inertia, same.inertia, 1e-6));
    let rod = mass_of_capsule(&Capsule { a: v(0.0, 0.0, -5.0), b: v(0.0, 0.0, 5.0), radius: 0.01 });
    assert!((rod.inertia.xx / (rod.mass * 100.0 / 12.0) - 1.0).abs() < 0.01);
    assert!((rod.inertia.zz / (rod.mass * 0.5e-4) - 1.0).abs() < 0.01);
    assert_eq!(hull.scaled(2.0).mass, 2.0 * hull.mass);
}

/// The first hit of a ray on the outside of the triangles of a hull.
fn ray_by_brute_force(hull: &Hull, origin: Vector, direction: Vector) -> Option<f32> {
    let mut best: Option<f32> = None;
    for face in hull.faces() {
        let outline = hull.outline(face);
        for k in 2..outline.len() {
            let [a, b, c] = [outline[0], outline[k - 1], outline[k]].map(|i| hull.vertices()[i as usize]);
            if let Some(hit) = cast_ray_triangle(&Triangle { a, b, c }, origin, direction, 100.0, true) {
                best = Some(best.map_or(hit.distance, |d| d.min(hit.distance)));
            }
        }
    }
    best
}

/// Asserts that the hull contains its points, also along `axes`, and fails only for flat points.
fn surrounds(points: &[Vector], axes: [Vector; 3]) -> Result<(), TestCaseError> {
    let size = size_of(points);
    let Ok(hull) = Hull::convex_hull_of(points) else {
        let flat = (0..points.len()).any(|a| {
            (0..a).any(|b| {
                (0..b).any(|c| {
                    let normal = (points[b] - points[a]).cross(points[c] - points[a]);
                    let heights = points.iter().map(|p| normal.dot(*p - points[a]).abs());
                    let highest = heights.fold(0.0, f32::max);
                    normal.length() > 0.0 && highest <= 3e-5 * size * normal.length()
                })
            })
        });
        prop_assert!(flat, "a solid was refused");
        return Ok(());
    };
    for axis in axes.into_iter().flat_map(|a| [a, a * -1.0]) {
        let farthest = points.iter().map(|p| axis.dot(*p)).fold(f32::MIN, f32::max);
        prop_assert!(axis.dot(hull.support(axis)) >= farthest - 5e-4 * size);
    }
    for face in hull.faces() {
        prop_assert!((face.normal.length() - 1.0).abs() < 1e-5);
        for p in points {
            prop_assert!(face.normal.dot(*p) <= face.offset + 3e-4 * size);
        }
    }
    prop_assert_eq!(hull.vertices().len() + hull.faces().len(), hull.edges().len() + 2);
    for vertex in hull.vertices() {
        prop_assert!(points.contains(vertex));
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    fn a_hull_surrounds_its_points(points in cloud()) {
        surrounds(&points, [Vector::X, Vector::Y, Vector::Z])?;
    }

    /// Plates and needles, in which two sides are nearly one plane and triangles are slivers.
    #[test]
    fn a_thin_hull_surrounds_its_points(
        points in cloud(),
        (y, z) in prop_oneof![(-1.0f32..0.0, -4.0f32..0.0), (-3.0f32..0.0, -3.0f32..0.0)],
        turn in rotation(),
    ) {
        let scale = v(1.0, 10.0f32.powf(y), 10.0f32.powf(z));
        let thin: Vec<Vector> =
            points.iter().map(|p| turn.rotate(v(p.x, p.y * scale.y, p.z * scale.z))).collect();
        surrounds(&thin, [Vector::X, Vector::Y, Vector::Z].map(|a| turn.rotate(a)))?;
    }

    #[test]
    fn a_hull_far_from_the_origin_surrounds_its_points(
        points in prop::collection::vec([0u8..5, 0u8..5, 0u8..5], 5..40),
        at in [-100_000i32..100_000, -100_000..100_000, -100_000..100_000],
    ) {
        let at = Vector::from_array(at.map(|c| c as f32));
        let near: Vec<Vector> =
            points.iter().map(|p| Vector::from_array(p.map(f32::from))).collect();
        let far: Vec<Vector> = near.iter().map(|p| *p + at).collect();
        let (near, far) = (Hull::convex_hull_of(&near), Hull::convex_hull_of(&far));
        prop_assert_eq!(near.map(|h| h.faces().len()), far.map(|h| h.faces().len()));
    }

    #[test]
    fn a_turned_grid_of_points_is_a_box(turn in rotation(), size in -3.0f32..3.0, thin in 0.01f32..1.0) {
        let size = 10.0f32.powf(size);
        let grid: Vec<Vector> = (0..64)
            .map(|i| turn.rotate(v((i & 3) as f32, (i >> 2 & 3) as f32, (i >> 4) as f32 * thin)) * size)
            .collect();
        let hull = Hull::convex_hull_of(&grid).expect("solid");
        prop_assert_eq!((hull.vertices().len(), hull.edges().len(), hull.faces().len()), (8, 12, 6));
    }

    #[test]
    fn support_is_the_farthest_vertex(points in cloud(), direction in vector(1.0)) {
        if let Ok(hull) = Hull::convex_hull_of(&points) {
            let found = hull.support(direction).dot(direction);
            let best = hull.vertices().iter().map(|p| p.dot(direction)).fold(f32::MIN, f32::max);
            prop_assert!((found - best).abs() <= 1e-6);
        }
    }

    #[test]
    fn mass_moves_with_the_hull(points in cloud(), turn in rotation(), shift in vector(3.0)) {
        let moved: Vec<Vector> = points.iter().map(|p| turn.rotate(*p) + shift).collect();
        if let (Ok(one), Ok(two)) = (Hull::convex_hull_of(&points), Hull::convex_hull_of(&moved)) {
            let (m, n) = (one.unit_mass(), two.unit_mass());
            prop_assert!((m.mass - n.mass).abs() < 2e-3);
            prop_assert!((turn.rotate(m.center) + shift - n.center).length() < 2e-3);
            prop_assert!(close(m.inertia.rotated(turn), n.inertia, 2e-3));
        }
    }

    #[test]
    fn a_cut_box_weighs_what_its_parts_weigh(half in [0.3f32..1.0, 0.3..1.0, 0.3..1.0], at in -0.9f32..0.9) {
        let h = Vector::from_array(half);
        let whole = Hull::cuboid(h).expect("positive").unit_mass();
        let cut = at * h.x;
        let part = |low: f32, high: f32| {
            let points: Vec<Vector> = (0..8)
                .map(|i| v(if i & 1 == 0 { low } else { high }, if i & 2 == 0 { -h.y } else { h.y }, if i & 4 == 0 { -h.z } else { h.z }))
                .collect();
            Hull::convex_hull_of(&points).map(|h| h.unit_mass())
        };
        if let (Ok(a), Ok(b)) = (part(-h.x, cut), part(cut, h.x)) {
            prop_assert!((a.mass + b.mass - whole.mass).abs() < 1e-5 * whole.mass.max(1.0));
            let (i, j) = (shifted(a.inertia, a.mass, a.center), shifted(b.inertia, b.mass, b.center));
            let sum = [0, 1, 2, 3, 4, 5].map(|k| entries(i)[k] + entries(j)[k]);
            for (s, w) in sum.iter().zip(entries(whole.inertia)) {
                prop_assert!((s - w).abs() < 1e-4);
            }
        }
    }

    #[test]
    fn rays_meet_the_nearest_face(points in cloud(), from in vector(3.0), to in vector(1.2)) {
        if let Ok(hull) = Hull::convex_hull_of(&points) {
            let direction = to - from;
            let length = direction.length();
            prop_assume!(length > 0.1);
            let direction = direction * (1.0 / length);
            let inside = hull.faces().iter().all(|f| f.normal.dot(from) < f.offset);
            let hit = hull.cast_ray(from, direction, 100.0, false);
            match (hit, ray_by_brute_force(&hull, from, direction)) {
                (Some(hit), Some(distance)) => {
                    prop_assert!((hit.distance - distance).abs() < 2e-3, "{} {}", hit.distance, distance);
                    prop_assert!((hit.normal.dot(direction) > 0.0) == inside);
                }
                (None, None) => {}
                // A ray through an edge may miss in either test.
                (hit, brute) => {
                    let grazing = hull.edges().iter().any(|e| {
                        let [a, b] = [e.tail, e.head].map(|i| hull.vertices()[i as usize]);
                        line_distance(from, direction, a, b) < 2e-3
                    });
                    prop_assert!(grazing, "{hit:?} {brute:?}");
                }
            }
            if inside {
                let solid = hull.cast_ray(from, direction, 100.0, true).expect("starts inside");
                prop_assert_eq!((solid.distance, solid.normal), (0.0, Vector::ZERO));
            }
        }
    }
}

/// The approximate distance of a line from a segment, by samples along the segment.
fn line_distance(origin: Vector, direction: Vector, a: Vector, b: Vector) -> f32 {
    let off = |p: Vector| {
        let r = p - origin;
        (r - direction * r.dot(direction)).length()
    };
    (0..=1000).map(|k| off(a + (b - a) * (k as f32 / 1000.0))).fold(f32::INFINITY, f32::min)
}

#[test]
fn a_triangle_is_hit_from_both_sides() {
    let t = Triangle { a: Vector::ZERO, b: Vector::X, c: Vector::Y };
    for side in [-1.0f32, 1.0] {
        let hit =
            cast_ray_triangle(&t, v(0.2, 0.2, 2.0 * side), Vector::Z * -side, 5.0, true).expect("in the way");
        assert_eq!((hit.distance, hit.normal), (2.0, Vector::Z * side));
        assert!(cast_ray_triangle(&t, v(0.2, 0.2, 2.0 * side), Vector::Z * -side, 1.9, true).is_none());
        assert!(cast_ray_triangle(&t, v(0.6, 0.6, 2.0 * side), Vector::Z * -side, 5.0, true).is_none());
        assert!(cast_ray_triangle(&t, v(0.2, 0.2, 2.0 * side), Vector::Z * side, 5.0, true).is_none());
    }
    let segment = Shape::Segment(crate::shape::Segment { a: Vector::ZERO, b: Vector::X });
    assert!(segment.cast_ray(v(0.5, 0.0, 1.0), Vector::Z * -1.0, 5.0, true).is_none());
}

#[test]
fn a_rounded_hull_weighs_what_rays_find() {
    let corners = [v(0.1, 0.2, 0.0), v(1.3, 0.0, 0.2), v(0.2, 1.0, 0.1), v(0.4, 0.3, 1.1)];
    let wedge = [v(0.0, 0.0, 0.0), v(2.0, 0.0, 0.0), v(2.0, 0.4, 0.0), v(0.0, 0.0, 0.5), v(2.0, 0.0, 0.7)];
    for points in [&corners[..], &wedge[..]] {
        for radius in [0.0, 0.2, 1.0] {
            let hull = Hull::convex_hull_of(points).and_then(|h| h.rounded(radius)).expect("it is solid");
            check_mass_by_rays(&Shape::Hull(hull.into()), 1.5 + radius);
        }
    }
    let cuboid = Hull::cuboid(v(0.5, 0.3, 0.8)).and_then(|h| h.rounded(0.25)).expect("it is solid");
    let mass = cuboid.unit_mass();
    // A box, six plates, twelve quarters of cylinders, a ball.
    let volume =
        0.96 + 0.25 * 2.0 * (0.6 + 1.6 + 0.96) + core::f32::consts::PI * (0.0625 * 3.2 + 0.0625 / 3.0);
    assert!((mass.mass - volume).abs() < 1.0e-5 && mass.center.length() < 1.0e-6, "{} {volume}", mass.mass);
    check_mass_by_rays(&Shape::Hull(cuboid.into()), 1.3);
}

#[test]
fn a_bad_radius_is_refused() {
    let cube = || Hull::cuboid(Vector::ONE).expect("positive");
    assert_eq!(cube().rounded(-0.1), Err(ShapeError::Negative));
    assert_eq!(cube().rounded(f32::NAN), Err(ShapeError::NotFinite));
    assert_eq!(cube().rounded(0.0), Ok(cube()));
}

proptest! {
    #[test]
    fn rays_hit_rounded_hulls_where_their_normal_says(
        points in cloud(), radius in 0.01f32..0.5, from in vector(4.0), to in vector(1.0), solid in any::<bool>(),
    ) {
        let Ok(hull) = Hull::convex_hull_of(&points).and_then(|h| h.rounded(radius)) else { return Ok(()) };
        check_ray(&Shape::Hull(hull.into()), from, to, solid)?;
    }
}
