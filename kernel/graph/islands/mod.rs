//! Persistent islands: groups of dynamic bodies that are connected by links. The bodies of an island sleep
//! and wake together.

mod split;
mod validate;

use super::kind::{ConstraintId, ConstraintKind};
use super::union_find::DisjointSets;
use crate::data::IdPool;

/// Id of an island, valid until it is merged into another or loses its last body. Ids are reused.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct IslandId(pub u32);

/// The caller's id of a link: a contact or other constraint between two dynamic bodies.
///
/// It indexes a table, so keep ids small.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct LinkId(pub u32);

impl LinkId {
    /// The link of a constraint. The kind is the low digit, so the table is as long as the largest kind
    /// needs.
    pub fn of(ConstraintId { kind, id }: ConstraintId) -> Self {
        Self(id * ConstraintKind::COUNT as u32 + kind as u32)
    }
}

/// A link between two bodies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct IslandLink {
    /// The caller's id.
    pub key: LinkId,
    /// One body.
    pub a: u32,
    /// The other body; `u32::MAX` for a [carrier](Islands::link_carrier).
    pub b: u32,
}

impl IslandLink {
    fn is_to_carrier(&self) -> bool {
        self.b == NONE
    }

    /// The bodies of the link that are in islands.
    fn ends(&self) -> impl Iterator<Item = u32> {
        [self.a, self.b].into_iter().filter(|body| *body != NONE)
    }
}

/// Marks an absent island, index in the awake list, or body.
const NONE: u32 = u32::MAX;

const NOWHERE: Place = Place { island: NONE, index: NONE };

/// Message of a broken invariant of the lists.
const LISTED: &str = "a body's links are in its island";

/// Place of a body or link: an island and the index in its list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Place {
    island: u32,
    index: u32,
}

/// Record of a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Member {
    place: Place,
    /// The number of links of the body.
    links: u32,
}

impl Member {
    const NOBODY: Self = Self { place: NOWHERE, links: 0 };
}

/// Slot of an island. A free slot has no bodies.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Island {
    bodies: Vec<u32>,
    links: Vec<IslandLink>,
    /// Number of links removed since the island was last known to be connected.
    removed: u32,
    /// Index in the awake list, `NONE` if asleep.
    awake: u32,
    /// Number of links to carriers.
    carriers: u32,
    /// Whether the sleep timers of the bodies must be reset.
    is_woken: bool,
}

impl Island {
    const EMPTY: Self =
        Self { bodies: Vec::new(), links: Vec::new(), removed: 0, awake: NONE, carriers: 0, is_woken: false };
}

/// A connected part of an island that fell apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Piece {
    lowest_body: u32,
    size: u32,
    island: u32,
}

/// Buffers of [`Islands::split`], empty between calls except for `created`.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
struct Scratch {
    sets: DisjointSets,
    /// Index of the piece of each body, by the body's index in the island.
    piece_of: Vec<u32>,
    pieces: Vec<Piece>,
    order: Vec<u32>,
    created: Vec<IslandId>,
}

/// All islands.
///
/// Decision: islands persist (Catto, "Simulation Islands", 2023). A new link merges two islands at once, the
/// smaller into the larger. A removed link only increments `removed`; [`split`](Self::split) finds the
/// connected parts when a body is ready to sleep. In between an island may be larger than its connected
/// parts, never smaller. A search through all contacts in every step would cost most when nothing changes.
///
/// Only dynamic bodies are in islands: bodies on the same floor or lift need not sleep together. An island is
/// awake or asleep as a whole. The caller puts bodies and contacts to sleep and wakes them.
///
/// The state follows from the sequence of calls. The lowest free id is reused first, so ids depend only on
/// the live islands. Buffers are reused last in, first out: a steady state allocates nothing.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Islands {
    islands: Vec<Island>,
    ids: IdPool,
    /// Emptied buffers of removed islands.
    spare: Vec<(Vec<u32>, Vec<IslandLink>)>,
    awake: Vec<IslandId>,
    /// Records by body id.
    members: Vec<Member>,
    /// Places by link id.
    link_places: Vec<Place>,
    /// Whether any island may be marked as woken.
    any_woken: bool,
    /// The first island in the order of splitting.
    split_turn: IslandId,
    scratch: Scratch,
}

