//! All joints between steps.

use super::super::{MassRow, RowInput};
use super::class::Summary;
use super::coupling::{CouplingDef, CouplingRecord};
use super::def::{JointDef, JointError};
use super::dim::{AXES, BLOCK, TURNS, lacking, with_inertia};
use super::gap::JointGap;
use super::records::Records;
use super::state::{JointReaction, State};
use crate::contact::ContactManager;
use crate::graph::{COLOR_COUNT, ColorGraph, ConstraintKind};
use crate::table::BodyTable;
use crate::thread_pool::ThreadPool;

/// Buffers of [`JointTable::raise_inertia`].
#[derive(Clone, Debug, Default)]
pub(in super::super) struct InertiaFloors {
    /// By colour and joint, the row and the minimum inertia, kg·m², of both bodies.
    asked: Vec<Vec<[(u32, f32); 2]>>,
    /// Minimum inertia by body row, kg·m².
    least: Vec<f32>,
}

/// All joints by id. [`BodyTable::constraints`](crate::table::BodyTable::constraints) stores their bodies.
/// Entries of free ids are stale.
#[derive(Clone, Debug, Default)]
pub struct JointTable {
    /// Definitions. Couplings have bodies and anchors only.
    defs: Vec<JointDef>,
    summaries: Vec<Summary>,
    states: Vec<State>,
    /// Couplings by id; `None` for joints.
    couplings: Vec<Option<Box<CouplingRecord>>>,
}

const KIND: ConstraintKind = ConstraintKind::Joint;

impl JointTable {
    /// Adds a joint and wakes its bodies. They are in one island if both are dynamic.
    pub fn add(&mut self, manager: &mut ContactManager, def: JointDef) -> Result<u32, JointError> {
        def.check()?;
        self.enter(manager, def, Summary::of(&def), None)
    }

    /// Adds a coupling, which gets an id among joints, and wakes its bodies.
    pub fn add_coupling(
        &mut self,
        manager: &mut ContactManager,
        def: CouplingDef,
    ) -> Result<u32, JointError> {
        def.check()?;
        self.enter(manager, def.joint(), Summary::OF_COUPLING, Some(Box::new(CouplingRecord::new(def))))
    }

    fn enter(
        &mut self,
        manager: &mut ContactManager,
        def: JointDef,
        summary: Summary,
        coupling: Option<Box<CouplingRecord>>,
    ) -> Result<u32, JointError> {
        let bodies = def.bodies;
        if let Some(dead) = bodies.into_iter().find(|body| !manager.bodies.ids.is_live(*body)) {
            return Err(JointError::NoBody(dead));
        }
        let id = manager.connect(KIND, bodies);
        let index = id as usize;
        if index == self.defs.len() {
            self.defs.push(def);
            self.summaries.push(summary);
            self.states.push(State::new());
            self.couplings.push(coupling);
        } else {
            (self.defs[index], self.summaries[index]) = (def, summary);
            (self.states[index], self.couplings[index]) = (State::new(), coupling);
        }
        Ok(id)
    }

    /// Changes a coupling except for its bodies, and wakes them if the definition differs. The count of
    /// turns continues.
    pub fn set_coupling(
        &mut self,
        manager: &mut ContactManager,
        id: u32,
        def: CouplingDef,
    ) -> Result<(), JointError> {
        def.check()?;
        let is_live = manager.bodies.constraints(KIND).is_live(id);
        let coupling = self.couplings.get_mut(id as usize).filter(|_| is_live);
        let Some(coupling) = coupling.and_then(Option::as_deref_mut) else {
            return Err(JointError::NoJoint(id));
        };
        if let Some(other) = (0..2).find(|side| coupling.def.bodies[*side] != def.bodies[*side]) {
            return Err(JointError::NoBody(def.bodies[other]));
        }
        if coupling.def == def {
            return Ok(());
        }
        coupling.def = def;
        self.defs[id as usize] = def.joint();
        def.bodies.into_iter().for_each(|body| manager.wake_body(body));
        Ok(())
    }

    /// The force of a coupling along the coordinate at A in the last substep, N or N·m: positive if it
    /// increases the coordinate. The force along the coordinate at B is the ratio times this force. 0 for
    /// an unknown id.
    pub fn coupling_force(&self, id: u32) -> f32 {
        let coupling = self.couplings.get(id as usize).and_then(Option::as_deref);
        coupling.map_or(0.0, |coupling| coupling.force)
    }

    /// Errors of the locked coordinates and limits of a joint or coupling at the current poses. `None` for
    /// an unknown id.
    pub fn gap(&self, id: u32, bodies: &BodyTable) -> Option<JointGap> {
        bodies.constraints(KIND).is_live(id).then(|| {
            let id = id as usize;
            match &self.couplings[id] {
                Some(coupling) => JointGap::of_coupling(coupling, bodies),
                None => JointGap::of_joint(&self.defs[id], self.states[id].angle, bodies),
            }
        })
    }

