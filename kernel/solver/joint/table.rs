//! All joints between steps.

use super::super::{MassRow, RowInput};
use super::class::Summary;
use super::coupling::{CouplingDef, CouplingRecord};
use super::def::{JointDef, JointError};
use super::dim::{AXES, BLOCK, TURNS, lacking, with_inertia};
use super::gap::JointGap;
use crate::contact::Link;
use crate::data::Parts;
use crate::graph::{COLOR_COUNT, ColorGraph, ConstraintKind};
use crate::math::{Angular, Vector};
use crate::table::BodyTable;

/// What a joint did to body B in the last substep, and against which it pushed A.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JointReaction {
    /// In world axes, in N.
    pub force: Vector,
    /// About B's anchor, in world axes, in N·m.
    pub torque: Angular,
    /// Forces in N, or torques in N·m, of the motors, by number of the coordinate.
    pub motors: [f32; AXES],
    /// Torque of the orientation motor on B, in world axes, in N·m. It is part of `torque`.
    pub orientation: Angular,
}

/// State of a joint between steps.
#[derive(Clone, Debug)]
pub(super) struct Record {
    pub(super) def: JointDef,
    /// Impulses of what is locked in A's frame, N·s or N·m·s, by number of the coordinate.
    pub(super) block: [f32; BLOCK],
    /// Impulses of lower limit, upper limit, spring and motor, by number of the coordinate.
    pub(super) singles: [[f32; 4]; AXES],
    /// Impulses of the orientation motor along A's axes, N·m·s.
    pub(super) orientation: [f32; TURNS],
    /// The angle that counts turns, at the end of the last step. NaN before the first.
    pub(super) angle: f32,
    pub(super) reaction: JointReaction,
    /// Set if it is a coupling. Then the definition has its bodies and anchors only.
    pub(super) coupling: Option<Box<CouplingRecord>>,
}

impl Record {
    fn new(def: JointDef) -> Self {
        let (block, singles, orientation) = ([0.0; BLOCK], [[0.0; 4]; AXES], [0.0; TURNS]);
        let (angle, reaction) = (f32::NAN, JointReaction::default());
        Self { def, block, singles, orientation, angle, reaction, coupling: None }
    }

    fn of_coupling(def: CouplingDef) -> Self {
        let joint = JointDef::free(def.bodies, def.ends.map(|end| end.frame.anchor));
        Self { coupling: Some(Box::new(CouplingRecord::new(def))), ..Self::new(joint) }
    }
}

/// All joints by id. Their bodies are in [`BodyTable::constraints`](crate::table::BodyTable::constraints).
#[derive(Clone, Debug, Default)]
pub struct JointTable {
    /// Records by id. Those of free ids are stale.
    records: Vec<Record>,
    /// Of each record.
    summaries: Vec<Summary>,
}

const KIND: ConstraintKind = ConstraintKind::Joint;

impl JointTable {
    /// Adds a joint and wakes its bodies. They are in one island if both are dynamic.
    pub fn add(&mut self, link: &mut Link, def: JointDef) -> Result<u32, JointError> {
        def.check()?;
        self.enter(link, Record::new(def), Summary::of(&def))
    }

    /// Adds a coupling, as a joint with an id among joints, and wakes its bodies.
    pub fn add_coupling(&mut self, link: &mut Link, def: CouplingDef) -> Result<u32, JointError> {
        def.check()?;
        self.enter(link, Record::of_coupling(def), Summary::OF_COUPLING)
    }

    fn enter(&mut self, link: &mut Link, record: Record, summary: Summary) -> Result<u32, JointError> {
        let bodies = record.def.bodies;
        if let Some(dead) = bodies.into_iter().find(|body| !link.bodies.ids.is_live(*body)) {
            return Err(JointError::NoBody(dead));
        }
        let id = link.connect(KIND, bodies);
        match self.records.get_mut(id as usize) {
            Some(place) => {
                *place = record;
                self.summaries[id as usize] = summary;
            }
            None => {
                self.records.push(record);
                self.summaries.push(summary);
            }
        }
        Ok(id)
    }

    /// Changes all of a coupling but its bodies, and wakes them if anything is different. Turns are counted on.
    pub fn set_coupling(&mut self, link: &mut Link, id: u32, def: CouplingDef) -> Result<(), JointError> {
        def.check()?;
        let is_live = link.bodies.constraints(KIND).is_live(id);
        let record = self.records.get_mut(id as usize).filter(|_| is_live);
        let Some(coupling) = record.and_then(|record| record.coupling.as_deref_mut()) else {
            return Err(JointError::NoJoint(id));
        };
        if let Some(other) = (0..2).find(|side| coupling.def.bodies[*side] != def.bodies[*side]) {
            return Err(JointError::NoBody(def.bodies[other]));
        }
        if coupling.def == def {
            return Ok(());
        }
        coupling.def = def;
        def.bodies.into_iter().for_each(|body| link.wake_body(body));
        Ok(())
    }

