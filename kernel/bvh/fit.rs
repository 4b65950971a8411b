//! All boxes of a tree anew, by a team.
#![expect(unsafe_code, reason = "branches are changed by several threads, each its own subtrees")]

use super::tree::{Branch, LEAF, Leaf, NONE, Tree, admitted};
use crate::data::Parts;
use crate::shape::Aabb;
use crate::team::Team;

/// Into about so many subtrees a tree is cut for the members of a team.
const SUBTREES: usize = 64;

/// Where leaves get their boxes, and who they are.
struct Source<'a, F> {
    leaves: &'a [Leaf],
    boxes: &'a F,
}

impl Tree {
    /// Gives every leaf the box of its id, and fits the boxes above. Costs as much as the tree is large: for when much
    /// of it moved.
    pub fn fit(&mut self, boxes: &(impl Fn(u32) -> Aabb + Sync), team: &Team) {
        if self.root == NONE {
            return;
        }
        // Taken out, so that a panic of `boxes` leaves nothing in it.
        let mut list = core::mem::take(&mut self.order);
        let Self { branches, leaves, root, root_box, .. } = self;
        let source = Source { leaves, boxes };
        if *root & LEAF == 0 {
            // From the root down, until there are enough branches to begin below.
            list.push(*root);
            let mut above = 0;
            while above < list.len() && list.len() - above < SUBTREES {
                let children = branches[list[above] as usize].children;
                list.extend(children.into_iter().filter(|child| child & LEAF == 0));
                above += 1;
            }
            let (above, below) = list.split_at(above);
            let shared = Parts::of(branches);
            // SAFETY: no branch is below two others neither of which is below the other.
            team.run(below.len(), |i, _| _ = unsafe { source.fit_below(&shared, below[i]) });
            for &branch in above.iter().rev() {
                let fitted = branches[branch as usize].children.map(|child| source.fitted(branches, child));
                put(&mut branches[branch as usize], fitted);
            }
            list.clear();
        }
        *root_box = source.fitted(branches, *root).0;
        self.order = list;
    }
}

/// A box, and whether a leaf in it moved since the last rebuild, if it is one of a branch.
type Fitted = (Aabb, bool);

/// Gives a branch the boxes of its children.
#[inline(always)]
fn put(branch: &mut Branch, fitted: [Fitted; 2]) {
    for (i, (aabb, is_enlarged)) in fitted.into_iter().enumerate() {
        let is_leaf = branch.children[i] & LEAF != 0;
        let is_enlarged = if is_leaf { branch.boxes[i] != aabb } else { is_enlarged };
        branch.boxes[i] = aabb;
        branch.enlarged |= u16::from(is_enlarged) << i;
    }
}

/// The box around a branch whose boxes are right.
#[inline(always)]
fn around(branch: &Branch) -> Fitted {
    (branch.boxes[0].union(&branch.boxes[1]), branch.enlarged != 0)
}

impl<F: Fn(u32) -> Aabb> Source<'_, F> {
    #[inline(always)]
    fn leaf(&self, node: u32) -> Fitted {
        (admitted((self.boxes)(self.leaves[(node & !LEAF) as usize].id)), false)
    }

    /// The box of a node below which all boxes are right.
    fn fitted(&self, branches: &[Branch], node: u32) -> Fitted {
        if node & LEAF != 0 { self.leaf(node) } else { around(&branches[node as usize]) }
    }

    /// Fits all boxes below a branch, and gives the box around them. As deep as a tree is high.
    ///
    /// # Safety
    /// Nobody may use the branch nor those below it meanwhile.
    unsafe fn fit_below(&self, branches: &Parts<Branch>, branch: u32) -> Fitted {
        // SAFETY: by the contract.
        let branch = unsafe { branches.one(branch as usize) };
        let fitted = branch.children.map(|child| {
            if child & LEAF != 0 {
                self.leaf(child)
            } else {
                // SAFETY: it is below the branch, and is not the branch.
                unsafe { self.fit_below(branches, child) }
            }
        });
        put(branch, fitted);
        around(branch)
    }
}
