//! The points of a face contact: the part of an incident face that lies over a reference face (Sutherland and
//! Hodgman, "Reentrant Polygon Clipping", 1974), with a feature id for each corner, reduced to at most four
//! points.

use super::axis::FaceAxis;
use super::view::{MatrixPose, View};
use crate::manifold::{LocalManifold, LocalPoint};
use crate::math::{F32x4, Lane, Num, Vector, max, min};
use crate::shape::Face;
use crate::tuning::manifold::{ABOUT_EQUAL, FLAT, HIGH, IN_THE_AIR, MARGIN};

/// Clipped polygons have fewer corners than this. A cut adds at most one per side.
pub(super) const MAX_CORNERS: usize = 65;
/// Capacity for nearly all polygons; smaller buffers take less time to clear.
pub(super) const FEW_CORNERS: usize = 17;
/// Capacity where a triangle clips a face with up to four corners.
pub(super) const LEAST_CORNERS: usize = 8;
/// Incident faces with more vertices are thinned to every second, fourth, … vertex.
const MAX_INCIDENT: usize = 32;
/// Tags an edge that lies on a side of the reference face.
const ON_SIDE: u32 = 0x200;

/// Data of a corner besides its position, interpolated between corners.
pub(super) trait Carried: Copy + Default {
    /// The value interpolated to another by a share.
    fn between(self, other: Self, share: f32) -> Self;
}

impl Carried for () {
    #[inline(always)]
    fn between(self, _: Self, _: f32) {}
}

impl Carried for F32x4 {
    #[inline(always)]
    fn between(self, other: Self, share: f32) -> Self {
        self + (other - self) * Self::splat(share)
    }
}

/// A corner of the clipped polygon, in the frame of the reference polyhedron.
#[derive(Clone, Copy, Default)]
pub(super) struct Corner<H = ()> {
    pub point: Vector,
    /// Ten bits for the edge, ten for the side that cut it (plus 1), or for the vertex and 0.
    pub name: u32,
    pub heights: H,
    /// The edge from here to the next corner.
    edge: u32,
}

/// A clipped polygon of fewer than `N` corners on the stack.
pub(super) struct Polygon<const N: usize, H = ()> {
    /// The last place receives unwanted corners and corners beyond the capacity.
    corners: [Corner<H>; N],
    count: usize,
}

impl<const N: usize, H: Carried> Polygon<N, H> {
    #[inline(always)]
    pub fn new() -> Self {
        Self { corners: [Corner::default(); N], count: 0 }
    }

    #[inline(always)]
    pub fn corners(&self) -> &[Corner<H>] {
        &self.corners[..self.count]
    }

    /// Adds corner `number` of an incident face, and the edge that begins there.
    #[inline(always)]
    pub fn push(&mut self, number: u32, point: Vector, heights: H) {
        let number = number & 0x1ff;
        self.push_if(true, Corner { point, name: number << 10, heights, edge: number });
    }

    /// Writes a corner and counts it if `wanted`, without a branch.
    #[inline(always)]
    fn push_if(&mut self, wanted: bool, corner: Corner<H>) {
        self.corners[self.count] = corner;
        self.count += usize::from(wanted & (self.count < N - 1));
    }
}

/// The face of `incident` most opposite to a direction in its own frame, among the faces around the vertex
/// `deepest` along it; `None` if it has no faces. A face elsewhere may be more opposite: the base of a cone
/// that stands on its tip.
pub(super) fn incident_face(incident: &View, normal: Vector, deepest: usize) -> Option<usize> {
    if incident.faces.is_empty() {
        return None;
    }
    let (mut face, mut least) = (0, f32::INFINITY);
    for &beside in incident.fan(deepest) {
        let cos = incident.faces[beside as usize].normal.dot(normal);
        let better = cos < least;
        face = if better { beside } else { face };
        least = if better { cos } else { least };
    }
    Some(face as usize)
}

