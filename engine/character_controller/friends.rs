//! Characters that yield to their friends.

use super::{mover::Mover, planning::Planning};
use crate::{
    collision::collider::LayerMask,
    math::{Scalar, Vector},
};

/// Minimum horizontal part of a normal along which characters separate.
const LEVEL: Scalar = 0.05;

impl Planning<'_> {
    /// Moves half of the way out of overlapping friends. The friends move the other half.
    pub(super) fn yield_to_friends(&mut self) {
        let around = self.around;
        let friends = self.controller.friends;
        let farthest = self.controller.yield_speed * self.unit * around.time;
        if friends == LayerMask::NONE || !(farthest > 0.0) {
            return;
        }
        let is_friend = |entity| around.is_friend(friends, entity);
        let mover = &self.walker.mover;
        let friendly = Mover { is_solid: &is_friend, ignored: mover.ignored.clone(), ..*mover };
        let mut way = Vector::ZERO;
        for part in friendly.near(self.walker.position, 0.0) {
            let flat = self.walker.horizontal(part.normal);
            let other = around.bodies.position_of(part.entity);
            // Characters at the same place separate along any direction, signed by the order of their
            // entities.
            let (direction, depth) = if other.is_some_and(|other| self.is_at(other)) {
                let sign = if around.bodies.body_of(part.entity) < Some(self.entity) { 1.0 } else { -1.0 };
                (self.aside() * sign, 2.0 * farthest)
            } else if flat.length() > LEVEL {
                (flat.normalize(), -part.distance / flat.length())
            } else {
                continue;
            };
            way += direction * (0.5 * depth.max(0.0));
        }
        let start = self.walker.position;
        self.walker.shift(way.clamp_length_max(farthest));
        self.moved_on(self.walker.position - start);
    }

    /// Whether a position is above or below the position of the character.
    fn is_at(&self, other: Vector) -> bool {
        self.walker.horizontal(other - self.walker.position).length() < self.walker.mover.skin
    }

    /// A horizontal direction.
    fn aside(&self) -> Vector {
        let up = self.walker.up;
        let axis = Vector::AXES.into_iter().min_by(|a, b| a.dot(up).abs().total_cmp(&b.dot(up).abs()));
        self.walker.horizontal(axis.unwrap_or(Vector::X)).normalize_or_zero()
    }
}
