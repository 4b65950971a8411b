//! Free motion: velocities from accelerations and damping, positions from velocities.

use super::{BodyRow, BodyRows, RowView, gyro::*};
use crate::math::{Angular, F32x4, Lane};
use crate::team::Team;

/// How many bodies a member of the team moves at a stretch: a multiple of the lanes.
const BLOCK: usize = 256;

/// Changes the rows of some bodies, each of which is listed once.
fn each_of<T: Sync>(
    list: &[T],
    row: impl Fn(&T) -> u32 + Sync,
    rows: &mut [BodyRow],
    team: &Team,
    change: impl Fn(&T, &mut BodyRow) + Sync,
) {
    let view = RowView::over(rows, 0);
    team.run(list.len().div_ceil(BLOCK), |block, _| {
        for item in &list[block * BLOCK..list.len().min((block + 1) * BLOCK)] {
            view.put(row(item), |row| change(item, row));
        }
    });
}

fn limit_factor(speed: f32, max: f32) -> f32 {
    if speed > max { max / speed } else { 1.0 }
}

impl BodyRows {
    /// v ← v / (1 + c h) + h a for every dynamic body; the damping acts on the old velocity, so that
    /// without forces v falls by exactly 1 / (1 + c h). In 3D then one step of the gyroscopic torque.
    pub(super) fn integrate_velocities(&mut self, h: f32, team: &Team) {
        let Self { rows, motions, spins, first_dynamic, .. } = self;
        let (first, count) = (*first_dynamic as usize, rows.len());
        let view = RowView::over(rows, 0);
        team.run((count - first).div_ceil(BLOCK), |block, _| {
            let start = first + block * BLOCK;
            for id in start..count.min(start + BLOCK) {
                let motion = &motions[id];
                view.put(id as u32, |row| {
                    let (v, w) = row.velocity();
                    row.set_velocity(
                        v * (1.0 / (1.0 + motion.linear_damping * h)) + motion.acceleration * h,
                        w * (1.0 / (1.0 + motion.angular_damping * h)) + motion.angular_acceleration * h,
                    );
                });
            }
        });
        each_of(
            spins,
            |spin| spin.row,
            rows,
            team,
            |spin, row| {
                let (v, w) = row.velocity();
                let rotation = world_rotation(row.delta().1, spin.rotation);
                row.set_velocity(v, gyroscopic(w, rotation, spin.inv_inertia, h));
            },
        );
        self.hold_back(team);
    }

    /// Δx ← Δx + h v and Δθ ← Δθ turned by h ω, for every body.
    pub(super) fn integrate_positions(&mut self, h: f32, team: &Team) {
        self.hold_back(team);
        let count = self.rows.len();
        let view = self.view_all();
        team.run(count.div_ceil(BLOCK), |block, _| {
            let (mut id, end) = (block * BLOCK, count.min((block + 1) * BLOCK));
            while id + F32x4::WIDTH <= end {
                let ids = core::array::from_fn(|k| (id + k) as u32);
                move_bodies::<F32x4>(&view, &ids, h);
                id += F32x4::WIDTH;
            }
            for id in id..end {
                move_bodies::<f32>(&view, &[id as u32], h);
            }
        });
    }

    /// Keeps velocities within their limits.
    fn hold_back(&mut self, team: &Team) {
        each_of(
            &self.limits,
            |limited| limited.0,
            &mut self.rows,
            team,
            |(_, limits), row| {
                let (v, w) = row.velocity();
                let v = v.scale(limits.locks.translation_factors());
                let w = scale_angular(w, limits.locks.rotation_factors());
                row.set_velocity(
                    v * limit_factor(v.length(), limits.max_speed),
                    w * limit_factor(w.length(), limits.max_angular_speed),
                );
            },
        );
    }
}

#[inline(always)]
fn move_bodies<N: Lane>(view: &super::RowView<BodyRow>, ids: &N::Ids, h: f32) {
    let (v, w) = BodyRow::gather_velocity::<N>(view, ids);
    let (p, q) = BodyRow::gather_delta::<N>(view, ids);
    let h = N::splat(h);
    let (p, q) = (p + v * h, q.integrated(exact_turn(w * h)));
    BodyRow::scatter_delta::<N>(view, ids, p, q);
}

/// The normalised Euler step turns by 2 atan(δ/2) (in 2D: atan δ) instead of δ. Terms of the
/// tangent's series beforehand make up for it: δ (1 + x/3 + 2x²/15 + 17x³/315 + 62x⁴/2835), x = (δ/2)² (in 2D: δ²).
#[inline(always)]
fn exact_turn<N: Lane>(turn: Angular<N>) -> Angular<N> {
    let k = if crate::math::DIM == 2 { 1.0 } else { 0.25 };
    let x = turn.length_squared() * N::splat(k);
    let series = N::splat(2.0 / 15.0) + x * (N::splat(17.0 / 315.0) + x * N::splat(62.0 / 2835.0));
    turn * (N::ONE + x * (N::splat(1.0 / 3.0) + x * series))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Rot, Vector};
    use crate::solver::{Limits, Motion};

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
            bodies.integrate_velocities(h, &Team::default());
            bodies.integrate_positions(h, &Team::default());
        }
        let t = h * n as f32;
        let (v, p) = (bodies.rows[1].velocity().0, bodies.rows[1].delta().0);
        let want = Vector::X * (3.0 * t) + g * (0.5 * t * (t + h));
        assert!((p - want).length() < 1e-5 * want.length(), "{p:?} is not {want:?}");
        assert!((v.y + 9.81 * t).abs() < 1e-4);
    }

    #[test]
    fn damping_divides_the_velocity() {
        let mut bodies = one_body(Motion { linear_damping: 0.7, ..Motion::FREE }, Vector::X * 5.0);
        let h = 1.0 / 60.0;
        for _ in 0..100 {
            bodies.integrate_velocities(h, &Team::default());
        }
        let want = 5.0 / (1.0f64 + 0.7 / 60.0).powi(100);
        assert!((f64::from(bodies.rows[1].velocity().0.x) - want).abs() < 1e-4 * want);
    }

    #[test]
    fn a_turn_is_the_angle_it_should_be() {
        let axis = Rot::IDENTITY.axes()[0];
        for degrees in [1.0f32, 10.0, 30.0] {
            let angle = degrees / 180.0 * core::f32::consts::PI;
            let turn = spin(angle);
            let turned = Rot::IDENTITY.integrated(exact_turn(turn)).rotate(axis);
            let cos = turned.dot(axis);
            assert!((f64::from(cos) - crate::math::cos(f64::from(angle))).abs() < 2e-5, "{degrees}°");
        }
    }

    #[test]
    fn held_axes_do_not_move_and_speeds_stay_limited() {
        let mut bodies = one_body(Motion { acceleration: Vector::ONE, ..Motion::FREE }, Vector::ZERO);
        let locks = crate::math::AxisLocks(0b100_000);
        bodies.limit(1, Limits { locks, max_speed: 0.25, ..Limits::NONE });
        for _ in 0..60 {
            bodies.integrate_velocities(1.0 / 60.0, &Team::default());
            bodies.integrate_positions(1.0 / 60.0, &Team::default());
        }
        let (v, _) = bodies.rows[1].velocity();
        assert_eq!(v.x, 0.0);
        assert!((v.length() - 0.25).abs() < 1e-6);
        assert_eq!(bodies.rows[1].delta().0.x, 0.0);
    }
}
