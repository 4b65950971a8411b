//! The direct solution of a tree of joints, in time linear in their number.
//!
//! Bodies move by Δv = M⁻¹ Σ Jᵀ λ, and joints require J Δv + Γ λ = r. Joints are eliminated from the leaves
//! to the root. Let B be the inverse inertia of a body with all eliminated joints attached, initially M⁻¹,
//! and g its motion due to these joints. A joint between a parent p and a child c, whose own child joints
//! are all eliminated, has
//!
//! E = J_c B_c J_cᵀ + Γ + J_p B_p J_pᵀ,  e = r − J_c g_c − J_p g_p,  λ = E⁻¹ (e − J_p B_p F)
//!
//! where F is the impulse on the parent by the joints that are eliminated later. With Y = E⁻¹ J_p B_p
//! follows
//!
//! B_p ← B_p − Yᵀ E Y,  g_p ← g_p + Yᵀ e
//!
//! and F is known on the way back to the leaves. Only inverses of inertia are used, so bodies with locked
//! axes need no special case. Where a light body holds a heavy one, B is a difference of close numbers,
//! which requires `f64`.
//!
//! Trees of equal shape are solved in parallel, one per lane. A row that only some of them have is 0 in the
//! others.
//!
//! After Baraff, "Linear-time dynamics using Lagrange multipliers" (1996), and Featherstone's articulated
//! bodies.

use super::dim::{AXES, DOF, numbers, of_numbers};
use super::forest::GROUND;
use crate::math::{Angular, Double, Lane, Num, Vector};

/// Maximum number of rows of a link: one per coordinate.
pub(super) const ROWS: usize = AXES;

/// A motion of a body, or an impulse on it.
pub(super) type Screw<N> = [<N as Lane>::Double; DOF];

/// Share of a row's own inverse mass below which its pivot is rounding error.
const NO_PIVOT: f64 = 1.0e-10;

/// Number of entries in the lower half of a matrix of rows, including the diagonal.
const LOWER: usize = ROWS * (ROWS + 1) / 2;

/// The index of an entry of the lower half.
#[inline(always)]
const fn at(row: usize, column: usize) -> usize {
    row * (row + 1) / 2 + column
}

/// A motion, or an impulse and its moment, in the precision of the elimination.
#[inline(always)]
pub(super) fn screw<N: Lane>(v: Vector<N>, w: Angular<N>) -> Screw<N> {
    widen(&numbers((v, w)))
}

/// The motion of a screw.
#[inline(always)]
pub(super) fn motion<N: Lane>(screw: &Screw<N>) -> (Vector<N>, Angular<N>) {
    let mut rounded = [N::ZERO; DOF];
    for i in 0..DOF {
        rounded[i] = N::of_double(screw[i]);
    }
    of_numbers(rounded)
}

#[inline(always)]
pub(super) fn widen<N: Lane>(a: &[N; DOF]) -> Screw<N> {
    let mut wide = [N::Double::ZERO; DOF];
    for i in 0..DOF {
        wide[i] = a[i].double();
    }
    wide
}

/// The dot product, summed in groups of three products so that the groups are independent.
#[inline(always)]
fn dot<N: Lane>(a: &Screw<N>, b: &Screw<N>) -> N::Double {
    let mut sum = N::Double::ZERO;
    for k in (0..DOF).step_by(3) {
        sum += a[k] * b[k] + a[k + 1] * b[k + 1] + a[k + 2] * b[k + 2];
    }
    sum
}

/// Adds a multiple of `a`.
#[inline(always)]
pub(super) fn add<N: Lane>(to: &mut Screw<N>, a: &Screw<N>, times: N::Double) {
    for i in 0..DOF {
        to[i] += a[i] * times;
    }
}

/// The product with a symmetric matrix, summed column by column, so that the components are independent.
#[inline(always)]
fn product<N: Lane>(matrix: &[Screw<N>; DOF], a: &[N; DOF]) -> Screw<N> {
    let mut sum = [N::Double::ZERO; DOF];
    for i in 0..DOF {
        add::<N>(&mut sum, &matrix[i], a[i].double());
    }
    sum
}

/// A body of a tree.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node<N: Lane> {
    /// M⁻¹.
    pub(super) inverse: [[N; DOF]; DOF],
    /// B, during elimination.
    left: [Screw<N>; DOF],
    /// g, during elimination.
    motion: Screw<N>,
    /// The total impulse of its joints, after solving.
    pub(super) impulse: Screw<N>,
}

impl<N: Lane> Node<N> {
    #[inline(always)]
    pub(super) fn new(inverse: [[N; DOF]; DOF]) -> Self {
        let none = [N::Double::ZERO; DOF];
        Self { inverse, left: [none; DOF], motion: none, impulse: none }
    }

