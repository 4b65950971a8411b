//! Box2D through its C interface. With `workerCount` above one and no task callbacks, Box2D runs
//! its own threads.

#![expect(unsafe_code, reason = "a C interface")]

use bench_core::{
    dim2::{Body2, D2, Joint2, Part2, Ray2, Shape2, State2, V2},
    engine::{DT, Engine, SUBSTEPS, Settings, Stage},
    world::{Group, Kind},
};
use boxdd_sys::ffi::*;

struct World {
    id: b2WorldId,
    bodies: Vec<b2BodyId>,
}

fn v(p: V2) -> b2Vec2 {
    b2Vec2 { x: p[0], y: p[1] }
}

fn rot(angle: f32) -> b2Rot {
    let (s, c) = angle.sin_cos();
    b2Rot { c, s }
}

/// Makes a world.
pub fn make(gravity: V2, settings: &Settings) -> Box<dyn Engine<D2>> {
    // SAFETY: the definition is Box2D's default one, with plain numbers changed.
    let id = unsafe {
        let mut def = b2DefaultWorldDef();
        def.gravity = v(gravity);
        def.enableSleep = settings.sleeping;
        def.workerCount = settings.threads as _;
        b2CreateWorld(&def)
    };
    Box::new(World { id, bodies: Vec::new() })
}

fn add_shape(body: b2BodyId, def: &b2ShapeDef, part: &Part2) {
    // SAFETY: the body is alive, and Box2D copies definition and geometry.
    unsafe {
        match &part.shape {
            Shape2::Circle(r) => {
                let circle = b2Circle { center: v(part.pos), radius: *r };
                b2CreateCircleShape(body, def, &circle);
            }
            Shape2::Box(x, y) if part.is_centred() => {
                b2CreatePolygonShape(body, def, &b2MakeBox(*x, *y));
            }
            Shape2::Box(x, y) => {
                let polygon = b2MakeOffsetBox(*x, *y, v(part.pos), rot(part.turn));
                b2CreatePolygonShape(body, def, &polygon);
            }
            Shape2::Capsule(h, r) => {
                let (s, c) = part.turn.sin_cos();
                let [x, y] = part.pos;
                let capsule = b2Capsule {
                    center1: v([x - h * c, y - h * s]),
                    center2: v([x + h * c, y + h * s]),
                    radius: *r,
                };
                b2CreateCapsuleShape(body, def, &capsule);
            }
            Shape2::Poly(points) => {
                let points: Vec<b2Vec2> = points.iter().map(|p| v(*p)).collect();
                let hull = b2ComputeHull(points.as_ptr(), points.len() as _);
                let polygon = b2MakeOffsetPolygon(&hull, v(part.pos), rot(part.turn));
                b2CreatePolygonShape(body, def, &polygon);
            }
        }
    }
}

impl Engine<D2> for World {
    fn add_body(&mut self, b: &Body2) {
        // SAFETY: the definitions are Box2D's default ones, with plain values changed; the world is alive.
        unsafe {
            let mut def = b2DefaultBodyDef();
            def.type_ = match b.kind {
                Kind::Static => b2BodyType_b2_staticBody,
                Kind::Kinematic => b2BodyType_b2_kinematicBody,
                Kind::Dynamic => b2BodyType_b2_dynamicBody,
            };
            def.position = v(b.pos);
            def.rotation = rot(b.turn);
            def.linearVelocity = v(b.vel);
            def.angularVelocity = b.spin;
            let id = b2CreateBody(self.id, &def);
            let mut shape = b2DefaultShapeDef();
            shape.density = b.density;
            shape.material.friction = b.friction;
            shape.material.restitution = b.restitution;
            if b.group == Group::NotEachOther {
                shape.filter.categoryBits = 2;
                shape.filter.maskBits = !2;
            }
            b.parts.iter().for_each(|part| add_shape(id, &shape, part));
            self.bodies.push(id);
        }
    }

    fn add_joint(&mut self, j: &Joint2) {
        // SAFETY: both bodies are alive, and Box2D copies the definition.
        unsafe {
            let mut def = b2DefaultRevoluteJointDef();
            def.base.bodyIdA = self.bodies[j.a];
            def.base.bodyIdB = self.bodies[j.b];
            def.base.localFrameA.p = v(j.anchor_a);
            def.base.localFrameB.p = v(j.anchor_b);
            if let Some([lower, upper]) = j.limits {
                def.enableLimit = true;
                (def.lowerAngle, def.upperAngle) = (lower, upper);
            }
            b2CreateRevoluteJoint(self.id, &def);
        }
    }

    fn push(&mut self, body: usize, vel: V2) {
        // SAFETY: the body is alive.
        unsafe { b2Body_SetLinearVelocity(self.bodies[body], v(vel)) }
    }

    fn clear(&mut self) {
        for id in self.bodies.drain(..) {
            // SAFETY: the body is alive, and forgotten hereafter.
            unsafe { b2DestroyBody(id) }
        }
    }

    fn step(&mut self) {
        // SAFETY: the world is alive.
        unsafe { b2World_Step(self.id, DT, SUBSTEPS as _) }
    }

    fn states(&mut self, out: &mut Vec<State2>) {
        // SAFETY: the bodies are alive.
        out.extend(self.bodies.iter().map(|id| unsafe {
            let (p, q) = (b2Body_GetPosition(*id), b2Body_GetRotation(*id));
            let u = b2Body_GetLinearVelocity(*id);
            State2 { pos: [p.x, p.y], turn: q.s.atan2(q.c), vel: [u.x, u.y] }
        }));
    }

    fn awake(&mut self) -> usize {
        // SAFETY: the world is alive.
        unsafe { b2World_GetAwakeBodyCount(self.id) as usize }
    }

    fn raycast(&mut self, rays: &[Ray2], out: &mut Vec<f32>) {
        out.clear();
        // SAFETY: the world is alive.
        out.extend(rays.iter().map(|r| unsafe {
            let along = v([r.dir[0] * r.length, r.dir[1] * r.length]);
            let hit = b2World_CastRayClosest(self.id, v(r.origin), along, b2DefaultQueryFilter());
            if hit.hit { hit.fraction * r.length } else { f32::INFINITY }
        }));
    }

    fn stages(&mut self) -> Vec<Stage> {
        // SAFETY: the world is alive.
        let p = unsafe { b2World_GetProfile(self.id) };
        vec![
            Stage::own("step", p.step as f64),
            Stage::own("pairs", p.pairs as f64),
            Stage::own("collide", p.collide as f64),
            Stage::own("solve", p.solve as f64),
            Stage::own("constraints", p.constraints as f64),
            Stage::own("transforms", p.transforms as f64),
            Stage::own("refit", p.refit as f64),
            Stage::own("sleep islands", p.sleepIslands as f64),
        ]
    }
}

impl Drop for World {
    fn drop(&mut self) {
        // SAFETY: the world is alive, and not used after this.
        unsafe { b2DestroyWorld(self.id) }
    }
}
