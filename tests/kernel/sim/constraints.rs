//! Joints, couplings and custom constraints of a simulation.

use super::super::units;
use super::Sim;
use crate::kernel;
use kernel::contact::ContactManager;
use kernel::solver::{
    CouplingDef, CustomConstraint, CustomError, CustomTable, JointDef, JointError, JointGap, JointReaction,
    JointTable,
};

impl Sim {
    /// Adds a joint.
    pub fn join(&mut self, def: JointDef) -> Result<u32, JointError> {
        let def = units::scaled_joint(&def, self.unit);
        self.with_joints(|joints, manager| joints.add(manager, def))
    }

    /// Changes a joint.
    pub fn rejoin(&mut self, id: u32, def: JointDef) -> Result<(), JointError> {
        let def = units::scaled_joint(&def, self.unit);
        self.with_joints(|joints, manager| joints.set(manager, id, def))
    }

    /// Removes a joint.
    pub fn part(&mut self, id: u32) -> Result<(), JointError> {
        self.with_joints(|joints, manager| joints.remove(manager, id))
    }

    fn with_joints<R>(&mut self, f: impl FnOnce(&mut JointTable, &mut ContactManager) -> R) -> R {
        let mut joints = core::mem::take(&mut self.solver.joints);
        let result = f(&mut joints, &mut self.contact_manager());
        self.solver.joints = joints;
        result
    }

    /// Adds a coupling.
    pub fn couple(&mut self, def: CouplingDef) -> Result<u32, JointError> {
        let def = units::scaled_coupling(&def, self.unit);
        self.with_joints(|joints, manager| joints.add_coupling(manager, def))
    }

    /// Changes a coupling.
    pub fn recouple(&mut self, id: u32, def: CouplingDef) -> Result<(), JointError> {
        self.with_joints(|joints, manager| joints.set_coupling(manager, id, def))
    }

    /// The force of a coupling along its coordinate at A.
    pub fn coupling_force(&self, id: u32) -> f32 {
        self.solver.joints.coupling_force(id)
    }

    /// How far a joint is off.
    pub fn gap(&self, id: u32) -> Option<JointGap> {
        self.solver.joints.gap(id, &self.bodies)
    }

    /// Adds a custom constraint.
    pub fn tie(
        &mut self,
        bodies: [u32; 2],
        act: Option<Box<dyn CustomConstraint>>,
    ) -> Result<u32, CustomError> {
        self.with_customs(|customs, manager| customs.add(manager, bodies, act))
    }

    /// Removes a custom constraint.
    pub fn untie(&mut self, id: u32) -> Result<(), CustomError> {
        self.with_customs(|customs, manager| customs.remove(manager, id))
    }

    fn with_customs<R>(&mut self, f: impl FnOnce(&mut CustomTable, &mut ContactManager) -> R) -> R {
        let mut customs = core::mem::take(&mut self.solver.customs);
        let result = f(&mut customs, &mut self.contact_manager());
        self.solver.customs = customs;
        result
    }

    /// All custom constraints.
    pub fn customs(&self) -> &CustomTable {
        &self.solver.customs
    }

    /// What a joint did in the last substep.
    pub fn reaction(&self, id: u32) -> JointReaction {
        self.solver.joints.reaction(id)
    }
}
