//! Characters of Rapier.

use rapier3d::{
    control::{CharacterAutostep, CharacterLength, KinematicCharacterController},
    prelude::*,
};

use super::{DT, SIDE, SIZE, STEP, STEPS, V, course::Part, hills, place, speed};
use crate::world::{median, milliseconds};

/// A character: a kinematic body, its fall in m/s, and whether it stood on the ground.
struct Character {
    body: RigidBodyHandle,
    fall: f32,
    is_grounded: bool,
}

fn v(v: V) -> Vector {
    Vector::new(v[0], v[1], v[2])
}

fn world() -> PhysicsWorld {
    let mut world = PhysicsWorld::new();
    world.gravity = v([0.0, -9.81, 0.0]);
    world.integration_parameters.dt = DT;
    world.configure_thread_pool(1).expect("a thread pool");
    world
}

/// Climbs steps and snaps to the ground as this engine's characters do by default.
fn controller() -> KinematicCharacterController {
    KinematicCharacterController {
        offset: CharacterLength::Absolute(0.01),
        autostep: Some(CharacterAutostep {
            max_height: CharacterLength::Absolute(STEP),
            min_width: CharacterLength::Absolute(0.1),
            include_dynamic_bodies: true,
        }),
        snap_to_ground: Some(CharacterLength::Absolute(STEP)),
        ..KinematicCharacterController::default()
    }
}

fn spawn(world: &mut PhysicsWorld, at: V) -> Character {
    let pose = Pose::from_parts(v(at), Rotation::IDENTITY);
    let body = world.insert_body(RigidBodyBuilder::kinematic_position_based().pose(pose));
    world.insert_collider(ColliderBuilder::capsule_y(0.5 * SIZE[1], SIZE[0]), Some(body));
    Character { body, fall: 0.0, is_grounded: false }
}

/// Moves a character by a tick.
fn advance(
    world: &mut PhysicsWorld,
    controller: &KinematicCharacterController,
    who: &mut Character,
    velocity: V,
) {
    who.fall = if who.is_grounded { 0.0 } else { who.fall } - 9.81 * DT;
    let wish = v([velocity[0], who.fall, velocity[2]]) * DT;
    let pose = *world.bodies[who.body].position();
    let queries = world.broad_phase.as_query_pipeline(
        world.narrow_phase.query_dispatcher(),
        &world.bodies,
        &world.colliders,
        QueryFilter::default().exclude_rigid_body(who.body),
    );
    let shape = Capsule::new_y(0.5 * SIZE[1], SIZE[0]);
    let moved = controller.move_shape(DT, &queries, &shape, &pose, wish, |_| ());
    who.is_grounded = moved.grounded;
    world.bodies[who.body].set_next_kinematic_translation(pose.translation + moved.translation);
}

/// The places of a character in a part of the course, after each tick.
pub fn walk(part: &Part) -> Vec<V> {
    let mut world = world();
    for block in &part.blocks {
        let [x, y, z] = block.half;
        let turn = Rotation::from_rotation_y(block.turn[1]) * Rotation::from_rotation_z(block.turn[0]);
        world.insert_collider(
            ColliderBuilder::cuboid(x, y, z).position(Pose::from_parts(v(block.at), turn)),
            None,
        );
    }
    let mut character = spawn(&mut world, part.start);
    world.step();
    let controller = controller();
    (0..(part.seconds / DT) as usize)
        .map(|_| {
            advance(&mut world, &controller, &mut character, part.velocity);
            world.step();
            let at = world.bodies[character.body].translation();
            [at.x, at.y, at.z]
        })
        .collect()
}

/// Times of a step of the crowd with its characters, and of these alone, by one thread.
pub fn crowd() -> [f64; 2] {
    let mut world = world();
    let (vertices, triangles) = hills();
    let vertices = vertices.into_iter().map(v).collect();
    world.insert_collider(ColliderBuilder::trimesh(vertices, triangles).expect("a mesh"), None);
    let mut characters: Vec<Character> = (0..SIDE * SIDE).map(|i| spawn(&mut world, place(i))).collect();
    world.step();
    let controller = controller();
    let (mut steps, mut parts) = (Vec::new(), Vec::new());
    for step in 0..STEPS[0] + STEPS[1] {
        let part = milliseconds(|| {
            for (i, character) in characters.iter_mut().enumerate() {
                advance(&mut world, &controller, character, [speed(i), 0.0, 0.0]);
            }
        });
        let rest = milliseconds(|| world.step());
        if step >= STEPS[0] {
            steps.push(part + rest);
            parts.push(part);
        }
    }
    [steps, parts].map(median)
}
