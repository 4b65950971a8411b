//! The closest points of two convex cores (Gilbert, Johnson and Keerthi, "A Fast Procedure for Computing the
//! Distance Between Complex Objects in Three-Dimensional Space", 1988), in `f64`.

use super::Convex;
use super::dim::nearest_weights;
use super::simplex::Weights;
use crate::math::{DIM, Pose, Rot, Vector};

/// Maximum number of iterations. Polytopes need a few; curved cores gain about a digit every two iterations.
const MAX_ITERATIONS: usize = 64;

type Wide = Vector<f64>;

/// The Minkowski difference A − B of two cores, given by its farthest points.
pub(crate) trait Difference {
    /// Cores closer than this share of the simplex's size touch: the rounding of vertices, with a margin.
    const TOUCHING: f64;
    /// The relative accuracy of distances, added to the requested tolerance.
    const RELATIVE: f64;

    /// The vertex farthest along a direction of about unit length.
    fn vertex(&self, direction: Wide) -> Vertex;
}

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

/// The requested accuracy of a distance.
#[derive(Clone, Copy)]
pub(crate) struct Accuracy {
    /// The tolerance, in metres.
    pub(crate) tolerance: f64,
    /// Cores farther apart than this need no exact distance, in metres.
    pub(crate) beyond: f64,
}

/// The closest points of two cores.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cores {
    /// The point on A, in A's frame.
    pub(crate) a: Wide,
    /// The point on B, in A's frame.
    pub(crate) b: Wide,
    /// The unit normal from A to B; zero if they touch or overlap.
    pub(crate) normal: Wide,
    /// In metres; 0 if they touch or overlap.
    pub(crate) distance: f64,
    /// The gap between the planes with this normal at both cores: a lower bound of the distance, in metres.
    pub(crate) gap: f64,
}

/// A vertex of the Minkowski difference A − B.
#[derive(Clone, Copy, Default)]
pub(crate) struct Vertex {
    a: Wide,
    b: Wide,
    w: Wide,
    weight: f64,
    /// The vertex numbers of A and B. The distance search does not need them, and sets 0.
    pub(crate) features: [u32; 2],
}

impl Vertex {
    /// The difference of a point of A and a point of B.
    #[inline]
    pub(crate) fn new(a: Wide, b: Wide, features: [u32; 2]) -> Self {
        Self { a, b, w: a - b, weight: 1.0, features }
    }
}

/// Two cores: A is fixed, B moves.
pub(crate) struct Moving<'a> {
    a: &'a Convex<'a>,
    b: &'a Convex<'a>,
    /// The pose of B in A's frame.
    frame: Frame,
}

impl Difference for Moving<'_> {
    const TOUCHING: f64 = 1.0e-10;
    const RELATIVE: f64 = 1.0e-7;

    #[inline]
    fn vertex(&self, direction: Wide) -> Vertex {
        let a = self.a.farthest(direction.narrow()).widen();
        let b = if self.b.is_point() {
            self.frame.position
        } else {
            let inner = self.frame.rotation.inverse_rotate(-direction);
            self.frame.position + self.frame.rotation.rotate(self.b.farthest(inner.narrow()).widen())
        };
        Vertex::new(a, b, [0; 2])
    }
}

/// A search for the closest points of core A and core B. It keeps its simplex, so the search after a small
/// motion of B is short.
pub(crate) struct Search<D> {
    difference: D,
    simplex: [Vertex; DIM + 1],
    count: usize,
    /// The point of the simplex that is nearest to the origin.
    nearest: Wide,
}

/// A displacement of B along a line that meets nothing.
#[derive(Clone, Copy)]
pub(crate) struct FreeWay {
    /// The length, in metres.
    pub(crate) length: f64,
    /// The normal of the last plane between A and B that B was moved up to; zero if there was no plane.
    pub(crate) normal: Wide,
}

/// The closest points of core A and core B. `frame` is the pose of B in A's frame, `guess` a direction from A
/// to B, of about unit length or zero. `None` if a number is not finite.
pub(crate) fn closest_cores(
    a: &Convex<'_>,
    b: &Convex<'_>,
    frame: &Frame,
    guess: Wide,
    accuracy: Accuracy,
) -> Option<Cores> {
    Search::of_cores(a, b, *frame, guess).closest(accuracy)
}

