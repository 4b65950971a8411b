//! The contact region of two plane parts of surfaces that face each other, at least one of them round.
//!
//! Circles are exact: the corners of a region are corners of one part inside the other, crossings of a side
//! and a circle, and four points of a circle, a quarter turn apart. Each point is named after its features. A
//! full circle stands on four points that keep their positions in the other shape's frame, so that no point
//! moves while a cylinder turns.

use super::super::clip::{Candidates, MAX_CANDIDATES, clip_line};
use super::super::round::Lines;
use super::super::view::MatrixPose;
use crate::manifold::LocalPoint;
use crate::math::{Vector, atan2, min, sin_cos};
use crate::tuning::manifold::{ALIKE, CROSSED, MARGIN, SIDEWAYS};
use core::f64::consts::TAU;

/// A part of a surface, in A's frame.
pub(super) enum Patch<'a> {
    /// The end of a frustum.
    Disc(Disc),
    /// A polygon.
    Face(Face<'a>),
    /// A line, or a point with both ends in one place.
    Line([Vector; 2]),
}

impl Patch<'_> {
    /// A part of a frustum in the outer frame. Polygons stay: only A has them.
    pub fn moved(self, frame: &MatrixPose) -> Self {
        match self {
            Patch::Disc(disc) => Patch::Disc(Disc {
                center: frame.point(disc.center),
                normal: frame.direction(disc.normal),
                radius: disc.radius,
                hint: frame.direction(disc.hint),
            }),
            Patch::Line(ends) => Patch::Line(ends.map(|p| frame.point(p))),
            Patch::Face(_) => self,
        }
    }
}

/// A circle with its interior.
#[derive(Clone, Copy)]
pub(super) struct Disc {
    pub center: Vector,
    /// Out of the solid.
    pub normal: Vector,
    pub radius: f32,
    /// A direction across the normal that turns with the shape.
    pub hint: Vector,
}

/// A convex polygon, counter-clockwise around its normal.
#[derive(Clone, Copy)]
pub(super) struct Face<'a> {
    pub vertices: &'a [Vector],
    pub outline: &'a [u32],
    pub normal: Vector,
    pub offset: f32,
}

/// The angle of the four points of a circle, kept from step to step: 0 if unknown, otherwise 1 plus the
/// number of 255ths of a turn.
pub(super) type Phase = u8;

/// The names of points; a number of up to 16 bits is added.
const CORNER: u32 = 1 << 16;
const ENTRY: u32 = 2 << 16;
const EXIT: u32 = 3 << 16;
const OF_A: u32 = 4 << 16;
const OF_B: u32 = 5 << 16;
const END: u32 = 6 << 16;
const CUT: u32 = 7 << 16;
const CROSSING: u32 = 8 << 16;

/// Polygons with more corners are thinned to every second, third, … corner.
const MAX_CORNERS: usize = 32;

/// The region under construction.
pub(super) struct Region {
    /// The unit normal from A to B, in A's frame.
    pub normal: Vector,
    /// The radius around A's core.
    pub radius: f32,
    pub prediction: f32,
    /// The extent of the smaller shape.
    pub extent: f32,
    pub phase: Phase,
    pub candidates: Candidates<MAX_CANDIDATES>,
    /// The least separation of the cores, of all points.
    pub least: f32,
    /// Points deeper than this lie beyond the overlap, and are dropped.
    pub deepest: f32,
}

impl Region {
    pub fn new(normal: Vector, radius: f32, prediction: f32, extent: f32, phase: Phase) -> Self {
        let (candidates, least, deepest) = (Candidates::new(), f32::INFINITY, f32::NEG_INFINITY);
        Self { normal, radius, prediction, extent, phase, candidates, least, deepest }
    }

    /// Adds a point by its place on A and the distance from there to B along the normal.
    #[inline]
    fn push(&mut self, on_a: Vector, gap: f32, feature: u32) {
        if gap < self.deepest {
            return;
        }
        self.least = min(self.least, gap);
        let separation = gap - self.radius;
        if separation <= self.prediction {
            let point = on_a + self.normal * (0.5 * (gap + self.radius));
            self.candidates.push(LocalPoint::new(point, separation, feature));
        }
    }

