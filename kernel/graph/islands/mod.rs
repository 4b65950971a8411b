//! Persistent islands: the groups of dynamic bodies that hang together through links and therefore
//! sleep and wake together.

mod split;
mod validate;

use super::kind::{ConstraintId, ConstraintKind};
use super::union_find::DisjointSets;
use crate::data::IdPool;

/// The name of an island, valid until it is merged away or loses its last body; reused after that.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct IslandId(pub u32);

/// The caller's name of a link: a contact or other constraint between two dynamic bodies.
///
/// A table is indexed by it, so keep ids small.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct LinkId(pub u32);

impl LinkId {
    /// The name of a constraint. The kind is in the low digit: so the table is as long as the kind with the most asks for.
    pub fn of(ConstraintId { kind, id }: ConstraintId) -> Self {
        Self(id * ConstraintKind::COUNT as u32 + kind as u32)
    }
}

/// A link with the two bodies it holds together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Link {
    /// The caller's name for it.
    pub key: LinkId,
    /// One body.
    pub a: u32,
    /// The other body; `u32::MAX` for a [carrier](Islands::link_carrier).
    pub b: u32,
}

impl Link {
    fn is_to_carrier(&self) -> bool {
        self.b == NONE
    }

    /// The bodies in islands that it holds.
    fn ends(&self) -> impl Iterator<Item = u32> {
        [self.a, self.b].into_iter().filter(|body| *body != NONE)
    }
}

/// Stands for "in no island", "not in the awake list" and "no body".
const NONE: u32 = u32::MAX;

/// Where a body or link lies: an island and the index in its list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Place {
    island: u32,
    index: u32,
}

const NOWHERE: Place = Place { island: NONE, index: NONE };

/// What is kept of a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Member {
    place: Place,
    /// How many links it has.
    links: u32,
}

impl Member {
    const NOBODY: Self = Self { place: NOWHERE, links: 0 };
}

/// A slot for an island; a free one has no bodies.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Island {
    bodies: Vec<u32>,
    links: Vec<Link>,
    /// Links lost since the island was last known to be connected.
    removed: u32,
    /// Index in the awake list, `NONE` if asleep.
    awake: u32,
    /// How many of its links are to carriers.
    carriers: u32,
    /// Whether its bodies are to rest anew.
    is_woken: bool,
}

impl Island {
    const EMPTY: Self =
        Self { bodies: Vec::new(), links: Vec::new(), removed: 0, awake: NONE, carriers: 0, is_woken: false };
}

/// One of the connected parts an island fell into.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Piece {
    lowest_body: u32,
    size: u32,
    island: u32,
}

/// Memory of [`Islands::split`], empty between calls except for `created`.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
struct Scratch {
    sets: DisjointSets,
    /// By index of a body in the island: the index of its piece.
    piece_of: Vec<u32>,
    pieces: Vec<Piece>,
    order: Vec<u32>,
    created: Vec<IslandId>,
}

/// The islands of a world.
///
/// Decision: islands persist (Catto, "Simulation Islands", 2023). A new link merges two islands at once,
/// the smaller into the larger; a removed link only counts up `removed`, and whether the island fell
/// apart is found out by [`split`](Self::split) when somebody wants to sleep. Between these times an
/// island may be larger than what is connected, never smaller. The alternative, a search through all
/// contacts every step, costs most when nothing changes.
///
/// Only dynamic bodies are in islands: what rests on the same floor or lift need not sleep together. An
/// island is awake or asleep as a whole; to put bodies and contacts to sleep, and to wake them, is up to
/// the caller.
///
/// Everything follows from the sequence of calls. The lowest free id is reused first, so that ids follow from the
/// islands there are; buffers are reused last in, first out: a steady state allocates nothing.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Islands {
    islands: Vec<Island>,
    ids: IdPool,
    /// The emptied buffers of former islands.
    spare: Vec<(Vec<u32>, Vec<Link>)>,
    awake: Vec<IslandId>,
    /// By body id.
    members: Vec<Member>,
    /// By link id.
    link_places: Vec<Place>,
    /// Whether an island may be marked as woken.
    any_woken: bool,
    /// The id from which on islands are next split.
    split_turn: IslandId,
    scratch: Scratch,
}

impl Islands {
    /// How many bytes are kept of each body here, besides its island's share.
    pub const BYTES_PER_BODY: usize = size_of::<Member>() + size_of::<u32>();
    /// How many bytes are kept of each link here.
    pub const BYTES_PER_LINK: usize = size_of::<Place>() + size_of::<Link>();

    /// No bodies, no islands.
    pub fn new() -> Self {
        Self::default()
    }

    /// Puts a body into an awake island of its own. A body that already has an island stays in it.
    pub fn add_body(&mut self, body: u32) -> IslandId {
        if let Some(island) = self.island_of(body) {
            debug_assert!(false, "body {body} is already in {island:?}");
            return island;
        }
        let island = self.create(true);
        self.push_body(island, body);
        IslandId(island)
    }

    /// Takes a body out; its links must have been unlinked before. An unknown body is ignored.
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

