//! Bodies with free spin: the gyroscopic torque turns their spin axes. `spin2.rs` exports the same name.
#![expect(unsafe_code, reason = "rows of bodies are shared by threads")]

use super::{BodyRow, RowView, gyro::*};
use crate::math::{Angular, Ids, Lane, Quad, Rot, SymTensor};

/// A body with free spin, as quads: several bodies are loaded into lanes at once.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spin {
    /// The inertia: xx, yy, zz, xy; xz, yz, and xx, yy of the inverse; the rest of the inverse.
    gyro: [Quad; 3],
    /// Rotation at the start of the step.
    rotation: Quad,
    /// Angular velocity after the last substep, in the body's frame and in world axes.
    after: [Quad; 2],
}

impl Spin {
    /// A body with this rotation at the start of the step.
    pub(super) fn new(gyro: Gyro, rotation: Rot) -> Self {
        let (i, inv, q) = (gyro.inertia, gyro.inv_inertia, rotation);
        Self {
            gyro: [
                Quad([i.xx, i.yy, i.zz, i.xy]),
                Quad([i.xz, i.yz, inv.xx, inv.yy]),
                Quad([inv.zz, inv.xy, inv.xz, inv.yz]),
            ],
            rotation: Quad([q.x, q.y, q.z, q.w]),
            after: [Quad::default(); 2],
        }
    }

    /// The inertia.
    pub(super) fn gyro(&self) -> Gyro {
        gyro_of([self.gyro[0].0, self.gyro[1].0, self.gyro[2].0])
    }

    /// Rotation at the start of the step.
    pub(super) fn rotation(&self) -> Rot {
        let [x, y, z, w] = self.rotation.0;
        Rot { x, y, z, w }
    }

    /// Discards the stored angular velocity, because the rotation was changed by something other than free
    /// spin. The next turn takes the velocity of the row.
    pub(super) fn restart(&mut self) {
        self.after = [Quad::default(); 2];
    }

    /// Sets the angular velocities to their values in the middle of a substep of `h` seconds, with which
    /// bodies are rotated. One body per lane.
    ///
    /// # Safety
    /// No row is listed twice, and until the call returns no other thread uses these rows.
    #[inline(always)]
    pub(super) unsafe fn begin_turns<N: Lane>(spins: &mut [(u32, Self)], rows: &RowView<BodyRow>, h: f32) {
        let (places, ids) = ids_of::<N>(spins);
        // SAFETY: by the contract.
        let ((v, w), (_, turn)) =
            unsafe { (BodyRow::gather_velocity::<N>(rows, &ids), BodyRow::gather_delta::<N>(rows, &ids)) };
        let quads = |k: usize| N::gather(&places, |i| &spins[i as usize].1.gyro[k]);
        let gyro = gyro_of([quads(0), quads(1), quads(2)]);
        let [start, last] = [0, 1].map(|k| after::<N>(spins, &places, k));
        let rotation = world_rotation(turn, rotation::<N>(spins, &places));
        // Only the change since the last substep is rotated into the body's frame, so free spin itself is
        // not rounded.
        let local = start + to_body(rotation, w - last);
        let (middle, end) = gyro.spun(local, N::splat(h));
        N::scatter([end.x, end.y, end.z, N::ZERO], &places, |i, quad| spins[i as usize].1.after[0] = quad);
        // SAFETY: by the contract.
        unsafe { BodyRow::scatter_velocity::<N>(rows, &ids, v, to_world(rotation, middle)) };
    }

    /// Sets the angular velocities of rotated bodies to their values at the end of the substep. One body
    /// per lane.
    ///
    /// # Safety
    /// As [`begin_turns`](Self::begin_turns).
    #[inline(always)]
    pub(super) unsafe fn end_turns<N: Lane>(spins: &mut [(u32, Self)], rows: &RowView<BodyRow>) {
        let (places, ids) = ids_of::<N>(spins);
        // SAFETY: by the contract.
        let ((v, _), (_, turn)) =
            unsafe { (BodyRow::gather_velocity::<N>(rows, &ids), BodyRow::gather_delta::<N>(rows, &ids)) };
        let rotation = world_rotation(turn, rotation::<N>(spins, &places));
        let end = to_world(rotation, after::<N>(spins, &places, 0));
        N::scatter([end.x, end.y, end.z, N::ZERO], &places, |i, quad| spins[i as usize].1.after[1] = quad);
        // SAFETY: by the contract.
        unsafe { BodyRow::scatter_velocity::<N>(rows, &ids, v, end) };
    }
}

