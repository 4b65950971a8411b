//! Orientation motors of a tree, each solved by the responses of the whole tree to impulses along its axes.
#![expect(unsafe_code, reason = "rows of bodies are shared by threads")]

use super::super::batch::{Pass, Sweep};
use super::dim::{motion, screw};
use super::elimination::{self, Screw};
use super::forest::GROUND;
use super::place::{Gradient, Response};
use super::tree_pass::Tree;
use crate::math::{Angular, Vector};

impl Tree<'_> {
    /// Solves the orientation motor of a joint.
    ///
    /// # Safety
    /// As [`solve`](Self::solve).
    pub(super) unsafe fn solve_orientation(&mut self, k: usize, sweep: &Sweep) {
        let joint = &mut self.joints[k];
        joint.row.turning = Angular::ZERO;
        let Some(mut motor) = joint.orientation else { return };
        // SAFETY: by the contract.
        let place = unsafe { joint.row.start.now(&sweep.bodies, &joint.row.ids) };
        let turning = motor.look(&place);
        if sweep.pass == Pass::Solve {
            let alone = turning.gradients.map(|gradient| joint.row.masses.response(&gradient));
            let responses = turning.gradients.map(|gradient| self.unit_response(k, &gradient));
            let changes = motor.act(&turning, (&responses, &alone), &self.pair(k), sweep.params.h);
            self.joints[k].orientation = Some(motor);
            let mut sum = Angular::ZERO;
            for (gradient, change) in turning.gradients.iter().zip(changes) {
                sum += gradient.moments[1] * change;
            }
            self.unit_response(k, &place.gradient(Vector::ZERO, sum));
            self.apply(sweep);
        }
        for (gradient, impulse) in turning.gradients.iter().zip(motor.impulses) {
            self.joints[k].row.turning += gradient.moments[1] * impulse;
        }
    }

    /// Solves the tree for a unit impulse along a coordinate of a joint, and adds the impulse to those on its bodies. The
    /// response of the joint's bodies.
    pub(super) fn unit_response(&mut self, k: usize, gradient: &Gradient<f32>) -> Response<f32> {
        let Self { joints, links, nodes, width, .. } = self;
        let ends: [(u32, Screw); 2] = core::array::from_fn(|end| {
            let sign = if joints[k].side(end) == 0 { -1.0 } else { 1.0 };
            let moment = gradient.moments[joints[k].side(end)];
            (links[k].places[end], screw(gradient.normal * sign, moment * sign))
        });
        for link in links.iter_mut() {
            link.rows.iter_mut().for_each(|row| row.wanted = 0.0);
            for (place, push) in ends.iter().filter(|(place, _)| *place != GROUND) {
                if let Some(end) = link.places.iter().position(|other| other == place) {
                    link.want_against(end, &nodes[*place as usize].moved(push));
                }
            }
        }
        elimination::solve(links, nodes, *width);
        let mut response = Response { v: [Vector::ZERO; 2], w: [Angular::ZERO; 2] };
        for (end, (place, push)) in ends.into_iter().enumerate().filter(|(_, (place, _))| *place != GROUND) {
            let node = &mut nodes[place as usize];
            elimination::add(&mut node.impulse, &push, 1.0);
            let (v, w) = motion(&node.change());
            let side = joints[k].side(end);
            let sign = if side == 0 { -1.0 } else { 1.0 };
            (response.v[side], response.w[side]) = (v * sign, w * sign);
        }
        response
    }
}
