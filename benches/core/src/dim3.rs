//! Three dimensions.

use std::sync::Arc;

use parry3d::{
    math::{Pose, Rotation, Vector},
    query::contact,
    shape::SharedShape,
};

use crate::world::{self, Dimension};

/// A point or a direction.
pub type V3 = [f32; 3];
/// A quaternion: x, y, z, w.
pub type Q4 = [f32; 4];
/// A body in 3D.
pub type Body3 = world::Body<D3>;
/// A shape of a body in 3D.
pub type Part3 = world::Part<D3>;
/// A spherical joint.
pub type Joint3 = world::Joint<D3>;
/// A ray in 3D.
pub type Ray3 = world::Ray<D3>;
/// Where a body is in 3D.
pub type State3 = world::State<D3>;

/// Three dimensions.
#[derive(Clone, Copy, Debug)]
pub struct D3;

/// Triangles in space.
#[derive(Debug)]
pub struct Mesh {
    /// The corners.
    pub points: Vec<V3>,
    /// Three corners each.
    pub triangles: Vec<[u32; 3]>,
}

/// A shape in 3D.
#[derive(Clone, Debug)]
pub enum Shape3 {
    /// Radius.
    Sphere(f32),
    /// Half extents.
    Box(f32, f32, f32),
    /// Along y: half length of the segment, radius.
    Capsule(f32, f32),
    /// Along y: half height, radius.
    Cylinder(f32, f32),
    /// The convex hull of some points.
    Hull(Arc<Vec<V3>>),
    /// A triangle mesh.
    Mesh(Arc<Mesh>),
}

/// The quaternion of a turn about an axis of any length.
pub fn turn_about(axis: V3, angle: f32) -> Q4 {
    let (s, c) = (0.5 * angle).sin_cos();
    let n = (axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]).sqrt();
    [s * axis[0] / n, s * axis[1] / n, s * axis[2] / n, c]
}

fn vector(p: V3) -> Vector {
    Vector::new(p[0], p[1], p[2])
}

fn vectors(points: &[V3]) -> Vec<Vector> {
    points.iter().map(|p| vector(*p)).collect()
}

impl Dimension for D3 {
    type Vec = V3;
    type Turn = Q4;
    type Spin = V3;
    type Shape = Shape3;
    type Pose = Pose;
    type Solid = SharedShape;

    const NUMBER: u32 = 3;
    const ZERO: V3 = [0.0; 3];
    const UPRIGHT: Q4 = [0.0, 0.0, 0.0, 1.0];
    const STILL: V3 = [0.0; 3];

    fn is_finite(turn: Q4) -> bool {
        turn.iter().all(|x| x.is_finite())
    }

    fn is_mesh(shape: &Shape3) -> bool {
        matches!(shape, Shape3::Mesh(_))
    }

    fn pose(at: V3, q: Q4) -> Pose {
        Pose::from_parts(vector(at), Rotation::from_xyzw(q[0], q[1], q[2], q[3]))
    }

    fn point(pose: &Pose, local: V3) -> V3 {
        (*pose * vector(local)).into()
    }

    fn solid(shape: &Shape3) -> SharedShape {
        match shape {
            Shape3::Sphere(r) => SharedShape::ball(*r),
            Shape3::Box(x, y, z) => SharedShape::cuboid(*x, *y, *z),
            Shape3::Capsule(h, r) => SharedShape::capsule_y(*h, *r),
            Shape3::Cylinder(h, r) => SharedShape::cylinder(*h, *r),
            Shape3::Hull(points) => SharedShape::convex_hull(&vectors(points)).expect("a convex hull"),
            Shape3::Mesh(m) => {
                SharedShape::trimesh(vectors(&m.points), m.triangles.clone()).expect("a triangle mesh")
            }
        }
    }

    fn bounds(solid: &SharedShape, pose: &Pose) -> (V3, V3) {
        let aabb = solid.compute_aabb(pose);
        (aabb.mins.into(), aabb.maxs.into())
    }

    fn depth(a: (&SharedShape, &Pose), b: (&SharedShape, &Pose)) -> f32 {
        contact(a.1, &**a.0, b.1, &**b.0, 0.0).ok().flatten().map_or(0.0, |c| -c.dist)
    }
}