    fn margin(&self) -> f32 {
        MARGIN * self.extent
    }

    /// Adds the points of a pair of parts.
    pub fn fill(&mut self, a: &Patch, b: &Patch) {
        match (a, b) {
            (Patch::Disc(a), Patch::Disc(b)) => self.discs(a, b),
            (Patch::Disc(a), Patch::Face(b)) => self.disc_and_face(a, true, b),
            (Patch::Face(a), Patch::Disc(b)) => self.disc_and_face(b, false, a),
            (Patch::Disc(a), Patch::Line(b)) => self.disc_and_corners(a, true, b, 2),
            (Patch::Line(a), Patch::Disc(b)) => self.disc_and_corners(b, false, a, 2),
            (Patch::Face(a), Patch::Line(b)) => self.face_and_line(a, b),
            // B is never a polygon, and two lines have no plane between them.
            (Patch::Line(_) | Patch::Face(_), Patch::Face(_)) | (Patch::Line(_), Patch::Line(_)) => {}
        }
    }

    /// The points of a part over a plane, where the plane is A.
    pub fn fill_plane(&mut self, b: &Patch) {
        let normal = self.normal;
        match b {
            Patch::Disc(disc) => {
                for (i, point) in self.quarters(disc, normal.any_orthonormal(), normal, false) {
                    let gap = normal.dot(point);
                    self.push(point - normal * gap, gap, OF_B | i);
                }
            }
            Patch::Line(ends) => {
                for (i, point) in (0..).zip(ends) {
                    let gap = normal.dot(*point);
                    self.push(*point - normal * gap, gap, END | i);
                }
            }
            Patch::Face(_) => {}
        }
    }

    /// The four points of a circle over a plane with a normal across it, with their numbers. One of them is
    /// at or close to the point nearest to the plane. Angles count from `hint`. `of_a` tells that the circle
    /// is A's.
    fn quarters(&mut self, disc: &Disc, hint: Vector, plane: Vector, of_a: bool) -> [(u32, Vector); 4] {
        let (u, v) = disc.frame(hint);
        // The distance to the plane along the normal falls this way.
        let sign = if (plane.dot(self.normal) > 0.0) == of_a { 1.0 } else { -1.0 };
        let fall = [u.dot(plane) * sign, v.dot(plane) * sign];
        let tilt = (fall[0] * fall[0] + fall[1] * fall[1]).sqrt();
        let known = f64::from(self.phase.max(1) - 1) * (TAU / 255.0);
        let (sin, cos) = sin_cos(known);
        let mut spoke = [cos as f32, sin as f32];
        if tilt > 1.0e-6 {
            let lowest = fall.map(|f| f / tilt);
            let spokes = quarter_turns(spoke);
            let cosine = |s: [f32; 2]| s[0] * lowest[0] + s[1] * lowest[1];
            let mut nearest = 0;
            for i in 1..4 {
                nearest = if cosine(spokes[i]) > cosine(spokes[nearest]) { i } else { nearest };
            }
            let above = tilt * disc.radius * (1.0 - cosine(spokes[nearest]));
            if tilt > SIDEWAYS || above > 2.0 * ALIKE * min(disc.radius, self.extent) {
                spoke = quarter_turns(lowest)[(4 - nearest) % 4];
            }
        }
        let angle = atan2(f64::from(spoke[1]), f64::from(spoke[0])).rem_euclid(TAU);
        self.phase = 1 + ((angle * (255.0 / TAU)).round() as u32 % 255) as u8;
        let spokes = quarter_turns(spoke);
        let r = disc.radius;
        let point = |i: usize| disc.center + (u * spokes[i][0] + v * spokes[i][1]) * r;
        core::array::from_fn(|i| (i as u32, point(i)))
    }

