//! Changes of velocity that are pending until the next step.

use bevy_ecs::prelude::*;
use core::ops::{Add, Sub};

use crate::math::{AngularVector, Scalar, Vector};

/// Velocity changes by [`Forces`](super::Forces) in a query that also reads the velocity and therefore cannot
/// write it at once. The next step applies them.
#[derive(Component, Clone, Debug, Default)]
pub struct PushedVelocity {
    pub(super) linear: Push<Vector>,
    pub(super) angular: Push<AngularVector>,
}

impl PushedVelocity {
    /// Whether a change is pending.
    pub(super) fn is_set(&self) -> bool {
        self.linear.0.is_some() || self.angular.0.is_some()
    }
}

/// A velocity before and after its change.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Push<V>(Option<[V; 2]>);

impl<V: Quantity> Push<V> {
    /// The changed velocity, given the component's current value. If the app wrote the component since, both
    /// changes add up.
    pub(super) fn of(&self, current: V) -> V {
        match self.0 {
            Some([from, to]) if current == from => to,
            Some([from, to]) => current + (to - from),
            None => current,
        }
    }

    /// Starts or continues a change. Returns the changed velocity, to be written.
    pub(super) fn start(&mut self, current: V) -> &mut V {
        let to = self.of(current);
        &mut self.0.insert([current, to])[1]
    }

    /// Ends the change, if there is one. Returns the changed velocity.
    pub(super) fn take(&mut self, current: V) -> Option<V> {
        let to = self.of(current);
        self.0.take().map(|_| to)
    }
}

/// A number or vector.
pub trait Quantity: Copy + Default + PartialEq + Add<Output = Self> + Sub<Output = Self> {
    /// Whether all components are finite.
    fn is_number(self) -> bool;

    /// The difference, or zero if it is not finite.
    fn less(self, other: Self) -> Self {
        let rest = self - other;
        if self == other || !rest.is_number() { Self::default() } else { rest }
    }
}

impl Quantity for Scalar {
    fn is_number(self) -> bool {
        self.is_finite()
    }
}

impl Quantity for Vector {
    fn is_number(self) -> bool {
        self.is_finite()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_change_is_exact_and_adds_to_what_the_app_wrote_since() {
        let mut push = Push::<Scalar>::default();
        assert_eq!((push.of(0.1), push.take(0.1)), (0.1, None));
        *push.start(0.1) += 0.2;
        *push.start(0.1) += 1.0;
        assert_eq!(push.of(0.1), 0.1 + 0.2 + 1.0);
        assert!((push.of(5.0) - 6.2).abs() < 1e-6);
        assert_eq!(push.take(0.1), Some(0.1 + 0.2 + 1.0));
        assert_eq!(push.of(0.1), 0.1);
    }
}
