//! Recycling, of several contacts side by side.
//!
//! It is Erin Catto's (Box2D v3.2, Box3D; both ask to be cited for it): while two bodies have hardly moved relative to
//! each other since their manifold was computed, its normal, anchors and features are kept and only the separations
//! follow the motion. The frozen pose is not renewed by that, so errors cannot add up. Besides the time saved, frozen
//! anchors are what lets tall towers stand.
//!
//! Decision: on a platform, which is a body that contacts do not turn, the frozen pose turns as a whole with it: normal,
//! anchors and rotations. Only rounding adds up, as a random walk. Between dynamic bodies it does not turn: where normals
//! follow every little turn, a tower of 50 boxes leans ever further and falls.
//!
//! In a scene at rest nearly all contacts are recycled, and each by the same arithmetic. So [`ask`](NarrowPhase::ask)
//! lays out in a row what it needs, and [`answer`](NarrowPhase::answer) computes with as many rows side by side as a
//! lane has floats.
#![expect(unsafe_code, reason = "rows of numbers are turned into lanes of numbers")]

use super::phase::{NarrowPhase, smaller};
use super::record::{Contact, ContactFlags};
#[cfg(target_arch = "x86_64")]
use crate::math::F32x8;
use crate::math::{Angular, F32x4, Ids, Lane, MAX_POINTS, Num, Quad, Rot, Vector, Width, max};
use crate::table::BodyPose;
use core::mem::MaybeUninit;

/// The manifold of small bodies is recycled over this share of the smaller one's reach at most.
const RECYCLE_SHARE: f32 = 0.25;

/// Bodies that turned further than this since the manifold was computed do not recycle: cos 10°.
const RECYCLE_COS: f32 = 0.985;

/// The frozen pose is left alone while the platform turned by less than this since, in radians. A frictionless body
/// slides on it as on a plane that is tilted by that angle less.
const UNTURNED: f32 = 2.0e-5;

/// Which body of a contact is a platform, as a number in a row.
const NO_PLATFORM: f32 = 0.0;
const PLATFORM_A: f32 = 1.0;
const PLATFORM_B: f32 = 2.0;

/// By how much the chord of an angle of twice that may be longer than [`small_turn`](Rot::small_turn) says.
const CHORD: f32 = 1.016;

/// What recycling asks of a contact, or of several side by side: the numbers are in the same order.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C)]
struct Asked<N: Num = f32> {
    /// The rotations of A and B.
    rotations: [Rot<N>; 2],
    /// The same when the contact was frozen.
    frozen: [Rot<N>; 2],
    /// From A's to B's centre of mass when the contact was frozen.
    offset: Vector<N>,
    /// From A's to B's centre of mass.
    offset_now: Vector<N>,
    /// As in [`Frozen`](super::Frozen).
    prediction: N,
    /// As in [`Reach`](crate::table::Reach).
    extents: [N; 2],
    /// As in [`Reach`](crate::table::Reach).
    turning: [N; 2],
    /// How many points there are.
    count: N,
    /// [`PLATFORM_A`], [`PLATFORM_B`] or [`NO_PLATFORM`].
    platform: N,
    /// How fast B moves against A. Stale if all points there can be are there.
    speed: N,
    /// The angular velocities. Stale if all points there can be are there.
    angular: [Angular<N>; 2],
    /// As in [`Manifold`](super::Manifold); stale if there are no points, as is what follows.
    rounding: [N; 2],
    normal: Vector<N>,
    points: [AskedPoint<N>; MAX_POINTS],
}

#[derive(Clone, Copy, Debug, Default)]
#[repr(C)]
struct AskedPoint<N: Num> {
    anchor: Vector<N>,
    frozen_separation: N,
}

const FLOATS: usize = size_of::<Asked>() / size_of::<f32>();
const QUADS: usize = FLOATS.div_ceil(4);

/// What is asked of one contact, as quads.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C, align(16))]
struct Row {
    asked: Asked,
    unused: [f32; 4 * QUADS - FLOATS],
}

impl Row {
    #[inline(always)]
    fn quads(&self) -> &[Quad; QUADS] {
        const { assert!(size_of::<Row>() == size_of::<[Quad; QUADS]>()) }
        // SAFETY: both are as many floats without anything between, as strictly aligned.
        unsafe { &*core::ptr::from_ref(self).cast() }
    }
}

