//! When to give back buffers that a crowd filled, after the crowd is gone.

/// Buffers are given back after this number of steps in which they were hardly used. After each time the
/// number doubles, up to [`MOST_STEPS`]: a crowd that is gone leaves nothing behind at once, and crowds that
/// come in waves soon keep their buffers.
const LEAST_STEPS: u32 = 2;

/// The greatest number of steps. Fewer reallocate for crowds that come in waves; more hold the memory longer.
const MOST_STEPS: u32 = 256;

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
    /// The number of steps between two checks; 0 before buffers were first given back.
    patience: u32,
}

impl Slack {
    /// Counts a step with `used` places in use. Returns whether to give the buffers back.
    #[inline]
    pub fn is_due(&mut self, used: usize) -> bool {
        self.recent = self.recent.max(used);
        self.held = self.held.max(used);
        self.steps += 1;
        let patience = self.patience.max(LEAST_STEPS);
        if self.steps < patience {
            return false;
        }
        let recent = core::mem::take(&mut self.recent);
        self.steps = 0;
        let is_due = self.held >= WORTH && recent <= self.held / SHARE;
        if is_due {
            self.held = recent;
            self.patience = (2 * patience).min(MOST_STEPS);
        }
        is_due
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The places that buffers have after some steps, if they grow to what a step uses.
    fn sizes(used: impl Fn(u32) -> usize, steps: u32) -> Vec<usize> {
        let (mut slack, mut size) = (Slack::default(), 0);
        let step = |step| {
            size = size.max(used(step));
            if slack.is_due(used(step)) {
                size = used(step);
            }
            size
        };
        (0..steps).map(step).collect()
    }

    #[test]
    fn buffers_are_given_back_at_once_after_a_crowd() {
        let sizes = sizes(|step| if step < 99 { 100_000 } else { 100 }, 1000);
        assert!(sizes[..99].iter().all(|size| *size == 100_000));
        assert!(sizes[99 + 2 * LEAST_STEPS as usize..].iter().all(|size| *size == 100));
    }

    #[test]
    fn what_comes_in_waves_is_soon_kept() {
        for period in [3, 10, 100] {
            let sizes = sizes(|step| if step % period == 0 { 100_000 } else { 0 }, 100 * period);
            let grown = sizes.windows(2).filter(|pair| pair[0] < pair[1]).count();
            assert!(grown <= 8, "grown {grown} times, with a period of {period} steps");
            assert!(sizes[50 * period as usize..].iter().all(|size| *size == 100_000));
        }
    }

    #[test]
    fn small_buffers_and_those_in_use_are_kept() {
        for used in [WORTH - 1, SHARE * WORTH] {
            let least = used / SHARE + 1;
            let sizes = sizes(|step| if step == 0 { used } else { least.min(used) }, 1000);
            assert!(sizes.iter().all(|size| *size == used));
        }
    }
}
