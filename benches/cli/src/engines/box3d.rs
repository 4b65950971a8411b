//! Box3D through its C interface. With `workerCount` above one and no task callbacks, Box3D runs
//! its own threads.

#![expect(unsafe_code, reason = "a C interface")]

use std::{f32::consts::FRAC_PI_2, ffi::c_void};

use bench_core::{
    dim3::{Body3, D3, Joint3, Mesh, Part3, Ray3, Shape3, State3, V3, turn_about},
    engine::{DT, Engine, SUBSTEPS, Settings, Stage},
    world::{Group, Kind},
};
use box3d_sys::*;

struct World {
    id: b3WorldId,
    bodies: Vec<b3BodyId>,
    /// Meshes are referenced by their shapes and live as long as the world.
    meshes: Vec<*mut b3MeshData>,
}

fn v(p: V3) -> b3Vec3 {
    b3Vec3 { x: p[0], y: p[1], z: p[2] }
}

fn q([x, y, z, w]: [f32; 4]) -> b3Quat {
    b3Quat { v: v([x, y, z]), s: w }
}

/// Makes a world.
pub fn make(gravity: V3, settings: &Settings) -> Box<dyn Engine<D3>> {
    // SAFETY: the definition is Box3D's default one, with plain numbers changed.
    let id = unsafe {
        let mut def = b3DefaultWorldDef();
        def.gravity = v(gravity);
        def.enableSleep = settings.sleeping;
        def.workerCount = settings.threads as _;
        b3CreateWorld(&def)
    };
    Box::new(World { id, bodies: Vec::new(), meshes: Vec::new() })
}

/// A mesh that the caller frees after its shapes.
fn make_mesh(mesh: &Mesh) -> *mut b3MeshData {
    let mut points: Vec<b3Vec3> = mesh.points.iter().map(|p| v(*p)).collect();
    let mut indices: Vec<i32> = mesh.triangles.iter().flatten().map(|i| *i as i32).collect();
    // SAFETY: a definition is plain numbers and pointers, of which the rest may be zero; Box3D copies what
    // they point to.
    let mesh = unsafe {
        let mut def: b3MeshDef = std::mem::zeroed();
        def.vertices = points.as_mut_ptr();
        def.vertexCount = points.len() as _;
        def.indices = indices.as_mut_ptr();
        def.triangleCount = mesh.triangles.len() as _;
        def.identifyEdges = true;
        b3CreateMesh(&def, std::ptr::null_mut(), 0)
    };
    assert!(!mesh.is_null(), "Box3D takes the mesh");
    mesh
}

/// A prism of 16 sides in place of a cylinder, which Box3D does not have.
fn prism(half_height: f32, radius: f32) -> Vec<V3> {
    let corners = (0..16).map(|i| (i as f32 * std::f32::consts::TAU / 16.0).sin_cos());
    corners
        .flat_map(|(sin, cos)| [-half_height, half_height].map(|y| [radius * cos, y, radius * sin]))
        .collect()
}

/// Adds the convex hull of some points to a body.
///
/// # Safety
/// The body must be alive.
unsafe fn add_hull(body: b3BodyId, def: &b3ShapeDef, points: &[V3]) {
    let points: Vec<b3Vec3> = points.iter().map(|p| v(*p)).collect();
    // SAFETY: the body is alive by the contract. Box3D copies the points into the hull, and the hull
    // into the shape.
    unsafe {
        let hull = b3CreateHull(points.as_ptr(), points.len() as _, points.len() as _);
        assert!(!hull.is_null(), "Box3D takes the hull");
        b3CreateHullShape(body, def, hull);
        b3DestroyHull(hull);
    }
}

impl World {
    fn add_shape(&mut self, body: b3BodyId, def: &b3ShapeDef, part: &Part3) {
        let place = b3Transform { p: v(part.pos), q: q(part.turn) };
        // SAFETY: the body is alive, and Box3D copies definition and geometry, but for meshes, which live as
        // long as the world.
        unsafe {
            match &part.shape {
                Shape3::Sphere(r) => {
                    b3CreateSphereShape(body, def, &b3Sphere { center: place.p, radius: *r });
                }
                Shape3::Box(x, y, z) => {
                    let hull = b3MakeTransformedBoxHull(*x, *y, *z, place);
                    b3CreateHullShape(body, def, &hull.base);
                }
                Shape3::Capsule(h, r) => {
                    assert!(part.is_centred(), "no scene has a capsule as a part");
                    let (center1, center2) = (v([0.0, -h, 0.0]), v([0.0, *h, 0.0]));
                    b3CreateCapsuleShape(body, def, &b3Capsule { center1, center2, radius: *r });
                }
                Shape3::Hull(points) => {
                    assert!(part.is_centred(), "a part's hull has its points in the body's frame");
                    add_hull(body, def, points);
                }
                Shape3::Cylinder(h, r) => {
                    assert!(part.is_centred(), "no scene has a cylinder as a part");
                    add_hull(body, def, &prism(*h, *r));
                }
                Shape3::Mesh(mesh) => {
                    let mesh = make_mesh(mesh);
                    b3CreateMeshShape(body, def, mesh, v([1.0; 3]));
                    self.meshes.push(mesh);
                }
            }
        }
    }
}

