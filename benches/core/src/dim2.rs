//! Two dimensions.

use parry2d::{
    math::{Pose, Vector},
    query::contact,
    shape::SharedShape,
};

use crate::world::{self, Dimension};

/// A point or a direction.
pub type V2 = [f32; 2];
/// A body in 2D.
pub type Body2 = world::Body<D2>;
/// A shape of a body in 2D.
pub type Part2 = world::Part<D2>;
/// A revolute joint.
pub type Joint2 = world::Joint<D2>;
/// A ray in 2D.
pub type Ray2 = world::Ray<D2>;
/// Where a body is in 2D.
pub type State2 = world::State<D2>;

/// Two dimensions.
#[derive(Clone, Copy, Debug)]
pub struct D2;

/// A shape in 2D.
#[derive(Clone, Debug)]
pub enum Shape2 {
    /// Radius.
    Circle(f32),
    /// Half extents.
    Box(f32, f32),
    /// Along x: half length of the segment, radius.
    Capsule(f32, f32),
    /// Convex, at most eight points, in any order.
    Poly(Vec<V2>),
}

fn vector(p: V2) -> Vector {
    Vector::new(p[0], p[1])
}

impl Dimension for D2 {
    type Vec = V2;
    /// In radians.
    type Turn = f32;
    type Spin = f32;
    type Shape = Shape2;
    type Pose = Pose;
    type Solid = SharedShape;

    const NUMBER: u32 = 2;
    const ZERO: V2 = [0.0; 2];
    const UPRIGHT: f32 = 0.0;
    const STILL: f32 = 0.0;

    fn is_finite(turn: f32) -> bool {
        turn.is_finite()
    }

    fn is_mesh(_: &Shape2) -> bool {
        false
    }

    fn pose(at: V2, turn: f32) -> Pose {
        Pose::new(vector(at), turn)
    }

    fn point(pose: &Pose, local: V2) -> V2 {
        (*pose * vector(local)).into()
    }

    fn solid(shape: &Shape2) -> SharedShape {
        match shape {
            Shape2::Circle(r) => SharedShape::ball(*r),
            Shape2::Box(x, y) => SharedShape::cuboid(*x, *y),
            Shape2::Capsule(h, r) => SharedShape::capsule_x(*h, *r),
            Shape2::Poly(points) => {
                let points: Vec<Vector> = points.iter().map(|p| vector(*p)).collect();
                SharedShape::convex_hull(&points).expect("a convex polygon")
            }
        }
    }

    fn bounds(solid: &SharedShape, pose: &Pose) -> (V2, V2) {
        let aabb = solid.compute_aabb(pose);
        (aabb.mins.into(), aabb.maxs.into())
    }

    fn depth(a: (&SharedShape, &Pose), b: (&SharedShape, &Pose)) -> f32 {
        contact(a.1, &**a.0, b.1, &**b.0, 0.0).ok().flatten().map_or(0.0, |c| -c.dist)
    }
}
