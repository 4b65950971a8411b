//! Cylinders, cones and frusta against all other shapes.
//!
//! Planes are tested first as separating axes: faces of a polyhedron, and ends of frusta. A plane whose
//! lowest point is in the region where both parts face each other is the best axis, and its region gives up
//! to four points. Otherwise the axis is found by closest points (GJK). Overlapping shapes are first moved
//! apart along the best axis so far, and this is repeated until the axis stays; with little overlap this
//! takes two or three rounds.

mod patch;
mod rim;
mod shape_features;
#[cfg(test)]
mod tests;

use super::axis::Sizes;
use super::clip::keep;
use super::gjk;
use super::round::unit_or;
use super::view::{MatrixPose, View, with_view};
use crate::manifold::{FeatureCache, LocalManifold, PairInput};
use crate::math::{Vector, max};
use crate::shape::{Ball, Curved, Shape};
use crate::tuning::contact::DEEP;
use crate::tuning::manifold::{FACING, KEPT, MARGIN, ROUNDING};
use crate::tuning::sweeps::ROUNDS;
use core::cell::Cell;
use patch::{Phase, Region};
pub use rim::midstep_rims;
use shape_features::ShapeFeatures;

/// [`FeatureCache::kind`] of a plane of A; `a` is the plane, `b` the phase of its circles.
const PLANE_A: u8 = 1;
/// [`FeatureCache::kind`] of an end of B; `a` is the end, `b` the phase of its circles.
const PLANE_B: u8 = 2;
/// [`FeatureCache::kind`] of any other axis, which is in `a` and `b`.
const LINE: u8 = 3;

/// The name of the point of a contact with a single point.
const SINGLE: u32 = 15 << 16;

/// An axis between the shapes.
#[derive(Clone, Copy)]
enum Axis {
    /// A plane of A, by its number.
    PlaneA(usize),
    /// An end of B.
    PlaneB(usize),
    /// Any other axis.
    Line,
}

/// An axis and the distance between the cores along it.
#[derive(Clone, Copy)]
struct Found {
    axis: Axis,
    /// The unit normal from A to B.
    normal: Vector,
    separation: f32,
    /// The nearest points of the cores, if they are known.
    nearest: Option<[Vector; 2]>,
}

/// Two shapes and their relative pose.
struct Pair<'a, A> {
    a: &'a A,
    b: &'a Curved,
    b_in_a: MatrixPose,
    cache: &'a Cell<FeatureCache>,
    sizes: Sizes,
}

/// The contact of a shape with a polyhedral core and a frustum. Not inlined, since its stack frame is large.
#[inline(never)]
pub(super) fn with_polyhedron(a: &Shape, b: &Curved, input: PairInput, out: &mut LocalManifold) {
    with_view(a, |a| a.map(|a| collide(a, b, input, out)));
}

/// The contact of two frusta. Not inlined, since its stack frame is large.
#[inline(never)]
pub(super) fn frusta(a: &Curved, b: &Curved, input: PairInput, out: &mut LocalManifold) {
    collide(&a.with_equal_discs(), b, input, out);
}

fn collide<A: ShapeFeatures>(a: &A, b: &Curved, input: PairInput, out: &mut LocalManifold) {
    let b = &b.with_equal_discs();
    let pair = Pair::new(a, b, input);
    if !pair.try_cached(out) {
        pair.search(out);
    }
}

/// The contact of a polyhedron's face with the given normal and a frustum: the frustum's points over the
/// face, if any.
pub(super) fn collide_face(a: &View, normal: Vector, b: &Curved, input: PairInput, out: &mut LocalManifold) {
    let Some(face) = (0..a.faces.len()).find(|i| a.faces[*i].normal.dot(normal) > FACING) else { return };
    let b = &b.with_equal_discs();
    let pair = Pair::new(a, b, input);
    let found = pair.plane_a(face);
    if found.separation > pair.sizes.limit() {
        out.gap = found.separation - a.radius;
        return;
    }
    pair.build_plane(&found, &mut 0, out);
    // A shape deep under a face need not be over it.
    if out.count == 0 && found.separation < -DEEP * pair.sizes.smaller {
        pair.search(out);
    }
}

