//! Contacts of collider types of the app. The type computes them before the narrow phase, which looks them
//! up.
//!
//! The narrow phase handles all pairs in one call, and does not know types of the app.

use bevy_ecs::{prelude::*, system::StaticSystemParam};
use core::any::TypeId;
use kernel::{
    contact::ContactFlags,
    manifold::{LocalManifold, LocalPoint},
    math::{Pose, WorldPose},
};
use std::collections::BTreeMap;

use super::{
    collider::{AnyCollider, ContactManifoldContext},
    contact_types::{ContactManifold, ContactPoint},
    local_points::reduce,
    narrow_phase::input::Settings,
};
use crate::{
    dynamics::tables::{Bodies, Colliders, Contacts},
    math::{Scalar, to_f32, vector_to_kernel, world_to_kernel},
    physics_transform::pose_from_kernel,
};

/// The manifolds of a pair.
#[derive(Clone, Debug)]
struct CustomContact {
    colliders: [u32; 2],
    /// The pose of B in A's frame for which the manifolds were computed.
    pose: Pose,
    manifolds: Vec<LocalManifold>,
}

/// The manifolds of all pairs of collider types of the app in this step: by type, sorted by pair.
#[derive(Resource, Default)]
pub(crate) struct CustomContacts(BTreeMap<TypeId, Vec<CustomContact>>);

impl CustomContacts {
    /// Adds the manifolds of a pair, if they were computed for this pose.
    pub(super) fn find(&self, colliders: [u32; 2], pose: &Pose, out: &mut Vec<LocalManifold>) {
        for contacts in self.0.values() {
            let found = contacts.binary_search_by_key(&colliders, |contact| contact.colliders);
            if let Ok(place) = found
                && contacts[place].pose == *pose
            {
                out.extend_from_slice(&contacts[place].manifolds);
            }
        }
    }
}

/// Computes the manifolds of all awake pairs of colliders of one type.
pub(crate) fn find_custom_contacts<C: AnyCollider>(
    shapes: Query<&C>,
    context: StaticSystemParam<C::Context>,
    settings: Settings,
    (bodies, colliders, contacts): (Res<Bodies>, Res<Colliders>, Res<Contacts>),
    mut all: ResMut<CustomContacts>,
    mut found: Local<Vec<ContactManifold>>,
) {
    let input = settings.input(&bodies.table, &colliders.table, &());
    let list = all.0.entry(TypeId::of::<C>()).or_default();
    list.clear();
    for id in contacts.table.active() {
        let contact = contacts.table.get(id);
        if !contact.flags.has(ContactFlags::FOREIGN) {
            continue;
        }
        let [entity1, entity2] = contact.colliders.map(|id| colliders.entities[id as usize]);
        let Ok([first, second]) = shapes.get_many([entity1, entity2]) else { continue };
        let (pose, prediction) = input.foreign_view(contact);
        let worlds = contact.colliders.map(|id| colliders.table.poses[id as usize]);
        let [(position1, rotation1), (position2, rotation2)] = worlds.map(pose_from_kernel);
        found.clear();
        first.contact_manifolds_with_context(
            second,
            position1.0,
            rotation1,
            position2.0,
            rotation2,
            Scalar::from(prediction),
            &mut found,
            ContactManifoldContext::new(entity1, entity2, &*context),
        );
        let manifolds = found.iter().filter_map(|m| to_local(m, &worlds[0], prediction)).collect();
        list.push(CustomContact { colliders: contact.colliders, pose, manifolds });
    }
    list.sort_unstable_by_key(|contact| contact.colliders);
}

/// A manifold in the frame of its first collider; `None` without a usable normal and points.
fn to_local(manifold: &ContactManifold, first: &WorldPose, prediction: f32) -> Option<LocalManifold> {
    let normal = vector_to_kernel(manifold.normal);
    let length = normal.length();
    if !(length > 0.5 && length.is_finite()) {
        return None;
    }
    let mut points: Vec<LocalPoint> = manifold
        .points
        .iter()
        .zip(1..)
        .map(|(point, number)| {
            let at = first.inverse_transform(world_to_kernel(point.point));
            LocalPoint::new(at, -to_f32(point.penetration), feature_of(point, number))
        })
        .filter(|p| p.separation <= prediction && p.separation.is_finite() && p.point.is_finite())
        .collect();
    reduce(&mut points);
    let normal = first.rotation.inverse_rotate(normal * (1.0 / length));
    let mut local = LocalManifold { normal, ..LocalManifold::default() };
    for p in points {
        local.add(p);
    }
    (local.count > 0).then_some(local)
}

/// Identifies a point in the next step: by its features, or by its number if they are unknown.
fn feature_of(point: &ContactPoint, number: u32) -> u32 {
    match (point.feature_id1.0, point.feature_id2.0) {
        (0, 0) => number,
        (a, b) => a.rotate_left(16) ^ b,
    }
}
