//! The direct solution of a tree of joints: linear in their number.
//!
//! Bodies move by Δv = M⁻¹ Σ Jᵀ λ, joints ask for J Δv + Γ λ = r. Joints are eliminated from the leaves to the root. Let B be the
//! inverse inertia of a body with all that is eliminated hanging on it, at first M⁻¹, and g its motion by that. A joint
//! between a parent p and a child c, whose own joints are all eliminated, has
//!
//! E = J_c B_c J_cᵀ + Γ + J_p B_p J_pᵀ,  e = r − J_c g_c − J_p g_p,  λ = E⁻¹ (e − J_p B_p F)
//!
//! where F is the impulse on the parent by the joints that are eliminated later. So, with Y = E⁻¹ J_p B_p,
//!
//! B_p ← B_p − Yᵀ E Y,  g_p ← g_p + Yᵀ e
//!
//! and on the way back F is known. Only inverses of inertia are used: bodies with locked axes are nothing special. B is a
//! difference of near numbers where a light body holds a heavy one, which takes `f64`.
//!
//! After Baraff, "Linear-time dynamics using Lagrange multipliers" (1996), and Featherstone's articulated bodies.

#![expect(unsafe_code, reason = "entry points of CPU features")]

use super::dim::{AXES, DOF};
use super::forest::GROUND;
use crate::math::{Job, Width, enter};

/// Most rows of a link: one of each coordinate.
pub(super) const ROWS: usize = AXES;

/// A motion of a body, or an impulse on it.
pub(super) type Screw = [f64; DOF];

/// Share of a row's own inverse mass below which its pivot is rounding.
const NO_PIVOT: f64 = 1.0e-10;

/// Number of entries of the lower half of a matrix of rows, with its diagonal.
const LOWER: usize = ROWS * (ROWS + 1) / 2;

/// The place of an entry of the lower half.
#[inline(always)]
const fn at(row: usize, column: usize) -> usize {
    row * (row + 1) / 2 + column
}

#[inline(always)]
fn widen(a: &[f32; DOF]) -> Screw {
    let mut wide = [0.0; DOF];
    for i in 0..DOF {
        wide[i] = f64::from(a[i]);
    }
    wide
}

/// Sums of three products each do not wait for each other.
#[inline(always)]
fn dot(a: &Screw, b: &Screw) -> f64 {
    let mut sum = 0.0;
    for k in (0..DOF).step_by(3) {
        sum += a[k] * b[k] + a[k + 1] * b[k + 1] + a[k + 2] * b[k + 2];
    }
    sum
}

/// Adds a multiple.
#[inline(always)]
pub(super) fn add(to: &mut Screw, a: &Screw, times: f64) {
    for i in 0..DOF {
        to[i] += a[i] * times;
    }
}

/// The product with a symmetric matrix, by columns: they are added side by side.
#[inline(always)]
fn product(matrix: &[Screw; DOF], a: &[f32; DOF]) -> Screw {
    let mut sum = [0.0; DOF];
    for i in 0..DOF {
        add(&mut sum, &matrix[i], f64::from(a[i]));
    }
    sum
}

/// A body of a tree.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    /// M⁻¹.
    pub(super) inverse: [[f32; DOF]; DOF],
    /// B, while joints are eliminated.
    left: [Screw; DOF],
    /// g, while joints are eliminated.
    motion: Screw,
    /// The impulse of its joints, after solving.
    pub(super) impulse: Screw,
}

impl Node {
    pub(super) fn new(inverse: [[f32; DOF]; DOF]) -> Self {
        Self { inverse, left: [[0.0; DOF]; DOF], motion: [0.0; DOF], impulse: [0.0; DOF] }
    }

    /// What the impulse of its joints changes.
    pub(super) fn change(&self) -> Screw {
        self.moved(&self.impulse)
    }

    /// What an impulse changes.
    #[inline(always)]
    pub(super) fn moved(&self, impulse: &Screw) -> Screw {
        let mut sum = [0.0; DOF];
        for i in 0..DOF {
            add(&mut sum, &widen(&self.inverse[i]), impulse[i]);
        }
        sum
    }
}

/// A row of a link: what passes use of it lies together, since all trees of a big scene are larger than caches. J, Γ and M⁻¹
/// are stored as they are computed, in `f32`.
#[derive(Clone, Copy, Debug)]
pub(super) struct LinkRow {
    /// J of parent and child.
    pub(super) jacobians: [[f32; DOF]; 2],
    /// Γ.
    pub(super) softness: f32,
    /// By how much what is locked is off, in m or rad.
    pub(super) error: f32,
    /// r.
    pub(super) wanted: f64,
    /// λ.
    pub(super) impulse: f64,
    /// D⁻¹ of E = L D Lᵀ.
    inverse: f64,
    /// Y.
    passed: Screw,
}

