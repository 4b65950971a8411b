//! Locked axes of 3D. `dim2.rs` has the locked axes of 2D.

use super::LockedAxes;

impl LockedAxes {
    /// Locks translation along the z axis.
    #[must_use]
    pub const fn lock_translation_z(mut self) -> Self {
        self.0 |= 0b001_000;
        self
    }

    /// Unlocks translation along the z axis.
    #[must_use]
    pub const fn unlock_translation_z(mut self) -> Self {
        self.0 &= !0b001_000;
        self
    }

    /// Whether translation along the z axis is locked.
    pub const fn is_translation_z_locked(&self) -> bool {
        self.0 & 0b001_000 != 0
    }

    /// Whether translation along every axis is locked.
    pub const fn is_translation_locked(&self) -> bool {
        self.0 & 0b111_000 == 0b111_000
    }

    /// Locks rotation about the x axis.
    #[must_use]
    pub const fn lock_rotation_x(mut self) -> Self {
        self.0 |= 0b000_100;
        self
    }

    /// Unlocks rotation about the x axis.
    #[must_use]
    pub const fn unlock_rotation_x(mut self) -> Self {
        self.0 &= !0b000_100;
        self
    }

    /// Whether rotation about the x axis is locked.
    pub const fn is_rotation_x_locked(&self) -> bool {
        self.0 & 0b000_100 != 0
    }

    /// Locks rotation about the y axis.
    #[must_use]
    pub const fn lock_rotation_y(mut self) -> Self {
        self.0 |= 0b000_010;
        self
    }

    /// Unlocks rotation about the y axis.
    #[must_use]
    pub const fn unlock_rotation_y(mut self) -> Self {
        self.0 &= !0b000_010;
        self
    }

    /// Whether rotation about the y axis is locked.
    pub const fn is_rotation_y_locked(&self) -> bool {
        self.0 & 0b000_010 != 0
    }

    /// Locks rotation about the z axis.
    #[must_use]
    pub const fn lock_rotation_z(mut self) -> Self {
        self.0 |= 0b000_001;
        self
    }

    /// Unlocks rotation about the z axis.
    #[must_use]
    pub const fn unlock_rotation_z(mut self) -> Self {
        self.0 &= !0b000_001;
        self
    }

    /// Whether rotation about the z axis is locked.
    pub const fn is_rotation_z_locked(&self) -> bool {
        self.0 & 0b000_001 != 0
    }

    /// Whether rotation about every axis is locked.
    pub const fn is_rotation_locked(&self) -> bool {
        self.0 & 0b000_111 == 0b000_111
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_axis_has_its_bit() {
        let locks = LockedAxes::new().lock_translation_z().lock_rotation_x();
        assert_eq!(locks.to_bits(), 0b001_100);
        assert!(locks.is_translation_z_locked() && locks.is_rotation_x_locked());
        assert!(!locks.is_rotation_y_locked() && !locks.is_rotation_z_locked());
        assert!(!locks.is_translation_locked() && !locks.is_rotation_locked());
        let all = locks.lock_rotation_y().lock_rotation_z();
        assert!(all.is_rotation_locked());
        assert_eq!(
            all.unlock_rotation_x().unlock_rotation_y().unlock_rotation_z().unlock_translation_z().to_bits(),
            0
        );
        let factors = locks.to_kernel().rotation_factors();
        assert_eq!([factors.x, factors.y, factors.z], [0.0, 1.0, 1.0]);
    }
}