impl<N: Lane> Asked<N> {
    /// The rows at some places side by side.
    #[inline(always)]
    fn side_by_side(rows: &[Row; Group::SIZE], places: &N::Ids) -> Self {
        const { assert!(size_of::<Self>() == FLOATS * size_of::<N>()) }
        let mut lanes = MaybeUninit::<[[N; 4]; QUADS]>::uninit();
        for quad in 0..QUADS {
            let four = N::gather(places, |place| &rows[place as usize].quads()[quad]);
            // SAFETY: one of the `QUADS` that there is room for.
            unsafe { lanes.as_mut_ptr().cast::<[N; 4]>().add(quad).write(four) };
        }
        // SAFETY: all are written, and `Self` is the first `FLOATS` of them in order: `repr(C)`, of nothing but `N`.
        unsafe { lanes.as_ptr().cast::<Self>().read() }
    }
}

/// What is the same for all contacts; as in [`NarrowPhase`].
#[derive(Clone, Copy)]
struct Terms {
    dt: f32,
    tolerance: f32,
    recycle_distance: f32,
}

/// Contacts that are asked about together, and what was found.
#[derive(Clone, Debug, Default)]
pub(super) struct Group {
    rows: [Row; Self::SIZE],
    ids: [u32; Self::SIZE],
    len: usize,
    /// Which keep their manifolds, as bits.
    kept: u32,
    /// Which have a frozen pose that is to be turned if they do.
    turned: u32,
    /// How far the points of each are apart now.
    separations: [Quad; Self::SIZE],
}

impl Group {
    /// So many fit in: two of the widest lanes.
    const SIZE: usize = 16;

    pub(super) fn clear(&mut self) {
        self.len = 0;
    }

    #[inline(always)]
    pub(super) fn is_full(&self) -> bool {
        self.len == Self::SIZE
    }

    /// The contacts asked about, in order.
    #[inline(always)]
    pub(super) fn ids(&self) -> &[u32] {
        &self.ids[..self.len]
    }

    /// Whether a contact keeps its manifold; if so, has it follow the motion of its bodies. `place` is how many were
    /// asked about before it.
    #[inline(always)]
    pub(super) fn apply(&self, place: usize, contact: &mut Contact) -> bool {
        let is_kept = self.kept & 1 << place != 0;
        if is_kept {
            if self.turned & 1 << place != 0 {
                turn(contact, self.rows[place].asked.rotations);
            }
            let m = &mut contact.manifold;
            for (p, separation) in m.points[..m.count as usize].iter_mut().zip(self.separations[place].0) {
                p.separation = separation;
            }
        }
        is_kept
    }

    /// Not generic, so that it is compiled here, once, where its assembly can be looked at.
    fn answer(&mut self, terms: &Terms, width: Width) {
        #[inline(never)]
        fn baseline(group: &mut Group, terms: &Terms) {
            group.answer_wide::<F32x4>(terms);
        }
        #[cfg(target_arch = "x86_64")]
        #[target_feature(enable = "avx2")]
        fn avx2(group: &mut Group, terms: &Terms) {
            group.answer_wide::<F32x8>(terms);
        }
        match width {
            // SAFETY: the width comes with the proof that the CPU has AVX2.
            #[cfg(target_arch = "x86_64")]
            Width::Eight(_) => unsafe { avx2(self, terms) },
            _ => baseline(self, terms),
        }
    }

    #[inline(always)]
    fn answer_wide<N: Lane>(&mut self, terms: &Terms) {
        const { assert!(Self::SIZE.is_multiple_of(N::WIDTH) && Self::SIZE <= u32::BITS as usize) }
        (self.kept, self.turned) = (0, 0);
        for start in (0..self.len).step_by(N::WIDTH) {
            let mut places = N::Ids::splat(0);
            (0..N::WIDTH).for_each(|i| places.set(i, (start + i) as u32));
            let asked = Asked::<N>::side_by_side(&self.rows, &places);
            self.kept |= N::bits(asked.is_kept(terms)) << start;
            self.turned |= N::bits(asked.is_turned()) << start;
            N::scatter(asked.separations(), &places, |place, quad| self.separations[place as usize] = quad);
        }
    }
}

