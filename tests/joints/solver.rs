//! How joints are solved is a setting, and counts in both forms of a substep.

use super::*;
use avian::prelude::SubstepSchedule;

/// How far a beam of eight welded metres sags with 100 kg at its tip, in m.
fn sag(solver: JointSolver, by_schedule: bool) -> Scalar {
    let mut rig = Rig::new();
    rig.app.insert_resource(solver).insert_resource(SubstepCount(4));
    if by_schedule {
        rig.app.add_systems(SubstepSchedule, || {});
    }
    let mut last = rig.post(0.0, 0.0);
    for i in 0..8 {
        let link = rig.rod(0.5 + Scalar::from(i as u8), 0.0);
        rig.spawn(FixedJoint::new(last, link).with_anchor(xy(Scalar::from(i as u8), 0.0)));
        last = link;
    }
    rig.insert(last, Mass(100.0));
    rig.steps(256);
    (rig.place(last) - xy(7.5, 0.0)).length()
}

#[test]
fn a_beam_sags_by_the_solver_that_was_chosen() {
    for by_schedule in [false, true] {
        let [rows, auto, rigid] =
            [JointSolver::Rows, JointSolver::Auto, JointSolver::Rigid].map(|solver| sag(solver, by_schedule));
        assert!(
            rigid < 1e-3 && rigid < auto && auto < 0.5 && auto < 0.5 * rows,
            "{rows} m, {auto} m, {rigid} m"
        );
    }
}
