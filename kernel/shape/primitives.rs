//! The shapes with the same code in both dimensions: plain values with public fields, their support points,
//! boxes and ray hits. Masses differ between 2D and 3D and are in the twin files.
//!
//! Constructors return errors for values that are not finite and for negative sizes. Since the fields are
//! public, functions accept all values: degenerate shapes act as points or segments.

use super::aabb::rotate_half;
use super::{Aabb, RayHit, ShapeError};
use crate::math::{DIM, Rot, Vector, max, min};

/// A circle or sphere around the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ball {
    /// The radius in metres; 0 is a point, which collides but has no mass.
    pub radius: f32,
}

/// All points within `radius` of a segment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Capsule {
    /// The first end of the axis.
    pub a: Vector,
    /// The second end of the axis. If it equals `a`, the capsule is a ball off the origin.
    pub b: Vector,
    /// The radius in metres; 0 is a segment, which collides but has no mass.
    pub radius: f32,
}

/// A rectangle or box around the origin along the axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cuboid {
    /// Half the size along each axis, in metres; 0 makes it flat.
    pub half: Vector,
}

/// The half of space behind a plane through the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfSpace {
    /// The unit normal that points out of the solid.
    pub normal: Vector,
}

/// A line segment without thickness.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// The first end.
    pub a: Vector,
    /// The second end.
    pub b: Vector,
}

/// A triangle: solid in 2D (with its corners in either order), a two-sided surface in 3D.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triangle {
    /// The first corner.
    pub a: Vector,
    /// The second corner.
    pub b: Vector,
    /// The third corner.
    pub c: Vector,
}

impl From<[Vector; 2]> for Segment {
    fn from([a, b]: [Vector; 2]) -> Self {
        Self { a, b }
    }
}

impl From<[Vector; 3]> for Triangle {
    fn from([a, b, c]: [Vector; 3]) -> Self {
        Self { a, b, c }
    }
}

/// The direction and length of a vector. `None` if the vector is shorter than 1e-15 m or not finite, since
/// its squared length then leaves the normal range of `f32`.
#[inline]
pub(crate) fn direction(v: Vector) -> Option<(Vector, f32)> {
    let square = v.length_squared();
    if square > 1e-30 && square < f32::INFINITY {
        let length = square.sqrt();
        Some((v * (1.0 / length), length))
    } else {
        None
    }
}

/// The unit vector along `v`, or `otherwise` if `v` has no direction.
#[inline]
pub(crate) fn direction_or(v: Vector, otherwise: Vector) -> Vector {
    match direction(v) {
        Some((unit, _)) => unit,
        None => otherwise,
    }
}

/// The point of the segment from `a` to `b` nearest to `p`, as a fraction 0…1 from `a`.
#[inline]
pub(crate) fn nearest_fraction(a: Vector, b: Vector, p: Vector) -> f32 {
    let axis = b - a;
    let square = axis.length_squared();
    if square > 0.0 { min(max((p - a).dot(axis) / square, 0.0), 1.0) } else { 0.0 }
}

/// The range of a ray in a convex solid: it enters at `.0` and leaves at `.1`, negative behind the origin.
pub(crate) type Stretch = (f32, f32);

/// The hit of a ray whose range in a solid is known. `normal_at` gives the outward normal at the entry
/// (`true`) or exit (`false`) at a distance.
pub(crate) fn hit_of_stretch(
    (enter, exit): Stretch,
    max_distance: f32,
    solid: bool,
    normal_at: impl FnOnce(bool, f32) -> Vector,
) -> Option<RayHit> {
    if !(exit >= 0.0 && enter <= exit) {
        return None;
    }
    let outside = enter >= 0.0;
    if !outside && solid {
        return Some(RayHit { distance: 0.0, normal: Vector::ZERO });
    }
    let distance = if outside { enter } else { exit };
    (distance <= max_distance).then(|| RayHit { distance, normal: normal_at(outside, distance) })
}

