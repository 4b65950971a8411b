//! Kinematic bodies that follow their `Transform`: their targets at the end of a step.
//!
//! The app writes a `Transform` once a frame, and steps are taken at other times. A body follows the line
//! between the transforms of the last two frames: over the ticks of this frame it moves from the older to the
//! newer transform. This gives it the same velocity at any number of ticks per frame.
//!
//! ```text
//! frame        f-2        f-1         f
//! app writes   T₂         T₁
//! ticks                        k          pose at tick k = T₂ + (T₁ - T₂) · (time of k - start of f) / length of f
//! ```
//!
//! If the `Transform` changed within the fixed loop, or the step is taken outside of it, the target is the
//! current `Transform`.

use bevy_ecs::prelude::*;
use bevy_reflect::prelude::*;
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};

use super::{Position, Rotation};
use crate::math::Scalar;

/// Moves a kinematic body to its `Transform` by velocity instead of teleporting it. It carries bodies that
/// stand on it, and hits bodies in its way with its true velocity.
///
/// The app animates the `Transform` of the body or of an entity above it, once a frame or in each tick. The
/// engine sets [`LinearVelocity`](crate::prelude::LinearVelocity) and
/// [`AngularVelocity`](crate::prelude::AngularVelocity) before each step, so that the body reaches the
/// `Transform` in the step. They are zero when the `Transform` no longer moves. Values that the app writes to
/// them are overwritten.
///
/// - If the `Transform` is written in `Update` while physics runs in fixed ticks, the body is one frame
///   behind its `Transform`, and moves evenly: at 64 ticks a second its velocity is right with 30 frames as
///   with 144.
/// - The engine does not write the `Transform`. The app may animate it by `translation += …`.
/// - A jump of the `Transform` is a motion like any other: 10 m in a tick are 640 m/s. To teleport the body,
///   set its [`Position`] or [`Rotation`]: the body is there at once, at rest, and its `Transform` is
///   written.
/// - A `Transform` that moved while physics was paused also teleports the body.
///
/// It has no effect on dynamic, static and disabled bodies. Do not use it with `TransformInterpolation`: a
/// `Transform` animated by the app needs no easing. Beyond Avian.
///
/// ```
/// # use avian::prelude::*;
/// # use bevy_ecs::prelude::*;
/// # use bevy_time::Time;
/// # use bevy_transform::components::Transform;
/// #[derive(Component)]
/// struct Lift;
///
/// fn setup(mut commands: Commands) {
///     commands.spawn((Lift, RigidBody::Kinematic, FollowTransform, Collider::capsule(1.0, 2.0), Transform::default()));
/// }
///
/// /// In `Update`.
/// fn animate(time: Res<Time>, mut lifts: Query<&mut Transform, With<Lift>>) {
///     for mut transform in &mut lifts {
///         transform.translation.y = 2.0 * time.elapsed_secs().sin();
///     }
/// }
/// ```
#[derive(Component, Reflect, Clone, Copy, Debug, Default, PartialEq, Eq)]
#[reflect(Component, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serialize",
    derive(serde::Serialize, serde::Deserialize),
    reflect(Serialize, Deserialize)
)]
#[require(Followed)]
pub struct FollowTransform;

/// A pose in the world.
pub(crate) type Place = (Position, Rotation);

/// Whether the app sets the pose or the transform.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Lead {
    /// The body is new, or has just started to follow.
    #[default]
    Fresh,
    /// The app set the pose before the last step. The pose was written to the transform.
    Pose,
    /// The body follows its transform.
    Transform,
}

/// The state of a body that follows its transform.
#[derive(Component, Clone, Copy, Debug, Default)]
pub(crate) struct Followed {
    pub(crate) lead: Lead,
    /// The transforms at the start of the last frame and of this frame.
    frames: Option<[Place; 2]>,
    /// The target pose at the end of the next step.
    target: Option<Place>,
    /// The previous target was replaced before a step took it.
    is_late: bool,
    /// The target pose of the last step.
    reached: Option<Place>,
}

/// The target pose of a body at the end of a step.
pub(crate) struct Target {
    pub(crate) place: Place,
    /// The target of the last step was the same.
    pub(crate) is_same: bool,
    /// Steps were skipped, so the body must be teleported to the target.
    pub(crate) is_late: bool,
}

impl Followed {
    /// Whether the app sets the transform, and the engine does not write it.
    pub(crate) fn is_led(&self) -> bool {
        self.lead == Lead::Transform
    }

    /// Stops following, because the app set a pose.
    pub(crate) fn stop(&mut self) {
        *self = Self { lead: Lead::Pose, ..Self::default() };
    }

    /// Takes the target for a step. `None` if no target was set, for example for steps taken by hand.
    pub(crate) fn take(&mut self) -> Option<Target> {
        let is_late = core::mem::take(&mut self.is_late);
        let place = self.target.take()?;
        let is_same = self.reached.replace(place) == Some(place);
        Some(Target { place, is_same, is_late })
    }

    /// Starts a frame with its current transform.
    pub(super) fn begin_frame(&mut self, now: Place) {
        let last = self.frames.map_or(now, |[_, last]| last);
        self.frames = Some([last, now]);
    }

    /// Sets the target from the current transform and the elapsed fraction of this frame.
    pub(super) fn aim(&mut self, now: Place, share: Scalar) {
        let [from, to] = self.frames.filter(|[_, last]| *last == now).unwrap_or([now; 2]);
        self.frames = Some([from, to]);
        let between = || {
            let at = from.0.0 + (to.0.0 - from.0.0) * share;
            (Position(at), from.1.slerp(to.1, share))
        };
        self.is_late |= self.target.is_some();
        self.target = Some(if from == to || share >= 1.0 { to } else { between() });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Vector;

    fn at(x: Scalar) -> Place {
        (Position(Vector::X * x), Rotation::IDENTITY)
    }

    fn next(followed: &mut Followed, now: Scalar, share: Scalar) -> Scalar {
        followed.aim(at(now), share);
        followed.take().expect("a target").place.0.x
    }

    #[test]
    fn ticks_of_a_frame_share_the_way_of_the_last_one() {
        let mut followed = Followed { lead: Lead::Transform, ..Followed::default() };
        followed.begin_frame(at(0.0));
        assert_eq!(next(&mut followed, 0.0, 0.5), 0.0);
        followed.begin_frame(at(8.0));
        assert_eq!([0.25, 0.5, 1.0].map(|share| next(&mut followed, 8.0, share)), [2.0, 4.0, 8.0]);
        // A frame without a tick.
        followed.begin_frame(at(10.0));
        followed.begin_frame(at(12.0));
        assert_eq!(next(&mut followed, 12.0, 0.5), 11.0);
        // Within the loop the app knows the time of the tick.
        assert_eq!(next(&mut followed, 20.0, 0.5), 20.0);
        followed.begin_frame(at(20.0));
        assert_eq!(next(&mut followed, 20.0, 0.5), 20.0);
    }

    #[test]
    fn targets_that_no_step_took_make_the_next_one_late() {
        let mut followed = Followed { lead: Lead::Transform, ..Followed::default() };
        let mut take = |times: usize| {
            (0..times).for_each(|_| followed.aim(at(1.0), 1.0));
            followed.take().map(|target| (target.is_late, target.is_same))
        };
        assert_eq!(take(1), Some((false, false)));
        assert_eq!(take(1), Some((false, true)));
        assert_eq!(take(0), None);
        assert_eq!(take(3), Some((true, true)));
        assert_eq!(take(1), Some((false, true)));
    }
}