/// The contact of a half-space with the given normal and a frustum.
pub(super) fn half_space(normal: Vector, b: &Curved, input: PairInput, out: &mut LocalManifold) {
    let (b, frame) = (&b.with_equal_discs(), MatrixPose::new(input.pose));
    let down = -frame.direction_in(normal);
    out.normal = normal;
    out.gap = normal.dot(frame.point(b.support(down)));
    if !(out.gap <= input.prediction) {
        return;
    }
    let known = input.cache.get();
    let phase = if known.kind == PLANE_A { known.b } else { 0 };
    let mut region = Region::new(normal, 0.0, input.prediction, b.extent(Vector::ZERO), phase);
    region.fill_plane(&b.facing(down).moved(&frame));
    input.cache.set(FeatureCache { kind: PLANE_A, a: 0, b: region.phase, separation: out.gap });
    take(&region, out);
    out.radii = [0.0, b.rolling(down)];
}

/// The contact of a frustum and a ball.
pub(super) fn ball(a: &Curved, &Ball { radius }: &Ball, input: PairInput, out: &mut LocalManifold) {
    let (a, center) = (&a.with_equal_discs(), input.pose.position);
    let nearest = a.nearest(center);
    let separation = nearest.distance - radius;
    if !(separation <= input.prediction) {
        out.gap = separation;
        return;
    }
    out.normal = nearest.normal;
    let point = center - nearest.normal * (0.5 * (nearest.distance + radius));
    out.push(point, separation, 0);
    let own = if nearest.on_side { a.rolling(nearest.normal) } else { 0.0 };
    out.radii = [own, radius];
}

/// Stores at most four points of a region.
fn take(region: &Region, out: &mut LocalManifold) {
    out.normal = region.normal;
    keep::<false>(region.candidates.as_slice(), out);
}

impl<'a, A: ShapeFeatures> Pair<'a, A> {
    fn new(a: &'a A, b: &'a Curved, input: PairInput<'a>) -> Self {
        let PairInput { pose, prediction, cache } = input;
        let sizes = Sizes::new(prediction, a.radius(), [a.extent(), b.extent(Vector::ZERO)]);
        Self { a, b, b_in_a: MatrixPose::new(pose), cache, sizes }
    }

    /// The distance between the cores along a unit normal.
    fn separation(&self, normal: Vector) -> f32 {
        let b = self.b.support(-self.b_in_a.direction_in(normal));
        normal.dot(self.b_in_a.point(b)) - normal.dot(self.a.farthest_point(normal).0)
    }

    fn plane_a(&self, plane: usize) -> Found {
        let (normal, offset) = self.a.plane(plane);
        let b = self.b.support(-self.b_in_a.direction_in(normal));
        let separation = normal.dot(self.b_in_a.point(b)) - offset;
        Found { axis: Axis::PlaneA(plane), normal, separation, nearest: None }
    }

    fn plane_b(&self, end: usize) -> Found {
        let outward = self.b_in_a.axes[1] * if end == 0 { -1.0 } else { 1.0 };
        let a = self.a.farthest_point(-outward).0;
        let separation = outward.dot(a - self.b_in_a.position) - self.b.half_height;
        Found { axis: Axis::PlaneB(end), normal: -outward, separation, nearest: None }
    }

    fn line(&self, normal: Vector, nearest: Option<[Vector; 2]>) -> Found {
        Found { axis: Axis::Line, normal, separation: self.separation(normal), nearest }
    }

    /// Whether the cached axis decides the contact.
    fn try_cached(&self, out: &mut LocalManifold) -> bool {
        let cache = self.cache.get();
        let index = usize::from(cache.a);
        let found = match cache.kind {
            PLANE_A if index < self.a.planes() => self.plane_a(index),
            PLANE_B if index < 2 => self.plane_b(index),
            LINE => self.line(normal_of(cache), None),
            _ => return false,
        };
        if found.separation > self.sizes.limit() {
            out.gap = found.separation - self.sizes.radius;
            return true;
        }
        if matches!(found.axis, Axis::Line)
            || !((found.separation - cache.separation).abs() < KEPT * self.sizes.smaller)
        {
            return false;
        }
        let mut phase = cache.b;
        let is_best = self.build_plane(&found, &mut phase, out) && self.is_best(&found, self.middle(out));
        if is_best {
            self.cache.set(FeatureCache { b: phase, ..cache });
        }
        is_best
    }

