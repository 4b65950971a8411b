//! A warning if gravity and the sizes of colliders indicate that the length unit was forgotten.
//!
//! The warning is only for worlds that no app builds on purpose: every collider on a dynamic or kinematic
//! body is out of range, and gravity agrees. One collider of ordinary size ends the search.

use bevy_ecs::prelude::*;
use bevy_log::warn;
use bevy_time::Time;
use core::time::Duration;

use super::config::PhysicsLengthUnit;
use crate::{
    collision::collider::{Collider, ColliderDisabled, SimpleCollider, collider_hierarchy::ColliderOf},
    dynamics::{integrator::Gravity, rigid_body::RigidBody},
    math::{Scalar, Vector},
    physics_transform::Rotation,
    schedule::Physics,
};

/// Duration of the search: the first bodies of a level may be its largest.
const PATIENCE: Duration = Duration::from_secs(1);

/// Thickness in length units from which bodies do not fall under gravity in metres: 50 m in every direction.
const HUGE: Scalar = 50.0;

/// Minimum gravity in length units/s² that applies to [`HUGE`] bodies. The moon has more.
const FELT: Scalar = 1.0;

/// Length in length units from which a body is large under [`HEAVY`] gravity: a lorry.
const LARGE: Scalar = 5.0;

/// Gravity in length units/s² that no game in metres has: 20 times the earth's gravity.
const HEAVY: Scalar = 200.0;

/// Length in length units up to which a body is small under [`FAINT`] gravity: a coin or a die.
const SMALL: Scalar = 0.05;

/// Gravity in length units/s² that is too small for any moon that a game would use: a fiftieth of the earth's
/// gravity.
const FAINT: Scalar = 0.2;

/// The sizes of colliders, in the app's units of length.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Sizes {
    /// The smallest extent of a collider in any direction.
    thinnest: Scalar,
    /// The length of the shortest collider.
    shortest: Scalar,
    /// The length of the longest collider.
    longest: Scalar,
}

impl Sizes {
    /// The extents of one collider along its axes.
    fn of(extents: Vector) -> Self {
        let length = extents.max_element();
        Self { thinnest: extents.min_element(), shortest: length, longest: length }
    }

    fn with(self, other: Self) -> Self {
        Self {
            thinnest: self.thinnest.min(other.thinnest),
            shortest: self.shortest.min(other.shortest),
            longest: self.longest.max(other.longest),
        }
    }
}

/// The error in the length unit.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Verdict {
    /// The length unit should be much longer.
    TooShort,
    /// The length unit should be much shorter.
    TooLong,
}

/// Judges a world by its gravity and the sizes of its moving colliders, all in the app's units of length.
/// `None` if the values may be intended.
fn judge(sizes: Sizes, gravity: Scalar, unit: Scalar) -> Option<Verdict> {
    let Sizes { thinnest, shortest, longest } = sizes;
    if !longest.is_finite() {
        return None;
    }
    let (huge, large, small) = (thinnest >= HUGE * unit, shortest >= LARGE * unit, longest <= SMALL * unit);
    if huge && gravity >= FELT * unit || large && gravity >= HEAVY * unit {
        Some(Verdict::TooShort)
    } else if small && longest > 0.0 && gravity <= FAINT * unit {
        Some(Verdict::TooLong)
    } else {
        None
    }
}

/// The state of the search.
#[derive(Resource, Clone, Copy, Default)]
pub(super) enum Search {
    /// No collider on a moving body was seen yet.
    #[default]
    Waiting,
    /// All colliders are out of range since this physics time.
    Suspicious(Duration),
    /// The world is ordinary, or the warning was given.
    Over,
}

/// Whether the search continues.
pub(super) fn goes_on(search: Res<Search>) -> bool {
    !matches!(*search, Search::Over)
}

/// Warns once if all moving bodies are out of range for a second.
pub(super) fn check_length_unit(
    mut search: ResMut<Search>,
    colliders: Query<(&Collider, &ColliderOf), Without<ColliderDisabled>>,
    bodies: Query<&RigidBody>,
    unit: Option<Res<PhysicsLengthUnit>>,
    gravity: Option<Res<Gravity>>,
    time: Option<Res<Time<Physics>>>,
) {
    let (Some(unit), Some(gravity), Some(time)) = (unit, gravity, time) else { return };
    let (unit, gravity) = (Scalar::from(unit.metres()), gravity.0.length());
    if !(gravity > 0.0) {
        return;
    }
    let mut all: Option<Sizes> = None;
    for (collider, of) in &colliders {
        if bodies.get(of.body).is_ok_and(|body| !body.is_static()) {
            let sizes = Sizes::of(collider.aabb(Vector::ZERO, Rotation::default()).size());
            let sizes = all.map_or(sizes, |all| all.with(sizes));
            if judge(sizes, gravity, unit).is_none() {
                *search = Search::Over;
                return;
            }
            all = Some(sizes);
        }
    }
    let now = time.elapsed();
    match (*search, all) {
        (_, None) | (Search::Over, _) => *search = Search::Waiting,
        (Search::Waiting, _) => *search = Search::Suspicious(now),
        (Search::Suspicious(since), _) if now.saturating_sub(since) < PATIENCE => {}
        (Search::Suspicious(_), Some(sizes)) => {
            *search = Search::Over;
            tell(sizes, gravity, unit);
        }
    }
}