    /// Changes a joint except for its bodies, and wakes them if the definition differs. Coordinates that
    /// are still solved in the same way keep their impulses.
    pub fn set(&mut self, manager: &mut ContactManager, id: u32, def: JointDef) -> Result<(), JointError> {
        def.check()?;
        if !manager.bodies.constraints(KIND).is_live(id) {
            return Err(JointError::NoJoint(id));
        }
        if self.couplings[id as usize].is_some() {
            return Err(JointError::NoJoint(id));
        }
        let old = &mut self.defs[id as usize];
        if let Some(other) = (0..2).find(|side| old.bodies[*side] != def.bodies[*side]) {
            return Err(JointError::NoBody(def.bodies[other]));
        }
        if *old == def {
            return Ok(());
        }
        let state = &mut self.states[id as usize];
        for number in 0..AXES {
            if def.is_in_block(number) != old.is_in_block(number) && number < BLOCK {
                state.block[number] = 0.0;
            }
            if def.is_single(number) != old.is_single(number) {
                state.singles[number] = [0.0; 4];
            }
        }
        if def.orientation.is_none() {
            state.orientation = [0.0; TURNS];
        }
        *old = def;
        self.summaries[id as usize] = Summary::of(&def);
        def.bodies.into_iter().for_each(|body| manager.wake_body(body));
        Ok(())
    }

    /// Removes a joint and wakes its bodies.
    pub fn remove(&mut self, manager: &mut ContactManager, id: u32) -> Result<(), JointError> {
        if !manager.bodies.constraints(KIND).is_live(id) {
            return Err(JointError::NoJoint(id));
        }
        manager.disconnect(KIND, id);
        Ok(())
    }

    /// Force and torque of a joint in the last substep. Zero for an unknown id.
    pub fn reaction(&self, id: u32) -> JointReaction {
        self.states.get(id as usize).map_or_else(JointReaction::default, |state| state.reaction)
    }

    /// Raises the inertia of bodies in this step if their joints bear large forces, to at least h² Σ
    /// |force| |arm|.
    ///
    /// An impulse acts in one direction for a whole substep. A light body under a large force rotates so
    /// far in that time that the next impulse turns it back further, and the motion grows (Andrews,
    /// Teichmann and Kry, "Geometric Stiffness for Real-time Constrained Multibody Dynamics", 2017).
    pub(in super::super) fn raise_inertia(
        &self,
        input: &RowInput,
        colors: &ColorGraph,
        (h, pool): (f32, &ThreadPool),
        masses: &mut [MassRow],
        floors: &mut InertiaFloors,
    ) {
        let ids = |color: usize| colors.constraints(KIND, color as u8);
        if (0..COLOR_COUNT).all(|color| ids(color).is_empty()) {
            return;
        }
        let InertiaFloors { asked, least } = floors;
        asked.resize_with(COLOR_COUNT, Vec::new);
        pool.each(asked.iter_mut().enumerate(), |(color, asked)| {
            asked.clear();
            asked.extend(ids(color).iter().map(|id| self.asked_inertia(*id, input, h)));
        });
        least.clear();
        least.resize(masses.len(), 0.0);
        for (row, asked) in asked.iter().flatten().flatten() {
            least[*row as usize] += asked;
        }
        for (row, least) in least.iter().enumerate().filter(|(_, least)| **least > 0.0) {
            let (inv_mass, inverse) = MassRow::gather::<f32>(masses, &[row as u32]);
            masses[row] = MassRow::new(inv_mass, with_inertia(inverse, lacking(inverse, *least)));
        }
    }

    /// The rows of a joint's bodies, and the minimum inertia that the joint requires.
    fn asked_inertia(&self, id: u32, input: &RowInput, h: f32) -> [(u32, f32); 2] {
        let (def, state) = (&self.defs[id as usize], &self.states[id as usize]);
        let force = state.reaction.force.length();
        core::array::from_fn(|side| {
            let body = def.bodies[side];
            let arm = (def.frames[side].anchor - input.bodies[body].local_center).length();
            (input.row_of(body), h * h * force * arm)
        })
    }

    /// The bodies of a joint.
    pub(super) fn bodies(&self, id: u32) -> [u32; 2] {
        self.defs[id as usize].bodies
    }

    pub(super) fn summary(&self, id: u32) -> Summary {
        self.summaries[id as usize]
    }

    /// Whether a joint locks something.
    pub(in super::super) fn holds(&self, id: u32) -> bool {
        self.summary(id).holds
    }

    pub(in super::super) fn records(&mut self) -> Records<'_> {
        let Self { defs, summaries, states, couplings } = self;
        Records::of((defs, summaries), states, couplings)
    }
}
