//! Recycling of manifolds, several contacts side by side.
//!
//! Recycling is Erin Catto's (Box2D v3.2, Box3D; both ask to be cited for it). While two bodies have hardly
//! moved relative to each other since their manifold was computed, its normal, anchors and features are kept,
//! and only the separations follow the motion. The frozen pose stays the same, so errors cannot add up.
//! Frozen anchors save time and let tall towers stand.
//!
//! Decision: a platform is a body that contacts do not turn. The frozen pose (normal, anchors, rotations)
//! turns as a whole with it. Only rounding adds up, as a random walk. Between dynamic bodies the frozen
//! pose does not turn: where normals follow every small turn, a tower of 50 boxes leans further and
//! further, and falls.
//!
//! In a scene at rest nearly all contacts are recycled, each by the same arithmetic. So
//! [`RecycleBatch::push`] copies the numbers of a contact into a row, and [`RecycleBatch::evaluate`] computes
//! with as many rows side by side as a lane has floats.
#![expect(unsafe_code, reason = "rows of numbers are turned into lanes of numbers")]

use super::input::{NarrowPhaseInput, Sides, smaller};
use super::record::{Contact, ContactFlags, Manifold};
#[cfg(target_arch = "x86_64")]
use crate::math::F32x8;
use crate::math::{Angular, F32x4, Ids, Lane, MAX_POINTS, Num, Quad, Rot, Vector, Width, max};
use crate::tuning::contact::{RECYCLE_COS, RECYCLE_SHARE};
use crate::tuning::manifold::{KEPT, ROUNDING};
use core::mem::MaybeUninit;

/// Which body of a contact is a platform, as a number in a row.
const NO_PLATFORM: f32 = 0.0;
const PLATFORM_A: f32 = 1.0;
const PLATFORM_B: f32 = 2.0;

/// An upper bound of the ratio of a chord to twice [`small_turn`](Rot::small_turn), for turns up to
/// [`RECYCLE_COS`].
pub(crate) const CHORD: f32 = 1.016;

/// The numbers of a contact that recycling reads, or of several contacts side by side in the same order.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C)]
struct RecycleRow<N: Num = f32> {
    /// The rotations of A and B.
    rotations: [Rot<N>; 2],
    /// The rotations of A and B at the frozen pose.
    frozen: [Rot<N>; 2],
    /// From A's to B's centre of mass at the frozen pose.
    offset: Vector<N>,
    /// From A's to B's centre of mass now.
    offset_now: Vector<N>,
    /// As in [`Frozen`](super::Frozen).
    prediction: N,
    /// As in [`Reach`](crate::table::Reach).
    extents: [N; 2],
    /// As in [`Reach`](crate::table::Reach).
    turning: [N; 2],
    /// The number of points.
    count: N,
    /// [`PLATFORM_A`], [`PLATFORM_B`] or [`NO_PLATFORM`].
    platform: N,
    /// The speed of B relative to A. Unset if the manifold has [`MAX_POINTS`].
    speed: N,
    /// The angular velocities. Unset if the manifold has [`MAX_POINTS`].
    angular: [Angular<N>; 2],
    /// As in [`Manifold`](super::Manifold). This and the fields below are unset if there are no points.
    radii: [N; 2],
    normal: Vector<N>,
    points: [RowPoint<N>; MAX_POINTS],
}

#[derive(Clone, Copy, Debug, Default)]
#[repr(C)]
struct RowPoint<N: Num> {
    anchor: Vector<N>,
    frozen_separation: N,
}

const FLOATS: usize = size_of::<RecycleRow>() / size_of::<f32>();
const QUADS: usize = FLOATS.div_ceil(4);

/// The numbers of one contact as quads.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C, align(16))]
struct PackedRow {
    numbers: RecycleRow,
    unused: [f32; 4 * QUADS - FLOATS],
}

impl PackedRow {
    #[inline(always)]
    fn quads(&self) -> &[Quad; QUADS] {
        const { assert!(size_of::<PackedRow>() == size_of::<[Quad; QUADS]>()) }
        // SAFETY: both are the same number of floats without padding, with the same alignment.
        unsafe { &*core::ptr::from_ref(self).cast() }
    }
}

