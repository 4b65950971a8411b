//! Bodies that turn far within a step: constraints see their angular velocity from the step's start.
//!
//! Rows keep the inertia I₀ and the arms of the start of the step. A body that turns within it has another inertia I. A
//! sweep lowers ½ ω · I₀ ω, but not always ½ ω · I ω, which free spin conserves. A thin rod's moments differ by a
//! factor of hundreds, so it gained many times its energy. Arms are off as well: if the axis swings by the angle θ, a
//! spin σ about it moves a point on the axis at the distance l by σ l θ, where it is at rest.
//!
//! Let S be the swing of the thin axis since the step began. Rows see
//!
//! ω₀ = c S⁻¹ ω, with c so that ω₀ · I₀ ω₀ = ω · I ω,
//!
//! and what they make of it is turned back in the same way. No sweep without bias raises the energy then, whatever the
//! rows are. A body of revolution has c = 1, and on its axis the velocity is exact: ω₀ × r₀ = S⁻¹ (ω × S r₀). Impulses
//! are off by the angle θ, as without it.

use super::{BodyRow, gyro::*, spin::Spin};
use crate::math::{Angular, Rot};

/// A body that turns far within this step.
#[derive(Clone, Copy, Debug)]
pub(super) struct FastTurn {
    gyro: Gyro,
    /// Rotation at the start of the step.
    rotation: Rot,
    /// The thin axis at the start of the step, in world axes.
    axis: Angular,
    /// The last angular velocity as rows see it, and the true one that it came from.
    seen: [Angular; 2],
}

impl FastTurn {
    /// A body that turns far, by its free spin.
    pub(super) fn new(spin: &Spin) -> Self {
        let rotation = spin.rotation();
        let axis = spin.gyro().thin_axis(rotation);
        Self { gyro: spin.gyro(), rotation, axis, seen: [Angular::ZERO; 2] }
    }

    /// Sets the angular velocity to the one that rows see.
    pub(super) fn enter(&mut self, row: &mut BodyRow) {
        let ((v, w), turn) = (row.velocity(), row.delta().1);
        let mut start = w;
        if turn != Rot::IDENTITY {
            let seen = to_body(swing_of(self.axis, turn), w);
            start = seen * self.share(w, world_rotation(turn, self.rotation), seen, self.rotation);
        }
        self.seen = [start, w];
        row.set_velocity(v, start);
    }

    /// Sets the angular velocity back to the true one. Without an impulse it has the same bits as before.
    pub(super) fn leave(&mut self, row: &mut BodyRow) {
        let ((v, start), turn) = (row.velocity(), row.delta().1);
        let mut w = start;
        if start == self.seen[0] {
            w = self.seen[1];
        } else if turn != Rot::IDENTITY {
            let now = to_world(swing_of(self.axis, turn), start);
            w = now * self.share(start, self.rotation, now, world_rotation(turn, self.rotation));
        }
        row.set_velocity(v, w);
    }

    /// The factor that gives `to` at one rotation the energy of `from` at another.
    fn share(&self, from: Angular, from_rotation: Rot, to: Angular, to_rotation: Rot) -> f32 {
        let share = self.gyro.energy(from_rotation, from) / self.gyro.energy(to_rotation, to);
        if share > 0.0 && share.is_finite() { share.sqrt() } else { 1.0 }
    }
}