/// The range of the line `origin + t direction` within `radius` of `center`. The nearest point of the line is
/// computed first, so no large squares cancel.
#[inline]
fn stretch_in_ball(center: Vector, radius: f32, origin: Vector, direction: Vector) -> Option<Stretch> {
    let to_center = center - origin;
    let nearest = to_center.dot(direction);
    let offset = to_center - direction * nearest;
    let square = radius * radius - offset.length_squared();
    (square >= 0.0).then(|| (nearest - square.sqrt(), nearest + square.sqrt()))
}

impl Ball {
    /// A ball of the given radius in metres, which must be finite and not negative.
    pub fn new(radius: f32) -> Result<Self, ShapeError> {
        Ok(Self { radius: checked_length(radius)? })
    }

    /// The point farthest along `direction` (any length).
    #[inline]
    pub fn support(&self, direction: Vector) -> Vector {
        direction_or(direction, Vector::X) * self.radius
    }

    /// The box around the ball.
    #[inline]
    pub fn local_aabb(&self) -> Aabb {
        Aabb::new(Vector::ONE * -self.radius, Vector::ONE * self.radius)
    }

    /// The hit of a ray along the unit vector `direction`; see [`Shape::cast_ray`](super::Shape::cast_ray).
    pub fn cast_ray(
        &self,
        origin: Vector,
        direction: Vector,
        max_distance: f32,
        solid: bool,
    ) -> Option<RayHit> {
        let stretch = stretch_in_ball(Vector::ZERO, self.radius, origin, direction)?;
        hit_of_stretch(stretch, max_distance, solid, |_, t| direction_or(origin + direction * t, -direction))
    }
}

impl Capsule {
    /// The capsule around the segment from `a` to `b`; `radius` must be finite and not negative.
    pub fn new(a: Vector, b: Vector, radius: f32) -> Result<Self, ShapeError> {
        Ok(Self { a: checked_point(a)?, b: checked_point(b)?, radius: checked_length(radius)? })
    }

    /// The point farthest along `direction` (any length).
    #[inline]
    pub fn support(&self, direction: Vector) -> Vector {
        let end = if (self.b - self.a).dot(direction) > 0.0 { self.b } else { self.a };
        end + direction_or(direction, Vector::X) * self.radius
    }

    /// The box around the capsule turned by `rotation`.
    #[inline]
    pub fn local_aabb(&self, rotation: Rot) -> Aabb {
        Aabb::around([self.a, self.b].map(|v| rotation.rotate(v))).grown(self.radius)
    }

    /// The hit of a ray along the unit vector `direction`; see [`Shape::cast_ray`](super::Shape::cast_ray).
    pub fn cast_ray(
        &self,
        origin: Vector,
        direction: Vector,
        max_distance: f32,
        solid: bool,
    ) -> Option<RayHit> {
        let stretch = self.stretch(origin, direction)?;
        hit_of_stretch(stretch, max_distance, solid, |_, t| {
            self.normal_at(origin + direction * t, -direction)
        })
    }

    /// The direction from the axis to a point of the surface; `otherwise` for a point on the axis.
    pub(crate) fn normal_at(&self, point: Vector, otherwise: Vector) -> Vector {
        let fraction = nearest_fraction(self.a, self.b, point);
        direction_or(point - (self.a + (self.b - self.a) * fraction), otherwise)
    }

    /// The range of a line in the capsule, the union of two balls and the tube between them. All three and
    /// their union are convex, so the range ends at the outermost ends of the three ranges.
    pub(crate) fn stretch(&self, origin: Vector, direction: Vector) -> Option<Stretch> {
        let pieces = [
            stretch_in_ball(self.a, self.radius, origin, direction),
            stretch_in_ball(self.b, self.radius, origin, direction),
            self.stretch_in_tube(origin, direction),
        ];
        pieces.into_iter().flatten().reduce(|p, q| (min(p.0, q.0), max(p.1, q.1)))
    }

