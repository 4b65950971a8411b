//! Nearest points of two shapes.

use crate::distance::{Accuracy, Convex, Cores, Frame, closest_cores};
use crate::manifold::{self, FeatureCache, LocalManifold};
use crate::math::{Pose, Vector, max, min};
use crate::shape::{Aabb, Composite, HalfSpace, Part, Shape};

/// The nearest points of two shapes, or how they overlap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Closest {
    /// The points on the surface of A and of B, in A's frame.
    pub points: [Vector; 2],
    /// The unit normal from A to B, in A's frame. Zero for two half-spaces that are not opposite.
    pub normal: Vector,
    /// In metres; negative if the shapes overlap: B is free after moving by this depth along the normal. The
    /// normal has the least depth, or belongs to a face of slightly more depth, as in contacts.
    pub distance: f32,
}

impl Closest {
    /// The same result seen from B, where `pose` is the pose of A in B's frame.
    pub(super) fn flipped(&self, pose: &Pose) -> Self {
        let [a, b] = self.points;
        Self {
            points: [pose.transform(b), pose.transform(a)],
            normal: -pose.rotation.rotate(self.normal),
            distance: self.distance,
        }
    }

    /// The same result in an outer frame.
    fn moved(&self, pose: &Pose) -> Self {
        Self {
            points: self.points.map(|point| pose.transform(point)),
            normal: pose.rotation.rotate(self.normal),
            distance: self.distance,
        }
    }

    fn is_finite(&self) -> bool {
        self.points[0].is_finite()
            && self.points[1].is_finite()
            && self.normal.is_finite()
            && self.distance.is_finite()
    }
}

/// The nearest points of shape `a` and shape `b`, where `pose_b_in_a` is the pose of B in A's frame. `None`
/// if they are farther apart than `limit` metres, if a number is not finite, and for foreign shapes.
///
/// For composites it is the nearest part, or if parts overlap the deepest part.
pub fn closest(a: &Shape, b: &Shape, pose_b_in_a: &Pose, limit: f32) -> Option<Closest> {
    let found = of_shapes(a, b, pose_b_in_a, limit)?;
    (found.distance <= limit && found.is_finite()).then_some(found)
}

/// Calls `visit` with the nearest points of each convex part of shape `a` and each convex part of shape `b`
/// that are within `limit` metres, in an order that depends only on the shapes and the pose. Overlapping
/// parts are found as by [`closest`].
pub fn visit_closest(a: &Shape, b: &Shape, pose_b_in_a: &Pose, limit: f32, visit: &mut dyn FnMut(Closest)) {
    match (a, b) {
        (Shape::Composite(composite), b) => {
            visit_parts(composite, b, pose_b_in_a, limit, |_, part, own, at, limit| {
                visit_closest(part, b, at, limit, &mut |found| visit(found.moved(own)));
                limit
            });
        }
        (a, Shape::Composite(_)) => {
            let back = pose_b_in_a.inverse();
            visit_closest(b, a, &back, limit, &mut |found| visit(found.flipped(pose_b_in_a)));
        }
        (a, b) => closest(a, b, pose_b_in_a, limit).into_iter().for_each(visit),
    }
}

/// Whether the shapes touch or overlap.
pub fn overlaps(a: &Shape, b: &Shape, pose_b_in_a: &Pose) -> bool {
    match (a, b) {
        (Shape::Foreign(_), _) | (_, Shape::Foreign(_)) => false,
        (Shape::Composite(a), b) => {
            let mut found = false;
            visit_parts(a, b, pose_b_in_a, 0.0, |_, part, _, at, limit| {
                found |= overlaps(part, b, at);
                if found { -1.0 } else { limit }
            });
            found
        }
        (a, Shape::Composite(_)) => overlaps(b, a, &pose_b_in_a.inverse()),
        (Shape::HalfSpace(_), _) | (_, Shape::HalfSpace(_)) => {
            of_shapes(a, b, pose_b_in_a, 0.0).is_some_and(|found| found.distance <= 0.0)
        }
        (a, b) => {
            let (Some(a), Some(b)) = (Convex::of(a), Convex::of(b)) else { return false };
            let radius = f64::from(a.radius) + f64::from(b.radius);
            cores(&a, &b, pose_b_in_a, 0.0, radius).is_some_and(|cores| cores.distance <= radius)
        }
    }
}

fn of_shapes(a: &Shape, b: &Shape, pose: &Pose, limit: f32) -> Option<Closest> {
    match (a, b) {
        (Shape::Foreign(_), _) | (_, Shape::Foreign(_)) => None,
        (Shape::Composite(a), b) => {
            let mut best: Option<(Closest, u32)> = None;
            visit_parts(a, b, pose, limit, |id, part, own, at, limit| {
                if let Some(found) = closest(part, b, at, limit)
                    && best.is_none_or(|best| (found.distance, id) < (best.0.distance, best.1))
                {
                    best = Some((found.moved(own), id));
                    return max(found.distance, 0.0);
                }
                limit
            });
            best.map(|best| best.0)
        }
        (a, Shape::Composite(_)) => Some(of_shapes(b, a, &pose.inverse(), limit)?.flipped(pose)),
        (Shape::HalfSpace(a), Shape::HalfSpace(b)) => half_spaces(*a, *b, pose),
        (Shape::HalfSpace(a), b) => below(*a, b, pose),
        (a, Shape::HalfSpace(b)) => Some(below(*b, a, &pose.inverse())?.flipped(pose)),
        (a, b) => of_convex(a, b, pose, limit),
    }
}

