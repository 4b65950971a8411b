//! Collisions that began or ended, and blows, until they are sent.

use bevy_ecs::entity::{Entity, EntityIndexSet};
use bevy_platform::collections::HashSet;
use kernel::{math as k, table::Velocity};

use crate::math::{Scalar, Vector};

/// Two colliders that began or stopped touching.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Report {
    /// Both colliders, in the order of ids.
    pub(crate) colliders: [Entity; 2],
    /// The body of each collider.
    pub(crate) bodies: [Option<Entity>; 2],
    /// Whether one of the colliders has `CollisionEventsEnabled`.
    pub(crate) is_sent: bool,
}

/// Collisions to send at the end of the step. Only colliders that report or track collisions are recorded.
#[derive(Clone, Debug, Default)]
pub(crate) struct Reports {
    /// Pairs that began to touch, by contact id.
    pub(crate) started: Vec<Report>,
    /// Pairs that stopped touching, in the order in which this was detected.
    pub(crate) ended: Vec<Report>,
    /// Colliders whose `CollidingEntities` may have changed.
    pub(crate) trackers: EntityIndexSet,
}

impl Reports {
    /// Drops pairs that ended and began again in the step, for example when a collider moves to another body.
    pub(crate) fn drop_resumed(&mut self) {
        if self.started.is_empty() || self.ended.is_empty() {
            return;
        }
        let key = |report: &Report| {
            let [a, b] = report.colliders;
            [a.min(b), a.max(b)]
        };
        let ended: HashSet<_> = self.ended.iter().map(key).collect();
        let resumed: HashSet<_> = self.started.iter().map(key).filter(|pair| ended.contains(pair)).collect();
        if !resumed.is_empty() {
            self.started.retain(|report| !resumed.contains(&key(report)));
            self.ended.retain(|report| !resumed.contains(&key(report)));
        }
    }
}

/// A contact that may become a blow, before it is solved.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Approach {
    pub(crate) contact: u32,
    pub(crate) colliders: [Entity; 2],
    /// The centre of mass of the first body, and the vector from it to the centre of mass of the second.
    pub(crate) center: k::WorldVector,
    pub(crate) offset: k::Vector,
    /// The velocities of both bodies.
    pub(crate) velocities: [Velocity; 2],
    /// Minimum speed of reported blows.
    pub(crate) min_speed: f32,
    /// Whether a point closes faster than `min_speed`.
    pub(crate) is_fast: bool,
    /// The ongoing blow of this contact, if any.
    pub(crate) blow: Option<GoingBlow>,
}

/// A blow that may take more than one step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GoingBlow {
    pub(crate) contact: u32,
    pub(crate) colliders: [Entity; 2],
    /// The closing speed at the start of the blow.
    pub(crate) speed: f32,
    /// The accumulated impulses on the second body, N·s.
    pub(crate) impulse: k::Vector,
    /// Whether the blow was reported.
    pub(crate) is_told: bool,
}

/// A blow whose bodies no longer approach.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Blow {
    pub(crate) colliders: [Entity; 2],
    pub(crate) bodies: [Option<Entity>; 2],
    pub(crate) point: Vector,
    pub(crate) normal: Vector,
    pub(crate) speed: Scalar,
    pub(crate) impulse: Scalar,
}

/// The fast contacts of a step, and the resulting blows.
#[derive(Clone, Debug, Default)]
pub(crate) struct Hits {
    pub(crate) approaches: Vec<Approach>,
    /// Ongoing blows, by contact.
    pub(crate) going: Vec<GoingBlow>,
    pub(crate) blows: Vec<Blow>,
}
