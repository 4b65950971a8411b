//! Manifolds become rows: each colour's contacts are sorted by point count and laid out, then lanes are
//! filled, block by block, and the effective masses computed for all lanes of a row at once.
#![expect(unsafe_code, reason = "rows of bodies are shared by threads")]

use super::batch::{BlockRows, Plan, PointClass, RowSet, Rows, Set, Source, with_rows};
use super::input::RowInput;
use super::shares::Shares;
use super::{
    BodyRow, BodyRows, ContactRow, DeepRow, InvMass, MassRow, Motion, RestitutionRow, RowView, SubstepParams,
};
use crate::contact::{Contact, ContactFlags, Manifold};
use crate::math::{AxisLocks, Ids, Lane, TangentFrame, Vector};
use crate::table::{BodyTable, NONE};

/// How many deeply overlapping contacts each dynamic body's row has; nothing in steps without any.
///
/// Where a body overlaps many others deeply, as when a crowd is spawned in one place, contacts work against
/// one another; so those of a crowd push less and start from less of their last impulses.
#[derive(Clone, Debug, Default)]
pub(super) struct DeepCounts(Vec<u32>);

/// So many deep contacts a body may have and still start from all their impulses: about as many as touch it
/// in a full container.
const WARM_CONTACTS: f32 = 8.0;

impl DeepCounts {
    pub(super) fn count(&mut self, input: &RowInput, bodies: &BodyRows) {
        self.0.clear();
        if !input.contacts.any_deep() {
            return;
        }
        self.0.resize(bodies.rows.len(), 0);
        for id in input.contacts.active() {
            let contact = input.contacts.get(id);
            if contact.flags.has(ContactFlags::DEEP) && contact.slot.is_some() {
                for body in contact.bodies {
                    let row = input.row_of(body);
                    self.0[row as usize] += u32::from(row >= bodies.first_dynamic);
                }
            }
        }
    }

    /// Whether there are any.
    pub(super) fn any(&self) -> bool {
        !self.0.is_empty()
    }

    /// How crowded it is around a contact between two body rows, at least 1: the least crowded movable side
    /// decides.
    #[inline(always)]
    fn crowd(&self, rows: [u32; 2], first_dynamic: u32) -> f32 {
        let count = rows.into_iter().filter(|r| *r >= first_dynamic).map(|r| self.0[r as usize]).min();
        count.unwrap_or(1).max(1) as f32
    }

    /// The share of the push-out speed of a contact between two body rows that are in n others deeply: n^(−3/4).
    /// With 1/n, which no sum exceeds, a hundred bodies in one place hardly move in five seconds, since
    /// most pushes cancel; with 1/√n, as random pushes add up, an overfull container does not calm down.
    #[inline(always)]
    fn share(&self, rows: [u32; 2], first_dynamic: u32) -> f32 {
        if !self.any() {
            return 1.0;
        }
        let root = self.crowd(rows, first_dynamic).sqrt();
        1.0 / (root * root.sqrt())
    }

    /// The share of its last impulses that a contact between two body rows starts from. One sweep does not
    /// settle a body with dozens of contacts; started from all their impulses again and again, the error
    /// grows from substep to substep.
    #[inline(always)]
    fn warm_share(&self, rows: [u32; 2], first_dynamic: u32) -> f32 {
        crate::math::min(1.0, WARM_CONTACTS / self.crowd(rows, first_dynamic))
    }

    /// Whether a body of these rows overlaps something deeply.
    #[inline(always)]
    fn concern(&self, rows: [u32; 2]) -> bool {
        rows.iter().any(|row| self.0[*row as usize] > 0)
    }
}

/// One manifold that wants a row.
#[derive(Clone, Copy, Debug)]
pub struct ContactSource {
    contact: u32,
    manifold: u32,
}

/// Whether a body of the contact is held along some axes.
fn is_held(input: &RowInput, locks: &[AxisLocks], contact: u32) -> bool {
    input.contacts.get(contact).bodies.iter().any(|body| {
        let row = input.row_of(*body);
        locks[row as usize].is_translation_held()
    })
}

/// The manifolds of one member's part, by point class.
pub(super) type Lists = [Vec<ContactSource>; 3];

/// Manifolds of one colour and one layer, sorted by set, by the part of the stage they belong to and by point class.
///
/// The first layer are the first manifolds of all contacts, the next one the second ones, and so on.
#[derive(Clone, Debug, Default)]
pub(super) struct Sorted {
    /// Contacts of bodies held along some axes, and all others.
    pub(super) held: Vec<Lists>,
    pub(super) free: Vec<Lists>,
    pub(super) parts: usize,
    /// How many contacts have manifolds in the next layer too.
    more: usize,
}

