//! Reads the transforms that bodies follow: at the start of each frame, and before each step.

use bevy_ecs::{prelude::*, system::SystemParam};
use bevy_time::{Fixed, Time, Virtual};
use bevy_transform::components::Transform;

use super::{
    Position, Rotation,
    follow::{FollowTransform, Followed, Lead, Place},
    frame::read_pose,
    sync::{SyncTicks, parent_frame, warn_non_finite},
    tree::Parents,
};
use crate::{
    dynamics::rigid_body::{RigidBody, RigidBodyDisabled},
    math::Scalar,
    schedule::OnThisThread,
};

/// Whether the fixed loop of this frame is running.
#[derive(Resource, Default)]
pub(crate) struct InFixedLoop(bool);

/// Computes the poses that the transforms of following bodies give.
#[derive(SystemParam)]
pub(crate) struct Places<'w, 's> {
    transforms: Query<'w, 's, &'static Transform>,
    parents: Parents<'w, 's>,
    ticks: ResMut<'w, SyncTicks>,
}

impl Places<'_, '_> {
    /// The pose given by a body's transform. `None` without a transform, and with a warning if it is not
    /// finite. If the transform has no rotation, the body's rotation is used.
    fn of(&mut self, entity: Entity, rotation: &Rotation) -> Option<Place> {
        let transform = self.transforms.get(entity).ok()?;
        let parent = parent_frame(entity, &self.parents, |e| self.transforms.get(e).ok().copied());
        let (position, turned) = read_pose(parent.as_ref(), transform);
        warn_non_finite(entity, transform, &position, &mut self.ticks.reported);
        let is_finite = position.is_finite() && transform.rotation.is_finite();
        is_finite.then(|| (Position(position), turned.unwrap_or(*rotation)))
    }
}

/// Records the transforms at the start of a frame, before the fixed loop.
pub(crate) fn begin_frame(
    mut followers: Query<(Entity, &Rotation, &mut Followed)>,
    mut places: Places,
    mut in_loop: ResMut<InFixedLoop>,
) {
    in_loop.0 = true;
    for (entity, rotation, mut followed) in &mut followers {
        if followed.is_led()
            && let Some(now) = places.of(entity, rotation)
        {
            followed.begin_frame(now);
        }
    }
}

/// Records that the fixed loop is over.
pub(crate) fn end_fixed_loop(mut in_loop: ResMut<InFixedLoop>) {
    in_loop.0 = false;
}

/// Sets the target of each body that follows its transform, before a step.
pub(crate) fn aim(
    mut followers: Query<(
        Entity,
        &RigidBody,
        Has<RigidBodyDisabled>,
        Has<FollowTransform>,
        &Rotation,
        &mut Followed,
    )>,
    mut places: Places,
    in_loop: Res<InFixedLoop>,
    frame: Option<Res<Time<Virtual>>>,
    ticks: Option<Res<Time<Fixed>>>,
    _: OnThisThread,
) {
    let share = match (frame, ticks) {
        (Some(frame), Some(ticks)) if in_loop.0 && !frame.delta().is_zero() => {
            let left = ticks.overstep().as_secs_f64() / frame.delta().as_secs_f64();
            (1.0 - left).clamp(0.0, 1.0) as Scalar
        }
        _ => 1.0,
    };
    for (entity, body, is_disabled, follows, rotation, mut followed) in &mut followers {
        if !body.is_kinematic() || is_disabled || !follows {
            *followed = Followed::default();
            continue;
        }
        if followed.lead == Lead::Pose {
            followed.lead = Lead::Transform;
        }
        if followed.is_led()
            && let Some(now) = places.of(entity, rotation)
        {
            followed.aim(now, share);
        }
    }
}
