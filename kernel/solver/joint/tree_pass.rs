//! A pass over a group of trees: its parts and their order.
#![expect(unsafe_code, reason = "rows of bodies are shared by threads")]

use super::super::MassRow;
use super::super::batch::{SolverPass, Sweep};
use super::elimination::{Link, Node};
use super::single::Single;
use super::tree_joint::{TreeBody, TreeJoint};
use super::tree_scratch::{Coordinate, Known, Scratch};
use crate::math::{Entry, Job, Width};
use crate::tuning::solver::JOINT_ROUNDS;

/// The entry to code compiled for the CPU features of the lanes.
#[derive(Clone, Copy)]
pub(super) struct TreeEntry<N: Entry> {
    pub(super) width: Width,
    pub(super) proof: N::Proof,
}

impl<N: Entry> TreeEntry<N> {
    /// # Safety
    /// The condition of the job holds.
    pub(super) unsafe fn run<J: Job>(self, job: J) -> J::Output {
        // SAFETY: by the contract.
        unsafe { N::enter_widest(self.proof, self.width, job) }
    }
}

/// Trees of equal shape, one per lane. Lanes without a tree have immovable bodies.
///
/// A pass consists of parts, each with an entry point of its own. Only these parts compute with lanes.
pub(super) struct Tree<'a, N: Entry> {
    pub(super) joints: &'a mut [TreeJoint<N>],
    pub(super) singles: &'a mut [Single<N>],
    pub(super) links: &'a mut [Link<N>],
    pub(super) nodes: &'a mut [Node<N>],
    pub(super) bodies: &'a mut [TreeBody<N>],
    pub(super) scratch: &'a mut Scratch<N>,
    pub(super) entry: TreeEntry<N>,
}

/// Declares jobs that each call a method.
macro_rules! parts {
    ($($part:ident: $method:ident -> $output:ty;)+) => {$(
        struct $part<'t, 'a, N: Entry>(&'t mut Tree<'a, N>, &'t Sweep<'t>);

        impl<N: Entry> Job for $part<'_, '_, N> {
            type Output = $output;

            #[inline(always)]
            unsafe fn run(self) -> $output {
                // SAFETY: by the contract.
                unsafe { self.0.$method(self.1) }
            }
        }
    )+};
}

parts! {
    PlaceAll: place -> ();
    Load: load -> bool;
    TurnInertia: turn_bodies -> ();
    Lock: factor_locked -> ();
    Factor: factor_all -> ();
    Round: round -> ();
    Pivot: pivot -> bool;
    Finish: finish -> ();
    Bear: bear -> ();
    Warm: warm -> ();
}

/// Computes derived values of joints and masses, at the start of a step.
pub(super) struct BeginStep<'t, 'a, N: Entry> {
    pub(super) tree: Tree<'a, N>,
    pub(super) masses: &'t [MassRow],
}

impl<N: Entry> Job for BeginStep<'_, '_, N> {
    type Output = ();

    #[inline(always)]
    unsafe fn run(self) {
        let Tree { joints, singles, scratch, .. } = self.tree;
        for joint in joints.iter_mut() {
            joint.row.finish(self.masses);
            let of_joint = &singles[joint.singles()];
            joint.is_warm = joint.orientation.is_some();
            for single in of_joint {
                joint.is_warm |= single.is_warm();
            }
        }
        scratch.is_weighed = false;
        scratch.coordinates.clear();
        for single in singles.iter() {
            scratch.coordinates.push(Coordinate::new(single));
        }
    }
}

/// Computes the mass that a single coordinate of a joint moves.
struct Weigh<'t, 'a, N: Entry>(&'t mut Tree<'a, N>, usize, usize);

impl<N: Entry> Job for Weigh<'_, '_, N> {
    type Output = ();

    #[inline(always)]
    unsafe fn run(self) {
        self.0.weigh(self.1, self.2);
    }
}

