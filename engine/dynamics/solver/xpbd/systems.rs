//! The systems that solve constraints of one type.

use bevy_ecs::{component::Mutable, prelude::*};
use bevy_time::Time;

use super::{XpbdConstraint, XpbdConstraintSolverData, links::Links};
use crate::{
    dynamics::{
        joints::{EntityConstraint, JointDisabled},
        rigid_body::{RigidBody, RigidBodyDisabled, RigidBodyQueryReadOnly},
        solver::{
            SolverConfig,
            solver_body::{SolverBody, SolverBodyInertia},
        },
    },
    math::{AdjustPrecision, Scalar},
};

/// Bodies in the simulation.
type Known<'w, 's> = Query<'w, 's, (), (With<RigidBody>, Without<RigidBodyDisabled>)>;

/// The states of awake bodies.
type States<'w, 's> =
    Query<'w, 's, (&'static mut SolverBody, &'static SolverBodyInertia), Without<RigidBodyDisabled>>;

/// Prepares the constraints of a type for a step. Add it to
/// [`SolverSystems::PrepareJoints`](crate::dynamics::solver::schedule::SolverSystems::PrepareJoints) of
/// [`PhysicsSchedule`](crate::schedule::PhysicsSchedule).
///
/// Constraints with [`JointDisabled`], and constraints between entities that are not simulated bodies, are
/// skipped. Bodies with a common constraint are in one island from the next step on.
pub fn prepare_xpbd_joint<C: Component<Mutability = Mutable> + EntityConstraint<2> + XpbdConstraint<2>>(
    bodies: Query<RigidBodyQueryReadOnly, Without<RigidBodyDisabled>>,
    mut joints: Query<(Entity, &mut C, &mut C::SolverData), Without<JointDisabled>>,
    links: Option<Res<Links>>,
    mut number: Local<Option<u32>>,
) where
    C::SolverData: Component<Mutability = Mutable>,
{
    for (entity, mut joint, mut data) in &mut joints {
        let ends = joint.entities();
        let [a, b] = ends;
        let Ok([a, b]) = bodies.get_many([a, b]) else { continue };
        if ends[0] == ends[1] {
            continue;
        }
        joint.prepare([&a, &b], &mut data);
        if let Some(links) = &links {
            let number = *number.get_or_insert_with(|| links.next_number());
            links.want(number, entity, ends);
        }
    }
}

/// Solves the constraints of a type in a substep. Add it to
/// [`XpbdSolverSystems::SolveUserConstraints`](super::XpbdSolverSystems::SolveUserConstraints) of
/// [`SubstepSchedule`](crate::dynamics::solver::schedule::SubstepSchedule).
///
/// Constraints are solved one after the other. Of two bodies with different
/// [`Dominance`](crate::dynamics::rigid_body::Dominance), only the body with the lower value moves.
pub fn solve_xpbd_joint<C: Component<Mutability = Mutable> + EntityConstraint<2> + XpbdConstraint<2>>(
    mut bodies: States,
    known: Known,
    mut joints: Query<(&mut C, &mut C::SolverData), Without<JointDisabled>>,
    time: Res<Time>,
) where
    C::SolverData: Component<Mutability = Mutable>,
{
    let dt = time.delta_secs().adjust_precision();
    if dt == 0.0 {
        return;
    }
    for (mut joint, mut data) in &mut joints {
        let ends = joint.entities();
        with_bodies(ends, &mut bodies, &known, |states, inertias| {
            data.clear_lagrange_multipliers();
            joint.solve(states, inertias, &mut data, dt);
        });
    }
}

/// Applies the motor impulses of a type of constraints from the last substep. Add it to
/// [`SubstepSolverSystems::WarmStart`](crate::dynamics::solver::schedule::SubstepSolverSystems::WarmStart) of
/// [`SubstepSchedule`](crate::dynamics::solver::schedule::SubstepSchedule).
pub fn warm_start_xpbd_motors<C: Component<Mutability = Mutable> + EntityConstraint<2> + XpbdConstraint<2>>(
    mut bodies: States,
    known: Known,
    mut joints: Query<(&C, &mut C::SolverData), Without<JointDisabled>>,
    time: Res<Time>,
    solver_config: Res<SolverConfig>,
) where
    C::SolverData: Component<Mutability = Mutable>,
{
    let dt = time.delta_secs().adjust_precision();
    let coefficient: Scalar = solver_config.warm_start_coefficient;
    for (joint, mut data) in &mut joints {
        with_bodies(joint.entities(), &mut bodies, &known, |states, inertias| {
            joint.warm_start_motors(states, inertias, &mut data, dt, coefficient);
        });
    }
}

/// Calls a function with the states of two bodies if at least one body is awake.
fn with_bodies(
    [a, b]: [Entity; 2],
    bodies: &mut States,
    known: &Known,
    f: impl FnOnce([&mut SolverBody; 2], [&SolverBodyInertia; 2]),
) {
    if a == b || !known.contains(a) || !known.contains(b) {
        return;
    }
    let (mut rest, at_rest) = (SolverBody::DUMMY, &SolverBodyInertia::DUMMY);
    if let Ok([(mut state1, inertia1), (mut state2, inertia2)]) = bodies.get_many_mut([a, b]) {
        let [above1, above2] =
            [inertia1.dominance() > inertia2.dominance(), inertia2.dominance() > inertia1.dominance()];
        let inertias = [if above1 { at_rest } else { inertia1 }, if above2 { at_rest } else { inertia2 }];
        f([&mut state1, &mut state2], inertias);
    } else if let Ok((mut state, inertia)) = bodies.get_mut(a) {
        f([&mut state, &mut rest], [inertia, at_rest]);
    } else if let Ok((mut state, inertia)) = bodies.get_mut(b) {
        f([&mut rest, &mut state], [at_rest, inertia]);
    }
}
