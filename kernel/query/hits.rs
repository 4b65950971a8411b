//! Hits in the order of their distances.

use crate::math::Scalar;

/// A hit of a collider.
pub trait Hit: Copy {
    /// The distance in metres; nearer hits come first.
    fn distance(&self) -> Scalar;
    /// The collider, which orders hits at the same distance.
    fn collider(&self) -> u32;
}

/// The nearest of some hits; of equally near hits, the hit with the lowest collider id.
#[derive(Clone, Copy, Debug)]
pub struct Nearest<H> {
    best: Option<H>,
}

impl<H> Default for Nearest<H> {
    fn default() -> Self {
        Self { best: None }
    }
}

impl<H: Hit> Nearest<H> {
    /// Takes a hit if it is the nearest so far. Returns the limit for further hits: its distance, or `limit`
    /// if that is less.
    pub fn offer(&mut self, hit: Option<H>, limit: Scalar) -> Scalar {
        let Some(hit) = hit else { return limit };
        let is_nearer = |best: H| (hit.distance(), hit.collider()) < (best.distance(), best.collider());
        if self.best.is_none_or(is_nearer) {
            self.best = Some(hit);
        }
        if hit.distance() < limit { hit.distance() } else { limit }
    }

    /// The nearest hit.
    pub fn best(self) -> Option<H> {
        self.best
    }
}

/// Sorts hits by distance, and hits at the same distance by collider.
pub fn sort_hits<H: Hit>(hits: &mut [H]) {
    hits.sort_unstable_by(|a, b| a.distance().total_cmp(&b.distance()).then(a.collider().cmp(&b.collider())));
}
