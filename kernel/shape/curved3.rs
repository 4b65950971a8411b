//! The frustum of a circular cone: a cylinder if both ends are equal, a cone if one end is a point.

use super::MassProperties;
use crate::math::{Inertia, Rot, Vector, max, min};
use crate::shape::primitives::{checked_length, direction_or, hit_of_stretch};
use crate::shape::{Aabb, RayHit, ShapeError};
use core::f32::consts::PI;

/// The solid between two circles about the y axis: a cylinder, a cone, or the frustum of a cone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Curved {
    /// The radius of the circle at `-half_height`, in metres.
    pub lower: f32,
    /// The radius of the circle at `half_height`, in metres.
    pub upper: f32,
    /// Half the distance between the circles, in metres; 0 makes it a disc.
    pub half_height: f32,
}

impl Curved {
    /// The cylinder of the given radius and half height in metres, which must be finite and not negative.
    pub fn cylinder(radius: f32, half_height: f32) -> Result<Self, ShapeError> {
        Self::frustum(radius, radius, half_height)
    }

    /// The cone with a base of the given radius at `-half_height` and its tip at `half_height`, in metres,
    /// which must be finite and not negative.
    pub fn cone(radius: f32, half_height: f32) -> Result<Self, ShapeError> {
        Self::frustum(radius, 0.0, half_height)
    }

    /// The frustum with the given radii of its lower and upper end, and half height, in metres, which must be
    /// finite and not negative.
    pub fn frustum(lower: f32, upper: f32, half_height: f32) -> Result<Self, ShapeError> {
        Ok(Self {
            lower: checked_length(lower)?,
            upper: checked_length(upper)?,
            half_height: checked_length(half_height)?,
        })
    }

    /// The frustum, or if it has no height, the disc of the larger circle, which contains the other.
    #[inline]
    pub(crate) fn with_equal_discs(&self) -> Self {
        let radius = max(self.lower, self.upper);
        if self.half_height > 0.0 { *self } else { Self { lower: radius, upper: radius, ..*self } }
    }

    /// The radius of an end: end 0 is the lower end, end 1 the upper.
    #[inline(always)]
    pub(crate) fn radius_of(&self, end: usize) -> f32 {
        if end == 0 { self.lower } else { self.upper }
    }

    /// The height of an end.
    #[inline(always)]
    pub(crate) fn height_of(&self, end: usize) -> f32 {
        if end == 0 { -self.half_height } else { self.half_height }
    }

    /// The components of the side's unit normal, away from the axis and along it. For a disc the normal
    /// points away from the axis.
    #[inline(always)]
    pub(crate) fn slope(&self) -> (f32, f32) {
        let (outward, upward) = (2.0 * self.half_height, self.lower - self.upper);
        let size = max(outward, upward.abs());
        if !(size > 0.0 && self.half_height > 0.0) {
            return (1.0, 0.0);
        }
        let (outward, upward) = (outward / size, upward / size);
        let length = (outward * outward + upward * upward).sqrt();
        (outward / length, upward / length)
    }

    /// The end that reaches farthest along a direction with the given parts across and along the axis.
    #[inline(always)]
    pub(crate) fn end_along(&self, across: f32, along: f32) -> usize {
        usize::from(
            self.upper * across + self.half_height * along > self.lower * across - self.half_height * along,
        )
    }

    /// The point farthest along `direction` (any length).
    #[inline]
    pub fn support(&self, direction: Vector) -> Vector {
        self.farthest(direction).0
    }

    /// The point farthest along a direction of any length, and its end.
    #[inline(always)]
    pub(crate) fn farthest(&self, direction: Vector) -> (Vector, usize) {
        let (x, z) = (direction.x, direction.z);
        let across = (x * x + z * z).sqrt();
        let end = self.end_along(across, direction.y);
        // A direction along the axis leaves the choice of the point.
        let (x, z) = if across > 1.0e-15 { (x / across, z / across) } else { (1.0, 0.0) };
        let radius = self.radius_of(end);
        (Vector { x: radius * x, y: self.height_of(end), z: radius * z }, end)
    }

