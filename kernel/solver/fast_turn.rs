//! Bodies that rotate far within a step: constraints see their angular velocity as of the step's start.
//!
//! Rows keep the inertia I₀ and the arms of the start of the step. A body that rotates within it has
//! another inertia I. A sweep lowers ½ ω · I₀ ω, but not always ½ ω · I ω, which free spin conserves. The
//! moments of a thin rod differ by a factor of hundreds, so it gained many times its energy. Arms are off
//! as well: if the axis swings by the angle θ, a spin σ about it moves a point on the axis at the distance
//! l by σ l θ, although that point is at rest.
//!
//! Let S be the swing of the thin axis since the step began. Rows see
//!
//! ω₀ = c S⁻¹ ω, with c so that ω₀ · I₀ ω₀ = ω · I ω,
//!
//! and the angular velocity after the sweep is turned back in the same way. A sweep without bias then never
//! raises the energy, for any rows. A body of revolution has c = 1, and on its axis the velocity is exact:
//! ω₀ × r₀ = S⁻¹ (ω × S r₀). Impulses are off by the angle θ, as without this correction.

use super::{BodyRow, gyro::*, spin::Spin};
use crate::math::{Angular, Rot};

/// A body that rotates far within this step.
#[derive(Clone, Copy, Debug)]
pub(super) struct FastTurn {
    gyro: Gyro,
    /// Rotation at the start of the step.
    rotation: Rot,
    /// The thin axis at the start of the step, in world axes.
    axis: Angular,
    /// The last angular velocity that rows see, and the true one it was computed from.
    seen: [Angular; 2],
}

impl FastTurn {
    /// A body that rotates far, from its free spin.
    pub(super) fn new(spin: &Spin) -> Self {
        let rotation = spin.rotation();
        let axis = spin.gyro().thin_axis(rotation);
        Self { gyro: spin.gyro(), rotation, axis, seen: [Angular::ZERO; 2] }
    }

    /// Replaces the true angular velocity by the one that rows see.
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

    /// Restores the true angular velocity, with the same bits as before if no impulse acted.
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

    /// The factor by which `to` at one rotation gets the energy of `from` at another.
    fn share(&self, from: Angular, from_rotation: Rot, to: Angular, to_rotation: Rot) -> f32 {
        let share = self.gyro.energy(from_rotation, from) / self.gyro.energy(to_rotation, to);
        if share > 0.0 && share.is_finite() { share.sqrt() } else { 1.0 }
    }
}
