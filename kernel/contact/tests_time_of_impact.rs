//! Tests the lower bound of the time of impact against the distance at many times.

use super::{Motion, Placed, Slab};
use crate::math::{Angular, Pose, Rot, Vector, WorldPose, max, min};
use crate::query::closest;
use crate::query::tests::{convex, pose, vector};
use crate::shape::Shape;
use crate::table::{BodyPose, Reach};
use crate::tuning::sweeps::MOST_TURN;
use proptest::prelude::*;

/// A body with one shape in the body's frame.
#[derive(Debug)]
struct Body {
    frame: Pose,
    /// The centre of mass, in the frame.
    center: Vector,
    linear: Vector,
    angular: Angular,
}

impl Body {
    fn center(&self, time: f32) -> Vector {
        self.frame.transform(self.center) + self.linear * time
    }

    fn turn(&self, time: f32) -> Rot {
        Rot::IDENTITY.turned_by(self.angular * time)
    }

    fn frame(&self, time: f32) -> Pose {
        let rotation = self.turn(time).mul(self.frame.rotation);
        Pose { position: self.center(time) - rotation.rotate(self.center), rotation }
    }

    fn placed(&self) -> Placed {
        let frame = &self.frame;
        let shape = WorldPose { position: frame.position.to_world(), rotation: frame.rotation };
        let center = self.center(0.0).to_world();
        let body = BodyPose { center, rotation: frame.rotation, ..BodyPose::default() };
        Placed { body, turn: Rot::IDENTITY, shape }
    }

    /// How far the shape reaches from the centre of mass.
    fn reach(&self, shape: &Shape) -> f32 {
        let (middle, radius) = shape.ball_around();
        (middle - self.center).length() + radius
    }
}

fn body() -> impl Strategy<Value = Body> {
    let size = prop_oneof![Just(0.0f32), 0.0f32..2.0, 0.0f32..40.0];
    (pose(2.0), vector(0.5), vector(20.0), vector(1.0), vector(1.0), size).prop_map(
        |(frame, center, linear, u, v, size)| Body { frame, center, linear, angular: u.cross(v) * size },
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4_000))]

    #[test]
    fn shapes_do_not_meet_sooner_than_is_said(a in convex(), b in convex(), of_a in body(), of_b in body()) {
        let bodies = [&of_a, &of_b];
        let relative = |time: f32| of_a.frame(time).inverse().then(&of_b.frame(time));
        let found = closest(&a, &b, &relative(0.0), f32::MAX).expect("a distance");
        let (gap, normal) = (found.distance, of_a.frame.rotation.rotate(found.normal));
        if gap <= 1.0e-3 {
            return Ok(());
        }
        let reaches = [of_a.reach(&a), of_b.reach(&b)];
        let reaches = reaches.map(|extent| Reach { extent, arm: extent, ..Reach::default() });
        let spins = bodies.map(|body| body.angular.length());
        let motion = Motion {
            linear: of_b.linear - of_a.linear,
            angular: bodies.map(|body| body.angular),
            spins,
            reaches: reaches.each_ref(),
            met: 1.0e-3,
        };
        let offset = of_b.center(0.0) - of_a.center(0.0);
        let placed = bodies.map(Body::placed);
        let slab = Slab { shapes: [&a, &b], placed: &placed, motion: &motion, offset, margin: 0.0 };
        let end = min(1.0 / 60.0, MOST_TURN / max(spins[0], spins[1]));
        let time = slab.time_to_cross(normal, gap, end);
        prop_assert!(time >= 0.0, "{time}");
        for k in 1..=20 {
            let at = min(time, end) * (k as f32 / 20.0);
            let distance = closest(&a, &b, &relative(at), f32::MAX).expect("a distance").distance;
            prop_assert!(distance > -1.0e-4, "after {at} of {time} s they overlap by {}", -distance);
        }
    }
}
