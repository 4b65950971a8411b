//! Bytes of memory per body, collider and contact: printed by `cargo test -- memory --nocapture`, and listed
//! in docs/hot-loops.md.

use crate::kernel;
use core::mem::size_of;
use kernel::bvh::Tree;
use kernel::contact::ContactTable;
use kernel::data::PairSet;
use kernel::graph::{ColorGraph, Islands};
use kernel::math::{DIM, F32x4, Lane};
use kernel::solver::{BodyRow, ContactRow, ImpactRow, InvMass, MassRow, Motion};
use kernel::table::{BodyTable, ColliderTable};

/// Bytes per contact in a wide row: data of all passes, and data of impacts.
fn row<const P: usize>() -> [usize; 2] {
    fn of<N: Lane, M: InvMass<N>, const P: usize>() -> [usize; 2] {
        [size_of::<ContactRow<N, M, P>>() / N::WIDTH, size_of::<ImpactRow<N>>() / N::WIDTH]
    }
    of::<F32x4, F32x4, P>()
}

#[test]
fn memory_of_bodies_colliders_and_contacts_stays_in_its_budget() {
    let [color_of_body, color_of_contact] = ColorGraph::BYTES;
    let body = [BodyTable::BYTES_PER_BODY, Islands::BYTES_PER_BODY + color_of_body];
    let rows = [size_of::<BodyRow>(), size_of::<MassRow>(), size_of::<Motion>()];
    let collider = [ColliderTable::BYTES_PER_COLLIDER, Tree::BYTES_PER_LEAF];
    let slots = 2 * PairSet::BYTES_PER_SLOT;
    let contact = [ContactTable::BYTES_PER_CONTACT, slots, Islands::BYTES_PER_LINK + color_of_contact];
    let contact_rows = [row::<1>(), row::<2>(), row::<4>()];
    println!("{DIM}D, bytes:");
    println!("body {body:?}, awake also rows {rows:?}");
    println!("collider {collider:?}");
    println!("contact {contact:?}, touching and awake also rows {contact_rows:?} with one, two, four points");
    let sum = |parts: &[usize]| parts.iter().sum::<usize>();
    let (body, collider, contact) = (sum(&body), sum(&collider), sum(&contact));
    println!("sum {body} + {}, {collider}, {contact} + {:?}", sum(&rows), contact_rows.map(|r| sum(&r)));
    // World positions are twice as large, and may need alignment.
    let more = if size_of::<kernel::math::Scalar>() == 8 { 16 } else { 0 };
    let [of_body, of_collider, of_contact] = if DIM == 2 { [108, 264, 252] } else { [148, 316, 356] };
    let budget = [of_body + more, of_collider + more, of_contact];
    assert!([body, collider, contact].iter().zip(budget).all(|(is, most)| *is <= most), "{budget:?}");
}
