//! Frames of a body's parts, and numbers of the user made usable.

#[cfg(feature = "2d")]
pub(in super::super) use bevy_math::{DMat2 as Matrix64, DVec2 as Vector64};
#[cfg(feature = "3d")]
pub(in super::super) use bevy_math::{DMat3 as Matrix64, DVec3 as Vector64};

/// Stands for infinity, so that sums stay defined: what it weighs vanishes beside it, itself in no result.
pub(in super::super) const HUGE: f64 = 1e60;

/// A user's number that ought to be zero or more, as one that is: NaN and negative give 0, infinity [`HUGE`].
pub(in super::super) fn sanitize(value: f32) -> f64 {
    // NaN fails the comparison.
    if value > 0.0 { f64::from(value).min(HUGE) } else { 0.0 }
}

/// To `f32`; what is beyond it is infinite.
pub(in super::super) fn narrow(value: f64) -> f32 {
    value as f32
}

/// Where a part's frame lies in its body's.
#[derive(Clone, Copy, Debug)]
pub(in super::super) struct Frame {
    /// In metres.
    pub(in super::super) translation: Vector64,
    /// As a matrix, whose products with vectors are the same on every machine.
    pub(in super::super) rotation: Matrix64,
    /// What lengths given inside are to be multiplied with.
    pub(in super::super) scale: Vector64,
}

impl Frame {
    /// The frame that `inner` describes within this one. Shear, which a turn inside an uneven scale would make,
    /// is left out.
    pub(in super::super) fn then(&self, inner: &Frame) -> Self {
        Self {
            translation: self.translation + self.rotation * (self.scale * inner.translation),
            rotation: self.rotation * inner.rotation,
            scale: self.scale * inner.scale,
        }
    }
}