    /// Finds the axis and fills the manifold.
    fn search(&self, out: &mut LocalManifold) {
        let known = self.cache.get();
        let phase = if known.kind == PLANE_A || known.kind == PLANE_B { known.b } else { 0 };
        let preference = 2.0 * MARGIN * self.sizes.smaller;
        let mut best = self.plane_b(0);
        let mut consider = |found: Found, bonus: f32| {
            if found.separation + bonus > best.separation {
                best = found;
            }
        };
        consider(self.plane_b(1), 0.0);
        (0..self.a.planes()).for_each(|plane| consider(self.plane_a(plane), 0.1 * preference));
        if best.separation > self.sizes.limit() {
            self.remember(&best, phase);
            out.gap = best.separation - self.sizes.radius;
            return;
        }
        let plane = best;
        let mut start = plane;
        let lines = [self.across_axes(), (known.kind == LINE).then(|| normal_of(known))];
        for (i, normal) in lines.into_iter().enumerate() {
            let Some(normal) = normal else { continue };
            let line = self.line(normal, None);
            if line.separation <= max(start.separation, plane.separation + preference) {
                continue;
            }
            start = line;
            if line.separation > self.sizes.limit() {
                return self.finish_line(&line, out);
            }
            // The cached axis is rounded.
            if i == 0 && self.build_line(&line, out) && self.is_best(&line, self.middle(out)) {
                self.remember(&line, 0);
                return;
            }
        }
        let mut turned: Phase = phase;
        let is_exact = self.build_plane(&plane, &mut turned, out);
        let is_start = matches!(start.axis, Axis::PlaneA(_) | Axis::PlaneB(_));
        if is_exact && is_start && self.is_best(&plane, self.middle(out)) {
            return self.remember(&plane, turned);
        }
        let refined = self.refine_all(&start);
        let is_better = refined.separation > plane.separation + preference;
        if out.count > 0 && plane.separation <= self.sizes.resolution() && !is_better {
            if !is_exact {
                refined.nearest.iter().for_each(|ends| self.push_single(&refined, *ends, out));
            }
            return self.remember(&plane, turned);
        }
        self.finish_line(&refined, out);
    }

    /// Adds the point between two points of the cores, in place of the last point of a full manifold.
    fn push_single(&self, line: &Found, [a, b]: [Vector; 2], out: &mut LocalManifold) {
        let separation = line.separation - self.sizes.radius;
        if separation <= self.sizes.prediction {
            out.count = out.count.min(out.points.len() - 1);
            out.push((a + b + out.normal * self.sizes.radius) * 0.5, separation, SINGLE);
        }
    }

    /// Fills the manifold along an axis that is no plane.
    fn finish_line(&self, line: &Found, out: &mut LocalManifold) {
        self.remember(line, 0);
        out.count = 0;
        if !(line.separation <= self.sizes.limit()) {
            out.gap = max(line.separation - self.sizes.radius, 0.0);
            return;
        }
        self.build_line(line, out);
    }

    /// The cache for the next step.
    fn remember(&self, found: &Found, phase: Phase) {
        let (kind, a, b) = match found.axis {
            Axis::PlaneA(plane) => (PLANE_A, plane, phase),
            Axis::PlaneB(end) => (PLANE_B, end, phase),
            Axis::Line => {
                let [a, b] = bytes_of(found.normal);
                (LINE, usize::from(a), b)
            }
        };
        self.cache.set(match u8::try_from(a) {
            Ok(a) => FeatureCache { kind, a, b, separation: found.separation },
            Err(_) => FeatureCache::NONE,
        });
    }

    /// Fills the manifold from a plane. Returns whether its nearest point is as near as the plane.
    fn build_plane(&self, found: &Found, phase: &mut Phase, out: &mut LocalManifold) -> bool {
        let n = found.normal;
        let mut region = self.region(found, *phase);
        match found.axis {
            Axis::PlaneA(plane) => {
                let down = -self.b_in_a.direction_in(n);
                region.fill(&self.a.part(plane), &self.b.facing(down).moved(&self.b_in_a));
            }
            Axis::PlaneB(end) => {
                region.fill(&self.a.facing(n), &self.b.part(end).moved(&self.b_in_a));
            }
            Axis::Line => return false,
        }
        *phase = region.phase;
        take(&region, out);
        self.set_radii(out);
        region.least <= found.separation + MARGIN * self.sizes.smaller
    }

