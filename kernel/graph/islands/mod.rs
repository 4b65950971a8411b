//! Persistent islands: the groups of dynamic bodies that hang together through links and therefore
//! sleep and wake together.

mod split;

use super::union_find::DisjointSets;

/// The name of an island, valid until it is merged away or loses its last body; reused after that.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct IslandId(pub u32);

/// The caller's name of a link: a contact or joint between two dynamic bodies.
///
/// A table is indexed by it, so keep ids small. With several kinds of links put the kind into the low
/// bits (`2 * contact`, `2 * joint + 1`), not the high ones.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct LinkId(pub u32);

/// A link with the two bodies it holds together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Link {
    /// The caller's name for it.
    pub key: LinkId,
    /// One body.
    pub a: u32,
    /// The other body.
    pub b: u32,
}

/// Stands for "in no island" and "not in the awake list".
const NONE: u32 = u32::MAX;

/// Where a body or link lies: an island and the index in its list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Place {
    island: u32,
    index: u32,
}

const NOWHERE: Place = Place { island: NONE, index: NONE };

/// A slot for an island; a free one has no bodies.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Island {
    bodies: Vec<u32>,
    links: Vec<Link>,
    /// Links lost since the island was last known to be connected.
    removed: u32,
    /// Index in the awake list, `NONE` if asleep.
    awake: u32,
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
/// Everything follows from the sequence of calls. Freed ids are reused last in, first out, with their
/// memory: large buffers stay at the top of the stack, and a steady state allocates nothing.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Islands {
    islands: Vec<Island>,
    free: Vec<u32>,
    awake: Vec<IslandId>,
    /// By body id.
    body_places: Vec<Place>,
    /// By link id.
    link_places: Vec<Place>,
    scratch: Scratch,
}

