//! The ellipse.

use super::MassProperties;
use crate::math::{Rot, Vector, max};
use crate::shape::primitives::{direction_or, hit_of_stretch};
use crate::shape::{Aabb, RayHit, ShapeError};
use core::f32::consts::PI;

/// An ellipse around the origin along the axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Curved {
    /// Half the size along each axis, in metres; 0 makes it flat.
    pub half: Vector,
}

impl Curved {
    /// The ellipse of the given half sizes in metres, which must be finite and not negative.
    pub fn ellipse(half: Vector) -> Result<Self, ShapeError> {
        if !half.is_finite() {
            return Err(ShapeError::NotFinite);
        }
        if half.min_element() < 0.0 { Err(ShapeError::Negative) } else { Ok(Self { half }) }
    }

    /// The point farthest along `direction` (any length): h² d / |h d| for the half sizes h.
    #[inline]
    pub fn support(&self, direction: Vector) -> Vector {
        direction_or(direction.scale(self.half), Vector::X).scale(self.half)
    }

    /// The box around the ellipse turned by `rotation`.
    pub fn local_aabb(&self, rotation: Rot) -> Aabb {
        let [x, y] = Vector::AXES.map(|axis| rotation.inverse_rotate(axis).scale(self.half).length());
        let half = Vector { x, y };
        Aabb::new(-half, half)
    }

    /// The largest ball within the ellipse: its centre and its radius.
    pub(crate) fn core(&self) -> (Vector, f32) {
        (Vector::ZERO, self.half.min_element())
    }

    /// The distance from a point to the farthest point of the ellipse, or somewhat more.
    pub(crate) fn extent(&self, center: Vector) -> f32 {
        center.length() + self.half.max_element()
    }

    /// The radius of curvature where the outward normal has the given direction, at most four times the
    /// larger half size.
    pub(crate) fn curvature_radius(&self, normal: Vector) -> f32 {
        let (a, b) = (self.half.x, self.half.y);
        let most = 4.0 * max(a, b);
        let reach = normal.scale(self.half).length();
        let radius = (a / reach) * (b / reach) * (a * b / reach);
        if radius < most { radius } else { most }
    }

    /// The hit of a ray along the unit vector `direction`; see
    /// [`Shape::cast_ray`](crate::shape::Shape::cast_ray). A flat ellipse is not hit.
    ///
    /// The ellipse is scaled to the unit circle along both axes.
    pub fn cast_ray(
        &self,
        origin: Vector,
        direction: Vector,
        max_distance: f32,
        solid: bool,
    ) -> Option<RayHit> {
        if !(self.half.min_element() > 0.0) {
            return None;
        }
        let scaled =
            |v: Vector| [f64::from(v.x) / f64::from(self.half.x), f64::from(v.y) / f64::from(self.half.y)];
        let (o, d) = (scaled(origin), scaled(direction));
        let square = d[0] * d[0] + d[1] * d[1];
        let nearest = -(o[0] * d[0] + o[1] * d[1]) / square;
        let off = [o[0] + d[0] * nearest, o[1] + d[1] * nearest];
        let rest = 1.0 - off[0] * off[0] - off[1] * off[1];
        if !(rest >= 0.0) {
            return None;
        }
        let half = (rest / square).sqrt();
        let stretch = ((nearest - half) as f32, (nearest + half) as f32);
        hit_of_stretch(stretch, max_distance, solid, |entering, _| {
            let t = if entering { nearest - half } else { nearest + half };
            let x = (o[0] + d[0] * t) / f64::from(self.half.x);
            let y = (o[1] + d[1] * t) / f64::from(self.half.y);
            let size = x.abs().max(y.abs());
            direction_or(Vector { x: (x / size) as f32, y: (y / size) as f32 }, -direction)
        })
    }

    /// The mass properties at 1 kg/m²: m = π a b, I = m (a² + b²) / 4.
    pub fn unit_mass(&self) -> MassProperties {
        let mass = PI * self.half.x * self.half.y;
        MassProperties { mass, center: Vector::ZERO, inertia: 0.25 * mass * self.half.length_squared() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn vector(range: f32) -> impl Strategy<Value = Vector> {
        [-range..range, -range..range].prop_map(Vector::from_array)
    }

    fn ellipse() -> impl Strategy<Value = Curved> {
        [0.05f32..2.0, 0.05..2.0].prop_map(|half| Curved { half: Vector::from_array(half) })
    }

    #[test]
    fn bad_sizes_are_refused() {
        assert_eq!(Curved::ellipse(Vector { x: f32::NAN, y: 1.0 }), Err(ShapeError::NotFinite));
        assert_eq!(Curved::ellipse(Vector { x: 1.0, y: -1.0 }), Err(ShapeError::Negative));
        let flat = Curved::ellipse(Vector::X).expect("flat is good");
        assert_eq!((flat.unit_mass().mass, flat.support(Vector::X)), (0.0, Vector::X));
    }

    #[test]
    fn a_circle_is_a_circle() {
        let circle = Curved { half: Vector::ONE * 0.5 };
        let ball = crate::shape::Shape::Ball(crate::shape::Ball { radius: 0.5 }).mass_properties(1.0);
        let mass = circle.unit_mass();
        assert!((mass.mass - ball.mass).abs() < 1e-6 && (mass.inertia - ball.inertia).abs() < 1e-6);
        assert!((circle.curvature_radius(Vector::Y) - 0.5).abs() < 1e-6);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(5000))]

        #[test]
        fn rays_hit_ellipses_where_their_normal_says(
            shape in ellipse(), from in vector(4.0), to in vector(1.0), solid in any::<bool>(),
        ) {
            prop_assume!((to - from).length() > 0.1);
            let line = (to - from) * (1.0 / (to - from).length());
            if let Some(hit) = shape.cast_ray(from, line, 20.0, solid).filter(|hit| hit.distance > 0.0) {
                let at = from + line * hit.distance;
                prop_assert!((hit.normal.length() - 1.0).abs() < 1e-4);
                let farthest = shape.support(hit.normal).dot(hit.normal);
                prop_assert!((farthest - at.dot(hit.normal)).abs() < 2e-3, "{farthest}");
            }
        }

        #[test]
        fn boxes_hold_all_points(shape in ellipse(), angle in -3.0f32..3.0, center in vector(2.0)) {
            let rotation = Rot::from_angle(angle);
            let aabb = shape.local_aabb(rotation);
            for around in Vector::AXES {
                let high = rotation.rotate(shape.support(rotation.inverse_rotate(around))).dot(around);
                prop_assert!((aabb.max.dot(around) - high).abs() < 1e-5, "{:?} {high}", aabb);
            }
            prop_assert!((shape.support(center) - center).length() <= shape.extent(center) + 1e-5);
        }

        #[test]
        fn the_radius_of_curvature_is_that_of_three_points(shape in ellipse(), angle in -3.0f32..3.0) {
            let at = |a: f32| Vector { x: a.cos(), y: a.sin() };
            let [p, q] = [-0.01, 0.01].map(|d| shape.support(at(angle + d)));
            // Points whose normals differ by dα are ρ dα apart.
            let radius = (q - p).length() / 0.02;
            let most = 4.0 * shape.half.max_element();
            let expected = radius.min(most);
            let got = shape.curvature_radius(at(angle));
            prop_assert!((got - expected).abs() < 0.1 * expected, "{got} {expected}");
        }
    }
}
