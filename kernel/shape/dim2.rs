//! Shapes in the plane: the convex polygon, masses and areas, rays against flat shapes.

pub(crate) use super::primitives::direction;
use super::primitives::{Stretch, checked_length, direction_or, hit_of_stretch};
use super::{Aabb, Ball, Capsule, Cuboid, RayHit, Segment, ShapeError, Triangle};
use crate::math::{Vector, atan2, max, min};
use core::f64::consts::PI;

/// A convex polygon, sharp or rounded: all points within [`radius`](Self::radius) of its core.
///
/// The vertices go round counter-clockwise, without duplicates and without vertices on the line of
/// their neighbours; edge `i` leads from vertex `i` to the next one and has normal `i`.
#[derive(Clone, Debug, PartialEq)]
pub struct Hull {
    vertices: Box<[Vector]>,
    normals: Box<[Vector]>,
    radius: f32,
    aabb: Aabb,
    mass: MassProperties,
}

/// Mass, centre of mass and moment of inertia.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MassProperties {
    /// In kg (or, at unit density, the area in m²).
    pub mass: f32,
    /// The centre of mass in the shape's frame, in metres.
    pub center: Vector,
    /// The moment of inertia about the centre of mass, in kg·m².
    pub inertia: f32,
}

impl MassProperties {
    /// No mass.
    pub const ZERO: Self = Self { mass: 0.0, center: Vector::ZERO, inertia: 0.0 };

    /// The same shape at a density times as high. A density of 0 gives no mass but keeps the centre.
    #[inline]
    pub fn scaled(&self, density: f32) -> Self {
        Self { mass: self.mass * density, center: self.center, inertia: self.inertia * density }
    }
}

/// A point in `f64`: outlines are checked and measured in full precision, once, when they are made.
type Point = [f64; 2];

fn wide(v: Vector) -> Point {
    [f64::from(v.x), f64::from(v.y)]
}

fn sub(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1]]
}

fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn cross(a: Point, b: Point) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

fn length(a: Point) -> f64 {
    dot(a, a).sqrt()
}

/// How close two points, or a point and the line of its neighbours, may be before they count as one
/// or as on it: 1e-6 of the outline's size, and no less than the spacing of `f32` at its place.
fn merge_distance(points: &[Vector]) -> f64 {
    let bounds = Aabb::around(points.iter().copied());
    let size = wide(bounds.max - bounds.min);
    let far = bounds.min.abs().max(bounds.max.abs()).max_element();
    1.0e-6 * size[0].max(size[1]) + 2.0 * f64::from(f32::EPSILON) * f64::from(far)
}

impl Hull {
    /// The polygon with the given outline, rounded by `radius` metres (0 leaves it sharp).
    ///
    /// Takes either orientation. Duplicate points and points on the line of their neighbours, within
    /// 1e-6 of the size, are left out.
    ///
    /// # Errors
    /// `NotFinite` and `Negative` for such numbers, `Degenerate` if less than a triangle is left,
    /// `NotConvex` if the outline turns both ways or goes round more than once.
    pub fn from_convex(vertices: &[Vector], radius: f32) -> Result<Self, ShapeError> {
        let radius = check(vertices, radius)?;
        let mut outline = vertices.to_vec();
        let origin = outline.first().copied().map(wide).ok_or(ShapeError::Degenerate)?;
        let area: f64 = edges(&outline).map(|(p, q)| cross(sub(wide(p), origin), sub(wide(q), origin))).sum();
        if area < 0.0 {
            outline.reverse();
        }
        let outline = simplified(outline, merge_distance(vertices))?;
        if turns_left_once(&outline) { Ok(Self::build(outline, radius)) } else { Err(ShapeError::NotConvex) }
    }

    /// The convex hull of any points, rounded by `radius` metres (0 leaves it sharp).
    ///
    /// # Errors
    /// `NotFinite` and `Negative` for such numbers, `Degenerate` if all points lie on one line within
    /// 1e-6 of their extent.
    pub fn convex_hull_of(points: &[Vector], radius: f32) -> Result<Self, ShapeError> {
        let radius = check(points, radius)?;
        let tolerance = merge_distance(points);
        let outline = simplified(monotone_chain(points), tolerance)?;
        if turns_left_once(&outline) { Ok(Self::build(outline, radius)) } else { Err(ShapeError::Degenerate) }
    }