impl Islands {
    /// How many bytes are kept of each body here, besides its island's share.
    pub const BYTES_PER_BODY: usize = size_of::<Place>() + size_of::<u32>();
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
        let place = place_in(&self.body_places, body);
        let Some(island) = self.islands.get_mut(place.island as usize) else { return };
        while let Some(link) = island.links.iter().find(|link| link.a == body || link.b == body) {
            debug_assert!(false, "{link:?} must be unlinked before its body is removed");
            let place = std::mem::replace(&mut self.link_places[link.key.0 as usize], NOWHERE);
            remove_link(island, &mut self.link_places, place.index);
        }
        island.bodies.swap_remove(place.index as usize);
        if let Some(moved) = island.bodies.get(place.index as usize) {
            self.body_places[*moved as usize].index = place.index;
        }
        self.body_places[body as usize] = NOWHERE;
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
        Some(island)
    }

    /// Removes a link. The island stays whole until it is [split](Self::split). Returns whether the key
    /// was linked.
    pub fn unlink(&mut self, key: LinkId) -> bool {
        let place = place_in(&self.link_places, key.0);
        let Some(island) = self.islands.get_mut(place.island as usize) else { return false };
        self.link_places[key.0 as usize] = NOWHERE;
        remove_link(island, &mut self.link_places, place.index);
        true
    }

    /// Whether a link of this name exists.
    pub fn is_linked(&self, key: LinkId) -> bool {
        place_in(&self.link_places, key.0) != NOWHERE
    }

    /// The island of a body, `None` if the body was not added.
    pub fn island_of(&self, body: u32) -> Option<IslandId> {
        let place = place_in(&self.body_places, body);
        (place != NOWHERE).then_some(IslandId(place.island))
    }

    /// The bodies of an island in an order that follows from the calls; none if there is no such island.
    pub fn bodies(&self, island: IslandId) -> &[u32] {
        self.get(island).map_or(&[], |island| &island.bodies)
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
        if self.bodies(island).is_empty() || self.is_asleep(island) == asleep {
            return;
        }
        if asleep { self.drop_from_awake(island.0) } else { self.add_to_awake(island.0) }
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
        self.islands.len() - self.free.len()
    }

    /// Whether there are no islands, hence no bodies.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    fn merge(&mut self, a: IslandId, b: IslandId) -> IslandId {
        let (sizes, low_first) = ((self.bodies(a).len(), self.bodies(b).len()), a < b);
        let a_is_large = sizes.0 > sizes.1 || (sizes.0 == sizes.1 && low_first);
        let (large, small) = if a_is_large { (a, b) } else { (b, a) };
        debug_assert!(
            self.is_asleep(a) == self.is_asleep(b),
            "{a:?} or {b:?} must be woken before the other links it"
        );
        if !self.is_asleep(small) {
            self.set_asleep(large, false);
        }
        // The buffers go back to the freed slot, empty, to be used again.
        let mut links = std::mem::take(&mut self.islands[small.0 as usize].links);
        links.drain(..).for_each(|link| self.push_link(large.0, link));
        let mut bodies = std::mem::take(&mut self.islands[small.0 as usize].bodies);
        bodies.drain(..).for_each(|body| self.push_body(large.0, body));
        let slot = &mut self.islands[small.0 as usize];
        (slot.links, slot.bodies) = (links, bodies);
        let removed = slot.removed;
        let sum = &mut self.islands[large.0 as usize].removed;
        *sum = sum.saturating_add(removed);
        self.destroy(small.0);
        large
    }

    fn get(&self, island: IslandId) -> Option<&Island> {
        self.islands.get(island.0 as usize).filter(|island| !island.bodies.is_empty())
    }

    /// An island without bodies; the caller adds the first one.
    fn create(&mut self, awake: bool) -> u32 {
        let id = self.free.pop().unwrap_or_else(|| {
            self.islands.push(Island { bodies: Vec::new(), links: Vec::new(), removed: 0, awake: NONE });
            self.islands.len() as u32 - 1
        });
        if awake {
            self.add_to_awake(id);
        }
        id
    }

    /// Gives back the slot of an island that has lost all bodies and links.
    fn destroy(&mut self, island: u32) {
        self.drop_from_awake(island);
        self.islands[island as usize].removed = 0;
        self.free.push(island);
    }

    fn add_to_awake(&mut self, island: u32) {
        self.islands[island as usize].awake = self.awake.len() as u32;
        self.awake.push(IslandId(island));
    }

    fn drop_from_awake(&mut self, island: u32) {
        let index = std::mem::replace(&mut self.islands[island as usize].awake, NONE);
        if index != NONE {
            self.awake.swap_remove(index as usize);
            if let Some(moved) = self.awake.get(index as usize) {
                self.islands[moved.0 as usize].awake = index;
            }
        }
    }

    fn push_body(&mut self, island: u32, body: u32) {
        let list = &mut self.islands[island as usize].bodies;
        set_place(&mut self.body_places, body, Place { island, index: list.len() as u32 });
        list.push(body);
    }

    fn push_link(&mut self, island: u32, link: Link) {
        let list = &mut self.islands[island as usize].links;
        set_place(&mut self.link_places, link.key.0, Place { island, index: list.len() as u32 });
        list.push(link);
    }

    /// Checks all invariants and panics with the broken one. O(bodies + links).
    pub fn validate(&self) {
        let mut sets = DisjointSets::default();
        let mut is_free = vec![false; self.islands.len()];
        for &id in &self.free {
            assert!(!is_free[id as usize], "slot {id} is free once");
            is_free[id as usize] = true;
        }
        let (mut bodies, mut links) = (0, 0);
        for (id, island) in self.islands.iter().enumerate() {
            let at = |index: usize| Place { island: id as u32, index: index as u32 };
            for (index, &body) in island.bodies.iter().enumerate() {
                assert_eq!(
                    place_in(&self.body_places, body),
                    at(index),
                    "body {body} lies where its record says"
                );
            }
            sets.reset(island.bodies.len());
            for (index, link) in island.links.iter().enumerate() {
                assert_eq!(
                    place_in(&self.link_places, link.key.0),
                    at(index),
                    "{link:?} lies where its record says"
                );
                let ends = [link.a, link.b].map(|body| place_in(&self.body_places, body));
                assert!(
                    ends.iter().all(|end| end.island == id as u32),
                    "both ends of {link:?} are in island {id}"
                );
                sets.unite(ends[0].index, ends[1].index);
            }
            assert!(island.removed > 0 || sets.count() <= 1, "island {id} is connected or has lost links");
            if island.awake != NONE {
                assert_eq!(
                    self.awake.get(island.awake as usize),
                    Some(&IslandId(id as u32)),
                    "it is in the awake list"
                );
            }
            let is_free = is_free[id];
            assert_eq!(
                is_free,
                island.bodies.is_empty(),
                "island {id} has bodies if and only if it is in use"
            );
            assert!(!is_free || (island.removed == 0 && island.awake == NONE), "the free slot {id} is reset");
            bodies += island.bodies.len();
            links += island.links.len();
        }
        let placed = |places: &[Place]| places.iter().filter(|place| **place != NOWHERE).count();
        assert_eq!(placed(&self.body_places), bodies, "every body is in one island");
        assert_eq!(placed(&self.link_places), links, "every link is in one island");
        let awake = self.islands.iter().filter(|island| island.awake != NONE).count();
        assert_eq!(self.awake.len(), awake, "the awake list holds the awake islands only");
    }
}

fn place_in(places: &[Place], id: u32) -> Place {
    places.get(id as usize).copied().unwrap_or(NOWHERE)
}

fn set_place(places: &mut Vec<Place>, id: u32, place: Place) {
    if places.len() <= id as usize {
        places.resize(id as usize + 1, NOWHERE);
    }
    places[id as usize] = place;
}

/// Removes the link at an index and notes where the one moved into its slot now lies.
fn remove_link(island: &mut Island, places: &mut [Place], index: u32) {
    island.links.swap_remove(index as usize);
    if let Some(moved) = island.links.get(index as usize) {
        places[moved.key.0 as usize].index = index;
    }
    // Without sleep nobody splits: the counter must not wrap around to "connected".
    island.removed = island.removed.saturating_add(1);
}

#[cfg(test)]
mod tests;
