//! Free spin: none in 2D. `spin3.rs` exports the same name.
#![expect(unsafe_code, reason = "the interface is that of 3D")]

use super::{BodyRow, RowView, gyro::*};
use crate::math::{Lane, Rot};

/// A body with free spin: there is none in 2D.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spin;

impl Spin {
    /// A body with this rotation at the start of the step.
    pub(super) fn new(_gyro: Gyro, _rotation: Rot) -> Self {
        Self
    }

    /// The inertia.
    pub(super) fn gyro(&self) -> Gyro {
        Gyro
    }

    /// Rotation at the start of the step.
    pub(super) fn rotation(&self) -> Rot {
        Rot::IDENTITY
    }

    /// Nothing in 2D.
    pub(super) fn restart(&mut self) {}

    /// Nothing in 2D.
    ///
    /// # Safety
    /// None is needed.
    pub(super) unsafe fn begin_turns<N: Lane>(_: &mut [(u32, Self)], _: &RowView<BodyRow>, _: f32) {}

    /// As [`begin_turns`](Self::begin_turns).
    ///
    /// # Safety
    /// None is needed.
    pub(super) unsafe fn end_turns<N: Lane>(_: &mut [(u32, Self)], _: &RowView<BodyRow>) {}
}
