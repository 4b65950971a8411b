//! Finds the joints that are solved directly: trees in the graph of bodies and joints, in an order for
//! elimination.
//!
//! Bodies that joints do not move are not nodes: a joint to such a body is a leaf of its tree. A bridge
//! between two towers is therefore a tree.

/// Stands for a body that joints do not move.
pub(super) const GROUND: u32 = u32::MAX;

/// An edge of the graph of bodies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Edge {
    /// The joint.
    pub(super) id: u32,
    /// Nodes of its bodies, or [`GROUND`].
    pub(super) nodes: [u32; 2],
}

/// A joint of a tree. The parent is the end closer to the root.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Branch {
    /// The joint.
    pub(super) id: u32,
    /// The side of the joint on the parent: 0 for A.
    pub(super) parent_side: usize,
    /// Indices of parent and child among the bodies of all trees, or [`GROUND`].
    pub(super) places: [u32; 2],
}

/// The branches and bodies of one tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Span {
    pub(super) branches: [u32; 2],
    pub(super) bodies: [u32; 2],
}

/// Trees of joints.
#[derive(Clone, Debug, Default)]
pub(super) struct Forest {
    pub(super) trees: Vec<Span>,
    /// Branches from the roots on: each comes after the branch to its parent.
    pub(super) branches: Vec<Branch>,
    /// The node of each body of the trees. The root of a tree comes first.
    pub(super) bodies: Vec<u32>,
    /// By node, its tree; [`GROUND`] if it is in no tree.
    pub(super) owners: Vec<u32>,
    /// By node, the first of its edges in `links`; one more entry marks the end.
    starts: Vec<u32>,
    /// Indices of the edges of each node, node by node.
    links: Vec<u32>,
    /// By edge, whether the edge may be in a tree.
    hangs: Vec<bool>,
    /// By node, the number of edges to other nodes that are not yet known to be in a tree.
    degrees: Vec<u32>,
    /// Nodes with exactly one such edge.
    ends: Vec<u32>,
    /// By node, its index among the bodies; [`GROUND`] before it is found.
    found: Vec<u32>,
}

impl Forest {
    pub(super) fn clear(&mut self) {
        self.trees.clear();
        self.branches.clear();
        self.bodies.clear();
    }

    /// Builds trees of at least `fewest` edges among `nodes` nodes. Loops, and paths between two loops, are
    /// left out; trees attached to them are included.
    pub(super) fn build(&mut self, edges: &[Edge], nodes: usize, fewest: usize) {
        self.clear();
        self.link(edges, nodes);
        self.peel(edges, nodes);
        for list in [&mut self.owners, &mut self.found] {
            list.clear();
            list.resize(nodes, GROUND);
        }
        for node in 0..nodes as u32 {
            if self.found[node as usize] == GROUND {
                self.grow(edges, node, fewest);
            }
        }
    }

    /// Lists the edges of each node.
    fn link(&mut self, edges: &[Edge], nodes: usize) {
        let Self { starts, links, .. } = self;
        let ends = || {
            let all = edges.iter().zip(0u32..).flat_map(|(edge, i)| edge.nodes.map(|node| (i, node)));
            all.filter(|(_, node)| *node != GROUND)
        };
        starts.clear();
        starts.resize(nodes + 1, 0);
        ends().for_each(|(_, node)| starts[node as usize + 1] += 1);
        (0..nodes).for_each(|node| starts[node + 1] += starts[node]);
        links.clear();
        links.resize(starts[nodes] as usize, 0);
        // Each start advances to the end of its edges, which is the start of the next node.
        for (edge, node) in ends() {
            let place = &mut starts[node as usize];
            links[*place as usize] = edge;
            *place += 1;
        }
        starts.rotate_right(1);
        starts[0] = 0;
    }

