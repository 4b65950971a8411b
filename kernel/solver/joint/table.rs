//! All joints between steps.

use super::super::{MassRow, RowInput};
use super::def::{JointDef, JointError};
use super::dim::{AXES, BLOCK, with_least_inertia};
use crate::contact::Link;
use crate::data::Parts;
use crate::graph::{COLOR_COUNT, ColorGraph, ConstraintKind};
use crate::math::{Angular, Vector};

/// What a joint did to body B in the last substep, and against which it pushed A.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JointReaction {
    /// In world axes, in N.
    pub force: Vector,
    /// About B's anchor, in world axes, in N·m.
    pub torque: Angular,
    /// Forces in N, or torques in N·m, of the motors, by number of the coordinate.
    pub motors: [f32; AXES],
}

/// State of a joint between steps.
#[derive(Clone, Debug)]
pub(super) struct Record {
    pub(super) def: JointDef,
    /// Impulses of what is locked in A's frame, N·s or N·m·s, by number of the coordinate.
    pub(super) block: [f32; BLOCK],
    /// Impulses of lower limit, upper limit and motor, by number of the coordinate.
    pub(super) singles: [[f32; 3]; AXES],
    /// The angle that counts turns, at the end of the last step. NaN before the first.
    pub(super) angle: f32,
    pub(super) reaction: JointReaction,
}

impl Record {
    fn new(def: JointDef) -> Self {
        let (block, singles) = ([0.0; BLOCK], [[0.0; 3]; AXES]);
        Self { def, block, singles, angle: f32::NAN, reaction: JointReaction::default() }
    }
}

/// All joints by id. Their bodies are in [`BodyTable::constraints`](crate::table::BodyTable::constraints).
#[derive(Clone, Debug, Default)]
pub struct JointTable {
    /// Records by id. Those of free ids are stale.
    records: Vec<Record>,
}

const KIND: ConstraintKind = ConstraintKind::Joint;

impl JointTable {
    /// Adds a joint and wakes its bodies. They are in one island if both are dynamic.
    pub fn add(&mut self, link: &mut Link, def: JointDef) -> Result<u32, JointError> {
        def.check()?;
        if let Some(dead) = def.bodies.into_iter().find(|body| !link.bodies.ids.is_live(*body)) {
            return Err(JointError::NoBody(dead));
        }
        let id = link.connect(KIND, def.bodies);
        match self.records.get_mut(id as usize) {
            Some(place) => *place = Record::new(def),
            None => self.records.push(Record::new(def)),
        }
        Ok(id)
    }

    /// Changes all of a joint but its bodies, and wakes them if anything is different. What is kept has its impulses.
    pub fn set(&mut self, link: &mut Link, id: u32, def: JointDef) -> Result<(), JointError> {
        def.check()?;
        if !link.bodies.constraints(KIND).is_live(id) {
            return Err(JointError::NoJoint(id));
        }
        let record = &mut self.records[id as usize];
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
                record.singles[number] = [0.0; 3];
            }
        }
        record.def = def;
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
            masses[row] = MassRow::new(inv_mass, with_least_inertia(inverse, *least));
        }
    }

    pub(super) fn record(&self, id: u32) -> &Record {
        &self.records[id as usize]
    }

    pub(in super::super) fn records(&mut self) -> Records<'_> {
        Records(Parts::of(&mut self.records))
    }
}

/// The records of all joints, changed by several threads.
pub(in super::super) struct Records<'a>(pub(super) Parts<'a, Record>);