    /// The velocity change by the impulse of its joints.
    #[inline(always)]
    pub(super) fn change(&self) -> Screw<N> {
        self.moved(&self.impulse)
    }

    /// The velocity change by an impulse.
    #[inline(always)]
    pub(super) fn moved(&self, impulse: &Screw<N>) -> Screw<N> {
        let mut sum = [N::Double::ZERO; DOF];
        for i in 0..DOF {
            add::<N>(&mut sum, &widen(&self.inverse[i]), impulse[i]);
        }
        sum
    }
}

/// A row of a link. Data of one pass is kept together, since all trees of a big scene are larger than
/// caches. J, Γ and M⁻¹ are stored in `f32`, in which they are computed.
#[derive(Clone, Copy, Debug)]
pub(super) struct LinkRow<N: Lane> {
    /// J of parent and child.
    pub(super) jacobians: [[N; DOF]; 2],
    /// Γ.
    pub(super) softness: N,
    /// Position error of a locked coordinate, m or rad.
    pub(super) error: N,
    /// r.
    pub(super) wanted: N::Double,
    /// λ.
    pub(super) impulse: N::Double,
    /// D⁻¹ of E = L D Lᵀ.
    inverse: N::Double,
    /// Y.
    passed: Screw<N>,
}

impl<N: Lane> LinkRow<N> {
    const NONE: Self = Self {
        jacobians: [[N::ZERO; DOF]; 2],
        softness: N::ZERO,
        error: N::ZERO,
        wanted: N::Double::ZERO,
        impulse: N::Double::ZERO,
        inverse: N::Double::ZERO,
        passed: [N::Double::ZERO; DOF],
    };
}

/// A joint of a tree: some rows between a parent and a child.
#[derive(Clone, Copy, Debug)]
pub(super) struct Link<N: Lane> {
    /// Indices of parent and child among the bodies of the tree, or [`GROUND`].
    pub(super) places: [u32; 2],
    /// Number of rows.
    pub(super) count: usize,
    /// E, replaced by L below the diagonal.
    lower: [N::Double; LOWER],
    pub(super) rows: [LinkRow<N>; ROWS],
}

impl<N: Lane> Link<N> {
    pub(super) const NONE: Self =
        Self { places: [GROUND; 2], count: 0, lower: [N::Double::ZERO; LOWER], rows: [LinkRow::NONE; ROWS] };

    /// Subtracts a motion of an end from the wanted velocities.
    #[inline(always)]
    pub(super) fn want_against(&mut self, end: usize, motion: &Screw<N>) {
        for row in &mut self.rows[..self.count] {
            row.wanted -= dot::<N>(&widen(&row.jacobians[end]), motion);
        }
    }

    /// Replaces the lower half of E by its factors. Rows that depend on earlier rows, and rows that no
    /// impulse moves, are left out.
    #[inline(always)]
    fn factor(&mut self, count: usize) {
        let Self { lower, rows, .. } = self;
        for j in 0..count {
            let (own, mut pivot) = (lower[at(j, j)], lower[at(j, j)]);
            for m in 0..j {
                // `lower[at(j, m)]` is still multiplied by D[m] here.
                let scaled = lower[at(j, m)] * rows[m].inverse;
                pivot -= scaled * lower[at(j, m)];
                lower[at(j, m)] = scaled;
            }
            rows[j].inverse = pivot.inverse_above(own * N::Double::splat(NO_PIVOT));
            for i in j + 1..count {
                for m in 0..j {
                    let of_both = lower[at(i, m)] * lower[at(j, m)];
                    lower[at(i, j)] -= of_both;
                }
            }
        }
    }

    /// E⁻¹ x.
    #[inline(always)]
    fn solve(&self, x: &mut [N::Double; ROWS], count: usize) {
        for i in 0..count {
            for m in 0..i {
                let passed = self.lower[at(i, m)] * x[m];
                x[i] -= passed;
            }
        }
        for i in (0..count).rev() {
            x[i] = x[i] * self.rows[i].inverse;
            for m in i + 1..count {
                let passed = self.lower[at(m, i)] * x[m];
                x[i] -= passed;
            }
        }
    }