    /// The box around the frustum turned by `rotation`.
    pub fn local_aabb(&self, rotation: Rot) -> Aabb {
        let axis = rotation.rotate(Vector::Y);
        let (u, v) = (rotation.rotate(Vector::X).to_array(), rotation.rotate(Vector::Z).to_array());
        let wide: [f32; 3] = core::array::from_fn(|i| (u[i] * u[i] + v[i] * v[i]).sqrt());
        let ends = [0, 1].map(|end| {
            let (center, half) = (axis * self.height_of(end), Vector::from_array(wide) * self.radius_of(end));
            (center - half, center + half)
        });
        Aabb::new(ends[0].0.min(ends[1].0), ends[0].1.max(ends[1].1))
    }

    /// The largest ball about the middle of the axis: its centre and its radius.
    pub(crate) fn core(&self) -> (Vector, f32) {
        let (outward, _) = self.slope();
        (Vector::ZERO, min(self.half_height, 0.5 * (self.lower + self.upper) * outward))
    }

    /// The distance from a point to the farthest point of the frustum.
    pub(crate) fn extent(&self, center: Vector) -> f32 {
        let across = (center.x * center.x + center.z * center.z).sqrt();
        let [lower, upper] = [0, 1].map(|end| {
            let (out, along) = (across + self.radius_of(end), self.height_of(end) - center.y);
            (out * out + along * along).sqrt()
        });
        max(lower, upper)
    }

    /// The hit of a ray along the unit vector `direction`; see
    /// [`Shape::cast_ray`](crate::shape::Shape::cast_ray).
    ///
    /// Between the planes of its ends, the frustum is the set of points within the radius m + k y of the
    /// axis, a quadratic inequality in the distance. The frustum is convex, so if two ranges satisfy the
    /// inequality, one of them is empty.
    pub fn cast_ray(
        &self,
        origin: Vector,
        direction: Vector,
        max_distance: f32,
        solid: bool,
    ) -> Option<RayHit> {
        let h = f64::from(self.half_height);
        // Computed from the nearest point of the line, so no large squares cancel.
        let start = -origin.dot(direction);
        let at = |v: f32, d: f32| f64::from(v) + f64::from(start) * f64::from(d);
        let o = [at(origin.x, direction.x), at(origin.y, direction.y), at(origin.z, direction.z)];
        let d = direction.to_array().map(f64::from);
        let (mut enter, mut exit) = (f64::NEG_INFINITY, f64::INFINITY);
        if d[1] != 0.0 {
            let (p, q) = ((-h - o[1]) / d[1], (h - o[1]) / d[1]);
            (enter, exit) = if p < q { (p, q) } else { (q, p) };
        } else if o[1].abs() > h {
            return None;
        }
        let slab = (enter, exit);
        let (middle, k) = self.profile();
        let (m, slope) = (middle + k * o[1], k * d[1]);
        let a = d[0] * d[0] + d[2] * d[2] - slope * slope;
        let b = o[0] * d[0] + o[2] * d[2] - m * slope;
        let c = o[0] * o[0] + o[2] * o[2] - m * m;
        let square = b * b - a * c;
        if a.abs() < 1.0e-12 {
            // The ray is parallel to the side.
            if b.abs() > 1.0e-12 {
                let t = -0.5 * c / b;
                (enter, exit) = if b > 0.0 { (enter, exit.min(t)) } else { (enter.max(t), exit) };
            } else if c > 0.0 {
                return None;
            }
        } else if square < 0.0 {
            if a > 0.0 {
                return None;
            }
        } else {
            let root = square.sqrt();
            let (p, q) = ((-b - root) / a, (-b + root) / a);
            if a > 0.0 {
                (enter, exit) = (enter.max(p), exit.min(q));
            } else if exit.min(q) - enter >= exit - enter.max(p) {
                // Inside before the first root and after the second, on both halves of the double cone.
                exit = exit.min(q);
            } else {
                enter = enter.max(p);
            }
        }
        let shift = |t: f64| (t + f64::from(start)) as f32;
        hit_of_stretch((shift(enter), shift(exit)), max_distance, solid, |entering, _| {
            let t = if entering { enter } else { exit };
            if t == if entering { slab.0 } else { slab.1 } {
                let outward = if (direction.y > 0.0) == entering { -1.0 } else { 1.0 };
                return Vector::Y * outward;
            }
            let [x, z] = [0, 2].map(|i| (o[i] + d[i] * t) as f32);
            let (out, up) = self.slope();
            let around = direction_or(Vector { x, y: 0.0, z }, Vector::ZERO);
            direction_or(around * out + Vector::Y * up, -direction)
        })
    }

