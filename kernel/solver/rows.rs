//! All contact rows of a step, and how they are laid out.

use super::batch::{Plan, RowSet, Set};
use super::block::{SetsView, Wide, WideView};
use super::prepare::{Sorted, Sorter};
use super::shares::Shares;
use crate::graph::{COLOR_COUNT, ColorGraph, OVERFLOW};
#[cfg(target_arch = "x86_64")]
use crate::math::F32x8;
use crate::math::{F32x4, Lane, Vector, Width};
use crate::team::Team;

/// The rows of every width; of the wide ones only one is in use.
#[derive(Clone, Debug, Default)]
pub(super) struct AllRows {
    pub(super) width: Width,
    overflow: WideRows<f32>,
    four: WideRows<F32x4>,
    #[cfg(target_arch = "x86_64")]
    eight: WideRows<F32x8>,
}

/// The rows of one width.
#[derive(Clone, Debug)]
struct WideRows<N: Lane> {
    free: RowSet<N, N>,
    /// Contacts of bodies held along some axes.
    held: RowSet<N, Vector<N>>,
}

impl<N: Lane> Default for WideRows<N> {
    fn default() -> Self {
        Self { free: RowSet::default(), held: RowSet::default() }
    }
}

/// What rows are laid out from, and buffers kept between steps.
pub(super) struct Layout<'a> {
    pub(super) sorter: &'a Sorter<'a>,
    pub(super) any_deep: bool,
    pub(super) buffers: &'a mut Buffers,
    pub(super) plan: &'a mut Plan,
    pub(super) team: &'a Team,
}

/// The sorted manifolds of each colour; kept between steps.
#[derive(Clone, Debug, Default)]
pub(super) struct Buffers(Vec<Sorted>);

impl AllRows {
    /// Decides which contact has which row, and what is solved when.
    pub(super) fn lay_out(&mut self, colors: &ColorGraph, layout: &mut Layout) {
        let Layout { sorter, any_deep, buffers: Buffers(sorted), plan, team } = layout;
        sorted.resize_with(COLOR_COUNT, Sorted::default);
        let (sorted, of_overflow) = sorted.split_at_mut(usize::from(OVERFLOW));
        self.overflow.clear();
        for id in colors.overflow() {
            let (contact, sorted) = (core::slice::from_ref(id), &mut of_overflow[0]);
            sorted.sort(contact, 0, sorter);
            self.overflow.lay_layers([Set::OverflowHeld, Set::Overflow], contact, sorted, sorter, plan);
        }
        self.overflow.make_room(*any_deep);
        // The first layer of all colours at once: most contacts have no other.
        team.each(sorted.iter_mut().zip(0..), |(sorted, color)| {
            sorted.sort(colors.contacts(color), 0, sorter);
        });
        match self.width {
            #[cfg(target_arch = "x86_64")]
            Width::Eight(_) => {
                self.eight.lay_colors(colors, sorted, sorter, plan);
                self.eight.make_room(*any_deep);
            }
            _ => {
                self.four.lay_colors(colors, sorted, sorter, plan);
                self.four.make_room(*any_deep);
            }
        }
    }

    pub(super) fn view(&mut self) -> SetsView<'_> {
        let wide = match self.width {
            #[cfg(target_arch = "x86_64")]
            Width::Eight(avx2) => Wide::Eight(self.eight.view(), avx2),
            _ => Wide::Four(self.four.view()),
        };
        SetsView { overflow: self.overflow.view(), wide }
    }
}

impl<N: Lane> WideRows<N> {
    fn clear(&mut self) {
        self.free.clear();
        self.held.clear();
    }

    fn make_room(&mut self, any_deep: bool) {
        self.free.make_room(any_deep);
        self.held.make_room(any_deep);
    }

    /// Lays out the rows of all colours but overflow, whose first layer is sorted.
    fn lay_colors(&mut self, colors: &ColorGraph, sorted: &mut [Sorted], sorter: &Sorter, plan: &mut Plan) {
        self.clear();
        for (sorted, color) in sorted.iter_mut().zip(0..) {
            self.lay_layers([Set::WideHeld, Set::Wide], colors.contacts(color), sorted, sorter, plan);
        }
    }

    /// Lays out the rows of contacts whose dynamic bodies are all different, and whose first layer is sorted.
    ///
    /// A contact with several manifolds has them solved one after the other: each layer has stages of its own, so that a
    /// stage still holds no body twice.
    fn lay_layers(
        &mut self,
        sets: [Set; 2],
        contacts: &[u32],
        sorted: &mut Sorted,
        sorter: &Sorter,
        plan: &mut Plan,
    ) {
        self.lay(sets, sorted, sorter.shares, plan);
        let mut layer = 1;
        while sorted.has_more() {
            sorted.sort(contacts, layer, sorter);
            self.lay(sets, sorted, sorter.shares, plan);
            layer += 1;
        }
    }

    fn lay(&mut self, [held, free]: [Set; 2], sorted: &Sorted, shares: &Shares, plan: &mut Plan) {
        self.held.lay(held, &sorted.held, sorted.parts, shares, plan);
        self.free.lay(free, &sorted.free, sorted.parts, shares, plan);
    }

    fn view(&mut self) -> WideView<'_, N> {
        WideView { free: self.free.view(), held: self.held.view() }
    }
}
