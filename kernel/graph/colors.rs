//! Graph colouring of constraints. No two constraints of a colour share a dynamic body, so a colour is solved
//! in lanes and by several threads.

use super::kind::ConstraintKind;
use core::num::NonZeroU8;

/// The number of colours, including the overflow.
pub const COLOR_COUNT: usize = 24;
/// The last colour: constraints for which no colour was free. They may share bodies. They are solved one by
/// one, before all other colours.
pub const OVERFLOW: u8 = COLOR_COUNT as u8 - 1;

/// Colours of constraints between two dynamic bodies, as a bit mask: 0..=19. Higher colours are reserved for
/// static partners, so these constraints are solved last in every sweep and win.
const DYNAMIC_COLORS: u32 = (1 << 20) - 1;
/// Colours of constraints with one dynamic body: 1..=22, taken from the top.
const STATIC_COLORS: u32 = ((1 << OVERFLOW) - 1) & !1;

/// The place of a constraint in the list of its kind and colour. When a constraint is released, another one
/// moves into its slot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ColorSlot {
    /// The colour plus one, so an optional slot is no larger.
    above_color: NonZeroU8,
    /// The index in the list of that colour.
    index: u32,
}

impl ColorSlot {
    /// The slot of an index in the list of a colour below [`COLOR_COUNT`].
    fn new(color: u8, index: usize) -> Self {
        Self { above_color: NonZeroU8::MIN.saturating_add(color), index: index as u32 }
    }

    /// The colour, below [`COLOR_COUNT`].
    pub fn color(self) -> u8 {
        self.above_color.get() - 1
    }
}

/// The constraints of one colour, by kind. All kinds share the masks of bodies, so a joint and a contact of
/// one pair never share a colour.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
struct Color {
    lists: [Vec<u32>; ConstraintKind::COUNT],
}

impl Color {
    fn len(&self) -> usize {
        self.lists.iter().map(Vec::len).sum()
    }
}

/// An incremental greedy edge colouring.
///
/// A contact is assigned a colour when it begins to touch, and releases it when it stops touching.
/// Constraints are never recoloured. Colours are chosen by first fit, from below for two dynamic bodies, from
/// above for one, as in the constraint graph of Box2D v3 (Catto, "SIMD Matters", 2024).
///
/// Decision: the colours of a body are one 32-bit mask per body, not one bit set over bodies per colour. The
/// table is the same, transposed. First fit is then one `or` and one count of zeroes instead of up to 20
/// probes of 20 arrays, and only one array grows.
///
/// The order within a colour follows from the sequence of calls (append, swap-remove): the same calls give
/// the same order.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ColorGraph {
    colors: [Color; COLOR_COUNT],
    /// Bit `c` of `used[body]`: the body has a constraint of colour `c`. Never the overflow bit.
    used: Vec<u32>,
}

impl ColorGraph {
    /// Bytes of memory per body with contacts, and per contact.
    pub const BYTES: [usize; 2] = [size_of::<u32>(); 2];

    /// A graph without contacts.
    pub fn new() -> Self {
        Self::default()
    }

    /// Assigns a colour to a constraint. `bodies` are the ids of its dynamic bodies, with `None` for a static
    /// or kinematic body.
    ///
    /// The two dynamic bodies should differ: a constraint of a body with itself goes to the overflow. A
    /// constraint without a dynamic body conflicts with none and takes the highest colour.
    pub(crate) fn assign(&mut self, kind: ConstraintKind, id: u32, bodies: [Option<u32>; 2]) -> ColorSlot {
        let color = self.take_color(bodies);
        let list = &mut self.colors[usize::from(color)].lists[kind as usize];
        list.push(id);
        ColorSlot::new(color, list.len() - 1)
    }

    /// Gives back the storage of constraints that were released.
    pub(crate) fn shrink(&mut self) {
        self.colors.iter_mut().flat_map(|color| &mut color.lists).for_each(Vec::shrink_to_fit);
    }

