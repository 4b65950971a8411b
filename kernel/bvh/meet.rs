//! Walks two trees at once, or a tree against itself, for pairs of leaves that touch.
//!
//! If most leaves moved, a walk visits each branch a few times, while a query for each leaf would start at
//! the root and find every pair twice.

use super::tree::{LEAF, MAX_HEIGHT, NONE, ROOT, Tree};

/// Two slots, one in each tree, to be searched for pairs of leaves. In a walk of a tree against itself, the
/// same slot twice stands for the pairs within that slot.
pub(super) type Slots = [u32; 2];

/// Maximum number of slot pairs on the stack of a walk. Each step adds at most three if it goes down in both
/// trees, one if it goes down in one tree, and two in a walk of a tree against itself.
const DEEPEST: usize = 3 * MAX_HEIGHT as usize + 4;

/// The stack of a walk, kept between walks.
#[derive(Clone, Debug)]
pub(super) struct Walk {
    slots: Box<[Slots; DEEPEST]>,
    len: usize,
}

impl Default for Walk {
    fn default() -> Self {
        Self { slots: Box::new([[0; 2]; DEEPEST]), len: 0 }
    }
}

impl Walk {
    /// Pushes slots if `needed`. It has no jump, since a jump would be mispredicted.
    #[inline(always)]
    fn push_if(&mut self, needed: bool, slots: Slots) {
        self.slots[self.len] = slots;
        self.len += usize::from(needed);
    }

    #[inline(always)]
    fn pop(&mut self) -> Option<Slots> {
        self.len = self.len.checked_sub(1)?;
        Some(self.slots[self.len])
    }

    /// Calls `found` with the ids of a leaf of each tree if their boxes touch, for all leaves below two slots
    /// whose boxes touch. Without `b` it finds the leaves of `a` that touch each other, each pair once.
    pub(super) fn meet(&mut self, a: &Tree, b: Option<&Tree>, slots: Slots, mut found: impl FnMut(u32, u32)) {
        self.len = 0;
        self.push_if(true, slots);
        while let Some(slots) = self.pop() {
            self.step(a, b, slots, &mut found);
        }
    }

    /// Divides a walk into parts, breadth first, until there are at least `count` parts or none can be
    /// divided.
    pub(super) fn divide(&mut self, a: &Tree, b: Option<&Tree>, count: usize, parts: &mut Vec<Slots>) {
        parts.clear();
        let touch = match b {
            _ if a.root == NONE => false,
            None => true,
            Some(b) => b.root != NONE && a.root_box.overlaps(&b.root_box),
        };
        if !touch {
            return;
        }
        parts.push([ROOT; 2]);
        let (mut divided, mut whole) = (0, 0);
        while let Some(&slots) = parts.get(divided)
            && parts.len() - divided + whole < count
        {
            self.len = 0;
            let mut is_pair = false;
            self.step(a, b, slots, &mut |_, _| is_pair = true);
            if is_pair {
                parts.swap(whole, divided);
                whole += 1;
            }
            divided += 1;
            parts.extend_from_slice(&self.slots[..self.len]);
        }
        parts.drain(whole..divided);
    }

    /// Goes down by one level.
    #[inline(always)]
    fn step(&mut self, a: &Tree, b: Option<&Tree>, slots: Slots, found: &mut impl FnMut(u32, u32)) {
        let in_a = a.node_in(slots[0]);
        if b.is_none() && slots[0] == slots[1] {
            if in_a & LEAF == 0 {
                let branch = &a.branches[in_a as usize];
                let [first, second] = [in_a << 1, in_a << 1 | 1];
                self.push_if(branch.children[0] & LEAF == 0, [first; 2]);
                self.push_if(branch.children[1] & LEAF == 0, [second; 2]);
                self.push_if(branch.boxes[0].overlaps(&branch.boxes[1]), [first, second]);
            }
            return;
        }
        let b = b.unwrap_or(a);
        let in_b = b.node_in(slots[1]);
        match (in_a & LEAF == 0, in_b & LEAF == 0) {
            (true, true) => {
                let (boxes, others) = (&a.branches[in_a as usize].boxes, &b.branches[in_b as usize].boxes);
                for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                    let slots = [in_a << 1 | i, in_b << 1 | j];
                    self.push_if(boxes[i as usize].overlaps(&others[j as usize]), slots);
                }
            }
            (true, false) => {
                let (boxes, leaf) = (&a.branches[in_a as usize].boxes, b.slot_box(slots[1]));
                self.push_if(boxes[0].overlaps(&leaf), [in_a << 1, slots[1]]);
                self.push_if(boxes[1].overlaps(&leaf), [in_a << 1 | 1, slots[1]]);
            }
            (false, true) => {
                let (boxes, leaf) = (&b.branches[in_b as usize].boxes, a.slot_box(slots[0]));
                self.push_if(boxes[0].overlaps(&leaf), [slots[0], in_b << 1]);
                self.push_if(boxes[1].overlaps(&leaf), [slots[0], in_b << 1 | 1]);
            }
            (false, false) => {
                found(a.leaves[(in_a & !LEAF) as usize].id, b.leaves[(in_b & !LEAF) as usize].id);
            }
        }
    }
}

impl Tree {
    /// The content of a slot.
    #[inline(always)]
    fn node_in(&self, slot: u32) -> u32 {
        if slot == ROOT { self.root } else { self.branches[slot as usize >> 1].children[slot as usize & 1] }
    }
}
