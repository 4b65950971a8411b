//! The dense body rows of one step, which constraint rows refer to by index.

use super::{BodyRow, GainRow, MassRow, RowView, fast_turn::FastTurn, gyro::*, input::RowInput, spin::Spin};
use crate::data::{BitSet, Parts};
use crate::graph::{ColorGraph, ConstraintKind, OVERFLOW};
use crate::math::{Angular, AxisLocks, InvInertia, Rot, Vector, Width};
use crate::tuning::contact::STILL;
use core::sync::atomic::AtomicBool;

/// Acceleration and damping of a body. Constant over a step.
#[derive(Clone, Copy, Debug)]
pub struct Motion {
    /// Acceleration including gravity, m/s².
    pub acceleration: Vector,
    /// Angular acceleration, rad/s².
    pub angular_acceleration: Angular,
    /// Linear damping, 1/s.
    pub linear_damping: f32,
    /// Angular damping, 1/s.
    pub angular_damping: f32,
}

impl Motion {
    /// No acceleration and no damping.
    pub const FREE: Self = Self {
        acceleration: Vector::ZERO,
        angular_acceleration: Angular::ZERO,
        linear_damping: 0.0,
        angular_damping: 0.0,
    };
}

/// Acceleration of a body by forces, in addition to its [`Motion`]. Few bodies have one. Constant over a
/// step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Thrust {
    /// Acceleration in world axes, m/s².
    pub linear: Vector,
    /// Angular acceleration about world axes, rad/s².
    pub angular: Angular,
    /// Acceleration in the body's frame, m/s². It turns with the body in each substep.
    pub local_linear: Vector,
    /// Angular acceleration in the body's frame, rad/s². It turns with the body in each substep.
    pub local_angular: Angular,
}

impl Thrust {
    /// No acceleration.
    pub const NONE: Self = Self {
        linear: Vector::ZERO,
        angular: Angular::ZERO,
        local_linear: Vector::ZERO,
        local_angular: Angular::ZERO,
    };

    /// Whether all numbers are finite.
    pub fn is_finite(&self) -> bool {
        let linear = self.linear.is_finite() && self.local_linear.is_finite();
        linear && self.angular.is_finite() && self.local_angular.is_finite()
    }
}

/// An acceleration that turns with its body.
#[derive(Clone, Copy, Debug)]
pub(super) struct LocalThrust {
    linear: Vector,
    angular: Angular,
    /// Rotation at the start of the step.
    rotation: Rot,
}

impl LocalThrust {
    /// Accelerates the body for `h` seconds, by its rotation now.
    pub(super) fn accelerate(&self, row: &mut BodyRow, h: f32) {
        let (v, w) = row.velocity();
        let rotation = world_rotation(row.delta().1, self.rotation);
        row.set_velocity(v + rotation.rotate(self.linear) * h, w + to_world(rotation, self.angular) * h);
    }
}

/// Limits on a body's velocity, which few bodies have. Constant over a step.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// Locked axes.
    pub locks: AxisLocks,
    /// Maximum speed, m/s. Infinity for no limit.
    pub max_speed: f32,
    /// Maximum angular speed, rad/s. Infinity for no limit.
    pub max_angular_speed: f32,
}

impl Limits {
    /// No limit.
    pub const NONE: Self =
        Self { locks: AxisLocks::NONE, max_speed: f32::INFINITY, max_angular_speed: f32::INFINITY };

    pub(super) fn is_none(&self) -> bool {
        self.locks.0 == 0 && !self.max_speed.is_finite() && !self.max_angular_speed.is_finite()
    }
}

/// At most one item per body row, so that threads that process items write different rows.
#[derive(Clone, Debug)]
pub(super) struct OnceEach<T> {
    list: Vec<(u32, T)>,
    rows: BitSet,
}

impl<T> Default for OnceEach<T> {
    fn default() -> Self {
        Self { list: Vec::new(), rows: BitSet::new() }
    }
}

impl<T> OnceEach<T> {
    pub(super) fn clear(&mut self) {
        self.list.clear();
        self.rows.clear();
    }

    /// Adds an item, unless the row has one. Returns whether it was added.
    #[inline]
    pub(super) fn push(&mut self, row: usize, item: T) -> bool {
        let row = u32::try_from(row).expect("a row is many bytes of memory");
        let is_first = self.rows.insert(row);
        if is_first {
            self.list.push((row, item));
        }
        is_first
    }