    /// Links two bodies and merges their islands at once: the one with fewer bodies into the other, at a
    /// tie into the one with the lower id. Returns the id of the island they are in now.
    ///
    /// Either both islands are awake or both asleep: wake the sleeping one first, with its bodies and
    /// contacts, for afterwards they cannot be told from the others. (If not, the result is awake.)
    /// `None`, and nothing happens, if a body has no island or the key is in use.
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
        self.push_link(island.0, Link { key, a, b });
        for body in [a, b] {
            self.members[body as usize].links += 1;
        }
        Some(island)
    }

    /// Links a body to something that moves it without being in an island, as a lift does. Such a link holds nothing
    /// together; it is counted, and stays with its body whatever island that comes to.
    pub fn link_carrier(&mut self, key: LinkId, body: u32) {
        if self.is_linked(key) {
            debug_assert!(false, "{key:?} is linked twice");
        } else if let Some(island) = self.island_of(body) {
            self.push_link(island.0, Link { key, a: body, b: NONE });
            self.members[body as usize].links += 1;
        }
    }

    /// Removes a link. An island that it held together stays whole until it is [split](Self::split). Returns whether the key
    /// was linked.
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

    /// Whether a link of this name exists.
    pub fn is_linked(&self, key: LinkId) -> bool {
        place_in(&self.link_places, key.0) != NOWHERE
    }

    /// The island of a body, `None` if the body was not added.
    pub fn island_of(&self, body: u32) -> Option<IslandId> {
        self.place(body).map(|place| IslandId(place.island))
    }

    fn place(&self, body: u32) -> Option<Place> {
        self.members.get(body as usize).map(|member| member.place).filter(|place| *place != NOWHERE)
    }

    /// The bodies of an island in an order that follows from the calls; none if there is no such island.
    pub fn bodies(&self, island: IslandId) -> &[u32] {
        let bodies: &[u32] = self.get(island).map_or(&[], |island| &island.bodies);
        count_visits(bodies.len());
        bodies
    }

    /// The links between the bodies of an island.
    pub fn links(&self, island: IslandId) -> &[Link] {
        self.get(island).map_or(&[], |island| &island.links)
    }

    /// How many links the island lost since it was last known to be connected. At 0 it is connected.
    pub fn removed(&self, island: IslandId) -> u32 {
        self.get(island).map_or(0, |island| island.removed)
    }

    /// Whether the island is asleep; `false` if there is no such island.
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

    /// Notes that the bodies of an awake island are to rest anew, all of them, whatever it costs to visit them: that is
    /// left to [`drain_woken`](Self::drain_woken), once for all notes since. An island that merges with a woken one is
    /// woken as well. Nothing for a sleeping island.
    pub fn mark_woken(&mut self, island: IslandId) {
        if let Some(island) = self.islands.get_mut(island.0 as usize).filter(|island| island.awake != NONE) {
            island.is_woken = true;
            self.any_woken = true;
        }
    }

    /// Whether the bodies of an island are still to rest anew: so it must not fall asleep.
    pub fn is_woken(&self, island: IslandId) -> bool {
        self.get(island).is_some_and(|island| island.is_woken)
    }

    /// Hands over the bodies of all islands that were [marked](Self::mark_woken), and takes the marks away.
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

    /// How many links to [carriers](Self::link_carrier) an island has.
    pub fn carriers(&self, island: IslandId) -> u32 {
        self.get(island).map_or(0, |island| island.carriers)
    }

    /// The lowest id that an island may have to be the next that is split, whatever its size.
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

    /// Whether there are no islands, hence no bodies.
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
        // The buffers go back, empty, to be used again.
        let mut links = std::mem::take(&mut self.islands[small.0 as usize].links);
        links.drain(..).for_each(|link| self.push_link(large.0, link));
        let mut bodies = std::mem::take(&mut self.islands[small.0 as usize].bodies);
        bodies.drain(..).for_each(|body| self.push_body(large.0, body));
        let slot = &mut self.islands[small.0 as usize];
        (slot.links, slot.bodies) = (links, bodies);
        let Island { removed, is_woken, .. } = *slot;
        let sum = &mut self.islands[large.0 as usize];
        sum.removed = sum.removed.saturating_add(removed);
        // It rests as long as its least rested body, so it makes no difference that all rest anew.
        sum.is_woken |= is_woken;
        self.destroy(small.0);
        large
    }

    fn get(&self, island: IslandId) -> Option<&Island> {
        self.islands.get(island.0 as usize).filter(|island| !island.bodies.is_empty())
    }

    /// An island without bodies; the caller adds the first one.
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

    /// Gives back the slot of an island that has lost all bodies and links.
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

    fn push_link(&mut self, island: u32, link: Link) {
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

/// Removes the link at an index and notes where the one moved into its slot now lies.
fn remove_link(island: &mut Island, places: &mut [Place], index: u32) -> Link {
    let link = island.links.swap_remove(index as usize);
    if let Some(moved) = island.links.get(index as usize) {
        places[moved.key.0 as usize].index = index;
    }
    if link.is_to_carrier() {
        island.carriers -= 1;
    } else {
        // Islands are not split while sleep is off: the counter must not wrap around to "connected".
        island.removed = island.removed.saturating_add(1);
    }
    link
}

/// What a broken invariant of the lists is called.
const LISTED: &str = "a body's links are in its island";

#[cfg(test)]
std::thread_local! {
    /// How many bodies and links were handed out or looked at, island by island.
    pub(crate) static VISITS: std::cell::Cell<usize> = const { std::cell::Cell::new(0) };
}

/// Counts what a walk over an island looks at, for tests of how the work grows.
#[inline(always)]
fn count_visits(_count: usize) {
    #[cfg(test)]
    VISITS.set(VISITS.get() + _count);
}

#[cfg(test)]
mod tests;
