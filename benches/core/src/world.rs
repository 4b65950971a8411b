//! Bodies, joints and rays in either dimension.

use std::fmt::Debug;
use std::ops::Mul;

/// The types and operations of a dimension.
pub trait Dimension: Copy + Debug + 'static {
    /// A point or a direction.
    type Vec: Copy + Debug + PartialEq + AsRef<[f32]> + AsMut<[f32]>;
    /// An orientation.
    type Turn: Copy + Debug + PartialEq;
    /// An angular velocity.
    type Spin: Copy + Debug;
    /// A shape, as the scenes name it.
    type Shape: Clone + Debug;
    /// parry's pose.
    type Pose: Copy + Mul<Output = Self::Pose>;
    /// parry's shape.
    type Solid;

    /// 2 or 3.
    const NUMBER: u32;
    /// The origin.
    const ZERO: Self::Vec;
    /// Not turned.
    const UPRIGHT: Self::Turn;
    /// Not turning.
    const STILL: Self::Spin;

    /// Whether an orientation has no NaN and nothing infinite in it.
    fn is_finite(turn: Self::Turn) -> bool;
    /// Whether the shape is a triangle mesh.
    fn is_mesh(shape: &Self::Shape) -> bool;
    /// A pose in parry's type.
    fn pose(at: Self::Vec, turn: Self::Turn) -> Self::Pose;
    /// Transforms a point from a body's frame to the world.
    fn point(pose: &Self::Pose, local: Self::Vec) -> Self::Vec;
    /// A shape in parry's type.
    fn solid(shape: &Self::Shape) -> Self::Solid;
    /// The box around a shape: its lowest and its highest corner.
    fn bounds(solid: &Self::Solid, pose: &Self::Pose) -> (Self::Vec, Self::Vec);
    /// The depth of the overlap of two shapes; 0 or less if they do not overlap.
    fn depth(a: (&Self::Solid, &Self::Pose), b: (&Self::Solid, &Self::Pose)) -> f32;
}

/// The distance of two points.
pub fn distance<D: Dimension>(a: D::Vec, b: D::Vec) -> f32 {
    a.as_ref().iter().zip(b.as_ref()).map(|(a, b)| (a - b) * (a - b)).sum::<f32>().sqrt()
}

/// The kind of a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Never moves.
    Static,
    /// Moves by its velocity only.
    Kinematic,
    /// Moves by forces and contacts.
    Dynamic,
}

/// Whether a body collides with others of its group.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Group {
    /// Collides with all.
    All,
    /// Does not collide with others of this group.
    NotEachOther,
}

/// A shape of a body.
#[derive(Clone, Debug)]
pub struct Part<D: Dimension> {
    /// The shape.
    pub shape: D::Shape,
    /// Where it is in the body's frame.
    pub pos: D::Vec,
    /// How it is turned in the body's frame.
    pub turn: D::Turn,
}

impl<D: Dimension> Part<D> {
    /// A shape at a place of the body.
    pub fn at(pos: D::Vec, shape: D::Shape) -> Self {
        Self { shape, pos, turn: D::UPRIGHT }
    }

    /// Whether the shape sits at the body's origin.
    pub fn is_centred(&self) -> bool {
        self.pos == D::ZERO && self.turn == D::UPRIGHT
    }
}

/// A rigid body.
#[derive(Clone, Debug)]
pub struct Body<D: Dimension> {
    /// The kind.
    pub kind: Kind,
    /// Where its origin is, in metres.
    pub pos: D::Vec,
    /// How it is turned.
    pub turn: D::Turn,
    /// Velocity in m/s.
    pub vel: D::Vec,
    /// Angular velocity in rad/s.
    pub spin: D::Spin,
    /// Density of every shape, in kg/m² or kg/m³.
    pub density: f32,
    /// Friction of every shape.
    pub friction: f32,
    /// Restitution of every shape.
    pub restitution: f32,
    /// Whether it must not pass static bodies, however fast. Engines that sweep only on request are asked to.
    pub bullet: bool,
    /// The collision group.
    pub group: Group,
    /// Its shapes.
    pub parts: Vec<Part<D>>,
}

impl<D: Dimension> Body<D> {
    /// A body with one shape, at its origin.
    pub fn new(kind: Kind, pos: D::Vec, shape: D::Shape) -> Self {
        Self::compound(kind, pos, vec![Part::at(D::ZERO, shape)])
    }

    /// A body with several shapes.
    pub fn compound(kind: Kind, pos: D::Vec, parts: Vec<Part<D>>) -> Self {
        Self {
            kind,
            pos,
            turn: D::UPRIGHT,
            vel: D::ZERO,
            spin: D::STILL,
            density: 1.0,
            friction: 0.6,
            restitution: 0.0,
            bullet: false,
            group: Group::All,
            parts,
        }
    }

    /// A dynamic body of one shape.
    pub fn dynamic(pos: D::Vec, shape: D::Shape) -> Self {
        Self::new(Kind::Dynamic, pos, shape)
    }

    /// A static body of one shape.
    pub fn fixed(pos: D::Vec, shape: D::Shape) -> Self {
        Self::new(Kind::Static, pos, shape)
    }

    /// The body's shape, if there is only one, at the body's origin.
    pub fn only_shape(&self) -> Option<&D::Shape> {
        match &self.parts[..] {
            [part] if part.is_centred() => Some(&part.shape),
            _ => None,
        }
    }
}

/// Keeps a point of one body at a point of another. The two bodies do not collide.
///
/// With limits, the second body turns against the first by no more: in 2D from the first to the second
/// angle; in 3D its y axis by up to the first from the first body's, and about it by up to the second either
/// way. In radians.
#[derive(Clone, Copy, Debug)]
pub struct Joint<D: Dimension> {
    /// The first body.
    pub a: usize,
    /// The second body.
    pub b: usize,
    /// The point in the first body's frame.
    pub anchor_a: D::Vec,
    /// The point in the second body's frame.
    pub anchor_b: D::Vec,
    /// The limits of turns.
    pub limits: Option<[f32; 2]>,
}

impl<D: Dimension> Joint<D> {
    /// A joint that turns freely.
    pub fn free([a, b]: [usize; 2], [anchor_a, anchor_b]: [D::Vec; 2]) -> Self {
        Self { a, b, anchor_a, anchor_b, limits: None }
    }
}

/// A ray of a query.
#[derive(Clone, Copy, Debug)]
pub struct Ray<D: Dimension> {
    /// The origin.
    pub origin: D::Vec,
    /// Unit length.
    pub dir: D::Vec,
    /// The length, in metres.
    pub length: f32,
}

/// Pose and velocity of a body.
#[derive(Clone, Copy, Debug)]
pub struct State<D: Dimension> {
    /// Where its origin is.
    pub pos: D::Vec,
    /// How it is turned.
    pub turn: D::Turn,
    /// Its velocity.
    pub vel: D::Vec,
}
