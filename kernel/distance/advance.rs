//! When two shapes that move first meet, by conservative advancement (B. Mirtich, "Impulse-based Dynamic Simulation", 1996).
//!
//! The time advances by what the gap between the shapes takes to close at least, until they are near enough. Casts, sweeps and
//! predicted contacts differ in how they bound that time.

/// How near two shapes are at a time of their motion.
pub(crate) enum Approach<T, M> {
    /// Apart, and they stay apart at least until this time.
    ApartUntil(T),
    /// Near enough.
    Met(M),
}

/// Advances the time from `start` to where two shapes meet. `look` gets a time and the number of the look, from 1 to `rounds`.
/// It tells how near the shapes are then, or that they do not meet.
///
/// Shapes that are still apart after the last look count as a miss, unless `look` returns [`Approach::Met`] there.
#[inline(always)]
pub(crate) fn advance<T, M>(
    start: T,
    rounds: usize,
    mut look: impl FnMut(T, usize) -> Option<Approach<T, M>>,
) -> Option<M> {
    let mut time = start;
    for round in 1..=rounds {
        match look(time, round)? {
            Approach::ApartUntil(later) => time = later,
            Approach::Met(meeting) => return Some(meeting),
        }
    }
    None
}
