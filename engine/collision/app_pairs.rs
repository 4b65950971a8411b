//! Pairs that the app adds to [`ContactGraph`] and removes from it, and its contents for apps that read it.

use bevy_ecs::prelude::*;
use kernel::{contact::ContactFlags, table::NONE};

use super::{
    contact_types::{
        ContactGraph,
        views::{ContactViews, Source},
    },
    pairs::{add_contact, wake_beset},
};
use crate::dynamics::{
    solver::schedule::SubstepCount,
    tables::{Bodies, Colliders, Contacts, Tables},
};

/// Creates contacts for the pairs that the app added, and removes the contacts of pairs that it removed, in
/// order of collider ids.
pub(crate) fn apply_app_pairs(mut graph: ResMut<ContactGraph>, mut tables: Tables) {
    let (added, removed) = graph.bypass_change_detection().take_changes();
    for entities in removed {
        let [Some(a), Some(b)] = entities.map(|entity| tables.colliders.find(entity)) else { continue };
        tables.end_contacts(a, |_, contact| contact.colliders.contains(&b));
    }
    let mut pairs: Vec<_> = added
        .iter()
        .filter_map(|pair| {
            let [a, b] = pair.colliders;
            let (a, b) = (tables.colliders.find(a)?, tables.colliders.find(b)?);
            Some((a.min(b), a.max(b), pair.pushes))
        })
        .collect();
    pairs.sort_unstable();
    pairs.dedup_by_key(|(a, b, _)| (*a, *b));
    let mut sleepers = Vec::new();
    for (a, b, pushes) in pairs {
        if is_possible(&tables, [a, b]) {
            let mut flags = ContactFlags::default();
            flags.set(ContactFlags::QUIET, !pushes);
            sleepers.extend(add_contact(&mut tables, [a, b], flags));
        }
    }
    wake_beset(&sleepers, &mut tables);
}

/// Whether two colliders have no contact yet, and may have one.
fn is_possible(tables: &Tables, [a, b]: [u32; 2]) -> bool {
    let Tables { bodies, colliders, contacts, .. } = tables;
    let body = colliders.table.body(a);
    (a != b && (body == NONE || body != colliders.table.body(b)))
        && contacts.table.find(a, b).is_none()
        && bodies.may_pair(&colliders.table, [a, b])
}

/// Fills [`ContactGraph`], if the app reads it.
pub(crate) fn fill_graph(
    mut graph: ResMut<ContactGraph>,
    views: Res<ContactViews>,
    (bodies, colliders, contacts): (Res<Bodies>, Res<Colliders>, Res<Contacts>),
    substeps: Option<Res<SubstepCount>>,
) {
    if graph.is_read() {
        views.note_reader();
        let substeps = substeps.map_or(1, |count| count.0.max(1));
        let source = Source { bodies: &bodies, colliders: &colliders, contacts: &contacts, substeps };
        graph.bypass_change_detection().refill(views.graph(source));
    }
}