    /// Releases the colour of a constraint. `bodies` must be the bodies that it was assigned with.
    ///
    /// Returns the constraint of the same kind that moved into the slot, if any: the caller must store `slot`
    /// as its new slot.
    pub(crate) fn release(
        &mut self,
        kind: ConstraintKind,
        slot: ColorSlot,
        bodies: [Option<u32>; 2],
    ) -> Option<u32> {
        let list =
            self.colors.get_mut(usize::from(slot.color())).map(|color| &mut color.lists[kind as usize]);
        let Some(list) = list.filter(|list| (slot.index as usize) < list.len()) else {
            debug_assert!(false, "no constraint lies in the slot to release: {slot:?}");
            return None;
        };
        list.swap_remove(slot.index as usize);
        let moved = list.get(slot.index as usize).copied();
        self.give_back_color(slot.color(), bodies);
        moved
    }

    /// The contacts of a colour. Empty if the colour does not exist.
    pub fn contacts(&self, color: u8) -> &[u32] {
        self.constraints(ConstraintKind::Contact, color)
    }

    /// The constraints of a kind and colour. Empty if the colour does not exist.
    pub fn constraints(&self, kind: ConstraintKind, color: u8) -> &[u32] {
        self.colors.get(usize::from(color)).map_or(&[], |color| &color.lists[kind as usize])
    }

    /// The contacts of the overflow, which are solved first, one by one.
    pub fn overflow(&self) -> &[u32] {
        self.contacts(OVERFLOW)
    }

    /// The colours with contacts, without the overflow, in the order of solving: ascending, contacts with
    /// static partners last.
    pub fn colors(&self) -> impl Iterator<Item = (u8, &[u32])> {
        (0..OVERFLOW).map(|color| (color, self.contacts(color))).filter(|(_, contacts)| !contacts.is_empty())
    }

    /// The same graph without its contacts.
    pub fn without_contacts(&self) -> Self {
        let mut rest = self.clone();
        rest.colors.iter_mut().for_each(|color| color.lists[ConstraintKind::Contact as usize].clear());
        rest
    }

    /// The number of constraints in all colours.
    pub fn len(&self) -> usize {
        self.colors.iter().map(Color::len).sum()
    }

    /// Whether there are no constraints.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The colours of a body's constraints, as a bit mask without the overflow.
    pub fn colors_of(&self, body: u32) -> u32 {
        self.used.get(body as usize).copied().unwrap_or(0)
    }

    /// The bodies with a constraint of any colour except the overflow, in ascending order.
    pub(crate) fn bodies(&self) -> impl Iterator<Item = u32> {
        self.used.iter().enumerate().filter(|(_, used)| **used != 0).map(|(body, _)| body as u32)
    }

    /// Chooses a colour for a constraint between these bodies, and marks it used.
    fn take_color(&mut self, bodies: [Option<u32>; 2]) -> u8 {
        let color = match bodies {
            [Some(a), Some(b)] if a == b => {
                debug_assert!(false, "body {a} touches itself");
                return OVERFLOW;
            }
            [Some(a), Some(b)] => lowest(!(self.colors_of(a) | self.colors_of(b)) & DYNAMIC_COLORS),
            [Some(body), None] | [None, Some(body)] => highest(!self.colors_of(body) & STATIC_COLORS),
            [None, None] => highest(STATIC_COLORS),
        };
        let Some(color) = color else { return OVERFLOW };
        for body in bodies.into_iter().flatten() {
            if self.used.len() <= body as usize {
                self.used.resize(body as usize + 1, 0);
            }
            self.used[body as usize] |= 1 << color;
        }
        color
    }

    /// Marks a colour of these bodies free again.
    fn give_back_color(&mut self, color: u8, bodies: [Option<u32>; 2]) {
        if color == OVERFLOW {
            return;
        }
        for body in bodies.into_iter().flatten() {
            debug_assert!(
                self.colors_of(body) & (1 << color) != 0,
                "body {body} has no constraint of colour {color}"
            );
            if let Some(used) = self.used.get_mut(body as usize) {
                *used &= !(1 << color);
            }
        }
    }

