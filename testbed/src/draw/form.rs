//! Shapes as geometry to draw: outlines in the plane, triangle meshes in space.

use std::f32::consts::{FRAC_PI_2, PI, TAU};

use bevy_math::{Vec2, Vec3};

/// Corners on a full turn of a curved shape.
pub const CORNERS: usize = 40;

/// The geometry of one shape in its own frame.
#[derive(Clone, Debug)]
pub enum Form {
    /// Of the plane: one or several outlines.
    Flat(Vec<Outline>),
    /// Of space.
    Solid(Solid),
}

/// A line through points.
#[derive(Clone, Debug, Default)]
pub struct Outline {
    /// The corners; counter-clockwise and convex where `filled`.
    pub points: Vec<Vec2>,
    /// Whether the last corner leads back to the first and the inside belongs to the shape.
    pub filled: bool,
    /// A mark to see a round shape turn: from here to the first corner.
    pub spoke: Option<Vec2>,
}

/// A triangle mesh.
#[derive(Clone, Debug, Default)]
pub struct Solid {
    /// The corners.
    pub positions: Vec<Vec3>,
    /// Unit normals at the corners.
    pub normals: Vec<Vec3>,
    /// Three corners each, counter-clockwise from outside.
    pub triangles: Vec<[u32; 3]>,
}

impl Form {
    /// The bits of all coordinates: equal for equal forms.
    pub fn key(&self) -> Vec<u32> {
        match self {
            Self::Flat(outlines) => outlines
                .iter()
                .flat_map(|o| {
                    o.points.iter().flat_map(|p| p.to_array()).chain([f32::from(u8::from(o.filled))])
                })
                .map(f32::to_bits)
                .collect(),
            Self::Solid(solid) => {
                let corners = solid.triangles.iter().flatten().map(|&i| solid.positions[i as usize]);
                corners.flat_map(|p| p.to_array()).map(f32::to_bits).collect()
            }
        }
    }
}

impl Outline {
    /// A closed, filled polygon.
    pub fn polygon(points: Vec<Vec2>) -> Self {
        Self { points, filled: true, spoke: None }
    }

    /// An open line.
    pub fn line(points: Vec<Vec2>) -> Self {
        Self { points, filled: false, spoke: None }
    }

    /// A circle around the origin.
    pub fn circle(radius: f32) -> Self {
        let points =
            (0..CORNERS).map(|i| Vec2::from_angle(i as f32 * TAU / CORNERS as f32) * radius).collect();
        Self { points, filled: true, spoke: Some(Vec2::ZERO) }
    }

    /// Any convex shape, by its farthest point in each direction.
    pub fn from_support(support: impl Fn(Vec2) -> Vec2) -> Self {
        let mut points: Vec<Vec2> =
            (0..2 * CORNERS).map(|i| support(Vec2::from_angle(i as f32 * PI / CORNERS as f32))).collect();
        points.dedup_by(|a, b| a.distance_squared(*b) < 1e-12);
        Self::polygon(points)
    }
}

impl Solid {
    /// Triangles with one flat normal each.
    pub fn faceted(positions: &[Vec3], triangles: impl IntoIterator<Item = [u32; 3]>) -> Self {
        let mut solid = Self::default();
        for triangle in triangles {
            let [a, b, c] = triangle.map(|i| positions[i as usize]);
            solid.push_face(&[a, b, c], (b - a).cross(c - a).normalize_or_zero());
        }
        solid
    }