impl<N: Lane> RecycleRow<N> {
    /// Loads the rows at `places` side by side.
    #[inline(always)]
    fn side_by_side(rows: &[PackedRow; RecycleBatch::SIZE], places: &N::Ids) -> Self {
        const { assert!(size_of::<Self>() == FLOATS * size_of::<N>()) }
        let mut lanes = MaybeUninit::<[[N; 4]; QUADS]>::uninit();
        for quad in 0..QUADS {
            let four = N::gather(places, |place| &rows[place as usize].quads()[quad]);
            // SAFETY: `quad` is below `QUADS`.
            unsafe { lanes.as_mut_ptr().cast::<[N; 4]>().add(quad).write(four) };
        }
        // SAFETY: all quads are written, and `Self`, `repr(C)` of nothing but `N`, is the first `FLOATS`
        // lanes in order.
        unsafe { lanes.as_ptr().cast::<Self>().read() }
    }
}

/// Settings common to all contacts, as in [`NarrowPhaseInput`].
#[derive(Clone, Copy)]
struct Settings {
    dt: f32,
    tolerance: f32,
    recycle_distance: f32,
}

/// Contacts that are evaluated together, and the results.
#[derive(Clone, Debug, Default)]
pub(super) struct RecycleBatch {
    rows: [PackedRow; Self::SIZE],
    ids: [u32; Self::SIZE],
    len: usize,
    /// One bit for each contact: it keeps its manifold.
    kept: u32,
    /// One bit for each contact: its frozen pose turns with a platform, if it keeps its manifold.
    turned: u32,
    /// The present separations of each contact's points.
    separations: [Quad; Self::SIZE],
    /// How far the surfaces of each contact may move, if nothing closes, and how far they have moved.
    ways: [[f32; 2]; Self::SIZE],
}

impl RecycleBatch {
    /// The capacity: two of the widest lanes.
    const SIZE: usize = 16;

    pub(super) fn clear(&mut self) {
        self.len = 0;
    }

    #[inline(always)]
    pub(super) fn is_full(&self) -> bool {
        self.len == Self::SIZE
    }

    /// The contacts of the batch, in order.
    #[inline(always)]
    pub(super) fn ids(&self) -> &[u32] {
        &self.ids[..self.len]
    }

    /// Adds a contact to a batch that is not full; `false` if its manifold cannot be kept.
    #[inline(always)]
    pub(super) fn push(&mut self, id: u32, contact: &Contact, sides: &Sides) -> bool {
        let (&Sides { input, poses, .. }, reaches) = (sides, sides.reaches());
        let frozen = &contact.frozen;
        // The sum of both speeds bounds the closing speed. So velocities are read only for fast bodies.
        let fastest = (poses[0].speed + poses[1].speed) * input.dt;
        if !contact.flags.has(ContactFlags::FROZEN)
            || !(input.recycle_distance > 0.0)
            || contact.revisions != sides.revisions()
            || (fastest > frozen.prediction && frozen.prediction < sides.prediction())
            // A point and a half-space: neither has a reach.
            || max(reaches[0].extent, reaches[1].extent) == 0.0
        {
            return false;
        }
        self.ids[self.len] = id;
        let row = &mut self.rows[self.len].numbers;
        self.len += 1;
        row.rotations = [poses[0].rotation, poses[1].rotation];
        row.frozen = frozen.rotations;
        row.offset = frozen.offset;
        row.offset_now = sides.offset();
        row.prediction = frozen.prediction;
        row.extents = [reaches[0].extent, reaches[1].extent];
        row.turning = [reaches[0].turning, reaches[1].turning];
        let m = &contact.manifold;
        row.count = f32::from(m.count);
        row.platform = platform(contact.flags);
        let may_lack = contact.flags.any(ContactFlags::COMPOSITE.union(ContactFlags::HULL));
        if usize::from(m.count) < MAX_POINTS || may_lack {
            let [a, b] = [sides.velocity(0), sides.velocity(1)];
            row.speed = (b.linear - a.linear).length();
            row.angular = [a.angular, b.angular];
            let turns = row.angular != [Angular::ZERO; 2];
            if m.count > 0 && (turns || contact.flags.has(ContactFlags::COMPOSITE)) {
                // Even a full manifold may lack points that are near.
                row.count = 1.0;
            }
        }
        if m.count > 0 {
            row.set_manifold(m);
        }
        true
    }