    /// The force of a coupling along the coordinate at A in the last substep, N or N·m: positive where it increases the coordinate.
    /// Along the one at B it is the ratio times that. 0 for an unknown id.
    pub fn coupling_force(&self, id: u32) -> f32 {
        let coupling = self.records.get(id as usize).and_then(|record| record.coupling.as_deref());
        coupling.map_or(0.0, |coupling| coupling.force)
    }

    /// How far locked coordinates and limits of a joint or coupling are off, by the bodies' present poses. `None` for an unknown
    /// id.
    pub fn gap(&self, id: u32, bodies: &BodyTable) -> Option<JointGap> {
        bodies.constraints(KIND).is_live(id).then(|| {
            let Record { def, angle, coupling, .. } = &self.records[id as usize];
            match coupling {
                Some(coupling) => JointGap::of_coupling(coupling, bodies),
                None => JointGap::of_joint(def, *angle, bodies),
            }
        })
    }

    /// Changes all of a joint but its bodies, and wakes them if anything is different. What is kept has its impulses.
    pub fn set(&mut self, link: &mut Link, id: u32, def: JointDef) -> Result<(), JointError> {
        def.check()?;
        if !link.bodies.constraints(KIND).is_live(id) {
            return Err(JointError::NoJoint(id));
        }
        let record = &mut self.records[id as usize];
        if record.coupling.is_some() {
            return Err(JointError::NoJoint(id));
        }
        if let Some(other) = (0..2).find(|side| record.def.bodies[*side] != def.bodies[*side]) {
            return Err(JointError::NoBody(def.bodies[other]));
        }
        if record.def == def {
            return Ok(());
        }
        for number in 0..AXES {
            if def.is_in_block(number) != record.def.is_in_block(number) && number < BLOCK {
                record.block[number] = 0.0;
            }
            if def.is_single(number) != record.def.is_single(number) {
                record.singles[number] = [0.0; 4];
            }
        }
        if def.orientation.is_none() {
            record.orientation = [0.0; TURNS];
        }
        record.def = def;
        self.summaries[id as usize] = Summary::of(&def);
        def.bodies.into_iter().for_each(|body| link.wake_body(body));
        Ok(())
    }

    /// Removes a joint and wakes its bodies.
    pub fn remove(&mut self, link: &mut Link, id: u32) -> Result<(), JointError> {
        if !link.bodies.constraints(KIND).is_live(id) {
            return Err(JointError::NoJoint(id));
        }
        link.disconnect(KIND, id);
        Ok(())
    }

    /// What the joint did in the last substep. Nothing for an unknown id.
    pub fn reaction(&self, id: u32) -> JointReaction {
        self.records.get(id as usize).map_or_else(JointReaction::default, |record| record.reaction)
    }

    /// Gives bodies more inertia in this step where their joints bear much: h² Σ |force| |arm|.
    ///
    /// An impulse acts in one direction for a whole substep. A light body under a large force turns so far in that time that
    /// the next impulse turns it back further, and the motion grows (Andrews, Teichmann and Kry, "Geometric Stiffness for
    /// Real-time Constrained Multibody Dynamics", 2017).
    pub(in super::super) fn stiffen(
        &self,
        input: &RowInput,
        colors: &ColorGraph,
        h: f32,
        masses: &mut [MassRow],
        least: &mut Vec<f32>,
    ) {
        if (0..COLOR_COUNT as u8).all(|color| colors.constraints(KIND, color).is_empty()) {
            return;
        }
        least.clear();
        least.resize(masses.len(), 0.0);
        for color in 0..COLOR_COUNT as u8 {
            for id in colors.constraints(KIND, color) {
                let record = &self.records[*id as usize];
                let force = record.reaction.force.length();
                for (body, frame) in record.def.bodies.iter().zip(&record.def.frames) {
                    let arm = (frame.anchor - input.bodies[*body].local_center).length();
                    least[input.row_of(*body) as usize] += h * h * force * arm;
                }
            }
        }
        for (row, least) in least.iter().enumerate().filter(|(_, least)| **least > 0.0) {
            let (inv_mass, inverse) = MassRow::gather::<f32>(masses, &[row as u32]);
            masses[row] = MassRow::new(inv_mass, with_inertia(inverse, lacking(inverse, *least)));
        }
    }

    pub(super) fn summary(&self, id: u32) -> Summary {
        self.summaries[id as usize]
    }

    /// Whether a joint locks something.
    pub(in super::super) fn holds(&self, id: u32) -> bool {
        self.summary(id).holds
    }

    pub(in super::super) fn records(&mut self) -> Records<'_> {
        Records(Parts::of(&mut self.records))
    }
}

/// The records of all joints, changed by several threads.
pub(in super::super) struct Records<'a>(pub(super) Parts<'a, Record>);