    /// A circle and a polygon.
    fn disc_and_face(&mut self, disc: &Disc, of_a: bool, face: &Face) {
        let mut corners = [Vector::ZERO; MAX_CORNERS];
        let stride = face.outline.len().div_ceil(MAX_CORNERS).max(1);
        let mut count = 0;
        for i in face.outline.iter().step_by(stride) {
            corners[count] = face.vertices[*i as usize];
            count += 1;
        }
        let corners = &corners[..count];
        let (hint, margin) = (corners[1 % count] - corners[0], self.margin());
        let under = |point: Vector| face.offset - face.normal.dot(point);
        let contains = |foot: Vector| face.contains(corners, foot, margin);
        let inside = self.circle_over(disc, hint, of_a, face.normal, under, contains);
        // With all four points inside there may be sides that cut the circle between them, but not deeply.
        if inside < 4 {
            self.disc_and_corners(disc, of_a, corners, if count > 2 { count } else { count - 1 });
        }
    }

    /// The corners of an outline inside of a circle, and the crossings of the first `sides` sides with it.
    fn disc_and_corners(&mut self, disc: &Disc, of_a: bool, corners: &[Vector], sides: usize) {
        let (n, w) = (self.normal, disc.normal);
        let rise = n.dot(w);
        let reach = disc.radius + self.margin();
        // The projection of a corner onto the disc's plane along the normal, and the distance there.
        let over = |p: Vector| {
            let height = (disc.center - p).dot(w) / rise;
            (p + n * height - disc.center, height)
        };
        let mut add = |place: Vector, height: f32, name: u32| {
            let on_disc = disc.center + place;
            if of_a {
                self.push(on_disc, -height, name);
            } else {
                self.push(on_disc - n * height, height, name);
            }
        };
        let sides = if corners.len() == 2 { 1 } else { sides };
        for (i, corner) in corners.iter().enumerate() {
            let (p, height) = over(*corner);
            if p.length_squared() <= reach * reach {
                add(p, height, CORNER | i as u32);
            }
            if i >= sides {
                continue;
            }
            let (q, end) = over(corners[(i + 1) % corners.len()]);
            let d = q - p;
            let (a, b) = (d.length_squared(), p.dot(d));
            let c = p.length_squared() - disc.radius * disc.radius;
            let square = b * b - a * c;
            if !(square > 0.0 && a > 0.0) {
                continue;
            }
            let root = square.sqrt();
            for (t, name) in [((-b - root) / a, ENTRY), ((-b + root) / a, EXIT)] {
                if t > 0.0 && t < 1.0 {
                    add(p + d * t, height + (end - height) * t, name | i as u32);
                }
            }
        }
    }

    /// A polygon and a line over it.
    fn face_and_line(&mut self, face: &Face, ends: &[Vector; 2]) {
        let outline = face.outline.iter().map(|i| face.vertices[*i as usize]);
        let Some(range) = clip_line(face.normal, outline, *ends, self.margin()) else { return };
        for (i, (t, side)) in (0..).zip(range) {
            let name = side.map_or(END | i, |side| CUT | side);
            let point = ends[0] + (ends[1] - ends[0]) * t;
            let gap = face.normal.dot(point) - face.offset;
            self.push(point - face.normal * gap, gap, name);
        }
    }

    /// Two circles.
    fn discs(&mut self, a: &Disc, b: &Disc) {
        // The points of the smaller circle if the other circle contains them all, otherwise the points of
        // both and their crossings.
        let a_first = a.radius <= b.radius;
        let first = self.circle_in_disc(a, b, a_first);
        if first == 4 {
            return;
        }
        self.circle_in_disc(a, b, !a_first);
        if a.normal.cross(b.normal).length_squared() < CROSSED * CROSSED {
            self.crossings(a, b);
        }
    }

    /// Adds the points of one circle, A's if `of_a`, that are over the other circle, and returns their
    /// number.
    fn circle_in_disc(&mut self, a: &Disc, b: &Disc, of_a: bool) -> usize {
        let (own, other) = if of_a { (a, b) } else { (b, a) };
        let reach = other.radius + self.margin();
        let under = |point: Vector| (other.center - point).dot(other.normal);
        let contains = |foot: Vector| (foot - other.center).length_squared() <= reach * reach;
        self.circle_over(own, a.hint, of_a, other.normal, under, contains)
    }