impl<S> NarrowPhase<'_, S> {
    /// Adds to a group that is not full what decides whether a contact keeps its manifold; `false` if it does not.
    #[inline(always)]
    pub(super) fn ask(&self, id: u32, contact: &Contact, poses: [&BodyPose; 2], group: &mut Group) -> bool {
        let reaches = self.reaches(contact);
        let frozen = &contact.frozen;
        // Neither can close faster than both together: that settles it without asking for the velocities
        // of all but fast bodies.
        let fastest = (poses[0].speed + poses[1].speed) * self.dt;
        if !contact.flags.has(ContactFlags::FROZEN)
            || !(self.recycle_distance > 0.0)
            || contact.revisions != self.revisions(contact, poses)
            || (fastest > frozen.prediction && frozen.prediction < self.prediction(contact))
            // A point and a half-space: nobody reaches anywhere.
            || max(reaches[0].extent, reaches[1].extent) == 0.0
        {
            return false;
        }
        group.ids[group.len] = id;
        let row = &mut group.rows[group.len].asked;
        group.len += 1;
        row.rotations = [poses[0].rotation, poses[1].rotation];
        row.frozen = frozen.rotations;
        row.offset = frozen.offset;
        row.offset_now = (poses[1].center - poses[0].center).to_local();
        row.prediction = frozen.prediction;
        row.extents = [reaches[0].extent, reaches[1].extent];
        row.turning = [reaches[0].turning, reaches[1].turning];
        // Only native pairs are recycled, which have no manifolds after the first.
        let m = &contact.manifold;
        row.count = m.count as f32;
        row.platform = platform(contact.flags);
        if m.count < MAX_POINTS as u32 {
            let [a, b] = [self.velocity(contact, 0), self.velocity(contact, 1)];
            row.speed = (b.linear - a.linear).length();
            row.angular = [a.angular, b.angular];
        }
        if m.count > 0 {
            row.rounding = m.rounding;
            row.normal = m.normal;
            for (out, p) in row.points.iter_mut().zip(&m.points) {
                *out = AskedPoint { anchor: p.anchor, frozen_separation: p.frozen_separation };
            }
        }
        true
    }

    /// Finds out which contacts of a group keep their manifolds.
    #[inline(always)]
    pub(super) fn answer(&self, group: &mut Group) {
        let &Self { dt, tolerance, recycle_distance, .. } = self;
        group.answer(&Terms { dt, tolerance, recycle_distance }, Width::of(self.narrow));
    }
}

impl<N: Lane> Asked<N> {
    /// Whether the bodies moved little enough against each other.
    ///
    /// No point of one surface moved further against the other than `moved`. So of shapes that were `prediction` apart none
    /// can be nearer than what is left of it; they are not looked at until that may close in the step.
    #[inline(always)]
    fn is_kept(&self, terms: &Terms) -> N::Mask {
        let &Self { offset, prediction, count, extents, turning, .. } = self;
        // In world axes: how far each turned since freezing, R Rᶠ⁻¹, and how far B's centre of mass shifted against A's.
        let turns = self.turns();
        let straight = N::splat(RECYCLE_COS);
        let is_straight = N::and(straight.le(turns[0].cos_angle()), straight.le(turns[1].cos_angle()));
        // How far the centre of one shifted in the frame of the other, which length is the same in world axes, and
        // the angle between how far each turned, times the reach of the one that shifted: B, but A if B is static, for
        // that may be large and its centre far off, or a half-space, which has no end. Not less than the reach of
        // either that moves, so that normals and anchors do not grow old on the larger.
        let is_a = N::and(turning[1].eq(N::ZERO), N::ZERO.lt(extents[0]));
        let frame = Rot::select(is_a, turns[1], turns[0]);
        let reach = N::select(is_a, extents[0], extents[1]).max(turning[0].max(turning[1]));
        let shift = self.change() - frame.inverse().unturn(offset);
        let angle: Angular<N> = turns[0].difference(turns[1]);
        let moved = shift.length() + N::splat(CHORD) * reach * angle.length();

        let closing = self.closing(N::splat(terms.dt));
        let without_points = prediction - closing.max(N::splat(terms.tolerance));
        let errors = N::splat(terms.recycle_distance).min(N::splat(RECYCLE_SHARE) * smaller(extents));
        // Points may be missing that were too far apart to be found; none of them may close in this step.
        let is_full = count.eq(N::splat(MAX_POINTS as f32));
        let with_points = N::select(is_full, errors, errors.min(prediction - closing));
        let allowed = N::select(count.eq(N::ZERO), without_points, with_points);
        // A NaN fails the comparison.
        N::and(is_straight, moved.lt(allowed))
    }

