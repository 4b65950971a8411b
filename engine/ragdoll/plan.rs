//! The measures of a human, relative to its height and mass. After D. A. Winter, "Biomechanics and Motor
//! Control of Human Movement": lengths of segments (figure 4.1) and their masses (table 4.1), hands with
//! forearms and feet with shins. Thicknesses are chosen so that only neighbouring bones overlap.

use super::bone::Bone;
use crate::math::Scalar;

/// A bone in the plane of the chest, relative to the middle of the hips, with arms and legs hanging down.
/// Lengths are parts of the height.
#[derive(Clone, Copy)]
pub(super) struct Plan {
    /// The ends of the capsule's segment.
    pub(super) from: [Scalar; 2],
    pub(super) to: [Scalar; 2],
    pub(super) radius: Scalar,
    /// Part of the mass.
    pub(super) mass: Scalar,
    /// The joint with the parent.
    pub(super) joint: [Scalar; 2],
}

impl Plan {
    /// The middle of the segment.
    pub(super) fn center(&self) -> [Scalar; 2] {
        core::array::from_fn(|i| 0.5 * (self.from[i] + self.to[i]))
    }

    /// A point relative to the middle of the segment.
    pub(super) fn relative_to_center(&self, point: [Scalar; 2]) -> [Scalar; 2] {
        let center = self.center();
        core::array::from_fn(|i| point[i] - center[i])
    }
}

/// The measures of a bone.
pub(super) fn plan(bone: Bone) -> Plan {
    let of = |from, to, radius, mass, joint| Plan { from, to, radius, mass, joint };
    let mut plan = match bone {
        Bone::Pelvis => of([-0.035, 0.035], [0.035, 0.035], 0.06, 0.142, [0.0, 0.0]),
        Bone::Chest => of([0.0, 0.135], [0.0, 0.215], 0.085, 0.355, [0.0, 0.08]),
        Bone::Head => of([0.0, 0.39], [0.0, 0.41], 0.06, 0.081, [0.0, 0.315]),
        Bone::LeftUpperArm | Bone::RightUpperArm => {
            of([0.14, 0.27], [0.14, 0.12], 0.026, 0.028, [0.14, 0.288])
        }
        Bone::LeftForearm | Bone::RightForearm => {
            of([0.14, 0.085], [0.14, -0.13], 0.022, 0.022, [0.14, 0.102])
        }
        Bone::LeftThigh | Bone::RightThigh => of([0.06, -0.03], [0.06, -0.22], 0.042, 0.1, [0.06, 0.0]),
        Bone::LeftShin | Bone::RightShin => of([0.06, -0.27], [0.06, -0.498], 0.032, 0.061, [0.06, -0.245]),
    };
    for point in [&mut plan.from, &mut plan.to, &mut plan.joint] {
        point[0] *= bone.side();
    }
    plan
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_make_a_whole_and_both_sides_are_alike() {
        let mass: Scalar = Bone::ALL.iter().map(|bone| plan(*bone).mass).sum();
        assert!((mass - 1.0).abs() < 1e-6, "{mass}");
        let ends = |bone: &Bone| {
            let plan = plan(*bone);
            [
                plan.from[1] - plan.radius,
                plan.to[1] - plan.radius,
                plan.from[1] + plan.radius,
                plan.to[1] + plan.radius,
            ]
        };
        let all: Vec<Scalar> = Bone::ALL.iter().flat_map(ends).collect();
        let [low, high] =
            [all.iter().copied().fold(0.0, Scalar::min), all.iter().copied().fold(0.0, Scalar::max)];
        assert!((high - low - 1.0).abs() < 1e-6, "{low} to {high}");
        let (left, right) = (plan(Bone::LeftShin), plan(Bone::RightShin));
        assert_eq!((left.from[0], left.from[1]), (-right.from[0], right.from[1]));
    }

    #[test]
    fn only_neighbours_overlap() {
        for (i, a) in Bone::ALL.into_iter().enumerate() {
            for b in Bone::ALL.into_iter().skip(i + 1) {
                let (p, q) = (plan(a), plan(b));
                let along = |plan: &Plan, t: u8| -> [Scalar; 2] {
                    let t = Scalar::from(t) / 64.0;
                    core::array::from_fn(|k| plan.from[k] + (plan.to[k] - plan.from[k]) * t)
                };
                let mut gap = Scalar::INFINITY;
                for (s, t) in (0..=64).flat_map(|s| (0..=64).map(move |t| (s, t))) {
                    let (x, y) = (along(&p, s), along(&q, t));
                    let square = (x[0] - y[0]) * (x[0] - y[0]) + (x[1] - y[1]) * (x[1] - y[1]);
                    gap = gap.min(square.sqrt() - p.radius - q.radius);
                }
                if a.parent() != Some(b) && b.parent() != Some(a) {
                    assert!(gap > 0.0, "{a:?} and {b:?}: {gap}");
                }
            }
        }
    }
}