impl<'a> Search<Moving<'a>> {
    /// `guess` as in [`closest_cores`].
    pub(crate) fn of_cores(a: &'a Convex<'a>, b: &'a Convex<'a>, frame: Frame, guess: Wide) -> Self {
        Self::new(Moving { a, b, frame }, guess)
    }

    /// The pose of B in A's frame.
    pub(crate) fn frame(&self) -> Frame {
        self.difference.frame
    }

    /// Moves B, and finds the nearest point of the simplex again.
    pub(crate) fn move_by(&mut self, offset: Wide) {
        self.shift(offset);
        self.renew();
    }

    fn shift(&mut self, offset: Wide) {
        self.difference.frame.position += offset;
        for vertex in &mut self.simplex[..self.count] {
            vertex.b += offset;
            vertex.w = vertex.a - vertex.b;
        }
    }

    /// Reduces the simplex. A simplex around the origin becomes its first vertex.
    fn renew(&mut self) {
        match reduced(&mut self.simplex, self.count) {
            Some((count, point)) => (self.count, self.nearest) = (count, point),
            None => {
                self.simplex[0].weight = 1.0;
                (self.count, self.nearest) = (1, self.simplex[0].w);
            }
        }
    }

    /// Moves B along the unit vector `direction` while a plane keeps it farther than `target` from A, up to
    /// `tolerance`. `None` if B meets nothing within `limit`. The search for planes is the search for the
    /// closest points, continued while B moves (G. van den Bergen, "Ray Casting against General Convex
    /// Objects with Application to Continuous Collision Detection", 2004). All lengths are in metres.
    pub(crate) fn advance(
        &mut self,
        direction: Wide,
        target: f64,
        tolerance: f64,
        limit: f64,
    ) -> Option<FreeWay> {
        let mut free = FreeWay { length: 0.0, normal: Wide::ZERO };
        for _ in 0..MAX_ITERATIONS {
            let square = self.nearest.length_squared();
            if !(square < f64::INFINITY) || square <= target * target || self.touches(square) {
                break;
            }
            let distance = square.sqrt();
            let normal = self.nearest * (-1.0 / distance);
            let mut new = self.difference.vertex(normal);
            let gap = -normal.dot(new.w);
            let is_apart = gap > target + tolerance;
            if is_apart {
                let rate = -direction.dot(normal);
                // A NaN is a miss.
                if !(rate > 0.0) {
                    return None;
                }
                let length = (gap - target - 0.5 * tolerance) / rate;
                let step = direction * length;
                free.length += length;
                free.normal = normal;
                if !(free.length <= limit) {
                    return None;
                }
                let is_known = self.has(&new);
                self.shift(step);
                new.b += step;
                new.w = new.a - new.b;
                if is_known {
                    self.renew();
                    continue;
                }
            } else if self.has(&new) || distance - gap <= tolerance + Moving::RELATIVE * distance {
                break;
            }
            if self.count > DIM {
                self.renew();
                break;
            }
            self.simplex[self.count] = new;
            self.count += 1;
            let inside = reduced(&mut self.simplex, self.count);
            let Some((count, point)) = inside else {
                self.count -= 1;
                self.renew();
                break;
            };
            (self.count, self.nearest) = (count, point);
            if !is_apart && !(point.length_squared() < square) {
                break;
            }
        }
        Some(free)
    }
}

impl<D: Difference> Search<D> {
    /// Begins with the vertex along a direction from A to B, of about unit length or zero.
    pub(crate) fn new(difference: D, start: Wide) -> Self {
        let first = difference.vertex(start);
        let mut simplex = [Vertex::default(); DIM + 1];
        simplex[0] = first;
        Self { difference, simplex, count: 1, nearest: first.w }
    }

    /// The vertices between which the closest points lie.
    pub(crate) fn simplex(&self) -> &[Vertex] {
        &self.simplex[..self.count]
    }