    fn region(&self, found: &Found, phase: Phase) -> Region {
        let mut region =
            Region::new(found.normal, self.sizes.radius, self.sizes.prediction, self.sizes.smaller, phase);
        region.deepest = found.separation - MARGIN * self.sizes.smaller;
        region
    }

    fn set_radii(&self, out: &mut LocalManifold) {
        let n = out.normal;
        let down = -self.b_in_a.direction_in(n);
        out.radii = [self.a.rolling(n), self.b.rolling(down)];
    }

    /// Fills the manifold from an axis that is no plane: the points of two lines side by side, or one point.
    /// Returns whether the points are as near as the separation along the axis.
    fn build_line(&self, found: &Found, out: &mut LocalManifold) -> bool {
        let n = found.normal;
        let mut region = self.region(found, 0);
        let down = -self.b_in_a.direction_in(n);
        let line_b = self.b.line_along(down).map(|ends| ends.map(|p| self.b_in_a.point(p)));
        let bar = found.separation + MARGIN * self.sizes.smaller;
        if let (Some(a), Some(b)) = (self.a.line_along(n), line_b)
            && region.parallel_lines(&a, &b)
            && region.least <= bar
        {
            take(&region, out);
            self.set_radii(out);
            return true;
        }
        let (ends, is_exact) = match (found.nearest, self.a.line_along(n), line_b) {
            (Some(nearest), ..) => (nearest, true),
            (None, Some(a), Some(b)) => {
                let (p, q, inside) = super::convex::closest_of_lines(a, b);
                let aside = (q - p - n * found.separation).length();
                ([p, q], inside && aside <= MARGIN * self.sizes.smaller)
            }
            _ => {
                let (a, b) = (self.a.farthest_point(n).0, self.b_in_a.point(self.b.support(down)));
                ([a, b], (b - a - n * found.separation).length() <= MARGIN * self.sizes.smaller)
            }
        };
        (out.normal, out.count) = (n, 0);
        self.push_single(found, ends, out);
        self.set_radii(out);
        is_exact
    }

    /// The direction between the axes of two cylinders, capsules or segments, across both.
    fn across_axes(&self) -> Option<Vector> {
        let a = self.a.axis()?;
        if self.b.lower != self.b.upper {
            return None;
        }
        let end = self.b_in_a.axes[1] * self.b.half_height;
        let b = [self.b_in_a.position - end, self.b_in_a.position + end];
        let (u, v) = (a[1] - a[0], b[1] - b[0]);
        let between = (b[0] + b[1] - a[0] - a[1]) * 0.5;
        let across = u.cross(v);
        let (uu, vv) = (u.length_squared(), v.length_squared());
        let normal = if across.length_squared() > 1.0e-4 * uu * vv {
            unit_or(across, Vector::Y)
        } else {
            let along = if uu > vv { u * (1.0 / uu) } else { v * (1.0 / max(vv, f32::MIN_POSITIVE)) };
            let along = along * max(uu, vv);
            let off = between - along * (along.dot(between) / max(along.length_squared(), f32::MIN_POSITIVE));
            if !(off.length_squared() > 1.0e-6 * self.sizes.smaller * self.sizes.smaller) {
                return None;
            }
            unit_or(off, Vector::Y)
        };
        Some(if normal.dot(between) < 0.0 { -normal } else { normal })
    }

    /// The middle of a manifold's points, on A's core and on B's core.
    fn middle(&self, out: &LocalManifold) -> Option<[Vector; 2]> {
        if out.count == 0 {
            return None;
        }
        let to_a = |separation: f32| out.normal * (0.5 * separation + self.sizes.radius);
        let ends = out.points().iter().fold([Vector::ZERO; 2], |[a, b], p| {
            [a + p.point - to_a(p.separation), b + p.point + out.normal * (0.5 * p.separation)]
        });
        Some(ends.map(|sum| sum * (1.0 / out.count as f32)))
    }