    fn build(vertices: Vec<Vector>, radius: f32) -> Self {
        let normals: Box<[Vector]> = edges(&vertices)
            .map(|(p, q)| {
                let e = sub(wide(q), wide(p));
                let l = length(e);
                Vector::from_array([(e[1] / l) as f32, (-e[0] / l) as f32])
            })
            .collect();
        let aabb = Aabb::around(vertices.iter().copied()).grown(radius);
        let mass = mass_of_rounded_polygon(&vertices, f64::from(radius));
        Self { vertices: vertices.into(), normals, radius, aabb, mass }
    }

    /// The corners of the core, counter-clockwise; at least three.
    #[inline]
    pub fn vertices(&self) -> &[Vector] {
        &self.vertices
    }

    /// The outward unit normals: `normals()[i]` is that of the edge from vertex `i` to the next.
    #[inline]
    pub fn normals(&self) -> &[Vector] {
        &self.normals
    }

    /// How far the surface stands off the core, in metres; 0 for a sharp polygon.
    #[inline]
    pub fn radius(&self) -> f32 {
        self.radius
    }

    /// The box around the polygon in its own frame, radius included.
    #[inline]
    pub fn bounds(&self) -> Aabb {
        self.aabb
    }

    /// The point farthest along `direction` (any length), radius included.
    pub fn support(&self, direction: Vector) -> Vector {
        let mut best = (self.vertices[0], self.vertices[0].dot(direction));
        for v in &self.vertices[1..] {
            let height = v.dot(direction);
            if height > best.1 {
                best = (*v, height);
            }
        }
        if self.radius > 0.0 { best.0 + direction_or(direction, Vector::X) * self.radius } else { best.0 }
    }

    /// Where a ray along the unit vector `direction` hits; see [`Shape::cast_ray`](super::Shape::cast_ray).
    pub fn cast_ray(
        &self,
        origin: Vector,
        direction: Vector,
        max_distance: f32,
        solid: bool,
    ) -> Option<RayHit> {
        if self.radius == 0.0 {
            return cast_ray_polygon(&self.vertices, &self.normals, origin, direction, max_distance, solid);
        }
        // The boundary of a rounded polygon is that of the capsules around its edges.
        let mut whole: Option<Stretch> = None;
        let (mut first, mut last) = (None, None);
        for (a, b) in edges(&self.vertices) {
            let capsule = Capsule { a, b, radius: self.radius };
            let Some((enter, exit)) = capsule.stretch(origin, direction) else { continue };
            let (low, high) = whole.unwrap_or((f32::INFINITY, f32::NEG_INFINITY));
            if enter < low {
                first = Some(capsule);
            }
            if exit > high {
                last = Some(capsule);
            }
            whole = Some((min(enter, low), max(exit, high)));
        }
        hit_of_stretch(whole?, max_distance, solid, |entering, t| {
            let outward = if entering { -direction } else { direction };
            let capsule = if entering { first } else { last };
            capsule.map_or(outward, |c| c.normal_at(origin + direction * t, outward))
        })
    }

    /// Area, centroid and polar moment of the area about it.
    #[inline]
    pub fn unit_mass(&self) -> MassProperties {
        self.mass
    }
}

/// The radius, if all numbers are usable.
fn check(points: &[Vector], radius: f32) -> Result<f32, ShapeError> {
    if points.iter().all(|p| p.is_finite()) { checked_length(radius) } else { Err(ShapeError::NotFinite) }
}

/// The edges of a closed outline.
fn edges(outline: &[Vector]) -> impl Iterator<Item = (Vector, Vector)> + '_ {
    let n = outline.len();
    (0..n).map(move |i| (outline[i], outline[if i + 1 == n { 0 } else { i + 1 }]))
}

