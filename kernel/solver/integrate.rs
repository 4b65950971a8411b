//! Free motion: velocities from accelerations and damping, positions from velocities.
#![expect(unsafe_code, reason = "rows of bodies are shared by threads")]

use super::body::OnceEach;
use super::{BodyRow, BodyRows, RowView, gyro::*, spin::Spin};
use crate::data::Parts;
use crate::math::{Angular, Entry, F32x4, Ids, Job, Lane, Rot};
#[cfg(target_arch = "x86_64")]
use crate::math::{F32x8, Width};
use crate::thread_pool::ThreadPool;
use core::marker::PhantomData;
use core::ops::Range;

/// Bodies per block of the job, a multiple of the widest lanes. More leaves workers idle at the end, fewer
/// cost more claims.
const BLOCK: usize = 256;

/// As [`BLOCK`], for bodies with free spin: each takes twenty times as long.
const SPIN_BLOCK: usize = 64;

impl<T: Send> OnceEach<T> {
    /// Changes the rows of bodies with an item in the list.
    pub(super) fn each(
        &mut self,
        rows: &mut [BodyRow],
        pool: &ThreadPool,
        change: impl Fn(&mut T, &mut BodyRow) + Sync,
    ) {
        self.each_block(BLOCK, pool, rows, |items, view| {
            for (row, item) in items {
                // SAFETY: no row is listed twice, and an item is in one block.
                unsafe { view.put(*row, |row| change(item, row)) };
            }
        });
    }

    /// Calls `change` with blocks of items. No row is listed twice, and each item is in one block.
    fn each_block(
        &mut self,
        size: usize,
        pool: &ThreadPool,
        rows: &mut [BodyRow],
        change: impl Fn(&mut [(u32, T)], &RowView<BodyRow>) + Sync,
    ) {
        let (count, items, view) = (self.list().len(), self.parts(), RowView::over(rows, 0));
        pool.run(count.div_ceil(size), |block, _| {
            // SAFETY: an item is in one block.
            change(unsafe { items.take(block * size..count.min((block + 1) * size)) }, &view);
        });
    }
}

impl OnceEach<Spin> {
    /// Sets angular velocities to the ones with which bodies are rotated for `h` seconds.
    fn begin_turns(&mut self, rows: &mut [BodyRow], pool: &ThreadPool, h: f32) {
        self.each_block(SPIN_BLOCK, pool, rows, |spins, view| {
            let (wide, rest) = spins.split_at_mut(spins.len() - spins.len() % F32x4::WIDTH);
            for spins in wide.chunks_exact_mut(F32x4::WIDTH) {
                // SAFETY: by `each_block`.
                unsafe { Spin::begin_turns::<F32x4>(spins, view, h) };
            }
            for spins in rest.chunks_exact_mut(1) {
                // SAFETY: as above.
                unsafe { Spin::begin_turns::<f32>(spins, view, h) };
            }
        });
    }

    /// Sets angular velocities to their values at the end of the substep, after bodies were rotated.
    fn end_turns(&mut self, rows: &mut [BodyRow], pool: &ThreadPool) {
        self.each_block(SPIN_BLOCK, pool, rows, |spins, view| {
            let (wide, rest) = spins.split_at_mut(spins.len() - spins.len() % F32x4::WIDTH);
            for spins in wide.chunks_exact_mut(F32x4::WIDTH) {
                // SAFETY: by `each_block`.
                unsafe { Spin::end_turns::<F32x4>(spins, view) };
            }
            for spins in rest.chunks_exact_mut(1) {
                // SAFETY: as above.
                unsafe { Spin::end_turns::<f32>(spins, view) };
            }
        });
    }
}

fn limit_factor(speed: f32, max: f32) -> f32 {
    debug_assert!(max >= 0.0, "a limit of {max}");
    if speed > max { max / speed } else { 1.0 }
}

