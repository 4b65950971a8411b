//! The motor of all angles at once: torque along the rotation vector from the target to the current
//! rotation.
//!
//! With the error e, the relative angular velocity ω and its target ω₀, stiffness k and damping c, the
//! motor applies the impulse
//!
//! λ = −h (k e + c (ω − ω₀)), implicitly: (K + Γ) Δλ = −(ω + b + Γ λ), Γ = 1 / (h (c + h k)), b = (k e − c
//! ω₀) / (c + h k)
//!
//! where K is the inverse inertia that the block leaves free. If k and c are per mass, Γ is a multiple of
//! K. An impulse longer than the maximum is shortened to the maximum.

use super::super::pair::Pair;
use super::block::{Block, Factors, Locked, Solved};
use super::def::OrientationMotor;
use super::dim::{TURNS, rotation_vector, units};
use super::place::{Gradient, Masses, Place, Response};
use super::single::laws;
use crate::math::{Lane, Rot, Vector};
use crate::tuning::solver::NO_MASS;

/// Orientation motors, one per lane.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub(super) struct OrientationRow<N> {
    /// Stiffness and damping, per inertia.
    of_mass: [N; 2],
    /// Additional stiffness and damping, N·m/rad and N·m·s/rad.
    besides: [N; 2],
    /// Target rotation of B's frame in A's.
    target: Rot<N>,
    /// Target angular velocity along A's axes, rad/s.
    velocity: [N; TURNS],
    /// Maximum impulse of a substep, N·m·s. 0 without a motor.
    pub(super) most: N,
    /// Impulses along A's axes, N·m·s.
    pub(super) impulses: [N; TURNS],
}

/// The axes of the motor in a pass, and its errors.
pub(super) struct Turning<N> {
    pub(super) gradients: [Gradient<N>; TURNS],
    /// The error along each axis, rad.
    errors: [N; TURNS],
}

impl<N: Lane> OrientationRow<N> {
    /// No motor.
    pub(super) const NONE: Self = Self {
        of_mass: [N::ZERO; 2],
        besides: [N::ZERO; 2],
        target: Rot::IDENTITY,
        velocity: [N::ZERO; TURNS],
        most: N::ZERO,
        impulses: [N::ZERO; TURNS],
    };

    /// Copies a motor into a lane.
    pub(super) fn set(&mut self, lane: usize, motor: &OrientationMotor, impulses: [f32; TURNS], h: f32) {
        let (of_mass, besides) = laws(&motor.drive);
        for i in 0..2 {
            self.of_mass[i].set(lane, of_mass[i]);
            self.besides[i].set(lane, besides[i]);
        }
        self.target.set(lane, motor.target_rotation.normalized());
        for (i, unit) in units::<f32>().into_iter().enumerate() {
            self.impulses[i].set(lane, impulses[i]);
            self.velocity[i].set(lane, unit.dot(motor.target_velocity));
        }
        self.most.set(lane, motor.max_torque * h);
    }

    /// The motor's gradients and errors at a place.
    #[inline(always)]
    pub(super) fn evaluate(&self, place: &Place<N>) -> Turning<N> {
        let [a, b] = place.bases;
        let error = rotation_vector(b.mul(a.mul(self.target).inverse()));
        let axes = place.turn_axes();
        let mut turning = Turning { gradients: [Gradient::NONE; TURNS], errors: [N::ZERO; TURNS] };
        for i in 0..TURNS {
            turning.gradients[i] = place.gradient(Vector::ZERO, axes[i]);
            turning.errors[i] = axes[i].dot(error);
        }
        turning
    }

    /// Solves the motor, and changes the impulses of the block so that the block stays solved.
    #[inline(always)]
    pub(super) fn solve<const D: usize>(
        &mut self,
        turning: &Turning<N>,
        masses: &Masses<N>,
        (block, solved, rows): (&Block<N, D>, &Solved<N, D>, &mut [Locked<N>]),
        pair: &mut Pair<N>,
        h: f32,
    ) {
        let mut alone = [Response::NONE; TURNS];
        let (mut beside, mut kept) = (alone, [[N::ZERO; D]; TURNS]);
        for i in 0..TURNS {
            alone[i] = masses.response(&turning.gradients[i]);
            (beside[i], kept[i]) = block.beside(solved, alone[i]);
        }
        let changes = self.act(turning, (&beside, &alone), pair, h);
        for i in 0..TURNS {
            beside[i].push(pair, changes[i]);
            for k in 0..D {
                rows[k].impulse -= kept[i][k] * changes[i];
            }
        }
    }

    /// Solves the motor. `responses` are the responses to unit impulses along its axes, `alone` the
    /// responses without other joints. Returns the changes of the impulses.
    #[inline(always)]
    pub(super) fn act(
        &mut self,
        turning: &Turning<N>,
        (responses, alone): (&[Response<N>; TURNS], &[Response<N>; TURNS]),
        pair: &Pair<N>,
        h: f32,
    ) -> [N; TURNS] {
        let h = N::splat(h);
        let [stiffness, damping] = [self.of_mass[0] + self.besides[0], self.of_mass[1] + self.besides[1]];
        let resistance = damping + stiffness * h;
        let drives = N::ZERO.lt(resistance);
        let safe = N::select(drives, resistance, N::ONE);
        let softness = N::ONE / (safe * h);
        let is_of_mass = N::ZERO.lt(self.of_mass[0] + self.of_mass[1]);
        let share = N::select(is_of_mass, softness, N::ZERO);
        let more = N::select(is_of_mass, N::ZERO, softness);
        let Turning { gradients, errors } = turning;
        let mut k = [[N::ZERO; TURNS]; TURNS];
        let mut moves = [N::ZERO; TURNS];
        for i in 0..TURNS {
            let own = responses[i].along(&gradients[i]);
            // The motor cannot rotate about an axis that the block already locks.
            let is_free = (alone[i].along(&gradients[i]) * N::splat(NO_MASS)).lt(own);
            moves[i] = N::select(N::and(is_free, drives), N::ONE, N::ZERO);
            for j in 0..=i {
                k[i][j] = responses[i].along(&gradients[j]) * (moves[i] * moves[j]);
                k[j][i] = k[i][j];
            }
        }
        let mut wanted = [N::ZERO; TURNS];
        for i in 0..TURNS {
            let bias = (stiffness * errors[i] - damping * self.velocity[i]) / safe;
            let mut soft = more * self.impulses[i];
            for j in 0..TURNS {
                soft += share * k[i][j] * self.impulses[j];
            }
            wanted[i] = -(gradients[i].rate(pair) + bias + soft) * moves[i];
        }
        for i in 0..TURNS {
            for j in 0..TURNS {
                k[i][j] = k[i][j] * (N::ONE + share);
            }
            k[i][i] = N::select(N::ZERO.lt(moves[i]), k[i][i] + more, N::ONE);
        }
        let mut changes = Factors::of(k).solve(wanted);
        let (mut after, mut square) = (changes, N::ZERO);
        for i in 0..TURNS {
            after[i] = (self.impulses[i] + changes[i]) * moves[i];
            square += after[i] * after[i];
        }
        let length = square.sqrt();
        let is_long = self.most.lt(length);
        let shorter = N::select(is_long, self.most / N::select(is_long, length, N::ONE), N::ONE);
        for i in 0..TURNS {
            changes[i] = after[i] * shorter - self.impulses[i];
            self.impulses[i] = after[i] * shorter;
        }
        changes
    }
}
