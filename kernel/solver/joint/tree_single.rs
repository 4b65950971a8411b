//! Limits, springs and motors along a coordinate of a tree of joints: one row of its link.
//!
//! Side by side, each asks for the impulse −G (v + b), with the rate v of the coordinate, a bias b and a conductance G = a / k + c, where
//! k is what a unit impulse changes beside all rows before. Together they ask for the impulse −ΣG (v + ΣG b / ΣG). A limit that
//! does not give way has no bound on G, and takes what the others leave.
//!
//! Which limits act, and which motors are at their maximum, is found by pivoting: a limit that would pull is let go, one that would be
//! passed is added, and the tree is solved again.

use super::super::SubstepParams;
use super::single::{MotorRow, Single};
use super::tree_scratch::Coordinate;

/// What acts along a coordinate.
const LIMIT: usize = 0;
const SPRING: usize = 1;
const MOTOR: usize = 2;

/// What one of them asks for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Law {
    /// a and c of the conductance. Both 0 if it does not act.
    conductance: [f32; 2],
    bias: f32,
}

impl Law {
    const NONE: Self = Self { conductance: [0.0; 2], bias: 0.0 };

    fn acts(&self) -> bool {
        self.conductance != [0.0; 2]
    }

    /// G, or infinity.
    fn at(&self, k: f32) -> f32 {
        let [of_mass, besides] = self.conductance;
        if of_mass == 0.0 { besides } else { of_mass / k + besides }
    }
}

impl MotorRow<f32> {
    /// The impulse that it asks for in a substep.
    fn law(&self, value: f32, h: f32) -> Law {
        let conductance =
            [self.of_mass, self.besides].map(|[stiffness, damping]| h * (damping + h * stiffness));
        // One of them is 0.
        let [stiffness, damping] = [0, 1].map(|i| self.of_mass[i] + self.besides[i]);
        let resistance = damping + h * stiffness;
        if resistance <= 0.0 {
            return Law::NONE;
        }
        let bias = (stiffness * (value - self.target_position) - damping * self.target_velocity) / resistance;
        Law { conductance, bias }
    }
}

impl Single<f32> {
    /// Whether both limits are one: it acts both ways.
    pub(super) fn is_locked(&self) -> bool {
        self.limits[0] == self.limits[1]
    }

    /// The limit that has an impulse.
    pub(super) fn limit(&self) -> Option<usize> {
        if self.is_locked() { Some(0) } else { self.impulses.iter().position(|impulse| *impulse > 0.0) }
    }

    /// What the limit of a side asks for, if it takes part in the pass.
    fn limit_law(&self, side: usize, value: f32, params: &SubstepParams, biased: bool) -> Law {
        let softening = &self.softening;
        if !biased && softening.is_spring > 0.0 {
            return Law::NONE;
        }
        let past = value - self.limits[side];
        let is_open = !self.is_locked() && (if side == 0 { past > 0.0 } else { past < 0.0 });
        let rigid = [f32::INFINITY, 0.0];
        if is_open {
            return Law { conductance: rigid, bias: past * params.inv_h };
        }
        let conductance = match (softening.share, softening.more) {
            _ if !biased => rigid,
            (share, _) if share > 0.0 => [1.0 / share, 0.0],
            (_, more) if more > 0.0 => [0.0, 1.0 / more],
            _ => rigid,
        };
        Law { conductance, bias: if biased { softening.bias_rate * past } else { 0.0 } }
    }

    /// What limit, spring and motor ask for in a pass.
    fn laws(&self, at: &Coordinate, params: &SubstepParams, biased: bool) -> [Law; 3] {
        let mut laws = [Law::NONE; 3];
        if let Some(side) = at.limit {
            laws[LIMIT] = self.limit_law(side, at.value, params, biased);
        }
        if biased {
            laws[SPRING] =
                if self.spring.most > 0.0 { self.spring.law(at.value, params.h) } else { Law::NONE };
            let drives = self.motor.most > 0.0 && !at.is_capped;
            laws[MOTOR] = if drives { self.motor.law(at.value, params.h) } else { Law::NONE };
        }
        laws
    }

