//! Avian 3D, by its prelude and diagnostics only. The crate is chosen outside of this file, which compiles
//! with upstream and with ours.

#[cfg(feature = "joints")]
use bench_core::dim3::Joint3;
#[cfg(feature = "queries")]
use bench_core::dim3::Ray3;
use bench_core::{
    dim3::{Body3, D3, Q4, Shape3, State3, V3},
    engine::{Engine, SUBSTEPS, Settings, Stage},
    scene::Need,
    world::{Group, Kind},
};
use bevy::prelude::*;

use super::app;
use crate::backend::{SWEEPS_ALL, d3 as avian};
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
pub fn make(gravity: V3, settings: &Settings) -> Box<dyn Engine<D3>> {
    let mut app = app::app(settings);
    app.add_plugins(PhysicsPlugins::default());
    app.insert_resource(Gravity(Vec3::from(gravity)));
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

fn collider(shape: &Shape3) -> Collider {
    match shape {
        Shape3::Sphere(r) => Collider::sphere(*r),
        Shape3::Box(x, y, z) => Collider::cuboid(2.0 * x, 2.0 * y, 2.0 * z),
        Shape3::Capsule(h, r) => Collider::capsule(*r, 2.0 * h),
        Shape3::Cylinder(h, r) => Collider::cylinder(*r, 2.0 * h),
        Shape3::Hull(points) => {
            let points = points.iter().map(|p| Vec3::from(*p)).collect();
            Collider::convex_hull(points).expect("a convex hull")
        }
        #[cfg(feature = "meshes")]
        Shape3::Mesh(m) => {
            Collider::trimesh(m.points.iter().map(|p| Vec3::from(*p)).collect(), m.triangles.clone())
        }
        #[cfg(not(feature = "meshes"))]
        Shape3::Mesh(_) => unreachable!("a build without meshes is given none"),
    }
}

fn transform(p: V3, turn: Q4) -> Transform {
    Transform::from_translation(Vec3::from(p)).with_rotation(Quat::from_array(turn))
}

impl Engine<D3> for Sim {
    fn lacks(&self) -> &'static [Need] {
        app::LACKS
    }

    fn add_body(&mut self, b: &Body3) {
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
            entity.insert((LinearVelocity(Vec3::from(b.vel)), AngularVelocity(Vec3::from(b.spin))));
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
    fn add_joint(&mut self, j: &Joint3) {
        let mut joint = SphericalJoint::new(self.bodies[j.a], self.bodies[j.b])
            .with_local_anchor1(Vec3::from(j.anchor_a))
            .with_local_anchor2(Vec3::from(j.anchor_b));
        if let Some([cone, twist]) = j.limits {
            joint = joint.with_swing_limits(-cone, cone).with_twist_limits(-twist, twist);
        }
        self.app.world_mut().spawn((joint, JointCollisionDisabled));
    }

    fn ready(&mut self) {
        app::finish(&mut self.app, &self.settings);
    }

    fn push(&mut self, body: usize, vel: V3) {
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

    fn states(&mut self, out: &mut Vec<State3>) {
        let world = self.app.world();
        out.extend(self.bodies.iter().map(|id| {
            let entity = world.entity(*id);
            State3 {
                pos: entity.get::<Position>().map_or([f32::NAN; 3], |p| p.0.into()),
                turn: entity.get::<Rotation>().map_or([f32::NAN; 4], |r| r.0.to_array()),
                vel: entity.get::<LinearVelocity>().map_or([0.0; 3], |v| v.0.into()),
            }
        }));
    }

    fn awake(&mut self) -> usize {
        let world = self.app.world_mut();
        let mut bodies = world.query_filtered::<&RigidBody, Without<Sleeping>>();
        bodies.iter(world).filter(|body| body.is_dynamic()).count()
    }

    #[cfg(feature = "queries")]
    fn raycast(&mut self, rays: &[Ray3], out: &mut Vec<f32>) {
        out.clear();
        let world = self.app.world_mut();
        let state = self.spatial.get_or_insert_with(|| Spatial::new(world));
        let spatial = state.get(world).expect("the spatial query is there");
        let filter = SpatialQueryFilter::default();
        out.extend(rays.iter().map(|r| {
            let dir = Dir3::new_unchecked(Vec3::from(r.dir).normalize());
            spatial
                .cast_ray(Vec3::from(r.origin), dir, r.length, true, &filter)
                .map_or(f32::INFINITY, |h| h.distance)
        }));
    }

    #[cfg(feature = "queries")]
    fn ballcast(&mut self, radius: f32, rays: &[Ray3], out: &mut Vec<f32>) {
        out.clear();
        let world = self.app.world_mut();
        let state = self.spatial.get_or_insert_with(|| Spatial::new(world));
        let spatial = state.get(world).expect("the spatial query is there");
        let filter = SpatialQueryFilter::default();
        let ball = Collider::sphere(radius);
        out.extend(rays.iter().map(|r| {
            let dir = Dir3::new_unchecked(Vec3::from(r.dir).normalize());
            let config = ShapeCastConfig::from_max_distance(r.length);
            spatial
                .cast_shape(&ball, Vec3::from(r.origin), Quat::IDENTITY, dir, &config, &filter)
                .map_or(f32::INFINITY, |h| h.distance)
        }));
    }

    #[cfg(feature = "batches")]
    fn raycast_batch(&mut self, rays: &[Ray3], out: &mut Vec<f32>) {
        out.clear();
        let world = self.app.world_mut();
        let state = self.spatial.get_or_insert_with(|| Spatial::new(world));
        let spatial = state.get(world).expect("the spatial query is there");
        let length = rays.first().map_or(0.0, |r| r.length);
        let aimed = |r: &Ray3| (Vec3::from(r.origin), Dir3::new_unchecked(Vec3::from(r.dir).normalize()));
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
