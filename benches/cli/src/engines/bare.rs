//! The App without physics: the same entities with only a `Transform`. The difference of an engine's time to
//! this is its cost.

use bench_core::{
    dim2::D2,
    dim3::D3,
    engine::{Engine, Settings},
    scene::Need,
    world::{Body, Dimension, State},
};
use bevy::prelude::*;

use super::app;

struct Bare {
    app: App,
    bodies: Vec<Entity>,
    settings: Settings,
}

fn bare(settings: &Settings) -> Box<Bare> {
    Box::new(Bare { app: app::app(settings), bodies: Vec::new(), settings: *settings })
}

/// In 2D.
pub fn make2(_gravity: [f32; 2], settings: &Settings) -> Box<dyn Engine<D2>> {
    bare(settings)
}

/// In 3D.
pub fn make3(_gravity: [f32; 3], settings: &Settings) -> Box<dyn Engine<D3>> {
    bare(settings)
}

/// The position of an entity. Orientations do not matter for the cost.
fn transform<D: Dimension>(at: D::Vec) -> Transform {
    let at = at.as_ref();
    Transform::from_xyz(at[0], at[1], at.get(2).copied().unwrap_or(0.0))
}

impl<D: Dimension> Engine<D> for Bare {
    fn lacks(&self) -> &'static [Need] {
        &[Need::Physics]
    }

    fn add_body(&mut self, body: &Body<D>) {
        let world = self.app.world_mut();
        let id = world.spawn(transform::<D>(body.pos)).id();
        if body.only_shape().is_none() {
            for part in &body.parts {
                world.spawn((transform::<D>(part.pos), ChildOf(id)));
            }
        }
        self.bodies.push(id);
    }

    fn ready(&mut self) {
        app::finish(&mut self.app, &self.settings);
    }

    fn push(&mut self, _body: usize, _vel: D::Vec) {}

    fn clear(&mut self) {
        let world = self.app.world_mut();
        for id in self.bodies.drain(..) {
            world.despawn(id);
        }
    }

    fn step(&mut self) {
        app::update(&mut self.app);
    }

    fn states(&mut self, _out: &mut Vec<State<D>>) {}

    fn awake(&mut self) -> usize {
        0
    }
}
