//! Soft-constraint coefficients, and parameters of a substep.

use super::JointSolver;
use crate::math::min;

/// Coefficients of a soft constraint for one substep.
///
/// A damped harmonic oscillator of angular frequency ω and damping ratio ζ, integrated implicitly with
/// time step h: with a₁ = 2ζ + hω, a₂ = hω a₁, a₃ = 1 / (1 + a₂) the constraint is solved with the bias
/// velocity (ω / a₁) C, the mass scaled by a₂ a₃ and a share a₃ of the accumulated impulse subtracted
/// (Catto, "Soft Constraints", GDC 2011; Solver2D).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Softness {
    /// Bias velocity per metre of error, 1/s.
    pub bias_rate: f32,
    /// Factor on the effective mass.
    pub mass_scale: f32,
    /// Share of the accumulated impulse that is subtracted.
    pub impulse_scale: f32,
}

impl Softness {
    /// No softness: velocity error is removed, position error is ignored.
    pub const RIGID: Self = Self { bias_rate: 0.0, mass_scale: 1.0, impulse_scale: 0.0 };

    /// Whether the coefficients are valid for solving a row.
    fn is_valid(&self) -> bool {
        let share = 0.0..=1.0;
        self.bias_rate.is_finite() && share.contains(&self.mass_scale) && share.contains(&self.impulse_scale)
    }

    /// Overlap at rest per velocity change by the impulse of a substep, in seconds. 0 if the constraint has
    /// no spring.
    pub(super) fn sag_rate(&self) -> f32 {
        let spring = self.mass_scale * self.bias_rate;
        if spring > 0.0 { self.impulse_scale / spring } else { 0.0 }
    }

    /// Coefficients for a frequency in Hz, a damping ratio and a time step in seconds. Rigid if the
    /// frequency or the time step is not positive.
    pub fn new(frequency: f32, damping_ratio: f32, h: f32) -> Self {
        let omega = core::f32::consts::TAU * frequency;
        if !(omega > 0.0 && h > 0.0) {
            return Self::RIGID;
        }
        let a1 = 2.0 * damping_ratio + h * omega;
        let a2 = h * omega * a1;
        let a3 = 1.0 / (1.0 + a2);
        Self { bias_rate: omega / a1, mass_scale: a2 * a3, impulse_scale: a3 }
    }
}

/// Parameters of all rows in a substep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SubstepParams {
    /// Length of the substep, in seconds. Positive.
    pub h: f32,
    /// Inverse of `h`, 1/s.
    pub inv_h: f32,
    /// Length of the step, in seconds.
    pub dt: f32,
    /// Softness of contacts between two dynamic bodies.
    pub soft: Softness,
    /// Softness of contacts with an immovable body.
    pub stiff: Softness,
    /// Maximum speed at which overlap is pushed out, m/s.
    pub max_push_speed: f32,
    /// Share of the last impulses for the warm start, 0 to 1.
    pub warm_start: f32,
    /// Minimum approach speed for restitution, m/s.
    pub restitution_threshold: f32,
    /// Minimum approach speed of a blow, m/s. Slower contacts are stopped by the solve and relax passes.
    pub blow_speed: f32,
    /// Separation over which the weight of a point in the friction centre fades, in metres.
    pub friction_fade: f32,
    /// Overlap to which a heavy body may press light ones into each other, in metres, before their mass in
    /// contacts is raised. Positive.
    pub max_sag: f32,
    /// Rolling speed up to which rolling resistance acts fully, m/s. It fades to zero at twice that speed.
    /// 0 turns it off.
    pub roll_speed: f32,
    /// How joints are solved.
    pub joints: JointSolver,
}

impl SubstepParams {
    /// Parameters for a step of `dt` seconds in `substeps` substeps, in a world whose length unit is the
    /// metre.
    ///
    /// The contact frequency is 1.5 times the highest one that step and substeps resolve: the lower of half
    /// the step rate and a quarter of the substep rate (Catto, Solver2D, 2024).
    pub fn new(dt: f32, substeps: u32) -> Self {
        let h = dt / substeps as f32;
        let frequency = 1.5 * min(0.5 / dt, 0.25 / h);
        Self {
            h,
            inv_h: 1.0 / h,
            dt,
            soft: Softness::new(frequency, 10.0, h),
            stiff: Softness::new(2.0 * frequency, 10.0, h),
            max_push_speed: 4.0,
            warm_start: 1.0,
            restitution_threshold: 1.0,
            blow_speed: 0.5,
            friction_fade: 0.02,
            max_sag: 0.005,
            roll_speed: 0.2,
            joints: JointSolver::Auto,
        }
    }

    /// These parameters in a world whose length unit is `length_unit` metres: all lengths and speeds are
    /// multiplied by `length_unit`.
    pub fn in_units_of(self, length_unit: f32) -> Self {
        Self {
            max_push_speed: self.max_push_speed * length_unit,
            restitution_threshold: self.restitution_threshold * length_unit,
            blow_speed: self.blow_speed * length_unit,
            friction_fade: self.friction_fade * length_unit,
            max_sag: self.max_sag * length_unit,
            roll_speed: self.roll_speed * length_unit,
            ..self
        }
    }

    /// Whether the parameters are valid for a substep.
    pub(super) fn is_valid(&self) -> bool {
        let is_step = [self.h, self.inv_h, self.dt].iter().all(|x| x.is_finite() && *x >= 0.0);
        let limits = [
            self.max_push_speed,
            self.restitution_threshold,
            self.blow_speed,
            self.friction_fade,
            self.roll_speed,
        ];
        is_step
            && self.max_sag > 0.0
            && self.soft.is_valid()
            && self.stiff.is_valid()
            && (0.0..=1.0).contains(&self.warm_start)
            && limits.iter().all(|limit| *limit >= 0.0)
    }
}
