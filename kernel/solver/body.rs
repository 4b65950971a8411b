//! The dense bodies of one step: rows that contact rows refer to by index.

use super::{BodyRow, MassRow, RowView};
use crate::math::{Angular, AxisLocks, InvInertia, Rot, Vector};

/// How a body's velocity changes by itself, and what limits it. Constant over a step.
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
    /// m/s; infinity for no limit.
    pub max_speed: f32,
    /// rad/s; infinity for no limit.
    pub max_angular_speed: f32,
    /// Axes along or about which the body does not move.
    pub locks: AxisLocks,
    /// The inverse inertia in the body's frame, for the gyroscopic torque.
    pub local_inv_inertia: InvInertia,
    /// The body's rotation when the step begins.
    pub rotation: Rot,
}

impl Motion {
    /// No acceleration, no damping, no limit.
    pub const FREE: Self = Self {
        acceleration: Vector::ZERO,
        angular_acceleration: Angular::ZERO,
        linear_damping: 0.0,
        angular_damping: 0.0,
        max_speed: f32::INFINITY,
        max_angular_speed: f32::INFINITY,
        locks: AxisLocks::NONE,
        local_inv_inertia: InvInertia::ZERO,
        rotation: Rot::IDENTITY,
    };
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
    /// The first row of a dynamic body.
    pub(super) first_dynamic: u32,
}

impl BodyRows {
    /// Makes room for `kinematic` and `dynamic` bodies after the dummy. Rows hold what they held before: every
    /// one of them is to be filled.
    pub fn reset(&mut self, kinematic: usize, dynamic: usize) {
        let count = 1 + kinematic + dynamic;
        self.rows.resize(count, BodyRow::REST);
        self.masses.resize(count, MassRow::default());
        self.motions.resize(count, Motion::FREE);
        self.first_dynamic = 1 + kinematic as u32;
        self.still(0);
    }

    /// The first row of a dynamic body.
    pub fn first_dynamic(&self) -> u32 {
        self.first_dynamic
    }

    /// Forgets how far a body has moved and turned in this step.
    pub fn put_back(&mut self, row: u32) {
        self.rows[row as usize].set_delta(Vector::ZERO, Rot::IDENTITY);
    }

    /// Fills a row with a body at rest that nothing moves.
    pub fn still(&mut self, row: usize) {
        self.rows[row] = BodyRow::REST;
        self.masses[row] = MassRow::default();
        self.motions[row] = Motion::FREE;
    }

    /// A view through which rows of disjoint bodies can be read and written; only dynamic bodies are.
    pub(super) fn view(&mut self) -> RowView<'_, BodyRow> {
        RowView::over(&mut self.rows, self.first_dynamic)
    }

    /// A view that writes kinematic bodies too, for integrating positions.
    pub(super) fn view_all(&mut self) -> RowView<'_, BodyRow> {
        RowView::over(&mut self.rows, 1)
    }
}