impl BodyRows {
    /// v ← v / (1 + c h) + h a for every dynamic body. Damping acts on the old velocity, so that without
    /// forces v falls by exactly 1 / (1 + c h). An acceleration in a body's frame uses the body's rotation
    /// at the start of the substep.
    pub(super) fn integrate_velocities(&mut self, h: f32, pool: &ThreadPool) {
        let Self { rows, motions, first_dynamic, .. } = self;
        debug_assert_eq!(rows.len(), motions.len(), "each row has its motion");
        debug_assert!(*first_dynamic as usize <= rows.len(), "dynamic rows begin within the rows");
        let (first, count) = (*first_dynamic as usize, rows.len());
        let rows = Parts::of(rows);
        pool.run((count - first).div_ceil(BLOCK), |block, _| {
            let start = first + block * BLOCK;
            let range = start..count.min(start + BLOCK);
            // SAFETY: a row is in one block.
            let rows = unsafe { rows.take(range.clone()) };
            for (row, motion) in rows.iter_mut().zip(&motions[range]) {
                let gained = (motion.acceleration, motion.angular_acceleration);
                let damping = [motion.linear_damping, motion.angular_damping];
                // Divisions are expensive, and most bodies have no damping.
                let kept = if damping == [0.0; 2] { [1.0; 2] } else { damping.map(|c| 1.0 / (1.0 + c * h)) };
                row.accelerate(kept, gained, h);
            }
        });
        self.thrusts.each(&mut self.rows, pool, |thrust, row| thrust.accelerate(row, h));
        self.hold_back(pool);
    }

    /// Δx ← Δx + h v and Δθ ← Δθ turned by h ω, for every body.
    ///
    /// A body with free spin is rotated with the ω in the middle of the free spin. Contacts use the ω
    /// before it, which belongs to the same rotation as their arms. If contacts came after the gyroscopic
    /// torque, the axis of a fast spinner would have moved, and contacts would throw it back.
    pub(super) fn integrate_positions(&mut self, h: f32, pool: &ThreadPool) {
        self.add_to_gains(-1.0, pool);
        self.hold_back(pool);
        self.spins.begin_turns(&mut self.rows, pool, h);
        self.hold_back(pool);
        let (count, width) = (self.rows.len(), self.width);
        let view = self.view_all();
        pool.run(count.div_ceil(BLOCK), |block, _| {
            let rows = block * BLOCK..count.min((block + 1) * BLOCK);
            // SAFETY: a row is in one block.
            unsafe {
                match width {
                    #[cfg(target_arch = "x86_64")]
                    Width::Eight(avx2) => F32x8::enter(avx2, MoveJob::<F32x8>::new(view, rows, h)),
                    _ => F32x4::enter((), MoveJob::<F32x4>::new(view, rows, h)),
                }
            }
        });
        self.spins.end_turns(&mut self.rows, pool);
        self.hold_back(pool);
        self.add_to_gains(1.0, pool);
    }

    /// Before a sweep: gives bodies that rotate far the angular velocity that constraint rows see.
    pub(super) fn enter_rows(&mut self, pool: &ThreadPool) {
        if !core::mem::replace(&mut self.see_rows, true) {
            self.fast_turns.each(&mut self.rows, pool, |fast, row| fast.enter(row));
        }
    }

    /// After a sweep: gives bodies that rotate far their true angular velocity.
    pub(super) fn leave_rows(&mut self, pool: &ThreadPool) {
        if core::mem::replace(&mut self.see_rows, false) {
            self.fast_turns.each(&mut self.rows, pool, |fast, row| fast.leave(row));
        }
    }

    /// Applies axis locks and speed limits to velocities.
    fn hold_back(&mut self, pool: &ThreadPool) {
        self.limits.each(&mut self.rows, pool, |limits, row| {
            let (v, w) = row.velocity();
            let v = v.scale(limits.locks.translation_factors());
            let w = scale_angular(w, limits.locks.rotation_factors());
            row.set_velocity(
                v * limit_factor(v.length(), limits.max_speed),
                w * limit_factor(w.length(), limits.max_angular_speed),
            );
        });
    }
}

/// Integrates the positions of the bodies of some rows.
struct MoveJob<'a, N> {
    view: RowView<'a, BodyRow>,
    rows: Range<usize>,
    h: f32,
    lane: PhantomData<N>,
}

impl<'a, N> MoveJob<'a, N> {
    fn new(view: RowView<'a, BodyRow>, rows: Range<usize>, h: f32) -> Self {
        Self { view, rows, h, lane: PhantomData }
    }
}

impl<N: Lane> Job for MoveJob<'_, N> {
    type Output = ();

    #[inline(always)]
    unsafe fn run(self) {
        let Self { view, rows, h, .. } = self;
        let (mut id, end) = (rows.start, rows.end);
        let mut ids = N::Ids::splat(0);
        while id + N::WIDTH <= end {
            for lane in 0..N::WIDTH {
                ids.set(lane, (id + lane) as u32);
            }
            // SAFETY: by the contract.
            unsafe { move_bodies::<N>(&view, &ids, h) };
            id += N::WIDTH;
        }
        for id in id..end {
            // SAFETY: as above.
            unsafe { move_bodies::<f32>(&view, &[id as u32], h) };
        }
    }
}