    /// Rows with their items. No row is listed twice.
    pub(super) fn list(&self) -> &[(u32, T)] {
        &self.list
    }

    /// As [`list`](Self::list), to change items.
    fn list_mut(&mut self) -> &mut [(u32, T)] {
        &mut self.list
    }

    /// Whether a row has an item.
    pub(super) fn contains(&self, row: u32) -> bool {
        self.rows.contains(row)
    }

    /// As [`list`](Self::list), to be changed by several threads.
    pub(super) fn parts(&mut self) -> Parts<'_, (u32, T)> {
        Parts::of(&mut self.list)
    }
}

/// State of the gains ([`GainRow`]) in a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Gains {
    /// The warm start applies the impulses of constraint rows in each substep.
    #[default]
    Unused,
    /// No substep has run yet.
    Unknown,
    /// The gains hold the velocity changes of the last substep.
    Known,
}

/// One flag per row, set once the row is filled. The flag of row 0, the dummy, is always set.
#[derive(Debug, Default)]
pub(super) struct Claims(pub(super) Vec<AtomicBool>);

impl Clone for Claims {
    /// A copy starts without rows: flags are valid for one step.
    fn clone(&self) -> Self {
        Self::default()
    }
}

impl Claims {
    pub(super) fn reset(&mut self, rows: usize) {
        self.0.clear();
        self.0.resize_with(rows, || AtomicBool::new(false));
        if let Some(dummy) = self.0.first_mut() {
            *dummy = AtomicBool::new(true);
        }
    }
}

/// The bodies of one step. Row 0 is the immovable dummy that static partners and padding refer to.
/// Kinematic bodies follow, then dynamic bodies from [`first_dynamic`](Self::first_dynamic) on. Constraint
/// rows write dynamic rows only.
#[derive(Clone, Debug, Default)]
pub struct BodyRows {
    /// Velocity and displacement.
    pub rows: Vec<BodyRow>,
    /// Inverse masses.
    pub masses: Vec<MassRow>,
    /// Acceleration and damping.
    pub motions: Vec<Motion>,
    /// The velocity change of each body by the impulses of a substep.
    pub(super) gains: Vec<GainRow>,
    pub(super) gains_known: Gains,
    /// Velocity limits of the bodies that have any.
    pub(super) limits: OnceEach<Limits>,
    /// Bodies with free spin. None in 2D.
    pub(super) spins: OnceEach<Spin>,
    /// Accelerations given in the frame of a body.
    pub(super) thrusts: OnceEach<LocalThrust>,
    /// Bodies with constraints that rotate far within the step. Empty in 2D.
    pub(super) fast_turns: OnceEach<FastTurn>,
    /// Whether bodies that rotate far currently have the angular velocity that constraint rows see instead
    /// of the true one.
    pub(super) see_rows: bool,
    /// Rows of bodies with constraints. Filled only if a body rotates far.
    pub(super) constrained: BitSet,
    /// Rows of bodies with a locked rotation axis.
    pub(super) turn_locked: BitSet,
    /// Factors of the inverse mass along each axis, by row: 0 for a locked axis. Empty if all factors are
    /// 1.
    pub(super) axes: Vec<Vector>,
    /// Rows of bodies that were displaced after the last relax pass.
    pub(super) moved: BitSet,
    pub(super) claims: Claims,
    /// SIMD width with which bodies are moved.
    pub(super) width: Width,
    /// Row of the first dynamic body.
    pub(super) first_dynamic: u32,
}

impl BodyRows {
    /// Resizes to `kinematic` and `dynamic` bodies after the dummy, without limits and spins. The content
    /// of rows is stale: every row must be filled.
    pub(super) fn reset(&mut self, kinematic: usize, dynamic: usize) {
        let count = 1 + kinematic + dynamic;
        debug_assert!(u32::try_from(count).is_ok(), "{count} rows have ids of 32 bits");
        self.rows.resize(count, BodyRow::REST);
        self.masses.resize(count, MassRow::default());
        self.motions.resize(count, Motion::FREE);
        self.gains.resize(count, GainRow::default());
        self.gains_known = Gains::Unused;
        self.limits.clear();
        self.spins.clear();
        self.fast_turns.clear();
        self.see_rows = false;
        self.turn_locked.clear();
        self.moved.clear();
        self.thrusts.clear();
        self.axes.clear();
        self.first_dynamic = 1 + kinematic as u32;
        self.set_at_rest(0);
    }