    /// The range of a line within `radius` of the infinite axis and between the planes at its ends.
    fn stretch_in_tube(&self, origin: Vector, line: Vector) -> Option<Stretch> {
        let (axis, length) = direction(self.b - self.a)?;
        let from_a = origin - self.a;
        let (along, slope) = (from_a.dot(axis), line.dot(axis));
        // The parts across the axis; the nearest point of the line to the axis comes first.
        let (across, drift) = (from_a - axis * along, line - axis * slope);
        let square = drift.length_squared();
        let (mut enter, mut exit) = (f32::NEG_INFINITY, f32::INFINITY);
        if square > 1e-12 {
            let nearest = -across.dot(drift) / square;
            let rest = self.radius * self.radius - (across + drift * nearest).length_squared();
            if rest < 0.0 {
                return None;
            }
            let half = (rest / square).sqrt();
            (enter, exit) = (nearest - half, nearest + half);
        } else if across.length_squared() > self.radius * self.radius {
            return None;
        }
        if slope != 0.0 {
            let (p, q) = (-along / slope, (length - along) / slope);
            (enter, exit) = (max(enter, min(p, q)), min(exit, max(p, q)));
        } else if along < 0.0 || along > length {
            return None;
        }
        (enter <= exit).then_some((enter, exit))
    }
}

impl Cuboid {
    /// The box of the given half extents in metres, which must be finite and not negative.
    pub fn new(half: Vector) -> Result<Self, ShapeError> {
        let half = checked_point(half)?;
        if half.min_element() < 0.0 { Err(ShapeError::Negative) } else { Ok(Self { half }) }
    }

    /// The corner farthest along `direction` (any length).
    #[inline]
    pub fn support(&self, direction: Vector) -> Vector {
        let (h, d) = (self.half.to_array(), direction.to_array());
        Vector::from_array(core::array::from_fn(|i| if d[i] < 0.0 { -h[i] } else { h[i] }))
    }

    /// The box around the cuboid turned by `rotation`.
    #[inline]
    pub fn local_aabb(&self, rotation: Rot) -> Aabb {
        let half = rotate_half(self.half, rotation);
        Aabb::new(-half, half)
    }

    /// The hit of a ray along the unit vector `direction`; see [`Shape::cast_ray`](super::Shape::cast_ray).
    pub fn cast_ray(
        &self,
        origin: Vector,
        direction: Vector,
        max_distance: f32,
        solid: bool,
    ) -> Option<RayHit> {
        let (h, o, d) = (self.half.to_array(), origin.to_array(), direction.to_array());
        let (mut enter, mut exit) = (f32::NEG_INFINITY, f32::INFINITY);
        let (mut enter_axis, mut exit_axis) = (0, 0);
        for i in 0..DIM {
            if d[i] == 0.0 {
                if o[i].abs() > h[i] {
                    return None;
                }
                continue;
            }
            let (p, q) = ((-h[i] - o[i]) / d[i], (h[i] - o[i]) / d[i]);
            let (near, far) = if p < q { (p, q) } else { (q, p) };
            if near > enter {
                (enter, enter_axis) = (near, i);
            }
            if far < exit {
                (exit, exit_axis) = (far, i);
            }
        }
        hit_of_stretch((enter, exit), max_distance, solid, |entering, _| {
            let axis = if entering { enter_axis } else { exit_axis };
            // A ray enters against the normal and leaves along it.
            let outward = if (d[axis] > 0.0) == entering { -1.0 } else { 1.0 };
            Vector::AXES[axis] * outward
        })
    }
}

impl HalfSpace {
    /// The half-space behind the plane through the origin with the given outward normal, of any length except
    /// 0.
    pub fn new(normal: Vector) -> Result<Self, ShapeError> {
        let largest = checked_point(normal)?.abs().max_element();
        if largest == 0.0 {
            return Err(ShapeError::Degenerate);
        }
        // Scaled to about 1 first, since the square of a tiny or huge length is not a normal `f32`.
        let scaled = Vector::from_array(normal.to_array().map(|c| c / largest));
        Ok(Self { normal: direction_or(scaled, Vector::Y) })
    }

