//! What is done with the rows of one block: filled, swept, stored; for the width of its set.
#![expect(unsafe_code, reason = "blocks are run at once; entry points for a CPU feature that was looked for")]

use super::batch::{Block, BlockRows, RowSetView, Set, with_block};
use super::prepare::{AHEAD, Filler};
use super::{BodyRow, InvMass, RowView, SubstepParams};
use crate::contact::ManifoldsView;
#[cfg(target_arch = "x86_64")]
use crate::math::{Avx2, F32x8};
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
    #[cfg(target_arch = "x86_64")]
    Eight(WideView<'a, F32x8>, Avx2),
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
            (Set::Overflow, _) => $f((), &$view.overflow.free, $block, $($argument),*),
            (Set::OverflowHeld, _) => $f((), &$view.overflow.held, $block, $($argument),*),
            (Set::Wide, Wide::Four(wide)) => $f((), &wide.free, $block, $($argument),*),
            (Set::WideHeld, Wide::Four(wide)) => $f((), &wide.held, $block, $($argument),*),
            #[cfg(target_arch = "x86_64")]
            (Set::Wide, Wide::Eight(wide, avx2)) => $f(*avx2, &wide.free, $block, $($argument),*),
            #[cfg(target_arch = "x86_64")]
            (Set::WideHeld, Wide::Eight(wide, avx2)) => $f(*avx2, &wide.held, $block, $($argument),*),
        }
    };
}

impl SetsView<'_> {
    /// Fills a block's rows, and notes in it what they are like.
    ///
    /// # Safety
    /// Meanwhile no other thread runs a block that has rows of this one, nor writes a body or contact that it has.
    pub(super) unsafe fn fill(&self, block: &mut Block, filler: &Filler) {
        // SAFETY: by the contract.
        (block.bouncy, block.deep) = unsafe { of_set!(self, block, fill(filler)) };
    }

    /// Runs a pass over a block. Returns whether it found an impact.
    ///
    /// # Safety
    /// Meanwhile no other thread runs a block that has rows of this one, nor touches a dynamic body that it has, nor writes another that it has.
    pub(super) unsafe fn run(
        &self,
        block: &Block,
        pass: Pass,
        bodies: &RowView<BodyRow>,
        params: &SubstepParams,
    ) -> bool {
        // SAFETY: by the contract.
        unsafe { of_set!(self, block, run(pass, bodies, params)) }
    }

    /// Puts a block's impulses back into the manifolds.
    ///
    /// # Safety
    /// Meanwhile no other thread runs a block that has rows of this one, nor touches a contact that it has.
    pub(super) unsafe fn store(&self, block: &Block, contacts: &ManifoldsView) {
        // SAFETY: by the contract.
        unsafe { of_set!(self, block, store(contacts)) };
    }
}

/// The entry points of a width: everything below them is inlined, and compiled for the CPU feature it needs.
///
/// There is one for each class and pass. Without optimisation, whatever is inlined has its own place on the stack:
/// all passes in one function took 4.6 MB of it in 3D, where threads have two.
trait Entry: Lane {
    /// What proves that the CPU has the feature.
    type Proof: Copy;

    fn fill<M: InvMass<Self>, const P: usize>(
        proof: Self::Proof,
        rows: BlockRows<Self, M, P>,
        filler: &Filler,
    ) -> (bool, bool);

    /// # Safety
    /// As [`SetsView::run`]'s.
    unsafe fn sweep<M: InvMass<Self>, S: Sweep, const P: usize>(
        proof: Self::Proof,
        rows: BlockRows<Self, M, P>,
        block: &Block,
        bodies: &RowView<BodyRow>,
        params: &SubstepParams,
    ) -> bool;

    /// # Safety
    /// As [`SetsView::store`]'s.
    unsafe fn store<M: InvMass<Self>, const P: usize>(
        proof: Self::Proof,
        rows: BlockRows<Self, M, P>,
        contacts: &ManifoldsView,
    );
}

