//! The stack of a tree walk.

/// Number of entries that fit without allocating. A walk needs at most one entry per level, and nearly all
/// trees are lower.
const FIXED: usize = 64;

/// A stack with its first entries inline. Deeper entries spill to the heap.
pub(super) struct Stack<T> {
    fixed: [T; FIXED],
    len: usize,
    spill: Vec<T>,
}

impl<T: Copy + Default> Stack<T> {
    #[inline(always)]
    pub fn new() -> Self {
        Self { fixed: [T::default(); FIXED], len: 0, spill: Vec::new() }
    }

    #[inline(always)]
    pub fn push(&mut self, value: T) {
        if self.len < FIXED {
            self.fixed[self.len] = value;
            self.len += 1;
        } else {
            self.spill(value);
        }
    }

    /// Pushes a value if `wanted`. There is no jump while there is room.
    #[inline(always)]
    pub fn push_if(&mut self, value: T, wanted: bool) {
        if self.len < FIXED {
            self.fixed[self.len] = value;
            self.len += usize::from(wanted);
        } else if wanted {
            self.spill(value);
        }
    }

    #[inline(always)]
    pub fn pop(&mut self) -> Option<T> {
        // Entries spill only while the inline part is full.
        if self.len == FIXED
            && let Some(value) = self.spill.pop()
        {
            return Some(value);
        }
        self.len = self.len.checked_sub(1)?;
        Some(self.fixed[self.len])
    }

    #[cold]
    #[inline(never)]
    fn spill(&mut self, value: T) {
        self.spill.push(value);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(16))]
        #[test]
        fn behaves_as_a_vec(ops in prop::collection::vec(prop::option::weighted(0.53, any::<u32>()), 3_000)) {
            let (mut stack, mut model) = (Stack::new(), Vec::new());
            for op in ops {
                match op {
                    Some(value) => {
                        stack.push(value);
                        model.push(value);
                    }
                    None => prop_assert_eq!(stack.pop(), model.pop()),
                }
            }
            while let Some(value) = model.pop() {
                prop_assert_eq!(stack.pop(), Some(value));
            }
            prop_assert_eq!(stack.pop(), None);
        }
    }
}
