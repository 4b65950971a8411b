//! 2D parts of the tests of constraints: angles are numbers.
#![allow(clippy::unnecessary_cast, reason = "Scalar may be f32 or f64")]

use avian::{
    dynamics::{
        joints::EntityConstraint,
        solver::{
            solver_body::{SolverBody, SolverBodyInertia},
            xpbd::*,
        },
    },
    math::Scalar,
    prelude::*,
};
use bevy_ecs::{entity::MapEntities, prelude::*};

/// Keeps two bodies at one angle.
#[derive(Component, MapEntities)]
#[require(AlignData)]
pub struct Align(#[entities] pub [Entity; 2]);

/// The rotations at the start of the step, and the multiplier.
#[derive(Component, Default)]
pub struct AlignData([Rotation; 2], Scalar);

impl XpbdConstraintSolverData for AlignData {
    fn clear_lagrange_multipliers(&mut self) {
        self.1 = 0.0;
    }
}

impl EntityConstraint<2> for Align {
    fn entities(&self) -> [Entity; 2] {
        self.0
    }
}

impl AngularConstraint for Align {}

impl XpbdConstraint<2> for Align {
    type SolverData = AlignData;

    fn prepare(&mut self, bodies: [&RigidBodyQueryReadOnlyItem; 2], data: &mut AlignData) {
        data.0 = bodies.map(|body| *body.rotation);
    }

    fn solve(
        &mut self,
        [a, b]: [&mut SolverBody; 2],
        inertias: [&SolverBodyInertia; 2],
        data: &mut AlignData,
        dt: Scalar,
    ) {
        let [from_a, from_b] = data.0;
        let angle = ((a.delta_rotation * from_a) * (b.delta_rotation * from_b).inverse()).as_radians();
        let [ia, ib] = inertias.map(SolverBodyInertia::effective_inv_angular_inertia);
        data.1 += self.align_orientation(a, b, ia, ib, angle, data.1, 0.0, dt);
    }
}

#[test]
fn an_angular_impulse_turns_by_its_inertia() {
    let weld = Align([Entity::PLACEHOLDER; 2]);
    let (mut a, mut b) = (SolverBody::default(), SolverBody::default());
    weld.apply_angular_impulse(&mut a, &mut b, 2.0, 1.0, 0.1);
    assert!((a.delta_rotation.as_radians() - 0.2).abs() < 1e-6);
    assert!((b.delta_rotation.as_radians() + 0.1).abs() < 1e-6);
    assert!((weld.compute_torque(0.5, 0.1) - 50.0).abs() < 1e-3);
}