/// The entry points of lanes that every CPU has.
macro_rules! enter {
    ($lane:ty) => {
        impl Entry for $lane {
            type Proof = ();

            #[inline(never)]
            fn fill<M: InvMass<Self>, const P: usize>(
                (): (),
                rows: BlockRows<Self, M, P>,
                filler: &Filler,
            ) -> (bool, bool) {
                filler.fill(rows)
            }

            #[inline(never)]
            unsafe fn sweep<M: InvMass<Self>, S: Sweep, const P: usize>(
                (): (),
                rows: BlockRows<Self, M, P>,
                block: &Block,
                bodies: &RowView<BodyRow>,
                params: &SubstepParams,
            ) -> bool {
                // SAFETY: by the contract.
                unsafe { S::over(rows, block, bodies, params) }
            }

            #[inline(never)]
            unsafe fn store<M: InvMass<Self>, const P: usize>(
                (): (),
                rows: BlockRows<Self, M, P>,
                contacts: &ManifoldsView,
            ) {
                // SAFETY: by the contract.
                unsafe { store_rows(&rows, contacts) };
            }
        }
    };
}

enter!(f32);
enter!(F32x4);

#[cfg(target_arch = "x86_64")]
impl Entry for F32x8 {
    type Proof = Avx2;

    fn fill<M: InvMass<Self>, const P: usize>(
        _: Avx2,
        rows: BlockRows<Self, M, P>,
        filler: &Filler,
    ) -> (bool, bool) {
        #[target_feature(enable = "avx2")]
        fn avx2<M: InvMass<F32x8>, const P: usize>(
            rows: BlockRows<F32x8, M, P>,
            filler: &Filler,
        ) -> (bool, bool) {
            filler.fill(rows)
        }
        // SAFETY: the caller has the proof that the CPU has AVX2.
        unsafe { avx2(rows, filler) }
    }

    unsafe fn sweep<M: InvMass<Self>, S: Sweep, const P: usize>(
        _: Avx2,
        rows: BlockRows<Self, M, P>,
        block: &Block,
        bodies: &RowView<BodyRow>,
        params: &SubstepParams,
    ) -> bool {
        #[target_feature(enable = "avx2")]
        unsafe fn avx2<M: InvMass<F32x8>, S: Sweep, const P: usize>(
            rows: BlockRows<F32x8, M, P>,
            block: &Block,
            bodies: &RowView<BodyRow>,
            params: &SubstepParams,
        ) -> bool {
            // SAFETY: by the contract.
            unsafe { S::over(rows, block, bodies, params) }
        }
        // SAFETY: as above, and by the contract.
        unsafe { avx2::<M, S, P>(rows, block, bodies, params) }
    }

    unsafe fn store<M: InvMass<Self>, const P: usize>(
        _: Avx2,
        rows: BlockRows<Self, M, P>,
        contacts: &ManifoldsView,
    ) {
        #[target_feature(enable = "avx2")]
        unsafe fn avx2<M: InvMass<F32x8>, const P: usize>(
            rows: BlockRows<F32x8, M, P>,
            contacts: &ManifoldsView,
        ) {
            // SAFETY: by the contract.
            unsafe { store_rows(&rows, contacts) };
        }
        // SAFETY: as above, and by the contract.
        unsafe { avx2(rows, contacts) }
    }
}

/// # Safety
/// As [`SetsView::fill`]'s.
unsafe fn fill<N: Entry, M: InvMass<N>>(
    proof: N::Proof,
    set: &RowSetView<N, M>,
    block: &Block,
    filler: &Filler,
) -> (bool, bool) {
    with_block!(set, block, |rows| N::fill(proof, rows, filler))
}

/// # Safety
/// As [`SetsView::run`]'s.
unsafe fn run<N: Entry, M: InvMass<N>>(
    proof: N::Proof,
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
    with_block!(set, block, |rows| {
        // SAFETY: by the contract.
        unsafe {
            match pass {
                Pass::Impact => N::sweep::<M, Impact, _>(proof, rows, block, bodies, params),
                Pass::WarmStart => N::sweep::<M, WarmStart, _>(proof, rows, block, bodies, params),
                Pass::Solve => N::sweep::<M, Solve, _>(proof, rows, block, bodies, params),
                Pass::TakeBack => N::sweep::<M, TakeBack, _>(proof, rows, block, bodies, params),
                Pass::Relax if block.bouncy => {
                    N::sweep::<M, RelaxBouncy, _>(proof, rows, block, bodies, params)
                }
                Pass::Relax => N::sweep::<M, Relax, _>(proof, rows, block, bodies, params),
                Pass::Restitute => N::sweep::<M, Restitute, _>(proof, rows, block, bodies, params),
            }
        }
    })
}