    /// Whether the frozen pose is to be turned.
    #[inline(always)]
    fn is_turned(&self) -> N::Mask {
        let is_far = N::splat(UNTURNED * UNTURNED).lt(self.platform_turn().small_turn().length_squared());
        N::and(N::and(is_far, N::ZERO.lt(self.platform)), N::ZERO.lt(self.count))
    }

    /// How far the platform turned, if there is one.
    #[inline(always)]
    fn platform_turn(&self) -> Rot<N> {
        let [a, b] = self.turns();
        Rot::select(self.platform.eq(N::splat(PLATFORM_B)), b, a)
    }

    /// How far each body turned since freezing, in world axes.
    #[inline(always)]
    fn turns(&self) -> [Rot<N>; 2] {
        let ([a, b], [frozen_a, frozen_b]) = (self.rotations, self.frozen);
        [a.mul(frozen_a.inverse()), b.mul(frozen_b.inverse())]
    }

    /// How far B's centre of mass shifted against A's since freezing.
    #[inline(always)]
    fn change(&self) -> Vector<N> {
        self.offset_now - self.offset
    }

    /// How far the surfaces may close in `dt` seconds, in metres.
    #[inline(always)]
    fn closing(&self, dt: N) -> N {
        let far = self.offset.length();
        let arm = |side: usize| {
            let own = self.extents[side];
            // A half-space turns as far out as the other is.
            N::select(N::ZERO.lt(own), own, far + self.extents[1 - side])
        };
        let turning = arm(0) * self.angular[0].length() + arm(1) * self.angular[1].length();
        (self.speed + turning) * dt
    }

    /// How far apart the points are now: s = s₀ + n · (Δ + (Q_B − 1) r_B − (Q_A − 1) r_A), where Q are the turns of the
    /// bodies and Δ how far B's centre of mass shifted, all as seen from the frozen pose, which may turn as a whole.
    #[inline(always)]
    fn separations(&self) -> [N; 4] {
        let frame = Rot::select(self.is_turned(), self.platform_turn(), Rot::IDENTITY);
        let normal = self.normal;
        let along = (self.change() + frame.unturn(self.offset_now)).dot(normal);
        let cores = [normal * self.rounding[0], self.offset - normal * self.rounding[1]];
        // n · (Q r − r) = (Q⁻¹ n − n) · r, of which only r differs from point to point.
        let leans = self.turns().map(|turn| frame.inverse().mul(turn).unturn(normal));
        let mut all = [N::ZERO; 4];
        for (out, p) in all.iter_mut().zip(&self.points) {
            let turn = leans[1].dot(p.anchor - cores[1]) - leans[0].dot(p.anchor - cores[0]);
            *out = p.frozen_separation + along + turn;
        }
        all
    }
}

/// Which body is a platform.
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