    /// The closest points. `None` if a number is not finite.
    pub(crate) fn closest(&mut self, accuracy: Accuracy) -> Option<Cores> {
        let mut gap = f64::NEG_INFINITY;
        for _ in 0..MAX_ITERATIONS {
            let square = self.nearest.length_squared();
            if self.touches(square) {
                return Some(touching(self.simplex()));
            }
            if !(square < f64::INFINITY) {
                return None;
            }
            let distance = square.sqrt();
            let new = self.difference.vertex(self.nearest * (-1.0 / distance));
            gap = self.nearest.dot(new.w) / distance;
            let near = distance - gap <= accuracy.tolerance + D::RELATIVE * distance;
            if self.has(&new) || near || gap > accuracy.beyond || self.count > DIM {
                break;
            }
            self.simplex[self.count] = new;
            let extended = &self.simplex[..self.count + 1];
            let Some((weights, point)) = nearest_of(extended, true) else {
                return Some(touching(extended));
            };
            if !(point.length_squared() < square) {
                break;
            }
            (self.count, self.nearest) = (keep(&mut self.simplex, self.count + 1, &weights), point);
            gap = f64::NEG_INFINITY;
        }
        let distance = self.nearest.length();
        let normal = self.nearest * (-1.0 / distance);
        if gap == f64::NEG_INFINITY {
            gap = -normal.dot(self.difference.vertex(normal).w);
        }
        let [a, b] = witness(self.simplex());
        Some(Cores { a, b, normal, distance, gap })
    }

    /// Whether the simplex touches the origin. `square` is the squared distance of its nearest point.
    fn touches(&self, square: f64) -> bool {
        let scale = self.simplex().iter().fold(0.0, |most: f64, v| most.max(v.w.length_squared()));
        square <= D::TOUCHING * D::TOUCHING * scale
    }

    fn has(&self, new: &Vertex) -> bool {
        self.simplex().iter().any(|v| v.w == new.w && v.features == new.features)
    }
}

/// Reduces the simplex to its face nearest to the origin and returns the face's size and nearest point.
/// `None` if the origin is inside.
fn reduced(simplex: &mut [Vertex; DIM + 1], count: usize) -> Option<(usize, Wide)> {
    let (weights, point) = nearest_of(&simplex[..count], false)?;
    Some((keep(simplex, count, &weights), point))
}

/// The point of a simplex that is nearest to the origin, and its weights. `None` if the origin is inside.
/// `is_extended` as in [`nearest_weights`].
#[inline(always)]
fn nearest_of(simplex: &[Vertex], is_extended: bool) -> Option<(Weights, Wide)> {
    let mut corners = [Wide::ZERO; DIM + 1];
    for (corner, vertex) in corners.iter_mut().zip(simplex) {
        *corner = vertex.w;
    }
    let weights = nearest_weights(&corners[..simplex.len()], is_extended)?;
    let mut point = Wide::ZERO;
    for (vertex, weight) in simplex.iter().zip(weights).filter(|(_, weight)| *weight > 0.0) {
        point += vertex.w * weight;
    }
    Some((weights, point))
}

/// Keeps the vertices with a weight, and returns their number.
#[inline(always)]
fn keep(simplex: &mut [Vertex; DIM + 1], count: usize, weights: &Weights) -> usize {
    let mut kept = 0;
    for (i, weight) in weights.iter().enumerate().take(count).filter(|(_, weight)| **weight > 0.0) {
        if kept < i {
            simplex[kept] = simplex[i];
        }
        simplex[kept].weight = *weight;
        kept += 1;
    }
    kept
}

fn witness(simplex: &[Vertex]) -> [Wide; 2] {
    simplex.iter().fold([Wide::ZERO; 2], |[a, b], v| [a + v.a * v.weight, b + v.b * v.weight])
}

fn touching(simplex: &[Vertex]) -> Cores {
    let total = simplex.iter().map(|v| v.weight).sum::<f64>();
    let [a, b] = witness(simplex).map(|point| point * (1.0 / total));
    Cores { a, b, normal: Wide::ZERO, distance: 0.0, gap: 0.0 }
}
