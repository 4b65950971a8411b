//! Checks that the lists of islands agree with each other.

use super::{Island, IslandId, Islands, Member, NONE, NOWHERE, Place, place_in};
use crate::graph::union_find::DisjointSets;

impl Islands {
    /// Checks all invariants, and panics with the broken one. O(bodies + links).
    pub fn validate(&self) {
        let mut sets = DisjointSets::default();
        let (mut bodies, mut links) = (0, 0);
        for (id, island) in (0..).zip(&self.islands) {
            let is_free = !self.ids.is_live(id);
            self.validate_lists(id, island);
            self.validate_connection(id, island, &mut sets);
            if island.awake != NONE {
                let listed = self.awake.get(island.awake as usize);
                assert_eq!(listed, Some(&IslandId(id)), "it is in the awake list");
            }
            let has_none = island.bodies.is_empty();
            assert_eq!(is_free, has_none, "island {id} has bodies if and only if it is in use");
            assert!(!is_free || (island.removed == 0 && island.awake == NONE), "the free slot {id} is reset");
            assert!(!island.is_woken || island.awake != NONE, "only awake islands are to rest anew");
            assert!(!island.is_woken || self.any_woken, "a woken island is looked for");
            bodies += island.bodies.len();
            links += island.links.len();
        }
        let members = self.members.iter().filter(|member| **member != Member::NOBODY).count();
        assert_eq!(members, bodies, "every body is in one island");
        let placed = self.link_places.iter().filter(|place| **place != NOWHERE).count();
        assert_eq!(placed, links, "every link is in one island");
        let degrees: usize = self.members.iter().map(|member| member.links as usize).sum();
        let ends: usize =
            self.islands.iter().flat_map(|island| &island.links).map(|link| link.ends().count()).sum();
        assert_eq!(degrees, ends, "bodies count their links");
        let awake = self.islands.iter().filter(|island| island.awake != NONE).count();
        assert_eq!(self.awake.len(), awake, "the awake list holds the awake islands only");
    }

    /// Checks that bodies and links are at the place in their records, and that links to carriers are
    /// counted.
    fn validate_lists(&self, id: u32, island: &Island) {
        let at = |index: usize| Place { island: id, index: index as u32 };
        for (index, &body) in island.bodies.iter().enumerate() {
            assert_eq!(self.place(body), Some(at(index)), "body {body} lies where its record says");
        }
        for (index, link) in island.links.iter().enumerate() {
            let place = place_in(&self.link_places, link.key.0);
            assert_eq!(place, at(index), "{link:?} lies where its record says");
        }
        let carriers = island.links.iter().filter(|link| link.is_to_carrier()).count();
        assert_eq!(island.carriers as usize, carriers, "island {id} counts its carriers");
    }

    /// Checks that links are between bodies of the island, and that an island without removed links is
    /// connected.
    fn validate_connection(&self, id: u32, island: &Island, sets: &mut DisjointSets) {
        sets.reset(island.bodies.len());
        for link in &island.links {
            let place = |body: u32| self.place(body).unwrap_or(NOWHERE);
            assert!(link.ends().all(|body| place(body).island == id), "{link:?} is of island {id}");
            link.ends().for_each(|body| sets.unite(place(link.a).index, place(body).index));
        }
        assert!(island.removed > 0 || sets.count() <= 1, "island {id} is connected or has lost links");
    }
}
