//! Groups of trees of equal shape, which are solved in SIMD lanes: ragdolls, vehicles and bridges of a
//! world are mostly alike.

use super::forest::{Branch, Forest, GROUND};
use super::tree_joint::range;

/// Maximum number of trees in a group.
pub(super) const MAX_LANES: usize = 8;

/// Numbers of trees of equal shape, one per lane. [`GROUND`] in unused lanes.
pub(super) type Group = [u32; MAX_LANES];

/// Finds trees of equal shape: their joints connect the same nodes and have the same rows.
#[derive(Clone, Debug, Default)]
pub(super) struct Shapes {
    /// The shape of the joint of each branch.
    shapes: Vec<u32>,
    /// The shapes and the width of the last grouping.
    grouped: (Vec<u32>, usize),
    /// The last groups, of one tree and of several trees.
    groups: [Vec<Group>; 2],
    /// The hash of each tree's shape, and the tree's number.
    hashes: Vec<(u64, u32)>,
}

impl Shapes {
    /// Groups all trees, at most `width` per group. `shape` gives the shapes of joints by id, and `is_same`
    /// tells whether the forest is the same as in the last call. Groups of one tree are in the first list.
    pub(super) fn group(
        &mut self,
        (forest, is_same): (&Forest, bool),
        shape: impl Fn(u32) -> u32,
        width: usize,
        groups: [&mut Vec<Group>; 2],
    ) {
        self.shapes.clear();
        self.shapes.extend(forest.branches.iter().map(|branch| shape(branch.id)));
        if !(is_same && (&self.grouped.0, self.grouped.1) == (&self.shapes, width)) {
            self.regroup(forest, width);
            core::mem::swap(&mut self.grouped.0, &mut self.shapes);
            self.grouped.1 = width;
        }
        for (groups, last) in groups.into_iter().zip(&self.groups) {
            groups.clone_from(last);
        }
    }

    fn regroup(&mut self, forest: &Forest, width: usize) {
        let Self { shapes, hashes, groups: [ones, wide], .. } = self;
        let words = |tree: u32| words(forest, shapes, tree);
        hashes.clear();
        hashes.extend((0..forest.trees.len() as u32).map(|tree| {
            let mix = |hash: u64, word| {
                (hash ^ u64::from(word)).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(29)
            };
            (words(tree).fold(0, mix), tree)
        }));
        hashes.sort_unstable();
        ones.clear();
        wide.clear();
        let mut rest = &hashes[..];
        while let [(hash, first), ..] = *rest {
            let is_alike = |(other, tree): &&(u64, u32)| *other == hash && words(*tree).eq(words(first));
            let count = rest.iter().take(width).take_while(is_alike).count();
            let mut group = [GROUND; MAX_LANES];
            for (place, (_, tree)) in group.iter_mut().zip(&rest[..count]) {
                *place = *tree;
            }
            if count == 1 { &mut *ones } else { &mut *wide }.push(group);
            rest = &rest[count..];
        }
    }
}

/// The numbers that describe the shape of a tree.
fn words<'a>(forest: &'a Forest, shapes: &'a [u32], tree: u32) -> impl Iterator<Item = u32> + 'a {
    let span = &forest.trees[tree as usize];
    let first = span.bodies[0];
    range(span.branches).flat_map(move |k| {
        let Branch { parent_side, places: [parent, child], .. } = forest.branches[k];
        let child = if child == GROUND { GROUND } else { child - first };
        [shapes[k], parent_side as u32, parent - first, child]
    })
}

#[cfg(test)]
mod tests {
    use super::super::forest::Edge;
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn trees_of_equal_shape_are_side_by_side() {
        // Chains of three bodies: one is attached by its other end, and one has another kind of joint.
        let chain =
            |first: u32, id: u32| [[first, first + 1], [first + 1, first + 2]].map(move |nodes| (id, nodes));
        let edges: Vec<Edge> =
            [chain(0, 0), chain(3, 0), [(0, [8, 7]), (0, [7, 6])], chain(9, 1), chain(12, 0)]
                .into_iter()
                .flatten()
                .map(|(id, nodes)| Edge { id, nodes })
                .collect();
        let mut forest = Forest::default();
        forest.build(&edges, 15, 1);
        let (mut ones, mut wide) = (Vec::new(), Vec::new());
        Shapes::default().group((&forest, false), |id| id, 4, [&mut ones, &mut wide]);
        let alike = |trees: [u32; 3]| {
            let mut group = [GROUND; MAX_LANES];
            group[..3].copy_from_slice(&trees);
            group
        };
        assert_eq!(wide, [alike([0, 1, 4])]);
        assert_eq!(
            ones.iter().map(|group| group[0]).collect::<std::collections::BTreeSet<_>>(),
            [2, 3].into()
        );
    }

    proptest! {
        #[test]
        fn each_tree_is_in_one_group_of_its_shape(
            kinds in prop::collection::vec((0u32..3, 1u32..4), 0..60),
            width in 1usize..=MAX_LANES,
        ) {
            let (mut edges, mut nodes) = (Vec::new(), 0);
            for (kind, length) in &kinds {
                edges.extend((0..*length).map(|k| Edge { id: *kind, nodes: [nodes + k, nodes + k + 1] }));
                nodes += length + 1;
            }
            let mut forest = Forest::default();
            forest.build(&edges, nodes as usize, 1);
            let (mut ones, mut wide) = (Vec::new(), Vec::new());
            Shapes::default().group((&forest, false), |id| id, width, [&mut ones, &mut wide]);
            let mut seen: Vec<u32> = Vec::new();
            for group in ones.iter().chain(&wide) {
                let trees: Vec<u32> = group.iter().copied().filter(|tree| *tree != GROUND).collect();
                prop_assert!(trees.len() <= width);
                prop_assert!(trees.iter().all(|tree| kinds[*tree as usize] == kinds[trees[0] as usize]));
                seen.extend(trees);
            }
            seen.sort_unstable();
            prop_assert!(seen.into_iter().eq(0..kinds.len() as u32));
            // No two groups of the same shape have room for each other.
            let part: Vec<_> = ones.iter().chain(&wide).filter(|group| group[..width].contains(&GROUND)).collect();
            let mut shapes: Vec<_> = part.iter().map(|group| kinds[group[0] as usize]).collect();
            shapes.sort_unstable();
            shapes.dedup();
            prop_assert_eq!(shapes.len(), part.len());
        }
    }
}