impl Engine<D3> for World {
    fn add_body(&mut self, b: &Body3) {
        // SAFETY: the definitions are Box3D's default ones, with plain values changed; the world is alive.
        unsafe {
            let mut def = b3DefaultBodyDef();
            def.type_ = match b.kind {
                Kind::Static => b3BodyType_b3_staticBody,
                Kind::Kinematic => b3BodyType_b3_kinematicBody,
                Kind::Dynamic => b3BodyType_b3_dynamicBody,
            };
            def.position = v(b.pos);
            def.rotation = q(b.turn);
            def.linearVelocity = v(b.vel);
            def.angularVelocity = v(b.spin);
            let id = b3CreateBody(self.id, &def);
            let mut shape = b3DefaultShapeDef();
            shape.density = b.density;
            shape.baseMaterial.friction = b.friction;
            shape.baseMaterial.restitution = b.restitution;
            if b.group == Group::NotEachOther {
                shape.filter.categoryBits = 2;
                shape.filter.maskBits = !2;
            }
            b.parts.iter().for_each(|part| self.add_shape(id, &shape, part));
            self.bodies.push(id);
        }
    }

    fn add_joint(&mut self, j: &Joint3) {
        // SAFETY: both bodies are alive, and Box3D copies the definition.
        unsafe {
            let mut def = b3DefaultSphericalJointDef();
            def.base.bodyIdA = self.bodies[j.a];
            def.base.bodyIdB = self.bodies[j.b];
            def.base.localFrameA.p = v(j.anchor_a);
            def.base.localFrameB.p = v(j.anchor_b);
            if let Some([cone, twist]) = j.limits {
                // Its axis is z of both frames.
                let axis = q(turn_about([1.0, 0.0, 0.0], -FRAC_PI_2));
                (def.base.localFrameA.q, def.base.localFrameB.q) = (axis, axis);
                (def.enableConeLimit, def.coneAngle) = (true, cone);
                def.enableTwistLimit = true;
                (def.lowerTwistAngle, def.upperTwistAngle) = (-twist, twist);
            }
            b3CreateSphericalJoint(self.id, &def);
        }
    }

    fn push(&mut self, body: usize, vel: V3) {
        // SAFETY: the body is alive.
        unsafe { b3Body_SetLinearVelocity(self.bodies[body], v(vel)) }
    }

    fn clear(&mut self) {
        for id in self.bodies.drain(..) {
            // SAFETY: the body is alive, and forgotten hereafter.
            unsafe { b3DestroyBody(id) }
        }
    }

    fn step(&mut self) {
        // SAFETY: the world is alive.
        unsafe { b3World_Step(self.id, DT, SUBSTEPS as _) }
    }

    fn states(&mut self, out: &mut Vec<State3>) {
        // SAFETY: the bodies are alive.
        out.extend(self.bodies.iter().map(|id| unsafe {
            let (p, q) = (b3Body_GetPosition(*id), b3Body_GetRotation(*id));
            let u = b3Body_GetLinearVelocity(*id);
            State3 { pos: [p.x, p.y, p.z], turn: [q.v.x, q.v.y, q.v.z, q.s], vel: [u.x, u.y, u.z] }
        }));
    }

    fn awake(&mut self) -> usize {
        // SAFETY: the world is alive.
        unsafe { b3World_GetAwakeBodyCount(self.id) as usize }
    }

    fn raycast(&mut self, rays: &[Ray3], out: &mut Vec<f32>) {
        out.clear();
        // SAFETY: the world is alive.
        out.extend(rays.iter().map(|r| unsafe {
            let along = v(r.dir.map(|d| d * r.length));
            let hit = b3World_CastRayClosest(self.id, v(r.origin), along, b3DefaultQueryFilter());
            if hit.hit { hit.fraction * r.length } else { f32::INFINITY }
        }));
    }

    fn ballcast(&mut self, radius: f32, rays: &[Ray3], out: &mut Vec<f32>) {
        unsafe extern "C" fn closest(
            _: b3ShapeId,
            _: b3Pos,
            _: b3Vec3,
            fraction: f32,
            _: u64,
            _: i32,
            _: i32,
            context: *mut c_void,
        ) -> f32 {
            // SAFETY: the context is the number below.
            unsafe { *context.cast::<f32>() = fraction };
            fraction
        }
        out.clear();
        // SAFETY: the world is alive, and proxy and number outlive the call.
        out.extend(rays.iter().map(|r| unsafe {
            let centre = v([0.0; 3]);
            let proxy = b3ShapeProxy { points: &centre, count: 1, radius };
            let mut best = f32::INFINITY;
            b3World_CastShape(
                self.id,
                v(r.origin),
                &proxy,
                v(r.dir.map(|d| d * r.length)),
                b3DefaultQueryFilter(),
                Some(closest),
                (&raw mut best).cast(),
            );
            best * r.length
        }));
    }

    fn stages(&mut self) -> Vec<Stage> {
        // SAFETY: the world is alive.
        let p = unsafe { b3World_GetProfile(self.id) };
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
        // SAFETY: world and meshes are alive, and not used after this.
        unsafe {
            b3DestroyWorld(self.id);
            self.meshes.iter().for_each(|m| b3DestroyMesh(*m));
        }
    }
}