    /// The hit of a ray along the unit vector `direction`; see [`Shape::cast_ray`](super::Shape::cast_ray).
    pub fn cast_ray(
        &self,
        origin: Vector,
        direction: Vector,
        max_distance: f32,
        solid: bool,
    ) -> Option<RayHit> {
        let (height, slope) = (origin.dot(self.normal), direction.dot(self.normal));
        let stretch = if slope < 0.0 {
            (height / -slope, f32::INFINITY)
        } else if slope > 0.0 {
            (f32::NEG_INFINITY, -height / slope)
        } else if height <= 0.0 {
            (f32::NEG_INFINITY, f32::INFINITY)
        } else {
            return None;
        };
        // A ray that leaves only at infinity does not leave.
        hit_of_stretch(stretch, min(max_distance, f32::MAX), solid, |_, _| self.normal)
    }
}

impl Segment {
    /// The segment from `a` to `b`, which must be finite; they may coincide.
    pub fn new(a: Vector, b: Vector) -> Result<Self, ShapeError> {
        Ok(Self { a: checked_point(a)?, b: checked_point(b)? })
    }

    /// The end farthest along `direction` (any length).
    #[inline]
    pub fn support(&self, direction: Vector) -> Vector {
        if (self.b - self.a).dot(direction) > 0.0 { self.b } else { self.a }
    }
}

impl Triangle {
    /// The triangle with the given corners, which must be finite; they may lie on a line.
    pub fn new(a: Vector, b: Vector, c: Vector) -> Result<Self, ShapeError> {
        Ok(Self { a: checked_point(a)?, b: checked_point(b)?, c: checked_point(c)? })
    }

    /// The corner farthest along `direction` (any length).
    #[inline]
    pub fn support(&self, direction: Vector) -> Vector {
        let (a, b, c) = (self.a.dot(direction), self.b.dot(direction), self.c.dot(direction));
        if a >= b && a >= c {
            self.a
        } else if b >= c {
            self.b
        } else {
            self.c
        }
    }
}

/// The point, if all its coordinates are finite.
fn checked_point(v: Vector) -> Result<Vector, ShapeError> {
    if v.is_finite() { Ok(v) } else { Err(ShapeError::NotFinite) }
}

/// The length, if it is finite and not negative.
pub(crate) fn checked_length(v: f32) -> Result<f32, ShapeError> {
    if !v.is_finite() {
        Err(ShapeError::NotFinite)
    } else if v < 0.0 {
        Err(ShapeError::Negative)
    } else {
        Ok(v)
    }
}

#[cfg(test)]
mod tests {
    use super::super::Shape;
    use super::*;
    use proptest::prelude::*;

    type V64 = [f64; DIM];

    fn wide(v: Vector) -> V64 {
        v.to_array().map(f64::from)
    }

    fn dot(a: V64, b: V64) -> f64 {
        (0..DIM).map(|i| a[i] * b[i]).sum()
    }

    fn along(a: V64, d: V64, t: f64) -> V64 {
        core::array::from_fn(|i| a[i] + d[i] * t)
    }

    /// The exact signed distance to a solid, in f64.
    fn distance(shape: &Shape, p: V64) -> f64 {
        match shape {
            Shape::Ball(s) => dot(p, p).sqrt() - f64::from(s.radius),
            Shape::Capsule(s) => {
                let (a, b) = (wide(s.a), wide(s.b));
                let (axis, from) = (along(b, a, -1.0), along(p, a, -1.0));
                let t = (dot(from, axis) / dot(axis, axis).max(1e-300)).clamp(0.0, 1.0);
                let r = along(from, axis, -t);
                dot(r, r).sqrt() - f64::from(s.radius)
            }
            Shape::Cuboid(s) => {
                let h = wide(s.half);
                let q: V64 = core::array::from_fn(|i| p[i].abs() - h[i]);
                let out = q.map(|v| v.max(0.0));
                dot(out, out).sqrt() + q.into_iter().fold(f64::NEG_INFINITY, f64::max).min(0.0)
            }
            Shape::HalfSpace(s) => dot(p, wide(s.normal)),
            _ => unreachable!("no such shape here"),
        }
    }

    fn vector(range: f32) -> impl Strategy<Value = Vector> {
        prop::array::uniform3(-range..range).prop_map(|v| Vector::from_array(core::array::from_fn(|i| v[i])))
    }