impl LinkRow {
    const NONE: Self = Self {
        jacobians: [[0.0; DOF]; 2],
        softness: 0.0,
        error: 0.0,
        wanted: 0.0,
        impulse: 0.0,
        inverse: 0.0,
        passed: [0.0; DOF],
    };
}

/// A joint of a tree: some rows between a parent and a child.
#[derive(Clone, Copy, Debug)]
pub(super) struct Link {
    /// Parent and child among the bodies of the tree, or [`GROUND`].
    pub(super) places: [u32; 2],
    /// Number of rows.
    pub(super) count: usize,
    /// E, and then L below the diagonal.
    lower: [f64; LOWER],
    pub(super) rows: [LinkRow; ROWS],
}

impl Link {
    pub(super) const NONE: Self =
        Self { places: [GROUND; 2], count: 0, lower: [0.0; LOWER], rows: [LinkRow::NONE; ROWS] };

    /// Wants a motion of an end taken back.
    pub(super) fn want_against(&mut self, end: usize, motion: &Screw) {
        for row in &mut self.rows[..self.count] {
            row.wanted -= dot(&widen(&row.jacobians[end]), motion);
        }
    }

    /// Replaces the lower half of E by its factors. Rows that depend on those before, or that nothing moves, are left out.
    #[inline(always)]
    fn factor(&mut self, count: usize) {
        let Self { lower, rows, .. } = self;
        for j in 0..count {
            let (own, mut pivot) = (lower[at(j, j)], lower[at(j, j)]);
            for m in 0..j {
                // It is still times D.
                let scaled = lower[at(j, m)] * rows[m].inverse;
                pivot -= scaled * lower[at(j, m)];
                lower[at(j, m)] = scaled;
            }
            rows[j].inverse = if pivot > own * NO_PIVOT { 1.0 / pivot } else { 0.0 };
            for i in j + 1..count {
                for m in 0..j {
                    lower[at(i, j)] -= lower[at(i, m)] * lower[at(j, m)];
                }
            }
        }
    }

    /// E⁻¹ x.
    #[inline(always)]
    fn solve(&self, x: &mut [f64; ROWS], count: usize) {
        for i in 0..count {
            for m in 0..i {
                x[i] -= self.lower[at(i, m)] * x[m];
            }
        }
        for i in (0..count).rev() {
            x[i] *= self.rows[i].inverse;
            for m in i + 1..count {
                x[i] -= self.lower[at(m, i)] * x[m];
            }
        }
    }

    /// Eliminates the joint: B of its parent is what is left.
    #[inline(always)]
    fn eliminate(&mut self, nodes: &mut [Node], count: usize) {
        let [parent, child] = self.places;
        for i in 0..count {
            for j in 0..i {
                self.lower[at(i, j)] = 0.0;
            }
            self.lower[at(i, i)] = f64::from(self.rows[i].softness);
        }
        for (side, place) in [parent, child].into_iter().enumerate() {
            let Some(node) = nodes.get(place as usize) else { continue };
            for i in 0..count {
                let response = product(&node.left, &self.rows[i].jacobians[side]);
                if side == 0 {
                    self.rows[i].passed = response;
                }
                for j in i..count {
                    self.lower[at(j, i)] += dot(&response, &widen(&self.rows[j].jacobians[side]));
                }
            }
        }
        self.factor(count);
        let Some(node) = nodes.get_mut(parent as usize) else { return };
        // L⁻¹ W, then B − Wᵀ E⁻¹ W row by row, then Y.
        for i in 0..count {
            for m in 0..i {
                let (of_m, times) = (self.rows[m].passed, -self.lower[at(i, m)]);
                add(&mut self.rows[i].passed, &of_m, times);
            }
        }
        for row in &self.rows[..count] {
            for k in 0..DOF {
                add(&mut node.left[k], &row.passed, -row.passed[k] * row.inverse);
            }
        }
        for i in (0..count).rev() {
            for k in 0..DOF {
                self.rows[i].passed[k] *= self.rows[i].inverse;
            }
            for m in i + 1..count {
                let (of_m, times) = (self.rows[m].passed, -self.lower[at(m, i)]);
                add(&mut self.rows[i].passed, &of_m, times);
            }
        }
    }