    /// Row of the first dynamic body.
    pub fn first_dynamic(&self) -> u32 {
        self.first_dynamic
    }

    /// Limits a body's velocity, at most once a step. Later calls for the same row are ignored.
    pub fn limit(&mut self, row: usize, limits: Limits) {
        debug_assert!((1..self.rows.len()).contains(&row), "row {row} is a body's");
        let [speed, turn] = [limits.max_speed, limits.max_angular_speed];
        debug_assert!(speed >= 0.0 && turn >= 0.0, "limits are not negative: {limits:?}");
        if limits.is_none() {
            return;
        }
        let is_first = self.limits.push(row, limits);
        debug_assert!(is_first, "body row {row} is limited twice");
        if is_first && limits.locks.rotation() != 0 {
            self.turn_locked.insert(row as u32);
        }
        if is_first && limits.locks.is_translation_held() {
            self.axes.resize(self.rows.len(), Vector::ONE);
            self.axes[row] = limits.locks.translation_factors();
        }
    }

    /// Multiplies the inverse mass that constraints see by `shares`, per axis, and the inverse inertia by
    /// the smallest share.
    pub(super) fn lower_inv_mass(&mut self, row: usize, shares: Vector) {
        let least = shares.min_element();
        let mass = &mut self.masses[row];
        *mass = MassRow::new(mass.inv_mass() * least, mass.inv_inertia().scaled(least));
        if shares != Vector::ONE * least {
            self.axes.resize(self.rows.len(), Vector::ONE);
            self.axes[row] = self.axes[row].scale(shares * (1.0 / least));
        }
    }

    /// Accelerates a dynamic body, whose row must be filled, in each substep. `rotation` is the rotation at
    /// the start of the step. Call it at most once a step per row: later calls add no acceleration in the
    /// body's frame.
    pub fn thrust(&mut self, row: usize, thrust: &Thrust, rotation: Rot) {
        debug_assert!((self.first_dynamic as usize..self.rows.len()).contains(&row), "row {row} is dynamic");
        debug_assert!(thrust.is_finite(), "{thrust:?}");
        let motion = &mut self.motions[row];
        motion.acceleration += thrust.linear;
        motion.angular_acceleration += thrust.angular;
        let (linear, angular) = (thrust.local_linear, thrust.local_angular);
        if linear != Vector::ZERO || angular != Angular::ZERO {
            let is_first = self.thrusts.push(row, LocalThrust { linear, angular, rotation });
            debug_assert!(is_first, "body row {row} is accelerated twice");
        }
    }

    /// Lets the gyroscopic torque turn the spin axis of a dynamic body, unless all moments of
    /// `inv_inertia`, given in the body's frame, are equal. `rotation` is the rotation at the start of the
    /// step. Call it at most once a step per row: later calls are ignored.
    #[inline]
    pub fn spin(&mut self, row: usize, inv_inertia: InvInertia, rotation: Rot) {
        if let Some(spin) = Gyro::of(inv_inertia).map(|gyro| Spin::new(gyro, rotation)) {
            self.add_spin(row, spin);
        }
    }

    #[inline]
    pub(super) fn add_spin(&mut self, row: usize, spin: Spin) {
        debug_assert!((self.first_dynamic as usize..self.rows.len()).contains(&row), "row {row} is dynamic");
        let is_first = self.spins.push(row, spin);
        debug_assert!(is_first, "body row {row} spins twice");
    }

