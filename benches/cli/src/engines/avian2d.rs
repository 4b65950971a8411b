//! Avian 2D, by its prelude and diagnostics only. The crate is chosen outside of this file, which compiles
//! with upstream and with ours.

#[cfg(feature = "joints")]
use bench_core::dim2::Joint2;
#[cfg(feature = "queries")]
use bench_core::dim2::Ray2;
use bench_core::{
    dim2::{Body2, D2, Shape2, State2, V2},
    engine::{Engine, SUBSTEPS, Settings, Stage},
    scene::Need,
    world::{Group, Kind},
};
use bevy::prelude::*;

use super::app;
use crate::backend::{SWEEPS_ALL, d2 as avian};
use avian::prelude::*;

#[cfg(feature = "queries")]
type Spatial = bevy::ecs::system::SystemState<SpatialQuery<'static, 'static>>;

struct Sim {
    app: App,
    bodies: Vec<Entity>,
    settings: Settings,
    #[cfg(feature = "queries")]
    spatial: Option<Spatial>,
}

/// Makes a world.
pub fn make(gravity: V2, settings: &Settings) -> Box<dyn Engine<D2>> {
    let mut app = app::app(settings);
    app.add_plugins(PhysicsPlugins::default());
    app.insert_resource(Gravity(Vec2::from(gravity)));
    app.insert_resource(SubstepCount(SUBSTEPS));
    if settings.stages {
        app::put_clocks!(app);
        #[cfg(feature = "sharing")]
        app.world_mut().resource_mut::<avian::schedule::StepTimes>().count_shared();
    }
    Box::new(Sim {
        app,
        bodies: Vec::new(),
        settings: *settings,
        #[cfg(feature = "queries")]
        spatial: None,
    })
}

fn collider(shape: &Shape2) -> Collider {
    match shape {
        Shape2::Circle(r) => Collider::circle(*r),
        Shape2::Box(x, y) => Collider::rectangle(2.0 * x, 2.0 * y),
        Shape2::Capsule(h, r) => Collider::capsule_endpoints(*r, Vec2::new(-h, 0.0), Vec2::new(*h, 0.0)),
        Shape2::Poly(points) => {
            let points = points.iter().map(|p| Vec2::from(*p)).collect();
            Collider::convex_hull(points).expect("a convex polygon")
        }
    }
}

fn transform(p: V2, angle: f32) -> Transform {
    Transform::from_xyz(p[0], p[1], 0.0).with_rotation(Quat::from_rotation_z(angle))
}

