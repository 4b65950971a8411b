//! Joint rows, with one joint per lane.
#![expect(unsafe_code, reason = "rows of bodies are shared by threads")]

use super::super::batch::{Filling, SolverPass};
use super::super::pair::Pair;
use super::super::{BodyRow, InvMass, MassRow, RowView, Softness, SubstepParams};
use super::block::{Block, Factors, Locked, Softening};
use super::def::{Axis, AxisSpring, Give, JointDef, Motor};

use super::dim::{ANGLE_AXES, ANGLES, AXES, BLOCK, TURNING, TURNS, coordinate, inverses, units};
use super::orientation::OrientationRow;
use super::place::{Gradient, Masses, Start};
use super::records::Joint;
use super::single::{MotorRow, Single, laws, turns_near};
use super::state::JointReaction;
use crate::math::{Angular, Ids, Lane, Vector};
use crate::tuning::solver::{DIRECT_FREQUENCY, NO_MASS, RIGID_DAMPING, RIGID_FREQUENCY};

/// Method by which rigid coordinates are solved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Hold {
    /// Rows that are solved one by one.
    #[default]
    Row,
    /// A tree that is solved directly.
    Tree,
    /// A tree that is solved directly, without softness.
    Exact,
}

#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub(super) struct Row<N: Lane> {
    pub(super) ids: [N::Ids; 2],
    pub(super) start: Start<N>,
    pub(super) masses: Masses<N>,
    /// Share of the relative velocity that damping removes in a substep: linear and angular.
    pub(super) damping: [N; 2],
    /// 1 if the block uses world axes, because all shifts are locked with the same softness.
    of_world: N,
    pub(super) block: [Locked<N>; BLOCK],
    force: Vector<N>,
    torque: Angular<N>,
    /// The impulse of the orientation motor, N·m·s.
    pub(super) turning: Angular<N>,
    inv_h: f32,
}

/// Total effect of a joint on B: an impulse at its anchor, and a moment.
struct Borne<N> {
    /// Vector from B's centre of mass to its anchor.
    arm: Vector<N>,
    force: Vector<N>,
    torque: Angular<N>,
}

impl<N: Lane> Borne<N> {
    /// Adds an impulse along a gradient.
    #[inline(always)]
    fn add(&mut self, gradient: &Gradient<N>, impulse: N) {
        self.force += gradient.normal * impulse;
        self.torque += (gradient.moments[1] - self.arm.cross(gradient.normal)) * impulse;
    }
}

impl<N: Lane> Default for Row<N> {
    fn default() -> Self {
        Self {
            ids: [N::Ids::splat(0); 2],
            start: Start::NONE,
            masses: Masses::NONE,
            damping: [N::ZERO; 2],
            of_world: N::ZERO,
            block: [Locked::FREE; BLOCK],
            force: Vector::ZERO,
            torque: Angular::ZERO,
            turning: Angular::ZERO,
            inv_h: 0.0,
        }
    }
}

/// Softness coefficients of joints solved by one method, for substeps of one length.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stiffness {
    h: f32,
    /// Bias rate and mass share of rigid coordinates.
    rigid: (f32, f32),
}

impl Stiffness {
    pub(super) fn new(hold: Hold, h: f32) -> Self {
        let rigid = match hold {
            Hold::Row => of_spring(RIGID_FREQUENCY / h, RIGID_DAMPING, h),
            Hold::Tree => of_spring(DIRECT_FREQUENCY / h, RIGID_DAMPING, h),
            Hold::Exact => (RIGID_FREQUENCY / h, NO_MASS),
        };
        Self { h, rigid }
    }

    /// The coefficients of an oscillator: bias rate, share of the mass, additional softness, and whether it
    /// is a spring.
    fn of(&self, give: Give) -> (f32, f32, f32, bool) {
        let h = self.h;
        match give {
            Give::Rigid => (self.rigid.0, self.rigid.1, 0.0, false),
            Give::Spring(spring) => {
                let (rate, share) = of_spring(spring.frequency, spring.damping_ratio, h);
                (rate, share, 0.0, true)
            }
            Give::Compliance(compliance) => (1.0 / h, 0.0, compliance / (h * h), true),
        }
    }
}

/// Bias rate and mass share of a spring.
fn of_spring(frequency: f32, damping_ratio: f32, h: f32) -> (f32, f32) {
    let s = Softness::new(frequency, damping_ratio, h);
    (s.bias_rate, if s.mass_scale > 0.0 { s.impulse_scale / s.mass_scale } else { 0.0 })
}

impl<N: Lane> Softening<N> {
    pub(super) fn set(&mut self, lane: usize, give: Give, stiffness: &Stiffness) {
        let (rate, share, more, is_spring) = stiffness.of(give);
        self.bias_rate.set(lane, rate);
        self.share.set(lane, share);
        self.more.set(lane, more);
        self.is_spring.set(lane, f32::from(u8::from(is_spring)));
    }
}