    /// Writes E⁻¹ e, and passes e on to the parent.
    #[inline(always)]
    fn rise(&mut self, nodes: &mut [Node], count: usize) {
        let is_still = |place: &u32| nodes.get(*place as usize).is_none_or(|node| node.motion == [0.0; DOF]);
        if self.rows[..count].iter().all(|row| row.wanted == 0.0) && self.places.iter().all(is_still) {
            self.rows[..count].iter_mut().for_each(|row| row.impulse = 0.0);
            return;
        }
        let mut e = [0.0; ROWS];
        for i in 0..count {
            e[i] = self.rows[i].wanted;
        }
        for (side, place) in self.places.into_iter().enumerate() {
            let Some(node) = nodes.get(place as usize) else { continue };
            for i in 0..count {
                e[i] -= dot(&widen(&self.rows[i].jacobians[side]), &node.motion);
            }
        }
        if let Some(node) = nodes.get_mut(self.places[0] as usize) {
            for i in 0..count {
                add(&mut node.motion, &self.rows[i].passed, e[i]);
            }
        }
        self.solve(&mut e, count);
        for i in 0..count {
            self.rows[i].impulse = e[i];
        }
    }

    /// Takes off what the parent's other joints do, and adds the impulses to those of both bodies.
    #[inline(always)]
    fn fall(&mut self, nodes: &mut [Node], count: usize) {
        if let Some(node) = nodes.get(self.places[0] as usize) {
            for row in &mut self.rows[..count] {
                row.impulse -= dot(&row.passed, &node.impulse);
            }
        }
        for (side, place) in self.places.into_iter().enumerate() {
            let Some(node) = nodes.get_mut(place as usize) else { continue };
            for row in &self.rows[..count] {
                add(&mut node.impulse, &widen(&row.jacobians[side]), row.impulse);
            }
        }
    }
}

/// Calls a method of a link with its number of rows. Loops over few rows are unrolled.
macro_rules! by_count {
    ($link:ident.$method:ident($nodes:expr)) => {
        match $link.count {
            1 => $link.$method($nodes, 1),
            2 => $link.$method($nodes, 2),
            3 => $link.$method($nodes, 3),
            4 => $link.$method($nodes, 4),
            5 => $link.$method($nodes, 5),
            6 => $link.$method($nodes, 6),
            count => $link.$method($nodes, count),
        }
    };
}

/// The joints of a tree, in an order from the root on, and its bodies.
struct Slices<'a> {
    links: &'a mut [Link],
    nodes: &'a mut [Node],
}

struct Factor<'a>(Slices<'a>);

impl Job for Factor<'_> {
    type Output = ();

    #[inline(always)]
    unsafe fn run(self) {
        let Slices { links, nodes } = self.0;
        for node in nodes.iter_mut() {
            for k in 0..DOF {
                node.left[k] = widen(&node.inverse[k]);
            }
        }
        for link in links.iter_mut().rev() {
            by_count!(link.eliminate(nodes));
        }
    }
}

struct Solve<'a>(Slices<'a>);

impl Job for Solve<'_> {
    type Output = ();

    #[inline(always)]
    unsafe fn run(self) {
        let Slices { links, nodes } = self.0;
        for node in nodes.iter_mut() {
            (node.motion, node.impulse) = ([0.0; DOF], [0.0; DOF]);
        }
        for link in links.iter_mut().rev() {
            by_count!(link.rise(nodes));
        }
        for link in links.iter_mut() {
            by_count!(link.fall(nodes));
        }
    }
}

/// Eliminates the joints of a tree, which are in an order from the root on.
pub(super) fn factor(links: &mut [Link], nodes: &mut [Node], width: Width) {
    // SAFETY: the job demands nothing.
    unsafe { enter(width, Factor(Slices { links, nodes })) };
}

