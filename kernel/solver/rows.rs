//! All contact rows of a step, and how they are laid out.

use super::batch::{Plan, RowSet, Set};
use super::block::{SetsView, Wide, WideView};
use super::input::RowInput;
use super::prepare::{Buckets, is_held};
use crate::graph::{ColorGraph, OVERFLOW};
#[cfg(target_arch = "x86_64")]
use crate::math::F32x8;
use crate::math::{AxisLocks, F32x4, Lane, Vector, Width};

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
    pub(super) input: &'a RowInput<'a>,
    /// Which axes are held, by body row; empty where nobody is held along any.
    pub(super) locks: &'a [AxisLocks],
    pub(super) any_deep: bool,
    pub(super) buffers: &'a mut Buffers,
    pub(super) plan: &'a mut Plan,
}

/// Kept between steps.
#[derive(Clone, Debug, Default)]
pub(super) struct Buffers {
    pub(super) buckets: Buckets,
    held: Vec<u32>,
    free: Vec<u32>,
}

impl AllRows {
    /// Decides which contact has which row, and what is solved when.
    pub(super) fn lay_out(&mut self, colors: &ColorGraph, layout: &mut Layout) {
        self.overflow.clear();
        for id in colors.overflow() {
            self.overflow.lay([Set::OverflowHeld, Set::Overflow], core::slice::from_ref(id), layout);
        }
        self.overflow.make_room(layout.any_deep);
        match self.width {
            #[cfg(target_arch = "x86_64")]
            Width::Eight(_) => self.eight.lay_colors(colors, layout),
            _ => self.four.lay_colors(colors, layout),
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

    /// Lays out the rows of all colours but overflow.
    fn lay_colors(&mut self, colors: &ColorGraph, layout: &mut Layout) {
        self.clear();
        for color in 0..OVERFLOW {
            self.lay([Set::WideHeld, Set::Wide], colors.contacts(color), layout);
        }
        self.make_room(layout.any_deep);
    }

    /// Lays out the rows of contacts whose dynamic bodies are all different.
    fn lay(&mut self, [held_set, free_set]: [Set; 2], contacts: &[u32], layout: &mut Layout) {
        let Layout { input, locks, buffers, plan, .. } = layout;
        let Buffers { buckets, held, free } = &mut **buffers;
        if locks.is_empty() {
            self.free.lay(free_set, contacts, input, buckets, plan);
            return;
        }
        held.clear();
        free.clear();
        for id in contacts {
            if is_held(input, locks, *id) { held.push(*id) } else { free.push(*id) }
        }
        self.held.lay(held_set, held, input, buckets, plan);
        self.free.lay(free_set, free, input, buckets, plan);
    }

    fn view(&mut self) -> WideView<'_, N> {
        WideView { free: self.free.view(), held: self.held.view() }
    }
}
