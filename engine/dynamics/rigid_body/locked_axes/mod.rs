//! Locked degrees of freedom.

#[cfg_attr(feature = "2d", path = "dim2.rs")]
#[cfg_attr(feature = "3d", path = "dim3.rs")]
mod dim;

use bevy_ecs::prelude::*;
use bevy_reflect::prelude::*;
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};
use derive_more::From;
use kernel::math::AxisLocks;

/// The world axes along or about which the motion of a dynamic body is locked.
///
/// A locked axis acts as an infinite mass or inertia: no force, impulse or contact changes this component of
/// the velocity. The velocity itself is kept, and an app may drive a body along a locked axis.
///
/// The bits, from the highest: translation along x, y, z, then rotation about x, y, z. In 2D translation
/// along z is ignored, and rotation is about z, the lowest bit.
///
/// ```
/// # use avian::prelude::*;
/// // A character that stays upright.
/// let upright = LockedAxes::ROTATION_LOCKED;
/// // One that also moves along the other axes only.
/// let sliding = upright.lock_translation_y();
/// assert!(sliding.is_rotation_locked() && sliding.is_translation_y_locked());
/// assert!(!sliding.is_translation_x_locked());
/// ```
#[derive(Component, Reflect, Clone, Copy, Debug, Default, From, PartialEq, Eq)]
#[reflect(Component, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serialize",
    derive(serde::Serialize, serde::Deserialize),
    reflect(Serialize, Deserialize)
)]
pub struct LockedAxes(u8);

impl LockedAxes {
    /// Translation is locked, rotation is free.
    pub const TRANSLATION_LOCKED: Self = Self(0b111_000);
    /// Rotation is locked, translation is free.
    pub const ROTATION_LOCKED: Self = Self(0b000_111);
    /// Translation and rotation are locked.
    pub const ALL_LOCKED: Self = Self(0b111_111);

    /// Nothing locked.
    pub const fn new() -> Self {
        Self(0)
    }

    /// Makes locks from bits; see the type for their order. The two highest bits are ignored.
    pub const fn from_bits(bits: u8) -> Self {
        Self(bits)
    }

    /// The bits; see the type for their order.
    pub const fn to_bits(&self) -> u8 {
        self.0
    }

    /// The locks in the kernel's type, without the two unused bits.
    pub(crate) const fn to_kernel(self) -> AxisLocks {
        AxisLocks(self.0 & Self::ALL_LOCKED.0)
    }

    /// Locks translation along the x axis.
    #[must_use]
    pub const fn lock_translation_x(mut self) -> Self {
        self.0 |= 0b100_000;
        self
    }

    /// Unlocks translation along the x axis.
    #[must_use]
    pub const fn unlock_translation_x(mut self) -> Self {
        self.0 &= !0b100_000;
        self
    }

    /// Whether translation along the x axis is locked.
    pub const fn is_translation_x_locked(&self) -> bool {
        self.0 & 0b100_000 != 0
    }

    /// Locks translation along the y axis.
    #[must_use]
    pub const fn lock_translation_y(mut self) -> Self {
        self.0 |= 0b010_000;
        self
    }

    /// Unlocks translation along the y axis.
    #[must_use]
    pub const fn unlock_translation_y(mut self) -> Self {
        self.0 &= !0b010_000;
        self
    }

    /// Whether translation along the y axis is locked.
    pub const fn is_translation_y_locked(&self) -> bool {
        self.0 & 0b010_000 != 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn locking_and_unlocking_touch_one_axis() {
        let x = LockedAxes::new().lock_translation_x();
        assert_eq!(x.to_bits(), 0b100_000);
        let xy = x.lock_translation_y();
        assert_eq!(xy.to_bits(), 0b110_000);
        assert!(xy.is_translation_x_locked() && xy.is_translation_y_locked() && !xy.is_rotation_locked());
        assert_eq!(xy.unlock_translation_x().to_bits(), 0b010_000);
        assert_eq!(LockedAxes::ALL_LOCKED.unlock_translation_y().to_bits(), 0b101_111);
        assert_eq!(LockedAxes::from_bits(0b010_001), LockedAxes::from(0b010_001));
    }

    #[test]
    fn the_constants_lock_what_they_say() {
        assert!(LockedAxes::TRANSLATION_LOCKED.is_translation_locked());
        assert!(!LockedAxes::TRANSLATION_LOCKED.is_rotation_locked());
        assert!(LockedAxes::ROTATION_LOCKED.is_rotation_locked());
        assert!(!LockedAxes::ROTATION_LOCKED.is_translation_locked());
        assert!(
            LockedAxes::ALL_LOCKED.is_translation_locked() && LockedAxes::ALL_LOCKED.is_rotation_locked()
        );
        assert_eq!(LockedAxes::default(), LockedAxes::new());
    }

    #[test]
    fn the_kernel_sees_the_same_locks() {
        assert_eq!(LockedAxes::from_bits(0b1101_0000).to_kernel(), AxisLocks(0b010_000));
        assert!(LockedAxes::TRANSLATION_LOCKED.to_kernel().is_translation_held());
        assert!(LockedAxes::new().lock_translation_x().to_kernel().is_translation_held());
        assert_eq!(LockedAxes::TRANSLATION_LOCKED.to_kernel().rotation(), 0);
    }
}
