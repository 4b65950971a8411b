//! Rapier 2D. `num_solver_iterations` are its substeps (TGS-soft with one biased and one relaxing
//! sweep each), so four of them match the other engines' four substeps.

use bench_core::{
    dim2::{Body2, D2, Joint2, Ray2, Shape2, State2, V2},
    engine::{DT, Engine, SUBSTEPS, Settings, Stage},
    world::{Group as Set, Kind},
};
use rapier2d::prelude::*;

struct World {
    w: PhysicsWorld,
    bodies: Vec<RigidBodyHandle>,
    sleeping: bool,
}

fn v(p: V2) -> Vector {
    Vector::new(p[0], p[1])
}

/// Makes a world.
pub fn make(gravity: V2, settings: &Settings) -> Box<dyn Engine<D2>> {
    let mut w = PhysicsWorld::new();
    w.gravity = v(gravity);
    w.integration_parameters.dt = DT;
    w.integration_parameters.num_solver_iterations = SUBSTEPS as usize;
    w.configure_thread_pool(settings.threads).expect("a thread pool");
    if cfg!(feature = "rapier-profiler") {
        w.physics_pipeline.counters.enable();
    }
    Box::new(World { w, bodies: Vec::new(), sleeping: settings.sleeping })
}

fn shape(shape: &Shape2) -> ColliderBuilder {
    match shape {
        Shape2::Circle(r) => ColliderBuilder::ball(*r),
        Shape2::Box(x, y) => ColliderBuilder::cuboid(*x, *y),
        Shape2::Capsule(h, r) => ColliderBuilder::capsule_x(*h, *r),
        Shape2::Poly(points) => {
            let points: Vec<Vector> = points.iter().map(|p| v(*p)).collect();
            ColliderBuilder::convex_hull(&points).expect("a convex polygon")
        }
    }
}

impl Engine<D2> for World {
    fn add_body(&mut self, b: &Body2) {
        let builder = match b.kind {
            Kind::Static => RigidBodyBuilder::fixed(),
            Kind::Kinematic => RigidBodyBuilder::kinematic_velocity_based(),
            Kind::Dynamic => RigidBodyBuilder::dynamic(),
        };
        let body = builder
            .pose(Pose::new(v(b.pos), b.turn))
            .linvel(v(b.vel))
            .angvel(b.spin)
            .ccd_enabled(b.bullet)
            .can_sleep(self.sleeping);
        let id = self.w.insert_body(body);
        for part in &b.parts {
            let mut shape = shape(&part.shape)
                .position(Pose::new(v(part.pos), part.turn))
                .density(b.density)
                .friction(b.friction)
                .restitution(b.restitution);
            if b.group == Set::NotEachOther {
                let (own, others) = (Group::GROUP_2, !Group::GROUP_2);
                shape = shape.collision_groups(InteractionGroups::new(own, others, InteractionTestMode::And));
            }
            self.w.insert_collider(shape, Some(id));
        }
        self.bodies.push(id);
    }

    fn add_joint(&mut self, j: &Joint2) {
        let mut joint = RevoluteJointBuilder::new()
            .local_anchor1(v(j.anchor_a))
            .local_anchor2(v(j.anchor_b))
            .contacts_enabled(false);
        if let Some(limits) = j.limits {
            joint = joint.limits(limits);
        }
        self.w.insert_impulse_joint(self.bodies[j.a], self.bodies[j.b], joint);
    }

    fn push(&mut self, body: usize, vel: V2) {
        self.w.bodies[self.bodies[body]].set_linvel(v(vel), true);
    }

    fn clear(&mut self) {
        for id in self.bodies.drain(..) {
            self.w.remove_body(id);
        }
    }

    fn step(&mut self) {
        self.w.step();
    }

    fn states(&mut self, out: &mut Vec<State2>) {
        out.extend(self.bodies.iter().map(|h| {
            let b = &self.w.bodies[*h];
            let (p, u) = (b.translation(), b.linvel());
            State2 { pos: [p.x, p.y], turn: b.rotation().angle(), vel: [u.x, u.y] }
        }));
    }

    fn awake(&mut self) -> usize {
        let live =
            |h: &&RigidBodyHandle| self.w.bodies[**h].is_dynamic() && !self.w.bodies[**h].is_sleeping();
        self.bodies.iter().filter(live).count()
    }

    fn raycast(&mut self, rays: &[Ray2], out: &mut Vec<f32>) {
        out.clear();
        let w = &self.w;
        let q = w.broad_phase.as_query_pipeline(
            w.narrow_phase.query_dispatcher(),
            &w.bodies,
            &w.colliders,
            QueryFilter::default(),
        );
        out.extend(rays.iter().map(|r| {
            let ray = Ray::new(v(r.origin), v(r.dir));
            q.cast_ray(&ray, r.length, true).map_or(f32::INFINITY, |h| h.1)
        }));
    }

    fn stages(&mut self) -> Vec<Stage> {
        if !cfg!(feature = "rapier-profiler") {
            return Vec::new();
        }
        let c = &self.w.physics_pipeline.counters;
        vec![
            Stage::own("step", c.step_time_ms()),
            Stage::own("broad phase", c.broad_phase_time_ms()),
            Stage::own("narrow phase", c.narrow_phase_time_ms()),
            Stage::own("islands", c.island_construction_time_ms()),
            Stage::own("solver", c.solver_time_ms()),
            Stage::own("ccd", c.ccd_time_ms()),
        ]
    }
}
