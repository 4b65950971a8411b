//! Contacts of round bodies that rock on each other, in the middle of the step.
//!
//! The solver keeps normals and arms for a step. The point where a round body rocks on another runs along both, and an arm
//! that lags behind it feeds the rocking like a negative damper: a light body between heavy ones never came to rest. So the
//! contact is computed where the bodies will be in the middle of the step, as for shapes that [meet](super::sweep) then.

use super::input::{NarrowPhaseInput, smaller};
use super::record::Contact;
use super::sweep::{Meeting, place_at};
use crate::manifold::{self, LocalManifold};
use crate::math::{max, min};
use crate::table::BodyPose;
use crate::tuning::contact::{MOST_WAY, SAME_FACE, STILL};
use crate::tuning::solver::SMALL_TURN;
use crate::tuning::sweeps::MOST_TURN;

/// Moves the only point of `local`, with a round surface that presses another body, to where it is in the middle of the step,
/// up to `prediction` apart. Leaves all other points as they are.
pub(super) fn lead<S>(
    input: &NarrowPhaseInput<S>,
    contact: &mut Contact,
    poses: [&BodyPose; 2],
    prediction: f32,
    local: &mut LocalManifold,
) -> Option<Meeting> {
    let is_round = |local: &LocalManifold| local.count == 1 && max(local.radii[0], local.radii[1]) > 0.0;
    let presses = is_round(local) && local.points[0].separation <= input.margin(contact);
    if !presses || contact.is_inert() {
        return None;
    }
    let [va, vb] = [input.velocity(contact, 0), input.velocity(contact, 1)];
    let turn = (vb.angular - va.angular).length() * input.dt;
    let fastest = max(va.angular.length(), vb.angular.length()) * input.dt;
    let way = (vb.linear - va.linear).length() * input.dt;
    let size = min(smaller(input.reaches(contact).map(|reach| reach.extent)), smaller(local.radii));
    let rocks = turn > STILL && turn < SMALL_TURN && fastest < MOST_TURN && way < MOST_WAY * size;
    if !(rocks && contact.bodies.iter().all(|body| input.is_dynamic(*body))) {
        return None;
    }
    let placed = place_at(input, contact, poses, 0.5 * input.dt);
    let relative = placed[0].shape.relative(&placed[1].shape);
    let [a, b] = input.shapes(contact);
    let mut then = LocalManifold::default();
    manifold::collide(a, b, &relative, prediction, &mut contact.cache, &mut then);
    let normal = input.shape_poses(contact)[0].rotation.rotate(local.normal);
    let continues = placed[0].shape.rotation.rotate(then.normal).dot(normal) > SAME_FACE;
    if !(is_round(&then) && continues) {
        return None;
    }
    *local = then;
    Some(Meeting::new(placed, poses))
}
