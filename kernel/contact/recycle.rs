//! Recycling, of several contacts side by side.
//!
//! It is Erin Catto's (Box2D v3.2, Box3D; both ask to be cited for it): while two bodies have hardly moved relative to
//! each other since their manifold was computed, its normal, anchors and features are kept and only the separations
//! follow the motion. The frozen pose is not renewed by that, so errors cannot add up. Besides the time saved, frozen
//! anchors are what lets tall towers stand.
//!
//! In a scene at rest nearly all contacts are recycled, and each by the same arithmetic. So [`ask`](NarrowPhase::ask)
//! lays out what it needs, and [`answer`](NarrowPhase::answer) computes it for as many contacts at once as a lane has.
#![expect(unsafe_code, reason = "rows of numbers are turned into lanes of numbers")]

use super::record::{Contact, ContactFlags};
use super::update::{ManifoldSource, NarrowPhase};
#[cfg(target_arch = "x86_64")]
use crate::math::F32x8;
use crate::math::{Angular, F32x4, Ids, Lane, MAX_POINTS, Num, Quad, Rot, Vector, Width, max};
use crate::table::BodyPose;
use core::mem::MaybeUninit;

/// The manifold of small bodies is recycled over this share of the smaller one's reach at most.
const RECYCLE_SHARE: f32 = 0.25;

/// Bodies that turned further than this since the manifold was computed do not recycle: cos 10°.
const RECYCLE_COS: f32 = 0.985;

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
    apart: Vector<N>,
    /// B's velocity against A's. Any number if all points there can be are there.
    linear: Vector<N>,
    /// The angular velocities. Any number if all points there can be are there.
    angular: [Angular<N>; 2],
    prediction: N,
    /// How many points there are; if none, all below may be any number.
    count: N,
    /// How far the shapes reach, and how far that moves them for each radian.
    extents: [N; 2],
    turning: [N; 2],
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
    /// The rows of some ids side by side.
    #[inline(always)]
    fn side_by_side(rows: &[Row], ids: &N::Ids) -> Self {
        const { assert!(size_of::<Self>() == FLOATS * size_of::<N>()) }
        let mut lanes = MaybeUninit::<[[N; 4]; QUADS]>::uninit();
        for quad in 0..QUADS {
            let four = N::gather(ids, |row| &rows[row as usize].quads()[quad]);
            // SAFETY: one of the `QUADS` that there is room for.
            unsafe { lanes.as_mut_ptr().cast::<[N; 4]>().add(quad).write(four) };
        }
        // SAFETY: all are written, and `Self` is the first `FLOATS` of them in order: `repr(C)`, of nothing but `N`.
        unsafe { lanes.as_ptr().cast::<Self>().read() }
    }
}

/// Contacts that are asked about together.
#[derive(Clone, Debug, Default)]
pub(super) struct Group {
    rows: [Row; Self::SIZE],
    len: usize,
}

/// Which contacts of a [`Group`] keep their manifold, as bits, and how far the points of each are apart now.
pub(super) struct Answer {
    kept: u32,
    separations: [Quad; Group::SIZE],
}

impl Group {
    /// So many fit in.
    pub(super) const SIZE: usize = 16;

    pub(super) fn len(&self) -> usize {
        self.len
    }

    pub(super) fn clear(&mut self) {
        self.len = 0;
    }
}

impl Answer {
    /// Has a contact's separations follow the motion of its bodies, if it keeps its manifold. `place` is how many were
    /// asked about before it.
    #[inline(always)]
    pub(super) fn apply(&self, place: usize, contact: &mut Contact) -> bool {
        let kept = self.kept & 1 << place != 0;
        if kept {
            let m = &mut contact.manifold;
            for (p, separation) in m.points[..m.count as usize].iter_mut().zip(self.separations[place].0) {
                p.separation = separation;
            }
        }
        kept
    }
}

