//! The batch of a joint, and whether the joint may be in a tree.

use super::def::JointDef;
use super::dim::{AXES, BLOCK};
use crate::math::DIM;

/// The batch of couplings, after the batches of classes.
pub(super) const COUPLINGS: usize = CLASSES.len();

/// Capacity of the rows in a batch: the size of the block, the number of single coordinates, and whether
/// there is an orientation motor.
#[derive(Clone, Copy, Debug)]
pub(super) struct Class {
    pub(super) block: usize,
    pub(super) singles: usize,
    pub(super) turns: bool,
}

/// The class of each batch. A joint is in the first class that it fits into.
pub(super) const CLASSES: [Class; 8] = [
    Class::new(DIM, 0),
    Class::new(0, 1),
    Class::new(DIM, 2),
    Class::new(BLOCK, 0),
    Class::new(BLOCK, 1),
    Class::new(BLOCK, AXES),
    Class { turns: true, ..Class::new(DIM, 2) },
    Class { turns: true, ..Class::new(BLOCK, AXES) },
];

impl Class {
    const fn new(block: usize, singles: usize) -> Self {
        Self { block, singles, turns: false }
    }
}

/// A digest of a definition: the joint's batch, and the coordinates that have rows.
#[derive(Clone, Copy, Debug)]
pub(super) struct Summary {
    /// The joint's batch among the batches of joints.
    pub(super) batch: u8,
    /// Whether the joint may be part of a tree.
    pub(super) may_branch: bool,
    /// Whether the joint locks something.
    pub(super) holds: bool,
    /// Whether all shifts are locked at 0 with the same softness, so that any axes may be used.
    pub(super) is_locked_alike: bool,
    /// Bits of locked coordinates, then of single coordinates, then of a rod and of an orientation motor.
    /// Joints with the same bits have the same rows in a tree.
    pub(super) shape: u32,
}

impl Summary {
    pub(super) const OF_COUPLING: Self =
        Self { batch: COUPLINGS as u8, may_branch: false, holds: false, is_locked_alike: false, shape: 0 };

    pub(super) fn of(def: &JointDef) -> Self {
        let block = (0..BLOCK).rev().find(|k| def.is_in_block(*k)).map_or(0, |last| last + 1);
        let singles = (0..AXES).filter(|k| def.is_single(*k)).count();
        let turns = def.orientation.is_some();
        let fits = |class: &Class| class.block >= block && class.singles >= singles && class.turns >= turns;
        let batch = CLASSES.iter().position(fits).expect("the last one has room for all");
        let bits = (0..BLOCK).map(|k| def.is_in_block(k)).chain((0..AXES).map(|k| def.is_single(k)));
        let bits = bits.chain([def.is_rod(), turns]);
        let shape = bits.enumerate().map(|(bit, is_set)| u32::from(is_set) << bit).sum();
        Self {
            batch: batch as u8,
            may_branch: def.may_branch(),
            holds: def.holds(),
            is_locked_alike: def.is_locked_alike(),
            shape,
        }
    }

    /// [`JointDef::is_in_block`].
    pub(super) fn is_in_block(self, number: usize) -> bool {
        number < BLOCK && self.has(number)
    }

    /// [`JointDef::is_single`].
    pub(super) fn is_single(self, number: usize) -> bool {
        self.has(BLOCK + number)
    }

    /// [`JointDef::is_rod`].
    pub(super) fn is_rod(self) -> bool {
        self.has(BLOCK + AXES)
    }

    /// Whether the joint has an orientation motor.
    pub(super) fn turns(self) -> bool {
        self.has(BLOCK + AXES + 1)
    }

    fn has(self, bit: usize) -> bool {
        self.shape >> bit & 1 != 0
    }
}

#[cfg(test)]
mod tests {
    use super::super::def::{Axis, Drive, Give, Motor};
    use super::*;
    use crate::math::Vector;
    use proptest::prelude::*;

    /// Free, locked, limited, driven, soft and driven lock, and locked at 1.
    fn axis(kind: u8) -> Axis {
        let drive = Drive::Force { stiffness: 1.0, damping: 0.0 };
        let motor = Some(Motor { target_velocity: 1.0, target_position: 0.0, max_force: 1.0, drive });
        match kind {
            0 => Axis::FREE,
            1 => Axis::LOCKED,
            2 => Axis::limited(-1.0, 1.0),
            3 => Axis { motor, ..Axis::FREE },
            4 => Axis { motor, give: Give::Compliance(0.1), ..Axis::LOCKED },
            _ => Axis::limited(1.0, 1.0),
        }
    }

    proptest! {
        #[test]
        fn a_summary_says_what_its_definition_says(kinds in proptest::array::uniform8(0u8..6)) {
            let mut def = JointDef::free([0, 1], [Vector::ZERO; 2]);
            for (number, of) in def.axes.iter_mut().enumerate() {
                *of = axis(kinds[number]);
            }
            let summary = Summary::of(&def);
            for number in 0..AXES {
                prop_assert_eq!(summary.is_in_block(number), def.is_in_block(number));
                prop_assert_eq!(summary.is_single(number), def.is_single(number));
            }
            prop_assert_eq!(summary.is_rod(), def.is_rod());
            prop_assert_eq!(summary.turns(), def.orientation.is_some());
            prop_assert_eq!(summary.is_locked_alike, def.is_locked_alike());
        }
    }
}
