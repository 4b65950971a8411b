//! A body and a joint of trees of equal shape, one tree per lane.

use super::super::BodyRows;
use super::super::batch::{SolverPass, Sweep};
use super::super::pair::Pair;
use super::block::{coordinates, wrapped};
use super::dim::{ANGLES, BLOCK, DOF, lacking, numbers, of_numbers};
use super::elimination::{self, Link, LinkRow, Screw, motion};
use super::orientation::OrientationRow;
use super::place::{Gradient, Place};
use super::row::Row;
use super::tree_single::is;
use crate::math::{Angular, DIM, Ids, InvInertia, Lane, Num, Vector};
use crate::tuning::solver::{NO_MASS, SMALL_TURN};
use core::ops::Range;

/// Softness of a spring in the relax pass, where springs take no part, as a multiple of the inverse mass.
const LOOSE: f32 = 1.0e12;

/// A body of a tree, with its true mass, which contacts may see raised.
#[derive(Clone, Copy, Debug)]
pub(super) struct ListedBody {
    pub(super) row: u32,
    /// Inverse mass along each world axis, 1/kg. 0 along locked axes.
    linear: Vector,
    /// Inverse inertia at the start of the step.
    angular: InvInertia,
    /// Whether its inertia rotates with it.
    turns: bool,
}

impl ListedBody {
    pub(super) fn new(row: u32, rows: &BodyRows) -> Self {
        let (mass, turns) = (&rows.masses[row as usize], !rows.turn_locked.contains(row));
        let (axes, angular) = (rows.axes.get(row as usize).copied(), mass.inv_inertia());
        Self {
            row,
            linear: axes.unwrap_or(Vector::ONE) * mass.inv_mass(),
            angular: if turns { angular.blunt() } else { angular },
            turns,
        }
    }
}

/// A body of each tree, with its true mass, which contacts may see raised.
#[derive(Clone, Copy, Debug)]
pub(super) struct TreeBody<N: Lane> {
    pub(super) ids: N::Ids,
    /// Inverse mass along each world axis, 1/kg. 0 along locked axes.
    pub(super) linear: Vector<N>,
    /// Inverse inertia at the start of the step.
    pub(super) angular: InvInertia<N>,
    /// The ratio of the inverse mass that contacts see to the true one, along each axis.
    pub(super) share: Vector<N>,
    /// 1 if the inertia rotates with the body, otherwise 0.
    pub(super) turns: N,
    /// The inverse inertia at the current rotation, times the smallest share.
    pub(super) turned: InvInertia<N>,
    /// The same, with the inertia that joints require.
    pub(super) now: InvInertia<N>,
    /// Inertia added to the body's own, kg·m².
    pub(super) lacking: N,
    /// Minimum inertia that the joints require: h Σ |impulse| |arm|, kg·m².
    pub(super) least: N,
}

/// A joint of each tree.
#[derive(Clone, Copy, Debug)]
pub(super) struct TreeJoint<N: Lane> {
    pub(super) row: Row<N>,
    /// The range of its single coordinates among the single coordinates of its tree.
    pub(super) singles: [u32; 2],
    /// The locked coordinates: the first rows of its link.
    pub(super) locks: [u8; BLOCK],
    /// Number of locked coordinates.
    pub(super) locked: usize,
    /// Whether the first coordinate of its block is the distance between the anchors.
    pub(super) is_rod: bool,
    /// The side of the joint on the parent.
    pub(super) parent_side: usize,
    /// Whether some of its impulses are warm-started.
    pub(super) is_warm: bool,
    /// Vector from B's centre of mass to its anchor.
    pub(super) arm: Vector<N>,
    /// Lengths from the centres of mass to the anchors.
    pub(super) arms: [N; 2],
    /// Length of the last impulse, N·s.
    pub(super) load: N,
    /// The impulse on B, and its moment, by rows that are not locked.
    pub(super) besides: Screw<N>,
    /// The orientation motor, if it has one.
    pub(super) orientation: Option<OrientationRow<N>>,
    /// The velocity of its body outside the tree, if an end is `GROUND`.
    pub(super) outside: [N; DOF],
}

pub(super) fn range([start, end]: [u32; 2]) -> Range<usize> {
    start as usize..end as usize
}

impl<N: Lane> TreeBody<N> {
    pub(super) fn none() -> Self {
        Self {
            ids: N::Ids::splat(0),
            linear: Vector::ZERO,
            angular: InvInertia::ZERO,
            share: Vector::ZERO,
            turns: N::ZERO,
            turned: InvInertia::ZERO,
            now: InvInertia::ZERO,
            lacking: N::ZERO,
            least: N::ZERO,
        }
    }

    /// Copies a body into a lane.
    pub(super) fn set(&mut self, lane: usize, body: &ListedBody, share: Vector) {
        self.ids.set(lane, body.row);
        self.linear.set(lane, body.linear);
        self.angular.set(lane, body.angular);
        self.share.set(lane, share);
        self.turns.set(lane, f32::from(u8::from(body.turns)));
    }

    /// The inertia that the body lacks to meet the minimum of its joints.
    #[inline(always)]
    pub(super) fn lacks(&self) -> N {
        lacking(self.turned, self.least)
    }
}