/// # Safety
/// Until the call returns, no other thread reads or writes these rows.
#[inline(always)]
unsafe fn move_bodies<N: Lane>(view: &super::RowView<BodyRow>, ids: &N::Ids, h: f32) {
    // SAFETY: by the contract.
    let ((v, w), (p, q)) =
        unsafe { (BodyRow::gather_velocity::<N>(view, ids), BodyRow::gather_delta::<N>(view, ids)) };
    let h = N::splat(h);
    // SAFETY: by the contract.
    unsafe { BodyRow::scatter_delta::<N>(view, ids, p + v * h, turned(q, w * h)) };
}

/// Maximum x of [`exact_turn`], at 0.5 rad (in 2D: 0.25 rad). Up to this x the series is exact to rounding.
const SMALL: f32 = 0.0625;

/// The rotation `q` after turning by `delta`, of any size.
#[inline(always)]
fn turned<N: Lane>(q: Rot<N>, delta: Angular<N>) -> Rot<N> {
    let near = q.integrated(exact_turn(delta));
    let far = N::lt(N::splat(SMALL), delta.length_squared() * N::splat(SERIES));
    if N::any(far) { large_turn(q, delta, N::bits(far), near) } else { near }
}

/// The ratio of x of [`exact_turn`] to δ².
const SERIES: f32 = if crate::math::DIM == 2 { 1.0 } else { 0.25 };

/// The normalised Euler step turns by 2 atan(δ/2) (in 2D: atan δ) instead of δ. Terms of the tangent's series
/// compensate: δ (1 + x/3 + 2x²/15 + 17x³/315 + 62x⁴/2835), x = (δ/2)² (in 2D: δ²).
#[inline(always)]
fn exact_turn<N: Lane>(turn: Angular<N>) -> Angular<N> {
    let x = turn.length_squared() * N::splat(SERIES);
    let series = N::splat(2.0 / 15.0) + x * (N::splat(17.0 / 315.0) + x * N::splat(62.0 / 2835.0));
    turn * (N::ONE + x * (N::splat(1.0 / 3.0) + x * series))
}