/// The outline without points that are within `tolerance` of the one before, or of the line of both
/// neighbours while between them. Spikes stay: they are not convex, and found as such later.
fn simplified(mut outline: Vec<Vector>, tolerance: f64) -> Result<Vec<Vector>, ShapeError> {
    loop {
        let before = outline.len();
        let mut i = 0;
        while outline.len() >= 3 && i < outline.len() {
            let n = outline.len();
            let (p, q, r) = (wide(outline[(i + n - 1) % n]), wide(outline[i]), wide(outline[(i + 1) % n]));
            let (chord, first) = (sub(r, p), sub(q, p));
            let between = dot(first, chord) >= 0.0 && dot(sub(r, q), chord) >= 0.0;
            let off_line = cross(chord, first).abs() <= tolerance * length(chord);
            if length(first) <= tolerance || (off_line && between) {
                outline.remove(i);
            } else {
                i += 1;
            }
        }
        if outline.len() < 3 {
            return Err(ShapeError::Degenerate);
        }
        if outline.len() == before {
            return Ok(outline);
        }
    }
}

/// Whether every corner turns left and the outline goes round once: its edges' directions pass from
/// the lower into the upper half of the circle exactly once.
fn turns_left_once(outline: &[Vector]) -> bool {
    let edge = |i: usize| sub(wide(outline[(i + 1) % outline.len()]), wide(outline[i % outline.len()]));
    let upper = |e: Point| e[1] > 0.0 || (e[1] == 0.0 && e[0] > 0.0);
    let mut rounds = 0;
    for i in 0..outline.len() {
        let (e, f) = (edge(i), edge(i + 1));
        if cross(e, f) <= 0.0 {
            return false;
        }
        rounds += usize::from(!upper(e) && upper(f));
    }
    rounds == 1
}

/// The convex hull, counter-clockwise, of points that are finite (A. M. Andrew, "Another efficient
/// algorithm for convex hulls in two dimensions", 1979). Fewer than three points if it has no area.
fn monotone_chain(points: &[Vector]) -> Vec<Vector> {
    let mut sorted = points.to_vec();
    // −0 and 0 are one place: adding 0 makes them one number.
    sorted.iter_mut().for_each(|p| *p = *p + Vector::ZERO);
    sorted.sort_unstable_by(|p, q| p.x.total_cmp(&q.x).then(p.y.total_cmp(&q.y)));
    sorted.dedup();
    let mut hull: Vec<Vector> = Vec::with_capacity(sorted.len() + 1);
    let add = |hull: &mut Vec<Vector>, floor: usize, p: Vector| {
        while hull.len() >= floor + 2 {
            let (a, b) = (wide(hull[hull.len() - 2]), wide(hull[hull.len() - 1]));
            if cross(sub(b, a), sub(wide(p), a)) > 0.0 {
                break;
            }
            hull.pop();
        }
        hull.push(p);
    };
    for p in &sorted {
        add(&mut hull, 0, *p);
    }
    let floor = hull.len().saturating_sub(1);
    for p in sorted.iter().rev().skip(1) {
        add(&mut hull, floor, *p);
    }
    hull.pop();
    hull
}

/// Sums of area, first and second moments about one point.
#[derive(Default)]
struct Moments {
    area: f64,
    first: Point,
    /// ∫ |p|² dA.
    polar: f64,
}

impl Moments {
    /// Adds a piece by its area, its first moment and its polar moment about `at`.
    fn add(&mut self, area: f64, at: Point, first_about: Point, polar_about: f64) {
        // ∫ |at + s|² = polar + 2 at · first + area |at|².
        self.area += area;
        self.first =
            [self.first[0] + area * at[0] + first_about[0], self.first[1] + area * at[1] + first_about[1]];
        self.polar += polar_about + 2.0 * dot(at, first_about) + area * dot(at, at);
    }

    /// About the centroid, with `origin` the point the sums are about.
    fn finish(&self, origin: Point) -> MassProperties {
        if self.area.partial_cmp(&0.0) != Some(core::cmp::Ordering::Greater) {
            return MassProperties::ZERO;
        }
        let center = self.first.map(|v| v / self.area);
        let inertia = self.polar - self.area * dot(center, center);
        MassProperties {
            mass: self.area as f32,
            center: Vector::from_array([(origin[0] + center[0]) as f32, (origin[1] + center[1]) as f32]),
            inertia: inertia.max(0.0) as f32,
        }
    }
}