    /// Whether no axis is clearly less deep, tested with a point of each core. If a ball about a point of B
    /// lies within A, all axes are at least as deep as its radius; the same holds for a point of A within B.
    fn is_best(&self, found: &Found, points: Option<[Vector; 2]>) -> bool {
        let sure = found.separation + KEPT * self.sizes.smaller;
        sure >= 0.0
            || points.is_some_and(|[on_a, on_b]| {
                let on_a = self.b_in_a.direction_in(on_a - self.b_in_a.position);
                max(self.a.depth_of(on_b), -self.b.nearest(on_a).distance) >= -sure
            })
    }

    /// Whether the point of one core that is farthest along an axis lies within the other core. Then they
    /// overlap, and no distance query is needed.
    fn surely_overlaps(&self, along: &Found) -> bool {
        if !(along.separation < 0.0) {
            return false;
        }
        let of_b = self.b.support(-self.b_in_a.direction_in(along.normal));
        let is_in_b = || {
            let of_a = self.a.farthest_point(along.normal).0;
            self.b.nearest(self.b_in_a.direction_in(of_a - self.b_in_a.position)).distance < 0.0
        };
        self.a.depth_of(self.b_in_a.point(of_b)) > 0.0 || is_in_b()
    }

    /// The axis that separates the cores best. Where cores overlap, several axes may be local optima.
    fn refine_all(&self, start: &Found) -> Found {
        let near = self.refine(start);
        if self.is_best(&near, near.nearest) {
            return near;
        }
        let Some(normal) = gjk::shallowest(self.a, self.b, &self.b_in_a) else { return near };
        let all = self.refine(&self.line(normal, None));
        if all.separation > near.separation { all } else { near }
    }

    /// The axis near a given axis that separates the cores best.
    fn refine(&self, start: &Found) -> Found {
        let apart = DEEP * self.sizes.smaller;
        if !self.surely_overlaps(start)
            && let Some(c) =
                gjk::closest_within(self.a, self.b, &self.b_in_a, start.normal, self.sizes.limit())
            && c.distance > self.sizes.resolution()
        {
            return self.line(c.normal, Some([c.a, c.b]));
        }
        let mut best = Found { axis: Axis::Line, ..*start };
        let mut normal = start.normal;
        let mut separation = start.separation;
        for _ in 0..ROUNDS {
            let push = max(apart - separation, 0.0);
            let mut frame = self.b_in_a;
            frame.position += normal * push;
            let Some(closest) = gjk::closest_within(self.a, self.b, &frame, normal, f32::INFINITY) else {
                break;
            };
            let found = self.line(closest.normal, Some([closest.a, closest.b - normal * push]));
            let gain = found.separation - best.separation;
            // Moved along another direction, the nearest points are not opposite each other.
            let aside = (closest.normal - normal).length() * push;
            if gain >= -ROUNDING * self.sizes.smaller {
                best = found;
            } else if best.nearest.is_none() {
                best.nearest = found.nearest;
            }
            if !(gain > ROUNDING * self.sizes.smaller
                || gain >= -ROUNDING * self.sizes.smaller && aside > MARGIN * self.sizes.smaller)
            {
                break;
            }
            (normal, separation) = (found.normal, found.separation);
        }
        best
    }
}

/// A direction in two bytes: its position on an octahedron unfolded to a square.
fn bytes_of(normal: Vector) -> [u8; 2] {
    let size = normal.x.abs() + normal.y.abs() + normal.z.abs();
    let (x, y) = (normal.x / size, normal.y / size);
    let fold = |own: f32, other: f32| if own < 0.0 { other.abs() - 1.0 } else { 1.0 - other.abs() };
    let (x, y) = if normal.z < 0.0 { (fold(x, y), fold(y, x)) } else { (x, y) };
    [x, y].map(|c| ((c * 127.0).round() + 127.0) as u8)
}

/// The direction in the bytes of a cache.
fn normal_of(cache: FeatureCache) -> Vector {
    let [x, y] = [cache.a, cache.b].map(|c| (f32::from(c) - 127.0) / 127.0);
    let z = 1.0 - x.abs() - y.abs();
    let fold = |own: f32, other: f32| if own < 0.0 { other.abs() - 1.0 } else { 1.0 - other.abs() };
    let (x, y) = if z < 0.0 { (fold(x, y), fold(y, x)) } else { (x, y) };
    unit_or(Vector { x, y, z }, Vector::Y)
}