    /// Eliminates the joint, and updates B of its parent.
    #[inline(always)]
    fn eliminate(&mut self, nodes: &mut [Node<N>], count: usize) {
        let [parent, child] = self.places;
        for i in 0..count {
            for j in 0..i {
                self.lower[at(i, j)] = N::Double::ZERO;
            }
            self.lower[at(i, i)] = self.rows[i].softness.double();
        }
        for (side, place) in [parent, child].into_iter().enumerate() {
            let Some(node) = nodes.get(place as usize) else { continue };
            for i in 0..count {
                let response = product(&node.left, &self.rows[i].jacobians[side]);
                if side == 0 {
                    self.rows[i].passed = response;
                }
                for j in i..count {
                    self.lower[at(j, i)] += dot::<N>(&response, &widen(&self.rows[j].jacobians[side]));
                }
            }
        }
        self.factor(count);
        let Some(node) = nodes.get_mut(parent as usize) else { return };
        // L⁻¹ W, then B − Wᵀ E⁻¹ W row by row, then Y.
        for i in 0..count {
            for m in 0..i {
                let (of_m, times) = (self.rows[m].passed, -self.lower[at(i, m)]);
                add::<N>(&mut self.rows[i].passed, &of_m, times);
            }
        }
        for row in &self.rows[..count] {
            for k in 0..DOF {
                add::<N>(&mut node.left[k], &row.passed, -row.passed[k] * row.inverse);
            }
        }
        for i in (0..count).rev() {
            for k in 0..DOF {
                self.rows[i].passed[k] = self.rows[i].passed[k] * self.rows[i].inverse;
            }
            for m in i + 1..count {
                let (of_m, times) = (self.rows[m].passed, -self.lower[at(m, i)]);
                add::<N>(&mut self.rows[i].passed, &of_m, times);
            }
        }
    }

    /// Computes E⁻¹ e, and adds Yᵀ e to g of the parent.
    #[inline(always)]
    fn rise(&mut self, nodes: &mut [Node<N>], count: usize) {
        let mut is_still = true;
        for row in &self.rows[..count] {
            is_still &= row.wanted.is_zero();
        }
        for place in self.places {
            if let (true, Some(node)) = (is_still, nodes.get(place as usize)) {
                for number in &node.motion {
                    is_still &= number.is_zero();
                }
            }
        }
        if is_still {
            for row in &mut self.rows[..count] {
                row.impulse = N::Double::ZERO;
            }
            return;
        }
        let mut e = [N::Double::ZERO; ROWS];
        for i in 0..count {
            e[i] = self.rows[i].wanted;
        }
        for (side, place) in self.places.into_iter().enumerate() {
            let Some(node) = nodes.get(place as usize) else { continue };
            for i in 0..count {
                e[i] -= dot::<N>(&widen(&self.rows[i].jacobians[side]), &node.motion);
            }
        }
        if let Some(node) = nodes.get_mut(self.places[0] as usize) {
            for i in 0..count {
                add::<N>(&mut node.motion, &self.rows[i].passed, e[i]);
            }
        }
        self.solve(&mut e, count);
        for i in 0..count {
            self.rows[i].impulse = e[i];
        }
    }

