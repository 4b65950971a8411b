//! Masses and normals of shapes in space, measured by rays, for tests.

use crate::math::{Rot, Vector};
use crate::shape::Shape;
use proptest::prelude::*;

fn v(x: f32, y: f32, z: f32) -> Vector {
    Vector { x, y, z }
}

/// The mass properties of a shape about `center`, measured by rays along z.
fn mass_by_rays(shape: &Shape, center: Vector, reach: f32) -> (f64, [f64; 3], [f64; 6]) {
    const CELLS: usize = 400;
    let aabb = shape.local_aabb(Rot::IDENTITY);
    let (low, cell) = (aabb.min - center, (aabb.max - aabb.min) * (1.0 / CELLS as f32));
    let area = f64::from(cell.x) * f64::from(cell.y);
    let place = |i: usize| i as f32 + 0.5;
    let (mut volume, mut first, mut second) = (0.0f64, [0.0f64; 3], [0.0f64; 6]);
    for i in 0..CELLS * CELLS {
        let (x, y) = (low.x + cell.x * place(i % CELLS), low.y + cell.y * place(i / CELLS));
        let cast = |side: f32| {
            let origin = center + v(x, y, -side * 2.0 * reach);
            let hit = shape.cast_ray(origin, Vector::Z * side, 9.0 * reach, false)?;
            Some(f64::from(side * (hit.distance - 2.0 * reach)))
        };
        let (Some(low), Some(high)) = (cast(1.0), cast(-1.0)) else { continue };
        let (x, y) = (f64::from(x), f64::from(y));
        let moments = [high - low, (high * high - low * low) / 2.0, (high.powi(3) - low.powi(3)) / 3.0]
            .map(|m| m * area);
        volume += moments[0];
        for (sum, k) in first.iter_mut().zip([x * moments[0], y * moments[0], moments[1]]) {
            *sum += k;
        }
        let products = [
            x * x * moments[0],
            y * y * moments[0],
            moments[2],
            x * y * moments[0],
            x * moments[1],
            y * moments[1],
        ];
        second.iter_mut().zip(products).for_each(|(sum, k)| *sum += k);
    }
    (volume, first.map(|m| m / volume), second)
}

/// Compares the mass properties with the measurement by rays.
#[track_caller]
pub(super) fn check_mass_by_rays(shape: &Shape, reach: f32) {
    let mass = shape.mass_properties(1.0);
    let (volume, offset, second) = mass_by_rays(shape, mass.center, reach);
    let (size, unit) = (f64::from(reach), volume * f64::from(reach) * f64::from(reach));
    assert!((f64::from(mass.mass) - volume).abs() < 1.0e-3 * volume, "{} {volume}", mass.mass);
    assert!(offset.iter().all(|o| o.abs() < 1.0e-3 * size), "{offset:?}");
    let [xx, yy, zz, xy, xz, yz] = second;
    let i = mass.inertia;
    let entries = [i.xx, i.yy, i.zz, i.xy, i.xz, i.yz];
    let expected = [yy + zz, xx + zz, xx + yy, -xy, -xz, -yz];
    for (got, expected) in entries.into_iter().zip(expected) {
        assert!((f64::from(got) - expected).abs() < 1.0e-3 * unit, "{got} {expected} of {unit}");
    }
}

/// Checks that a hit is on the surface: on a convex shape the hit is the farthest point along its normal.
pub(super) fn check_ray(shape: &Shape, from: Vector, to: Vector, solid: bool) -> Result<(), TestCaseError> {
    let line = to - from;
    prop_assume!(line.length() > 0.1);
    let line = line * (1.0 / line.length());
    let Some(hit) = shape.cast_ray(from, line, 20.0, solid).filter(|hit| hit.distance > 0.0) else {
        return Ok(());
    };
    let at = from + line * hit.distance;
    prop_assert!((hit.normal.length() - 1.0).abs() < 1e-4);
    let farthest = shape.support(hit.normal).expect("bounded").dot(hit.normal);
    prop_assert!((farthest - at.dot(hit.normal)).abs() < 2e-3, "{farthest} {}", at.dot(hit.normal));
    Ok(())
}
