//! The closest points of two convex cores (Gilbert, Johnson and Keerthi, "A Fast Procedure for Computing the Distance
//! Between Complex Objects in Three-Dimensional Space", 1988), in `f64`.

use super::{Convex, nearest_weights};
use crate::math::{DIM, Pose, Rot, Vector};

/// The most iterations. Polytopes need a few; curved cores gain about a digit every two.
const MAX_ITERATIONS: usize = 64;
/// Cores nearer than this share of the simplex's size touch: the rounding of `f64`, with room.
const TOUCHING: f64 = 1.0e-10;
/// The relative accuracy of distances, where it is more than what was asked for.
const RELATIVE: f64 = 1.0e-7;

type Wide = Vector<f64>;

/// The pose of one core in the frame of the other.
#[derive(Clone, Copy)]
pub(crate) struct Frame {
    pub(crate) position: Wide,
    pub(crate) rotation: Rot<f64>,
}

impl From<&Pose> for Frame {
    fn from(pose: &Pose) -> Self {
        Self { position: pose.position.widen(), rotation: pose.rotation.widen() }
    }
}

/// How exactly a distance is wanted.
#[derive(Clone, Copy)]
pub(crate) struct Accuracy {
    /// In metres.
    pub(crate) tolerance: f64,
    /// Cores farther apart than this need no exact distance, in metres.
    pub(crate) beyond: f64,
}

/// The closest points of two cores.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cores {
    /// On A.
    pub(crate) a: Wide,
    /// On B, in A's frame.
    pub(crate) b: Wide,
    /// The unit normal from A to B; zero if they touch or overlap.
    pub(crate) normal: Wide,
    /// In metres; 0 if they touch or overlap.
    pub(crate) distance: f64,
    /// The gap between the planes with that normal at both cores: a lower bound of the distance, in metres.
    pub(crate) gap: f64,
}

/// A vertex of the Minkowski difference A − B.
#[derive(Clone, Copy, Default)]
struct Vertex {
    a: Wide,
    b: Wide,
    w: Wide,
    weight: f64,
}

struct Difference<'a> {
    a: &'a Convex<'a>,
    b: &'a Convex<'a>,
    frame: &'a Frame,
}

impl Difference<'_> {
    /// The vertex farthest along a direction of about unit length.
    #[inline]
    fn vertex(&self, direction: Wide) -> Vertex {
        let a = self.a.farthest(direction.narrow()).widen();
        let inner = self.frame.rotation.inverse_rotate(-direction);
        let b = self.frame.position + self.frame.rotation.rotate(self.b.farthest(inner.narrow()).widen());
        Vertex { a, b, w: a - b, weight: 1.0 }
    }
}

/// The closest points of core A and core B, `frame` being where B is in A's. `guess` is a direction from A to B, of
/// about unit length or zero. `None` if a number is not finite.
pub(crate) fn closest_cores(
    a: &Convex<'_>,
    b: &Convex<'_>,
    frame: &Frame,
    guess: Wide,
    accuracy: Accuracy,
) -> Option<Cores> {
    let difference = Difference { a, b, frame };
    let mut simplex = [Vertex::default(); DIM + 1];
    simplex[0] = difference.vertex(guess);
    let mut count = 1;
    let mut nearest = simplex[0].w;
    let mut gap = f64::NEG_INFINITY;
    for _ in 0..MAX_ITERATIONS {
        let square = nearest.length_squared();
        let scale = simplex[..count].iter().fold(0.0, |most: f64, v| most.max(v.w.length_squared()));
        if square <= TOUCHING * TOUCHING * scale {
            return Some(touching(&simplex[..count]));
        }
        if !(square < f64::INFINITY) {
            return None;
        }
        let distance = square.sqrt();
        let new = difference.vertex(nearest * (-1.0 / distance));
        gap = nearest.dot(new.w) / distance;
        let known = simplex[..count].iter().any(|v| v.w == new.w);
        let near = distance - gap <= accuracy.tolerance + RELATIVE * distance;
        if known || near || gap > accuracy.beyond || count > DIM {
            break;
        }
        let mut next = simplex;
        next[count] = new;
        let Some((next_count, point)) = reduced(&mut next, count + 1) else {
            return Some(touching(&next[..count + 1]));
        };
        if !(point.length_squared() < square) {
            break;
        }
        (simplex, count, nearest) = (next, next_count, point);
        gap = f64::NEG_INFINITY;
    }
    let distance = nearest.length();
    let normal = nearest * (-1.0 / distance);
    if gap == f64::NEG_INFINITY {
        gap = -normal.dot(difference.vertex(normal).w);
    }
    let [a, b] = witness(&simplex[..count]);
    Some(Cores { a, b, normal, distance, gap })
}

/// Reduces the simplex to its face nearest to the origin and returns the face's size and nearest point. `None` if the
/// origin is inside.
fn reduced(simplex: &mut [Vertex; DIM + 1], count: usize) -> Option<(usize, Wide)> {
    let corners = simplex.map(|v| v.w);
    let weights = nearest_weights(&corners[..count])?;
    let mut kept = 0;
    let mut point = Wide::ZERO;
    for i in 0..count {
        if weights[i] > 0.0 {
            simplex[kept] = Vertex { weight: weights[i], ..simplex[i] };
            point += simplex[kept].w * weights[i];
            kept += 1;
        }
    }
    Some((kept, point))
}

fn witness(simplex: &[Vertex]) -> [Wide; 2] {
    simplex.iter().fold([Wide::ZERO; 2], |[a, b], v| [a + v.a * v.weight, b + v.b * v.weight])
}

fn touching(simplex: &[Vertex]) -> Cores {
    let total = simplex.iter().map(|v| v.weight).sum::<f64>();
    let [a, b] = witness(simplex).map(|point| point * (1.0 / total));
    Cores { a, b, normal: Wide::ZERO, distance: 0.0, gap: 0.0 }
}
