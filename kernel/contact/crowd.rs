//! The bound on the contacts of bodies that were placed into each other.

use super::manager::ContactManager;
use crate::data::BitSet;
use crate::graph::COLOR_COUNT;
use crate::math::min;
use crate::shape::Shape;
use crate::table::{BodyKind, NONE};
use crate::tuning::contact::DEEP;

impl ContactManager<'_> {
    /// The pairs, by their indices, that get no contact yet. Bodies in one place come apart by a few
    /// contacts each; contacts of all pairs, n² / 2, would only take time and memory. Look for these pairs
    /// again in the next step: they get their contacts when the bodies have come apart, or when other
    /// contacts have ended.
    ///
    /// A collider is full while it has as many deep contacts as there are colours. A deep pair waits while
    /// the larger collider is full. Another pair waits if both colliders have deep contacts, and both are
    /// full, or one is and their boxes do not overlap. Only solid convex colliders of dynamic bodies wait,
    /// and no pair of sleeping bodies.
    pub fn left_out(&self, pairs: &[(u32, u32)]) -> BitSet {
        let (mut left_out, mut fills) = (BitSet::default(), Vec::new());
        for (place, &(a, b)) in pairs.iter().enumerate() {
            let pair = [a, b];
            let Some(shares) = self.deep_shares(pair).filter(|_| self.is_awake_pair(pair)) else { continue };
            let is_larger = |side: usize| shares[side] <= shares[1 - side];
            if (0..2).any(|side| is_larger(side) && is_full(*self.fill(pair[side], &mut fills))) {
                left_out.insert(place as u32);
            } else {
                (0..2).for_each(|side| *self.fill(pair[side], &mut fills) += shares[side]);
            }
        }
        if left_out.is_empty() {
            return left_out;
        }
        for (place, &(a, b)) in pairs.iter().enumerate() {
            let pair = [a, b];
            if self.is_bounded(pair) && self.is_awake_pair(pair) && self.deep_shares(pair).is_none() {
                let fills = pair.map(|id| *self.fill(id, &mut fills));
                let (all, any) = (fills.into_iter().all(is_full), fills.into_iter().any(is_full));
                if all || any && fills.iter().all(|fill| *fill > 0.0) && !self.do_boxes_overlap(pair) {
                    left_out.insert(place as u32);
                }
            }
        }
        left_out
    }

    fn is_awake_pair(&self, pair: [u32; 2]) -> bool {
        pair.iter().any(|id| self.is_awake(self.colliders.body(*id)))
    }

    fn do_boxes_overlap(&self, pair: [u32; 2]) -> bool {
        let [a, b] = pair.map(|id| &self.colliders.tight[id as usize]);
        a.overlaps(b)
    }

    /// Whether both colliders are solid, convex, and on dynamic bodies.
    fn is_bounded(&self, pair: [u32; 2]) -> bool {
        pair.iter().all(|id| {
            let def = &self.colliders[*id].def;
            let is_convex =
                !matches!(def.shape, Shape::Composite(_) | Shape::Foreign(_) | Shape::HalfSpace(_));
            let is_dynamic = def.body != NONE && self.bodies[def.body].kind == BodyKind::Dynamic;
            is_convex && is_dynamic && !def.flags.sensor
        })
    }

    /// By how much a contact fills each collider, if the [balls within](Shape::core) the shapes overlap
    /// deeply: by 1 from another of its size or larger, by the ratio of sizes from a smaller one.
    fn deep_shares(&self, pair: [u32; 2]) -> Option<[f32; 2]> {
        if !self.do_boxes_overlap(pair) || !self.is_bounded(pair) {
            return None;
        }
        let [(a, first), (b, second)] = pair.map(|id| {
            let (center, radius) = self.colliders[id].def.shape.core();
            (self.colliders.poses[id as usize].transform(center), radius)
        });
        let smaller = min(first, second);
        let is_deep = smaller > 0.0 && (b - a).to_local().length() < first + second - DEEP * smaller;
        is_deep.then(|| [smaller / first, smaller / second])
    }

    /// How full a collider is, by the contacts that push it and by pairs that are added to it.
    fn fill<'f>(&self, id: u32, fills: &'f mut Vec<Option<f32>>) -> &'f mut f32 {
        if fills.is_empty() {
            fills.resize(self.colliders.poses.len(), None);
        }
        fills[id as usize].get_or_insert_with(|| {
            let contacts = self.contacts.of_collider(id, self.colliders).map(|id| self.contacts.get(id));
            let shares = contacts.filter(|contact| contact.is_solved()).filter_map(|contact| {
                Some(self.deep_shares(contact.colliders)?[usize::from(contact.colliders[1] == id)])
            });
            shares.sum()
        })
    }
}

fn is_full(fill: f32) -> bool {
    fill >= COLOR_COUNT as f32
}