/// The area of a polygon grown by `radius`: the core as a fan of triangles, a rectangle on each edge, a
/// sector of the exterior angle θ at each corner (∫ n̂ dθ from n₀ to n₁ is (n₁ − n₀) turned clockwise).
fn mass_of_rounded_polygon(vertices: &[Vector], radius: f64) -> MassProperties {
    let origin = wide(vertices[0]);
    let local = |v: Vector| sub(wide(v), origin);
    let mut sum = Moments::default();
    let n = vertices.len();
    for i in 0..n {
        let (p, q, r) = (local(vertices[i]), local(vertices[(i + 1) % n]), local(vertices[(i + 2) % n]));
        // The triangle (origin, p, q): ∫|s|² = area/6 (p·p + p·q + q·q), centroid (p + q)/3.
        let area = 0.5 * cross(p, q);
        let first = [area * (p[0] + q[0]) / 3.0, area * (p[1] + q[1]) / 3.0];
        sum.add(area, [0.0, 0.0], first, area / 6.0 * (dot(p, p) + dot(p, q) + dot(q, q)));
        if radius > 0.0 {
            let (e, f) = (sub(q, p), sub(r, q));
            let (le, lf) = (length(e), length(f));
            let (n0, n1) = ([e[1] / le, -e[0] / le], [f[1] / lf, -f[0] / lf]);
            let middle: Point = core::array::from_fn(|k| 0.5 * (p[k] + q[k] + radius * n0[k]));
            let slab = le * radius;
            sum.add(slab, middle, [0.0, 0.0], slab * (le * le + radius * radius) / 12.0);
            let angle = atan2(cross(n0, n1), dot(n0, n1));
            let (square, cube) = (radius * radius, radius * radius * radius);
            let first = [cube / 3.0 * (n1[1] - n0[1]), -cube / 3.0 * (n1[0] - n0[0])];
            sum.add(0.5 * square * angle, q, first, 0.25 * square * square * angle);
        }
    }
    sum.finish(origin)
}

/// π r², π r⁴ / 2.
pub(super) fn mass_of_ball(ball: &Ball) -> MassProperties {
    let square = f64::from(ball.radius) * f64::from(ball.radius);
    let area = PI * square;
    MassProperties { mass: area as f32, center: Vector::ZERO, inertia: (0.5 * area * square) as f32 }
}

/// With half axis h: a rectangle 2 h × 2 r and two half discs, whose first moment about the diameter is
/// 2 r³ / 3 each: I = rectangle + π r⁴ / 2 + π r² h² + 8 h r³ / 3.
pub(super) fn mass_of_capsule(capsule: &Capsule) -> MassProperties {
    let r = f64::from(capsule.radius);
    let h = 0.5 * length(sub(wide(capsule.b), wide(capsule.a)));
    let (slab, disc) = (4.0 * h * r, PI * r * r);
    let inertia = slab * (h * h + r * r) / 3.0 + disc * (0.5 * r * r + h * h) + 8.0 / 3.0 * h * r * r * r;
    let center = (capsule.a + capsule.b) * 0.5;
    MassProperties { mass: (slab + disc) as f32, center, inertia: inertia as f32 }
}

/// 4 hx hy, m (hx² + hy²) / 3.
pub(super) fn mass_of_cuboid(cuboid: &Cuboid) -> MassProperties {
    let half = wide(cuboid.half);
    let area = 4.0 * half[0] * half[1];
    MassProperties { mass: area as f32, center: Vector::ZERO, inertia: (area * dot(half, half) / 3.0) as f32 }
}

/// Half the cross product of two sides; A (a² + b² + c²) / 36 for sides a, b, c.
pub(super) fn mass_of_triangle(triangle: &Triangle) -> MassProperties {
    let [a, b, c] = [triangle.a, triangle.b, triangle.c].map(wide);
    let [u, v, w] = [sub(b, a), sub(c, b), sub(a, c)];
    let area = 0.5 * cross(u, v).abs();
    let center = Vector::from_array(core::array::from_fn(|i| ((a[i] + b[i] + c[i]) / 3.0) as f32));
    let inertia = area * (dot(u, u) + dot(v, v) + dot(w, w)) / 36.0;
    MassProperties { mass: area as f32, center, inertia: inertia as f32 }
}