    /// Adds the points of a circle, A's if `of_a`, that are over a part of a plane, and returns their
    /// number. `under` gives the depth of a point under the plane, `contains` tells whether a point of the
    /// plane is in the part.
    fn circle_over(
        &mut self,
        disc: &Disc,
        hint: Vector,
        of_a: bool,
        plane: Vector,
        under: impl Fn(Vector) -> f32,
        contains: impl Fn(Vector) -> bool,
    ) -> usize {
        let rise = plane.dot(self.normal);
        let mut inside = 0;
        for (i, point) in self.quarters(disc, hint, plane, of_a) {
            let gap = under(point) / rise;
            let foot = point + self.normal * gap;
            if contains(foot) {
                inside += 1;
                let (on_a, gap) = if of_a { (point, gap) } else { (foot, -gap) };
                self.push(on_a, gap, if of_a { OF_A } else { OF_B } | i);
            }
        }
        inside
    }

    /// Adds the points where two circles cross, as seen along the normal.
    fn crossings(&mut self, a: &Disc, b: &Disc) {
        let n = self.normal;
        let offset = b.center - a.center;
        let offset = offset - n * n.dot(offset);
        let square = offset.length_squared();
        let along = 0.5 * (1.0 + (a.radius * a.radius - b.radius * b.radius) / square);
        let half = a.radius * a.radius - along * along * square;
        if !(square > 0.0 && half > 0.0) {
            return;
        }
        let across = n.cross(offset) * (half / square).sqrt();
        for (i, side) in [(0, -1.0), (1, 1.0)] {
            let place = a.center + offset * along + across * side;
            let on_a = place + n * ((a.center - place).dot(a.normal) / a.normal.dot(n));
            let on_b = place + n * ((b.center - place).dot(b.normal) / b.normal.dot(n));
            self.push(on_a, n.dot(on_b - on_a), CROSSING | i);
        }
    }

    /// Adds the points of two lines across the normal: the ends of the range in which they run side by side.
    /// `false` if they do not.
    pub fn parallel_lines(&mut self, a: &[Vector; 2], b: &[Vector; 2]) -> bool {
        let lines = Lines::new(a[0], a[1] - a[0], *b, b[1] - b[0]);
        let Lines { u, v, uu, vv, .. } = lines;
        if !(uu > 0.0 && vv > 0.0 && u.cross(v).length_squared() <= SIDEWAYS * SIDEWAYS * uu * vv) {
            return false;
        }
        let Some(range) = lines.shared() else { return false };
        let across = self.normal.cross(u) * (1.0 / uu.sqrt());
        let pairs = range.map(|t| lines.at(t));
        // Lines that pass each other are nearest along another normal.
        let aside = pairs.map(|[on_a, on_b]| across.dot(on_b - on_a));
        if aside[0] * aside[1] > 0.0 && min(aside[0].abs(), aside[1].abs()) > 2.0 * self.margin() {
            return false;
        }
        for (i, [on_a, on_b]) in (0..).zip(pairs) {
            self.push(on_a, self.normal.dot(on_b - on_a), END | i);
        }
        true
    }
}

/// A direction of the plane, and the same direction turned by one, two and three quarters.
fn quarter_turns([x, y]: [f32; 2]) -> [[f32; 2]; 4] {
    [[x, y], [-y, x], [-x, -y], [y, -x]]
}

impl Disc {
    /// Two unit directions in the plane, the first as near as can be to `hint`.
    fn frame(&self, hint: Vector) -> (Vector, Vector) {
        let w = self.normal;
        let flat = hint - w * w.dot(hint);
        let length = flat.length();
        let u = if length > 1.0e-3 * hint.length() && length > 1.0e-30 {
            flat * (1.0 / length)
        } else {
            w.any_orthonormal()
        };
        (u, w.cross(u))
    }
}

impl Face<'_> {
    /// Whether a point of the plane is inside of all sides, or no farther outside than `margin`.
    fn contains(&self, corners: &[Vector], point: Vector, margin: f32) -> bool {
        let mut tail = corners[corners.len() - 1];
        corners.iter().all(|head| {
            let outward = (*head - tail).cross(self.normal);
            let is_inside = outward.dot(point - tail) <= margin * outward.length();
            tail = *head;
            is_inside
        })
    }
}
