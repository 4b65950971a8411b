//! Bevy's 2D primitives as colliders.
//!
//! Every solid or open primitive with an exact collider has one. Arcs, sectors, circular segments, rings and
//! annuli have none: their outlines are curved, and the app chooses how to approximate them (a
//! `Collider::compound` of convex parts, or a `Collider::polyline`).

use super::super::Collider;
use super::super::input::checked;
use crate::collision::collider::IntoCollider;
use crate::math::{AdjustPrecision, Scalar, Vector};
use bevy_math::Vec2;
use bevy_math::primitives::{
    Capsule2d, Circle, ConvexPolygon, Ellipse, Line2d, Plane2d, Polygon, Polyline2d, Rectangle,
    RegularPolygon, Rhombus, Segment2d, Triangle2d,
};

/// Half length of the segment that replaces an infinite line, in metres.
const LINE_HALF_LENGTH: Scalar = 10_000.0;

/// The vertices in the precision of the engine.
fn adjusted(vertices: &[Vec2]) -> Vec<Vector> {
    vertices.iter().map(AdjustPrecision::adjust_precision).collect()
}

impl IntoCollider<Collider> for Circle {
    fn collider(&self) -> Collider {
        Collider::circle(self.radius.adjust_precision())
    }
}

impl IntoCollider<Collider> for Ellipse {
    fn collider(&self) -> Collider {
        let half = self.half_size.adjust_precision();
        Collider::ellipse(half.x, half.y)
    }
}

impl IntoCollider<Collider> for Plane2d {
    /// The half-space behind the line.
    fn collider(&self) -> Collider {
        Collider::half_space(self.normal.as_vec2().adjust_precision())
    }
}

impl IntoCollider<Collider> for Line2d {
    /// A segment of 20 km, since no shape is infinite in both directions.
    fn collider(&self) -> Collider {
        let half = self.direction.as_vec2().adjust_precision() * LINE_HALF_LENGTH;
        Collider::segment(-half, half)
    }
}

impl IntoCollider<Collider> for Segment2d {
    fn collider(&self) -> Collider {
        Collider::segment(self.point1().adjust_precision(), self.point2().adjust_precision())
    }
}

impl IntoCollider<Collider> for Polyline2d {
    fn collider(&self) -> Collider {
        Collider::polyline(adjusted(&self.vertices), None)
    }
}

impl IntoCollider<Collider> for Triangle2d {
    fn collider(&self) -> Collider {
        let [a, b, c] = self.vertices.map(|v| v.adjust_precision());
        Collider::triangle(a, b, c)
    }
}

impl IntoCollider<Collider> for Rectangle {
    fn collider(&self) -> Collider {
        let size = self.half_size.adjust_precision() * 2.0;
        Collider::rectangle(size.x, size.y)
    }
}

impl IntoCollider<Collider> for Rhombus {
    fn collider(&self) -> Collider {
        checked!("from(Rhombus)", |input| {
            let half = self.half_diagonals.adjust_precision();
            let (x, y) = (Vector::X * input.length(half.x), Vector::Y * input.length(half.y));
            Collider::polygon(vec![x, y, -x, -y], &mut input)
        })
    }
}

impl IntoCollider<Collider> for Polygon {
    /// The inside of the outline, decomposed into convex polygons. An outline that crosses itself gives
    /// its convex hull.
    fn collider(&self) -> Collider {
        checked!("from(Polygon)", |input| Collider::polygon(adjusted(&self.vertices), &mut input))
    }
}

impl IntoCollider<Collider> for ConvexPolygon {
    fn collider(&self) -> Collider {
        checked!("from(ConvexPolygon)", |input| Collider::polygon(adjusted(self.vertices()), &mut input))
    }
}

impl IntoCollider<Collider> for RegularPolygon {
    fn collider(&self) -> Collider {
        Collider::regular_polygon(self.circumcircle.radius, self.sides)
    }
}

impl IntoCollider<Collider> for Capsule2d {
    fn collider(&self) -> Collider {
        Collider::capsule(self.radius.adjust_precision(), 2.0 * self.half_length.adjust_precision())
    }
}