/// Returns `near`, with the lanes `far` replaced by the rotation by a large angle, computed per lane with
/// sine and cosine: the tangent of [`exact_turn`] is infinite at half a turn. Not inlined, since few bodies
/// rotate so fast.
#[inline(never)]
fn large_turn<N: Lane>(q: Rot<N>, delta: Angular<N>, far: u32, near: Rot<N>) -> Rot<N> {
    let mut turned = near;
    for i in (0..N::WIDTH).filter(|i| far >> i & 1 != 0) {
        turned.set(i, q.get(i).turned_by(delta.get(i)));
    }
    turned
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Vector;
    use crate::solver::{Limits, Motion, Thrust};

    fn one_body(motion: Motion, v: Vector) -> BodyRows {
        let mut bodies = BodyRows::default();
        bodies.reset(0, 1);
        bodies.rows[1] = BodyRow::new(v, Angular::ZERO);
        bodies.motions[1] = motion;
        bodies
    }

    #[test]
    fn free_fall_is_symplectic_euler() {
        let g = Vector::Y * -9.81;
        let mut bodies = one_body(Motion { acceleration: g, ..Motion::FREE }, Vector::X * 3.0);
        let (h, n) = (1.0 / 256.0, 512);
        for _ in 0..n {
            bodies.integrate_velocities(h, &ThreadPool::default());
            bodies.integrate_positions(h, &ThreadPool::default());
        }
        let t = h * n as f32;
        let (v, p) = (bodies.rows[1].velocity().0, bodies.rows[1].delta().0);
        let want = Vector::X * (3.0 * t) + g * (0.5 * t * (t + h));
        assert!((p - want).length() < 1e-5 * want.length(), "{p:?} is not {want:?}");
        assert!((v.y + 9.81 * t).abs() < 1e-4);
    }

    /// v_n = h Σ R(ω k h) a: each substep accelerates with the rotation at its start. The test has more
    /// than two blocks of bodies.
    #[test]
    fn an_acceleration_in_the_frame_of_a_body_turns_with_it() {
        let (h, steps, rate, a) = (1.0 / 240.0, 300, 3.0, Vector::X * 8.0 + Vector::Y);
        let count = 2 * BLOCK + 3;
        let mut bodies = BodyRows::default();
        bodies.reset(0, count);
        let start = Rot::IDENTITY.turned_by(spin(0.5));
        let thrust = Thrust { local_linear: a, linear: Vector::Y * 0.25, ..Thrust::NONE };
        for row in 1..=count {
            bodies.set_at_rest(row);
            bodies.rows[row] = BodyRow::new(Vector::ZERO, spin(rate));
            bodies.thrust(row, &thrust, start);
        }
        let mut want = Vector::ZERO;
        for k in 0..steps {
            bodies.integrate_velocities(h, &ThreadPool::default());
            bodies.integrate_positions(h, &ThreadPool::default());
            want += start.turned_by(spin(rate * h * k as f32)).rotate(a) * h + Vector::Y * (0.25 * h);
        }
        for row in 1..=count {
            let (v, w) = bodies.rows[row].velocity();
            assert!((v - want).length() < 1e-4 * a.length(), "row {row}: {v:?} is not {want:?}");
            assert_eq!(w, spin(rate));
        }
    }

    #[test]
    fn an_angular_acceleration_in_the_frame_of_a_body_adds_up() {
        let mut bodies = one_body(Motion::FREE, Vector::ZERO);
        let thrust = Thrust { angular: spin(0.5), local_angular: spin(1.5), ..Thrust::NONE };
        bodies.thrust(1, &thrust, Rot::IDENTITY);
        for _ in 0..120 {
            bodies.integrate_velocities(1.0 / 60.0, &ThreadPool::default());
            bodies.integrate_positions(1.0 / 60.0, &ThreadPool::default());
        }
        let (v, w) = bodies.rows[1].velocity();
        assert_eq!(v, Vector::ZERO);
        assert!((w - spin(4.0)).length_squared() < 1e-8, "{w:?}");
    }

    #[test]
    fn damping_divides_the_velocity() {
        let mut bodies = one_body(Motion { linear_damping: 0.7, ..Motion::FREE }, Vector::X * 5.0);
        let h = 1.0 / 60.0;
        for _ in 0..100 {
            bodies.integrate_velocities(h, &ThreadPool::default());
        }
        let want = 5.0 / (1.0f64 + 0.7 / 60.0).powi(100);
        assert!((f64::from(bodies.rows[1].velocity().0.x) - want).abs() < 1e-4 * want);
    }

    /// Error of a rotation, compared with sine and cosine of the angle on two axes.
    fn turn_error(angle: f32) -> f64 {
        let [x, y] = [Rot::IDENTITY.axes()[0], Rot::IDENTITY.axes()[1]];
        let turned = turned::<f32>(Rot::IDENTITY, spin(angle)).rotate(x);
        let (sin, cos) = crate::math::sin_cos(f64::from(angle));
        (f64::from(turned.dot(x)) - cos).abs().max((f64::from(turned.dot(y)) - sin).abs())
    }

    #[test]
    fn a_turn_is_the_angle_it_should_be() {
        for degrees in
            [0.0f32, 1.0, 10.0, 14.0, 15.0, 28.0, 29.0, 30.0, 90.0, 180.0, 270.0, 360.0, 1000.0, 1.0e6]
        {
            let angle = degrees / 180.0 * core::f32::consts::PI;
            assert!(turn_error(angle) < 1e-6, "{degrees}°: {}", turn_error(angle));
            assert!(turn_error(-angle) < 1e-6, "−{degrees}°: {}", turn_error(-angle));
        }
    }

    #[test]
    fn a_turn_of_any_size_leaves_a_rotation() {
        for exponent in -38..38 {
            let angle = 10.0f32.powi(exponent);
            let q = turned::<f32>(Rot::IDENTITY, spin(angle));
            let length = q.rotate(Rot::IDENTITY.axes()[0]).length();
            assert!((length - 1.0).abs() < 1e-6, "1e{exponent} rad: {q:?}");
        }
    }

    #[test]
    fn held_axes_do_not_move_and_speeds_stay_limited() {
        let mut bodies = one_body(Motion { acceleration: Vector::ONE, ..Motion::FREE }, Vector::ZERO);
        let locks = crate::math::AxisLocks(0b100_000);
        bodies.limit(1, Limits { locks, max_speed: 0.25, ..Limits::NONE });
        for _ in 0..60 {
            bodies.integrate_velocities(1.0 / 60.0, &ThreadPool::default());
            bodies.integrate_positions(1.0 / 60.0, &ThreadPool::default());
        }
        let (v, _) = bodies.rows[1].velocity();
        assert_eq!(v.x, 0.0);
        assert!((v.length() - 0.25).abs() < 1e-6);
        assert_eq!(bodies.rows[1].delta().0.x, 0.0);
    }
}