/// A face of `incident`, or its edge or vertex if it has no faces. `place` gives the position of each vertex.
#[inline(always)]
pub(super) fn incident_polygon<const N: usize, H: Carried>(
    incident: &View,
    face: Option<usize>,
    place: impl Fn(Vector) -> (Vector, H),
    polygon: &mut Polygon<N, H>,
) {
    let Some(face) = face else {
        for (i, v) in incident.vertices.iter().enumerate() {
            let (point, heights) = place(*v);
            polygon.push_if(true, Corner { point, name: (i as u32) << 10, heights, edge: 0 });
        }
        return;
    };
    let outline = incident.outline(face);
    let stride = outline.len().div_ceil(MAX_INCIDENT).next_power_of_two();
    for i in outline.iter().step_by(stride) {
        let (point, heights) = place(incident.vertices[*i as usize]);
        polygon.push(*i, point, heights);
    }
}

/// Cuts a polygon by the side planes of a face; `extent` is the smaller shape's. Alternates between two
/// buffers and returns the buffer with the result.
#[inline(always)]
fn clip<'a, const N: usize>(
    view: &View,
    face: usize,
    [mut polygon, mut spare]: [&'a mut Polygon<N>; 2],
    extent: f32,
) -> &'a Polygon<N> {
    let normal = view.faces[face].normal;
    let outline = view.outline(face).iter().map(|i| view.vertices[*i as usize]);
    let Some(mut tail) = outline.clone().next_back() else { return polygon };
    let mut heights = [0.0; N];
    for (side, head) in outline.enumerate() {
        let outward = (head - tail).cross(normal);
        let margin = MARGIN * extent * outward.length();
        let offset = outward.dot(tail) + margin;
        // Copied only when a side cuts: most corners of a resting body are inside of all sides.
        let mut any_outside = false;
        for (height, corner) in heights.iter_mut().zip(polygon.corners()) {
            *height = outward.dot(corner.point) - offset;
            any_outside |= !(*height <= 0.0);
        }
        if any_outside {
            cut(polygon, |k, _| heights[k], side as u32, spare);
            core::mem::swap(&mut polygon, &mut spare);
            if polygon.count == 0 {
                break;
            }
        }
        tail = head;
    }
    polygon
}

/// The range of a line between `ends`, as 0…1, that lies over a face with a normal and an outline, and the
/// sides that end it, if any. The sides are `margin` metres farther out.
pub(super) fn clip_line(
    normal: Vector,
    outline: impl DoubleEndedIterator<Item = Vector> + Clone,
    ends: [Vector; 2],
    margin: f32,
) -> Option<[(f32, Option<u32>); 2]> {
    let along = ends[1] - ends[0];
    let (mut low, mut high) = ((0.0, None), (1.0, None));
    let mut tail = outline.clone().next_back()?;
    for (side, head) in (0..).zip(outline) {
        let outward = (head - tail).cross(normal);
        let height = outward.dot(ends[0] - tail) - margin * outward.length();
        let rate = outward.dot(along);
        let t = -height / rate;
        if rate > 0.0 && t < high.0 {
            high = (t, Some(side));
        } else if rate < 0.0 && t > low.0 {
            low = (t, Some(side));
        } else if rate == 0.0 && height > 0.0 {
            return None;
        }
        tail = head;
    }
    (low.0 <= high.0).then_some([low, high])
}

/// A reference face, and the inputs for the points of its contact.
pub(super) struct Reference<'a> {
    pub normal: Vector,
    pub offset: f32,
    /// The radii around the reference polyhedron and the incident polyhedron.
    pub radii: [f32; 2],
    pub prediction: f32,
    /// Transforms the face's frame to A's frame, if they differ.
    pub to_a: Option<&'a MatrixPose>,
    /// The bits of the face in its points' features.
    pub feature: u32,
}

