//! The dense bodies of one step: rows that contact rows refer to by index.

use super::{BodyRow, MassRow, RowView, gyro::*};
use crate::data::{BitSet, Parts};
use crate::math::{Angular, AxisLocks, InvInertia, Rot, Vector};
use core::sync::atomic::AtomicBool;

/// How a body's velocity changes by itself. Constant over a step.
#[derive(Clone, Copy, Debug)]
pub struct Motion {
    /// m/s², gravity included.
    pub acceleration: Vector,
    /// rad/s².
    pub angular_acceleration: Angular,
    /// 1/s.
    pub linear_damping: f32,
    /// 1/s.
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

/// What few bodies have: something that limits their velocity. Constant over a step.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// Axes along or about which the body does not move.
    pub locks: AxisLocks,
    /// m/s; infinity for no limit.
    pub max_speed: f32,
    /// rad/s; infinity for no limit.
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

/// A body that its own spin turns.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spin {
    pub(super) row: u32,
    pub(super) gyro: Gyro,
    /// When the step begins.
    pub(super) rotation: Rot,
    /// The angular velocity after the last substep, in the body's frame and in world axes.
    after: [Angular; 2],
}

impl Spin {
    pub(super) fn new(row: u32, gyro: Gyro, rotation: Rot) -> Self {
        Self { row, gyro, rotation, after: [Angular::ZERO; 2] }
    }

    /// Gives the body the angular velocity at which it turns in the middle of the substep.
    pub(super) fn begin_turn(&mut self, row: &mut BodyRow, h: f32) {
        let (v, w) = row.velocity();
        let rotation = world_rotation(row.delta().1, self.rotation);
        // Only what has changed since the last substep is turned into the body's frame: in free spin nothing is rounded.
        let local = self.after[0] + to_body(rotation, w - self.after[1]);
        let (middle, after) = self.gyro.spun(local, h);
        self.after[0] = after;
        row.set_velocity(v, to_world(rotation, middle));
    }

    /// Gives the turned body the angular velocity that it has at the end of the substep.
    pub(super) fn end_turn(&mut self, row: &mut BodyRow) {
        let (v, _) = row.velocity();
        self.after[1] = to_world(world_rotation(row.delta().1, self.rotation), self.after[0]);
        row.set_velocity(v, self.after[1]);
    }
}

/// What some body rows have, each once: their threads write these rows.
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
    fn clear(&mut self) {
        self.list.clear();
        self.rows.clear();
    }

    /// Adds what a row has, unless it has something already. Returns whether it had nothing.
    #[inline]
    fn push(&mut self, row: usize, item: T) -> bool {
        let row = u32::try_from(row).expect("a row is many bytes of memory");
        let is_first = self.rows.insert(row);
        if is_first {
            self.list.push((row, item));
        }
        is_first
    }

    /// Rows and what they have: no row twice.
    pub(super) fn list(&self) -> &[(u32, T)] {
        &self.list
    }

    /// As [`list`](Self::list), each row's to be changed by one thread.
    pub(super) fn parts(&mut self) -> Parts<'_, (u32, T)> {
        Parts::of(&mut self.list)
    }
}

/// Which rows are filled; row 0, the dummy, always is.
#[derive(Debug, Default)]
pub(super) struct Claims(pub(super) Vec<AtomicBool>);

impl Clone for Claims {
    /// A copy is for steps of its own.
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

/// The bodies of one step. Row 0 is the immovable dummy that static partners and padding refer to; then
/// come the kinematic bodies, then the dynamic ones from [`first_dynamic`](Self::first_dynamic). Only
/// dynamic rows are ever written by contact rows.
#[derive(Clone, Debug, Default)]
pub struct BodyRows {
    /// Velocity and motion.
    pub rows: Vec<BodyRow>,
    /// Inverse masses.
    pub masses: Vec<MassRow>,
    /// What changes velocities.
    pub motions: Vec<Motion>,
    /// What limits the few that are limited.
    pub(super) limits: OnceEach<Limits>,
    /// Those that their own spin turns: none in 2D.
    pub(super) spins: OnceEach<Spin>,
    /// Which axes are held, by row; empty if no body is held along any.
    pub(super) locks: Vec<AxisLocks>,
    pub(super) claims: Claims,
    /// The first row of a dynamic body.
    pub(super) first_dynamic: u32,
}

impl BodyRows {
    /// Makes room for `kinematic` and `dynamic` bodies after the dummy. Rows hold what they held before: every
    /// one of them is to be filled. Nobody is limited.
    pub(super) fn reset(&mut self, kinematic: usize, dynamic: usize) {
        let count = 1 + kinematic + dynamic;
        debug_assert!(u32::try_from(count).is_ok(), "{count} rows have ids of 32 bits");
        self.rows.resize(count, BodyRow::REST);
        self.masses.resize(count, MassRow::default());
        self.motions.resize(count, Motion::FREE);
        self.limits.clear();
        self.spins.clear();
        self.locks.clear();
        self.first_dynamic = 1 + kinematic as u32;
        self.still(0);
    }

