//! Separating axes of two polyhedra: the normals of their faces, and the products of their edges that
//! the Gauss map leaves.

use super::view::{Frame, View};
use crate::math::{F32x4, Lane, Num, Vector};

/// Edges with a smaller sine between them count as parallel: their product has no direction.
const PARALLEL: f32 = 0.005;

/// The face of one polyhedron that separates best.
#[derive(Clone, Copy)]
pub(super) struct FaceAxis {
    pub face: usize,
    /// The signed distance of the other polyhedron from the face's plane.
    pub separation: f32,
}

/// The pair of edges that separates best.
#[derive(Clone, Copy)]
pub(super) struct EdgeAxis {
    pub a: usize,
    pub b: usize,
    /// The unit normal from A to B, in A's frame.
    pub normal: Vector,
    pub separation: f32,
}

/// The signed distance of `other` from a face of `this`, where `frame` takes `other` into its frame.
#[inline(always)]
pub(super) fn face_separation(this: &View, face: usize, other: &View, frame: &Frame) -> f32 {
    let f = &this.faces[face];
    other.lowest(frame.direction_in(f.normal)) + (f.normal.dot(frame.position) - f.offset)
}

/// The face of `this` with the largest separation, where `frame` takes `other` into the frame of
/// `this`. Stops at the first that is above `limit`.
pub(super) fn best_face(this: &View, other: &View, frame: &Frame, limit: f32) -> FaceAxis {
    let mut best = FaceAxis { face: 0, separation: f32::NEG_INFINITY };
    for face in 0..this.faces.len() {
        let separation = face_separation(this, face, other, frame);
        if separation > best.separation {
            best = FaceAxis { face, separation };
            if separation > limit {
                break;
            }
        }
    }
    best
}

/// Edges of B in A's frame against four edges of A at a time.
///
/// The axis e_A × e_B is a face normal of the Minkowski difference A − B only if the arcs of the two
/// edges on the Gauss map, that of B point-reflected, cross (Gregorius, "The Separating Axis Test
/// between Convex Polyhedra", GDC 2013). An arc goes from the left normal l to the right one r by a
/// turn about the edge's direction; it meets the great circle of the other edge e where l·e and r·e
/// differ in sign, at sign(l·e) e_A × e_B for A's arc, and at the corresponding sign for B's. Both
/// must be the same point, and that point is the outward axis. Using the directions of the edges
/// instead of products of normals keeps this right for arcs up to 180°, as a flat triangle has.
struct EdgeTest {
    direction: Vector<F32x4>,
    left: Vector<F32x4>,
    right: Vector<F32x4>,
    tail: Vector<F32x4>,
}

impl EdgeTest {
    /// The separations along the four axes, −∞ where there is none, and the signs of the products.
    #[inline(always)]
    fn run(&self, block: &crate::shape::EdgeBlock) -> Option<(F32x4, F32x4)> {
        let (a_left, a_right) = (block.left.dot(self.direction), block.right.dot(self.direction));
        let (b_left, b_right) = (self.left.dot(block.direction), self.right.dot(block.direction));
        let (a_turn, b_turn) = (a_left - a_right, b_left - b_right);
        let crosses = F32x4::and(
            F32x4::and((a_left * a_right).le(F32x4::ZERO), (b_left * b_right).le(F32x4::ZERO)),
            F32x4::ZERO.lt(a_turn * b_turn),
        );
        if !F32x4::any(crosses) {
            return None;
        }
        let axis = block.direction.cross(self.direction);
        let square = axis.length_squared();
        let usable = F32x4::and(crosses, F32x4::splat(PARALLEL * PARALLEL).lt(square));
        let sign = F32x4::select(F32x4::ZERO.lt(a_turn), F32x4::ONE, -F32x4::ONE);
        let separation = axis.dot(self.tail - block.tail) * sign / square.sqrt();
        Some((F32x4::select(usable, separation, F32x4::splat(f32::NEG_INFINITY)), sign))
    }
}

/// The pair of edges with the largest separation; `frame` takes B into A's frame. Stops at the first
/// that is above `limit`.
pub(super) fn best_edges(a: &View, b: &View, frame: &Frame, limit: f32) -> Option<EdgeAxis> {
    let mut best = f32::NEG_INFINITY;
    let mut found = None;
    'search: for (j, of_b) in b.edge_blocks.iter().enumerate() {
        let direction = frame.direction(of_b.direction);
        let (left, right) = (frame.direction(of_b.left), frame.direction(of_b.right));
        let tail = frame.point(of_b.tail);
        for lane in 0..remaining(b, j) {
            let test = EdgeTest {
                direction: Vector::splat(direction.get(lane)),
                left: Vector::splat(left.get(lane)),
                right: Vector::splat(right.get(lane)),
                tail: Vector::splat(tail.get(lane)),
            };
            for (i, of_a) in a.edge_blocks.iter().enumerate() {
                let Some((separations, sign)) = test.run(of_a) else { continue };
                if !F32x4::any(F32x4::splat(best).lt(separations)) {
                    continue;
                }
                for k in 0..remaining(a, i) {
                    if separations.get(k) > best {
                        best = separations.get(k);
                        found = Some((4 * i + k, 4 * j + lane, sign.get(k)));
                    }
                }
                if best > limit {
                    break 'search;
                }
            }
        }
    }
    let (i, j, sign) = found?;
    let axis = a.edge_blocks[i / 4].direction.get(i % 4).cross(frame.direction(edge_direction(b, j))) * sign;
    Some(EdgeAxis { a: i, b: j, normal: axis * (1.0 / axis.length()), separation: best })
}

/// One pair of edges again: `None` if it is no axis of the Minkowski difference any more.
pub(super) fn edge_separation(a: &View, i: usize, b: &View, j: usize, frame: &Frame) -> Option<EdgeAxis> {
    let of_b = &b.edge_blocks[j / 4];
    let test = EdgeTest {
        direction: Vector::splat(frame.direction(of_b.direction.get(j % 4))),
        left: Vector::splat(frame.direction(of_b.left.get(j % 4))),
        right: Vector::splat(frame.direction(of_b.right.get(j % 4))),
        tail: Vector::splat(frame.point(of_b.tail.get(j % 4))),
    };
    let (separations, sign) = test.run(&a.edge_blocks[i / 4])?;
    let separation = separations.get(i % 4);
    if separation == f32::NEG_INFINITY {
        return None;
    }
    let axis = a.edge_blocks[i / 4].direction.get(i % 4).cross(test.direction.get(0)) * sign.get(i % 4);
    Some(EdgeAxis { a: i, b: j, normal: axis * (1.0 / axis.length()), separation })
}

fn edge_direction(view: &View, edge: usize) -> Vector {
    view.edge_blocks[edge / 4].direction.get(edge % 4)
}

/// How many lanes of an edge block are edges and not padding.
fn remaining(view: &View, block: usize) -> usize {
    (view.edges.len() - 4 * block).min(4)
}
