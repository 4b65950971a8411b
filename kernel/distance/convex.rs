//! A bounded convex shape as a core and a radius.

use super::dim::farthest_vertex;
use crate::math::Vector;
use crate::shape::{Hull, Shape};

/// A core and the radius around it, in metres.
#[derive(Clone, Copy)]
pub(crate) struct Convex<'a> {
    core: Core<'a>,
    pub(crate) radius: f32,
}

#[derive(Clone, Copy)]
enum Core<'a> {
    Point,
    Segment(Vector, Vector),
    Hull(&'a Hull),
    /// A shape without a radius.
    Whole(&'a Shape),
}

impl<'a> Convex<'a> {
    /// `None` for half-spaces, composites and foreign shapes.
    #[inline]
    pub(crate) fn of(shape: &'a Shape) -> Option<Self> {
        let core = match shape {
            Shape::Ball(_) => Core::Point,
            Shape::Capsule(s) => Core::Segment(s.a, s.b),
            Shape::Segment(s) => Core::Segment(s.a, s.b),
            Shape::Hull(s) => Core::Hull(s),
            Shape::HalfSpace(_) | Shape::Composite(_) | Shape::Foreign(_) => return None,
            Shape::Cuboid(_) | Shape::Triangle(_) | Shape::Curved(_) => Core::Whole(shape),
        };
        Some(Self { core, radius: shape.radius() })
    }

    /// Whether the points of the core are rounded because they lie on a curve. Vertices are exact.
    pub(crate) fn is_curved(&self) -> bool {
        matches!(self.core, Core::Whole(Shape::Curved(_)))
    }

    /// Whether the core is the point at the origin of the shape's frame.
    #[inline]
    pub(crate) fn is_point(&self) -> bool {
        matches!(self.core, Core::Point)
    }

    /// The point of the core farthest along a direction of any length.
    #[inline]
    pub(crate) fn farthest(&self, direction: Vector) -> Vector {
        match self.core {
            Core::Point => Vector::ZERO,
            Core::Segment(a, b) => {
                if (b - a).dot(direction) > 0.0 {
                    b
                } else {
                    a
                }
            }
            Core::Hull(hull) => farthest_vertex(hull, direction),
            Core::Whole(shape) => shape.support(direction).unwrap_or(Vector::ZERO),
        }
    }
}