impl Reference<'_> {
    /// A face of `view`, which is B if `of_b`. `radius` is the radius around the incident polyhedron.
    #[inline(always)]
    pub fn of_face(view: &View, face: usize, of_b: bool, radius: f32, prediction: f32) -> Self {
        let Face { normal, offset, .. } = view.faces[face];
        let feature = Self::feature_of(of_b, face);
        Self { normal, offset, radii: [view.radius, radius], prediction, to_a: None, feature }
    }

    /// The bits of a face of A or B in features.
    pub fn feature_of(of_b: bool, face: usize) -> u32 {
        u32::from(of_b) << 30 | (face as u32 & 0x3ff) << 20
    }

    /// The point between the surfaces for a corner at height `s` over the plane: at (s + r_ref − r_inc) / 2.
    /// In A's frame.
    #[inline(always)]
    fn middle(&self, corner: Vector, s: f32) -> Vector {
        let [of_reference, of_incident] = self.radii;
        let point = corner - self.normal * (0.5 * (s - of_reference + of_incident));
        self.to_a.map_or(point, |frame| frame.point(point))
    }

    /// The height of a point over the plane.
    #[inline(always)]
    pub fn height(&self, point: Vector) -> f32 {
        self.normal.dot(point) - self.offset
    }

    /// Fills a manifold, whose normal is set, with the corners of a clipped polygon. Returns the least height
    /// of the corners.
    #[inline(always)]
    pub fn fill<const N: usize, H: Carried>(
        &self,
        polygon: &Polygon<N, H>,
        height: impl Fn(&Corner<H>) -> f32,
        out: &mut LocalManifold,
    ) -> f32 {
        let radius = self.radii[0] + self.radii[1];
        let mut candidates = Candidates::<N>::new();
        let mut least = f32::INFINITY;
        for corner in polygon.corners() {
            let s = height(corner);
            least = min(s, least);
            if s - radius <= self.prediction {
                let feature = self.feature | corner.name;
                candidates.push(LocalPoint::new(self.middle(corner.point, s), s - radius, feature));
            }
        }
        keep::<false>(candidates.as_slice(), out);
        least
    }

    /// Fills a manifold, whose normal is set, with the part of an incident polygon over the face of an axis.
    /// `extent` is the smaller shape's. Returns whether the least height of the corners equals the separation
    /// of the axis.
    #[inline(always)]
    pub fn fill_clipped<const N: usize>(
        &self,
        view: &View,
        axis: &FaceAxis,
        polygon: &mut Polygon<N>,
        extent: f32,
        out: &mut LocalManifold,
    ) -> bool {
        let mut spare = Polygon::new();
        let polygon = clip(view, axis.face, [polygon, &mut spare], extent);
        let least = self.fill(polygon, |corner| self.height(corner.point), out);
        least <= axis.separation + MARGIN * extent
    }

    /// Adds the deepest vertex alone, where the shapes overlap beside the face.
    pub fn push_deepest(&self, corner: Vector, separation: f32, out: &mut LocalManifold) {
        let radius = self.radii[0] + self.radii[1];
        out.push(self.middle(corner, separation), separation - radius, self.feature | 0xf_ffff);
    }
}

/// The part of a convex polygon behind a plane, given the height of each corner over it.
#[inline(always)]
pub(super) fn cut<const N: usize, H: Carried>(
    polygon: &Polygon<N, H>,
    height: impl Fn(usize, &Corner<H>) -> f32,
    side: u32,
    out: &mut Polygon<N, H>,
) {
    out.count = 0;
    let corners = polygon.corners();
    let Some(first) = corners.first() else { return };
    // A segment's outline is walked in one direction only.
    let walk = if corners.len() == 2 { 1 } else { corners.len() };
    let side_name = (side + 1) & 0x3ff;
    let mut next = height(0, first);
    for (k, c) in corners.iter().enumerate() {
        let after = if k + 1 < corners.len() { k + 1 } else { 0 };
        let d = &corners[after];
        let this = next;
        next = height(after, d);
        let inside = this <= 0.0;
        out.push_if(inside, *c);
        let t = this / (this - next);
        let point = c.point + (d.point - c.point) * t;
        // Where the polygon leaves, its next edge runs along the side.
        let edge = if inside { ON_SIDE | side & 0x1ff } else { c.edge };
        let crosses = k < walk && inside != (next <= 0.0);
        let heights = c.heights.between(d.heights, t);
        out.push_if(crosses, Corner { point, name: c.edge << 10 | side_name, heights, edge });
    }
}

