//! Limits, springs and motors along a coordinate of a tree of joints: one row of its link.
//!
//! Side by side, each asks for the impulse −G (v + b), with the rate v of the coordinate, a bias b and a conductance G. Together they
//! ask for −ΣG (v + ΣG b / ΣG), which is a row with the softness 1 / ΣG.
//!
//! Which limits act, and which motors are at their maximum, is found by pivoting: a limit that would pull is let go, one that would be
//! passed is added, and the tree is solved again.

use super::super::SubstepParams;
use super::single::{MotorRow, Single};
use super::tree_scratch::Coordinate;
use crate::tuning::solver::NO_MASS;

/// What acts along a coordinate.
const LIMIT: usize = 0;
const SPRING: usize = 1;
const MOTOR: usize = 2;

/// What one of them asks for.
#[derive(Clone, Copy, Debug)]
struct Law {
    /// G. 0 if it does not act.
    conductance: f32,
    bias: f32,
}

impl Law {
    const NONE: Self = Self { conductance: 0.0, bias: 0.0 };

    fn acts(&self) -> bool {
        self.conductance > 0.0
    }

    /// The impulse that it asks for at a rate.
    fn asks(&self, rate: f32) -> f32 {
        -self.conductance * (rate + self.bias)
    }
}

impl MotorRow<f32> {
    /// The law of a substep. What is per mass is per the mass that the coordinate moves in the tree.
    fn law(&self, at: &Coordinate, h: f32) -> Law {
        let [stiffness, damping] = [0, 1].map(|i| match self.of_mass[i] {
            of_mass if of_mass > 0.0 && at.left > 0.0 => of_mass / at.left + self.besides[i],
            _ => self.besides[i],
        });
        let resistance = damping + h * stiffness;
        if self.most <= 0.0 || resistance <= 0.0 {
            return Law::NONE;
        }
        let off = at.value - self.target_position;
        let bias = (stiffness * off - damping * self.target_velocity) / resistance;
        Law { conductance: h * resistance, bias }
    }

    fn is_per_mass(&self) -> bool {
        self.most > 0.0 && self.of_mass != [0.0; 2]
    }
}

impl Single<f32> {
    /// Whether both limits are one: it acts both ways.
    fn is_locked(&self) -> bool {
        self.limits[0] == self.limits[1]
    }

    /// The limit that has an impulse.
    pub(super) fn limit(&self) -> Option<usize> {
        if self.is_locked() { Some(0) } else { self.impulses.iter().position(|impulse| *impulse > 0.0) }
    }

    /// Whether its laws depend on the mass that the coordinate moves.
    pub(super) fn is_per_mass(&self) -> bool {
        self.spring.is_per_mass() || self.motor.is_per_mass()
    }

    /// Whether something acts along it that is warm started.
    pub(super) fn is_warm(&self) -> bool {
        self.spring.most + self.motor.most + self.softening.is_spring > 0.0
    }

    /// What the limit of a side asks for, if it takes part in the pass.
    fn limit_law(&self, side: usize, at: &Coordinate, params: &SubstepParams, biased: bool) -> Law {
        let softening = &self.softening;
        if !biased && softening.is_spring > 0.0 || at.alone <= 0.0 {
            return Law::NONE;
        }
        let past = at.value - self.limits[side];
        let is_open = !self.is_locked() && (if side == 0 { past > 0.0 } else { past < 0.0 });
        let bias_rate = if is_open { params.inv_h } else { softening.bias_rate };
        let bias = if is_open || biased { bias_rate * past } else { 0.0 };
        let gives = if is_open || !biased { 0.0 } else { at.alone * softening.share + softening.more };
        Law { conductance: 1.0 / gives.max(at.alone * NO_MASS), bias }
    }

    /// What limit, spring and motor ask for in a pass.
    fn laws(&self, at: &Coordinate, params: &SubstepParams, biased: bool) -> [Law; 3] {
        let mut laws = [Law::NONE; 3];
        if let Some(side) = at.limit {
            laws[LIMIT] = self.limit_law(side, at, params, biased);
        }
        if biased {
            laws[SPRING] = self.spring.law(at, params.h);
            laws[MOTOR] = if at.is_capped { Law::NONE } else { self.motor.law(at, params.h) };
        }
        laws
    }

    /// The softness of all that acts, if anything does.
    pub(super) fn softness(&self, at: &Coordinate, params: &SubstepParams, biased: bool) -> Option<f32> {
        let sum: f32 = self.laws(at, params, biased).iter().map(|law| law.conductance).sum();
        (sum > 0.0).then(|| 1.0 / sum)
    }

    /// What the row wants at a rate.
    pub(super) fn wanted(&self, at: &Coordinate, rate: f32, params: &SubstepParams, biased: bool) -> f32 {
        let laws = self.laws(at, params, biased);
        let (mut sum, mut asked) = (0.0, 0.0);
        for (law, impulse) in laws.iter().zip(self.parts()).filter(|(law, _)| law.acts()) {
            sum += law.conductance;
            asked += law.conductance * law.bias + impulse;
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

    /// Shares an impulse out, given the rate after it: each takes what it asks for, and the stiffest one the rest.
    pub(super) fn share_out(
        &mut self,
        at: &Coordinate,
        (change, rate): (f32, f32),
        params: &SubstepParams,
        biased: bool,
    ) {
        let laws = self.laws(at, params, biased);
        let stiffest = |a: &usize, b: &usize| laws[*a].conductance.total_cmp(&laws[*b].conductance);
        let stiffest = (0..3).rev().max_by(stiffest).unwrap_or(LIMIT);
        let mut rest = change;
        for part in (0..3).filter(|part| *part != stiffest && laws[*part].acts()) {
            let more = laws[part].asks(rate) - self.parts()[part];
            self.add(at, part, more);
            rest -= more;
        }
        self.add(at, stiffest, rest);
    }

    /// Finds what acts by the rate that was solved for: a limit that would pull is let go, one that would be passed by more than a
    /// speed acts if some may be added, and a motor that exceeds its maximum is held there. Returns the impulse by which those that are
    /// let go or held change, if anything does.
    pub(super) fn pivot(
        &mut self,
        at: &mut Coordinate,
        (rate, tolerance, adds): (f32, f32, bool),
        params: &SubstepParams,
        biased: bool,
    ) -> Option<f32> {
        let mut change = None;
        if biased && self.motor.most > 0.0 {
            let most = self.motor.most;
            if at.is_capped {
                let asked = self.motor.law(at, params.h).asks(rate);
                if adds && asked * self.motor.impulse.signum() < most {
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
            Some(side) if self.impulses[side] < 0.0 => {
                let sign = if side == 0 { 1.0 } else { -1.0 };
                change = Some(change.unwrap_or(0.0) - sign * self.impulses[side]);
                (self.impulses[side], at.limit) = (0.0, None);
            }
            None if adds => {
                let passes = |side: &usize| {
                    let law = self.limit_law(*side, at, params, biased);
                    let sign = if *side == 0 { 1.0 } else { -1.0 };
                    law.acts() && (rate + law.bias) * sign < -tolerance
                };
                at.limit = (0..2).find(passes);
                if at.limit.is_some() {
                    change = Some(change.unwrap_or(0.0));
                }
            }
            _ => {}
        }
        change
    }
}