/// Clips the ray by every edge's line (M. Cyrus and J. Beck, 1978).
fn cast_ray_polygon(
    vertices: &[Vector],
    normals: &[Vector],
    origin: Vector,
    direction: Vector,
    max_distance: f32,
    solid: bool,
) -> Option<RayHit> {
    let (mut enter, mut exit) = (f32::NEG_INFINITY, f32::INFINITY);
    let (mut first, mut last) = (-direction, direction);
    for (v, n) in vertices.iter().zip(normals) {
        let (height, slope) = ((origin - *v).dot(*n), direction.dot(*n));
        let t = height / -slope;
        if slope < 0.0 {
            if t > enter {
                (enter, first) = (t, *n);
            }
        } else if slope > 0.0 {
            if t < exit {
                (exit, last) = (t, *n);
            }
        } else if height > 0.0 {
            return None;
        }
    }
    hit_of_stretch((enter, exit), max_distance, solid, |entering, _| if entering { first } else { last })
}

/// Where a ray along the unit vector `direction` hits a solid triangle. Without area it acts as its
/// longest side.
pub(super) fn cast_ray_triangle(
    triangle: &Triangle,
    origin: Vector,
    direction: Vector,
    max_distance: f32,
    solid: bool,
) -> Option<RayHit> {
    match oriented(triangle) {
        Ok((corners, normals)) => {
            cast_ray_polygon(&corners, &normals, origin, direction, max_distance, solid)
        }
        Err(side) => cast_ray_segment(&side, origin, direction, max_distance),
    }
}

/// The corners counter-clockwise and the edges' normals, or the longest side of a triangle whose
/// height over it is below 1e-6 of its length.
pub(crate) fn oriented(triangle: &Triangle) -> Result<([Vector; 3], [Vector; 3]), Segment> {
    let Triangle { a, b, c } = *triangle;
    let area = (b - a).perp_dot(c - a);
    let corners = if area < 0.0 { [a, c, b] } else { [a, b, c] };
    let mut longest = (Segment { a, b }, -1.0);
    for i in 0..3 {
        let (p, q) = (corners[i], corners[(i + 1) % 3]);
        let square = (q - p).length_squared();
        if square > longest.1 {
            longest = (Segment { a: p, b: q }, square);
        }
    }
    if area.abs() > 1.0e-6 * longest.1 && longest.1 > 1e-30 {
        let outward = |p: Vector, q: Vector| direction_or(-(q - p).perp(), Vector::Y);
        Ok((corners, core::array::from_fn(|i| outward(corners[i], corners[(i + 1) % 3]))))
    } else {
        Err(longest.0)
    }
}

/// Where a ray along the unit vector `direction` crosses a segment, from either side. A ray along the
/// segment's own line hits its nearer end.
pub(super) fn cast_ray_segment(
    segment: &Segment,
    origin: Vector,
    direction: Vector,
    max_distance: f32,
) -> Option<RayHit> {
    let (to_a, to_b) = (segment.a - origin, segment.b - origin);
    // The heights of the ends over the ray's line, counter-clockwise positive.
    let (height_a, height_b) = (direction.perp_dot(to_a), direction.perp_dot(to_b));
    if (height_a > 0.0 && height_b > 0.0) || (height_a < 0.0 && height_b < 0.0) {
        return None;
    }
    let (along_a, along_b) = (to_a.dot(direction), to_b.dot(direction));
    let drop = height_a - height_b;
    let distance = if drop == 0.0 {
        let (near, far) = (min(along_a, along_b), max(along_a, along_b));
        if far < 0.0 { far } else { max(near, 0.0) }
    } else {
        along_a + (along_b - along_a) * (height_a / drop)
    };
    if !(distance >= 0.0 && distance <= max_distance) {
        return None;
    }
    let normal = direction_or((segment.b - segment.a).perp(), -direction);
    let facing = normal.dot(direction);
    let normal = if drop == 0.0 { -direction } else { normal };
    Some(RayHit { distance, normal: if drop != 0.0 && facing > 0.0 { -normal } else { normal } })
}
