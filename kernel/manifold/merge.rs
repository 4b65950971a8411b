//! Merges manifolds of parts with the same normal into few.

use super::dim::few_points;
use super::{LocalManifold, LocalPoint};
use crate::math::{max, min};
use crate::tuning::manifold::{ALIKE, SAME, SAME_NORMAL};

/// Buffers, kept between calls.
#[derive(Clone, Debug, Default)]
pub(super) struct Merging {
    /// For each manifold, the index of its merged manifold.
    groups: Vec<usize>,
    points: Vec<LocalPoint>,
}

/// Merges the manifolds in `found` with the same groups and about the same normal, the deepest first, and
/// adds the results to `out`.
pub(super) fn merge(found: &mut [LocalManifold], room: &mut Merging, out: &mut Vec<LocalManifold>) {
    let Merging { groups, points } = room;
    if let [only] = found {
        out.push(*only);
        return;
    }
    let depth = |m: &LocalManifold| m.points().iter().fold(f32::INFINITY, |low, p| min(low, p.separation));
    found.sort_by(|a, b| depth(a).total_cmp(&depth(b)));
    groups.clear();
    let start = out.len();
    for m in found.iter() {
        let is_round_alike =
            |o: &LocalManifold| o.radii.iter().zip(m.radii).all(|(r, q)| (r - q).abs() <= SAME * max(*r, q));
        let is_flat = m.radii == [0.0; 2];
        let is_parallel = |o: &LocalManifold| match is_flat {
            true => o.radii == m.radii && o.normal.dot(m.normal) > SAME_NORMAL,
            false => (o.normal - m.normal).length_squared() < ALIKE * ALIKE && is_round_alike(o),
        };
        let is_same = |o: &LocalManifold| o.groups == m.groups && is_parallel(o);
        let group = out[start..].iter().position(is_same);
        groups.push(group.unwrap_or(out.len() - start));
        if group.is_none() {
            out.push(*m);
        }
    }
    for (group, merged) in out[start..].iter_mut().enumerate() {
        if groups.iter().filter(|g| **g == group).count() == 1 {
            continue;
        }
        points.clear();
        for (m, _) in found.iter().zip(groups.iter()).filter(|(_, g)| **g == group) {
            points.extend_from_slice(m.points());
        }
        drop_twins(points);
        few_points(points, merged);
    }
}

/// Merges points at the same place: the deeper point stays.
fn drop_twins(points: &mut Vec<LocalPoint>) {
    let first = points[0].point;
    let spread = points.iter().fold(0.0, |far, p| max(far, (p.point - first).length_squared()));
    let mut kept = 0;
    for i in 0..points.len() {
        let point = points[i];
        let is_near = |p: &LocalPoint| (p.point - point.point).length_squared() <= SAME * SAME * spread;
        match points[..kept].iter().position(is_near) {
            Some(twin) if point.separation < points[twin].separation => points[twin] = point,
            Some(_) => {}
            None => {
                points[kept] = point;
                kept += 1;
            }
        }
    }
    points.truncate(kept);
}