    /// Decides which contacts keep their manifolds, and computes their separations.
    #[inline(always)]
    pub(super) fn evaluate(&mut self, input: &NarrowPhaseInput) {
        let &NarrowPhaseInput { dt, tolerance, recycle_distance, .. } = input;
        self.evaluate_at(&Settings { dt, tolerance, recycle_distance }, Width::of(input.narrow));
    }

    /// How far the surfaces of a contact may move against each other before its manifold must be recomputed,
    /// if they do not close within a step, and how far they have moved. `place` is the contact's index in the
    /// evaluated batch.
    #[inline(always)]
    pub(super) fn ways(&self, place: usize) -> [f32; 2] {
        self.ways[place]
    }

    /// Updates a contact that keeps its manifold to the motion of its bodies; `false` if the manifold is not
    /// kept. `place` is the contact's index in the evaluated batch.
    #[inline(always)]
    pub(super) fn apply(&self, place: usize, contact: &mut Contact, extra: &mut [Manifold]) -> bool {
        let is_kept = self.kept & 1 << place != 0;
        if is_kept {
            let is_turned = self.turned & 1 << place != 0;
            follow(&mut contact.manifold, self.separations[place].0);
            if !extra.is_empty() {
                let mut row = self.rows[place].numbers;
                for m in extra.iter_mut() {
                    row.set_manifold(m);
                    follow(m, row.separations());
                }
            }
            if is_turned {
                turn(contact, extra, self.rows[place].numbers.rotations);
            }
        }
        is_kept
    }

    /// Not generic, so that it is compiled once, in this crate, where `tools/asm.sh` finds it.
    fn evaluate_at(&mut self, settings: &Settings, width: Width) {
        #[inline(never)]
        fn baseline(batch: &mut RecycleBatch, settings: &Settings) {
            batch.evaluate_wide::<F32x4>(settings);
        }
        #[cfg(target_arch = "x86_64")]
        #[target_feature(enable = "avx2")]
        fn avx2(batch: &mut RecycleBatch, settings: &Settings) {
            batch.evaluate_wide::<F32x8>(settings);
        }
        match width {
            // SAFETY: the width comes with the proof that the CPU has AVX2.
            #[cfg(target_arch = "x86_64")]
            Width::Eight(_) => unsafe { avx2(self, settings) },
            _ => baseline(self, settings),
        }
    }

    #[inline(always)]
    fn evaluate_wide<N: Lane>(&mut self, settings: &Settings) {
        const { assert!(Self::SIZE.is_multiple_of(N::WIDTH) && Self::SIZE <= u32::BITS as usize) }
        (self.kept, self.turned) = (0, 0);
        for start in (0..self.len).step_by(N::WIDTH) {
            let mut places = N::Ids::splat(0);
            (0..N::WIDTH).for_each(|i| places.set(i, (start + i) as u32));
            let numbers = RecycleRow::<N>::side_by_side(&self.rows, &places);
            let (kept, ways) = numbers.is_kept(settings);
            self.kept |= N::bits(kept) << start;
            for lane in 0..N::WIDTH {
                self.ways[start + lane] = ways.map(|way| way.get(lane));
            }
            self.turned |= N::bits(numbers.is_turned()) << start;
            N::scatter(numbers.separations(), &places, |place, quad| self.separations[place as usize] = quad);
        }
    }
}

/// Stores the present separations in the points of a manifold.
#[inline(always)]
fn follow(m: &mut Manifold, separations: [f32; 4]) {
    for (p, separation) in m.points[..usize::from(m.count)].iter_mut().zip(separations) {
        p.separation = separation;
    }
}

impl RecycleRow {
    /// Copies the numbers of a manifold.
    #[inline(always)]
    fn set_manifold(&mut self, m: &Manifold) {
        self.radii = m.radii;
        self.normal = m.normal;
        for (out, p) in self.points.iter_mut().zip(&m.points) {
            *out = RowPoint { anchor: p.anchor, frozen_separation: p.frozen_separation };
        }
    }
}

