//! [`SingleContact`]: the result of a contact query.

use crate::math::{Scalar, Vector};
use crate::physics_transform::{Position, Rotation};

/// The deepest or nearest points of two colliders, in their own frames.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SingleContact {
    /// The point on the first collider, in its frame, in metres.
    pub local_point1: Vector,
    /// The point on the second collider, in its frame, in metres.
    pub local_point2: Vector,
    /// The unit normal from the first collider to the second, in the frame of the first.
    pub local_normal1: Vector,
    /// The unit normal from the second collider to the first, in the frame of the second.
    pub local_normal2: Vector,
    /// How deep the colliders overlap, in metres; negative if they are apart.
    pub penetration: Scalar,
}

impl SingleContact {
    /// A contact.
    pub fn new(
        local_point1: Vector,
        local_point2: Vector,
        local_normal1: Vector,
        local_normal2: Vector,
        penetration: Scalar,
    ) -> Self {
        Self { local_point1, local_point2, local_normal1, local_normal2, penetration }
    }

    /// The point on the first collider, in the world.
    pub fn global_point1(&self, position: &Position, rotation: &Rotation) -> Vector {
        position.0 + *rotation * self.local_point1
    }

    /// The point on the second collider, in the world.
    pub fn global_point2(&self, position: &Position, rotation: &Rotation) -> Vector {
        position.0 + *rotation * self.local_point2
    }

    /// The normal from the first collider to the second, in the world. Takes the rotation of the first
    /// collider.
    pub fn global_normal1(&self, rotation: &Rotation) -> Vector {
        *rotation * self.local_normal1
    }

    /// The normal from the second collider to the first, in the world. Takes the rotation of the second
    /// collider.
    pub fn global_normal2(&self, rotation: &Rotation) -> Vector {
        *rotation * self.local_normal2
    }

    /// Exchanges the colliders.
    pub fn flip(&mut self) {
        *self = self.flipped();
    }

    /// The same contact with the colliders exchanged.
    pub fn flipped(&self) -> Self {
        let Self { local_point1, local_point2, local_normal1, local_normal2, penetration } = *self;
        Self::new(local_point2, local_point1, local_normal2, local_normal1, penetration)
    }
}