impl Islands {
    /// Bytes of memory per body, with its entry in an island.
    pub const BYTES_PER_BODY: usize = size_of::<Member>() + size_of::<u32>();
    /// Bytes of memory per link.
    pub const BYTES_PER_LINK: usize = size_of::<Place>() + size_of::<IslandLink>();

    /// An empty set of islands.
    pub fn new() -> Self {
        Self::default()
    }

    /// Gives back the storage of links that were removed.
    pub fn shrink(&mut self) {
        let placed = self.link_places.iter().rposition(|place| *place != NOWHERE);
        self.link_places.truncate(placed.map_or(0, |last| last + 1));
        self.link_places.shrink_to_fit();
        self.islands.iter_mut().for_each(|island| island.links.shrink_to_fit());
        self.spare.clear();
    }

    /// Adds a body in an awake island of its own. A body that already has an island stays in it.
    pub fn add_body(&mut self, body: u32) -> IslandId {
        if let Some(island) = self.island_of(body) {
            debug_assert!(false, "body {body} is already in {island:?}");
            return island;
        }
        let island = self.create(true);
        self.push_body(island, body);
        IslandId(island)
    }

    /// Removes a body. Its links must be removed before. An unknown body is ignored.
    pub fn remove_body(&mut self, body: u32) {
        let Some(place) = self.place(body) else { return };
        while self.members[body as usize].links > 0 {
            let island = &self.islands[place.island as usize];
            count_visits(island.links.len());
            let link = *island.links.iter().find(|link| link.a == body || link.b == body).expect(LISTED);
            debug_assert!(false, "{link:?} must be unlinked before its body is removed");
            self.unlink(link.key);
        }
        self.members[body as usize] = Member::NOBODY;
        let island = &mut self.islands[place.island as usize];
        island.bodies.swap_remove(place.index as usize);
        if let Some(moved) = island.bodies.get(place.index as usize) {
            self.members[*moved as usize].place.index = place.index;
        }
        if island.bodies.is_empty() {
            self.destroy(place.island);
        }
    }

    /// Links two bodies and merges their islands: the island with fewer bodies into the other, at a tie into
    /// the island with the lower id. Returns the id of the merged island.
    ///
    /// Both islands must be awake or both asleep: wake a sleeping island first, with its bodies and contacts.
    /// If the islands differ, the result is awake. Returns `None` and does nothing if a body has no island or
    /// the key is in use.
    pub fn link(&mut self, key: LinkId, a: u32, b: u32) -> Option<IslandId> {
        if self.is_linked(key) {
            debug_assert!(false, "{key:?} is linked twice");
            return None;
        }
        let (Some(island_a), Some(island_b)) = (self.island_of(a), self.island_of(b)) else {
            debug_assert!(false, "{key:?} links bodies {a} and {b}, which are not both in islands");
            return None;
        };
        let island = if island_a == island_b { island_a } else { self.merge(island_a, island_b) };
        self.push_link(island.0, IslandLink { key, a, b });
        for body in [a, b] {
            self.members[body as usize].links += 1;
        }
        Some(island)
    }

    /// Links a body to a carrier: an object that moves the body without being in an island, such as a lift.
    /// The link connects no bodies. It is counted, and stays with its body when islands merge or split.
    pub fn link_carrier(&mut self, key: LinkId, body: u32) {
        if self.is_linked(key) {
            debug_assert!(false, "{key:?} is linked twice");
        } else if let Some(island) = self.island_of(body) {
            self.push_link(island.0, IslandLink { key, a: body, b: NONE });
            self.members[body as usize].links += 1;
        }
    }

    /// Removes a link. The island stays whole until it is [split](Self::split). Returns whether the key was
    /// linked.
    pub fn unlink(&mut self, key: LinkId) -> bool {
        let place = place_in(&self.link_places, key.0);
        let Some(island) = self.islands.get_mut(place.island as usize) else { return false };
        self.link_places[key.0 as usize] = NOWHERE;
        let link = remove_link(island, &mut self.link_places, place.index);
        for body in link.ends() {
            self.members[body as usize].links -= 1;
        }
        true
    }

    /// Whether a link with this id exists.
    pub fn is_linked(&self, key: LinkId) -> bool {
        place_in(&self.link_places, key.0) != NOWHERE
    }

    /// The island of a body; `None` if the body was not added.
    pub fn island_of(&self, body: u32) -> Option<IslandId> {
        self.place(body).map(|place| IslandId(place.island))
    }

