//! Rapier 3D. `num_solver_iterations` are its substeps (TGS-soft with one biased and one relaxing
//! sweep each), so four of them match the other engines' four substeps.

use bench_core::{
    dim3::{Body3, D3, Joint3, Ray3, Shape3, State3, V3},
    engine::{DT, Engine, SUBSTEPS, Settings, Stage},
    world::{Group as Set, Kind},
};
use rapier3d::{
    parry::{query::ShapeCastOptions, shape::Ball},
    prelude::*,
};

struct World {
    w: PhysicsWorld,
    bodies: Vec<RigidBodyHandle>,
    sleeping: bool,
}

fn v(p: V3) -> Vector {
    Vector::new(p[0], p[1], p[2])
}

/// Makes a world.
pub fn make(gravity: V3, settings: &Settings) -> Box<dyn Engine<D3>> {
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

fn shape(shape: &Shape3) -> ColliderBuilder {
    match shape {
        Shape3::Sphere(r) => ColliderBuilder::ball(*r),
        Shape3::Box(x, y, z) => ColliderBuilder::cuboid(*x, *y, *z),
        Shape3::Capsule(h, r) => ColliderBuilder::capsule_y(*h, *r),
        Shape3::Cylinder(h, r) => ColliderBuilder::cylinder(*h, *r),
        Shape3::Hull(points) => {
            let points: Vec<Vector> = points.iter().map(|p| v(*p)).collect();
            ColliderBuilder::convex_hull(&points).expect("a convex hull")
        }
        Shape3::Mesh(m) => {
            let points = m.points.iter().map(|p| v(*p)).collect();
            ColliderBuilder::trimesh(points, m.triangles.clone()).expect("a triangle mesh")
        }
    }
}

fn quat(q: [f32; 4]) -> Rotation {
    Rotation::from_xyzw(q[0], q[1], q[2], q[3])
}

impl Engine<D3> for World {
    fn add_body(&mut self, b: &Body3) {
        let builder = match b.kind {
            Kind::Static => RigidBodyBuilder::fixed(),
            Kind::Kinematic => RigidBodyBuilder::kinematic_velocity_based(),
            Kind::Dynamic => RigidBodyBuilder::dynamic(),
        };
        let body = builder
            .pose(Pose::from_parts(v(b.pos), quat(b.turn)))
            .linvel(v(b.vel))
            .angvel(v(b.spin))
            .ccd_enabled(b.bullet)
            .can_sleep(self.sleeping);
        let id = self.w.insert_body(body);
        for part in &b.parts {
            let mut shape = shape(&part.shape)
                .position(Pose::from_parts(v(part.pos), quat(part.turn)))
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

    fn add_joint(&mut self, j: &Joint3) {
        let mut joint = SphericalJointBuilder::new()
            .local_anchor1(v(j.anchor_a))
            .local_anchor2(v(j.anchor_b))
            .contacts_enabled(false);
        if let Some([cone, twist]) = j.limits {
            // A pyramid, there.
            for (axis, limit) in [(JointAxis::AngX, cone), (JointAxis::AngY, twist), (JointAxis::AngZ, cone)]
            {
                joint = joint.limits(axis, [-limit, limit]);
            }
        }
        self.w.insert_impulse_joint(self.bodies[j.a], self.bodies[j.b], joint);
    }

    fn push(&mut self, body: usize, vel: V3) {
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

    fn states(&mut self, out: &mut Vec<State3>) {
        out.extend(self.bodies.iter().map(|h| {
            let b = &self.w.bodies[*h];
            let (p, q, u) = (b.translation(), b.rotation(), b.linvel());
            State3 { pos: [p.x, p.y, p.z], turn: [q.x, q.y, q.z, q.w], vel: [u.x, u.y, u.z] }
        }));
    }

    fn awake(&mut self) -> usize {
        let live =
            |h: &&RigidBodyHandle| self.w.bodies[**h].is_dynamic() && !self.w.bodies[**h].is_sleeping();
        self.bodies.iter().filter(live).count()
    }

    fn raycast(&mut self, rays: &[Ray3], out: &mut Vec<f32>) {
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

    fn ballcast(&mut self, radius: f32, rays: &[Ray3], out: &mut Vec<f32>) {
        out.clear();
        let w = &self.w;
        let q = w.broad_phase.as_query_pipeline(
            w.narrow_phase.query_dispatcher(),
            &w.bodies,
            &w.colliders,
            QueryFilter::default(),
        );
        let ball = Ball::new(radius);
        out.extend(rays.iter().map(|r| {
            let options = ShapeCastOptions::with_max_time_of_impact(r.length);
            let at = Pose::from_parts(v(r.origin), Rotation::IDENTITY);
            q.cast_shape(&at, v(r.dir), &ball, options).map_or(f32::INFINITY, |h| h.1.time_of_impact)
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
