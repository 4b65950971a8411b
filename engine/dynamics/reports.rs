//! Collisions that began and ended, until they are sent.

use bevy_ecs::entity::{Entity, EntityIndexSet};
use bevy_platform::collections::HashSet;

/// Two colliders that began or ceased to touch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Report {
    /// Both colliders, in the order of ids.
    pub(crate) colliders: [Entity; 2],
    /// The body of each.
    pub(crate) bodies: [Option<Entity>; 2],
    /// Whether one of the colliders has `CollisionEventsEnabled`.
    pub(crate) is_sent: bool,
}

/// What is to be sent at the end of the step. Only colliders that report or track collisions are noted.
#[derive(Clone, Debug, Default)]
pub(crate) struct Reports {
    /// Pairs that began to touch, by contact id.
    pub(crate) started: Vec<Report>,
    /// Pairs that ceased to touch, in the order in which it was found.
    pub(crate) ended: Vec<Report>,
    /// Colliders whose `CollidingEntities` may differ now.
    pub(crate) trackers: EntityIndexSet,
}

impl Reports {
    /// Drops pairs that ended and began again, as when a collider moves to another body.
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