    fn place(&self, body: u32) -> Option<Place> {
        self.members.get(body as usize).map(|member| member.place).filter(|place| *place != NOWHERE)
    }

    /// The bodies of an island, in an order that follows from the calls. Empty if the island does not exist.
    pub fn bodies(&self, island: IslandId) -> &[u32] {
        let bodies: &[u32] = self.get(island).map_or(&[], |island| &island.bodies);
        count_visits(bodies.len());
        bodies
    }

    /// The links of an island.
    pub fn links(&self, island: IslandId) -> &[IslandLink] {
        self.get(island).map_or(&[], |island| &island.links)
    }

    /// The number of links that the island lost since it was last known to be connected. With 0 it is
    /// connected.
    pub fn removed(&self, island: IslandId) -> u32 {
        self.get(island).map_or(0, |island| island.removed)
    }

    /// Whether the island is asleep; `false` if the island does not exist.
    pub fn is_asleep(&self, island: IslandId) -> bool {
        self.get(island).is_some_and(|island| island.awake == NONE)
    }

    /// Puts an island to sleep or wakes it. New islands are awake.
    pub fn set_asleep(&mut self, island: IslandId, asleep: bool) {
        if self.get(island).is_none() || self.is_asleep(island) == asleep {
            return;
        }
        if asleep { self.drop_from_awake(island.0) } else { self.add_to_awake(island.0) }
    }

    /// Marks an awake island: the sleep timers of all its bodies must be reset.
    /// [`drain_woken`](Self::drain_woken) visits the bodies, once for all marks. An island that merges with a
    /// marked island is marked as well. Does nothing for a sleeping island.
    pub fn mark_woken(&mut self, island: IslandId) {
        if let Some(island) = self.islands.get_mut(island.0 as usize).filter(|island| island.awake != NONE) {
            island.is_woken = true;
            self.any_woken = true;
        }
    }

    /// Whether the sleep timers of the island must still be reset. Such an island must not fall asleep.
    pub fn is_woken(&self, island: IslandId) -> bool {
        self.get(island).is_some_and(|island| island.is_woken)
    }

    /// Calls `rest_anew` for each body of each [marked](Self::mark_woken) island, and clears the marks.
    pub fn drain_woken(&mut self, mut rest_anew: impl FnMut(u32)) {
        if !std::mem::take(&mut self.any_woken) {
            return;
        }
        for id in &self.awake {
            let island = &mut self.islands[id.0 as usize];
            if std::mem::take(&mut island.is_woken) {
                count_visits(island.bodies.len());
                island.bodies.iter().for_each(|body| rest_anew(*body));
            }
        }
    }

    /// The number of links to [carriers](Self::link_carrier).
    pub fn carriers(&self, island: IslandId) -> u32 {
        self.get(island).map_or(0, |island| island.carriers)
    }

    /// The lowest id of the next island to be split at any size.
    pub(super) fn split_turn(&self) -> IslandId {
        self.split_turn
    }

    pub(super) fn set_split_turn(&mut self, island: IslandId) {
        self.split_turn = island;
    }

    /// The awake islands, in an order that follows from the calls.
    pub fn awake_islands(&self) -> &[IslandId] {
        &self.awake
    }

    /// All islands, by ascending id.
    pub fn islands(&self) -> impl Iterator<Item = IslandId> {
        let live =
            |(id, island): (usize, &Island)| (!island.bodies.is_empty()).then_some(IslandId(id as u32));
        self.islands.iter().enumerate().filter_map(live)
    }

    /// The number of islands.
    pub fn len(&self) -> usize {
        self.ids.len()
    }

