//! O(n) checks of a whole tree, for tests and the feature `validate`.

use super::tree::{LEAF, NO_LEAF, NONE, ROOT, Tree};
use crate::shape::Aabb;

impl Tree {
    /// Checks that links match, boxes contain the boxes below them, heights and flags are right, and every
    /// record is exactly once in the tree or in a free list.
    ///
    /// # Panics
    ///
    /// Names the broken invariant.
    pub fn validate(&self) {
        let mut branches = vec![false; self.branches.len()];
        let mut leaves = vec![false; self.leaves.len()];
        let mut order = Vec::new();
        if self.root != NONE {
            self.validate_node(self.root, ROOT, self.root_box, &mut leaves, &mut order);
        } else {
            assert!(self.root_box == Aabb::EMPTY, "an empty tree has a box");
        }
        let mut next = 0;
        while let Some(&i) = order.get(next) {
            next += 1;
            assert!(!core::mem::replace(&mut branches[i as usize], true), "branch {i} is met twice");
            let b = self.branches[i as usize];
            let height = b.children.map(|c| self.node_height(c));
            assert_eq!(b.height, 1 + height[0].max(height[1]), "height of branch {i}");
            let above = b.parent;
            if above != ROOT {
                let box_above = self.branches[above as usize >> 1].boxes[above as usize & 1];
                assert!(
                    box_above.contains(&b.boxes[0]) && box_above.contains(&b.boxes[1]),
                    "box of branch {i}"
                );
                let is_marked = self.branches[above as usize >> 1].enlarged >> (above & 1) & 1 != 0;
                assert!(is_marked || b.enlarged == 0, "branch {i} is enlarged, but not its slot");
            }
            assert!(b.enlarged < 4, "flags of branch {i}");
            for side in 0..2u32 {
                let child = b.children[side as usize];
                self.validate_node(child, i << 1 | side, b.boxes[side as usize], &mut leaves, &mut order);
            }
        }
        let found = leaves.iter().filter(|l| **l).count();
        assert_eq!(found, self.len(), "number of leaves");
        assert_eq!(order.len(), found.saturating_sub(1), "number of branches");
        self.validate_free(&mut branches, &mut leaves);
        assert!(self.items.is_empty() && self.order.is_empty(), "work space is left over");
    }

    fn validate_node(&self, node: u32, slot: u32, aabb: Aabb, leaves: &mut [bool], order: &mut Vec<u32>) {
        assert!(super::tree::admitted(aabb) == aabb, "a box in slot {slot} is neither valid nor empty");
        if node & LEAF == 0 {
            assert_eq!(self.branches[node as usize].parent, slot, "way back from branch {node}");
            if slot == ROOT {
                let boxes = &self.branches[node as usize].boxes;
                assert!(aabb.contains(&boxes[0]) && aabb.contains(&boxes[1]), "box of the tree");
            }
            order.push(node);
        } else {
            let leaf = (node & !LEAF) as usize;
            assert_eq!(self.leaves[leaf].slot, slot, "way back from leaf {leaf}");
            assert!(!core::mem::replace(&mut leaves[leaf], true), "leaf {leaf} is met twice");
        }
    }

    fn validate_free(&self, branches: &mut [bool], leaves: &mut [bool]) {
        let mut i = self.free_branch;
        while i != NONE {
            assert_eq!(self.branches[i as usize].height, 0, "free branch {i} has a height");
            assert!(!core::mem::replace(&mut branches[i as usize], true), "branch {i} is free and used");
            i = self.branches[i as usize].parent;
        }
        let mut i = self.free_leaf;
        while i != NO_LEAF {
            assert!(!core::mem::replace(&mut leaves[i as usize], true), "leaf {i} is free and used");
            let slot = self.leaves[i as usize].slot;
            assert!(slot & LEAF != 0 && slot != ROOT, "free leaf {i} has a slot");
            i = slot & !LEAF;
        }
        assert!(branches.iter().all(|b| *b), "a branch is neither used nor free");
        assert!(leaves.iter().all(|l| *l), "a leaf is neither used nor free");
    }
}
