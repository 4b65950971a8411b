//! The triangles of a surface: their borders, and contacts with their face alone.

use super::reduce::{Candidates, MAX_CANDIDATES, keep};
use super::view::{Facing, Small, View, with_view};
use super::{curved, triangle};
use crate::manifold::border::{Border, is_beside};
use crate::manifold::pairs::{collide_pair, drop_unusable, is_near};
use crate::manifold::{LocalManifold, LocalPoint, PairInput};
use crate::math::{F32x4, Vector, max};
use crate::shape::{Shape, Triangle};

/// The unit normal of a triangle, counter-clockwise from outside; `None` if it has no area.
pub(in crate::manifold) fn face_normal([a, b, c]: [Vector; 3]) -> Option<Vector> {
    Facing::of([b - a, c - b, a - c]).map(|facing| facing.normal)
}

/// Vectors across four triangles, of any length; 0 without area.
#[inline(always)]
pub(in crate::manifold) fn facing([a, b, c]: &[Vector<F32x4>; 3]) -> Vector<F32x4> {
    (*b - *a).cross(*c - *a)
}

/// The sides of a triangle with the given normal.
pub(in crate::manifold) fn borders(corners: [Vector; 3], normal: Vector) -> [Border; 3] {
    core::array::from_fn(|k| {
        let corner = corners[k];
        let side = corners[(k + 1) % 3] - corner;
        let along = side * (1.0 / max(side.length(), f32::MIN_POSITIVE));
        let outward = along.cross(normal);
        Border { corner, along, outward, depth: (corner - corners[(k + 2) % 3]).dot(outward) }
    })
}

/// A convex shape to collide with several facets in sequence.
pub(in crate::manifold) struct Convex<'a> {
    pub shape: &'a Shape,
    /// The polyhedral core; none for balls, whose contacts have closed forms.
    core: Option<&'a View<'a>>,
}

/// Calls `f` with a shape to collide with facets.
pub(in crate::manifold) fn with_convex<R>(shape: &Shape, f: impl FnOnce(&Convex) -> R) -> R {
    match shape {
        Shape::Ball(_) => f(&Convex::of(shape)),
        _ => with_view(shape, |core| f(&Convex { shape, core })),
    }
}

impl<'a> Convex<'a> {
    /// A shape to collide with few facets or none.
    pub fn of(shape: &'a Shape) -> Self {
        Self { shape, core: None }
    }

    /// Fills `out` with the contact of a single triangle; see [`collide_pair`].
    pub fn collide_facet(&self, corners: [Vector; 3], input: PairInput, out: &mut LocalManifold) {
        if let Some(core) = self.core
            && is_near(input.pose)
            && triangle::collide(corners, core, input, out)
        {
            out.radii = [0.0, core.radius];
            return drop_unusable(out);
        }
        let [a, b, c] = corners;
        let facet = Shape::Triangle(Triangle { a, b, c });
        collide_pair(&facet, self.shape, input, out);
    }

    /// Fills `out` with the contact of a triangle's face alone, where the shape is over it. `normal` is the
    /// face's, towards the shape.
    pub fn collide_face(
        &self,
        corners: [Vector; 3],
        normal: Vector,
        input: PairInput,
        out: &mut LocalManifold,
    ) {
        if let Some(core) = self.core {
            return triangle::collide_face(corners, normal, core, input, out);
        }
        (out.count, out.gap) = (0, 0.0);
        if let Shape::Curved(other) = self.shape {
            let small = Small::triangle(corners);
            return curved::collide_face(&small.view(), normal, other, input, out);
        }
        let PairInput { pose, prediction, .. } = input;
        let Some(lowest) = self.shape.support(pose.rotation.inverse_rotate(-normal)) else { return };
        let lowest = pose.transform(lowest);
        let separation = (lowest - corners[0]).dot(normal);
        if separation <= prediction
            && !face_normal(corners).is_some_and(|face| is_beside(&borders(corners, face), lowest))
        {
            out.normal = normal;
            out.push(lowest - normal * (0.5 * separation), separation, 0);
        } else {
            out.gap = max(separation, 0.0);
        }
    }
}

/// Reduces `points` to a few points with the same support, and stores them in a manifold.
pub(in crate::manifold) fn few_points(points: &[LocalPoint], out: &mut LocalManifold) {
    let mut candidates = Candidates::<MAX_CANDIDATES>::new();
    points.iter().for_each(|p| candidates.push(*p));
    keep::<true>(candidates.as_slice(), out);
}