    /// Whether there are no islands, and so no bodies.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    fn merge(&mut self, a: IslandId, b: IslandId) -> IslandId {
        let size = |island: IslandId| self.get(island).map_or(0, |island| island.bodies.len());
        let (sizes, low_first) = ((size(a), size(b)), a < b);
        let a_is_large = sizes.0 > sizes.1 || (sizes.0 == sizes.1 && low_first);
        let (large, small) = if a_is_large { (a, b) } else { (b, a) };
        debug_assert!(
            self.is_asleep(a) == self.is_asleep(b),
            "{a:?} or {b:?} must be woken before the other links it"
        );
        if !self.is_asleep(small) {
            self.set_asleep(large, false);
        }
        // The emptied buffers are kept for reuse.
        let mut links = std::mem::take(&mut self.islands[small.0 as usize].links);
        links.drain(..).for_each(|link| self.push_link(large.0, link));
        let mut bodies = std::mem::take(&mut self.islands[small.0 as usize].bodies);
        bodies.drain(..).for_each(|body| self.push_body(large.0, body));
        let slot = &mut self.islands[small.0 as usize];
        (slot.links, slot.bodies) = (links, bodies);
        let Island { removed, is_woken, .. } = *slot;
        let sum = &mut self.islands[large.0 as usize];
        sum.removed = sum.removed.saturating_add(removed);
        // An island rests as long as its least rested body, so resetting all timers changes nothing.
        sum.is_woken |= is_woken;
        self.destroy(small.0);
        large
    }

    fn get(&self, island: IslandId) -> Option<&Island> {
        self.islands.get(island.0 as usize).filter(|island| !island.bodies.is_empty())
    }

    /// Creates an island without bodies. The caller adds the first body.
    fn create(&mut self, awake: bool) -> u32 {
        let id = self.ids.allocate();
        let (bodies, links) = self.spare.pop().unwrap_or_default();
        let island = Island { bodies, links, ..Island::EMPTY };
        match self.islands.get_mut(id as usize) {
            Some(slot) => *slot = island,
            None => self.islands.push(island),
        }
        if awake {
            self.add_to_awake(id);
        }
        id
    }

    /// Frees the slot of an island without bodies and links.
    fn destroy(&mut self, island: u32) {
        self.drop_from_awake(island);
        let slot = &mut self.islands[island as usize];
        (slot.removed, slot.carriers) = (0, 0);
        self.spare.push((core::mem::take(&mut slot.bodies), core::mem::take(&mut slot.links)));
        self.ids.free(island);
        self.ids.recycle();
        if self.ids.is_empty() {
            self.split_turn = IslandId::default();
        }
    }

    fn add_to_awake(&mut self, island: u32) {
        self.islands[island as usize].awake = self.awake.len() as u32;
        self.awake.push(IslandId(island));
    }

    fn drop_from_awake(&mut self, island: u32) {
        let slot = &mut self.islands[island as usize];
        slot.is_woken = false;
        let index = std::mem::replace(&mut slot.awake, NONE);
        if index != NONE {
            self.awake.swap_remove(index as usize);
            if let Some(moved) = self.awake.get(index as usize) {
                self.islands[moved.0 as usize].awake = index;
            }
        }
    }

    fn push_body(&mut self, island: u32, body: u32) {
        let list = &mut self.islands[island as usize].bodies;
        if self.members.len() <= body as usize {
            self.members.resize(body as usize + 1, Member::NOBODY);
        }
        self.members[body as usize].place = Place { island, index: list.len() as u32 };
        list.push(body);
    }

    fn push_link(&mut self, island: u32, link: IslandLink) {
        let list = &mut self.islands[island as usize].links;
        let key = link.key.0 as usize;
        if self.link_places.len() <= key {
            self.link_places.resize(key + 1, NOWHERE);
        }
        self.link_places[key] = Place { island, index: list.len() as u32 };
        list.push(link);
        self.islands[island as usize].carriers += u32::from(link.is_to_carrier());
    }
}

fn place_in(places: &[Place], id: u32) -> Place {
    places.get(id as usize).copied().unwrap_or(NOWHERE)
}

/// Removes the link at an index, and updates the place of the link that moved into the slot.
fn remove_link(island: &mut Island, places: &mut [Place], index: u32) -> IslandLink {
    let link = island.links.swap_remove(index as usize);
    if let Some(moved) = island.links.get(index as usize) {
        places[moved.key.0 as usize].index = index;
    }
    if link.is_to_carrier() {
        island.carriers -= 1;
    } else {
        // Islands are not split while sleeping is off: the counter must not wrap to 0, which means connected.
        island.removed = island.removed.saturating_add(1);
    }
    link
}

#[cfg(test)]
std::thread_local! {
    /// Number of bodies and links visited by walks over islands.
    pub(crate) static VISITS: std::cell::Cell<usize> = const { std::cell::Cell::new(0) };
}

/// Counts the visits of a walk over an island, for tests of complexity.
#[inline(always)]
fn count_visits(_count: usize) {
    #[cfg(test)]
    VISITS.set(VISITS.get() + _count);
}

#[cfg(test)]
mod tests;