/// The maximum number of candidates before reduction.
pub(super) const MAX_CANDIDATES: usize = 64;
/// A list of at most `N` candidates on the stack.
pub(super) struct Candidates<const N: usize> {
    list: [LocalPoint; N],
    count: usize,
}

impl<const N: usize> Candidates<N> {
    pub fn new() -> Self {
        Self { list: [LocalPoint::default(); N], count: 0 }
    }

    pub fn as_slice(&self) -> &[LocalPoint] {
        &self.list[..self.count]
    }

    /// Adds a candidate. A full list replaces the candidate with the largest separation.
    pub fn push(&mut self, candidate: LocalPoint) {
        if self.count < N {
            self.list[self.count] = candidate;
            self.count += 1;
            return;
        }
        let mut shallowest = 0;
        for (i, c) in self.list.iter().enumerate() {
            if c.separation > self.list[shallowest].separation {
                shallowest = i;
            }
        }
        if candidate.separation < self.list[shallowest].separation {
            self.list[shallowest] = candidate;
        }
    }
}

/// Fills a manifold, whose normal is set, with at most four candidates; see [`Patch::reduce`].
///
/// Candidates of one face lie in a plane, so the outermost points support it. With several faces (`FACES`)
/// the outermost points may be in the air while the body leans on an edge between them. If one end of this
/// edge were dropped, it would sink in and be pushed out, which adds energy. So candidates above the deepest
/// candidate are worth less.
#[inline]
pub(super) fn keep<const FACES: bool>(list: &[LocalPoint], out: &mut LocalManifold) {
    let (kept, count) = match list.len() {
        0..=4 => ([0, 1, 2, 3], list.len()),
        5..=16 => Patch::<4>::of(list, out.normal).reduce::<FACES>(),
        _ => Patch::<16>::of(list, out.normal).reduce::<FACES>(),
    };
    out.count = 0;
    for k in &kept[..count] {
        out.add(list[*k]);
    }
}

/// The positions of candidates in the plane of contact, four side by side in each of `B` blocks. The last
/// may be unused.
pub(super) struct Patch<const B: usize> {
    pub x: [F32x4; B],
    pub y: [F32x4; B],
    /// Infinite for unused places.
    pub separation: [F32x4; B],
}

type Mask = <F32x4 as Lane>::Mask;

impl<const B: usize> Patch<B> {
    fn of(list: &[LocalPoint], normal: Vector) -> Self {
        let u = normal.any_orthonormal();
        let v = normal.cross(u);
        let none = F32x4::splat(f32::INFINITY);
        let mut patch = Self { x: [F32x4::ZERO; B], y: [F32x4::ZERO; B], separation: [none; B] };
        for (i, c) in list.iter().enumerate() {
            patch.x[i / 4].set(i % 4, u.dot(c.point));
            patch.y[i / 4].set(i % 4, v.dot(c.point));
            patch.separation[i / 4].set(i % 4, c.separation);
        }
        patch
    }

    /// The used places, as bits.
    #[inline(always)]
    fn present(&self) -> u64 {
        self.those_with(|_, present| present)
    }

    /// The candidates that pass a test, as bits.
    #[inline(always)]
    fn those_with(&self, holds: impl Fn(usize, Mask) -> Mask) -> u64 {
        let mut bits = 0;
        for k in 0..B {
            let present = self.separation[k].lt(F32x4::splat(f32::INFINITY));
            bits |= u64::from(F32x4::bits(F32x4::and(holds(k, present), present))) << (4 * k);
        }
        bits
    }

    /// A candidate's position.
    #[inline(always)]
    pub fn at(&self, i: usize) -> (f32, f32) {
        (F32x4::flat(&self.x)[i], F32x4::flat(&self.y)[i])
    }

    /// The first candidate of about the highest weighted worth above 0, and its worth.
    #[inline(always)]
    fn pick(&self, weights: &[F32x4; B], worth: impl Fn(F32x4, F32x4) -> F32x4) -> (usize, f32) {
        let (mut worths, mut scores) = ([F32x4::ZERO; B], [F32x4::ZERO; B]);
        let mut most = F32x4::ZERO;
        for k in 0..B {
            let present = self.separation[k].lt(F32x4::splat(f32::INFINITY));
            worths[k] = F32x4::select(present, worth(self.x[k], self.y[k]), F32x4::ZERO);
            scores[k] = worths[k] * weights[k];
            most = most.max(scores[k]);
        }
        let bar = F32x4::splat(ABOUT_EQUAL * greatest(most));
        let i = self.those_with(|k, _| bar.le(scores[k])).trailing_zeros() as usize % (4 * B);
        (i, F32x4::flat(&worths)[i])
    }