/// Calls `visit` with the parts of a composite whose boxes may be within a limit of a shape: the part's
/// number, the part, its pose in the composite's frame, the shape's pose in the part's frame, and the current
/// limit. `visit` returns the new limit.
fn visit_parts(
    composite: &Composite<Shape>,
    other: &Shape,
    pose: &Pose,
    limit: f32,
    mut visit: impl FnMut(u32, &Shape, &Pose, &Pose, f32) -> f32,
) {
    let around = other.local_box(pose);
    // Boxes are as exact as their coordinates.
    let slack = 1.0e-6 * (pose.position.abs() + around.half()).max_element();
    let gap = |aabb: &Aabb| {
        let apart = (aabb.min - around.max).max(around.min - aabb.max).max(Vector::ZERO).length();
        if apart > slack { apart - slack } else { 0.0 }
    };
    composite.tree().visit(limit, gap, |id, limit| match composite.part(id) {
        Part::Facet(facet) => visit(id, &Shape::from(facet), &Pose::IDENTITY, pose, limit),
        Part::Solid(own, solid) => visit(id, solid, own, &own.inverse().then(pose), limit),
    });
}

fn cores(a: &Convex, b: &Convex, pose: &Pose, tolerance: f64, beyond: f64) -> Option<Cores> {
    let frame = Frame::from(pose);
    closest_cores(a, b, &frame, frame.position * guess(frame.position), Accuracy { tolerance, beyond })
}

/// The factor that scales a vector to unit length, or zero.
fn guess(v: Vector<f64>) -> f64 {
    let length = v.length();
    if length > 0.0 && length < f64::INFINITY { 1.0 / length } else { 0.0 }
}

fn of_convex(shape_a: &Shape, shape_b: &Shape, pose: &Pose, limit: f32) -> Option<Closest> {
    let (a, b) = (Convex::of(shape_a)?, Convex::of(shape_b)?);
    let radii = [a.radius, b.radius].map(f64::from);
    let cores = cores(&a, &b, pose, 0.0, f64::from(limit) + radii[0] + radii[1])?;
    if cores.distance == 0.0 {
        return overlap(shape_a, shape_b, pose, &cores);
    }
    let points = [cores.a + cores.normal * radii[0], cores.b - cores.normal * radii[1]];
    Some(Closest {
        points: points.map(|point| point.narrow()),
        normal: cores.normal.narrow(),
        distance: (cores.distance - radii[0] - radii[1]) as f32,
    })
}

/// The overlap of shapes with touching cores, along the normal of their manifold, which has the least depth.
fn overlap(a: &Shape, b: &Shape, pose: &Pose, cores: &Cores) -> Option<Closest> {
    let (mut manifold, mut cache) = (LocalManifold::default(), FeatureCache::NONE);
    // Touching cores may be apart by the rounding of the manifold.
    let room = 1.0e-4 * (a.local_box(&Pose::IDENTITY).half() + b.local_box(&Pose::IDENTITY).half()).length();
    manifold::collide(a, b, pose, room, &mut cache, &mut manifold);
    let deepest = manifold.points().iter().reduce(|p, q| if q.separation < p.separation { q } else { p });
    let Some(deepest) = deepest else {
        // Shapes without an inside, such as two crossing segments.
        let toward = pose.position.widen();
        let normal = toward * guess(toward);
        let normal = if normal == Vector::ZERO { Vector::Y } else { normal.narrow() };
        return Some(Closest { points: [cores.a.narrow(), cores.b.narrow()], normal, distance: 0.0 });
    };
    // The manifold's points may leave out the deepest point.
    let normal = manifold.normal;
    let top = a.support(normal)?.dot(normal);
    let bottom = pose.transform(b.support(-pose.rotation.inverse_rotate(normal))?).dot(normal);
    let distance = min(bottom - top, 0.0);
    let half = normal * (0.5 * distance);
    Some(Closest { points: [deepest.point - half, deepest.point + half], normal, distance })
}

/// A half-space and a bounded convex shape.
fn below(plane: HalfSpace, shape: &Shape, pose: &Pose) -> Option<Closest> {
    let convex = Convex::of(shape)?;
    let frame = Frame::from(pose);
    let normal = plane.normal.widen();
    let lowest = convex.farthest(frame.rotation.inverse_rotate(-normal).narrow());
    let lowest = frame.position + frame.rotation.rotate(lowest.widen()) - normal * f64::from(convex.radius);
    let distance = lowest.dot(normal);
    Some(Closest {
        points: [(lowest - normal * distance).narrow(), lowest.narrow()],
        normal: plane.normal,
        distance: distance as f32,
    })
}

/// Half-spaces are apart only if they are opposite.
fn half_spaces(a: HalfSpace, b: HalfSpace, pose: &Pose) -> Option<Closest> {
    let opposite = a.normal + pose.rotation.rotate(b.normal);
    let distance = pose.position.dot(a.normal);
    if !(opposite.length() < 1.0e-6) {
        let points = [pose.position - a.normal * max(distance, 0.0); 2];
        return Some(Closest { points, normal: Vector::ZERO, distance: 0.0 });
    }
    Some(Closest { points: [pose.position - a.normal * distance, pose.position], normal: a.normal, distance })
}