    /// A box by its half extents.
    pub fn cuboid(half: Vec3) -> Self {
        let mut solid = Self::default();
        for axis in 0..3 {
            for side in [-1.0, 1.0] {
                let (mut normal, mut u, mut v) = (Vec3::ZERO, Vec3::ZERO, Vec3::ZERO);
                normal[axis] = side;
                u[(axis + 1) % 3] = 1.0;
                v[(axis + 2) % 3] = side;
                let corner = |s: f32, t: f32| (normal + u * s + v * t) * half;
                solid.push_face(
                    &[corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)],
                    normal,
                );
            }
        }
        solid
    }

    /// Any convex shape with a round surface, by its farthest point in each direction: the direction
    /// is the normal.
    pub fn from_support(support: impl Fn(Vec3) -> Vec3) -> Self {
        let rings = CORNERS / 2;
        let mut solid = Self::default();
        for ring in 0..=rings {
            let (sin, cos) = (PI * ring as f32 / rings as f32 - FRAC_PI_2).sin_cos();
            for i in 0..=CORNERS {
                // Half a step off the axes, so that no direction hits an edge of a box exactly.
                let around = Vec2::from_angle((i as f32 + 0.5) * TAU / CORNERS as f32);
                let normal = Vec3::new(cos * around.x, sin, cos * around.y);
                solid.positions.push(support(normal));
                solid.normals.push(normal);
            }
        }
        let stride = CORNERS as u32 + 1;
        for ring in 0..rings as u32 {
            for i in 0..CORNERS as u32 {
                let a = ring * stride + i;
                let (b, c, d) = (a + 1, a + stride, a + stride + 1);
                solid.triangles.extend([[a, c, b], [b, c, d]]);
            }
        }
        solid
    }

    /// A frustum around y by its radii and half its height: cylinders and cones.
    pub fn frustum(bottom: f32, top: f32, half_height: f32) -> Self {
        let mut solid = Self::default();
        let slope = (bottom - top) / (2.0 * half_height).max(f32::MIN_POSITIVE);
        let around = |i: usize| Vec2::from_angle(-(i as f32) * TAU / CORNERS as f32);
        let at = |i: usize, radius: f32, y: f32| Vec3::new(around(i).x * radius, y, around(i).y * radius);
        for i in 0..=CORNERS {
            let normal = Vec3::new(around(i).x, slope, around(i).y).normalize();
            solid.positions.extend([at(i, bottom, -half_height), at(i, top, half_height)]);
            solid.normals.extend([normal, normal]);
        }
        for i in 0..CORNERS as u32 {
            let a = 2 * i;
            solid.triangles.extend([[a, a + 2, a + 1], [a + 1, a + 2, a + 3]]);
        }
        let upper: Vec<Vec3> = (0..CORNERS).map(|i| at(i, top, half_height)).collect();
        let lower: Vec<Vec3> = (0..CORNERS).rev().map(|i| at(i, bottom, -half_height)).collect();
        if top > 0.0 {
            solid.push_face(&upper, Vec3::Y);
        }
        if bottom > 0.0 {
            solid.push_face(&lower, Vec3::NEG_Y);
        }
        solid
    }

    /// Appends another mesh, each corner sent through `place` (a position) and `turn` (a normal).
    pub fn append(&mut self, other: &Self, place: impl Fn(Vec3) -> Vec3, turn: impl Fn(Vec3) -> Vec3) {
        let base = self.positions.len() as u32;
        self.positions.extend(other.positions.iter().map(|&p| place(p)));
        self.normals.extend(other.normals.iter().map(|&n| turn(n)));
        self.triangles.extend(other.triangles.iter().map(|t| t.map(|i| i + base)));
    }

    /// Appends a flat convex face.
    fn push_face(&mut self, corners: &[Vec3], normal: Vec3) {
        let base = self.positions.len() as u32;
        self.positions.extend_from_slice(corners);
        self.normals.extend(corners.iter().map(|_| normal));
        self.triangles.extend((2..corners.len() as u32).map(|i| [base, base + i - 1, base + i]));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Signed volume by the divergence theorem: right only if every triangle is wound outwards and
    /// none is missing.
    fn volume(solid: &Solid) -> f32 {
        let corner = |i: u32| solid.positions[i as usize];
        solid.triangles.iter().map(|&[a, b, c]| corner(a).dot(corner(b).cross(corner(c))) / 6.0).sum()
    }

    fn normals_point_outwards(solid: &Solid) {
        for &triangle in &solid.triangles {
            let [a, b, c] = triangle.map(|i| solid.positions[i as usize]);
            let face = (b - a).cross(c - a);
            if face.length() > 1e-4 {
                for i in triangle {
                    assert!(face.normalize().dot(solid.normals[i as usize]) > 0.5, "{a} {b} {c}");
                }
            }
        }
    }

    #[test]
    fn solids_are_closed_and_wound_outwards() {
        let cuboid = Solid::cuboid(Vec3::new(1.0, 2.0, 3.0));
        assert!((volume(&cuboid) - 48.0).abs() < 1e-3);
        let ball = Solid::from_support(|d| 2.0 * d);
        assert!((volume(&ball) / (32.0 / 3.0 * PI) - 1.0).abs() < 0.02);
        let cylinder = Solid::frustum(1.0, 1.0, 2.0);
        assert!((volume(&cylinder) / (4.0 * PI) - 1.0).abs() < 0.02);
        let cone = Solid::frustum(1.0, 0.0, 1.5);
        assert!((volume(&cone) / PI - 1.0).abs() < 0.02);
        for solid in [cuboid, ball, cylinder, cone] {
            normals_point_outwards(&solid);
        }
    }

    #[test]
    fn a_circle_is_the_same_by_support() {
        let outline = Outline::from_support(|d| 3.0 * d);
        assert!(outline.points.iter().all(|p| (p.length() - 3.0).abs() < 1e-5));
        assert_eq!(outline.points.len(), 2 * CORNERS);
    }
}
