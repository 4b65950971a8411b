//! Buffers that a crowd has filled, and that are given back when it is gone.

/// The number of steps in which buffers were hardly used before they are given back. Fewer allocate anew for what comes in
/// waves, more hold the memory longer.
const STEPS: u32 = 256;

/// The number of places of a buffer for each one in use, from which it is given back. Smaller gives back and allocates more often;
/// larger keeps more memory.
const SHARE: usize = 4;

/// The least number of places that is worth giving back.
const WORTH: usize = 4096;

/// How much of some buffers is used, step by step.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Slack {
    /// The most that was used since buffers were given back.
    held: usize,
    /// The most that was used since the last look.
    recent: usize,
    steps: u32,
}

impl Slack {
    /// Counts a step in which `used` places are used. Returns whether the buffers are to be given back.
    #[inline]
    pub fn is_due(&mut self, used: usize) -> bool {
        self.recent = self.recent.max(used);
        self.held = self.held.max(used);
        self.steps += 1;
        if self.steps < STEPS {
            return false;
        }
        let recent = core::mem::take(&mut self.recent);
        self.steps = 0;
        let is_due = self.held >= WORTH && recent <= self.held / SHARE;
        if is_due {
            self.held = recent;
        }
        is_due
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn buffers_are_given_back_once_a_while_after_a_crowd() {
        let mut slack = Slack::default();
        (0..3).for_each(|_| assert!(!slack.is_due(100_000)));
        let due: Vec<u32> = (0..4 * STEPS).filter(|_| slack.is_due(100)).collect();
        assert_eq!(due.len(), 1);
        assert!(due[0] < 2 * STEPS, "within two looks, {due:?}");
    }

    #[test]
    fn what_comes_in_waves_is_kept() {
        let mut slack = Slack::default();
        assert!((0..4 * STEPS).all(|step| !slack.is_due(if step % 100 == 0 { 100_000 } else { 0 })));
    }
}