/// Turns the frozen pose of a contact, and what was computed there, with the platform.
/// `rotations` are those of both bodies now.
#[inline(never)]
fn turn(contact: &mut Contact, rotations: [Rot; 2]) {
    let own = usize::from(contact.flags.has(ContactFlags::PLATFORM_B));
    let frozen = &mut contact.frozen;
    let turn = rotations[own].mul(frozen.rotations[own].inverse()).renormalized();
    frozen.rotations[own] = rotations[own];
    frozen.rotations[1 - own] = turn.mul(frozen.rotations[1 - own]).renormalized();
    frozen.offset = turn.turn_little(frozen.offset);
    let m = &mut contact.manifold;
    m.normal = turn.turn_little(m.normal);
    m.friction_impulse = turn.turn_little(m.friction_impulse);
    for p in &mut m.points[..m.count as usize] {
        p.anchor = turn.turn_little(p.anchor);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::{prelude::*, strategy::ValueTree, test_runner::TestRunner};

    const TERMS: Terms = Terms { dt: 1.0 / 60.0, tolerance: 0.005, recycle_distance: 0.05 };

    impl Row {
        fn floats(&mut self) -> &mut [f32; 4 * QUADS] {
            // SAFETY: a row is so many floats, without anything between.
            unsafe { &mut *core::ptr::from_mut(self).cast() }
        }

        /// With NaN wherever the number may be stale.
        fn stale(mut self) -> Self {
            let nan = Vector::ONE * f32::NAN;
            if self.asked.count == 0.0 {
                self.asked.rounding = [f32::NAN; 2];
                self.asked.normal = nan;
                self.asked.points = [AskedPoint { anchor: nan, frozen_separation: f32::NAN }; MAX_POINTS];
            }
            if self.asked.count == MAX_POINTS as f32 {
                self.asked.speed = f32::NAN;
                self.asked.angular = [Angular::ZERO * f32::NAN; 2];
            }
            self
        }
    }

    /// Rows near one of which the manifold is kept, and far from it; of half-spaces too; with a NaN anywhere.
    fn row() -> impl Strategy<Value = Row> {
        let noise = prop_oneof![40 => Just(0.0), 20 => -0.005..0.005f32, 1 => -1.0..1.0f32];
        let noise = prop::collection::vec(noise, FLOATS);
        let count = prop::sample::select(vec![0.0, 1.0, MAX_POINTS as f32]);
        let reach = || prop_oneof![1 => Just(0.0), 4 => 0.1..2.0f32];
        let platform = prop::sample::select(vec![PLATFORM_A, PLATFORM_B, NO_PLATFORM]);
        (noise, (count, platform), [reach(), reach()], any::<bool>(), 0..20 * FLOATS).prop_map(
            |(noise, (count, platform), extents, is_a_static, odd)| {
                let asked = Asked {
                    offset: Vector::Y,
                    offset_now: Vector::Y,
                    prediction: 0.02,
                    normal: Vector::Y,
                    ..Asked::default()
                };
                let mut row = Row { asked, ..Row::default() };
                row.floats().iter_mut().zip(noise).for_each(|(float, noise)| *float += noise);
                row.asked.count = count;
                row.asked.platform = platform;
                row.asked.extents = extents;
                row.asked.turning = extents;
                row.asked.turning[usize::from(is_a_static)] = 0.0;
                if let Some(float) = row.floats()[..FLOATS].get_mut(odd) {
                    *float = f32::NAN;
                }
                row
            },
        )
    }

    fn group(rows: &[Row], dirt: Row) -> Group {
        let mut group =
            Group { rows: [dirt; Group::SIZE], len: rows.len(), kept: u32::MAX, ..Group::default() };
        group.rows[..rows.len()].copy_from_slice(rows);
        group
    }

    proptest! {
        /// What is found of a contact is the same bits with any width, whatever stands beside it, and does not depend on
        /// what a row held before.
        #[test]
        fn side_by_side_is_as_alone(rows in prop::collection::vec(row(), 1..=Group::SIZE), dirt in row()) {
            for width in [Width::default(), Width::Four] {
                let mut group = group(&rows, dirt);
                group.answer(&TERMS, width);
                for (place, row) in rows.iter().enumerate() {
                    let kept = group.kept & 1 << place != 0;
                    prop_assert_eq!(row.asked.is_kept(&TERMS), kept);
                    prop_assert_eq!(row.stale().asked.is_kept(&TERMS), kept);
                    prop_assert_eq!(row.asked.is_turned(), group.turned & 1 << place != 0);
                    for (alone, beside) in row.asked.separations().into_iter().zip(group.separations[place].0) {
                        prop_assert!(alone.to_bits() == beside.to_bits() || alone.is_nan() && beside.is_nan());
                    }
                }
            }
        }
    }

    /// Of the rows of the property above some are kept and some are not, with any number of points.
    #[test]
    fn rows_differ() {
        let mut runner = TestRunner::deterministic();
        for count in [0.0, 1.0, MAX_POINTS as f32] {
            let rows = (0..1000).map(|_| row().new_tree(&mut runner).expect("nothing is filtered").current());
            let mut rows: Vec<Row> = rows.collect();
            rows.iter_mut().for_each(|row| row.asked.count = count);
            let kept = rows.iter().filter(|row| row.asked.is_kept(&TERMS)).count();
            assert!((100..900).contains(&kept), "{kept} of 1000 with {count} points");
        }
    }

    /// A NaN where a body is, or how it was, is no reason to keep a manifold.
    #[test]
    fn nan_is_not_kept() {
        let asked = Asked {
            offset: Vector::Y,
            offset_now: Vector::Y,
            prediction: 0.02,
            extents: [1.0; 2],
            turning: [1.0; 2],
            count: MAX_POINTS as f32,
            normal: Vector::Y,
            ..Asked::default()
        };
        let good = Row { asked, ..Row::default() };
        assert!(good.asked.is_kept(&TERMS));
        for odd in 0..core::mem::offset_of!(Asked, prediction) / size_of::<f32>() {
            let mut row = good;
            row.floats()[odd] = f32::NAN;
            assert!(!row.asked.is_kept(&TERMS), "{odd}");
        }
    }
}