    /// Marks the edges outside of loops and of paths between loops, by repeatedly removing the last edge of
    /// each node with one edge left.
    fn peel(&mut self, edges: &[Edge], nodes: usize) {
        let Self { starts, links, hangs, degrees, ends, .. } = self;
        hangs.clear();
        hangs.extend(edges.iter().map(|edge| edge.nodes.contains(&GROUND)));
        degrees.clear();
        degrees.resize(nodes, 0);
        for edge in edges.iter().filter(|edge| !edge.nodes.contains(&GROUND)) {
            edge.nodes.into_iter().for_each(|node| degrees[node as usize] += 1);
        }
        ends.clear();
        ends.extend((0..nodes as u32).filter(|node| degrees[*node as usize] == 1));
        while let Some(node) = ends.pop() {
            let of_node = &links[starts[node as usize] as usize..starts[node as usize + 1] as usize];
            // Both ends of an edge may be in the list.
            let Some(edge) = of_node.iter().find(|edge| !hangs[**edge as usize]) else { continue };
            hangs[*edge as usize] = true;
            let [a, b] = edges[*edge as usize].nodes;
            let other = if a == node { b } else { a };
            degrees[other as usize] -= 1;
            if degrees[other as usize] == 1 {
                ends.push(other);
            }
        }
    }

