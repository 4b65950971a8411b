//! A scene in an `App` of its own. Compiled once per dimension, with the engine that the parent module names.

use std::collections::HashMap;
use std::sync::Arc;

use bevy_app::{App, PostUpdate};
use bevy_ecs::prelude::*;
use bevy_transform::components::GlobalTransform;

use super::avian::collision::CollisionDiagnostics;
use super::avian::parry::shape::SharedShape;
use super::avian::prelude::*;
use super::overlap::{Body, deepest_overlap};
use super::scenes::{self, Glass, Scene, Watch, Watched};
use super::space;
use crate::draw::{Drawable, Form, Role};
use crate::sim::{Counts, Entry, Measures, Simulation, view};

/// The scenes of this dimension.
pub fn entries() -> Vec<Entry> {
    let entry = |scene: &Scene| Entry {
        dimension: space::DIMENSION,
        name: scene.name,
        about: scene.about,
        steps: scene.steps,
        view: view(scene.bounds.min, scene.bounds.max, scene.eye),
        drift: match scene.watch {
            Watch::Rest => "moved",
            Watch::Inside => "outside",
        },
        start: |name| Some(Box::new(Running::new(scenes::find(name)?))),
    };
    scenes::all().iter().map(entry).collect()
}

struct Running {
    app: App,
    scene: &'static Scene,
    /// Forms by their bits, so that equal shapes share one.
    forms: HashMap<Vec<u32>, Arc<Form>>,
    /// Each collider's shape, as it was last seen, with its form.
    known: HashMap<Entity, (SharedShape, Arc<Form>)>,
    /// Bodies in the order they were first seen in.
    numbers: HashMap<Entity, u32>,
}

impl Running {
    fn new(scene: &'static Scene) -> Self {
        let mut app = scenes::headless_app(scenes::DT, scenes::SUBSTEPS);
        (scene.build)(app.world_mut());
        // Transforms are propagated for a picture before the first step. This schedule has no physics.
        app.world_mut().run_schedule(PostUpdate);
        Self { app, scene, forms: HashMap::new(), known: HashMap::new(), numbers: HashMap::new() }
    }

    fn form(&mut self, entity: Entity, collider: &Collider) -> Arc<Form> {
        let shape = collider.shape_scaled();
        if let Some((seen, form)) = self.known.get(&entity)
            && Arc::ptr_eq(&seen.0, &shape.0)
        {
            return form.clone();
        }
        let form = space::form(&**shape);
        let form = self.forms.entry(form.key()).or_insert_with(|| Arc::new(form)).clone();
        self.known.insert(entity, (shape.clone(), form.clone()));
        form
    }

    fn drift(&mut self) -> f32 {
        let world = self.app.world_mut();
        match self.scene.watch {
            Watch::Rest => {
                let mut watched = world.query::<(&Position, &Watched)>();
                let moved = |(position, start): (&Position, &Watched)| {
                    (space::lifted(position.0) - start.0 * space::PLANE).length()
                };
                watched.iter(world).map(moved).fold(0.0, f32::max)
            }
            Watch::Inside => {
                let mut bodies = world.query::<(&Position, &RigidBody)>();
                let outside = |position: &Position| {
                    self.scene.bounds.distance_outside(space::lifted(position.0), space::DIMENSION == 2)
                };
                let moving = bodies.iter(world).filter(|(_, kind)| kind.is_dynamic());
                moving.map(|(position, _)| outside(position)).fold(0.0, f32::max)
            }
        }
    }

    fn energy(&mut self) -> f64 {
        let world = self.app.world_mut();
        let gravity = world.resource::<Gravity>().0;
        let mut bodies = world.query::<(
            &RigidBody,
            &Position,
            &Rotation,
            &LinearVelocity,
            &AngularVelocity,
            &ComputedMass,
            &ComputedAngularInertia,
            &ComputedCenterOfMass,
        )>();
        let mut sum = 0.0;
        for (kind, position, rotation, velocity, spin, mass, inertia, center) in bodies.iter(world) {
            if kind.is_dynamic() && mass.is_finite() {
                let middle = position.0 + *rotation * center.0;
                let by_mass = 0.5 * velocity.0.length_squared() - gravity.dot(middle);
                sum += f64::from(mass.value() * by_mass)
                    + f64::from(space::spin_energy(*inertia, *spin, *rotation));
            }
        }
        sum
    }
}

impl Simulation for Running {
    fn step(&mut self) {
        scenes::step(&mut self.app);
    }

    fn drawables(&mut self) -> Vec<Drawable> {
        let world = self.app.world_mut();
        let mut query =
            world.query::<(Entity, &Collider, &GlobalTransform, Option<&ColliderOf>, Has<Glass>)>();
        let mut found: Vec<(Entity, Collider, GlobalTransform, Entity, bool)> = query
            .iter(world)
            .map(|(entity, collider, pose, of, glass)| {
                (entity, collider.clone(), *pose, of.map_or(entity, |of| of.body), glass)
            })
            .collect();
        let mut bodies = world.query::<(&RigidBody, Has<Sleeping>)>();
        // Tables have no special order, and it changes when bodies fall asleep.
        found.sort_by_key(|(entity, ..)| *entity);
        let states: Vec<(Role, bool)> = found
            .iter()
            .map(|(.., body, _)| match bodies.get(world, *body) {
                Ok((RigidBody::Dynamic, asleep)) => (Role::Dynamic, asleep),
                Ok((RigidBody::Kinematic, asleep)) => (Role::Kinematic, asleep),
                _ => (Role::Static, false),
            })
            .collect();
        let mut drawables = Vec::with_capacity(found.len());
        for ((entity, collider, pose, body, glass), (role, asleep)) in found.into_iter().zip(states) {
            let form = self.form(entity, &collider);
            let next = self.numbers.len() as u32;
            let number = *self.numbers.entry(body).or_insert(next);
            let (_, rotation, translation) = pose.to_scale_rotation_translation();
            drawables.push(Drawable { form, translation, rotation, body: number, role, asleep, glass });
        }
        drawables
    }

    fn counts(&mut self) -> Counts {
        let world = self.app.world_mut();
        let mut bodies = world.query::<(&RigidBody, Has<Sleeping>)>();
        let mut counts = Counts::default();
        for (kind, asleep) in bodies.iter(world) {
            counts.bodies += usize::from(!kind.is_static());
            counts.asleep += usize::from(asleep);
        }
        counts.contacts = world.get_resource::<CollisionDiagnostics>().map(|d| d.contact_count);
        counts
    }

    fn measures(&mut self) -> Measures {
        let world = self.app.world_mut();
        let mut positions = world.query_filtered::<&Position, With<RigidBody>>();
        let broken = positions.iter(world).filter(|position| !position.is_finite()).count();
        let kinds = world.query::<&RigidBody>();
        // Sensors may overlap.
        let mut colliders = world
            .query_filtered::<(Entity, &Collider, &GlobalTransform, Option<&ColliderOf>), Without<Sensor>>();
        let parts: Vec<Body> = colliders
            .iter(world)
            .map(|(entity, collider, pose, of)| {
                let body = of.map_or(entity, |of| of.body);
                let dynamic = kinds.get_manual(world, body).is_ok_and(RigidBody::is_dynamic);
                Body::new(body, dynamic, collider.shape_scaled().clone(), space::pose(pose))
            })
            .collect();
        Measures { energy: self.energy(), drift: self.drift(), overlap: deepest_overlap(parts), broken }
    }
}