    /// The indices of the candidates to keep, and their number, at most four. The first is the deepest,
    /// within 0.1 % of the patch's size. Then come the farthest point from it, the point of the largest
    /// triangle, and the point that adds most to the triangle's area.
    pub fn reduce<const FACES: bool>(&self) -> ([usize; 4], usize) {
        let mut present = self.present();
        let count = present.count_ones() as usize;
        if count <= 4 {
            let mut kept = [0; 4];
            for k in &mut kept {
                *k = (present.trailing_zeros() & 63) as usize;
                present &= present.wrapping_sub(1);
            }
            return (kept, count);
        }
        let distance = |(x, y): (f32, f32)| {
            let (x, y) = (F32x4::splat(x), F32x4::splat(y));
            move |p: F32x4, q: F32x4| (p - x) * (p - x) + (q - y) * (q - y)
        };
        let from_any = distance(self.at(present.trailing_zeros() as usize));
        let (mut size, mut least) = (F32x4::ZERO, self.separation[0]);
        for k in 0..B {
            let here = self.separation[k].lt(F32x4::splat(f32::INFINITY));
            size = F32x4::select(here, from_any(self.x[k], self.y[k]), F32x4::ZERO).max(size);
            least = self.separation[k].min(least);
        }
        let size_squared = greatest(size);
        let (size, deepest) = (size_squared.sqrt(), -greatest(-least));
        let mut weights = [F32x4::ONE; B];
        if FACES {
            let (deepest, slope) = (F32x4::splat(deepest), F32x4::splat((1.0 - IN_THE_AIR) / (HIGH * size)));
            for (weight, separation) in weights.iter_mut().zip(self.separation) {
                *weight = (F32x4::ONE - (separation - deepest) * slope).max(F32x4::splat(IN_THE_AIR));
            }
        }
        let bar = F32x4::splat(MARGIN * size + deepest);
        let first = self.those_with(|k, _| self.separation[k].le(bar)).trailing_zeros() as usize % (4 * B);
        let a = self.at(first);
        let (second, far) = self.pick(&weights, distance(a));
        if !(far > FLAT as f32 * size_squared) {
            return ([first, 0, 0, 0], 1);
        }
        let b = self.at(second);
        let (third, area) = self.pick(&weights, |x, y| {
            let area = twice_area(a, b, x, y);
            area.max(-area)
        });
        if !(area > FLAT as f32 * size_squared) {
            return ([first, second, 0, 0], 2);
        }
        let c = self.at(third);
        let (cx, cy) = (F32x4::splat(c.0), F32x4::splat(c.1));
        let [p, q, r] = if twice_area(a, b, cx, cy).get(0) < 0.0 { [b, a, c] } else { [a, b, c] };
        let (fourth, added) = self.pick(&weights, |x, y| {
            -twice_area(p, q, x, y).min(twice_area(q, r, x, y)).min(twice_area(r, p, x, y))
        });
        let count = if added > FLAT as f32 * size_squared { 4 } else { 3 };
        ([first, second, third, fourth], count)
    }
}

/// The largest lane.
#[inline(always)]
fn greatest(v: F32x4) -> f32 {
    max(max(v.get(0), v.get(1)), max(v.get(2), v.get(3)))
}

/// Twice the areas of the triangles of two points and four third points, positive where they turn left.
#[inline(always)]
fn twice_area(p: (f32, f32), q: (f32, f32), x: F32x4, y: F32x4) -> F32x4 {
    let (dx, dy) = (F32x4::splat(q.0 - p.0), F32x4::splat(q.1 - p.1));
    dx * (y - F32x4::splat(p.1)) - dy * (x - F32x4::splat(p.0))
}