/// # Safety
/// As [`SetsView::store`]'s.
unsafe fn store<N: Entry, M: InvMass<N>>(
    proof: N::Proof,
    set: &RowSetView<N, M>,
    block: &Block,
    contacts: &ManifoldsView,
) {
    // SAFETY: by the contract.
    with_block!(set, block, |rows| unsafe { N::store(proof, rows, contacts) });
}

/// A pass over the rows of a block.
///
/// Plain loops, not iterator adaptors: what is to be compiled for the caller's CPU feature must be inlined into it.
trait Sweep {
    /// Returns whether it found an impact.
    ///
    /// # Safety
    /// As [`SetsView::run`]'s.
    unsafe fn over<N: Lane, M: InvMass<N>, const P: usize>(
        rows: BlockRows<N, M, P>,
        block: &Block,
        bodies: &RowView<BodyRow>,
        params: &SubstepParams,
    ) -> bool;
}

/// Names a pass and says what it does.
macro_rules! sweep {
    ($name:ident($rows:ident, $block:ident, $bodies:ident, $params:ident) $body:block) => {
        struct $name;

        impl Sweep for $name {
            #[inline(always)]
            unsafe fn over<N: Lane, M: InvMass<N>, const P: usize>(
                $rows: BlockRows<N, M, P>,
                $block: &Block,
                $bodies: &RowView<BodyRow>,
                $params: &SubstepParams,
            ) -> bool {
                // SAFETY: by the contract.
                unsafe { $body }
            }
        }
    };
}

sweep!(Impact(all, _block, bodies, params) {
    let mut hit = false;
    for (row, bounce) in all.rows.iter_mut().zip(&mut *all.bounces) {
        hit |= row.impact(bodies, bounce, params);
    }
    hit
});

sweep!(WarmStart(all, block, bodies, _params) {
    if block.deep {
        for (row, deep) in all.rows.iter_mut().zip(&*all.deeps) {
            row.cool(deep);
        }
    }
    for row in all.rows.iter() {
        row.warm_start(bodies);
    }
    false
});

sweep!(Solve(all, block, bodies, params) {
    if block.deep {
        for (row, deep) in all.rows.iter().zip(all.deeps) {
            row.note_before(deep);
        }
    }
    for row in all.rows.iter_mut() {
        row.solve(bodies, params);
    }
    if block.bouncy {
        for (row, bounce) in all.rows.iter().zip(all.bounces) {
            row.note_impulses(bounce);
        }
    }
    false
});

sweep!(TakeBack(all, _block, bodies, _params) {
    for (row, deep) in all.rows.iter_mut().zip(&*all.deeps) {
        row.take_back(bodies, deep);
    }
    false
});

sweep!(Relax(all, _block, bodies, params) {
    for row in all.rows.iter_mut() {
        row.relax(bodies, params, None);
    }
    false
});

sweep!(RelaxBouncy(all, _block, bodies, params) {
    for (row, bounce) in all.rows.iter_mut().zip(&*all.bounces) {
        row.relax(bodies, params, Some(bounce.restitution));
    }
    for (row, bounce) in all.rows.iter().zip(all.bounces) {
        row.note_impulses(bounce);
    }
    false
});

sweep!(Restitute(all, _block, bodies, params) {
    for (row, bounce) in all.rows.iter_mut().zip(&mut *all.bounces) {
        row.restitute(bodies, bounce, params);
    }
    false
});

/// # Safety
/// As [`SetsView::store`]'s.
#[inline(always)]
unsafe fn store_rows<N: Lane, M: InvMass<N>, const P: usize>(
    rows: &BlockRows<N, M, P>,
    contacts: &ManifoldsView,
) {
    for (i, (row, source)) in rows.rows.iter().zip(rows.sources).enumerate() {
        if let Some(next) = rows.sources.get(i + AHEAD) {
            contacts.prefetch(next.contacts.lanes());
        }
        let friction = TangentFrame::new(row.normal).expand(row.tangent_impulse);
        for (lane, contact) in source.contacts.lanes().iter().enumerate() {
            if *contact == NONE {
                continue;
            }
            // SAFETY: by the contract; the one before is in use no more.
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
