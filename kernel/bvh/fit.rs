//! Sets all boxes of a tree, with the work shared by several workers.
#![expect(unsafe_code, reason = "branches are changed by several threads, each its own subtrees")]

use super::tree::{Branch, LEAF, Leaf, NONE, Tree, admitted};
use crate::data::Parts;
use crate::shape::Aabb;
use crate::thread_pool::ThreadPool;

/// The approximate number of subtrees that workers fit. Fewer subtrees balance worse; more take longer to
/// find.
const SUBTREES: usize = 64;

/// The source of the leaves' boxes.
struct Source<'a, F> {
    leaves: &'a [Leaf],
    boxes: &'a F,
}

impl Tree {
    /// Sets the box of every leaf by its id, and recomputes the boxes above. The cost depends on the size of
    /// the tree: use it if a large share of the leaves moved. [`Tree`] compares it with other changes.
    pub fn fit(&mut self, boxes: &(impl Fn(u32) -> Aabb + Sync), pool: &ThreadPool) {
        if self.root == NONE {
            return;
        }
        // The buffer is taken out of the tree, so it is empty even after a panic of `boxes`.
        let mut list = core::mem::take(&mut self.order);
        let Self { branches, leaves, root, root_box, .. } = self;
        let source = Source { leaves, boxes };
        if *root & LEAF == 0 {
            // Open branches from the root down, until there are enough subtrees.
            list.push(*root);
            let mut above = 0;
            while above < list.len() && list.len() - above < SUBTREES {
                let children = branches[list[above] as usize].children;
                list.extend(children.into_iter().filter(|child| child & LEAF == 0));
                above += 1;
            }
            let (above, below) = list.split_at(above);
            let shared = Parts::of(branches);
            // SAFETY: the subtrees are disjoint.
            pool.run(below.len(), |i, _| _ = unsafe { source.fit_below(&shared, below[i]) });
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

/// A box, and whether a leaf in it moved since the last rebuild (for a branch).
type Fitted = (Aabb, bool);

/// Sets the boxes of a branch to the boxes of its children.
#[inline(always)]
fn put(branch: &mut Branch, fitted: [Fitted; 2]) {
    for (i, (aabb, is_enlarged)) in fitted.into_iter().enumerate() {
        let is_leaf = branch.children[i] & LEAF != 0;
        let is_enlarged = if is_leaf { branch.boxes[i] != aabb } else { is_enlarged };
        branch.boxes[i] = aabb;
        branch.enlarged |= u16::from(is_enlarged) << i;
    }
}

/// The box around a branch whose boxes are up to date.
#[inline(always)]
fn around(branch: &Branch) -> Fitted {
    (branch.boxes[0].union(&branch.boxes[1]), branch.enlarged != 0)
}

impl<F: Fn(u32) -> Aabb> Source<'_, F> {
    #[inline(always)]
    fn leaf(&self, node: u32) -> Fitted {
        (admitted((self.boxes)(self.leaves[(node & !LEAF) as usize].id)), false)
    }

    /// The box of a node. All boxes below it are up to date.
    fn fitted(&self, branches: &[Branch], node: u32) -> Fitted {
        if node & LEAF != 0 { self.leaf(node) } else { around(&branches[node as usize]) }
    }

    /// Sets all boxes below a branch and returns the box around them. The recursion is as deep as the tree is
    /// high.
    ///
    /// # Safety
    /// While the call runs, no other thread may use the branch or the branches below it.
    unsafe fn fit_below(&self, branches: &Parts<Branch>, branch: u32) -> Fitted {
        // SAFETY: by the contract.
        let branch = unsafe { branches.one(branch as usize) };
        let fitted = branch.children.map(|child| {
            if child & LEAF != 0 {
                self.leaf(child)
            } else {
                // SAFETY: the child is below the branch, and differs from it.
                unsafe { self.fit_below(branches, child) }
            }
        });
        put(branch, fitted);
        around(branch)
    }
}
