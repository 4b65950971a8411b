//! Outlines of shapes that differ between dimensions, and of shapes that only 3D has.

use bevy_math::{Affine3A, Quat, Vec2, Vec3};
use core::f32::consts::{PI, TAU};

use crate::{
    debug_render::{
        curves::{FAR, arc, rounded},
        dim::{edges, frame, point},
        lines::Strips,
    },
    math::{AsF32, Scalar},
    parry::{
        math::Pose,
        shape::{ConvexPolyhedron, TypedShape},
    },
    physics_transform::Rotation,
};

/// The place of a part.
pub(in crate::debug_render) fn place(pose: &Pose) -> Affine3A {
    frame(pose.translation, Rotation(pose.rotation))
}

/// Adds the outline of a shape. Returns whether the shape is known.
pub(in crate::debug_render) fn add_of_dimension(shape: &TypedShape<'_>, lines: &mut Strips) -> bool {
    match shape {
        TypedShape::Ball(s) => ball(s.radius as f32, lines),
        TypedShape::Capsule(s) => capsule(s.segment.a.f32(), s.segment.b.f32(), s.radius as f32, lines),
        TypedShape::Cuboid(s) => lines.push(edges(-s.half_extents.f32(), s.half_extents.f32())),
        TypedShape::RoundCuboid(s) => {
            round_box(s.inner_shape.half_extents.f32(), s.border_radius as f32, lines);
        }
        TypedShape::Triangle(s) => lines.push_closed([s.a, s.b, s.c].map(point)),
        TypedShape::RoundTriangle(s) => {
            let s = (&s.inner_shape, s.border_radius as f32);
            round_triangle([s.0.a, s.0.b, s.0.c].map(point), s.1, lines);
        }
        TypedShape::HeightField(s) => {
            s.triangles().for_each(|t| lines.push_closed([t.a, t.b, t.c].map(point)));
        }
        TypedShape::HalfSpace(s) => half_space(s.normal.f32(), lines),
        TypedShape::Cylinder(s) => barrel(s.half_height, s.radius, s.radius, 0.0, lines),
        TypedShape::RoundCylinder(s) => {
            barrel(
                s.inner_shape.half_height,
                s.inner_shape.radius,
                s.inner_shape.radius,
                s.border_radius,
                lines,
            );
        }
        TypedShape::Cone(s) => barrel(s.half_height, s.radius, 0.0, 0.0, lines),
        TypedShape::RoundCone(s) => {
            barrel(s.inner_shape.half_height, s.inner_shape.radius, 0.0, s.border_radius, lines);
        }
        TypedShape::ConvexPolyhedron(s) => polyhedron(s, lines),
        TypedShape::RoundConvexPolyhedron(s) => {
            round_polyhedron(&s.inner_shape, s.border_radius as f32, lines);
        }
        _ => return false,
    }
    true
}

/// A circle about the y axis.
fn ring(y: f32, radius: f32, lines: &mut Strips) {
    if radius > 0.0 {
        lines.push(arc(Vec2::ZERO, radius, 0.0, TAU).into_iter().map(|p| Vec3::new(p.x, y, p.y)));
    }
}

fn ball(radius: f32, lines: &mut Strips) {
    let circle = arc(Vec2::ZERO, radius, 0.0, TAU);
    lines.push(circle.iter().map(|p| Vec3::new(p.x, p.y, 0.0)));
    lines.push(circle.iter().map(|p| Vec3::new(p.x, 0.0, p.y)));
    lines.push(circle.iter().map(|p| Vec3::new(0.0, p.x, p.y)));
}

fn capsule(a: Vec3, b: Vec3, radius: f32, lines: &mut Strips) {
    let half = a.distance(b) / 2.0;
    let mut own = Strips::default();
    turned(&[Vec2::new(0.0, -half), Vec2::new(0.0, half)], radius, &mut own);
    for y in [-half, half] {
        ring(y, radius, &mut own);
    }
    let turn = (b - a).try_normalize().map_or(Quat::IDENTITY, |axis| Quat::from_rotation_arc(Vec3::Y, axis));
    lines.push_placed(&own, &Affine3A::from_rotation_translation(turn, (a + b) / 2.0));
}

/// A cylinder, cone or frustum about the y axis, grown by a radius.
fn barrel(half_height: Scalar, low: Scalar, high: Scalar, radius: Scalar, lines: &mut Strips) {
    let [half, low, high, radius] = [half_height, low, high, radius].map(|v| v as f32);
    let mut profile = vec![Vec2::new(-low, -half), Vec2::new(low, -half), Vec2::new(high, half)];
    if high > 0.0 {
        profile.push(Vec2::new(-high, half));
    }
    turned(&profile, radius, lines);
    let side = -Vec2::new(high - low, 2.0 * half).perp().normalize_or_zero() * radius;
    ring(-half + side.y, low + side.x, lines);
    ring(half + side.y, high + side.x, lines);
    if radius > 0.0 {
        ring(-half - radius, low, lines);
        ring(half + radius, high, lines);
    }
}