impl<N: Entry> Tree<'_, N> {
    /// Solves all locked coordinates, limits and motors, and stores the loads on joints.
    ///
    /// # Safety
    /// Until the call returns, no other thread reads or writes the dynamic bodies of the trees, or writes
    /// their other bodies.
    pub(super) unsafe fn solve(&mut self, sweep: &Sweep) {
        self.scratch.open = N::ONE;
        // SAFETY: by the contract.
        unsafe {
            self.project(sweep);
            self.entry.run(Bear(self, sweep));
        }
    }

    /// Solves all locked coordinates, limits, springs and motors in the open lanes. Positions and factors
    /// stay valid until bodies move.
    ///
    /// # Safety
    /// As [`solve`](Self::solve).
    pub(super) unsafe fn project(&mut self, sweep: &Sweep) {
        let entry = self.entry;
        // SAFETY: by the contract.
        unsafe {
            if self.scratch.known == Known::Nothing {
                entry.run(PlaceAll(self, sweep));
                entry.run(TurnInertia(self, sweep));
            }
            if !entry.run(Load(self, sweep)) {
                return;
            }
        }
        let has_turns = self.joints.iter().any(|joint| joint.orientation.is_some());
        self.scratch.driven = if has_turns { N::ZERO } else { N::ONE };
        for round in 0..JOINT_ROUNDS {
            if self.scratch.known != Known::Factors(sweep.pass) {
                // SAFETY: by the contract.
                unsafe { self.factor(sweep) };
            }
            // In later rounds, limits are only deactivated.
            self.scratch.adds = 2 * round < JOINT_ROUNDS;
            self.scratch.is_last = round + 1 == JOINT_ROUNDS;
            // SAFETY: by the contract.
            let goes_on = unsafe {
                entry.run(Round(self, sweep));
                let goes_on = entry.run(Pivot(self, sweep));
                if has_turns { self.solve_motors(sweep) } else { goes_on }
            };
            if !goes_on {
                break;
            }
        }
        if has_turns {
            // Motors are solved sequentially, so repeating the pass would change the result.
            self.scratch.settled = N::ZERO;
        }
        // SAFETY: by the contract.
        unsafe { entry.run(Finish(self, sweep)) };
    }

    /// Pivots once more in the open lanes.
    ///
    /// # Safety
    /// As [`solve`](Self::solve).
    pub(super) unsafe fn pivot_again(&mut self, sweep: &Sweep) {
        // SAFETY: by the contract.
        unsafe { self.entry.run(Pivot(self, sweep)) };
    }

    /// Adds a row for each coordinate with an active limit, spring or motor, and factors the trees.
    ///
    /// # Safety
    /// As [`solve`](Self::solve).
    unsafe fn factor(&mut self, sweep: &Sweep) {
        let entry = self.entry;
        if sweep.pass == SolverPass::Solve && !core::mem::replace(&mut self.scratch.is_weighed, true) {
            let mut is_factored = false;
            for k in 0..self.joints.len() {
                for index in self.joints[k].singles() {
                    if !self.scratch.coordinates[index].is_per_mass {
                        continue;
                    }
                    // SAFETY: by the contract.
                    unsafe {
                        if !core::mem::replace(&mut is_factored, true) {
                            entry.run(Lock(self, sweep));
                        }
                        entry.run(Weigh(self, k, index));
                    }
                }
            }
        }
        // SAFETY: by the contract.
        unsafe { entry.run(Factor(self, sweep)) };
        self.scratch.known = Known::Factors(sweep.pass);
    }

    /// Applies the impulses of springs and motors, and damping. Rigid rows start from zero impulses.
    ///
    /// # Safety
    /// As [`solve`](Self::solve).
    pub(super) unsafe fn warm_start(&mut self, sweep: &Sweep) {
        // SAFETY: by the contract.
        unsafe { self.entry.run(Warm(self, sweep)) };
    }
}