    /// The conductance of all that acts, if anything does.
    pub(super) fn conductance(
        &self,
        at: &Coordinate,
        params: &SubstepParams,
        biased: bool,
    ) -> Option<[f32; 2]> {
        let laws = self.laws(at, params, biased);
        let sum = |i: usize| laws.iter().map(|law| law.conductance[i]).sum();
        laws.iter().any(Law::acts).then(|| [sum(0), sum(1)])
    }

    /// What the row wants, given the rate and k.
    pub(super) fn wanted(
        &self,
        at: &Coordinate,
        rate: f32,
        k: f32,
        params: &SubstepParams,
        biased: bool,
    ) -> f32 {
        let laws = self.laws(at, params, biased);
        if laws[LIMIT].at(k) == f32::INFINITY {
            return -(rate + laws[LIMIT].bias);
        }
        let impulses = self.parts();
        let (mut sum, mut asked) = (0.0, 0.0);
        for (law, impulse) in laws.iter().zip(impulses).filter(|(law, _)| law.acts()) {
            sum += law.at(k);
            asked += law.at(k) * law.bias + impulse;
        }
        -(rate + asked / sum)
    }

    /// The impulses of limit, spring and motor.
    fn parts(&self) -> [f32; 3] {
        [self.impulses[0] - self.impulses[1], self.spring.impulse, self.motor.impulse]
    }

    /// Adds to the impulse of one of them.
    fn add(&mut self, at: &Coordinate, part: usize, change: f32) {
        match (part, at.limit) {
            (LIMIT, Some(1)) => self.impulses[1] -= change,
            (LIMIT, _) => self.impulses[0] += change,
            (SPRING, _) => self.spring.impulse += change,
            _ => self.motor.impulse += change,
        }
    }

    /// Shares an impulse out, given the rate after it and k: each takes what it asks for, and the stiffest one the rest.
    pub(super) fn share_out(
        &mut self,
        at: &Coordinate,
        (change, rate, k): (f32, f32, f32),
        params: &SubstepParams,
        biased: bool,
    ) {
        let laws = self.laws(at, params, biased);
        let stiffest = (0..3).rev().max_by(|a, b| laws[*a].at(k).total_cmp(&laws[*b].at(k))).unwrap_or(LIMIT);
        let mut rest = change;
        for part in (0..3).filter(|part| *part != stiffest && laws[*part].acts()) {
            let more = -laws[part].at(k) * (rate + laws[part].bias) - self.parts()[part];
            self.add(at, part, more);
            rest -= more;
        }
        self.add(at, stiffest, rest);
    }

    /// Finds what acts by the rate that was solved for: a limit that would pull is let go, one that would be passed by more than a
    /// speed acts, and a motor that exceeds its maximum is held there. Returns the impulse by which those that are let go or held
    /// change, if anything does.
    pub(super) fn pivot(
        &mut self,
        at: &mut Coordinate,
        (rate, k, tolerance): (f32, f32, f32),
        params: &SubstepParams,
        biased: bool,
    ) -> Option<f32> {
        let mut change = None;
        if biased && self.motor.most > 0.0 {
            let most = self.motor.most;
            let law = self.motor.law(at.value, params.h);
            if at.is_capped {
                let asked = -law.at(k) * (rate + law.bias);
                if asked * self.motor.impulse.signum() < most {
                    at.is_capped = false;
                    change = Some(0.0);
                }
            } else if self.motor.impulse.abs() > most {
                let held = self.motor.impulse.clamp(-most, most);
                change = Some(held - self.motor.impulse);
                (self.motor.impulse, at.is_capped) = (held, true);
            }
        }
        match at.limit {
            _ if self.is_locked() => {}
            Some(side) => {
                if self.impulses[side] < 0.0 {
                    let sign = if side == 0 { 1.0 } else { -1.0 };
                    change = Some(change.unwrap_or(0.0) - sign * self.impulses[side]);
                    (self.impulses[side], at.limit) = (0.0, None);
                }
            }
            None => {
                let passes = |side: &usize| {
                    let law = self.limit_law(*side, at.value, params, biased);
                    let sign = if *side == 0 { 1.0 } else { -1.0 };
                    law.acts() && (rate + law.bias) * sign < -tolerance
                };
                at.limit = (0..2).find(passes);
                if at.limit.is_some() {
                    change = Some(change.unwrap_or(0.0));
                }
            }
        }
        change
    }
}
