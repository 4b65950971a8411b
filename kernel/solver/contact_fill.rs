//! Fills contact rows: lane by lane from manifolds, then the effective masses for all lanes of a row at
//! once.
#![expect(unsafe_code, reason = "rows of bodies are shared by threads")]

use super::batch::{Filling, SolverPass, SolverPasses};
use super::deep_overlap::DeepCounts;
use super::input::Item;
use super::mass_scaling::sag_rate;
use super::pair::lanes_of_body;
use super::resistance::levers;
use super::{BodyRow, ContactRow, ImpactRow, InvMass, MassRow, SplitImpulseRow};
use crate::contact::{Contact, ContactFlags, Manifold};
use crate::math::{Ids, Lane, TangentFrame, Vector};
use crate::table::{BodyTable, NONE};
use crate::tuning::solver::{HEAVY, MIN_USED_SHARE, NO_MASS, PRESSED, WATCHED_SPEED};
use crate::tuning::sweeps::AHEAD;

/// Prefetch distance, in rows: the contacts of a colour are scattered over the table.
pub(super) const PREFETCH_DISTANCE: usize = 1;

/// The rows of one block.
pub(super) struct BlockRows<'a, N: Lane, M, const P: usize> {
    pub(super) rows: &'a mut [ContactRow<N, M, P>],
    pub(super) impacts: &'a mut [ImpactRow<N>],
    /// Empty in steps without deep overlap.
    pub(super) splits: &'a mut [SplitImpulseRow<N, P>],
    /// Sum of each point's impulses over the substeps, N·s. Empty if sums are not kept.
    pub(super) sums: &'a mut [[N; P]],
}

/// Fills the rows of a block. Returns the passes that the rows need.
#[inline(always)]
pub(super) fn fill_rows<N: Lane, M: InvMass<N>, const P: usize>(
    block: BlockRows<N, M, P>,
    items: &[Item],
    from: &Filling,
) -> SolverPasses {
    let (mut watched, mut any_deep, mut overloaded) = (false, false, false);
    let sag_rate = N::splat(sag_rate(from.params));
    let pressed = N::splat(PRESSED * from.params.max_sag);
    for (i, lanes) in items.chunks(N::WIDTH).enumerate() {
        let next = (i + PREFETCH_DISTANCE) * N::WIDTH;
        for item in items.iter().skip(next).take(N::WIDTH) {
            from.input.contacts.prefetch(&[item.id]);
        }
        let (row, impact) = (&mut block.rows[i], &mut block.impacts[i]);
        *row = ContactRow::default();
        *impact = ImpactRow::default();
        let mut fill = Fill::<N, P>::new();
        for (lane, item) in lanes.iter().enumerate() {
            fill.lane(from, *item, lane, row, impact);
        }
        fill.finish(row, impact, from);
        overloaded |= N::any(pressed.lt(row.heavy_push() * sag_rate));
        watched |= N::any(N::ZERO.lt(impact.watched));
        if let Some(sum) = block.sums.get_mut(i) {
            *sum = [N::ZERO; P];
        }
        if from.deep.any() {
            let split = &mut block.splits[i];
            *split = SplitImpulseRow::default();
            any_deep |= split.mark(from.deep, &row.ids, from.first_dynamic);
            impact.watched = N::select(N::ZERO.lt(split.deep), N::splat(-1.0), impact.watched);
        }
    }
    let mut passes = SolverPasses::BASIC.with(SolverPass::Measure);
    if watched {
        passes = passes.watched();
    }
    if any_deep {
        passes = passes.with(SolverPass::UndoSplit);
    }
    if overloaded {
        passes = passes.overloaded();
    }
    passes
}

impl<N: Lane, M: InvMass<N>, const P: usize> ContactRow<N, M, P> {
    /// The velocity that the normal impulses give the lighter body, m/s, if the other body is much heavier;
    /// otherwise 0.
    #[inline(always)]
    fn heavy_push(&self) -> N {
        let mut impulse = N::ZERO;
        for point in &self.points {
            impulse += point.impulse;
        }
        let [a, b] = [self.inv_mass[0].along(self.normal), self.inv_mass[1].along(self.normal)];
        let (larger, smaller) = (a.max(b), a.min(b));
        let is_heavy = N::and((smaller * N::splat(HEAVY)).lt(larger), N::ZERO.lt(smaller));
        N::select(is_heavy, impulse * larger, N::ZERO)
    }
}