impl<S: ManifoldSource> NarrowPhase<'_, S> {
    /// Adds to a group with room left what decides whether a contact keeps its manifold; `false` if it does not.
    #[inline(always)]
    pub(super) fn ask(&self, contact: &Contact, poses: [&BodyPose; 2], group: &mut Group) -> bool {
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
        let row = &mut group.rows[group.len].asked;
        group.len += 1;
        row.rotations = [poses[0].rotation, poses[1].rotation];
        row.frozen = frozen.rotations;
        row.offset = frozen.offset;
        row.apart = (poses[1].center - poses[0].center).to_local();
        row.prediction = frozen.prediction;
        row.extents = [reaches[0].extent, reaches[1].extent];
        row.turning = [reaches[0].turning, reaches[1].turning];
        // Only native pairs are recycled, which have no manifolds after the first.
        let m = &contact.manifold;
        row.count = m.count as f32;
        if m.count < MAX_POINTS as u32 {
            let [a, b] = [self.velocity(contact, 0), self.velocity(contact, 1)];
            row.linear = b.linear - a.linear;
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

    /// Finds out which contacts of a group keep their manifolds, and empties it.
    pub(super) fn answer(&self, group: &mut Group) -> Answer {
        let len = core::mem::take(&mut group.len);
        match if self.narrow { Width::Four } else { Width::default() } {
            #[cfg(target_arch = "x86_64")]
            Width::Eight => {
                #[target_feature(enable = "avx2")]
                fn avx2<S: ManifoldSource>(phase: &NarrowPhase<S>, rows: &[Row], len: usize) -> Answer {
                    phase.answer_wide::<F32x8>(rows, len)
                }
                // SAFETY: this CPU has it.
                unsafe { avx2(self, &group.rows, len) }
            }
            _ => self.answer_wide::<F32x4>(&group.rows, len),
        }
    }

    #[inline(always)]
    fn answer_wide<N: Lane>(&self, rows: &[Row], len: usize) -> Answer {
        let mut answer = Answer { kept: 0, separations: [Quad::default(); Group::SIZE] };
        for start in (0..len).step_by(N::WIDTH) {
            let mut ids = N::Ids::splat(0);
            (0..N::WIDTH).for_each(|i| ids.set(i, (start + i) as u32));
            let asked = Asked::<N>::side_by_side(rows, &ids);
            answer.kept |= N::bits(self.is_kept(&asked)) << start;
            N::scatter(asked.separations(), &ids, |row, quad| answer.separations[row as usize] = quad);
        }
        answer
    }

    /// Whether the bodies moved little enough against each other.
    ///
    /// No point of one surface moved further against the other than `moved`. So of shapes that were `prediction` apart none
    /// can be nearer than what is left of it; they are not looked at until that may close in the step.
    #[inline(always)]
    fn is_kept<N: Lane>(&self, asked: &Asked<N>) -> N::Mask {
        let &Asked { offset, prediction, count, extents, turning, .. } = asked;
        // In world axes: how far each turned since freezing, R Rᶠ⁻¹, and how far B's centre of mass shifted against A's.
        let turns = asked.turns();
        let straight = N::splat(RECYCLE_COS);
        let is_straight = N::and(straight.le(turns[0].cos_angle()), straight.le(turns[1].cos_angle()));
        // How far the centre of one shifted in the frame of the other, which length is the same in world axes, and
        // the angle between how far each turned, times the reach of the one that shifted: B, but A if B is static, for
        // that may be large and its centre far off, or a half-space, which has no end. Not less than the reach of
        // either that moves, so that normals and anchors do not grow old on the larger.
        let is_a = N::and(turning[1].eq(N::ZERO), N::ZERO.lt(extents[0]));
        let frame = Rot::select(is_a, turns[1], turns[0]);
        let reach = N::select(is_a, extents[0], extents[1]).max(turning[0].max(turning[1]));
        let shift = asked.change() - frame.inverse().unturn(offset);
        let angle: Angular<N> = turns[0].difference(turns[1]);
        let moved = shift.length() + N::splat(CHORD) * reach * angle.length();

        let closing = asked.closing(N::splat(self.dt));
        let without_points = prediction - closing.max(N::splat(self.tolerance));
        // Half-spaces reach nowhere, and count by the other side.
        let [a, b] = extents;
        let smaller = N::select(N::or(a.eq(N::ZERO), b.eq(N::ZERO)), a.max(b), a.min(b));
        let errors = N::splat(self.recycle_distance).min(N::splat(RECYCLE_SHARE) * smaller);
        // Points may be missing that were too far apart to be found; none of them may close in this step.
        let is_full = count.eq(N::splat(MAX_POINTS as f32));
        let with_points = N::select(is_full, errors, errors.min(prediction - closing));
        let allowed = N::select(count.eq(N::ZERO), without_points, with_points);
        // A NaN fails the comparison.
        N::and(is_straight, moved.lt(allowed))
    }
}

impl<N: Lane> Asked<N> {
    /// How far each body turned since freezing, in world axes.
    #[inline(always)]
    fn turns(&self) -> [Rot<N>; 2] {
        let ([a, b], [frozen_a, frozen_b]) = (self.rotations, self.frozen);
        [a.mul(frozen_a.inverse()), b.mul(frozen_b.inverse())]
    }

    /// How far B's centre of mass shifted against A's since freezing.
    #[inline(always)]
    fn change(&self) -> Vector<N> {
        self.apart - self.offset
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
        (self.linear.length() + turning) * dt
    }

    /// How far apart the points are now: s = s₀ + n · (Δoffset + (R_B − 1) r_B − (R_A − 1) r_A).
    #[inline(always)]
    fn separations(&self) -> [N; 4] {
        let (normal, turns) = (self.normal, self.turns());
        let along = self.change().dot(normal);
        let cores = [normal * self.rounding[0], self.offset - normal * self.rounding[1]];
        // n · (R r − r) = (R⁻¹ n − n) · r, of which only r differs from point to point.
        let leans = [turns[0].unturn(normal), turns[1].unturn(normal)];
        let mut all = [N::ZERO; 4];
        for (out, p) in all.iter_mut().zip(&self.points) {
            let turn = leans[1].dot(p.anchor - cores[1]) - leans[0].dot(p.anchor - cores[0]);
            *out = p.frozen_separation + along + turn;
        }
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::table::{BodyTable, ColliderTable};
    use proptest::{prelude::*, strategy::ValueTree, test_runner::TestRunner};

    const LANES: usize = F32x4::WIDTH;

    /// Rows near one of which the manifold is kept, and far from it.
    fn row() -> impl Strategy<Value = Row> {
        let noise = prop_oneof![40 => Just(0.0), 20 => -0.005..0.005f32, 1 => -1.0..1.0f32];
        let points = prop::sample::select(vec![0.0, 1.0, MAX_POINTS as f32]);
        (prop::collection::vec(noise, FLOATS), points, 0.1..2.0f32, 0..40 * FLOATS).prop_map(
            |(noise, count, reach, odd)| {
                let mut asked = Asked {
                    offset: Vector::Y,
                    apart: Vector::Y,
                    prediction: 0.02,
                    extents: [reach, 1.0],
                    turning: [reach, 0.0],
                    normal: Vector::Y,
                    ..Asked::default()
                };
                asked.points[0].anchor = Vector::X;
                let mut row = Row { asked, ..Row::default() };
                // SAFETY: a row is so many floats, without anything between.
                let floats: &mut [f32; 4 * QUADS] = unsafe { &mut *core::ptr::from_mut(&mut row).cast() };
                floats.iter_mut().zip(noise).for_each(|(float, noise)| *float += noise);
                if let Some(float) = floats.get_mut(odd) {
                    *float = f32::NAN;
                }
                row.asked.count = count;
                row
            },
        )
    }

    fn phase((bodies, colliders): &(BodyTable, ColliderTable)) -> NarrowPhase<'_, ()> {
        NarrowPhase {
            bodies,
            colliders,
            source: &(),
            dt: 1.0 / 60.0,
            tolerance: 0.005,
            speculative: 0.02,
            recycle_distance: 0.05,
            match_points: true,
            narrow: false,
        }
    }

    proptest! {
        /// What is found of a contact is the same bits whatever stands beside it.
        #[test]
        fn side_by_side_is_as_alone(rows in prop::collection::vec(row(), LANES)) {
            let tables = Default::default();
            let phase = phase(&tables);
            let together = Asked::<F32x4>::side_by_side(&rows, &core::array::from_fn(|i| i as u32));
            let (kept, separations) = (F32x4::bits(phase.is_kept(&together)), together.separations());
            for (i, row) in rows.iter().enumerate() {
                prop_assert_eq!(phase.is_kept(&row.asked), kept & 1 << i != 0);
                for (alone, lane) in row.asked.separations().into_iter().zip(separations) {
                    let lane = lane.get(i);
                    prop_assert!(alone.to_bits() == lane.to_bits() || alone.is_nan() && lane.is_nan());
                }
            }
        }
    }

    #[test]
    fn some_of_those_rows_are_kept_and_some_are_not() {
        let tables = Default::default();
        let mut runner = TestRunner::deterministic();
        let mut draw = || row().new_tree(&mut runner).expect("nothing is filtered").current();
        let kept = (0..1000).filter(|_| phase(&tables).is_kept(&draw().asked)).count();
        assert!((100..900).contains(&kept), "{kept} of 1000");
    }
}