fn tell(sizes: Sizes, gravity: Scalar, unit: Scalar) {
    let Sizes { shortest, longest, .. } = sizes;
    let (sizes, advice) = match judge(sizes, gravity, unit) {
        Some(Verdict::TooLong) => ("small", "Is it shorter in your app?"),
        _ => ("large", "Is it longer in your app, as in a game that counts pixels?"),
    };
    warn!(
        "everything that moves is {sizes}, {shortest} to {longest} units long, and gravity is {gravity} units/s². A metre is \
         {unit} units for physics. {advice} Then set `PhysicsPlugins::with_length_unit` to its units, and `Gravity` to 9.81 \
         times them. If all is as it should be, disable `LengthUnitCheckPlugin`."
    );
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn world(thinnest: Scalar, shortest: Scalar, longest: Scalar) -> Sizes {
        Sizes { thinnest, shortest, longest }
    }

    #[test]
    fn ordinary_worlds_are_let_be() {
        for (sizes, gravity, unit) in [
            (world(0.02, 0.1, 30.0), 9.81, 1.0),       // a room
            (world(17.0, 70.0, 70.0), 9.81, 1.0),      // an airliner
            (world(40.0, 330.0, 330.0), 9.81, 1.0),    // a carrier
            (world(900.0, 900.0, 5000.0), 0.005, 1.0), // asteroids
            (world(1.0, 1.0, 2.0), 500.0, 1.0),        // an arcade game with snappy jumps
            (world(0.01, 0.02, 0.03), 9.81, 1.0),      // dice
            (world(0.01, 0.02, 0.03), 1.62, 1.0),      // dice on the moon
            (world(8.0, 16.0, 64.0), 981.0, 100.0),    // pixels
            (world(2.0, 3.0, 4.0), 981.0, 100.0),      // pixel dust
            (world(32.0, 32.0, 64.0), 9.81, 100.0),    // pixels in slow motion
            (world(5.0, 5.0, 9.0), 0.0, 100.0),        // a top-down game's bullets
        ] {
            assert_eq!(judge(sizes, gravity, unit), None, "{sizes:?}, {gravity}, {unit}");
        }
    }

    #[test]
    fn forgotten_units_are_found() {
        for (sizes, gravity, unit, verdict) in [
            (world(50.0, 50.0, 200.0), 9.81, 1.0, Verdict::TooShort),
            (world(6.0, 16.0, 64.0), 981.0, 1.0, Verdict::TooShort),
            (world(32.0, 48.0, 48.0), 1000.0, 1.0, Verdict::TooShort),
            (world(0.5, 0.5, 2.0), 9.81, 100.0, Verdict::TooLong),
        ] {
            assert_eq!(judge(sizes, gravity, unit), Some(verdict), "{sizes:?}, {gravity}, {unit}");
        }
    }

    proptest! {
        /// Units of length are the app's choice, and more colliders never make a world suspicious.
        #[test]
        fn the_verdict_is_that_of_all_and_of_any_unit(
            a in 1.0e-3..1.0e4_f64, b in 1.0e-3..1.0e4_f64, gravity in 1.0e-3..1.0e4_f64, exponent in -6..6_i32,
        ) {
            let (a, b) = (Sizes::of(Vector::splat(a as Scalar)), Sizes::of(Vector::splat(b as Scalar)));
            let gravity = gravity as Scalar;
            if let Some(verdict) = judge(a.with(b), gravity, 1.0) {
                prop_assert_eq!([judge(a, gravity, 1.0), judge(b, gravity, 1.0)], [Some(verdict); 2]);
            }
            let unit = Scalar::powi(2.0, exponent);
            let scaled = world(a.thinnest * unit, a.shortest * unit, a.longest * unit);
            prop_assert_eq!(judge(scaled, gravity * unit, unit), judge(a, gravity, 1.0));
        }
    }

    #[test]
    fn what_is_not_a_number_is_no_verdict() {
        for wrong in [Scalar::NAN, Scalar::INFINITY, 0.0, -1.0] {
            assert_eq!(judge(Sizes::of(Vector::splat(wrong)), 9.81, 100.0), None, "{wrong}");
        }
        assert_eq!(judge(world(60.0, 60.0, 60.0), Scalar::NAN, 1.0), None);
    }
}