    /// The first row of a dynamic body.
    pub fn first_dynamic(&self) -> u32 {
        self.first_dynamic
    }

    /// Limits a body's velocity: at most once a step. What comes after the first time counts for nothing.
    pub fn limit(&mut self, row: usize, limits: Limits) {
        debug_assert!((1..self.rows.len()).contains(&row), "row {row} is a body's");
        let [speed, turn] = [limits.max_speed, limits.max_angular_speed];
        debug_assert!(speed >= 0.0 && turn >= 0.0, "limits are not negative: {limits:?}");
        if limits.is_none() {
            return;
        }
        let is_first = self.limits.push(row, limits);
        debug_assert!(is_first, "body row {row} is limited twice");
        if is_first && limits.locks.is_translation_held() {
            self.locks.resize(self.rows.len(), AxisLocks::NONE);
            self.locks[row] = limits.locks;
        }
    }

    /// Has a dynamic body turn by its own spin, if its inverse inertia, in its own frame, makes it: at most once a
    /// step. `rotation` is the body's when the step begins. What comes after the first time counts for nothing.
    #[inline]
    pub fn spin(&mut self, row: usize, inv_inertia: InvInertia, rotation: Rot) {
        let spin = Gyro::of(inv_inertia).map(|gyro| Spin::new(row as u32, gyro, rotation));
        if let Some(spin) = spin {
            self.add_spin(spin);
        }
    }

    #[inline]
    pub(super) fn add_spin(&mut self, spin: Spin) {
        debug_assert!(
            (self.first_dynamic..self.rows.len() as u32).contains(&spin.row),
            "row {} is dynamic",
            spin.row
        );
        let is_first = self.spins.push(spin.row as usize, spin);
        debug_assert!(is_first, "body row {} spins twice", spin.row);
    }

    /// Has the contacts of the step see what inertia they may of bodies that swing fast; `h` is the length of a substep.
    pub(super) fn blunt(&mut self, h: f32) {
        for (_, spin) in self.spins.list() {
            let (mass, w) = (self.masses[spin.row as usize], self.rows[spin.row as usize].velocity().1);
            if let Some(inertia) = spin.gyro.in_step(mass.inv_inertia(), w, spin.rotation, h) {
                self.masses[spin.row as usize] = MassRow::new(mass.inv_mass(), inertia);
            }
        }
    }

    /// Forgets how far a body has moved and turned in this step.
    pub fn put_back(&mut self, row: u32) {
        self.rows[row as usize].set_delta(Vector::ZERO, Rot::IDENTITY);
    }

    /// Whether all that contact rows are built from is finite.
    pub(super) fn are_finite(&self) -> bool {
        let velocity = |row: &BodyRow| {
            let (v, w) = row.velocity();
            v.is_finite() && w.is_finite()
        };
        let mass = |mass: &MassRow| mass.inv_mass().is_finite() && mass.inv_mass() >= 0.0;
        self.rows.iter().all(velocity) && self.masses.iter().all(mass)
    }

    /// Fills a row with a body at rest that nothing moves.
    pub fn still(&mut self, row: usize) {
        self.rows[row] = BodyRow::REST;
        self.masses[row] = MassRow::default();
        self.motions[row] = Motion::FREE;
    }

    /// A view through which rows of disjoint bodies can be read and written, the latter from `first_dynamic` on.
    pub(super) fn view(&mut self, first_dynamic: u32) -> RowView<'_, BodyRow> {
        RowView::over(&mut self.rows, first_dynamic)
    }

    /// A view that writes kinematic bodies too, for integrating positions.
    pub(super) fn view_all(&mut self) -> RowView<'_, BodyRow> {
        RowView::over(&mut self.rows, 1)
    }
}