impl<N: Lane> RecycleRow<N> {
    /// Whether the bodies moved little enough against each other. Also how far their surfaces may move while
    /// nothing closes, and how far they have moved.
    ///
    /// No point of one surface moved farther against the other than `moved`. So shapes that were `prediction`
    /// apart are still `prediction - moved` apart, and stay without points until the remaining gap may close
    /// in the step.
    #[inline(always)]
    fn is_kept(&self, settings: &Settings) -> (N::Mask, [N; 2]) {
        let &Self { offset, prediction, count, extents, turning, .. } = self;
        // In world axes, the turn of each body since freezing is R Rᶠ⁻¹.
        let turns = self.turns();
        let straight = N::splat(RECYCLE_COS);
        let is_straight = N::and(straight.le(turns[0].cos_angle()), straight.le(turns[1].cos_angle()));
        // `moved` is the shift of one centre of mass in the frame of the other, plus the angle between both
        // turns times a reach. The shifting body is B, but A if B is static: a static body may be large or a
        // half-space. The reach is at least the reach of either moving body, so that normals and anchors stay
        // valid on the larger body.
        let is_a = N::and(turning[1].eq(N::ZERO), N::ZERO.lt(extents[0]));
        let frame = Rot::select(is_a, turns[1], turns[0]);
        let reach = N::select(is_a, extents[0], extents[1]).max(turning[0].max(turning[1]));
        let shift = self.change() - frame.inverse().unturn(offset);
        let angle: Angular<N> = turns[0].difference(turns[1]);
        let moved = shift.length() + N::splat(CHORD) * reach * angle.length();

        let closing = self.closing(N::splat(settings.dt));
        // The tolerance covers the velocities that forces add within the step.
        let without_points = prediction - (closing + N::splat(settings.tolerance));
        let errors = N::splat(settings.recycle_distance).min(N::splat(RECYCLE_SHARE) * smaller(extents));
        let radius = self.radii[0] + self.radii[1];
        let is_round = N::and(N::ZERO.lt(count), N::ZERO.lt(radius));
        let mut curved = radius;
        for (extent, radius) in extents.into_iter().zip(self.radii) {
            let is_flat = N::and(extent.lt(radius), N::ZERO.lt(extent));
            curved = N::select(is_flat, curved.min(extent * extent / radius), curved);
        }
        let errors = N::select(is_round, errors.min(curved * N::splat(KEPT)), errors);
        // A manifold that is not full may lack points that were too far apart. No missing point may close in
        // this step.
        let is_full = count.eq(N::splat(MAX_POINTS as f32));
        let with_points = N::select(is_full, errors, errors.min(prediction - closing));
        let allowed = N::select(count.eq(N::ZERO), without_points, with_points);
        let all =
            N::select(count.eq(N::ZERO), prediction - N::splat(settings.tolerance), errors.min(prediction));
        // A NaN fails the comparison.
        (N::and(is_straight, moved.lt(allowed)), [all, moved])
    }

    /// Whether the frozen pose turns with its platform.
    #[inline(always)]
    fn is_turned(&self) -> N::Mask {
        let is_far = N::splat(ROUNDING * ROUNDING).lt(self.platform_turn().small_turn().length_squared());
        N::and(N::and(is_far, N::ZERO.lt(self.platform)), N::ZERO.lt(self.count))
    }

    /// The platform's turn since freezing, if there is one.
    #[inline(always)]
    fn platform_turn(&self) -> Rot<N> {
        let [a, b] = self.turns();
        Rot::select(self.platform.eq(N::splat(PLATFORM_B)), b, a)
    }

    /// The turn of each body since freezing, in world axes.
    #[inline(always)]
    fn turns(&self) -> [Rot<N>; 2] {
        let ([a, b], [frozen_a, frozen_b]) = (self.rotations, self.frozen);
        [a.mul(frozen_a.inverse()), b.mul(frozen_b.inverse())]
    }

    /// The shift of B's centre of mass against A's since freezing.
    #[inline(always)]
    fn change(&self) -> Vector<N> {
        self.offset_now - self.offset
    }

    /// The distance that the surfaces may close in `dt` seconds, in metres.
    #[inline(always)]
    fn closing(&self, dt: N) -> N {
        let far = self.offset.length();
        let arm = |side: usize| {
            let own = self.extents[side];
            // A half-space has no reach: it may touch anywhere that the other shape is.
            N::select(N::ZERO.lt(own), own, far + self.extents[1 - side])
        };
        let turning = arm(0) * self.angular[0].length() + arm(1) * self.angular[1].length();
        (self.speed + turning) * dt
    }

