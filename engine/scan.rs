//! Scans all entities with a component for changes, by tables, reading only change ticks.

use bevy_ecs::{change_detection::Tick, system::SystemChangeTick};

/// The reason why a query can iterate over tables.
pub(crate) const IN_TABLES: &str = "components of the engine are stored in tables";

/// Maximum age of a tick. Older ticks get this age, which makes ages comparable although ticks wrap around.
const MAX_AGE: u32 = Tick::MAX.get();

/// A filter for changes after a tick.
///
/// A change is new if its age is below a limit. Both are stored with the sign bit flipped: then unsigned
/// order equals signed order, for which every CPU has SIMD comparisons.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Since {
    now: u32,
    age: i32,
}

/// The sign bit.
const SIGN: u32 = 1 << 31;

impl Since {
    /// Changes since `last`, for a system that runs now.
    pub(crate) fn new(last: Tick, system: SystemChangeTick) -> Self {
        Self::between(last, system.this_run())
    }

    fn between(last: Tick, now: Tick) -> Self {
        let age = now.get().wrapping_sub(last.get()).min(MAX_AGE);
        Self { now: now.get() ^ SIGN, age: (age ^ SIGN) as i32 }
    }

    /// Changes since the system last ran.
    pub(crate) fn last_run(system: SystemChangeTick) -> Self {
        Self::new(system.last_run(), system)
    }

    /// Like [`Tick::is_newer_than`], without branches.
    #[inline(always)]
    pub(crate) fn is_new(self, tick: Tick) -> bool {
        (self.now.wrapping_sub(tick.get()) as i32) < self.age
    }

    /// Calls `found` with each row where any of the columns is new.
    ///
    /// Most rows are not new, so stretches of rows are first tested as a whole, in a loop that the compiler
    /// vectorises.
    pub(crate) fn rows<const N: usize>(self, columns: [&[Tick]; N], mut found: impl FnMut(usize)) {
        let count = columns.iter().map(|column| column.len()).min().unwrap_or(0);
        for start in (0..count).step_by(STRETCH) {
            let rows = start..(start + STRETCH).min(count);
            let any =
                |column: &[Tick]| column[rows.clone()].iter().fold(false, |any, t| any | self.is_new(*t));
            if !columns.iter().any(|column| any(column)) {
                continue;
            }
            for row in rows.clone() {
                if columns.iter().any(|column| self.is_new(column[row])) {
                    found(row);
                }
            }
        }
    }
}

/// Number of rows that are tested as a whole.
const STRETCH: usize = 128;

#[cfg(test)]
mod tests {
    use super::*;

    fn since(last: u32, now: u32) -> Since {
        Since::between(Tick::new(last), Tick::new(now))
    }

    #[test]
    fn ages_compare_as_bevy_compares_them() {
        let ticks = [0, 1, 2, 1000, MAX_AGE, MAX_AGE + 1, u32::MAX - 1, u32::MAX];
        for last in ticks {
            for now in ticks {
                for tick in ticks {
                    let expected = Tick::new(tick).is_newer_than(Tick::new(last), Tick::new(now));
                    assert_eq!(since(last, now).is_new(Tick::new(tick)), expected, "{tick} {last} {now}");
                }
            }
        }
    }

    #[test]
    fn exactly_the_new_rows_are_found() {
        for count in [0, 1, 127, 128, 129, 1000] {
            let old = vec![Tick::new(5); count];
            let mut some = old.clone();
            for row in (0..count).step_by(37) {
                some[row] = Tick::new(11);
            }
            let mut found = Vec::new();
            since(10, 12).rows([&old, &some], |row| found.push(row));
            assert_eq!(found, (0..count).step_by(37).collect::<Vec<_>>());
        }
    }
}
