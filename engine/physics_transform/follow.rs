//! Kinematic bodies that follow their `Transform`: where they have to be at the end of a step.
//!
//! The app writes a `Transform` once a frame, and steps are taken at other times. What a body follows is the
//! line between the transforms of the last two frames: over the ticks of this frame it moves from one to the
//! other, so that it has the same velocity at any number of ticks per frame.
//!
//! ```text
//! frame        f-2        f-1         f
//! app writes   T₂         T₁
//! ticks                        k          pose at tick k = T₂ + (T₁ - T₂) · (time of k - start of f) / length of f
//! ```
//!
//! A `Transform` that changed within the fixed loop, or outside of it, is where the body has to be at once.

use bevy_ecs::prelude::*;
use bevy_reflect::prelude::*;
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};

use super::{Position, Rotation};
use crate::math::Scalar;

/// Lets a kinematic body go where its `Transform` is by velocity, instead of teleporting it there: what
/// stands on it is carried, what is in its way is hit with its true velocity.
///
/// The app animates the `Transform` of the body or of an entity above it, once a frame or in each tick. The
/// engine sets [`LinearVelocity`](crate::prelude::LinearVelocity) and
/// [`AngularVelocity`](crate::prelude::AngularVelocity) before each step, so that the body gets there in the
/// step; they are zero when the `Transform` no longer moves. What the app writes to them is overwritten.
///
/// - Written in `Update` while physics runs in fixed ticks, the body is one frame behind its `Transform`, and
///   moves evenly: at 64 ticks a second its velocity is right with 30 frames as with 144.
/// - The engine does not write the `Transform`: it stays as the app animates it, also with
///   `translation += …`.
/// - A jump of the `Transform` is a motion like any other: 10 m in a tick are 640 m/s. To teleport the body,
///   set its [`Position`] or [`Rotation`]: it is there at once and at rest, and its `Transform` is written.
/// - A `Transform` that moved while physics was paused is such a teleport.
///
/// Without effect on dynamic and static bodies, and while the body is disabled. Not for bodies with
/// `TransformInterpolation`: what the app animates needs no easing. Beyond Avian.
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

/// Which of pose and transform the app sets.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Lead {
    /// The body is new, or was none that follows.
    #[default]
    Fresh,
    /// A step was taken with a pose that the app set. It was written to the transform.
    Pose,
    /// The body follows its transform.
    Transform,
}

/// How far a body followed its transform.
#[derive(Component, Clone, Copy, Debug, Default)]
pub(crate) struct Followed {
    pub(crate) lead: Lead,
    /// The transform at the start of the last frame and of this one.
    frames: Option<[Place; 2]>,
    /// The end of the next step.
    target: Option<Place>,
    /// No step was taken with a target before this one.
    is_late: bool,
    /// The end of the last step.
    reached: Option<Place>,
}

/// Where a body has to be at the end of a step.
pub(crate) struct Target {
    pub(crate) place: Place,
    /// It was there in the last step already.
    pub(crate) is_same: bool,
    /// Steps were left out, so that the body has to be put there.
    pub(crate) is_late: bool,
}

impl Followed {
    /// Whether the transform is the app's, and not written.
    pub(crate) fn is_led(&self) -> bool {
        self.lead == Lead::Transform
    }

    /// Ends following: the app set a pose.
    pub(crate) fn stop(&mut self) {
        *self = Self { lead: Lead::Pose, ..Self::default() };
    }

    /// Takes the target for a step. `None` if there is none for it, as for steps taken by hand.
    pub(crate) fn take(&mut self) -> Option<Target> {
        let is_late = core::mem::take(&mut self.is_late);
        let place = self.target.take()?;
        let is_same = self.reached.replace(place) == Some(place);
        Some(Target { place, is_same, is_late })
    }

    /// Starts a frame with a transform.
    pub(super) fn begin_frame(&mut self, now: Place) {
        let last = self.frames.map_or(now, |[_, last]| last);
        self.frames = Some([last, now]);
    }

    /// Sets the target from the transform as it is, and the share of this frame that has passed.
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