impl Sorted {
    /// Sorts the manifolds of a layer: the first, or the one after the last that was sorted.
    pub(super) fn sort(&mut self, contacts: &[u32], layer: u32, sorter: &Sorter) {
        let Self { held, free, parts, more } = self;
        let Sorter { input, locks, shares } = sorter;
        debug_assert!(layer == 0 || *more > 0, "the layer before had more");
        *parts = shares.parts(if layer == 0 { contacts.len() } else { *more });
        *more = 0;
        for lists in [&mut *held, &mut *free] {
            lists.resize_with(lists.len().max(*parts), Lists::default);
            lists.iter_mut().flatten().for_each(Vec::clear);
        }
        for &id in contacts {
            let count = match input.contacts.point_count(id).of_only_manifold() {
                Some(count) if layer == 0 => count,
                Some(_) => 0,
                None => {
                    let contact = input.contacts.get(id);
                    *more += usize::from(u32::from(contact.extra_count) > layer);
                    input.contacts.manifold(contact, layer).map_or(0, |manifold| manifold.count)
                }
            };
            if count > 0 {
                let lists =
                    if !locks.is_empty() && is_held(input, locks, id) { &mut *held } else { &mut *free };
                let list = &mut lists[shares.part(input, id, *parts)][PointClass::of(count) as usize];
                list.push(ContactSource { contact: id, manifold: layer });
            }
        }
    }

    /// Whether some contacts have manifolds in the next layer.
    pub(super) fn has_more(&self) -> bool {
        self.more > 0
    }
}

/// What manifolds are sorted by.
pub(super) struct Sorter<'a> {
    pub(super) input: &'a RowInput<'a>,
    /// Which axes are held, by body row; empty where none is.
    pub(super) locks: &'a [AxisLocks],
    pub(super) shares: &'a Shares,
}

impl<N: Lane, M: InvMass<N>> RowSet<N, M> {
    /// Appends the rows of sorted manifolds, and plans a stage of them.
    pub(super) fn lay(&mut self, set: Set, lists: &[Lists], parts: usize, shares: &Shares, plan: &mut Plan) {
        debug_assert!((1..=shares.members()).contains(&parts) && parts <= lists.len(), "{parts} parts");
        for member in 0..shares.members() {
            if let Some(part) = shares.of_member(member, parts) {
                for class in PointClass::ALL {
                    let manifolds = &lists[part][class as usize];
                    let range = with_rows!(self, class, |rows| rows.lay(manifolds));
                    plan.add(set, class, range, manifolds.len());
                }
            }
            plan.end_part();
        }
        plan.end_stage(parts > 1);
    }
}

impl<N: Lane, M: InvMass<N>, const P: usize> Rows<N, M, P> {
    /// Appends rows for manifolds, and returns which.
    fn lay(&mut self, manifolds: &[ContactSource]) -> core::ops::Range<u32> {
        let start = self.sources.len() as u32;
        for chunk in manifolds.chunks(N::WIDTH) {
            let mut source = Source::<N> { contacts: N::Ids::splat(NONE), manifolds: N::Ids::splat(0) };
            for (lane, from) in chunk.iter().enumerate() {
                source.contacts.set(lane, from.contact);
                source.manifolds.set(lane, from.manifold);
            }
            self.sources.push(source);
        }
        start..self.sources.len() as u32
    }
}

/// What rows are filled from.
pub(super) struct Filler<'a> {
    pub(super) input: &'a RowInput<'a>,
    pub(super) view: RowView<'a, BodyRow>,
    pub(super) masses: &'a [MassRow],
    pub(super) motions: &'a [Motion],
    pub(super) first_dynamic: u32,
    pub(super) params: &'a SubstepParams,
    pub(super) deep: &'a DeepCounts,
    /// Which axes are held, by body row; empty where nobody is held along any.
    pub(super) locks: &'a [AxisLocks],
}

impl Filler<'_> {
    /// Fills the rows of a block. Returns whether any of them can bounce, and whether any overlaps deeply.
    #[inline(always)]
    pub(super) fn fill<N: Lane, M: InvMass<N>, const P: usize>(
        &self,
        block: BlockRows<N, M, P>,
    ) -> (bool, bool) {
        let (mut bouncy, mut any_deep) = (false, false);
        for (i, source) in block.sources.iter().enumerate() {
            if let Some(next) = block.sources.get(i + AHEAD) {
                self.input.contacts.prefetch(next.contacts.lanes());
            }
            let (row, bounce) = (&mut block.rows[i], &mut block.bounces[i]);
            *row = ContactRow::default();
            *bounce = RestitutionRow::default();
            let mut fill = Fill::<N, P>::new();
            for lane in 0..N::WIDTH {
                let contact = source.contacts.lanes()[lane];
                if contact != NONE {
                    let from = ContactSource { contact, manifold: source.manifolds.lanes()[lane] };
                    fill.lane(self, from, lane, row, bounce);
                }
            }
            fill.finish(row, bounce, self.masses, &self.view);
            bouncy |= N::any(N::ZERO.lt(bounce.restitution));
            if self.deep.any() {
                let deep = &mut block.deeps[i];
                *deep = DeepRow::default();
                any_deep |= deep.mark(self.deep, &row.ids, self.first_dynamic);
            }
        }
        (bouncy, any_deep)
    }
}

