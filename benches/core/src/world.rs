//! What a world is made of, in either dimension: bodies, joints, rays, and where bodies are.

use std::fmt::Debug;
use std::ops::Mul;

/// What differs between two and three dimensions.
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
    /// A pose for the ruler.
    fn pose(at: Self::Vec, turn: Self::Turn) -> Self::Pose;
    /// A point of a body's frame in the world.
    fn point(pose: &Self::Pose, local: Self::Vec) -> Self::Vec;
    /// A shape for the ruler.
    fn solid(shape: &Self::Shape) -> Self::Solid;
    /// The box around a shape: its lowest and its highest corner.
    fn bounds(solid: &Self::Solid, pose: &Self::Pose) -> (Self::Vec, Self::Vec);
    /// How deep two shapes overlap; 0 or less if they do not.
    fn depth(a: (&Self::Solid, &Self::Pose), b: (&Self::Solid, &Self::Pose)) -> f32;
}

/// The distance of two points.
pub fn distance<D: Dimension>(a: D::Vec, b: D::Vec) -> f32 {
    a.as_ref().iter().zip(b.as_ref()).map(|(a, b)| (a - b) * (a - b)).sum::<f32>().sqrt()
}

/// How a body takes part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Never moves.
    Static,
    /// Moves with its velocity, and nothing changes that.
    Kinematic,
    /// Falls and collides.
    Dynamic,
}

/// Whether a body collides with the other bodies of its group.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Group {
    /// With everything.
    All,
    /// Not with others of this group.
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
    /// How it takes part.
    pub kind: Kind,
    /// Where its origin is, in metres.
    pub pos: D::Vec,
    /// How it is turned.
    pub turn: D::Turn,
    /// Velocity in m/s.
    pub vel: D::Vec,
    /// Angular velocity in rad/s.
    pub spin: D::Spin,
    /// Of every shape, in kg/m² or kg/m³.
    pub density: f32,
    /// Of every shape.
    pub friction: f32,
    /// What it collides with.
    pub group: Group,
    /// Its shapes.
    pub parts: Vec<Part<D>>,
}

impl<D: Dimension> Body<D> {
    /// A body of one shape, which is at its origin.
    pub fn new(kind: Kind, pos: D::Vec, shape: D::Shape) -> Self {
        Self::compound(kind, pos, vec![Part::at(D::ZERO, shape)])
    }

    /// A body of many shapes.
    pub fn compound(kind: Kind, pos: D::Vec, parts: Vec<Part<D>>) -> Self {
        Self {
            kind,
            pos,
            turn: D::UPRIGHT,
            vel: D::ZERO,
            spin: D::STILL,
            density: 1.0,
            friction: 0.6,
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

    /// The body's shape, if it has just one and that sits at the body's origin.
    pub fn only_shape(&self) -> Option<&D::Shape> {
        match &self.parts[..] {
            [part] if part.is_centred() => Some(&part.shape),
            _ => None,
        }
    }
}

/// Holds a point of one body at a point of another; the two do not collide with each other.
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
}

/// What a query looks along.
#[derive(Clone, Copy, Debug)]
pub struct Ray<D: Dimension> {
    /// Where it starts.
    pub origin: D::Vec,
    /// Unit length.
    pub dir: D::Vec,
    /// How far it goes, in metres.
    pub length: f32,
}

/// Where a body is and how it moves.
#[derive(Clone, Copy, Debug)]
pub struct State<D: Dimension> {
    /// Where its origin is.
    pub pos: D::Vec,
    /// How it is turned.
    pub turn: D::Turn,
    /// Its velocity.
    pub vel: D::Vec,
}