    /// The present separations: s = s₀ + n · (Δ + (Q_B − 1) r_B − (Q_A − 1) r_A), where Q are the turns
    /// of the bodies and Δ is the shift of B's centre of mass, both seen from the frozen pose, which may
    /// turn as a whole.
    #[inline(always)]
    fn separations(&self) -> [N; 4] {
        let frame = Rot::select(self.is_turned(), self.platform_turn(), Rot::IDENTITY);
        let normal = self.normal;
        let along = (self.change() + frame.unturn(self.offset_now)).dot(normal);
        let cores = [normal * self.radii[0], self.offset - normal * self.radii[1]];
        // n · (Q r − r) = (Q⁻¹ n − n) · r, where only r differs from point to point. Without `map`: a closure
        // that is not inlined here makes a call of each lane operation.
        let [turn_a, turn_b] = self.turns();
        let back = frame.inverse();
        let leans = [back.mul(turn_a).unturn(normal), back.mul(turn_b).unturn(normal)];
        let mut all = [N::ZERO; 4];
        for (out, p) in all.iter_mut().zip(&self.points) {
            let turn = leans[1].dot(p.anchor - cores[1]) - leans[0].dot(p.anchor - cores[0]);
            *out = p.frozen_separation + along + turn;
        }
        all
    }
}

/// The platform of a contact, as a number in a row.
#[inline(always)]
fn platform(flags: ContactFlags) -> f32 {
    if flags.has(ContactFlags::PLATFORM_A) {
        PLATFORM_A
    } else if flags.has(ContactFlags::PLATFORM_B) {
        PLATFORM_B
    } else {
        NO_PLATFORM
    }
}

