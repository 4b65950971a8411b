//! Contacts of shapes that the kernel does not support: parry's manifolds in the kernel's convention.

use super::{Collider, dim};
use crate::collision::local_points::reduce;
use crate::math::{Scalar, Vector, vector_to_kernel};
use crate::parry::query::{
    ContactManifold, ContactManifoldsWorkspace, DefaultQueryDispatcher, PersistentQueryDispatcher,
    TrackedContact,
};
use crate::parry::shape::SharedShape;
use kernel::manifold::{LocalManifold, LocalPoint};
use kernel::math::Pose;

/// Appends the contact manifolds of two colliders. The kernel does not support the shape of at least one.
///
/// `pose` is the pose of `b` in the frame of `a`. See [`parry_manifolds`].
pub(crate) fn foreign_manifolds(
    a: &Collider,
    b: &Collider,
    pose: &Pose,
    prediction: f32,
    out: &mut Vec<LocalManifold>,
) {
    parry_manifolds(a.shape_scaled(), b.shape_scaled(), pose, prediction, out);
}

/// Appends the contact manifolds of a collider and a ball, whose centre is given in the collider's frame.
pub(crate) fn foreign_ball_manifolds(
    collider: &Collider,
    center: kernel::math::Vector,
    radius: f32,
    prediction: f32,
    out: &mut Vec<LocalManifold>,
) {
    let ball = SharedShape::ball(Scalar::from(radius));
    let pose = Pose { position: center, ..Pose::IDENTITY };
    parry_manifolds(collider.shape_scaled(), &ball, &pose, prediction, out);
}

/// Appends the contact manifolds of two shapes: one for convex shapes, one per touching part for composite
/// ones, none for pairs that parry does not support.
///
/// `pose` is the pose of shape 2 in the frame of shape 1. Manifolds are in that frame. Normals point from 1
/// to 2. Points are midway between the surfaces, separated by at most `prediction` metres. A manifold has at
/// most `MAX_POINTS` points: the deepest, and the points that spread widest. Feature ids of different part
/// pairs differ.
///
/// Parry could start from its last result for the pair. It does not, so that the result depends only on the
/// shapes and the pose, like all results of a step.
pub(crate) fn parry_manifolds(
    shape1: &SharedShape,
    shape2: &SharedShape,
    pose: &Pose,
    prediction: f32,
    out: &mut Vec<LocalManifold>,
) {
    if !(pose.position.is_finite() && pose.rotation.is_finite() && prediction.is_finite()) {
        return;
    }
    let pose = dim::pose_from_kernel(pose);
    let (mut manifolds, mut points) = (Vec::<ContactManifold<(), ()>>::new(), Vec::new());
    // Composite shapes store the parts of each manifold here. It is dropped with the manifolds.
    let mut parts: Option<ContactManifoldsWorkspace> = None;
    let found = DefaultQueryDispatcher.contact_manifolds(
        &pose,
        &**shape1,
        &**shape2,
        Scalar::from(prediction),
        &mut manifolds,
        &mut parts,
    );
    if found.is_err() {
        return;
    }
    // Sorted by part, independent of the order in which parry walks its tree.
    manifolds.sort_by_key(|m| (m.subshape1, m.subshape2));
    for manifold in &manifolds {
        let Some(normal) = normal_in_frame_1(manifold) else {
            continue;
        };
        points.clear();
        points.extend(manifold.points.iter().filter_map(|p| {
            let point = local_point(manifold, &pose, p);
            (point.separation <= prediction && point.separation.is_finite() && point.point.is_finite())
                .then_some(point)
        }));
        reduce(&mut points);
        let mut local = LocalManifold { normal, ..Default::default() };
        for p in &points {
            local.push(p.point, p.separation, p.feature);
        }
        if local.count > 0 {
            out.push(local);
        }
    }
}

/// The unit normal in the frame of shape 1; `None` if the manifold has none.
fn normal_in_frame_1(manifold: &ContactManifold<(), ()>) -> Option<kernel::math::Vector> {
    let normal = match manifold.subshape_pos1() {
        Some(part) => part.rotation * manifold.local_n1,
        None => manifold.local_n1,
    };
    let normal = vector_to_kernel(normal);
    let length = normal.length();
    (length > 0.5 && length.is_finite()).then(|| normal * (1.0 / length))
}

/// Converts a contact of parry, whose points are on the surfaces in the frames of the parts.
fn local_point(
    manifold: &ContactManifold<(), ()>,
    pose: &crate::parry::math::Pose,
    contact: &TrackedContact<()>,
) -> LocalPoint {
    let in_shape = |part: Option<&crate::parry::math::Pose>, p: Vector| part.map_or(p, |part| *part * p);
    let p1 = in_shape(manifold.subshape_pos1(), contact.local_p1);
    let p2 = *pose * in_shape(manifold.subshape_pos2(), contact.local_p2);
    let features = [contact.fid1.0, contact.fid2.0, manifold.subshape1, manifold.subshape2];
    LocalPoint::new(vector_to_kernel(p1.midpoint(p2)), contact.dist as f32, features.into_iter().fold(0, mix))
}

/// One round of a hash of words. Features must only differ, and be the same in the next step.
fn mix(hash: u32, word: u32) -> u32 {
    (hash.rotate_left(5) ^ word).wrapping_mul(0x9e37_79b9)
}