impl<N: Lane> MotorRow<N> {
    fn set(&mut self, lane: usize, motor: &Motor, h: f32) {
        let (of_mass, besides) = laws(&motor.drive);
        for i in 0..2 {
            self.of_mass[i].set(lane, of_mass[i]);
            self.besides[i].set(lane, besides[i]);
        }
        self.target_velocity.set(lane, motor.target_velocity);
        self.target_position.set(lane, motor.target_position);
        self.most.set(lane, motor.max_force * h);
    }
}

/// The initial guess for a turning angle with limits: `angle` itself if it is between the limits, otherwise
/// their middle or the finite limit.
fn first_guess(angle: f32, [min, max]: [f32; 2]) -> f32 {
    match (min.is_finite(), max.is_finite()) {
        _ if (min..=max).contains(&angle) => angle,
        (true, true) => 0.5 * (min + max),
        (true, false) => min,
        (false, true) => max,
        (false, false) => angle,
    }
}

impl<N: Lane> Single<N> {
    /// Copies a coordinate into a lane. `angle` is the turning angle within one turn.
    fn set(
        &mut self,
        (lane, stiffness): (usize, &Stiffness),
        number: usize,
        (joint, angle): (&Joint, f32),
        params: &SubstepParams,
    ) {
        let Joint { def, state, .. } = joint;
        let axis: &Axis = &def.axes[number];
        match ANGLE_AXES.iter().position(|a| *a == number) {
            Some(k) => self.about[k].set(lane, 1.0),
            None if number == coordinate::DISTANCE => self.apart.set(lane, 1.0),
            None => self.along[number].set(lane, 1.0),
        }
        let [min, max] = axis.limits.unwrap_or([f32::NEG_INFINITY, f32::INFINITY]);
        self.may_contradict.set(lane, f32::from(u8::from(def.has_set_parts(number))));
        self.limits[0].set(lane, min);
        self.limits[1].set(lane, max);
        self.softening.set(lane, axis.give, stiffness);
        let [lower, upper, spring, motor] = state.singles[number].map(|impulse| impulse * params.warm_start);
        self.impulses[0].set(lane, lower);
        self.impulses[1].set(lane, upper);
        if let Some(AxisSpring { rest, law }) = axis.spring {
            let (target_position, target_velocity, max_force) = (rest, 0.0, f32::INFINITY);
            let as_motor = Motor { target_position, target_velocity, max_force, drive: law };
            self.spring.set(lane, &as_motor, params.h);
            self.spring.impulse.set(lane, spring);
        }
        if let Some(of) = &axis.motor {
            self.motor.set(lane, of, params.h);
            // The motor's maximum may have been reduced since the last step.
            let most = of.max_force * params.h;
            self.motor.impulse.set(lane, motor.clamp(-most, most));
        }
        if number == ANGLE_AXES[TURNING] {
            let of_motor = axis.motor.map_or(0.0, |motor| motor.target_position);
            let target = axis.spring.map_or(of_motor, |spring| spring.rest);
            let near = match axis.limits {
                Some(limits) if state.angle.is_nan() => first_guess(angle, limits),
                Some(_) => state.angle,
                None => target,
            };
            let turns = turns_near(angle, near);
            self.turns.set(lane, turns);
            self.near.set(lane, if axis.limits.is_some() { angle + turns } else { target });
            self.counts_turns.set(lane, f32::from(u8::from(axis.limits.is_some())));
        }
    }
}