impl<N: Lane> TreeJoint<N> {
    /// An empty joint.
    pub(super) fn none() -> Self {
        Self {
            row: Row::default(),
            singles: [0; 2],
            locks: [0; BLOCK],
            locked: 0,
            is_rod: false,
            parent_side: 0,
            is_warm: false,
            arm: Vector::ZERO,
            arms: [N::ZERO; 2],
            load: N::ZERO,
            besides: [N::Double::ZERO; DOF],
            orientation: None,
            outside: [N::ZERO; DOF],
        }
    }

    /// The side of the joint on the parent (end 0) or on the child (end 1).
    #[inline(always)]
    pub(super) fn side(&self, end: usize) -> usize {
        if end == 0 { self.parent_side } else { 1 - self.parent_side }
    }

    /// The locked coordinates.
    #[inline(always)]
    pub(super) fn locks(&self) -> impl Iterator<Item = usize> + use<N> {
        let locks = self.locks;
        (0..self.locked).map(move |row| usize::from(locks[row]))
    }
}

impl<N: Lane> TreeJoint<N> {
    /// The range of its single coordinates.
    #[inline(always)]
    pub(super) fn singles(&self) -> Range<usize> {
        range(self.singles)
    }

    /// Writes the rows of the link for the locked coordinates, at a place.
    #[inline(always)]
    pub(super) fn lock<const D: usize>(
        &mut self,
        place: &Place<N>,
        angles: &[(N, Angular<N>); ANGLES],
        link: &mut Link<N>,
    ) {
        let (mut gradients, mut values) = coordinates::<N, D>(place, self.row.of_world(), angles);
        if self.is_rod {
            let (distance, direction) = place.apart();
            (gradients[0], values[0]) = (place.gradient(direction, Angular::ZERO), distance);
        }
        link.count = 0;
        for i in self.locks() {
            let error = values[i] - self.row.block[i].target;
            let row = self.add_row(&gradients[i], N::ZERO, link);
            link.rows[row].error = if i < DIM { error } else { wrapped(error) };
        }
        self.arm = place.arm();
    }

    /// Adds a row to the link. Returns its number.
    #[inline(always)]
    pub(super) fn add_row(&self, gradient: &Gradient<N>, softness: N, link: &mut Link<N>) -> usize {
        let number = link.count;
        let row = &mut link.rows[number];
        // `jacobians[0]` belongs to the parent, which is A if `parent_side` is 0.
        let Gradient { normal, moments } = *gradient;
        row.jacobians[self.parent_side] = numbers((-normal, -moments[0]));
        row.jacobians[1 - self.parent_side] = numbers((normal, moments[1]));
        row.softness = softness;
        link.count += 1;
        number
    }

    /// The gradient of a row of the link.
    #[inline(always)]
    pub(super) fn gradient(&self, row: &LinkRow<N>) -> Gradient<N> {
        let of_a = of_numbers(row.jacobians[self.parent_side]);
        let of_b = of_numbers(row.jacobians[1 - self.parent_side]);
        Gradient { normal: of_b.0, moments: [-of_a.1, of_b.1] }
    }

    /// Writes the softness of the locked coordinates in a pass. The link then has no other rows.
    #[inline(always)]
    pub(super) fn soften(&self, link: &mut Link<N>, pass: SolverPass) {
        link.count = self.locked;
        for (i, row) in self.locks().zip(&mut link.rows) {
            let (soft, gradient) = (&self.row.block[i].softening, self.gradient(row));
            let own = self.row.masses.response(&gradient).along(&gradient);
            row.softness = match pass {
                SolverPass::Solve => own * soft.share + soft.more,
                _ => own * N::select(is(soft.is_spring), N::splat(LOOSE), N::splat(NO_MASS)),
            };
        }
    }

    /// Writes the wanted velocities of the locked coordinates in a pass, in the lanes of a mask.
    #[inline(always)]
    pub(super) fn ask(&self, pair: &Pair<N>, link: &mut Link<N>, lanes: N::Mask, sweep: &Sweep) {
        for (i, row) in self.locks().zip(&mut link.rows) {
            let locked = &self.row.block[i];
            let (soft, is_spring) = (&locked.softening, is(locked.softening.is_spring));
            let mut rate = self.gradient(row).rate(pair);
            if sweep.pass == SolverPass::Solve {
                let bias = soft.bias_rate * row.error;
                let most =
                    if i < DIM { sweep.params.max_push_speed } else { SMALL_TURN * sweep.params.inv_h };
                let most = N::splat(most);
                rate += N::select(is_spring, bias, bias.max(-most).min(most));
                rate += row.softness * locked.impulse;
            } else {
                rate = N::select(is_spring, N::ZERO, rate);
            }
            row.wanted = N::select(lanes, -rate, N::ZERO).double();
        }
    }

    /// Stores the load on the joint, and its reaction.
    #[inline(always)]
    pub(super) fn bear(&mut self, link: &Link<N>, sweep: &Sweep) {
        let mut sum = self.besides;
        for (i, row) in self.locks().zip(&link.rows) {
            let of_b = elimination::widen(&row.jacobians[1 - self.parent_side]);
            elimination::add::<N>(&mut sum, &of_b, self.row.block[i].impulse.double());
        }
        let (force, moment) = motion::<N>(&sum);
        self.load = force.length();
        self.row.bear(force, moment - self.arm.cross(force), sweep.params);
    }
}
