//! The time at which two moving shapes first meet, by conservative advancement (B. Mirtich, "Impulse-based
//! Dynamic Simulation", 1996).
//!
//! Time advances by the least time that the gap between the shapes needs to close, until they are close
//! enough. Casts, sweeps and predicted contacts differ in how they bound that time.

/// How close two shapes are at a time of their motion.
pub(crate) enum Approach<T, M> {
    /// The shapes are apart, and stay apart at least until this time.
    ApartUntil(T),
    /// The shapes are close enough.
    Met(M),
}

/// Advances the time from `start` to the time at which two shapes meet. `evaluate` gets a time and the
/// number of the round, from 1 to `rounds`. It returns how close the shapes are at that time, or `None` if
/// they do not meet.
///
/// Shapes that are still apart after the last round count as a miss, unless `evaluate` returns
/// [`Approach::Met`] in it.
#[inline(always)]
pub(crate) fn advance<T, M>(
    start: T,
    rounds: usize,
    mut evaluate: impl FnMut(T, usize) -> Option<Approach<T, M>>,
) -> Option<M> {
    let mut time = start;
    for round in 1..=rounds {
        match evaluate(time, round)? {
            Approach::ApartUntil(later) => time = later,
            Approach::Met(meeting) => return Some(meeting),
        }
    }
    None
}
