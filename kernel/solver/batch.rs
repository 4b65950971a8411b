//! Contact rows in memory: arrays by point count, cut into batches that are solved one after the other.

use super::{ContactRow, DeepRow, InvMass, RestitutionRow};
use crate::math::Lane;

/// Rows are laid out by the number of points they have room for: 1, 2 or 4.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PointClass {
    /// One point.
    One,
    /// Two points.
    Two,
    /// Three or four points.
    Four,
}

impl PointClass {
    /// All classes, in the order in which a colour's batches are solved.
    pub const ALL: [Self; 3] = [Self::Four, Self::Two, Self::One];

    /// The smallest class with room for `count` points.
    pub fn of(count: u32) -> Self {
        match count {
            0 | 1 => Self::One,
            2 => Self::Two,
            _ => Self::Four,
        }
    }
}

/// Consecutive rows of one class whose dynamic bodies are all different, so that they may be solved in
/// any order or at once.
#[derive(Clone, Copy, Debug)]
pub struct Batch {
    /// Which array.
    pub class: PointClass,
    /// The first row.
    pub start: u32,
    /// How many rows.
    pub len: u32,
    /// Whether any of them can bounce.
    pub bouncy: bool,
    /// Whether any of them overlaps deeply.
    pub deep: bool,
}

/// Where a lane's manifold comes from and its impulses go back to.
#[derive(Clone, Copy, Debug)]
pub struct Source<N: Lane> {
    /// The contact of each lane; [`NONE`](crate::table::NONE) for padding.
    pub contacts: N::Ids,
    /// Which of the contact's manifolds.
    pub manifolds: N::Ids,
}

/// The rows of one class.
#[derive(Clone, Debug)]
pub struct Rows<N: Lane, M, const P: usize> {
    /// What every pass sweeps.
    pub rows: Vec<ContactRow<N, M, P>>,
    /// What the restitution pass needs besides.
    pub bounces: Vec<RestitutionRow<N, P>>,
    /// What deep overlap needs besides; empty in steps without.
    pub deeps: Vec<DeepRow<N, P>>,
    /// Where the rows come from.
    pub sources: Vec<Source<N>>,
}

impl<N: Lane, M, const P: usize> Default for Rows<N, M, P> {
    fn default() -> Self {
        Self { rows: Vec::new(), bounces: Vec::new(), deeps: Vec::new(), sources: Vec::new() }
    }
}

impl<N: Lane, M: InvMass<N>, const P: usize> Rows<N, M, P> {
    fn clear(&mut self) {
        self.rows.clear();
        self.bounces.clear();
        self.deeps.clear();
        self.sources.clear();
    }
}

/// The contact rows of a step for one lane width and kind of inverse mass.
#[derive(Clone, Debug)]
pub struct RowSet<N: Lane, M> {
    /// Manifolds of one point.
    pub one: Rows<N, M, 1>,
    /// Manifolds of two points.
    pub two: Rows<N, M, 2>,
    /// Manifolds of three or four points.
    pub four: Rows<N, M, 4>,
    /// What is solved, in this order.
    pub batches: Vec<Batch>,
}

impl<N: Lane, M: InvMass<N>> Default for RowSet<N, M> {
    fn default() -> Self {
        Self { one: Rows::default(), two: Rows::default(), four: Rows::default(), batches: Vec::new() }
    }
}

impl<N: Lane, M: InvMass<N>> RowSet<N, M> {
    /// Forgets all rows; keeps the memory.
    pub fn clear(&mut self) {
        self.one.clear();
        self.two.clear();
        self.four.clear();
        self.batches.clear();
    }

    /// How many rows there are.
    pub fn len(&self) -> usize {
        self.one.rows.len() + self.two.rows.len() + self.four.rows.len()
    }

    /// Whether there are no rows.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// Runs `$body` with `$rows` bound to the array of a batch's class, whatever its number of points.
macro_rules! with_rows {
    ($set:expr, $class:expr, |$rows:ident| $body:expr) => {
        match $class {
            $crate::solver::PointClass::One => {
                let $rows = &mut $set.one;
                $body
            }
            $crate::solver::PointClass::Two => {
                let $rows = &mut $set.two;
                $body
            }
            $crate::solver::PointClass::Four => {
                let $rows = &mut $set.four;
                $body
            }
        }
    };
}
pub(super) use with_rows;
