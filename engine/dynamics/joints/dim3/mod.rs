//! The kinds of joints in 3D, and 3D methods of limits and bases. `dim2` exports the same names.

mod gear;
mod rack_and_pinion;
mod revolute;
mod spherical;
mod spherical_motor;
mod wheel;

pub use gear::GearJoint;
pub use rack_and_pinion::RackAndPinionJoint;
pub use revolute::RevoluteJoint;
pub use spherical::SphericalJoint;
pub use spherical_motor::{AngularDrive, SphericalDrive, SphericalMotor};
pub use wheel::WheelJoint;

use super::{
    distance::DistanceJoint, fixed::FixedJoint, frame::JointBasis, generic::GenericJoint, kinds::joint_kinds,
    limits::AngleLimit, mouse::MouseJoint, prismatic::PrismaticJoint, pulley::PulleyJoint,
};
use crate::math::{Quaternion, Scalar, Vector, orthonormal_basis};

joint_kinds! {
    fixed: FixedJoint,
    distance: DistanceJoint,
    prismatic: PrismaticJoint,
    revolute: RevoluteJoint,
    generic: GenericJoint,
    mouse: MouseJoint,
    wheel: WheelJoint,
    gear: GearJoint,
    rack: RackAndPinionJoint,
    pulley: PulleyJoint,
    spherical: SphericalJoint,
}

/// Defines constructors of bases from two axes. The first axis keeps its direction.
macro_rules! from_axes {
    ($($local:ident, $global:ident: $first:literal, $second:literal => |$a:ident, $b:ident, $c:ident| $axes:expr;)+) => {
        impl JointBasis {$(
            #[doc = concat!("The basis on the body whose ", $first, " axis has the direction of the first vector, and whose ")]
            #[doc = concat!($second, " axis is in the plane of both. They may have any length. Vectors that span no plane give ")]
            #[doc = "the identity."]
            pub fn $local($a: Vector, $b: Vector) -> Self {
                Self::Local(from_plane($a, $b, |$a, $b, $c| $axes))
            }

            #[doc = concat!("The basis in the world whose ", $first, " axis has the direction of the first vector, and whose ")]
            #[doc = concat!($second, " axis is in the plane of both. They may have any length. Vectors that span no plane give ")]
            #[doc = "the identity."]
            pub fn $global($a: Vector, $b: Vector) -> Self {
                Self::FromGlobal(from_plane($a, $b, |$a, $b, $c| $axes))
            }
        )+}
    };
}

from_axes! {
    from_local_xy, from_global_xy: "x", "y" => |x_axis, y_axis, z_axis| [x_axis, y_axis, z_axis];
    from_local_xz, from_global_xz: "x", "z" => |x_axis, z_axis, y_axis| [x_axis, -y_axis, z_axis];
    from_local_yz, from_global_yz: "y", "z" => |y_axis, z_axis, x_axis| [x_axis, y_axis, z_axis];
}

/// The rotation to the axes along the first vector, along the component of the second perpendicular to it,
/// and along the normal of both.
fn from_plane(
    first: Vector,
    second: Vector,
    axes: impl Fn(Vector, Vector, Vector) -> [Vector; 3],
) -> Quaternion {
    let along = first.try_normalize();
    let normal = along.and_then(|along| along.cross(second).try_normalize());
    match (along, normal) {
        (Some(along), Some(normal)) => orthonormal_basis(axes(along, normal.cross(along), normal)),
        _ => Quaternion::IDENTITY,
    }
}

impl AngleLimit {
    /// The rotation vector in radians by which the second body must turn to satisfy the limits, at most
    /// `max_correction` long. `None` within the limits.
    ///
    /// The angle is measured from `axis1` to `axis2` about `limit_axis`. All three have unit length.
    pub fn compute_correction(
        &self,
        limit_axis: Vector,
        axis1: Vector,
        axis2: Vector,
        max_correction: Scalar,
    ) -> Option<Vector> {
        let sin = axis1.cross(axis2).dot(limit_axis);
        let cos = axis1.dot(axis2);
        #[allow(clippy::useless_conversion, clippy::unnecessary_cast, reason = "Scalar may be f64")]
        let angle = kernel::math::atan2(f64::from(sin), f64::from(cos)) as Scalar;
        let excess = self.excess(angle);
        (excess != 0.0).then(|| limit_axis * (-excess).max(-max_correction).min(max_correction))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        dynamics::joints::{
            motor::AngularMotor,
            space::TRANSLATIONS,
            tests::{define, entities, is_locked},
        },
        math::vector_to_kernel,
    };
    use kernel::{
        math::Vector as KernelVector,
        solver::{
            Axis, Give, JointFrame,
            coordinate::{CONE, SWING_Y, SWING_Z, TWIST},
        },
    };