impl<N: Lane, const P: usize> DeepRow<N, P> {
    /// Marks the lanes of bodies that overlap something deeply. Returns whether there are any.
    #[inline(always)]
    fn mark(&mut self, counts: &DeepCounts, ids: &[N::Ids; 2], first_dynamic: u32) -> bool {
        let mut any = false;
        for lane in 0..N::WIDTH {
            let rows = [ids[0].lanes()[lane], ids[1].lanes()[lane]];
            if counts.concern(rows) {
                self.deep.set(lane, 1.0);
                self.warm.set(lane, counts.warm_share(rows, first_dynamic));
                any = true;
            }
        }
        any
    }
}

/// A point whose K is a smaller share of what it were if no body was held along an axis cannot be pushed along
/// the normal: what is left is rounding.
const HELD: f32 = 1.0e-6;

/// It is not taken for a smaller share than this. A normal nearly along the axis on which a body is held would
/// else throw it out sideways.
const HARDLY: f32 = 0.1;

/// For so many rows ahead contacts are brought near: a colour's contacts stand anywhere in the table.
pub(super) const AHEAD: usize = 1;

/// What is needed of a row only while it is prepared.
struct Fill<N, const P: usize> {
    friction_impulse: Vector<N>,
    weights: [N; P],
    rounding: [N; 2],
    free: [Vector<N>; 2],
    dominated: [N; 2],
}

impl<N: Lane, const P: usize> Fill<N, P> {
    #[inline(always)]
    fn new() -> Self {
        Self {
            friction_impulse: Vector::ZERO,
            weights: [N::ZERO; P],
            rounding: [N::ZERO; 2],
            free: [Vector::splat(Vector::ONE); 2],
            dominated: [N::ZERO; 2],
        }
    }

    /// Copies one manifold into a lane.
    #[inline(always)]
    fn lane<M: InvMass<N>>(
        &mut self,
        filler: &Filler,
        from: ContactSource,
        lane: usize,
        row: &mut ContactRow<N, M, P>,
        bounce: &mut RestitutionRow<N, P>,
    ) {
        let input = filler.input;
        let contact = input.contacts.get(from.contact);
        let manifold = input.contacts.manifold(contact, from.manifold).expect("it was there to be counted");
        debug_assert!((1..=P as u32).contains(&manifold.count), "{} points fit into {P}", manifold.count);
        debug_assert!(
            (manifold.normal.length() - 1.0).abs() < 1.0e-3,
            "a normal of unit length: {:?}",
            manifold.normal
        );
        debug_assert!(manifold.points().iter().all(|p| p.separation.is_finite()), "separations are finite");
        let ids = contact.bodies.map(|body| input.row_of(body));
        for side in 0..2 {
            row.ids[side].set(lane, ids[side]);
            if let Some(locks) = filler.locks.get(ids[side] as usize)
                && locks.is_translation_held()
            {
                self.free[side].set(lane, locks.translation_factors());
            }
        }
        if input.bodies.any_dominance {
            self.dominate(input.bodies, contact, lane);
        }
        let [friction, restitution] = contact.surface;
        debug_assert!(friction >= 0.0 && restitution >= 0.0, "a surface: {friction}, {restitution}");
        row.friction.set(lane, friction);
        bounce.restitution.set(lane, restitution);
        if restitution > 0.0 {
            let [a, b] = ids.map(|row| filler.motions[row as usize].acceleration);
            bounce.gained.set(lane, (a - b).dot(manifold.normal) * filler.params.h);
        }
        let share = filler.deep.share(ids, filler.first_dynamic);
        debug_assert!(share > 0.0 && share <= 1.0, "a share: {share}");
        row.push_speed.set(lane, filler.params.max_push_speed * share);
        self.copy(manifold, contact.frozen.offset, filler.params, lane, row);
    }

