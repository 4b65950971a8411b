//! What is done with the rows of one block: filled, swept, stored; for the width of its set.
#![expect(unsafe_code, reason = "blocks are run at once; entry points for a CPU feature that was looked for")]

use super::batch::{Block, BlockRows, RowSetView, Set, with_block};
use super::prepare::{AHEAD, Filler};
use super::{BodyRow, InvMass, RowView, SubstepParams};
use crate::contact::ManifoldsView;
#[cfg(target_arch = "x86_64")]
use crate::math::F32x8;
use crate::math::{F32x4, Ids, Lane, TangentFrame, Vector};
use crate::table::NONE;

/// What a sweep does with each row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Pass {
    Impact,
    WarmStart,
    Solve,
    TakeBack,
    Relax,
    Restitute,
}

/// All rows of a step, of one width or the other, changed block by block.
pub(super) struct SetsView<'a> {
    pub(super) overflow: WideView<'a, f32>,
    pub(super) wide: Wide<'a>,
}

/// The wide rows.
pub(super) enum Wide<'a> {
    Four(WideView<'a, F32x4>),
    /// Only where the CPU has AVX2.
    #[cfg(target_arch = "x86_64")]
    Eight(WideView<'a, F32x8>),
}

/// The rows of one width.
pub(super) struct WideView<'a, N: Lane> {
    pub(super) free: RowSetView<'a, N, N>,
    pub(super) held: RowSetView<'a, N, Vector<N>>,
}

/// Calls a function with the block's set.
macro_rules! of_set {
    ($view:expr, $block:expr, $f:ident($($argument:expr),*)) => {
        match ($block.set, &$view.wide) {
            (Set::Overflow, _) => $f(&$view.overflow.free, $block, $($argument),*),
            (Set::OverflowHeld, _) => $f(&$view.overflow.held, $block, $($argument),*),
            (Set::Wide, Wide::Four(wide)) => four_lanes::$f(&wide.free, $block, $($argument),*),
            (Set::WideHeld, Wide::Four(wide)) => four_lanes::$f(&wide.held, $block, $($argument),*),
            #[cfg(target_arch = "x86_64")]
            (Set::Wide, Wide::Eight(wide)) => eight_lanes::$f(&wide.free, $block, $($argument),*),
            #[cfg(target_arch = "x86_64")]
            (Set::WideHeld, Wide::Eight(wide)) => eight_lanes::$f(&wide.held, $block, $($argument),*),
        }
    };
}

impl SetsView<'_> {
    /// Fills a block's rows, and notes in it what they are like.
    pub(super) fn fill(&self, block: &mut Block, filler: &Filler) {
        (block.bouncy, block.deep) = of_set!(self, block, fill(filler));
    }

    /// Runs a pass over a block. Returns whether it found an impact.
    pub(super) fn run(
        &self,
        block: &Block,
        pass: Pass,
        bodies: &RowView<BodyRow>,
        params: &SubstepParams,
    ) -> bool {
        of_set!(self, block, run(pass, bodies, params))
    }

    /// Puts a block's impulses back into the manifolds.
    pub(super) fn store(&self, block: &Block, contacts: &ManifoldsView) {
        of_set!(self, block, store(contacts));
    }
}

/// The entry points of four lanes. Functions of their own, like those of eight, so that it can be seen what the
/// compiler made of them (`tools/asm.sh`): contacts taken one by one are next to them otherwise.
mod four_lanes {
    use super::*;

    macro_rules! entry {
        ($name:ident($($argument:ident: $type:ty),*) -> $result:ty) => {
            #[inline(never)]
            pub(super) fn $name<M: InvMass<F32x4>>(
                set: &RowSetView<F32x4, M>,
                block: &Block,
                $($argument: $type),*
            ) -> $result {
                super::$name(set, block, $($argument),*)
            }
        };
    }

    entry!(fill(filler: &Filler) -> (bool, bool));
    entry!(run(pass: Pass, bodies: &RowView<BodyRow>, params: &SubstepParams) -> bool);
    entry!(store(contacts: &ManifoldsView) -> ());
}

/// The entry points of eight lanes: everything below them is inlined and compiled for AVX2.
#[cfg(target_arch = "x86_64")]
mod eight_lanes {
    use super::*;

    macro_rules! entry {
        ($name:ident($($argument:ident: $type:ty),*) -> $result:ty) => {
            pub(super) fn $name<M: InvMass<F32x8>>(
                set: &RowSetView<F32x8, M>,
                block: &Block,
                $($argument: $type),*
            ) -> $result {
                #[target_feature(enable = "avx2")]
                fn avx2<M: InvMass<F32x8>>(
                    set: &RowSetView<F32x8, M>,
                    block: &Block,
                    $($argument: $type),*
                ) -> $result {
                    super::$name(set, block, $($argument),*)
                }
                // SAFETY: rows of this width are only made where the CPU has AVX2.
                unsafe { avx2(set, block, $($argument),*) }
            }
        };
    }