/// Solves a factored tree for what its joints want. Afterwards joints have their impulses, and bodies those of all their
/// joints.
pub(super) fn solve(links: &mut [Link], nodes: &mut [Node], width: Width) {
    // SAFETY: the job demands nothing.
    unsafe { enter(width, Solve(Slices { links, nodes })) };
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::DIM;
    use proptest::prelude::*;

    /// A tree by seeds: masses, parents, rows and directions.
    fn tree(seeds: &[(f64, u32, u64)], ratio: f64) -> (Vec<Link>, Vec<Node>) {
        let mut state = 1u64;
        let mut any = |seed: u64| {
            state = (state ^ seed).wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1u64 << 53) as f64 * 2.0 - 1.0
        };
        let (mut links, mut nodes): (Vec<Link>, Vec<Node>) = (Vec::new(), Vec::new());
        for (number, &(weight, parent, seed)) in seeds.iter().enumerate() {
            let mut inverse = [[0.0f32; DOF]; DOF];
            let inv_mass = 1.0 / ratio.powf(weight);
            let roots: [Screw; DOF] = core::array::from_fn(|_| core::array::from_fn(|_| any(seed)));
            for (i, row) in inverse.iter_mut().enumerate() {
                for (j, x) in row.iter_mut().enumerate() {
                    let turn = if i >= DIM && j >= DIM { 0.3 * dot(&roots[i], &roots[j]) } else { 0.0 };
                    *x = (inv_mass * (turn + if i == j { 0.5 } else { 0.0 })) as f32;
                }
            }
            nodes.push(Node::new(inverse));
            let ends = if number == 0 || parent % 7 == 0 {
                [number as u32, GROUND]
            } else {
                [parent % number as u32, number as u32]
            };
            let count = 1 + seed as usize % ROWS;
            let mut link = Link { places: ends, count, ..Link::NONE };
            for row in &mut link.rows[..count] {
                row.jacobians = core::array::from_fn(|_| core::array::from_fn(|_| any(seed) as f32));
                (row.softness, row.wanted) = (1.0e-3 * inv_mass as f32, any(seed));
            }
            links.push(link);
            if ends[1] == GROUND && number > 0 {
                // It hangs on an earlier body as well.
                let places = [parent % number as u32, number as u32];
                links.insert(links.len() - 1, Link { places, ..link });
            }
        }
        (links, nodes)
    }

    /// J Δv + Γ λ − r, with Δv = M⁻¹ Σ Jᵀ λ.
    fn residual(links: &[Link], nodes: &[Node]) -> f64 {
        let mut impulses = vec![[0.0; DOF]; nodes.len()];
        for link in links {
            for (side, place) in link.places.into_iter().enumerate().filter(|(_, place)| *place != GROUND) {
                for row in &link.rows[..link.count] {
                    add(&mut impulses[place as usize], &widen(&row.jacobians[side]), row.impulse);
                }
            }
        }
        let mut most = 0.0f64;
        for link in links {
            for row in &link.rows[..link.count] {
                let mut sum = f64::from(row.softness) * row.impulse - row.wanted;
                for (side, place) in link.places.into_iter().enumerate().filter(|(_, place)| *place != GROUND)
                {
                    let change = nodes[place as usize].moved(&impulses[place as usize]);
                    sum += dot(&widen(&row.jacobians[side]), &change);
                }
                most = most.max(sum.abs());
            }
        }
        for (node, impulse) in nodes.iter().zip(&impulses) {
            let scale = impulse.iter().fold(1.0f64, |most, x| most.max(x.abs()));
            for i in 0..DOF {
                most = most.max((node.impulse[i] - impulse[i]).abs() / scale);
            }
        }
        most
    }

    proptest! {
        #[test]
        fn all_joints_of_a_tree_get_what_they_want(
            seeds in prop::collection::vec((0.0f64..1.0, any::<u32>(), any::<u64>()), 1..40),
            ratio in prop::sample::select(vec![1.0, 100.0, 1.0e6]),
        ) {
            let (mut links, mut nodes) = tree(&seeds, ratio);
            let mut other = (links.clone(), nodes.clone());
            factor(&mut links, &mut nodes, Width::default());
            factor(&mut other.0, &mut other.1, Width::Four);
            for _ in 0..2 {
                solve(&mut links, &mut nodes, Width::default());
                solve(&mut other.0, &mut other.1, Width::Four);
                let most = residual(&links, &nodes);
                prop_assert!(most < 1.0e-6, "off by {most}");
                let bits = |links: &[Link]| -> Vec<u64> {
                    links.iter().flat_map(|link| link.rows.map(|row| row.impulse.to_bits())).collect()
                };
                prop_assert_eq!(bits(&links), bits(&other.0), "other bits with another width");
            }
        }
    }

    #[test]
    fn rows_that_nothing_moves_are_left_out() {
        let mut held = [[0.0; DOF]; DOF];
        held[1][1] = 2.0;
        let mut link = Link { places: [0, GROUND], count: 3, ..Link::NONE };
        for (row, axis) in link.rows.iter_mut().zip([0, 1, 1]) {
            row.jacobians[0][axis] = 1.0;
            row.wanted = 4.0;
        }
        let (mut links, mut nodes) = ([link], [Node::new(held)]);
        factor(&mut links, &mut nodes, Width::default());
        solve(&mut links, &mut nodes, Width::default());
        assert_eq!(links[0].rows.map(|row| row.impulse)[..3], [0.0, 2.0, 0.0]);
        assert_eq!(nodes[0].change()[1], 4.0);
    }
}