    #[test]
    fn bases_have_the_axes_that_they_are_made_of() {
        let (a, b) = (Vector::new(1.0, 2.0, 3.0), Vector::new(-2.0, 0.5, 1.0));
        let (first, second) = (a.normalize(), b.reject_from(a).normalize());
        let is = |basis: JointBasis, one: Vector, other: Vector| {
            let basis = basis.local().expect("it is local");
            let apart = (basis * one - first).length() + (basis * other - second).length();
            assert!(apart < 1e-5 && (basis.length() - 1.0).abs() < 1e-5, "{apart}");
        };
        is(JointBasis::from_local_xy(a, b), Vector::X, Vector::Y);
        is(JointBasis::from_local_xz(a, b), Vector::X, Vector::Z);
        is(JointBasis::from_local_yz(a, b), Vector::Y, Vector::Z);
    }

    /// Whether the x axis of a kernel frame equals `axis`.
    fn has_x(frame: &JointFrame, axis: Vector) -> bool {
        (frame.basis.rotate(KernelVector::X) - vector_to_kernel(axis.normalize())).length() < 1e-6
    }

    #[test]
    fn a_revolute_joint_turns_about_the_x_axis_of_its_turned_frames() {
        let [a, b] = entities();
        let axis = Vector::new(1.0, 2.0, -2.0);
        let joint = RevoluteJoint::new(a, b)
            .with_hinge_axis(axis)
            .with_local_basis1(Quaternion::from_rotation_y(1.0))
            .with_angle_limits(-1.0, 2.0)
            .with_point_compliance(0.5)
            .with_align_compliance(0.25)
            .with_motor(AngularMotor::default().with_max_torque(3.0));
        let def = define(&joint);
        assert!(has_x(&def.frames[0], joint.local_hinge_axis1().expect("it is local")));
        assert!(has_x(&def.frames[1], axis));
        assert!(TRANSLATIONS.iter().all(|i| is_locked(def.axes[*i], 0.5)));
        assert!([SWING_Y, SWING_Z].iter().all(|i| is_locked(def.axes[*i], 0.25)));
        assert_eq!(def.axes[TWIST].limits, Some([-1.0, 2.0]));
        assert_eq!(def.axes[TWIST].motor.map(|motor| motor.max_force), Some(3.0));
        assert_eq!(define(&RevoluteJoint::new(a, b)).axes[TWIST], Axis::FREE);
    }

    #[test]
    fn a_spherical_joint_limits_swing_and_twist() {
        let [a, b] = entities();
        let joint = SphericalJoint::new(a, b).with_swing_limits(0.0, 1.0).with_twist_limits(-0.5, 0.5);
        let def = define(&joint.with_swing_compliance(0.25).with_twist_compliance(0.125));
        assert!(has_x(&def.frames[0], Vector::Y) && has_x(&def.frames[1], Vector::Y));
        assert_eq!(def.axes[CONE], Axis::limited(0.0, 1.0).with_give(Give::Compliance(0.25)));
        assert_eq!(def.axes[TWIST], Axis::limited(-0.5, 0.5).with_give(Give::Compliance(0.125)));
        let stiff = define(&SphericalJoint::new(a, b).with_swing_limits(0.0, 0.0));
        assert!([SWING_Y, SWING_Z].iter().all(|i| is_locked(stiff.axes[*i], 0.0)));
        assert_eq!((stiff.axes[CONE], stiff.axes[TWIST]), (Axis::FREE, Axis::FREE));
    }

    #[test]
    fn an_axis_without_direction_is_not_finite() {
        let [a, b] = entities();
        for axis in [Vector::ZERO, Vector::NAN] {
            let def = define(&RevoluteJoint::new(a, b).with_hinge_axis(axis));
            assert!(!def.frames[0].basis.is_finite());
        }
    }

    #[test]
    fn an_angle_is_led_back() {
        let limit = AngleLimit::new(-0.5, 1.0);
        let correct = |axis2, max| limit.compute_correction(Vector::Z, Vector::X, axis2, max);
        assert_eq!(correct(Vector::X, 1.0), None);
        let way = correct(Vector::Y, 1.0).expect("a quarter turn is too much");
        assert!((way.z - (1.0 - crate::math::FRAC_PI_2)).abs() < 1e-6 && way.x == 0.0, "{way}");
        assert_eq!(correct(Vector::NEG_Y, 0.25), Some(Vector::Z * 0.25));
    }
}
