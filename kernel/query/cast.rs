//! The distance at which a shape that moves along a line meets another, by conservative
//! [advancement](crate::distance::advance()).
//!
//! The distance of two convex shapes is a convex function of the displacement. The plane between both closes
//! at a constant rate, and the distance is never less than the plane's gap: advancing by gap / rate is
//! Newton's method on a convex function, from the left. It does not pass the first root. On polytopes it ends
//! after one step per face that is met, on curves each step doubles the digits.

use super::closest::{Closest, closest};
use crate::distance::{Accuracy, Approach, Convex, Cores, Frame, Search, advance, closest_cores};
use crate::math::{Pose, Vector, max};
use crate::shape::{Aabb, Composite, HalfSpace, Part, Shape};

/// Maximum number of steps of an advance. A shape that touches another in passing takes the most steps: each
/// step halves the remaining distance.
const MAX_ROUNDS: usize = 64;

/// Shapes meet at this share of their sizes. For a shape without curves the smaller of both sizes counts: its
/// vertices are exact, so a cast over a large floor is as exact as over a small one.
const MET: f64 = 1.0e-6;

/// A share of the larger size that is added, since the distance that counts as touching grows with it.
const MET_OF_LARGER: f64 = 1.0e-9;

/// How far curves are moved apart to compute their normal, as a multiple of the distance at which they meet.
/// A larger multiple turns the normal, by the displacement over the radius of curvature.
const FAR_ENOUGH: f64 = 300.0;

/// Shapes that close at less than this share of their speed slide along each other: it covers the rounding of
/// normals.
const SLIDING: f32 = 1.0e-6;

/// How far shapes that overlap where they met are moved back, as multiples of the distance at which they
/// meet.
const BACK: [f64; 5] = [4.0, 32.0, 256.0, 2048.0, 16384.0];

/// The conditions of a hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CastConfig {
    /// The distance at which shapes meet, in metres.
    pub target_distance: f32,
    /// Whether shapes that overlap at the start, and do not move deeper, are ignored.
    pub ignore_origin_penetration: bool,
    /// Whether points and normal are computed for shapes that overlap at the start.
    pub compute_contact_on_penetration: bool,
}

impl Default for CastConfig {
    fn default() -> Self {
        Self { target_distance: 0.0, ignore_origin_penetration: false, compute_contact_on_penetration: true }
    }
}

/// The hit of a moving shape B on a resting shape A.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CastHit {
    /// The distance moved until the hit, in metres.
    pub distance: f32,
    /// The nearest points at the hit, on A and on B, in A's frame. Both are the frame's origin if they were
    /// not requested.
    pub points: [Vector; 2],
    /// The unit normal from A to B, in A's frame. Zero if it was not requested.
    pub normal: Vector,
}

/// A cast in the frame of the resting shape.
#[derive(Clone, Copy)]
struct Way {
    /// The direction, of unit length.
    direction: Vector,
    config: CastConfig,
}

/// The first hit of shape `b` on shape `a` within `max_distance`, in metres. B moves from `pose_b_in_a` along
/// the unit vector `direction` in A's frame.
///
/// `None` also if a number is not finite, and for foreign shapes.
pub fn cast_shape(
    a: &Shape,
    b: &Shape,
    pose_b_in_a: &Pose,
    direction: Vector,
    max_distance: f32,
    config: &CastConfig,
) -> Option<CastHit> {
    let way = Way { direction, config: *config };
    let limit = if max_distance > f32::MAX { f32::MAX } else { max_distance };
    if !(limit >= 0.0) {
        return None;
    }
    let hit = of_shapes(a, b, pose_b_in_a, &way, limit)?;
    let finite =
        hit.distance.is_finite() && hit.normal.is_finite() && hit.points.iter().all(|p| p.is_finite());
    (finite && hit.distance <= limit).then_some(hit)
}

fn of_shapes(a: &Shape, b: &Shape, pose: &Pose, way: &Way, limit: f32) -> Option<CastHit> {
    match (a, b) {
        (Shape::Foreign(_), _) | (_, Shape::Foreign(_)) => None,
        (Shape::Composite(a), b) => of_parts(a, b, pose, way, limit),
        (Shape::HalfSpace(plane), b) if Convex::of(b).is_some() => onto_plane(*plane, a, b, pose, way, limit),
        (a, Shape::Composite(_) | Shape::HalfSpace(_)) if !matches!(a, Shape::HalfSpace(_)) => {
            turned(a, b, pose, way, limit)
        }
        (Shape::HalfSpace(_), Shape::Composite(_)) => turned(a, b, pose, way, limit),
        (Shape::HalfSpace(a_plane), b) => facing(*a_plane, a, b, pose, way),
        (a, b) => of_convex(a, b, pose, way, limit),
    }
}

