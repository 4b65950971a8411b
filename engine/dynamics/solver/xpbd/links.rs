//! Connects bodies with XPBD constraints into one island.

use bevy_ecs::prelude::*;
use core::sync::atomic::{AtomicU32, Ordering};
use std::sync::Mutex;

use crate::dynamics::solver::constraint::ties::{FIRST_XPBD, Ties};

/// The constraints prepared in the last step. Systems that prepare different types may run in any order, so
/// they add constraints without exclusive access.
#[derive(Resource, Debug, Default)]
pub struct Links {
    wanted: Mutex<Vec<(u32, Entity, [Entity; 2])>>,
    types: AtomicU32,
}

impl Links {
    /// The number of the next type of constraints.
    pub(super) fn next_number(&self) -> u32 {
        FIRST_XPBD + self.types.fetch_add(1, Ordering::Relaxed)
    }

    /// Notes a constraint between two bodies.
    pub(super) fn want(&self, number: u32, entity: Entity, ends: [Entity; 2]) {
        if let Ok(mut wanted) = self.wanted.lock() {
            wanted.push((number, entity, ends));
        }
    }
}

/// Passes the constraints to the table of connected bodies.
pub(super) fn note_links(mut links: ResMut<Links>, mut ties: ResMut<Ties>) {
    if let Ok(wanted) = links.bypass_change_detection().wanted.get_mut() {
        for (number, entity, ends) in wanted.drain(..) {
            ties.want((number, entity), ends, None);
        }
    }
}