    /// Checks the graph against the caller's records: slot and bodies of each constraint. Panics with the
    /// broken invariant. O(constraints + bodies).
    pub fn validate(&self, record: impl Fn(ConstraintKind, u32) -> (ColorSlot, [Option<u32>; 2])) {
        let mut used = vec![0u32; self.used.len()];
        let of_kind = |kind| (0..COLOR_COUNT as u8).map(move |color| (kind, color));
        for (kind, color) in ConstraintKind::ALL.into_iter().flat_map(of_kind) {
            for (index, &id) in self.constraints(kind, color).iter().enumerate() {
                let (slot, bodies) = record(kind, id);
                let here = ColorSlot::new(color, index);
                assert_eq!(slot, here, "{kind:?} {id} lies where its record says");
                if here.color() == OVERFLOW {
                    continue;
                }
                let allowed = if bodies.contains(&None) { STATIC_COLORS } else { DYNAMIC_COLORS };
                assert!(allowed & (1 << color) != 0, "colour {color} is allowed for the bodies {bodies:?}");
                for body in bodies.into_iter().flatten() {
                    let mask = used.get_mut(body as usize).expect("every coloured body has a mask");
                    assert!(*mask & (1 << color) == 0, "body {body} is once in colour {color}");
                    *mask |= 1 << color;
                }
            }
        }
        assert_eq!(used, self.used, "the masks are those of the constraints");
    }
}

/// The lowest bit that is set.
fn lowest(mask: u32) -> Option<u8> {
    (mask != 0).then(|| mask.trailing_zeros() as u8)
}