/// The same cast with A moving against B.
fn turned(a: &Shape, b: &Shape, pose: &Pose, way: &Way, limit: f32) -> Option<CastHit> {
    let back = Way { direction: -pose.rotation.inverse_rotate(way.direction), ..*way };
    let hit = of_shapes(b, a, &pose.inverse(), &back, limit)?;
    let then = Pose::new(pose.position + way.direction * hit.distance, pose.rotation);
    if hit.normal == Vector::ZERO {
        return Some(hit);
    }
    let [b, a] = hit.points.map(|point| then.transform(point));
    Some(CastHit { points: [a, b], normal: -then.rotation.rotate(hit.normal), ..hit })
}

/// The first hit on any part; of equally near parts, on the first part.
fn of_parts(composite: &Composite<Shape>, b: &Shape, pose: &Pose, way: &Way, limit: f32) -> Option<CastHit> {
    let around = b.local_box(pose);
    let (from, inverse) = (around.center(), way.direction.to_array().map(|c| 1.0 / c));
    let slack = 1.0e-6 * (from.abs() + around.half()).max_element();
    let grown = around.half() + Vector::ONE * (max(way.config.target_distance, 0.0) + slack);
    let entry = |aabb: &Aabb| {
        let aabb = Aabb { min: aabb.min - grown, max: aabb.max + grown };
        aabb.ray_entry(from, Vector::from_array(inverse), f32::MAX).unwrap_or(f32::INFINITY)
    };
    let mut best: Option<(CastHit, u32)> = None;
    composite.tree().visit(limit, entry, |id, limit| {
        let hit = match composite.part(id) {
            Part::Facet(facet) => of_shapes(&Shape::from(facet), b, pose, way, limit),
            Part::Solid(own, solid) => {
                let inner = Way { direction: own.rotation.inverse_rotate(way.direction), ..*way };
                let hit = of_shapes(solid, b, &own.inverse().then(pose), &inner, limit);
                hit.map(|hit| CastHit {
                    points: hit.points.map(|point| own.transform(point)),
                    normal: own.rotation.rotate(hit.normal),
                    ..hit
                })
            }
        };
        let Some(hit) = hit.filter(|hit| hit.distance <= limit) else { return limit };
        if best.is_none_or(|best| (hit.distance, id) < (best.0.distance, best.1)) {
            best = Some((hit, id));
        }
        hit.distance
    });
    best.map(|best| best.0)
}

/// The hit of shapes that are close enough at the start.
fn at_start(a: &Shape, b: &Shape, pose: &Pose, way: &Way) -> Option<CastHit> {
    let Way { direction, config } = way;
    let unknown = CastHit { distance: 0.0, points: [Vector::ZERO; 2], normal: Vector::ZERO };
    if !config.ignore_origin_penetration && !config.compute_contact_on_penetration {
        return Some(unknown);
    }
    let Closest { points, normal, .. } = closest(a, b, pose, f32::MAX)?;
    if config.ignore_origin_penetration && direction.dot(normal) >= -SLIDING {
        return None;
    }
    let known = CastHit { distance: 0.0, points, normal };
    Some(if config.compute_contact_on_penetration { known } else { unknown })
}

fn size_of(shape: &Shape) -> f64 {
    f64::from(max(shape.ball_around().1, 0.0))
}

/// The distance at which shapes meet, in metres.
fn met_distance(shapes: [(&Shape, &Convex); 2]) -> f64 {
    let [a, b] = shapes.map(|(shape, _)| size_of(shape));
    let size = |i: usize, size: f64| if shapes[i].1.is_curved() { size } else { a.min(b) };
    MET * (size(0, a) + size(1, b)) + MET_OF_LARGER * a.max(b)
}

