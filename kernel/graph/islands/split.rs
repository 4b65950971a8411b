//! Splitting an island into its connected parts.

use super::{Island, IslandId, Islands, NONE, Piece, Scratch, count_visits};

impl Islands {
    /// Splits an island into its connected parts. Each has `removed` = 0 afterwards.
    ///
    /// The part with the most bodies (at a tie the part with the lowest body id) keeps the id, since moving
    /// it costs most. Returns the other islands, created in the order of their lowest body id, asleep if the
    /// original is. Empty if the island is connected.
    pub fn split(&mut self, island: IslandId) -> &[IslandId] {
        self.scratch.created.clear();
        if self.removed(island) > 0 {
            self.islands[island.0 as usize].removed = 0;
            if self.find_pieces(island.0) {
                self.name_pieces(island.0);
                self.move_pieces(island.0);
            }
            self.scratch.sets.reset(0);
            self.scratch.piece_of.clear();
            self.scratch.pieces.clear();
            self.scratch.order.clear();
        }
        &self.scratch.created
    }

    /// Fills `piece_of` and `pieces`. Returns `false` if the island is connected.
    fn find_pieces(&mut self, island: u32) -> bool {
        let Self { islands, members, scratch, .. } = self;
        let island = &islands[island as usize];
        count_visits(island.bodies.len() + island.links.len());
        let sets = &mut scratch.sets;
        sets.reset(island.bodies.len());
        for link in &island.links {
            if link.is_to_carrier() {
                continue;
            }
            let [a, b] = [link.a, link.b].map(|body| members[body as usize].place.index);
            sets.unite(a, b);
            if sets.count() == 1 {
                return false;
            }
        }
        scratch.piece_of.resize(island.bodies.len(), NONE);
        for (index, &body) in island.bodies.iter().enumerate() {
            let root = sets.find(index as u32) as usize;
            // The entry of a root may already be set by an earlier body of its set, and keeps its value.
            if scratch.piece_of[root] == NONE {
                scratch.piece_of[root] = scratch.pieces.len() as u32;
                scratch.pieces.push(Piece { lowest_body: body, size: 0, island: NONE });
            }
            scratch.piece_of[index] = scratch.piece_of[root];
            let piece = &mut scratch.pieces[scratch.piece_of[root] as usize];
            piece.lowest_body = piece.lowest_body.min(body);
            piece.size += 1;
        }
        scratch.pieces.len() > 1
    }

    /// Assigns an island to each piece.
    fn name_pieces(&mut self, island: u32) {
        let Island { awake, is_woken, .. } = self.islands[island as usize];
        let Scratch { pieces, order, .. } = &mut self.scratch;
        order.extend(0..pieces.len() as u32);
        order.sort_unstable_by_key(|piece| pieces[*piece as usize].lowest_body);
        let size = |rank: &usize| (pieces[order[*rank] as usize].size, std::cmp::Reverse(*rank));
        let keeper = (0..order.len()).max_by_key(size).unwrap_or(0);
        for rank in 0..self.scratch.order.len() {
            let target = if rank == keeper { island } else { self.create(awake != NONE) };
            let piece = self.scratch.order[rank];
            self.scratch.pieces[piece as usize].island = target;
            if rank != keeper {
                self.islands[target as usize].is_woken = is_woken;
                self.scratch.created.push(IslandId(target));
            }
        }
    }

    /// Moves links and bodies to the islands of their pieces, in the same order.
    fn move_pieces(&mut self, island: u32) {
        let mut links = std::mem::take(&mut self.islands[island as usize].links);
        let mut kept = 0;
        links.retain(|link| {
            let target = self.target_of(self.members[link.a as usize].place.index);
            if target == island {
                self.link_places[link.key.0 as usize].index = kept;
                kept += 1;
            } else {
                self.push_link(target, *link);
                self.islands[island as usize].carriers -= u32::from(link.is_to_carrier());
            }
            target == island
        });
        self.islands[island as usize].links = links;

        let mut bodies = std::mem::take(&mut self.islands[island as usize].bodies);
        let (mut old, mut kept) = (0, 0);
        bodies.retain(|body| {
            let target = self.target_of(old);
            old += 1;
            if target == island {
                self.members[*body as usize].place.index = kept;
                kept += 1;
            } else {
                self.push_body(target, *body);
            }
            target == island
        });
        self.islands[island as usize].bodies = bodies;
    }

    /// The target island of the body at an index.
    fn target_of(&self, index: u32) -> u32 {
        self.scratch.pieces[self.scratch.piece_of[index as usize] as usize].island
    }
}
