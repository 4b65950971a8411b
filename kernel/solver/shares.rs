//! Who of a team solves which contacts.

use super::input::RowInput;
use crate::graph::ColorGraph;
use crate::table::NONE;

/// From so many contacts a member on a stage is shared: below, they are solved before another core has begun.
const WORTH_SHARING: usize = 256;

/// Of a shared stage a member solves the contacts of bodies whose rows lie in its part of all.
///
/// A body then mostly stays with one member, and in the cache of its core, through all sweeps of a step; else every
/// second time another core would have written it last, and to fetch it from there takes longer than to solve the
/// contact.
#[derive(Clone, Debug)]
pub(super) struct Shares {
    members: usize,
    /// From how many contacts a member on a stage is shared.
    pub(super) worth: usize,
    /// The member of each body row; [`NOBODY`] for rows that no contact changes. Empty in a team of one.
    of_row: Vec<u16>,
}

/// No member.
const NOBODY: u16 = u16::MAX;

impl Default for Shares {
    fn default() -> Self {
        Self { members: 1, worth: WORTH_SHARING, of_row: Vec::new() }
    }
}

impl Shares {
    /// Divides the rows of dynamic bodies, of which there are `rows` with all others, so that about as many contacts
    /// fall to each member.
    pub(super) fn divide(&mut self, members: usize, rows: usize, input: &RowInput, colors: &ColorGraph) {
        debug_assert!(members > 0, "a team has its caller");
        self.members = members.min(usize::from(NOBODY));
        self.of_row.clear();
        if self.members == 1 {
            return;
        }
        self.of_row.resize(rows, NOBODY);
        // Each body has moving to do as well.
        let work = |id: u32| u64::from(1 + colors.colors_of(id).count_ones());
        let all = input.bodies.awake_dynamic().map(work).sum::<u64>().max(1);
        let mut before = 0;
        for id in input.bodies.awake_dynamic() {
            self.of_row[input.row_of(id) as usize] = (before * self.members as u64 / all) as u16;
            before += work(id);
        }
        // Nobody's, whoever may have woken since rows were given.
        self.of_row[0] = NOBODY;
    }

    /// Into how many parts a stage of so many contacts is cut.
    pub(super) fn parts(&self, contacts: usize) -> usize {
        (contacts / self.worth.max(1)).clamp(1, self.members)
    }

    /// Which of so many parts a contact belongs to. Between bodies of two members it is either's, by chance.
    #[inline(always)]
    pub(super) fn part(&self, input: &RowInput, contact: u32, parts: usize) -> usize {
        if parts == 1 {
            return 0;
        }
        let of = |body: u32| if body == NONE { NOBODY } else { self.of_row[input.row_of(body) as usize] };
        debug_assert!(parts <= self.members, "{parts} parts for {} members", self.members);
        let member = match input.contacts.bodies_of(contact).map(of) {
            [NOBODY, NOBODY] => 0,
            [member, NOBODY] | [NOBODY, member] => member,
            members => members[contact as usize % 2],
        };
        usize::from(member) * parts / self.members
    }

    /// The part that a member begins with, if there is one: neighbours have one together where there are fewer parts.
    pub(super) fn of_member(&self, member: usize, parts: usize) -> Option<usize> {
        debug_assert!(member < self.members, "member {member} of {}", self.members);
        let part = member * parts / self.members;
        (member == 0 || part > (member - 1) * parts / self.members).then_some(part)
    }

    /// How many members there are.
    pub(super) fn members(&self) -> usize {
        self.members
    }
}