impl<N: Lane, const P: usize> SplitImpulseRow<N, P> {
    /// Marks the lanes of contacts with a deeply overlapping body. Returns whether any lane was marked.
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

/// Values that are needed only while a row is filled.
struct Fill<N, const P: usize> {
    friction_impulse: Vector<N>,
    weights: [N; P],
    radii: [N; 2],
    free: [Vector<N>; 2],
    dominated: [N; 2],
    surface_velocity: Vector<N>,
    /// Whether a lane has a surface velocity.
    is_driven: bool,
}

impl<N: Lane, const P: usize> Fill<N, P> {
    #[inline(always)]
    fn new() -> Self {
        Self {
            friction_impulse: Vector::ZERO,
            weights: [N::ZERO; P],
            radii: [N::ZERO; 2],
            free: [Vector::splat(Vector::ONE); 2],
            dominated: [N::ZERO; 2],
            surface_velocity: Vector::ZERO,
            is_driven: false,
        }
    }

    /// Copies one manifold into a lane.
    #[inline(always)]
    fn lane<M: InvMass<N>>(
        &mut self,
        from: &Filling,
        item: Item,
        lane: usize,
        row: &mut ContactRow<N, M, P>,
        impact: &mut ImpactRow<N>,
    ) {
        let input = from.input;
        let contact = input.contacts.get(item.id);
        let manifold = input.contacts.manifold(contact, item.index).expect("it was there to be counted");
        debug_assert!(
            (1..=P).contains(&usize::from(manifold.count)),
            "{} points fit into {P}",
            manifold.count
        );
        debug_assert!(
            (manifold.normal.length() - 1.0).abs() < 1.0e-3,
            "a normal of unit length: {:?}",
            manifold.normal
        );
        debug_assert!(manifold.points().iter().all(|p| p.separation.is_finite()), "separations are finite");
        let ids = contact.bodies.map(|body| input.row_of(body));
        for side in 0..2 {
            row.ids[side].set(lane, ids[side]);
        }
        if !from.axes.is_empty() {
            self.set_axes(from, ids, lane);
        }
        if input.bodies.any_dominance {
            self.dominate(input.bodies, contact, lane);
        }
        let [mut friction, mut restitution] = contact.surface;
        if manifold.has_own_surface() {
            let surface = manifold.surface(contact, input.colliders);
            [friction, restitution] = [surface.friction, surface.restitution];
            self.drive(lane, surface.velocity);
        }
        if contact.flags.has(ContactFlags::CHANGED)
            && let Some(surface) = input.contacts.changed_surface(item.id, item.index)
        {
            [friction, restitution] = [surface.friction, surface.restitution];
            self.drive(lane, surface.velocity);
        }
        debug_assert!(friction >= 0.0 && restitution >= 0.0, "a surface: {friction}, {restitution}");
        row.friction.set(lane, friction);
        impact.restitution.set(lane, restitution);
        let share = from.deep.share(ids, from.first_dynamic);
        debug_assert!(share > 0.0 && share <= 1.0, "a share: {share}");
        row.push_speed.set(lane, from.params.max_push_speed * share * from.mass_scaling.push_share(ids));
        let warm_start = if from.released.concerns(ids) { 0.0 } else { from.params.warm_start };
        self.copy(manifold, contact.frozen.offset, warm_start, from.params.friction_fade, lane, row);
    }

    /// Sets the factors of the inverse masses along each axis. Not inlined, since most worlds have no
    /// locked axes.
    #[inline(never)]
    fn set_axes(&mut self, from: &Filling, ids: [u32; 2], lane: usize) {
        for (free, id) in self.free.iter_mut().zip(ids) {
            free.set(lane, from.axes[id as usize]);
        }
    }

    /// Sets the velocity to which friction drives the surfaces of a lane.
    #[inline(always)]
    fn drive(&mut self, lane: usize, velocity: Vector) {
        self.surface_velocity.set(lane, velocity);
        self.is_driven |= velocity != Vector::ZERO;
    }

