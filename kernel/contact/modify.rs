//! Contacts that the embedder changes between the narrow phase and the solver.

use super::record::{ContactFlags, Manifold, ManifoldSurface};
use super::table::{ContactTable, PointCount};
use crate::data::BitSet;
use crate::table::NONE;

impl ContactTable {
    /// Replaces the manifolds of a contact after the update of this step; the next update computes them anew.
    /// `changed` holds the contacts that began or ended in the update; this contact is inserted or removed to
    /// match its new state.
    ///
    /// Manifolds without points, or with values that are not finite, are left out.
    pub fn change(
        &mut self,
        id: u32,
        manifolds: impl Iterator<Item = (Manifold, ManifoldSurface)>,
        changed: &mut BitSet,
    ) {
        let touched = self.get(id).flags.has(ContactFlags::TOUCHING) != changed.contains(id);
        let mut kept = Vec::new();
        for (manifold, surface) in manifolds.filter(|(manifold, surface)| is_usable(manifold, surface)) {
            self.surfaces.insert((id, kept.len() as u32), surface);
            kept.push(manifold);
        }
        let contact = &mut self.contacts[id as usize];
        contact.manifold = kept.first().copied().unwrap_or_default();
        contact.flags.set(ContactFlags::TOUCHING, !kept.is_empty());
        contact.flags.set(ContactFlags::CHANGED, true);
        // The frozen manifold is the embedder's: the next update must not recycle it.
        contact.flags.set(ContactFlags::FROZEN, false);
        if contact.extra != NONE || kept.len() > 1 {
            self.store_extra(id, kept.get(1..).unwrap_or_default());
        }
        self.points[id as usize] = PointCount::of(&self.contacts[id as usize]);
        if touched == kept.is_empty() {
            changed.insert(id);
        } else {
            changed.remove(id);
        }
    }

    /// Forgets the changed surfaces of active contacts, which the update recomputes. Contacts at rest keep
    /// theirs.
    pub(super) fn forget_changes(&mut self) {
        let active = &self.active;
        self.surfaces.retain(|(id, _), _| !active.contains(*id));
    }

    /// Forgets the surfaces of one contact.
    pub(super) fn forget_surfaces(&mut self, id: u32) {
        if self.contacts[id as usize].flags.has(ContactFlags::CHANGED) {
            self.surfaces.retain(|(contact, _), _| *contact != id);
        }
    }

    /// The surface of a manifold of a changed contact.
    pub fn changed_surface(&self, id: u32, index: u32) -> Option<&ManifoldSurface> {
        self.surfaces.get(&(id, index))
    }
}

/// Whether the solver can take a manifold.
fn is_usable(manifold: &Manifold, surface: &ManifoldSurface) -> bool {
    let is_point = |p: &super::ManifoldPoint| {
        p.anchor.is_finite() && p.separation.is_finite() && p.impulse.is_finite() && p.impulse >= 0.0
    };
    manifold.count > 0
        && (manifold.normal.length() - 1.0).abs() < 1.0e-3
        && manifold.points().iter().all(is_point)
        && surface.friction >= 0.0
        && surface.friction.is_finite()
        && surface.restitution >= 0.0
        && surface.restitution.is_finite()
        && surface.velocity.is_finite()
}

#[cfg(test)]
mod tests {
    use super::super::{Contact, ManifoldPoint};
    use super::*;
    use crate::math::Vector;
    use crate::math::WorldPose;
    use crate::shape::{Ball, Shape};
    use crate::table::{BodyTable, ColliderDef, ColliderTable};

    /// A manifold with one point on a normal of length `length`.
    fn manifold(length: f32) -> (Manifold, ManifoldSurface) {
        let mut m =
            Manifold { normal: Vector { x: length, ..Vector::ZERO }, count: 1, ..Manifold::default() };
        m.points[0] = ManifoldPoint { separation: -0.01, ..ManifoldPoint::default() };
        (m, ManifoldSurface { friction: 0.5, ..ManifoldSurface::default() })
    }

    /// A table with one contact of two colliders. `touched` is its state before the last update, `touches`
    /// its present state.
    fn table(touched: bool, touches: bool) -> (ContactTable, BitSet) {
        let (mut bodies, mut colliders) = (BodyTable::default(), ColliderTable::default());
        for _ in 0..2 {
            let def = ColliderDef::new(Shape::Ball(Ball { radius: 1.0 }), NONE);
            colliders.add(def, WorldPose::IDENTITY, &mut bodies);
        }
        let mut table = ContactTable::default();
        let mut contact = Contact::new([0, 1], [NONE; 2], ContactFlags::default());
        contact.flags.set(ContactFlags::TOUCHING, touches);
        contact.flags.set(ContactFlags::FROZEN, true);
        let id = table.add(contact, &mut colliders);
        let mut changed = BitSet::new();
        if touched != touches {
            changed.insert(id);
        }
        (table, changed)
    }

    #[test]
    fn a_change_begins_and_ends_what_it_leaves() {
        for (touched, keeps, is_change) in
            [(false, false, false), (false, true, true), (true, false, true), (true, true, false)]
        {
            let (mut table, mut changed) = table(touched, true);
            table.change(0, keeps.then(|| manifold(1.0)).into_iter(), &mut changed);
            assert_eq!(changed.contains(0), is_change, "touched before: {touched}, kept: {keeps}");
            assert_eq!(table.get(0).flags.has(ContactFlags::TOUCHING), keeps);
            assert!(!table.get(0).flags.has(ContactFlags::FROZEN), "it would be recycled");
            assert_eq!(table.changed_surface(0, 0).is_some(), keeps);
        }
    }

    #[test]
    fn manifolds_that_cannot_be_solved_are_left_out() {
        let (mut table, mut changed) = table(false, true);
        let all = [manifold(0.0), manifold(1.0), manifold(f32::NAN), manifold(1.0)];
        table.change(0, all.into_iter(), &mut changed);
        let contact = table.get(0);
        assert_eq!((contact.manifold.count, table.extra_of(contact).len()), (1, 1));
        assert!(table.changed_surface(0, 1).is_some() && table.changed_surface(0, 2).is_none());
    }
}
