//! Frames of a body's parts, and validation of the app's numbers.

#[cfg(feature = "2d")]
pub(in super::super) use bevy_math::{DMat2 as Matrix64, DVec2 as Vector64};
#[cfg(feature = "3d")]
pub(in super::super) use bevy_math::{DMat3 as Matrix64, DVec3 as Vector64};

/// Represents infinity in finite sums. Other masses vanish beside it, and no result contains it.
pub(in super::super) const HUGE: f64 = 1e60;

/// A valid number: NaN and negative values become 0, infinity becomes [`HUGE`].
pub(in super::super) fn sanitize(value: f32) -> f64 {
    // NaN fails the comparison.
    if value > 0.0 { f64::from(value).min(HUGE) } else { 0.0 }
}

/// Narrows to `f32`. Numbers beyond its range become infinite.
pub(in super::super) fn narrow(value: f64) -> f32 {
    value as f32
}

/// The frame of a part in its body's frame.
#[derive(Clone, Copy, Debug)]
pub(in super::super) struct PartFrame {
    /// Translation, in metres.
    pub(in super::super) translation: Vector64,
    /// Rotation. Products of `f64` matrices with vectors are the same on every machine.
    pub(in super::super) rotation: Matrix64,
    /// Scale of lengths in the part's frame.
    pub(in super::super) scale: Vector64,
}

impl PartFrame {
    /// The frame `inner`, which is given in this frame. Shear, from a rotation inside an uneven scale, is
    /// dropped.
    pub(in super::super) fn then(&self, inner: &PartFrame) -> Self {
        Self {
            translation: self.translation + self.rotation * (self.scale * inner.translation),
            rotation: self.rotation * inner.rotation,
            scale: self.scale * inner.scale,
        }
    }
}