    /// The radius at the height y as m + k y: m and k.
    fn profile(&self) -> (f64, f64) {
        let [lower, upper, h] = [self.lower, self.upper, self.half_height].map(f64::from);
        if h > 0.0 { (0.5 * (lower + upper), 0.5 * (upper - lower) / h) } else { (lower.max(upper), 0.0) }
    }

    /// Mass, centre and inertia at 1 kg/m³.
    ///
    /// With the radius m + d y/h for |y| ≤ h: V = 2πh (m² + d²/3), ∫ y dV = 4/3 π h² m d, ∫ y² dV = 2πh³
    /// (m²/3 + d²/5), and the moment about the axis is ½ π ∫ ρ⁴ dy = πh (m⁴ + 2 m² d² + d⁴/5). Values that
    /// overflow are infinite.
    pub fn unit_mass(&self) -> MassProperties {
        let (m, d, h) = (0.5 * (self.lower + self.upper), 0.5 * (self.upper - self.lower), self.half_height);
        let (mm, dd) = (m * m, d * d);
        let mass = 2.0 * PI * h * (mm + dd / 3.0);
        if !(mass > 0.0) {
            return MassProperties::ZERO;
        }
        let center = 4.0 / 3.0 * PI * h * h * m * d / mass;
        let axial = PI * h * (mm * mm + 2.0 * mm * dd + dd * dd / 5.0);
        if !(axial < f32::INFINITY && mass * h * h < f32::INFINITY) {
            return self.huge_unit_mass();
        }
        let along = 2.0 * PI * h * h * h * (mm / 3.0 + dd / 5.0) - mass * center * center;
        let across = 0.5 * axial + max(along, 0.0);
        let inertia = Inertia::from_diagonal(Vector { x: across, y: axial, z: across });
        MassProperties { mass, center: Vector::Y * center, inertia }
    }

    /// As [`unit_mass`](Self::unit_mass), for sizes whose products overflow: their quotients and differences
    /// would be NaN.
    fn huge_unit_mass(&self) -> MassProperties {
        let [lower, upper, h] = [self.lower, self.upper, self.half_height].map(f64::from);
        let (m, d, pi) = (0.5 * (lower + upper), 0.5 * (upper - lower), f64::from(PI));
        let (mm, dd) = (m * m, d * d);
        let mass = 2.0 * pi * h * (mm + dd / 3.0);
        let center = 4.0 / 3.0 * pi * h * h * m * d / mass;
        let axial = pi * h * (mm * mm + 2.0 * mm * dd + dd * dd / 5.0);
        let along = 2.0 * pi * h * h * h * (mm / 3.0 + dd / 5.0) - mass * center * center;
        let (across, axial) = ((0.5 * axial + along.max(0.0)) as f32, axial as f32);
        let inertia = Inertia::from_diagonal(Vector { x: across, y: axial, z: across });
        MassProperties { mass: mass as f32, center: Vector::Y * center as f32, inertia }
    }

