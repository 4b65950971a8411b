//! All custom constraints between steps.

use super::super::SubstepParams;
use super::body::CustomBody;
use crate::contact::ContactManager;
use crate::data::Parts;
use crate::graph::ConstraintKind;
use core::any::Any;
use core::fmt;

const KIND: ConstraintKind = ConstraintKind::Custom;

/// A constraint between two bodies, implemented by the embedder.
///
/// It may change only the velocities of its two bodies, and must compute the same output from the same
/// input, so that results do not depend on threads. Changes to a body that is not dynamic have no effect.
pub trait CustomConstraint: Send + Sync {
    /// Prepares for a step. Called again, with the same impulses, if masses change before the first
    /// substep.
    fn prepare(&mut self, bodies: [&CustomBody; 2], params: &SubstepParams);

    /// Applies the impulses of the last substep.
    fn warm_start(&mut self, bodies: [&mut CustomBody; 2], params: &SubstepParams);

    /// Changes velocities to satisfy the constraint. With `use_bias` it also reduces position errors.
    fn solve(&mut self, bodies: [&mut CustomBody; 2], params: &SubstepParams, use_bias: bool);

    /// Stores the impulses of the last substep for the next step.
    fn store(&mut self);

    /// Returns a copy.
    fn boxed(&self) -> Box<dyn CustomConstraint>;

    /// The constraint, for downcasting to its type and changing it.
    fn as_any_mut(&mut self) -> &mut dyn Any;

    /// The constraint, for downcasting to its type and reading it.
    fn as_any(&self) -> &dyn Any;
}

/// Reason why a custom constraint is rejected.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CustomError {
    /// A body with this id does not exist.
    NoBody(u32),
    /// Both bodies are the same.
    SameBody,
    /// A constraint with this id does not exist.
    NoConstraint(u32),
}

impl fmt::Display for CustomError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::NoBody(id) => write!(f, "there is no body {id}"),
            Self::SameBody => write!(f, "both bodies are one"),
            Self::NoConstraint(id) => write!(f, "there is no constraint {id}"),
        }
    }
}

impl core::error::Error for CustomError {}

/// State of a constraint between steps.
pub(super) struct Record {
    /// The implementation; `None` if the constraint only connects its bodies.
    pub(super) act: Option<Box<dyn CustomConstraint>>,
    /// Whether the constraint returned a velocity that is not finite. Such velocities are ignored.
    pub(super) is_faulty: bool,
}

impl Clone for Record {
    fn clone(&self) -> Self {
        Self { act: self.act.as_ref().map(|act| act.boxed()), is_faulty: self.is_faulty }
    }
}

impl fmt::Debug for Record {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self { act, is_faulty } = self;
        f.debug_struct("Record").field("acts", &act.is_some()).field("is_faulty", is_faulty).finish()
    }
}

/// All custom constraints by id. [`BodyTable::constraints`](crate::table::BodyTable::constraints) stores
/// their bodies.
#[derive(Clone, Debug, Default)]
pub struct CustomTable {
    /// Records by id. Records of free ids are stale.
    records: Vec<Record>,
}

impl CustomTable {
    /// Connects two bodies and wakes them. They are in one island if both are dynamic. Without `act`, the
    /// constraint has no other effect.
    pub fn add(
        &mut self,
        manager: &mut ContactManager,
        bodies: [u32; 2],
        act: Option<Box<dyn CustomConstraint>>,
    ) -> Result<u32, CustomError> {
        if bodies[0] == bodies[1] {
            return Err(CustomError::SameBody);
        }
        if let Some(dead) = bodies.into_iter().find(|body| !manager.bodies.ids.is_live(*body)) {
            return Err(CustomError::NoBody(dead));
        }
        let id = manager.connect(KIND, bodies);
        let record = Record { act, is_faulty: false };
        match self.records.get_mut(id as usize) {
            Some(place) => *place = record,
            None => self.records.push(record),
        }
        Ok(id)
    }

    /// Removes a constraint and wakes its bodies.
    pub fn remove(&mut self, manager: &mut ContactManager, id: u32) -> Result<(), CustomError> {
        if !manager.bodies.constraints(KIND).is_live(id) {
            return Err(CustomError::NoConstraint(id));
        }
        manager.disconnect(KIND, id);
        self.records[id as usize].act = None;
        Ok(())
    }

    /// The implementation of a constraint, for changing it. The caller wakes the bodies if the change
    /// affects them.
    pub fn act_mut(&mut self, id: u32) -> Option<&mut (dyn CustomConstraint + 'static)> {
        self.records.get_mut(id as usize)?.act.as_deref_mut()
    }

    /// The implementation of a constraint.
    pub fn act(&self, id: u32) -> Option<&(dyn CustomConstraint + 'static)> {
        self.records.get(id as usize)?.act.as_deref()
    }

    /// Whether a constraint returned a velocity that is not finite. Such velocities are ignored.
    pub fn is_faulty(&self, id: u32) -> bool {
        self.records.get(id as usize).is_some_and(|record| record.is_faulty)
    }

    /// Whether a constraint has an implementation.
    pub(super) fn acts(&self, id: u32) -> bool {
        self.records[id as usize].act.is_some()
    }

    pub(in super::super) fn records(&mut self) -> Records<'_> {
        Records(Parts::of(&mut self.records))
    }
}

/// The records of all constraints. Several threads may change them.
pub(in super::super) struct Records<'a>(pub(super) Parts<'a, Record>);
