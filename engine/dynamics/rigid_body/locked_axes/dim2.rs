//! Locked axes of 2D. `dim3.rs` has the locked axes of 3D.

use super::LockedAxes;

impl LockedAxes {
    /// Whether translation along both axes is locked.
    pub const fn is_translation_locked(&self) -> bool {
        self.0 & 0b110_000 == 0b110_000
    }

    /// Locks rotation.
    #[must_use]
    pub const fn lock_rotation(mut self) -> Self {
        self.0 |= 0b000_001;
        self
    }

    /// Unlocks rotation.
    #[must_use]
    pub const fn unlock_rotation(mut self) -> Self {
        self.0 &= !0b000_001;
        self
    }

    /// Whether rotation is locked.
    pub const fn is_rotation_locked(&self) -> bool {
        self.0 & 0b000_001 == 0b000_001
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rotation_is_the_lowest_bit() {
        assert_eq!(LockedAxes::new().lock_rotation().to_bits(), 0b000_001);
        assert!(LockedAxes::new().lock_rotation().is_rotation_locked());
        assert!(!LockedAxes::ROTATION_LOCKED.unlock_rotation().is_rotation_locked());
        assert!(LockedAxes::new().lock_translation_x().lock_translation_y().is_translation_locked());
        assert_eq!(LockedAxes::new().lock_rotation().to_kernel().rotation_factors().z, 0.0);
    }
}