    /// Adds the tree of a node, breadth first, unless the tree has too few edges.
    fn grow(&mut self, edges: &[Edge], root: u32, fewest: usize) {
        let Self { trees, branches, bodies, owners, starts, links, hangs, found, .. } = self;
        let first = [branches.len(), bodies.len()];
        let mut at = bodies.len();
        found[root as usize] = at as u32;
        bodies.push(root);
        // The edge by which a node was found is not followed back, because its other end is already found.
        while at < bodies.len() {
            let node = bodies[at];
            let of_node = &links[starts[node as usize] as usize..starts[node as usize + 1] as usize];
            for &edge in of_node.iter().filter(|edge| hangs[**edge as usize]) {
                let Edge { id, nodes } = edges[edge as usize];
                let parent_side = usize::from(nodes[0] != node);
                let other = nodes[1 - parent_side];
                let mut child = GROUND;
                if other != GROUND {
                    if found[other as usize] != GROUND {
                        continue;
                    }
                    child = bodies.len() as u32;
                    found[other as usize] = child;
                    bodies.push(other);
                }
                branches.push(Branch { id, parent_side, places: [at as u32, child] });
            }
            at += 1;
        }
        if branches.len() - first[0] < fewest {
            branches.truncate(first[0]);
            bodies.truncate(first[1]);
            return;
        }
        bodies[first[1]..].iter().for_each(|node| owners[*node as usize] = trees.len() as u32);
        let range = |start: usize, end: usize| [start as u32, end as u32];
        trees.push(Span { branches: range(first[0], branches.len()), bodies: range(first[1], bodies.len()) });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::collections::BTreeSet;

    fn built(pairs: &[[u32; 2]], nodes: usize, fewest: usize) -> (Vec<Edge>, Forest) {
        let edge = |(id, nodes): (usize, &[u32; 2])| Edge { id: id as u32, nodes: *nodes };
        let edges: Vec<Edge> = pairs.iter().enumerate().map(edge).collect();
        let mut forest = Forest::default();
        // Stale content must not matter.
        forest.build(&[Edge { id: 7, nodes: [0, 1] }], 2, 1);
        forest.build(&edges, nodes, fewest);
        (edges, forest)
    }

    #[test]
    fn a_bridge_is_one_tree() {
        let (_, forest) = built(&[[GROUND, 0], [0, 1], [2, 1], [2, GROUND]], 3, 3);
        assert_eq!(forest.trees, [Span { branches: [0, 4], bodies: [0, 3] }]);
        let ends: Vec<_> = forest.branches.iter().map(|b| (b.id, b.parent_side, b.places)).collect();
        let g = GROUND;
        assert_eq!(ends, [(0, 1, [0, g]), (1, 0, [0, 1]), (2, 1, [1, 2]), (3, 0, [2, g])]);
        assert_eq!(built(&[[GROUND, 0], [0, 1]], 2, 3).1.trees, []);
    }

    #[test]
    fn loops_are_left_out_and_what_hangs_on_them_is_not() {
        let ring = [[0, 1], [1, 2], [2, 3], [3, 0], [3, 4], [5, 4], [5, 6]];
        let (_, forest) = built(&ring, 7, 3);
        assert_eq!(forest.branches.iter().map(|b| b.id).collect::<Vec<_>>(), [4, 5, 6]);
        assert_eq!(forest.bodies, [3, 4, 5, 6]);
        assert_eq!(built(&[[0, 1], [1, 0]], 2, 1).1.trees, []);
    }

    /// Whether the ends of an edge are connected without the edge.
    fn is_loop(edges: &[Edge], without: &Edge) -> bool {
        let mut known = BTreeSet::from([without.nodes[0]]);
        for _ in 0..edges.len() {
            for edge in edges.iter().filter(|edge| edge.id != without.id && !edge.nodes.contains(&GROUND)) {
                if edge.nodes.iter().any(|node| known.contains(node)) {
                    known.extend(edge.nodes);
                }
            }
        }
        known.contains(&without.nodes[1])
    }

    proptest! {
        #[test]
        fn trees_hold_each_body_once_and_no_loop(
            pairs in prop::collection::vec([0u32..24, 0u32..24], 0..40),
            fewest in 1usize..6,
        ) {
            // Numbers from 20 on are the ground. A joint has two bodies, at most one of them the ground.
            let (nodes, g) = (20, |n: u32| if n < 20 { n } else { GROUND });
            let pairs: Vec<_> = pairs.into_iter().map(|pair| pair.map(g)).filter(|[a, b]| a != b).collect();
            let (edges, forest) = built(&pairs, nodes, fewest);
            let (mut seen, mut taken, mut end) = (BTreeSet::new(), BTreeSet::new(), 0);
            for (number, tree) in forest.trees.iter().enumerate() {
                prop_assert_eq!(tree.branches[0], end);
                end = tree.branches[1];
                prop_assert!((tree.branches[1] - tree.branches[0]) as usize >= fewest);
                let mut known = BTreeSet::from([tree.bodies[0]]);
                prop_assert!(seen.insert(forest.bodies[tree.bodies[0] as usize]), "a root is in no other tree");
                for branch in &forest.branches[tree.branches[0] as usize..tree.branches[1] as usize] {
                    let edge = edges.iter().find(|edge| edge.id == branch.id).unwrap();
                    prop_assert!(taken.insert(branch.id), "once");
                    let node = |place: u32| if place == GROUND { GROUND } else { forest.bodies[place as usize] };
                    let ends = branch.places.map(node);
                    prop_assert_eq!(edge.nodes[branch.parent_side], ends[0]);
                    prop_assert_eq!(edge.nodes[1 - branch.parent_side], ends[1]);
                    prop_assert_eq!(forest.owners[ends[0] as usize] as usize, number);
                    prop_assert!(known.contains(&branch.places[0]), "parents come first");
                    if ends[1] != GROUND {
                        prop_assert!(!is_loop(&edges, edge));
                        prop_assert!(known.insert(branch.places[1]), "no loop");
                        prop_assert!(seen.insert(ends[1]));
                        prop_assert!((tree.bodies[0]..tree.bodies[1]).contains(&branch.places[1]));
                    }
                }
                prop_assert_eq!(known.len() as u32, tree.bodies[1] - tree.bodies[0]);
            }
            if fewest == 1 {
                let is_left_out = |edge: &&Edge| !taken.contains(&edge.id);
                for edge in edges.iter().filter(is_left_out) {
                    prop_assert!(!edge.nodes.contains(&GROUND));
                    // The edge is in a loop, or connects two loops.
                    let in_loop = |node: u32| edges.iter().any(|other| other.nodes.contains(&node)
                        && !other.nodes.contains(&GROUND) && other.id != edge.id && !taken.contains(&other.id));
                    prop_assert!(edge.nodes.into_iter().all(in_loop), "{:?}", edge);
                }
            }
        }
    }
}
