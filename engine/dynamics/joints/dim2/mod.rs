//! The kinds of joints in 2D, and 2D methods of limits and bases. `dim3` exports the same names.

mod gear;
mod rack_and_pinion;
mod revolute;
mod wheel;

pub use gear::GearJoint;
pub use rack_and_pinion::RackAndPinionJoint;
pub use revolute::RevoluteJoint;
pub use wheel::WheelJoint;

use super::{
    distance::DistanceJoint, fixed::FixedJoint, frame::JointBasis, generic::GenericJoint, kinds::joint_kinds,
    limits::AngleLimit, mouse::MouseJoint, prismatic::PrismaticJoint, pulley::PulleyJoint,
};
use crate::math::{Scalar, Vector, orthonormal_basis_from_vec};

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
}

impl JointBasis {
    /// The basis with its x axis along a vector on the body. The vector's length does not matter.
    pub fn from_local_x(x_axis: Vector) -> Self {
        Self::Local(orthonormal_basis_from_vec(x_axis))
    }

    /// The basis with its y axis along a vector on the body. The vector's length does not matter.
    pub fn from_local_y(y_axis: Vector) -> Self {
        Self::from_local_x(-y_axis.perp())
    }

    /// The basis with its x axis along a vector in the world. The vector's length does not matter.
    pub fn from_global_x(x_axis: Vector) -> Self {
        Self::FromGlobal(orthonormal_basis_from_vec(x_axis))
    }

    /// The basis with its y axis along a vector in the world. The vector's length does not matter.
    pub fn from_global_y(y_axis: Vector) -> Self {
        Self::from_global_x(-y_axis.perp())
    }
}

impl AngleLimit {
    /// The angle in radians by which the second body must turn to satisfy the limits, at most
    /// `max_correction`. `None` within the limits.
    pub fn compute_correction(&self, angle_difference: Scalar, max_correction: Scalar) -> Option<Scalar> {
        let excess = self.excess(angle_difference);
        (excess != 0.0).then(|| (-excess).max(-max_correction).min(max_correction))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::joints::{
        motor::AngularMotor,
        space::TRANSLATIONS,
        tests::{define, entities, is_locked},
    };
    use kernel::solver::{Axis, coordinate::ANGLE};

    #[test]
    fn bases_have_the_axes_that_they_are_made_of() {
        let axis = Vector::new(0.6, 0.8);
        let basis = |basis: JointBasis| basis.local().expect("it is local");
        assert!((basis(JointBasis::from_local_x(axis * 3.0)) * Vector::X - axis).length() < 1e-6);
        assert!((basis(JointBasis::from_local_y(axis * 3.0)) * Vector::Y - axis).length() < 1e-6);
    }

    #[test]
    fn a_revolute_joint_leaves_the_angle() {
        let [a, b] = entities();
        let joint = RevoluteJoint::new(a, b).with_angle_limits(-1.0, 2.0).with_point_compliance(0.5);
        let def = define(&joint.with_motor(AngularMotor::default().with_max_torque(3.0)));
        assert!(TRANSLATIONS.iter().all(|i| is_locked(def.axes[*i], 0.5)));
        assert_eq!(def.axes[ANGLE].limits, Some([-1.0, 2.0]));
        assert_eq!(def.axes[ANGLE].motor.map(|motor| motor.max_force), Some(3.0));
        assert_eq!(define(&RevoluteJoint::new(a, b)).axes[ANGLE], Axis::FREE);
    }

    #[test]
    fn an_angle_is_led_back() {
        let limit = AngleLimit::new(-0.5, 1.0);
        assert_eq!(limit.compute_correction(0.0, 1.0), None);
        assert_eq!(limit.compute_correction(1.5, 1.0), Some(-0.5));
        assert_eq!(limit.compute_correction(-1.5, 0.25), Some(0.25));
    }
}