    fn unit() -> impl Strategy<Value = Vector> {
        vector(1.0).prop_filter_map("too short", |v| direction(v).filter(|(_, l)| *l > 0.01).map(|(u, _)| u))
    }

    fn solid_shape() -> impl Strategy<Value = Shape> {
        prop_oneof![
            (0.01f32..2.0).prop_map(|r| Shape::Ball(Ball::new(r).unwrap())),
            (vector(2.0), vector(2.0), 0.01f32..1.0)
                .prop_map(|(a, b, r)| Shape::Capsule(Capsule::new(a, b, r).unwrap())),
            (vector(1.0), 0.01f32..1.0).prop_map(|(a, r)| Shape::Capsule(Capsule::new(a, a, r).unwrap())),
            vector(2.0).prop_map(|h| Shape::Cuboid(Cuboid::new(h.abs()).unwrap())),
            unit().prop_map(|n| Shape::HalfSpace(HalfSpace::new(n).unwrap())),
        ]
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(3000))]

        #[test]
        fn rays_hit_the_first_boundary(
            shape in solid_shape(), origin in vector(4.0), direction in unit(), target in vector(1.0),
            aimed in any::<bool>(), solid in any::<bool>(),
        ) {
            let d = if aimed { super::direction_or(target - origin, direction) } else { direction };
            let reach = 12.0;
            let at = |t: f64| distance(&shape, along(wide(origin), wide(d), t));
            let hit = shape.cast_ray(origin, d, reach, solid);
            let start = at(0.0);
            prop_assume!(start.abs() > 1e-4);
            if start < 0.0 && solid {
                prop_assert_eq!(hit, Some(RayHit { distance: 0.0, normal: Vector::ZERO }));
                return Ok(());
            }
            let end = hit.map_or(f64::from(reach), |h| f64::from(h.distance));
            for k in 0..200 {
                let t = end * f64::from(k) / 200.0;
                // Grazing a flat face or a tangent is decided within rounding.
                prop_assert!(at(t) * start.signum() > -1e-4, "crossed a boundary before {end} at {t}");
            }
            if let Some(hit) = hit {
                prop_assert!(hit.distance <= reach);
                prop_assert!(at(end).abs() < 2e-4, "off the boundary by {}", at(end));
                prop_assert!((hit.normal.length() - 1.0).abs() < 1e-5);
                let slope = hit.normal.dot(d) * start.signum() as f32;
                prop_assert!(slope < 2e-2, "the normal faces the ray, or goes with it from within");
                let out = along(along(wide(origin), wide(d), end), wide(hit.normal), 0.01);
                prop_assert!((distance(&shape, out) - 0.01).abs() < 5e-4, "the normal is that of the surface");
            }
        }

        #[test]
        fn support_points_are_on_the_boundary_and_farthest(
            shape in solid_shape(), direction in vector(3.0), probes in prop::collection::vec(vector(4.0), 20),
        ) {
            prop_assume!(direction.length() > 1e-3);
            let Some(support) = shape.support(direction) else { return Ok(()) };
            prop_assert!(distance(&shape, wide(support)).abs() < 1e-5);
            let best = dot(wide(support), wide(direction));
            for p in probes {
                if distance(&shape, wide(p)) <= 0.0 {
                    prop_assert!(dot(wide(p), wide(direction)) <= best + 1e-4);
                }
            }
        }

        #[test]
        fn boxes_touch_the_support_points(shape in solid_shape()) {
            let aabb = shape.local_aabb(Rot::IDENTITY);
            for (i, axis) in Vector::AXES.into_iter().enumerate() {
                let Some(high) = shape.support(axis) else { return Ok(()) };
                let low = shape.support(-axis).expect("the same shape");
                prop_assert!((aabb.max.to_array()[i] - high.to_array()[i]).abs() < 1e-5);
                prop_assert!((aabb.min.to_array()[i] - low.to_array()[i]).abs() < 1e-5);
            }
        }

        #[test]
        fn segments_and_triangles_support_the_farthest_corner(
            a in vector(2.0), b in vector(2.0), c in vector(2.0), d in vector(1.0),
        ) {
            let t = Triangle::new(a, b, c).unwrap().support(d);
            prop_assert!([a, b, c].into_iter().all(|v| v.dot(d) <= t.dot(d)));
            let s = Segment::new(a, b).unwrap().support(d);
            prop_assert!([a, b].into_iter().all(|v| (v - s).dot(d) <= 1e-6));
        }
    }

    #[test]
    fn constructors_refuse_what_is_no_size() {
        for bad in [f32::NAN, f32::INFINITY] {
            let v = Vector::ONE * bad;
            assert_eq!(Ball::new(bad), Err(ShapeError::NotFinite));
            assert_eq!(Capsule::new(v, Vector::ZERO, 1.0), Err(ShapeError::NotFinite));
            assert_eq!(Capsule::new(Vector::ZERO, Vector::X, bad), Err(ShapeError::NotFinite));
            assert_eq!(Cuboid::new(v), Err(ShapeError::NotFinite));
            assert_eq!(HalfSpace::new(v), Err(ShapeError::NotFinite));
            assert_eq!(Segment::new(Vector::ZERO, v), Err(ShapeError::NotFinite));
            assert_eq!(Triangle::new(Vector::X, Vector::ZERO, v), Err(ShapeError::NotFinite));
        }
        assert_eq!(Ball::new(-1.0), Err(ShapeError::Negative));
        assert_eq!(Capsule::new(Vector::ZERO, Vector::X, -0.1), Err(ShapeError::Negative));
        assert_eq!(Cuboid::new(Vector::X * -1.0), Err(ShapeError::Negative));
        assert_eq!(HalfSpace::new(Vector::ZERO), Err(ShapeError::Degenerate));
        assert!(Ball::new(0.0).is_ok() && Cuboid::new(Vector::ZERO).is_ok());
        for tiny in [1e-30, 1.0, 1e30] {
            assert_eq!(HalfSpace::new(Vector::Y * tiny), Ok(HalfSpace { normal: Vector::Y }));
        }
    }

    #[test]
    fn a_ray_along_a_face_or_from_a_face_is_decided() {
        let cube = Cuboid::new(Vector::ONE).unwrap();
        let from = Vector::X * -3.0;
        assert_eq!(cube.cast_ray(from + Vector::Y, Vector::X, 9.0, true).map(|h| h.distance), Some(2.0));
        assert_eq!(cube.cast_ray(from + Vector::Y * 1.0001, Vector::X, 9.0, true), None);
        assert_eq!(cube.cast_ray(from, Vector::X, 1.9, true), None, "beyond the reach");
        let leaving = cube.cast_ray(Vector::ZERO, Vector::X, 9.0, false);
        assert_eq!(leaving, Some(RayHit { distance: 1.0, normal: Vector::X }));
        let plane = HalfSpace::new(Vector::Y).unwrap();
        assert_eq!(plane.cast_ray(Vector::Y * -1.0, Vector::X, f32::INFINITY, false), None);
        assert_eq!(plane.cast_ray(Vector::Y * -1.0, -Vector::Y, f32::INFINITY, false), None);
    }

    #[test]
    fn degenerate_shapes_are_total() {
        let point = Ball { radius: 0.0 };
        let hit = point.cast_ray(Vector::X * -1.0, Vector::X, 9.0, true).expect("through the point");
        assert_eq!((hit.distance, hit.normal), (1.0, -Vector::X));
        let capsule = Capsule { a: Vector::ONE, b: Vector::ONE, radius: 0.5 };
        assert_eq!(capsule.support(Vector::X), Vector::ONE + Vector::X * 0.5);
        assert!(capsule.support(Vector::ZERO).is_finite());
        let along = Capsule { a: Vector::ZERO, b: Vector::X, radius: 0.5 };
        let hit = along.cast_ray(Vector::X * 5.0, -Vector::X, 9.0, true).expect("end on");
        assert_eq!((hit.distance, hit.normal), (3.5, Vector::X));
    }
}
