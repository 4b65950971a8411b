//! The bodies around characters, and their motion in the coming step.

use bevy_ecs::{prelude::*, system::SystemParam};

use super::controller::{CharacterController, SurfaceVelocity};
use crate::{
    collision::collider::collider_hierarchy::{ColliderOf, RigidBodyColliders},
    dynamics::rigid_body::{AngularVelocity, RigidBody, RigidBodyDisabled, RigidBodyQueryReadOnly},
    math::{
        AdjustPrecision, AngularVector, Scalar, Vector, angular_to_kernel, inv_inertia_to_kernel, to_f32,
        vector_from_kernel, vector_to_kernel,
    },
    physics_transform::{Position, Rotation, pose_from_kernel, world_pose},
};

/// The load in N, of a mass under gravity, that a body bears after another step in which it yielded by a
/// speed.
///
/// The load that the body can bear is not known, and the whole weight at once would throw a light limb that
/// lies on nothing. So each step adds the force that accelerates the mass and the body together by gravity,
/// at least `growth` times the load, and subtracts the force that made the body yield.
pub(super) fn borne(
    load: Scalar,
    yielded: Scalar,
    (mass, gravity): (Scalar, Scalar),
    (inverse, growth): (Scalar, Scalar),
    time: Scalar,
) -> Scalar {
    let more = (gravity - yielded / time) / (1.0 / mass + inverse);
    let more = if more > 0.0 { more.max(growth * load) } else { more };
    (load + more).min(mass * gravity).max(0.0)
}

/// The bodies and their colliders.
#[derive(SystemParam)]
pub(super) struct BodiesAround<'w, 's> {
    states: Query<'w, 's, RigidBodyQueryReadOnly, Without<RigidBodyDisabled>>,
    owners: Query<'w, 's, &'static ColliderOf>,
    colliders: Query<'w, 's, &'static RigidBodyColliders>,
    surfaces: Query<'w, 's, (&'static Rotation, &'static SurfaceVelocity)>,
    characters: Query<'w, 's, (), (With<CharacterController>, Without<RigidBodyDisabled>)>,
    movers:
        Query<'w, 's, Entity, (With<RigidBody>, Without<CharacterController>, Without<RigidBodyDisabled>)>,
}

impl BodiesAround<'_, '_> {
    /// The body of a collider.
    pub(super) fn body_of(&self, collider: Entity) -> Option<Entity> {
        self.owners.get(collider).ok().map(|of| of.body)
    }

    /// Whether a body is dynamic.
    pub(super) fn is_dynamic(&self, body: Entity) -> bool {
        self.states.get(body).is_ok_and(|state| state.rb.is_dynamic())
    }

    /// Whether a body is a kinematic character.
    pub(super) fn is_character(&self, body: Entity) -> bool {
        self.characters.contains(body)
    }

    /// The position of the body of a collider.
    pub(super) fn position_of(&self, collider: Entity) -> Option<Vector> {
        self.states.get(self.body_of(collider)?).ok().map(|state| state.position.0)
    }

    /// The colliders of a body.
    pub(super) fn colliders_of(&self, body: Entity) -> impl Iterator<Item = Entity> + '_ {
        self.colliders.get(body).into_iter().flat_map(|colliders| colliders.iter())
    }

    /// The motion of a body in the next step; `None` if the entity is not a body.
    pub(super) fn motion_of(&self, body: Entity, time: Scalar) -> Option<Motion> {
        let state = self.states.get(body).ok()?;
        let moves = !state.rb.is_static();
        Some(Motion {
            kind: *state.rb,
            is_character: self.is_character(body),
            position: *state.position,
            rotation: *state.rotation,
            center: state.position.0 + *state.rotation * state.center_of_mass.0,
            velocity: if moves { state.linear_velocity.0 } else { Vector::ZERO },
            spin: if moves { state.angular_velocity.0 } else { AngularVelocity::ZERO.0 },
            time,
        })
    }

    /// The inverse effective mass of a body at a point along a direction, in 1/kg: zero for bodies that
    /// impulses do not move.
    pub(super) fn inverse_mass_at(&self, body: Entity, point: Vector, direction: Vector) -> Scalar {
        let Ok(state) = self.states.get(body) else { return 0.0 };
        let center = state.position.0 + *state.rotation * state.center_of_mass.0;
        let linear = (direction * direction * state.effective_inverse_mass()).element_sum();
        let lever = vector_to_kernel(point - center).cross(vector_to_kernel(direction));
        let inertia = inv_inertia_to_kernel(state.effective_global_angular_inertia().inverse());
        linear + inertia.apply(lever).dot(lever).adjust_precision()
    }

    /// The velocity of the surface of a collider, in world axes, in m/s.
    pub(super) fn surface_of(&self, collider: Entity) -> Vector {
        self.surfaces.get(collider).map_or(Vector::ZERO, |(rotation, surface)| *rotation * surface.0)
    }

    /// The kinematic bodies that move in the next step, without characters.
    pub(super) fn pushers(&self, time: Scalar) -> Vec<Motion> {
        let moving = self.movers.iter().filter_map(|body| self.motion_of(body, time));
        moving.filter(|body| body.kind.is_kinematic() && body.is_moving()).collect()
    }
}

/// The motion of a body in the next step, if its velocity does not change.
#[derive(Clone, Copy, Debug)]
pub(super) struct Motion {
    pub(super) kind: RigidBody,
    pub(super) is_character: bool,
    pub(super) position: Position,
    pub(super) rotation: Rotation,
    center: Vector,
    velocity: Vector,
    pub(super) spin: AngularVector,
    time: Scalar,
}

impl Motion {
    /// Whether the body moves in the step.
    pub(super) fn is_moving(&self) -> bool {
        self.velocity != Vector::ZERO || self.spin != AngularVelocity::ZERO.0
    }

    /// The maximum displacement in the step of points at most as far from the body's centre as `point`.
    pub(super) fn reach_at(&self, point: Vector) -> Scalar {
        let spin: Scalar = angular_to_kernel(self.spin).length_squared().sqrt().adjust_precision();
        (self.velocity.length() + spin * (point - self.center).length()) * self.time
    }

    /// The velocity of a point of the body, in m/s.
    pub(super) fn velocity_at(&self, point: Vector) -> Vector {
        let arm = vector_to_kernel(point - self.center);
        self.velocity + vector_from_kernel(angular_to_kernel(self.spin).cross(arm))
    }

    /// The pose of the body after the step.
    pub(super) fn end(&self) -> (Position, Rotation) {
        if !self.is_moving() {
            return (self.position, self.rotation);
        }
        let now = world_pose(&self.position, &self.rotation);
        let turn = angular_to_kernel(self.spin) * to_f32(self.time);
        let rotation = now.rotation.turned_by(turn);
        let (_, turned) = pose_from_kernel(kernel::math::WorldPose::new(now.position, rotation));
        let arm = self.rotation.inverse() * (self.center - self.position.0);
        (Position(self.center + self.velocity * self.time - turned * arm), turned)
    }

    /// The displacement of a point of the body in the step.
    pub(super) fn displacement_at(&self, point: Vector) -> Vector {
        let (position, rotation) = self.end();
        position.0 + rotation * self.to_local(point) - point
    }

    /// A point in the frame of the body.
    pub(super) fn to_local(self, point: Vector) -> Vector {
        self.rotation.inverse() * (point - self.position.0)
    }
}