/// The outline of a solid about the y axis, seen along x and along z.
fn turned(profile: &[Vec2], radius: f32, lines: &mut Strips) {
    let outline = rounded(profile.to_vec(), radius);
    lines.push_closed(outline.iter().map(|p| Vec3::new(p.x, p.y, 0.0)));
    lines.push_closed(outline.iter().map(|p| Vec3::new(0.0, p.y, p.x)));
}

/// A square of the boundary with its diagonals, and the normal.
fn half_space(normal: Vec3, lines: &mut Strips) {
    let (a, b) = normal.any_orthonormal_pair();
    let [a, b] = [a * FAR, b * FAR];
    lines.push([a + b, a - b, -a - b, b - a, a + b, -a - b]);
    lines.push([a - b, b - a]);
    lines.push([Vec3::ZERO, normal]);
}

fn polyhedron(shape: &ConvexPolyhedron, lines: &mut Strips) {
    for face in shape.faces() {
        let first = face.first_vertex_or_edge as usize;
        let around = &shape.vertices_adj_to_face()[first..first + face.num_vertices_or_edges as usize];
        lines.push_closed(around.iter().map(|v| point(shape.points()[*v as usize])));
    }
}

fn round_polyhedron(shape: &ConvexPolyhedron, radius: f32, lines: &mut Strips) {
    let faces = shape.faces().iter().map(|face| {
        let first = face.first_vertex_or_edge as usize;
        let around = &shape.vertices_adj_to_face()[first..first + face.num_vertices_or_edges as usize];
        (around.iter().map(|v| point(shape.points()[*v as usize])).collect(), point(face.normal))
    });
    round_faces(&faces.collect::<Vec<_>>(), radius, lines);
}

fn round_box(half: Vec3, radius: f32, lines: &mut Strips) {
    let mut faces = Vec::new();
    for axis in 0..3 {
        let [n, u, v] = [axis, (axis + 1) % 3, (axis + 2) % 3].map(|i| Vec3::AXES[i]);
        for sign in [-1.0, 1.0] {
            let corner = |a: f32, b: f32| half * (n * sign + u * a + v * b);
            faces.push((
                vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)],
                n * sign,
            ));
        }
    }
    round_faces(&faces, radius, lines);
}

fn round_triangle(corners: [Vec3; 3], radius: f32, lines: &mut Strips) {
    let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize_or(Vec3::Y);
    let mut back = corners;
    back.reverse();
    round_faces(&[(corners.to_vec(), normal), (back.to_vec(), -normal)], radius, lines);
}

/// The faces of a convex solid, moved outward by a radius, and the arcs between the corners of neighbours.
fn round_faces(faces: &[(Vec<Vec3>, Vec3)], radius: f32, lines: &mut Strips) {
    for (i, (corners, normal)) in faces.iter().enumerate() {
        lines.push_closed(corners.iter().map(|corner| *corner + *normal * radius));
        let middle = corners.iter().sum::<Vec3>() / corners.len() as f32;
        for (k, end) in corners.iter().enumerate() {
            let start = corners[(k + corners.len() - 1) % corners.len()];
            let shares = |face: &&(Vec<Vec3>, Vec3)| face.0.contains(end) && face.0.contains(&start);
            let Some((_, other)) = faces[..i].iter().find(shares) else { continue };
            let mut side = (*end - start).normalize_or(Vec3::Y).cross(*normal);
            if side.dot(*end - middle) < 0.0 {
                side = -side;
            }
            for corner in [start, *end] {
                lines.push(arc_between(*normal, *other, side, radius).into_iter().map(|p| corner + p));
            }
        }
    }
}

/// The arc from one face's normal to the other's, around the edge between them. `side` points outward from
/// the edge.
fn arc_between(from: Vec3, to: Vec3, side: Vec3, radius: f32) -> Vec<Vec3> {
    let angle = Vec2::new(to.dot(from), to.dot(side)).to_angle();
    // The two faces of a flat solid point away from each other.
    let angle = if angle.abs() > 0.999 * PI { PI } else { angle };
    let arc = arc(Vec2::ZERO, radius, 0.0, angle);
    arc.into_iter().map(|p| from * p.x + side * p.y).collect()
}