impl Engine<D2> for Sim {
    fn lacks(&self) -> &'static [Need] {
        app::LACKS
    }

    fn add_body(&mut self, b: &Body2) {
        let kind = match b.kind {
            Kind::Static => RigidBody::Static,
            Kind::Kinematic => RigidBody::Kinematic,
            Kind::Dynamic => RigidBody::Dynamic,
        };
        let layers = match b.group {
            Group::All => CollisionLayers::default(),
            Group::NotEachOther => CollisionLayers::from_bits(2, !2),
        };
        let (friction, restitution) = (Friction::new(b.friction), Restitution::new(b.restitution));
        let surface = (friction, restitution, ColliderDensity(b.density), layers);
        let world = self.app.world_mut();
        let mut entity = world.spawn((kind, transform(b.pos, b.turn)));
        if b.kind != Kind::Static {
            entity.insert((LinearVelocity(Vec2::from(b.vel)), AngularVelocity(b.spin)));
            if !self.settings.sleeping {
                entity.insert(SleepingDisabled);
            }
            if b.bullet && !SWEEPS_ALL {
                entity.insert(SweptCcd::default());
            }
        }
        let id = entity.id();
        if let Some(shape) = b.only_shape() {
            entity.insert((collider(shape), surface));
        } else {
            for part in &b.parts {
                world.spawn((collider(&part.shape), transform(part.pos, part.turn), surface, ChildOf(id)));
            }
        }
        self.bodies.push(id);
    }

    #[cfg(feature = "joints")]
    fn add_joint(&mut self, j: &Joint2) {
        let mut joint = RevoluteJoint::new(self.bodies[j.a], self.bodies[j.b])
            .with_local_anchor1(Vec2::from(j.anchor_a))
            .with_local_anchor2(Vec2::from(j.anchor_b));
        if let Some([min, max]) = j.limits {
            joint = joint.with_angle_limits(min, max);
        }
        self.app.world_mut().spawn((joint, JointCollisionDisabled));
    }

    fn ready(&mut self) {
        app::finish(&mut self.app, &self.settings);
    }

    fn push(&mut self, body: usize, vel: V2) {
        let velocity = self.app.world_mut().get_mut::<LinearVelocity>(self.bodies[body]);
        velocity.expect("a body has a velocity").0 = vel.into();
    }

    fn clear(&mut self) {
        let world = self.app.world_mut();
        for id in self.bodies.drain(..) {
            world.despawn(id);
        }
    }

    fn step(&mut self) {
        app::update(&mut self.app);
    }

    fn states(&mut self, out: &mut Vec<State2>) {
        let world = self.app.world();
        out.extend(self.bodies.iter().map(|id| {
            let entity = world.entity(*id);
            State2 {
                pos: entity.get::<Position>().map_or([f32::NAN; 2], |p| p.0.into()),
                turn: entity.get::<Rotation>().map_or(f32::NAN, |r| r.as_radians()),
                vel: entity.get::<LinearVelocity>().map_or([0.0; 2], |v| v.0.into()),
            }
        }));
    }

    fn awake(&mut self) -> usize {
        let world = self.app.world_mut();
        let mut bodies = world.query_filtered::<&RigidBody, Without<Sleeping>>();
        bodies.iter(world).filter(|body| body.is_dynamic()).count()
    }

    #[cfg(feature = "queries")]
    fn raycast(&mut self, rays: &[Ray2], out: &mut Vec<f32>) {
        out.clear();
        let world = self.app.world_mut();
        let state = self.spatial.get_or_insert_with(|| Spatial::new(world));
        let spatial = state.get(world).expect("the spatial query is there");
        let filter = SpatialQueryFilter::default();
        out.extend(rays.iter().map(|r| {
            let dir = Dir2::new_unchecked(Vec2::from(r.dir).normalize());
            spatial
                .cast_ray(Vec2::from(r.origin), dir, r.length, true, &filter)
                .map_or(f32::INFINITY, |h| h.distance)
        }));
    }

    #[cfg(feature = "batches")]
    fn raycast_batch(&mut self, rays: &[Ray2], out: &mut Vec<f32>) {
        out.clear();
        let world = self.app.world_mut();
        let state = self.spatial.get_or_insert_with(|| Spatial::new(world));
        let spatial = state.get(world).expect("the spatial query is there");
        let length = rays.first().map_or(0.0, |r| r.length);
        let aimed = |r: &Ray2| (Vec2::from(r.origin), Dir2::new_unchecked(Vec2::from(r.dir).normalize()));
        let aimed: Vec<_> = rays.iter().map(aimed).collect();
        let mut hits = vec![None; rays.len()];
        spatial.cast_rays(&aimed, length, true, &SpatialQueryFilter::default(), &mut hits);
        out.extend(hits.iter().map(|hit| hit.as_ref().map_or(f32::INFINITY, |h| h.distance)));
    }

    fn stages(&mut self) -> Vec<Stage> {
        let world = self.app.world();
        #[cfg_attr(not(feature = "diagnostics"), expect(unused_mut))]
        let mut stages = app::stages(world);
        #[cfg(feature = "diagnostics")]
        stages.extend(app::own_timers!(avian, world));
        #[cfg(feature = "sharing")]
        stages.push(app::shared!(avian, world));
        stages
    }
}