    /// Subtracts the effect of the parent's other joints, and adds the impulses to the impulses on both
    /// bodies.
    #[inline(always)]
    fn fall(&mut self, nodes: &mut [Node<N>], count: usize) {
        if let Some(node) = nodes.get(self.places[0] as usize) {
            for row in &mut self.rows[..count] {
                row.impulse -= dot::<N>(&row.passed, &node.impulse);
            }
        }
        for (side, place) in self.places.into_iter().enumerate() {
            let Some(node) = nodes.get_mut(place as usize) else { continue };
            for row in &self.rows[..count] {
                add::<N>(&mut node.impulse, &widen(&row.jacobians[side]), row.impulse);
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

/// Eliminates the joints of a tree. They are ordered from the root on.
#[inline(always)]
pub(super) fn factor<N: Lane>(links: &mut [Link<N>], nodes: &mut [Node<N>]) {
    for node in nodes.iter_mut() {
        for k in 0..DOF {
            node.left[k] = widen(&node.inverse[k]);
        }
    }
    for link in links.iter_mut().rev() {
        by_count!(link.eliminate(nodes));
    }
}

/// Solves a factored tree for the wanted velocities of its joints. Afterwards each joint has its impulse,
/// and each body the total impulse of its joints.
#[inline(always)]
pub(super) fn solve<N: Lane>(links: &mut [Link<N>], nodes: &mut [Node<N>]) {
    for node in nodes.iter_mut() {
        (node.motion, node.impulse) = ([N::Double::ZERO; DOF], [N::Double::ZERO; DOF]);
    }
    for link in links.iter_mut().rev() {
        by_count!(link.rise(nodes));
    }
    for link in links.iter_mut() {
        by_count!(link.fall(nodes));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{DIM, F32x4};
    use proptest::prelude::*;

    /// A tree built from seeds: masses, parents, rows and directions.
    fn tree(seeds: &[(f64, u32, u64)], ratio: f64) -> (Vec<Link<f32>>, Vec<Node<f32>>) {
        let mut state = 1u64;
        let mut any = |seed: u64| {
            state = (state ^ seed).wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1u64 << 53) as f64 * 2.0 - 1.0
        };
        let (mut links, mut nodes): (Vec<Link<f32>>, Vec<Node<f32>>) = (Vec::new(), Vec::new());
        for (number, &(weight, parent, seed)) in seeds.iter().enumerate() {
            let mut inverse = [[0.0f32; DOF]; DOF];
            let inv_mass = 1.0 / ratio.powf(weight);
            let roots: [Screw<f32>; DOF] = core::array::from_fn(|_| core::array::from_fn(|_| any(seed)));
            for (i, row) in inverse.iter_mut().enumerate() {
                for (j, x) in row.iter_mut().enumerate() {
                    let turn =
                        if i >= DIM && j >= DIM { 0.3 * dot::<f32>(&roots[i], &roots[j]) } else { 0.0 };
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
                (row.softness, row.wanted) = (1.0e-3 * inv_mass as f32, f64::from(any(seed) as f32));
            }
            links.push(link);
            if ends[1] == GROUND && number > 0 {
                // The body is also attached to an earlier body.
                let places = [parent % number as u32, number as u32];
                links.insert(links.len() - 1, Link { places, ..link });
            }
        }
        (links, nodes)
    }

    /// J Δv + Γ λ − r, with Δv = M⁻¹ Σ Jᵀ λ.
    fn residual(links: &[Link<f32>], nodes: &[Node<f32>]) -> f64 {
        let mut impulses = vec![[0.0; DOF]; nodes.len()];
        for link in links {
            for (side, place) in link.places.into_iter().enumerate().filter(|(_, place)| *place != GROUND) {
                for row in &link.rows[..link.count] {
                    add::<f32>(&mut impulses[place as usize], &widen(&row.jacobians[side]), row.impulse);
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
                    sum += dot::<f32>(&widen(&row.jacobians[side]), &change);
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

    /// The tree in one of four lanes.
    fn side_by_side(
        links: &[Link<f32>],
        nodes: &[Node<f32>],
        lane: usize,
    ) -> (Vec<Link<F32x4>>, Vec<Node<F32x4>>) {
        let put = |value: f32| {
            let mut wide = F32x4::ZERO;
            wide.set(lane, value);
            wide
        };
        let of_link = |link: &Link<f32>| {
            let mut wide = Link { places: link.places, count: link.count, ..Link::NONE };
            for (wide, row) in wide.rows.iter_mut().zip(&link.rows) {
                wide.jacobians = row.jacobians.map(|jacobian| jacobian.map(put));
                wide.softness = put(row.softness);
                wide.wanted = put(row.wanted as f32).double();
            }
            wide
        };
        let of_node = |node: &Node<f32>| Node::new(node.inverse.map(|row| row.map(put)));
        (links.iter().map(of_link).collect(), nodes.iter().map(of_node).collect())
    }

    proptest! {
        #[test]
        fn all_joints_of_a_tree_get_what_they_want(
            seeds in prop::collection::vec((0.0f64..1.0, any::<u32>(), any::<u64>()), 1..40),
            ratio in prop::sample::select(vec![1.0, 100.0, 1.0e6]),
        ) {
            let (mut links, mut nodes) = tree(&seeds, ratio);
            // The same tree in one lane, next to empty lanes.
            let lane = seeds.len() % 4;
            let (mut wide_links, mut wide_nodes) = side_by_side(&links, &nodes, lane);
            factor(&mut links, &mut nodes);
            factor(&mut wide_links, &mut wide_nodes);
            for _ in 0..2 {
                solve(&mut links, &mut nodes);
                solve(&mut wide_links, &mut wide_nodes);
                let most = residual(&links, &nodes);
                prop_assert!(most < 1.0e-6, "off by {most}");
                for (link, wide) in links.iter().zip(&wide_links) {
                    for (row, wide) in link.rows.iter().zip(&wide.rows) {
                        let wide = F32x4::of_double(wide.impulse);
                        prop_assert_eq!((row.impulse as f32).to_bits(), wide.get(lane).to_bits());
                        prop_assert!((0..4).all(|other| other == lane || wide.get(other) == 0.0));
                    }
                }
            }
        }
    }

    #[test]
    fn rows_that_nothing_moves_are_left_out() {
        let mut held = [[0.0; DOF]; DOF];
        held[1][1] = 2.0;
        let mut link = Link::<f32> { places: [0, GROUND], count: 3, ..Link::NONE };
        for (row, axis) in link.rows.iter_mut().zip([0, 1, 1]) {
            row.jacobians[0][axis] = 1.0;
            row.wanted = 4.0;
        }
        let (mut links, mut nodes) = ([link], [Node::new(held)]);
        factor(&mut links, &mut nodes);
        solve(&mut links, &mut nodes);
        assert_eq!(links[0].rows.map(|row| row.impulse)[..3], [0.0, 2.0, 0.0]);
        assert_eq!(nodes[0].change()[1], 4.0);
    }
}