/// The places of bodies in the list, and their rows.
#[inline(always)]
fn ids_of<N: Lane>(spins: &[(u32, Spin)]) -> (N::Ids, N::Ids) {
    let (mut places, mut ids) = (N::Ids::splat(0), N::Ids::splat(0));
    for (i, (row, _)) in spins[..N::WIDTH].iter().enumerate() {
        places.set(i, i as u32);
        ids.set(i, *row);
    }
    (places, ids)
}

#[inline(always)]
fn gyro_of<N: Lane>([[xx, yy, zz, xy], [xz, yz, ixx, iyy], [izz, ixy, ixz, iyz]]: [[N; 4]; 3]) -> Gyro<N> {
    Gyro {
        inertia: SymTensor { xx, yy, zz, xy, xz, yz },
        inv_inertia: SymTensor { xx: ixx, yy: iyy, zz: izz, xy: ixy, xz: ixz, yz: iyz },
    }
}

#[inline(always)]
fn rotation<N: Lane>(spins: &[(u32, Spin)], places: &N::Ids) -> Rot<N> {
    let [x, y, z, w] = N::gather(places, |i| &spins[i as usize].1.rotation);
    Rot { x, y, z, w }
}

#[inline(always)]
fn after<N: Lane>(spins: &[(u32, Spin)], places: &N::Ids, k: usize) -> Angular<N> {
    let [x, y, z, _] = N::gather(places, |i| &spins[i as usize].1.after[k]);
    Angular { x, y, z }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{F32x4, InvInertia, Vector};

    /// Rotations of all sizes: at rest, with one and with three Newton steps, and beyond the largest.
    #[test]
    fn free_spin_has_the_same_bits_in_lanes_and_alone() {
        let speeds = [0.0, 1.0e-4, 3.0, 70.0, 1.0e3, 1.0e6, 20.0, 1.0e30];
        let spins: Vec<_> = (0..64u32)
            .map(|i| {
                let size = Vector { x: 1.0 + i as f32, y: 0.3, z: 2.0 };
                let mut inertia = InvInertia::from_diagonal(size);
                inertia.xz = 0.2 * (i % 3) as f32;
                let rotation = Rot::IDENTITY.turned_by(size * (0.1 * i as f32));
                (1 + (i * 27) % 64, Spin::new(Gyro::of(inertia).unwrap(), rotation))
            })
            .collect();
        let row = |i: u32| {
            let axis = Vector { x: 0.3, y: 0.1 * i as f32 - 2.0, z: 0.7 };
            BodyRow::new(Vector::X, axis * speeds[i as usize % speeds.len()])
        };
        let rows: Vec<_> = (0..65).map(row).collect();
        let run = |width: usize| {
            let (mut spins, mut rows) = (spins.clone(), rows.clone());
            for _ in 0..3 {
                let view = RowView::over(&mut rows, 0);
                for spins in spins.chunks_mut(width) {
                    // SAFETY: no row is listed twice, and there is one thread.
                    unsafe {
                        match width {
                            1 => Spin::begin_turns::<f32>(spins, &view, 1.0 / 240.0),
                            _ => Spin::begin_turns::<F32x4>(spins, &view, 1.0 / 240.0),
                        }
                    }
                }
                for row in &mut rows {
                    row.set_delta(Vector::ZERO, row.delta().1.turned_by(row.velocity().1 * (1.0 / 240.0)));
                }
                let view = RowView::over(&mut rows, 0);
                for spins in spins.chunks_mut(width) {
                    // SAFETY: as above.
                    unsafe {
                        match width {
                            1 => Spin::end_turns::<f32>(spins, &view),
                            _ => Spin::end_turns::<F32x4>(spins, &view),
                        }
                    }
                }
            }
            rows.iter().map(|row| row.velocity().1.to_array().map(f32::to_bits)).collect::<Vec<_>>()
        };
        assert_eq!(run(1), run(4));
    }
}