impl<N: Lane> Row<N> {
    /// Copies a joint into a lane.
    pub(super) fn set(
        &mut self,
        (singles, orientation): (&mut [Single<N>], Option<&mut OrientationRow<N>>),
        (lane, stiffness): (usize, &Stiffness),
        joint: &Joint,
        from: &Filling,
    ) {
        let (table, params) = (from.input.bodies, from.params);
        let Joint { def, summary, state } = joint;
        let bodies = def.bodies;
        let poses = bodies.map(|body| &table.poses[body as usize]);
        for side in 0..2 {
            let row = from.input.row_of(bodies[side]);
            self.ids[side].set(lane, row);
            let frame = &def.frames[side];
            let arm = frame.anchor - table[bodies[side]].local_center;
            self.start.arms[side].set(lane, poses[side].rotation.rotate(arm));
            self.start.bases[side].set(lane, poses[side].rotation.mul(frame.basis).normalized());
            // Axis factors, until the mass is known.
            self.masses.linear[side].set(lane, from.axes.get(row as usize).copied().unwrap_or(Vector::ONE));
        }
        self.inv_h = params.inv_h;
        self.start.offset.set(lane, (poses[1].center - poses[0].center).to_local());
        for (share, rate) in self.damping.iter_mut().zip(def.damping) {
            share.set(lane, rate * params.h / (1.0 + rate * params.h));
        }
        self.of_world.set(lane, f32::from(u8::from(summary.is_locked_alike)));
        for (number, locked) in self.block.iter_mut().enumerate().filter(|(k, _)| summary.is_in_block(*k)) {
            locked.is_locked.set(lane, 1.0);
            locked.target.set(lane, def.axes[number].locked_at().unwrap_or(0.0));
            locked.softening.set(lane, def.axes[number].give, stiffness);
            locked.impulse.set(lane, state.block[number] * params.warm_start);
        }
        if !singles.is_empty() {
            let bases = self.start.bases.map(|basis| basis.get(lane));
            let angle = super::dim::angles::<f32>(bases)[TURNING].0;
            let numbers = (0..AXES).filter(|k| summary.is_single(*k));
            for (number, single) in numbers.zip(singles) {
                single.set((lane, stiffness), number, (joint, angle), params);
            }
        }
        if let (Some(row), Some(motor)) = (orientation, &def.orientation) {
            let impulses = state.orientation.map(|impulse| impulse * params.warm_start);
            row.set(lane, motor, impulses, params.h);
        }
    }

    /// Makes a locked distance the first coordinate of the block in a lane, instead of a single coordinate.
    pub(super) fn take_rod(
        &mut self,
        singles: &mut [Single<N>],
        def: &JointDef,
        (lane, stiffness): (usize, &Stiffness),
    ) {
        let axis = &def.axes[coordinate::DISTANCE];
        let Some(single) = singles.iter_mut().find(|single| single.apart.get(lane) > 0.0) else { return };
        for (limit, none) in single.limits.iter_mut().zip([f32::NEG_INFINITY, f32::INFINITY]) {
            limit.set(lane, none);
        }
        single.impulses.iter_mut().for_each(|impulse| impulse.set(lane, 0.0));
        let rod = &mut self.block[0];
        rod.is_locked.set(lane, 1.0);
        rod.target.set(lane, axis.locked_at().unwrap_or(0.0));
        rod.softening.set(lane, axis.give, stiffness);
    }

    /// Computes derived values, for all lanes at once.
    #[inline(always)]
    pub(super) fn finish(&mut self, masses: &[MassRow]) {
        for side in 0..2 {
            let (inv_mass, inertia) = MassRow::gather::<N>(masses, &self.ids[side]);
            self.masses.linear[side] = InvMass::new(inv_mass, self.masses.linear[side]);
            self.masses.angular[side] = inertia;
        }
    }

    pub(super) fn of_world(&self) -> N::Mask {
        N::ZERO.lt(self.of_world)
    }

    /// Runs a pass. All passes are one function, since it is inlined for every width and size of block.
    ///
    /// # Safety
    /// Until the call returns, no other thread reads or writes the row's writable bodies, or writes the
    /// others.
    #[inline(always)]
    pub(super) unsafe fn run<const D: usize>(
        &mut self,
        (singles, orientation): (&mut [Single<N>], Option<&mut OrientationRow<N>>),
        bodies: &RowView<BodyRow>,
        params: &SubstepParams,
        pass: SolverPass,
    ) {
        // SAFETY: by the contract.
        let (place, mut pair) = unsafe { (self.start.now(bodies, &self.ids), Pair::load(bodies, &self.ids)) };
        let biased = pass == SolverPass::Solve;
        let (arm, of_world) = (place.arm(), self.of_world());
        let mut borne = Borne { arm, force: Vector::ZERO, torque: Angular::ZERO };
        let rows = &mut self.block[..D];
        let block = Block::<N, D>::new(&place, of_world, &self.masses);
        let solved = if pass == SolverPass::WarmStart {
            block.push(rows, &mut pair);
            None
        } else {
            let drift = place.drift(&pair, params.h);
            Some(block.solve(rows, &mut pair, drift, biased))
        };
        let has_more = !singles.is_empty() || orientation.is_some();
        if let Some(motor) = orientation {
            let turning = motor.evaluate(&place);
            match &solved {
                None => {
                    for i in 0..TURNS {
                        self.masses.response(&turning.gradients[i]).push(&mut pair, motor.impulses[i]);
                    }
                }
                Some(solved) => {
                    if biased {
                        motor.solve(&turning, &self.masses, (&block, solved, rows), &mut pair, params.h);
                    }
                    self.turning = Angular::ZERO;
                    for i in 0..TURNS {
                        let (gradient, impulse) = (&turning.gradients[i], motor.impulses[i]);
                        borne.add(gradient, impulse);
                        self.turning += gradient.moments[1] * impulse;
                    }
                }
            }
        }
        let angles = if singles.is_empty() { [(N::ZERO, Angular::ZERO); ANGLES] } else { place.angles() };
        for single in singles {
            let (gradient, value) = single.gradient(&place, &angles);
            let alone = self.masses.response(&gradient);
            match &solved {
                None => alone.push(&mut pair, single.impulse()),
                Some(solved) => {
                    let at = (&gradient, value);
                    single.solve(at, alone, (&block, solved, rows), &mut pair, params, biased);
                    borne.add(&gradient, single.impulse());
                }
            }
        }
        if biased && has_more {
            // Hitting a limit has changed the rotation of the bodies.
            let drift = place.drift(&pair, params.h);
            block.solve(rows, &mut pair, drift, biased);
        }
        for k in 0..D {
            borne.add(&block.gradients[k], rows[k].impulse);
        }
        self.bear(borne.force, borne.torque, params);
        if solved.is_none() && N::any(N::ZERO.lt(self.damping[0] + self.damping[1])) {
            self.damp(&mut pair);
        }
        // SAFETY: by the contract.
        unsafe { pair.store(bodies, &self.ids) };
    }

