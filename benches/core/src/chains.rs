//! Chains with a weight at their end, and how well an engine holds them.

use serde::{Deserialize, Serialize};

use crate::{
    scene::{Plan, Scene},
    world::{Body, Dimension, Group, Joint, Kind, State, distance},
};

/// Number of links, of a metre and a kilogram each.
const LINKS: usize = 30;

/// The masses of a chain's bodies, in kg; 0 for what it hangs from.
#[derive(Clone, Debug)]
pub struct Chain {
    masses: Vec<f32>,
}

/// What a chain did in all its steps.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub struct Strain {
    /// The widest distance of a joint's two anchors in any step, in metres.
    pub widest: f32,
    /// By what share of its length the chain is longer at the end than it was.
    pub stretch: f32,
    /// The most that the energy of the centres of mass was above that of the start, in J per kg of the
    /// weight. Rotation is left out.
    pub gained: f32,
}

/// A chain that hangs along an axis from a fixed body, let go from rest. `link` and `weight` are shapes with
/// their densities; a link is a metre long, and so is the weight, of a mass in kg.
pub(crate) fn chain<D: Dimension>(
    axis: usize,
    link: (D::Shape, f32),
    weight: (D::Shape, f32),
    mass: f32,
) -> Scene<D> {
    let how = if axis == 0 { "let go level" } else { "hanging" };
    let about = format!("30 links of 1 kg and 1 m, {how}, with {mass} kg at the end");
    let mut scene = Scene::new(about, Plan::settled(0, 600));
    let along = |distance: f32| {
        let mut at = D::ZERO;
        at.as_mut()[axis] = if axis == 0 { distance } else { -distance };
        at
    };
    scene.bodies.push(Body { group: Group::NotEachOther, ..Body::fixed(along(-0.5), link.0.clone()) });
    let mut masses = vec![0.0];
    for i in 0..=LINKS {
        let ((shape, density), mass) = if i < LINKS { (link.clone(), 1.0) } else { (weight.clone(), mass) };
        let body = Body::new(Kind::Dynamic, along(i as f32 + 0.5), shape);
        scene.bodies.push(Body { density, group: Group::NotEachOther, ..body });
        masses.push(mass);
        scene.joints.push(Joint::free([i, i + 1], [along(0.5), along(-0.5)]));
    }
    scene.chain = Some(Chain { masses });
    scene
}

/// Follows a chain from step to step.
pub(crate) struct Watch<'a, D: Dimension> {
    scene: &'a Scene<D>,
    masses: &'a [f32],
    start: f64,
    strain: Strain,
}

impl<'a, D: Dimension> Watch<'a, D> {
    /// Of a scene with a chain.
    pub(crate) fn new(scene: &'a Scene<D>) -> Option<Self> {
        let masses = &scene.chain.as_ref()?.masses[..];
        let states: Vec<State<D>> =
            scene.bodies.iter().map(|body| State { pos: body.pos, turn: body.turn, vel: body.vel }).collect();
        let mut watch = Self { scene, masses, start: 0.0, strain: Strain::default() };
        watch.start = watch.energy(&states);
        Some(watch)
    }

    /// Takes the state after a step.
    pub(crate) fn look(&mut self, states: &[State<D>]) {
        let weight = f64::from(self.masses.last().copied().unwrap_or(1.0));
        let gained = (self.energy(states) - self.start) / weight;
        self.strain.gained = self.strain.gained.max(gained as f32);
        let at = |body: usize, local| D::point(&D::pose(states[body].pos, states[body].turn), local);
        for joint in &self.scene.joints {
            let gap = distance::<D>(at(joint.a, joint.anchor_a), at(joint.b, joint.anchor_b));
            self.strain.widest = self.strain.widest.max(gap);
        }
        let joints = &self.scene.joints;
        if let [first, .., last] = &joints[..] {
            let length = distance::<D>(at(first.a, first.anchor_a), at(last.b, last.anchor_b));
            self.strain.stretch = length / (joints.len() - 1) as f32 - 1.0;
        }
    }

    /// What it did.
    pub(crate) fn strain(self) -> Strain {
        self.strain
    }

    fn energy(&self, states: &[State<D>]) -> f64 {
        let gravity = f64::from(-self.scene.gravity.as_ref()[1]);
        let of = |(state, mass): (&State<D>, &f32)| {
            let speed = f64::from(distance::<D>(state.vel, D::ZERO));
            f64::from(*mass) * (0.5 * speed * speed + gravity * f64::from(state.pos.as_ref()[1]))
        };
        states.iter().zip(self.masses).map(of).sum()
    }
}
