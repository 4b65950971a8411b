//! When to give back buffers that a crowd filled, after the crowd is gone.

/// Buffers are given back after this number of steps in which they were hardly used. Fewer steps reallocate
/// for crowds that come in waves; more steps hold the memory longer.
const STEPS: u32 = 256;

/// The number of allocated places per used place from which a buffer is given back. Smaller gives back and
/// allocates more often; larger keeps more memory.
const SHARE: usize = 4;

/// The least number of places worth giving back.
const WORTH: usize = 4096;

/// The usage of some buffers, step by step.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Slack {
    /// Maximum usage since buffers were given back.
    held: usize,
    /// Maximum usage since the last check.
    recent: usize,
    steps: u32,
}

impl Slack {
    /// Counts a step with `used` places in use. Returns whether to give the buffers back.
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