    /// The place of the surface nearest to a point. The circles of a disc must be
    /// [equal](Self::with_equal_discs).
    ///
    /// The nearest point is in the plane through the axis, where the outline has three sides.
    pub(crate) fn nearest(&self, point: Vector) -> Nearest {
        let across = (point.x * point.x + point.z * point.z).sqrt();
        let size = max(max(self.lower, self.upper), self.half_height);
        // A point within rounding of the axis counts as on it.
        let around = if across > 1.0e-6 * size {
            Vector { x: point.x / across, y: 0.0, z: point.z / across }
        } else {
            Vector::X
        };
        let (h, (out, up)) = (self.half_height, self.slope());
        let over_side = (across - self.lower) * out + (point.y + h) * up;
        let heights = [-h - point.y, point.y - h, over_side];
        if heights.iter().all(|height| *height <= 0.0) {
            let [lower, upper, side] = heights;
            if side >= max(lower, upper) && !(across == 0.0 && out == 0.0) {
                return Nearest { distance: side, normal: around * out + Vector::Y * up, on_side: true };
            }
            let sign = if upper >= lower { 1.0 } else { -1.0 };
            return Nearest { distance: max(lower, upper), normal: Vector::Y * sign, on_side: false };
        }
        // The nearest of the three sides of the outline.
        let (dx, dy) = (self.upper - self.lower, 2.0 * h);
        let square = dx * dx + dy * dy;
        let t = if square > 0.0 { ((across - self.lower) * dx + (point.y + h) * dy) / square } else { 0.0 };
        let otherwise = around * out + Vector::Y * up;
        if over_side > 0.0 && t > 0.0 && t < 1.0 {
            return Nearest { distance: over_side, normal: otherwise, on_side: true };
        }
        let t = min(max(t, 0.0), 1.0);
        let nearest =
            [(min(across, self.lower), -h), (min(across, self.upper), h), (self.lower + dx * t, dy * t - h)];
        let mut best = (f32::INFINITY, 0);
        for (i, (x, y)) in nearest.into_iter().enumerate() {
            let square = (across - x) * (across - x) + (point.y - y) * (point.y - y);
            if square < best.0 {
                best = (square, i);
            }
        }
        let (x, y) = nearest[best.1];
        let distance = best.0.sqrt();
        let normal = direction_or(around * (across - x) + Vector::Y * (point.y - y), otherwise);
        Nearest { distance, normal, on_side: false }
    }
}

/// The place of a surface nearest to a point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Nearest {
    /// The distance of the point, negative inside.
    pub distance: f32,
    /// The unit normal.
    pub normal: Vector,
    /// Whether the place is on the side, off its edges.
    pub on_side: bool,
}

#[cfg(test)]
mod tests {
    use super::super::rays::{check_mass_by_rays, check_ray};
    use super::*;
    use crate::shape::Shape;
    use proptest::prelude::*;

    fn vector(range: f32) -> impl Strategy<Value = Vector> {
        [-range..range, -range..range, -range..range].prop_map(Vector::from_array)
    }

    fn frustum() -> impl Strategy<Value = Curved> {
        let radius = || prop_oneof![1 => Just(0.0f32), 4 => 0.05f32..1.5];
        (radius(), radius(), 0.05f32..1.5).prop_map(|(lower, upper, half_height)| Curved {
            lower,
            upper,
            half_height,
        })
    }

    #[test]
    fn frusta_weigh_what_rays_find() {
        for shape in [Curved::cylinder(0.7, 0.4), Curved::cone(0.8, 0.6), Curved::frustum(0.3, 0.9, 0.5)] {
            check_mass_by_rays(&Shape::Curved(shape.expect("good sizes")), 0.9);
        }
    }