    /// Marks the side that cannot be moved by the other because it dominates it.
    #[inline(always)]
    fn dominate(&mut self, bodies: &BodyTable, contact: &Contact, lane: usize) {
        let [a, b] = contact.bodies;
        if a != NONE && b != NONE {
            let (a, b) = (bodies[a].effective_dominance(), bodies[b].effective_dominance());
            if a > b {
                self.dominated[0].set(lane, 1.0);
            } else if b > a {
                self.dominated[1].set(lane, 1.0);
            }
        }
    }

    #[inline(always)]
    fn copy<M: InvMass<N>>(
        &mut self,
        manifold: &Manifold,
        offset: Vector,
        params: &SubstepParams,
        lane: usize,
        row: &mut ContactRow<N, M, P>,
    ) {
        row.normal.set(lane, manifold.normal);
        row.offset.set(lane, offset);
        self.friction_impulse.set(lane, manifold.friction_impulse * params.warm_start);
        for (to, from) in self.rounding.iter_mut().zip(manifold.radii) {
            to.set(lane, from);
        }
        row.twist.set_impulse(lane, manifold.twist_impulse * params.warm_start);
        for (i, p) in manifold.points().iter().enumerate() {
            let point = &mut row.points[i];
            point.anchor.set(lane, p.anchor);
            point.separation.set(lane, p.separation);
            point.impulse.set(lane, p.impulse * params.warm_start);
            // 1 marks the point as present until its mass is known.
            point.mass.set(lane, 1.0);
            // A point that is still apart counts less the farther it is, so that the friction centre
            // does not jump when a point comes or goes.
            let weight = 2.0 - p.separation / params.friction_fade;
            self.weights[i].set(lane, crate::math::clamp(weight, 1.0e-10, 1.0));
        }
    }

    /// Computes what follows from the lanes, for all at once: effective masses, friction centre,
    /// approach speeds.
    #[inline(always)]
    fn finish<M: InvMass<N>>(
        &self,
        row: &mut ContactRow<N, M, P>,
        bounce: &mut RestitutionRow<N, P>,
        masses: &[MassRow],
        view: &RowView<BodyRow>,
    ) {
        let mut unheld = N::ZERO;
        for side in 0..2 {
            let (inv_mass, inertia) = MassRow::gather::<N>(masses, &row.ids[side]);
            let movable = N::select(N::ZERO.lt(self.dominated[side]), N::ZERO, N::ONE);
            let inv_mass = inv_mass * movable;
            row.inv_mass[side] = M::new(inv_mass, self.free[side]);
            row.inv_inertia[side] = inertia.scaled(movable);
            unheld += inv_mass;
        }
        // SAFETY: no thread writes bodies while rows are filled.
        let [(va, wa), (vb, wb)] =
            unsafe { row.ids.each_ref().map(|ids| BodyRow::gather_velocity::<N>(view, ids)) };
        let n = row.normal;
        let linear = n.dot(row.inv_mass[0].apply(n)) + n.dot(row.inv_mass[1].apply(n));
        let (mut total, mut center) = (N::ZERO, Vector::ZERO);
        let to_surface = n * self.rounding[0];
        row.rounding = self.rounding[0] + self.rounding[1];
        row.offset -= n * row.rounding;
        for i in 0..P {
            let point = &mut row.points[i];
            point.anchor -= to_surface;
            let (ma, mb) = (point.anchor.cross(n), (point.anchor - row.offset).cross(n));
            let k = linear + ma.dot(row.inv_inertia[0].apply(ma)) + mb.dot(row.inv_inertia[1].apply(mb));
            let present = N::and((unheld * N::splat(HELD)).lt(k), N::ZERO.lt(point.mass));
            point.mass = N::select(present, N::ONE / k.max(unheld * N::splat(HARDLY)), N::ZERO);
            bounce.approach[i] = (vb - va).dot(n) + wb.dot(mb) - wa.dot(ma);
            total += self.weights[i];
            center += point.anchor * self.weights[i];
        }
        let total = N::select(N::ZERO.lt(total), total, N::ONE);
        let core = center * (N::ONE / total);
        row.center = core + to_surface;
        let frame = TangentFrame::new(n);
        let [ra, rb] = row.surface_arms();
        let arms = [(row.inv_inertia[0], ra), (row.inv_inertia[1], rb)];
        let [m0, m1] = row.inv_mass;
        row.tangent_mass = frame.mass(m0.diagonal() + m1.diagonal(), arms);
        row.tangent_impulse = frame.project(self.friction_impulse);
        let mut anchors = [core; P];
        for i in 0..P {
            // A point that is not there must not add a lever.
            let there = N::select(N::ZERO.lt(self.weights[i]), N::ONE, N::ZERO);
            anchors[i] += (row.points[i].anchor - core) * there;
        }
        row.twist.prepare(n, core, anchors, row.inv_inertia);
    }
}