    /// Makes the side with higher dominance immovable for this contact.
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
        warm_start: f32,
        friction_fade: f32,
        lane: usize,
        row: &mut ContactRow<N, M, P>,
    ) {
        row.normal.set(lane, manifold.normal);
        row.offset.set(lane, offset);
        self.friction_impulse.set(lane, manifold.friction_impulse * warm_start);
        for (to, from) in self.radii.iter_mut().zip(manifold.radii) {
            to.set(lane, from);
        }
        row.twist.set_impulse(lane, manifold.twist_impulse.get() * warm_start);
        row.owed.set(lane, manifold.friction_owed * warm_start);
        for (i, p) in manifold.points().iter().enumerate() {
            let point = &mut row.points[i];
            point.anchor.set(lane, p.anchor);
            point.separation.set(lane, p.separation);
            point.gap.set(lane, p.separation);
            point.impulse.set(lane, p.impulse * warm_start);
            // 1 marks the point as present until its mass is computed.
            point.mass.set(lane, 1.0);
            // A separated point weighs less with distance, so that the friction centre does not jump when a
            // point appears or disappears.
            let weight = 2.0 - p.separation / friction_fade;
            self.weights[i].set(lane, crate::math::clamp(weight, 1.0e-10, 1.0));
        }
    }

    /// Computes effective masses, the friction centre and whether a point may be struck, for all lanes at
    /// once.
    #[inline(always)]
    fn finish<M: InvMass<N>>(
        &self,
        row: &mut ContactRow<N, M, P>,
        impact: &mut ImpactRow<N>,
        from: &Filling,
    ) {
        let mut unheld = N::ZERO;
        for side in 0..2 {
            let (inv_mass, inertia) = MassRow::gather::<N>(from.masses, &row.ids[side]);
            let mut movable = N::select(N::ZERO.lt(self.dominated[side]), N::ZERO, N::ONE);
            if N::SHARES {
                movable = movable * lanes_of_body(&row.ids, side);
            }
            let inv_mass = inv_mass * movable;
            row.inv_mass[side] = M::new(inv_mass, self.free[side]);
            row.inv_inertia[side] = inertia.scaled(movable);
            unheld += inv_mass;
        }
        // SAFETY: no thread writes bodies while rows are filled.
        let [(va, wa), (vb, wb)] =
            unsafe { row.ids.each_ref().map(|ids| BodyRow::gather_velocity::<N>(&from.bodies, ids)) };
        let n = row.normal;
        let slow = N::splat(-WATCHED_SPEED * from.params.blow_speed);
        let time = N::splat(AHEAD * from.params.dt);
        let linear = n.dot(row.inv_mass[0].apply(n)) + n.dot(row.inv_mass[1].apply(n));
        let (mut total, mut center) = (N::ZERO, Vector::ZERO);
        let to_surface = n * self.radii[0];
        row.radius = self.radii[0] + self.radii[1];
        row.offset -= n * row.radius;
        for i in 0..P {
            let point = &mut row.points[i];
            point.anchor -= to_surface;
            let (ma, mb) = (point.anchor.cross(n), (point.anchor - row.offset).cross(n));
            let k = linear + ma.dot(row.inv_inertia[0].apply(ma)) + mb.dot(row.inv_inertia[1].apply(mb));
            let present = N::and((unheld * N::splat(NO_MASS)).lt(k), N::ZERO.lt(point.mass));
            point.mass = N::select(present, N::ONE / k.max(unheld * N::splat(MIN_USED_SHARE)), N::ZERO);
            let speed = (vb - va).dot(n) + wb.dot(mb) - wa.dot(ma);
            let may_be_struck = N::and(speed.lt(slow), (point.separation + speed * time).lt(N::ZERO));
            impact.watched = N::select(N::and(may_be_struck, present), N::ONE, impact.watched);
            total += self.weights[i];
            center += point.anchor * self.weights[i];
        }
        let total = N::select(N::ZERO.lt(total), total, N::ONE);
        let core = center * (N::ONE / total);
        row.center = core + to_surface;
        let frame = TangentFrame::new(n);
        row.weigh_friction(&frame);
        row.tangent_impulse = frame.project(self.friction_impulse);
        if self.is_driven {
            row.surface_velocity = frame.project(self.surface_velocity);
        }
        let mut anchors = [core; P];
        for i in 0..P {
            // Absent points must not add a lever.
            let there = N::select(N::ZERO.lt(self.weights[i]), N::ONE, N::ZERO);
            anchors[i] += (row.points[i].anchor - core) * there;
        }
        let [spin_lever, roll_lever] = levers(self.radii, row.rolling_arm());
        row.roll_lever = roll_lever;
        // Several points have levers of their own, so that only a single point needs the lever of its
        // contact patch.
        let patch = if P == 1 { spin_lever } else { N::ZERO };
        row.twist.prepare(n, core, anchors, patch, row.inv_inertia);
    }
}