    #[test]
    fn a_cylinder_and_a_cone_weigh_what_the_books_say() {
        let cylinder = Curved::cylinder(0.5, 1.0).expect("good sizes").unit_mass();
        assert!((cylinder.mass - 0.5 * PI).abs() < 1e-6 && cylinder.center == Vector::ZERO);
        assert!((cylinder.inertia.yy - 0.125 * cylinder.mass).abs() < 1e-6);
        assert!((cylinder.inertia.xx - (0.0625 + 1.0 / 3.0) * cylinder.mass).abs() < 1e-6);
        let cone = Curved::cone(0.5, 1.0).expect("good sizes").unit_mass();
        assert!((cone.mass - PI / 6.0).abs() < 1e-6 && (cone.center.y + 0.5).abs() < 1e-6);
        assert!((cone.inertia.yy - 0.3 * 0.25 * cone.mass).abs() < 1e-6);
        assert!((cone.inertia.xx - (0.15 * 0.25 + 0.0375 * 4.0) * cone.mass).abs() < 1e-6);
    }

    /// Regression: quotients and differences of overflowing products were NaN.
    #[test]
    fn issue_the_centre_of_a_huge_frustum_was_no_number() {
        for size in [1.0e7, 1.0e13, 1.0e18, f32::MAX] {
            let small = Curved::frustum(0.5, 1.0, 0.25).expect("good sizes").unit_mass();
            let large = Curved::frustum(0.5 * size, size, 0.25 * size).expect("good sizes").unit_mass();
            assert!(
                (large.center.y / size - small.center.y).abs() < 1e-6 && large.center.x == 0.0,
                "{large:?}"
            );
            let wanted =
                [small.mass * size * size * size, small.inertia.yy * size * size * size * size * size];
            for (found, wanted) in [large.mass, large.inertia.yy].into_iter().zip(wanted) {
                assert!(found == wanted || (found / wanted - 1.0).abs() < 1e-5, "{found} of {wanted}");
            }
            assert!(large.inertia.xx > 0.0 && large.inertia.xy == 0.0, "{large:?}");
        }
    }

    #[test]
    fn bad_sizes_are_refused() {
        assert_eq!(Curved::cylinder(f32::NAN, 1.0), Err(ShapeError::NotFinite));
        assert_eq!(Curved::cone(1.0, -1.0), Err(ShapeError::Negative));
        assert_eq!(Curved::cylinder(0.0, 0.0).map(|c| c.unit_mass()), Ok(MassProperties::ZERO));
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(5000))]

        #[test]
        fn rays_hit_frusta_where_their_normal_says(
            shape in frustum(), from in vector(4.0), to in vector(1.0), solid in any::<bool>(),
        ) {
            check_ray(&Shape::Curved(shape), from, to, solid)?;
        }

        #[test]
        fn boxes_and_extents_hold_all_points(shape in frustum(), center in vector(2.0), axis in vector(3.0)) {
            let rotation = Rot::IDENTITY.integrated(axis);
            let aabb = shape.local_aabb(rotation);
            for around in Vector::AXES {
                let high = rotation.rotate(shape.support(rotation.inverse_rotate(around))).dot(around);
                prop_assert!((aabb.max.dot(around) - high).abs() < 1e-5, "{:?} {high}", aabb);
            }
            let far = (shape.support(axis) - center).length();
            prop_assert!(far <= shape.extent(center) + 1e-5);
        }

        #[test]
        fn the_ball_within_touches(shape in frustum()) {
            let (center, radius) = shape.core();
            let depth = -shape.nearest(center).distance;
            prop_assert!((depth - radius).abs() < 1e-5, "{center:?} {radius} {depth}");
        }

        #[test]
        fn the_nearest_point_is_on_the_surface(shape in frustum(), point in vector(2.5)) {
            let nearest = shape.nearest(point);
            prop_assert!((nearest.normal.length() - 1.0).abs() < 1e-4);
            let foot = point - nearest.normal * nearest.distance;
            let height = shape.support(nearest.normal).dot(nearest.normal);
            prop_assert!((height - foot.dot(nearest.normal)).abs() < 1e-4, "{nearest:?}");
            // A ray from outside toward the nearest point goes no farther than the distance.
            if nearest.distance > 0.01 {
                let hit = shape.cast_ray(point, -nearest.normal, nearest.distance + 0.01, false);
                prop_assert!(hit.is_none_or(|hit| (hit.distance - nearest.distance).abs() < 5e-3));
            }
        }
    }
}