    /// Lists the constrained bodies that rotate far within the step, with substeps of `h` seconds. Bodies
    /// with a locked rotation axis are left out.
    ///
    /// Bodies without constraints are left out as well: every sweep would give them back their velocity
    /// unchanged.
    pub(super) fn find_fast_turns(&mut self, input: &RowInput, colors: &ColorGraph, h: f32) {
        let Self { spins, fast_turns, rows, turn_locked, constrained, .. } = self;
        fast_turns.clear();
        constrained.clear();
        let turns_far = |(row, spin): &&(u32, Spin)| {
            !turn_locked.contains(*row) && spin.gyro().turns_far(rows[*row as usize].velocity().1, h)
        };
        let mut far = spins.list().iter().filter(turns_far).peekable();
        if far.peek().is_none() {
            return;
        }
        colors.bodies().for_each(|body| _ = constrained.insert(input.row_of(body)));
        for kind in ConstraintKind::ALL {
            for &id in colors.constraints(kind, OVERFLOW) {
                let bodies = input.bodies_of(kind, id);
                bodies.into_iter().for_each(|body| _ = constrained.insert(input.row_of(body)));
            }
        }
        for (row, spin) in far.filter(|(row, _)| constrained.contains(*row)) {
            fast_turns.push(*row as usize, FastTurn::new(spin));
        }
    }

    /// Updates free spin after blows displaced bodies: spin restarts from the current rotations. Bodies
    /// that rotate far from now on are added to the list, with the angular velocity that constraint rows
    /// see.
    pub(super) fn follow_blows(&mut self, struck: &BitSet, h: f32) {
        let Self { spins, fast_turns, rows, turn_locked, .. } = self;
        if struck.is_empty() {
            return;
        }
        for (row, spin) in spins.list_mut().iter_mut().filter(|(row, _)| struck.contains(*row)) {
            spin.restart();
            let body = &mut rows[*row as usize];
            let turns_far = !turn_locked.contains(*row) && spin.gyro().turns_far(body.velocity().1, h);
            if turns_far && !fast_turns.contains(*row) {
                let mut fast = FastTurn::new(spin);
                fast.enter(body);
                fast_turns.push(*row as usize, fast);
            }
        }
    }

    /// Restarts free spin from the current rotations, after the embedder changed rotations between two
    /// stages of a substep.
    pub fn restart_spins(&mut self, turned: &BitSet) {
        for (_, spin) in self.spins.list_mut().iter_mut().filter(|(row, _)| turned.contains(*row)) {
            spin.restart();
        }
    }

    /// Rotates the inertia of bodies to `time` seconds after the start of the step. With the inertia at the
    /// start, contacts accelerate the spin of bodies whose principal axes are tilted against the spin axis.
    /// Bodies that rotate far keep the inertia at the start, because their constraints see the start of the
    /// step.
    ///
    /// The relax pass at the end of a substep takes back the velocity change of free spin. The mean time of
    /// these ends is the middle of the step plus half a substep. With the inertia at the middle of the
    /// step, bodies gain a few per cent.
    pub(super) fn turn_inertia(&mut self, time: f32) {
        let Self { spins, fast_turns, rows, masses, turn_locked, .. } = self;
        for (row, _) in spins.list() {
            let half = rows[*row as usize].velocity().1 * time;
            if half.length_squared() > 0.25 * STILL * STILL
                && !turn_locked.contains(*row)
                && !fast_turns.contains(*row)
            {
                masses[*row as usize].turn(half);
            }
        }
    }

    /// Resets the displacement and rotation of a body in this step.
    pub fn reset_delta(&mut self, row: u32) {
        self.rows[row as usize].set_delta(Vector::ZERO, Rot::IDENTITY);
    }

    /// Whether velocities and masses are finite.
    pub(super) fn are_finite(&self) -> bool {
        let velocity = |row: &BodyRow| {
            let (v, w) = row.velocity();
            v.is_finite() && w.is_finite()
        };
        let mass = |mass: &MassRow| mass.inv_mass().is_finite() && mass.inv_mass() >= 0.0;
        self.rows.iter().all(velocity) && self.masses.iter().all(mass)
    }

    /// Fills a row with an immovable body at rest.
    pub fn set_at_rest(&mut self, row: usize) {
        self.rows[row] = BodyRow::REST;
        self.masses[row] = MassRow::default();
        self.motions[row] = Motion::FREE;
    }

    /// Views of rows and gains. Both read all rows and write rows from `first_dynamic` on.
    pub(super) fn views(&mut self, first_dynamic: u32) -> (RowView<'_, BodyRow>, RowView<'_, GainRow>) {
        (RowView::over(&mut self.rows, first_dynamic), RowView::over(&mut self.gains, first_dynamic))
    }

    /// A view that writes kinematic rows as well, for integrating positions.
    pub(super) fn view_all(&mut self) -> RowView<'_, BodyRow> {
        RowView::over(&mut self.rows, 1)
    }
}
