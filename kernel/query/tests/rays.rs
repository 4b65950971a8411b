//! No ray passes between facets that share a vertex or an edge.

use super::dim::{lattice, star};
use super::pose;
use crate::math::{Pose, Vector, WorldPose};
use crate::query::Ray;
use crate::shape::{Part, Shape};
use proptest::prelude::*;

/// A point on the border of a facet: the facet, a corner, and the fraction of the side to the next corner.
type Aim = (prop::sample::Index, u8, f32);

fn aims() -> impl Strategy<Value = Vec<Aim>> {
    let along = prop_oneof![Just(0.0f32), 0.0..1.0f32];
    prop::collection::vec((any::<prop::sample::Index>(), 0..3u8, along), 400)
}

/// The aimed point, in the shape's frame.
fn point(shape: &Shape, (facet, corner, along): &Aim) -> Vector {
    let Shape::Composite(surface) = shape else { unreachable!("a surface") };
    let Part::Facet(facet) = surface.part(facet.index(surface.len()) as u32) else { unreachable!("a facet") };
    let corners = super::dim::corners(&facet);
    let [a, b] = [0, 1].map(|next| corners[(usize::from(*corner) + next) % corners.len()]);
    a + (b - a) * *along
}

/// Whether a ray from a point through another, both in the shape's frame, hits the shape at a pose.
fn is_hit(shape: &Shape, at: &Pose, from: Vector, to: Vector) -> bool {
    let [from, to] = [from, to].map(|p| at.transform(p).to_world());
    let ray = Ray::new(from, to - from, 1.0e9, false).expect("a direction");
    let pose = WorldPose { position: at.position.to_world(), rotation: at.rotation };
    ray.hit(0, shape, &pose, ray.max_distance()).is_some()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn a_closed_surface_is_left_by_no_ray(
        (shape, size) in star(),
        at in pose(3.0),
        from in super::vector(0.1),
        aims in aims(),
    ) {
        for aim in &aims {
            let to = point(&shape, aim);
            prop_assert!(is_hit(&shape, &at, from * size, to), "{from:?} {to:?}");
        }
    }

    #[test]
    fn a_wall_of_facets_has_no_gaps(
        (shape, size) in lattice(),
        at in prop_oneof![Just(Pose::IDENTITY), pose(3.0)],
        from in super::vector(1.0),
        aims in aims(),
    ) {
        // The wall is across y.
        prop_assume!(from.y.abs() > 0.01);
        for aim in &aims {
            let to = point(&shape, aim);
            let is_inner = to.to_array().iter().enumerate().all(|(i, c)| i == 1 || c.abs() < 0.9 * size);
            if is_inner {
                prop_assert!(is_hit(&shape, &at, from * (2.0 * size), to), "{from:?} {to:?}");
                prop_assert!(is_hit(&shape, &at, to + from, to), "{from:?} {to:?} near");
                prop_assert!(is_hit(&shape, &at, to + Vector::Y * from.y, to), "{from:?} {to:?} across");
            }
        }
    }
}
