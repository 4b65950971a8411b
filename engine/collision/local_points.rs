//! Reduces the contact points of manifolds that the kernel did not compute.

use kernel::{manifold::LocalPoint, math::MAX_POINTS};

/// Keeps the deepest point and the points that spread widest, at most `MAX_POINTS`, without duplicates.
///
/// Parry adds the closest points to the clipped ones, so a corner may appear twice.
pub(crate) fn reduce(points: &mut Vec<LocalPoint>) {
    let deepest =
        (0..points.len()).reduce(|a, b| if points[b].separation < points[a].separation { b } else { a });
    let Some(deepest) = deepest else {
        return;
    };
    points.swap(0, deepest);
    let first = points[0].point;
    let spread = points.iter().map(|p| (p.point - first).length_squared()).fold(0.0, kernel::math::max);
    // Points closer than a thousandth of the spread are duplicates.
    let least = spread * 1.0e-6;
    for chosen in 1..points.len() {
        let to_chosen = |i: usize| {
            let distances = points[..chosen].iter().map(|c| (c.point - points[i].point).length_squared());
            distances.fold(f32::MAX, kernel::math::min)
        };
        let farthest = (chosen..points.len()).reduce(|a, b| if to_chosen(b) > to_chosen(a) { b } else { a });
        match farthest {
            Some(i) if chosen < MAX_POINTS && to_chosen(i) > least => points.swap(chosen, i),
            _ => {
                points.truncate(chosen);
                return;
            }
        }
    }
}