/// Two bounded convex shapes. B moves as far as the planes of a first search allow, then by Newton's method.
fn of_convex(shape_a: &Shape, shape_b: &Shape, pose: &Pose, way: &Way, limit: f32) -> Option<CastHit> {
    let (a, b) = (Convex::of(shape_a)?, Convex::of(shape_b)?);
    let direction = way.direction.widen();
    let target = f64::from(a.radius) + f64::from(b.radius) + f64::from(max(way.config.target_distance, 0.0));
    let met = met_distance([(shape_a, &a), (shape_b, &b)]);
    let accuracy = Accuracy { tolerance: 0.1 * met, beyond: f64::INFINITY };
    let mut search = Search::of_cores(&a, &b, Frame::from(pose), direction * -1.0);
    let free = search.advance(direction, target, met, f64::from(limit))?;
    let mut normal = free.normal;
    advance(free.length, MAX_ROUNDS, |way_done, _| {
        // A NaN is a miss.
        if !(way_done <= f64::from(limit)) {
            return None;
        }
        let cores = search.closest(accuracy)?;
        let gap = cores.distance - target;
        if way_done == 0.0 && gap <= 0.0 {
            return at_start(shape_a, shape_b, pose, way).map(Approach::Met);
        }
        // If the cores touch, the normal is the normal of the plane that was crossed.
        if cores.distance > 0.0 {
            normal = cores.normal;
        }
        let rate = -direction.dot(normal);
        if gap <= met {
            // Shapes that move apart already, or slide along each other, do not meet.
            let parting = !(rate > 1.0e-7);
            if parting && way_done == 0.0 {
                return None;
            }
            // The rest of the way is short, so the points stay valid.
            let rest = if parting { 0.0 } else { (gap / rate).clamp(0.0, 16.0 * met) };
            let distance = (way_done + rest).min(f64::from(limit).max(way_done));
            let meeting = Meeting { shapes: [&a, &b], frame: search.frame(), direction, met, target };
            let (normal, points) = meeting.contact(cores, normal)?;
            return Some(Approach::Met(CastHit { distance: distance as f32, points, normal }));
        }
        if !(rate > 0.0) {
            return None;
        }
        // The plane's gap may be less than the distance by the tolerance.
        let left = (cores.gap - target - 0.5 * met).max(0.25 * met) / rate;
        search.move_by(direction * left);
        Some(Approach::ApartUntil(way_done + left))
    })
}

/// Two convex shapes, a little before they meet.
struct Meeting<'a> {
    shapes: [&'a Convex<'a>; 2],
    frame: Frame,
    direction: Vector<f64>,
    met: f64,
    target: f64,
}

impl Meeting<'_> {
    /// The normal and the points on both shapes, given the closest points of the cores and the normal of a
    /// plane between them.
    fn contact(&self, cores: Cores, normal: Vector<f64>) -> Option<(Vector, [Vector; 2])> {
        let [a, b] = self.shapes;
        let accuracy = Accuracy { tolerance: 0.1 * self.met, beyond: f64::INFINITY };
        let earlier = |way: f64| {
            let back = Frame { position: self.frame.position - self.direction * way, ..self.frame };
            closest_cores(a, b, &back, normal, accuracy)
        };
        // Cores that overlap by a rounding error have no closest points.
        let apart = |k: f64| earlier(k * self.met).filter(|cores| cores.distance > 0.0);
        let cores =
            if cores.distance > 0.0 { cores } else { BACK.into_iter().find_map(apart).unwrap_or(cores) };
        let mut normal = if cores.distance > 0.0 { cores.normal } else { normal };
        if (a.is_curved() || b.is_curved()) && cores.distance < FAR_ENOUGH * self.met {
            // Points on curves are rounded to f32, and so is the direction between close points.
            let apart = earlier(FAR_ENOUGH * self.met)?;
            normal = if apart.distance > 0.0 { apart.normal } else { normal };
        }
        let radii = [a.radius, b.radius].map(f64::from);
        let on_a = cores.a + normal * radii[0];
        let on_b = on_a + normal * (self.target - radii[0] - radii[1]);
        Some((normal.narrow(), [on_a.narrow(), on_b.narrow()]))
    }
}

/// A bounded convex shape that moves onto a half-space.
fn onto_plane(plane: HalfSpace, a: &Shape, b: &Shape, pose: &Pose, way: &Way, limit: f32) -> Option<CastHit> {
    let now = closest(a, b, pose, f32::MAX)?;
    let gap = f64::from(now.distance) - f64::from(max(way.config.target_distance, 0.0));
    if gap <= 0.0 {
        return at_start(a, b, pose, way);
    }
    let rate = -way.direction.widen().dot(plane.normal.widen());
    if !(rate > 0.0) {
        return None;
    }
    let distance = (gap / rate) as f32;
    if !(distance <= limit) {
        return None;
    }
    let on_b = now.points[1] + way.direction * distance;
    let on_a = on_b - plane.normal * on_b.dot(plane.normal);
    Some(CastHit { distance, points: [on_a, on_b], normal: plane.normal })
}

/// Two half-spaces.
fn facing(plane: HalfSpace, a: &Shape, b: &Shape, pose: &Pose, way: &Way) -> Option<CastHit> {
    let now = closest(a, b, pose, f32::MAX)?;
    let gap = now.distance - max(way.config.target_distance, 0.0);
    if gap <= 0.0 {
        return at_start(a, b, pose, way);
    }
    let rate = -way.direction.dot(plane.normal);
    if !(rate > 0.0) {
        return None;
    }
    let distance = gap / rate;
    let on_b = now.points[1] + way.direction * distance;
    let points = [on_b - plane.normal * on_b.dot(plane.normal), on_b];
    Some(CastHit { distance, points, normal: plane.normal })
}