    entry!(fill(filler: &Filler) -> (bool, bool));
    entry!(run(pass: Pass, bodies: &RowView<BodyRow>, params: &SubstepParams) -> bool);
    entry!(store(contacts: &ManifoldsView) -> ());
}

#[inline(always)]
fn fill<N: Lane, M: InvMass<N>>(set: &RowSetView<N, M>, block: &Block, filler: &Filler) -> (bool, bool) {
    with_block!(set, block, |rows| filler.fill(rows))
}

/// Plain loops, not iterator adaptors: what is to be compiled for the caller's CPU feature must be inlined
/// into it.
#[inline(always)]
fn run<N: Lane, M: InvMass<N>>(
    set: &RowSetView<N, M>,
    block: &Block,
    pass: Pass,
    bodies: &RowView<BodyRow>,
    params: &SubstepParams,
) -> bool {
    let concerned = match pass {
        Pass::Impact | Pass::Restitute => block.bouncy,
        Pass::TakeBack => block.deep,
        _ => true,
    };
    if !concerned {
        return false;
    }
    with_block!(set, block, |rows| run_rows(rows, block, pass, bodies, params))
}

#[inline(always)]
fn run_rows<N: Lane, M: InvMass<N>, const P: usize>(
    BlockRows { rows, bounces, deeps, .. }: BlockRows<N, M, P>,
    block: &Block,
    pass: Pass,
    bodies: &RowView<BodyRow>,
    params: &SubstepParams,
) -> bool {
    let mut hit = false;
    match pass {
        Pass::Impact => {
            for (row, bounce) in rows.iter_mut().zip(&mut *bounces) {
                hit |= row.impact(bodies, bounce, params);
            }
        }
        Pass::WarmStart => {
            if block.deep {
                for (row, deep) in rows.iter_mut().zip(&*deeps) {
                    row.cool(deep);
                }
            }
            for row in rows.iter() {
                row.warm_start(bodies);
            }
        }
        Pass::Solve => {
            if block.deep {
                for (row, deep) in rows.iter().zip(deeps) {
                    row.note_before(deep);
                }
            }
            for row in rows.iter_mut() {
                row.solve(bodies, params);
            }
        }
        Pass::TakeBack => {
            for (row, deep) in rows.iter_mut().zip(&*deeps) {
                row.take_back(bodies, deep);
            }
        }
        Pass::Relax if block.bouncy => {
            for (row, bounce) in rows.iter_mut().zip(&*bounces) {
                row.relax(bodies, params, Some(bounce.restitution));
            }
        }
        Pass::Relax => {
            for row in rows.iter_mut() {
                row.relax(bodies, params, None);
            }
        }
        Pass::Restitute => {
            for (row, bounce) in rows.iter_mut().zip(&mut *bounces) {
                row.restitute(bodies, bounce, params);
            }
        }
    }
    if block.bouncy && (pass == Pass::Solve || pass == Pass::Relax) {
        for (row, bounce) in rows.iter().zip(bounces) {
            row.note_impulses(bounce);
        }
    }
    hit
}

#[inline(always)]
fn store<N: Lane, M: InvMass<N>>(set: &RowSetView<N, M>, block: &Block, contacts: &ManifoldsView) {
    with_block!(set, block, |rows| store_rows(&rows, contacts));
}

#[inline(always)]
fn store_rows<N: Lane, M: InvMass<N>, const P: usize>(rows: &BlockRows<N, M, P>, contacts: &ManifoldsView) {
    for (i, (row, source)) in rows.rows.iter().zip(rows.sources).enumerate() {
        if let Some(next) = rows.sources.get(i + AHEAD) {
            contacts.prefetch(next.contacts.lanes());
        }
        let friction = TangentFrame::new(row.normal).expand(row.tangent_impulse);
        for (lane, contact) in source.contacts.lanes().iter().enumerate() {
            if *contact == NONE {
                continue;
            }
            // SAFETY: a contact has one row in a stage, and stages are stored one after the other.
            let manifold = unsafe { contacts.manifold(*contact, source.manifolds.lanes()[lane]) };
            manifold.friction_impulse = friction.get(lane);
            manifold.twist_impulse = row.twist.impulse(lane);
            let count = manifold.count as usize;
            for (p, point) in manifold.points[..count].iter_mut().zip(&row.points) {
                p.impulse = point.impulse.get(lane);
            }
        }
    }
}