/// The highest bit that is set.
fn highest(mask: u32) -> Option<u8> {
    (mask != 0).then(|| 31 - mask.leading_zeros() as u8)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::collections::{BTreeMap, BTreeSet};

    type Bodies = [Option<u32>; 2];

    /// The graph with the caller's records.
    #[derive(Clone, Default, PartialEq, Debug)]
    struct World {
        graph: ColorGraph,
        records: BTreeMap<u32, (ColorSlot, Bodies)>,
    }

    impl World {
        fn assign(&mut self, contact: u32, bodies: Bodies) -> u8 {
            let slot = self.graph.assign(ConstraintKind::Contact, contact, bodies);
            assert_eq!(self.graph.contacts(slot.color())[slot.index as usize], contact);
            self.records.insert(contact, (slot, bodies));
            slot.color()
        }

        fn release(&mut self, contact: u32) {
            let (slot, bodies) = self.records.remove(&contact).unwrap();
            if let Some(moved) = self.graph.release(ConstraintKind::Contact, slot, bodies) {
                self.records.get_mut(&moved).unwrap().0 = slot;
            }
        }

        /// The colour by the rules, found by a search through all contacts.
        fn expected(&self, bodies: Bodies) -> u8 {
            let dynamic: BTreeSet<u32> = bodies.into_iter().flatten().collect();
            let free = |color: &u8| {
                self.records.values().all(|(slot, others)| {
                    slot.color() != *color || others.iter().flatten().all(|other| !dynamic.contains(other))
                })
            };
            if dynamic.len() == 2 { (0..20).find(free) } else { (1..=22).rev().find(free) }
                .unwrap_or(OVERFLOW)
        }

        fn check(&self) {
            self.graph.validate(|_, contact| self.records[&contact]);
            assert_eq!(self.graph.len(), self.records.len());
            let mut seen: BTreeMap<u8, BTreeSet<u32>> = BTreeMap::new();
            for (slot, bodies) in self.records.values() {
                for body in bodies.iter().flatten() {
                    let fresh = seen.entry(slot.color()).or_default().insert(*body);
                    assert!(
                        fresh || slot.color() == OVERFLOW,
                        "body {body} twice in colour {}",
                        slot.color()
                    );
                }
            }
        }
    }

    #[test]
    fn static_contacts_take_the_highest_colors_first() {
        let mut world = World::default();
        let colors: Vec<u8> = (0..24).map(|k| world.assign(k, [None, Some(5)])).collect();
        let expected: Vec<u8> = (1..=22).rev().chain([OVERFLOW, OVERFLOW]).collect();
        assert_eq!(colors, expected);
        assert_eq!(world.graph.overflow(), [22, 23]);
        assert_eq!(world.graph.colors_of(5), STATIC_COLORS);
    }

    #[test]
    fn a_hub_of_dynamic_contacts_takes_the_lowest_colors_first() {
        let mut world = World::default();
        let colors: Vec<u8> = (0..22).map(|k| world.assign(k, [Some(0), Some(k + 1)])).collect();
        let expected: Vec<u8> = (0..20).chain([OVERFLOW, OVERFLOW]).collect();
        assert_eq!(colors, expected);
        assert_eq!(world.graph.colors_of(22), 0, "overflow takes no bits");
        assert_eq!(world.assign(50, [Some(0), None]), 22, "the static colours are still free");
    }

    /// A tower on the ground needs two colours between its bodies and one for the ground, at any height.
    #[test]
    fn a_tower_needs_three_colors() {
        let mut world = World::default();
        assert_eq!(world.assign(0, [None, Some(0)]), 22);
        for body in 1..100u32 {
            assert_eq!(u32::from(world.assign(body, [Some(body - 1), Some(body)])), (body - 1) % 2);
        }
        assert_eq!(
            world.graph.colors().map(|(color, list)| (color, list.len())).collect::<Vec<_>>(),
            [(0, 50), (1, 49), (22, 1)]
        );
        world.check();
        (0..100).for_each(|contact| world.release(contact));
        assert!(world.graph.is_empty() && world.graph.colors_of(3) == 0);
    }

    #[test]
    fn contacts_without_a_dynamic_body_are_harmless() {
        let mut world = World::default();
        for contact in 0..40 {
            assert_eq!(world.assign(contact, [None, None]), 22);
        }
        (0..40).step_by(3).for_each(|contact| world.release(contact));
        world.check();
    }

    /// Operations: a code, and two numbers that select bodies or a contact.
    fn operations() -> impl Strategy<Value = Vec<(u8, u32, u32)>> {
        prop::collection::vec((0u8..100, any::<u32>(), any::<u32>()), 20_000..20_100)
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 10, max_shrink_iters: 2_000, ..ProptestConfig::default() })]

        #[test]
        fn colors_follow_the_rules_through_long_histories(
            operations in operations(),
            bodies in 2u32..80,
            limit in 1usize..500,
        ) {
            let mut world = World::default();
            let mut free: Vec<u32> = (0..limit as u32).rev().collect();
            for (step, (kind, x, y)) in operations.into_iter().enumerate() {
                let grow = if world.records.len() < limit / 2 { 70 } else { 45 };
                if kind < grow && let Some(contact) = free.pop() {
                    let a = x % bodies;
                    let pair = match y % 4 {
                        0 => [None, Some(a)],
                        1 => [Some(a), None],
                        _ => [Some(a), Some((a + 1 + (y >> 2) % (bodies - 1)) % bodies)],
                    };
                    let expected = world.expected(pair);
                    prop_assert_eq!(world.assign(contact, pair), expected);
                    // Releasing restores everything: the same contact gets the same slot again.
                    let before = world.clone();
                    world.release(contact);
                    prop_assert!(!world.graph.contacts(expected).contains(&contact));
                    world.assign(contact, pair);
                    prop_assert_eq!(&world, &before);
                } else if let Some((&contact, _)) = world.records.iter().nth(x as usize % world.records.len().max(1)) {
                    world.release(contact);
                    free.push(contact);
                }
                if step % 100 == 0 {
                    world.check();
                }
            }
            world.check();
            while let Some((&contact, _)) = world.records.iter().next() {
                world.release(contact);
            }
            prop_assert!(world.graph.is_empty());
            prop_assert!((0..bodies).all(|body| world.graph.colors_of(body) == 0));
        }

        /// A constraint has at most 2 (Δ − 1) neighbours, so first fit needs at most 2 Δ − 1 colours for
        /// degree Δ: bodies with at most ten dynamic contacts never overflow, in any order of operations.
        #[test]
        fn ten_contacts_per_body_never_overflow(operations in operations()) {
            const BODIES: u32 = 30;
            let mut world = World::default();
            let mut degree = [0u32; BODIES as usize];
            for (contact, (kind, x, y)) in operations.into_iter().enumerate() {
                let (a, b) = (x % BODIES, y % BODIES);
                if a != b && degree[a as usize].max(degree[b as usize]) < 10 && kind < 60 {
                    prop_assert!(world.assign(contact as u32, [Some(a), Some(b)]) < 19);
                    degree[a as usize] += 1;
                    degree[b as usize] += 1;
                } else if let Some((&contact, &(_, pair))) = world.records.iter().nth((x % 60) as usize) {
                    world.release(contact);
                    pair.into_iter().flatten().for_each(|body| degree[body as usize] -= 1);
                }
            }
            world.check();
        }
    }
}