    /// Removes a share of the relative velocity of the centres of mass and of the relative angular
    /// velocity.
    #[inline(always)]
    pub(super) fn damp(&self, pair: &mut Pair<N>) {
        let [a, b] = [self.masses.linear[0].diagonal(), self.masses.linear[1].diagonal()];
        let impulse = (pair.v[1] - pair.v[0]).scale(inverses(a + b)) * self.damping[0];
        // Lanes without damping keep their bits.
        let [shifts, turns] = [N::ZERO.lt(self.damping[0]), N::ZERO.lt(self.damping[1])];
        pair.v[0] = Vector::select(shifts, pair.v[0] + impulse.scale(a), pair.v[0]);
        pair.v[1] = Vector::select(shifts, pair.v[1] - impulse.scale(b), pair.v[1]);
        let [ia, ib] = self.masses.angular;
        let units = units::<N>();
        let relative = (pair.w[1] - pair.w[0]) * self.damping[1];
        let (mut k, mut wanted) = ([[N::ZERO; TURNS]; TURNS], [N::ZERO; TURNS]);
        for i in 0..TURNS {
            wanted[i] = units[i].dot(relative);
            for j in 0..TURNS {
                k[i][j] = units[j].dot(ia.apply(units[i])) + units[j].dot(ib.apply(units[i]));
            }
        }
        let moments = Factors::of(k).solve(wanted);
        let mut turned = pair.w;
        for i in 0..TURNS {
            turned[0] += ia.apply(units[i] * moments[i]);
            turned[1] -= ib.apply(units[i] * moments[i]);
        }
        pair.w[0] = Angular::select(turns, turned[0], pair.w[0]);
        pair.w[1] = Angular::select(turns, turned[1], pair.w[1]);
    }

    /// Stores the force of the joint on B at its anchor, and its torque.
    #[inline(always)]
    pub(super) fn bear(&mut self, impulse: Vector<N>, moment: Angular<N>, params: &SubstepParams) {
        (self.force, self.torque) = (impulse * N::splat(params.inv_h), moment * N::splat(params.inv_h));
    }

    /// Stores the impulses and the reaction of a lane in its joint.
    pub(super) fn store(
        &self,
        (singles, orientation): (&[Single<N>], Option<&OrientationRow<N>>),
        lane: usize,
        joint: &mut Joint,
    ) {
        let Joint { summary, state, .. } = joint;
        let mut reaction = JointReaction {
            force: self.force.get(lane),
            torque: self.torque.get(lane),
            orientation: self.turning.get(lane) * self.inv_h,
            ..JointReaction::default()
        };
        for (number, locked) in self.block.iter().enumerate().filter(|(k, _)| summary.is_in_block(*k)) {
            state.block[number] = locked.impulse.get(lane);
        }
        let numbers = (0..AXES).filter(|k| summary.is_single(*k));
        for (number, single) in numbers.zip(singles) {
            let [lower, upper] = single.impulses.map(|impulse| impulse.get(lane));
            let [spring, motor] = [&single.spring, &single.motor].map(|row| row.impulse.get(lane));
            state.singles[number] = [lower, upper, spring, motor];
            reaction.motors[number] = motor * self.inv_h;
            if number == ANGLE_AXES[TURNING] && single.counts_turns.get(lane) > 0.0 {
                state.angle = single.near.get(lane);
            }
        }
        if let Some(motor) = orientation {
            state.orientation = motor.impulses.map(|impulse| impulse.get(lane));
        }
        state.reaction = reaction;
    }
}
