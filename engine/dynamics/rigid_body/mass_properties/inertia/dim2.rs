//! Inertia in 2D, and frames. `dim3.rs` exports the same names.

use bevy_math::{DMat2, DVec2, Vec2};
use bevy_transform::prelude::Transform;

use super::frame::{HUGE, Matrix64, PartFrame, Vector64, narrow, sanitize};
use crate::{
    collision::collider::collider_transform::ColliderTransform,
    dynamics::rigid_body::mass_properties::components::{AngularInertia, ComputedAngularInertia},
    math::{MassProperties, Scalar},
};

/// An angular inertia in kg·m².
#[derive(Clone, Copy, Debug)]
pub(in super::super) struct Inertia(pub(in super::super) f64);

impl Inertia {
    /// No inertia.
    pub(in super::super) const ZERO: Self = Self(0.0);

    pub(super) fn from_properties(properties: &MassProperties) -> Self {
        Self(sanitize(properties.angular_inertia))
    }

    pub(in super::super) fn from_component(inertia: &AngularInertia) -> Self {
        Self(sanitize(inertia.0))
    }

    pub(super) fn scaled(self, factor: f64) -> Self {
        Self((self.0 * factor).min(HUGE))
    }

    /// The inertia in rotated axes. In 2D it is unchanged.
    pub(in super::super) fn rotated(self, _rotation: Matrix64) -> Self {
        self
    }

    /// The inertia about a point at an offset from the centre of mass: I + m d².
    pub(in super::super) fn shifted(self, mass: f64, offset: Vector64) -> Self {
        Self(self.0 + mass * offset.length_squared())
    }

    pub(super) fn plus(self, other: Self) -> Self {
        Self(self.0 + other.0)
    }

    /// The inertia for the solver. Infinite if zero or beyond the range of `f32`.
    pub(in super::super) fn computed(self) -> ComputedAngularInertia {
        if self.0 > 0.0 && self.0 < f64::from(f32::MAX) {
            ComputedAngularInertia::new(self.0 as Scalar)
        } else {
            ComputedAngularInertia::INFINITY
        }
    }
}

pub(super) fn widen_vector(v: Vec2) -> Vector64 {
    v.as_dvec2()
}

pub(super) fn narrow_vector(v: Vector64) -> Vec2 {
    v.as_vec2()
}

pub(super) fn mass_properties(mass: f32, center: Vec2, inertia: Inertia) -> MassProperties {
    MassProperties::new(mass, narrow(inertia.0), center)
}

impl PartFrame {
    /// The frame of a collider in its body's frame. The collider's mass properties already include its scale.
    pub(in super::super) fn of_collider(transform: &ColliderTransform) -> Self {
        let (cos, sin) = (transform.rotation.cos as f64, transform.rotation.sin as f64);
        Self {
            translation: DVec2::new(transform.translation.x as f64, transform.translation.y as f64),
            rotation: DMat2::from_cols_array(&[cos, sin, -sin, cos]),
            scale: DVec2::ONE,
        }
    }

    /// A frame with the scale of an entity's `transform`.
    pub(in super::super) fn scaled_by(transform: &Transform) -> Self {
        let scale = transform.scale.truncate().as_dvec2();
        Self { translation: DVec2::ZERO, rotation: DMat2::IDENTITY, scale }
    }

    /// The frame of an entity in its parent's frame. Only the rotation about z is used.
    pub(in super::super) fn of_entity(transform: &Transform) -> Self {
        let (z, w) = (f64::from(transform.rotation.z), f64::from(transform.rotation.w));
        let square = z * z + w * w;
        let (cos, sin) =
            if square > 0.0 { ((w * w - z * z) / square, 2.0 * w * z / square) } else { (1.0, 0.0) };
        Self {
            translation: transform.translation.truncate().as_dvec2(),
            rotation: DMat2::from_cols_array(&[cos, sin, -sin, cos]),
            scale: transform.scale.truncate().as_dvec2(),
        }
    }
}