/// Turns the frozen pose of a contact and its manifolds with the platform. `rotations` are the present
/// rotations of both bodies.
#[inline(never)]
fn turn(contact: &mut Contact, extra: &mut [Manifold], rotations: [Rot; 2]) {
    let own = usize::from(contact.flags.has(ContactFlags::PLATFORM_B));
    let frozen = &mut contact.frozen;
    let turn = rotations[own].mul(frozen.rotations[own].inverse()).renormalized();
    frozen.rotations[own] = rotations[own];
    frozen.rotations[1 - own] = turn.mul(frozen.rotations[1 - own]).renormalized();
    frozen.offset = turn.turn_little(frozen.offset);
    for m in core::iter::once(&mut contact.manifold).chain(extra) {
        m.normal = turn.turn_little(m.normal);
        m.friction_impulse = turn.turn_little(m.friction_impulse);
        for p in &mut m.points[..usize::from(m.count)] {
            p.anchor = turn.turn_little(p.anchor);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::{prelude::*, strategy::ValueTree, test_runner::TestRunner};

    const SETTINGS: Settings = Settings { dt: 1.0 / 60.0, tolerance: 0.005, recycle_distance: 0.05 };

    impl PackedRow {
        fn floats(&mut self) -> &mut [f32; 4 * QUADS] {
            // SAFETY: a row consists of floats without padding.
            unsafe { &mut *core::ptr::from_mut(self).cast() }
        }

        /// With NaN in all numbers that are unset.
        fn with_unset(mut self) -> Self {
            let nan = Vector::ONE * f32::NAN;
            if self.numbers.count == 0.0 {
                self.numbers.radii = [f32::NAN; 2];
                self.numbers.normal = nan;
                self.numbers.points = [RowPoint { anchor: nan, frozen_separation: f32::NAN }; MAX_POINTS];
            }
            if self.numbers.count == MAX_POINTS as f32 {
                self.numbers.speed = f32::NAN;
                self.numbers.angular = [Angular::ZERO * f32::NAN; 2];
            }
            self
        }
    }

    /// Rows that keep the manifold and rows that do not, half-spaces among them, some with a NaN.
    fn row() -> impl Strategy<Value = PackedRow> {
        let noise = prop_oneof![40 => Just(0.0), 20 => -0.005..0.005f32, 1 => -1.0..1.0f32];
        let noise = prop::collection::vec(noise, FLOATS);
        let count = prop::sample::select(vec![0.0, 1.0, MAX_POINTS as f32]);
        let reach = || prop_oneof![1 => Just(0.0), 4 => 0.1..2.0f32];
        let platform = prop::sample::select(vec![PLATFORM_A, PLATFORM_B, NO_PLATFORM]);
        (noise, (count, platform), [reach(), reach()], any::<bool>(), 0..20 * FLOATS).prop_map(
            |(noise, (count, platform), extents, is_a_static, odd)| {
                let numbers = RecycleRow {
                    offset: Vector::Y,
                    offset_now: Vector::Y,
                    prediction: 0.02,
                    normal: Vector::Y,
                    ..RecycleRow::default()
                };
                let mut row = PackedRow { numbers, ..PackedRow::default() };
                row.floats().iter_mut().zip(noise).for_each(|(float, noise)| *float += noise);
                row.numbers.count = count;
                row.numbers.platform = platform;
                row.numbers.extents = extents;
                row.numbers.turning = extents;
                row.numbers.turning[usize::from(is_a_static)] = 0.0;
                if let Some(float) = row.floats()[..FLOATS].get_mut(odd) {
                    *float = f32::NAN;
                }
                row
            },
        )
    }

    fn batch(rows: &[PackedRow], dirt: PackedRow) -> RecycleBatch {
        let mut batch = RecycleBatch {
            rows: [dirt; RecycleBatch::SIZE],
            len: rows.len(),
            kept: u32::MAX,
            ..RecycleBatch::default()
        };
        batch.rows[..rows.len()].copy_from_slice(rows);
        batch
    }

    proptest! {
        /// Results are bit-identical with any width, other rows in the batch, and previous content of unused
        /// rows.
        #[test]
        fn side_by_side_is_as_alone(rows in prop::collection::vec(row(), 1..=RecycleBatch::SIZE), dirt in row()) {
            for width in [Width::default(), Width::Four] {
                let mut batch = batch(&rows, dirt);
                batch.evaluate_at(&SETTINGS, width);
                for (place, row) in rows.iter().enumerate() {
                    let kept = batch.kept & 1 << place != 0;
                    prop_assert_eq!(row.numbers.is_kept(&SETTINGS).0, kept);
                    prop_assert_eq!(row.with_unset().numbers.is_kept(&SETTINGS).0, kept);
                    prop_assert_eq!(row.numbers.is_turned(), batch.turned & 1 << place != 0);
                    for (alone, beside) in row.numbers.separations().into_iter().zip(batch.separations[place].0) {
                        prop_assert!(alone.to_bits() == beside.to_bits() || alone.is_nan() && beside.is_nan());
                    }
                }
            }
        }
    }

    /// The property above draws rows that are kept and rows that are not, with any number of points.
    #[test]
    fn rows_differ() {
        let mut runner = TestRunner::deterministic();
        for count in [0.0, 1.0, MAX_POINTS as f32] {
            let rows = (0..1000).map(|_| row().new_tree(&mut runner).expect("nothing is filtered").current());
            let mut rows: Vec<PackedRow> = rows.collect();
            rows.iter_mut().for_each(|row| row.numbers.count = count);
            let kept = rows.iter().filter(|row| row.numbers.is_kept(&SETTINGS).0).count();
            assert!((100..900).contains(&kept), "{kept} of 1000 with {count} points");
        }
    }

    /// A NaN in a present or frozen pose does not keep a manifold.
    #[test]
    fn nan_is_not_kept() {
        let numbers = RecycleRow {
            offset: Vector::Y,
            offset_now: Vector::Y,
            prediction: 0.02,
            extents: [1.0; 2],
            turning: [1.0; 2],
            count: MAX_POINTS as f32,
            normal: Vector::Y,
            ..RecycleRow::default()
        };
        let good = PackedRow { numbers, ..PackedRow::default() };
        assert!(good.numbers.is_kept(&SETTINGS).0);
        for odd in 0..core::mem::offset_of!(RecycleRow, prediction) / size_of::<f32>() {
            let mut row = good;
            row.floats()[odd] = f32::NAN;
            assert!(!row.numbers.is_kept(&SETTINGS).0, "{odd}");
        }
    }
}
