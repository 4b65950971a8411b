//! 2D parts of the scenes, and the list of 2D scenes.

use avian::math::Vector;
use avian::parry::math::{Pose, Rotation as Rotation2};
use avian::prelude::*;
use bevy_ecs::{entity::Entity, world::World};
use bevy_math::{Quat, Vec2, Vec3};
use bevy_transform::components::Transform;

use crate::scene::{Bounds, Scene, Watch, at, spawn_block, spawn_body};
use crate::{
    belts, blast, breaking, bridge, bullets, card_house, cars, dominoes, growing, pile, pyramid, ragdolls,
    scaled, sensors, slopes, terrain, towers, tumbler, walkers,
};

/// Density of the bodies in kg/m².
pub const DENSITY: f32 = 1.0;
/// Keeps positions in the plane.
pub const PLANE: Vec3 = Vec3::new(1.0, 1.0, 0.0);
/// Width of the large pyramid's floor in metres.
pub const FLOOR_WIDTH: f32 = 200.0;
/// Columns and rows of one layer of the pile.
pub const PILE_GRID: (u32, u32) = (8, 1);
/// Kinds of pieces in the pile.
pub const PIECES: u32 = 9;
/// Layers of boxes in the tumbler, front to back.
pub const TUMBLER_DEPTH: u32 = 1;
/// Room between the tumbler's front and back in metres.
pub const TUMBLER_SPACE: f32 = 1.0;
/// Side and pitch of the tumbler's boxes in metres.
pub const TUMBLER_BOX: (f32, f32) = (0.25, 0.4);

/// No rotation.
pub const NO_TURN: f32 = 0.0;

/// The scenes of the tour.
pub static SCENES: [Scene; 20] = [
    Scene {
        name: "large_pyramid",
        about: "5,050 unit boxes, 100 at the base, sleeping off",
        steps: 500,
        build: |world| drop(pyramid::large(world, 100)),
        bounds: Bounds::new([-54.0, -2.0, 0.0], [54.0, 102.0, 0.0]),
        eye: Vec3::Z,
        watch: Watch::Rest,
    },
    Scene {
        name: "many_pyramids",
        about: "20 x 20 pyramids of base 10, 22,000 boxes, sleeping off",
        steps: 200,
        build: |world| pyramid::many(world, 20, 20, 10),
        bounds: Bounds::new([-111.0, -1.0, 0.0], [111.0, 221.0, 0.0]),
        eye: Vec3::Z,
        watch: Watch::Rest,
    },
    Scene {
        name: "mixed_pile",
        about: "every shape falls into a container",
        steps: 900,
        build: |world| pile::mixed(world, 20),
        bounds: Bounds::new([-8.0, -1.5, 0.0], [8.0, 16.0, 0.0]),
        eye: Vec3::Z,
        watch: Watch::Inside,
    },
    Scene {
        name: "tumbler",
        about: "2,025 small boxes in a kinematic drum that turns 25 degrees a second",
        steps: 750,
        build: |world| {
            tumbler::tumbler(world, 45);
        },
        bounds: Bounds::new([-15.0, -5.0, 0.0], [15.0, 25.0, 0.0]),
        eye: Vec3::Z,
        watch: Watch::Inside,
    },
    Scene {
        name: "dominoes",
        about: "60 dominoes in a line, the first one falling",
        steps: 600,
        build: |world| drop(dominoes::dominoes(world, 60)),
        bounds: Bounds::new([-20.0, -1.5, 0.0], [20.0, 5.0, 0.0]),
        eye: Vec3::Z,
        watch: Watch::Inside,
    },
    Scene {
        name: "card_house",
        about: "a house of cards of 5 storeys",
        steps: 600,
        build: |world| card_house::card_house(world, 5),
        bounds: Bounds::new([-3.0, -0.5, 0.0], [3.0, 5.3, 0.0]),
        eye: Vec3::Z,
        watch: Watch::Rest,
    },
    Scene {
        name: "slopes",
        about: "circles roll or slip, boxes slide or stick on slopes of 20 degrees",
        steps: 240,
        build: |world| drop(slopes::slopes(world)),
        bounds: Bounds::new([-26.0, -22.0, 0.0], [26.0, 23.0, 0.0]),
        eye: Vec3::Z,
        watch: Watch::Rest,
    },
    Scene {
        name: "towers",
        about: "towers of 10, 20 and 50 boxes",
        steps: 900,
        build: |world| towers::towers(world, &[10, 20, 50]),
        bounds: Bounds::new([-14.0, -2.0, 0.0], [14.0, 51.0, 0.0]),
        eye: Vec3::Z,
        watch: Watch::Rest,
    },
    Scene {
        name: "terrain",
        about: "every shape falls over a height field and a mesh",
        steps: 600,
        build: |world| terrain::terrain(world, 3),
        bounds: Bounds::new([-8.0, -1.5, 0.0], [8.0, 12.0, 0.0]),
        eye: Vec3::Z,
        watch: Watch::Inside,
    },
    Scene {
        name: "sensors",
        about: "balls bob at the surface of a pool: a sensor and its events",
        steps: 600,
        build: |world| sensors::pool(world),
        bounds: Bounds::new([-8.0, -1.5, 0.0], [8.0, 14.0, 0.0]),
        eye: Vec3::Z,
        watch: Watch::Inside,
    },
    Scene {
        name: "belts",
        about: "belts carry boxes to and fro, by the velocity of their surface",
        steps: 900,
        build: |world| belts::belts(world),
        bounds: Bounds::new([-8.0, -1.5, 0.0], [8.0, 15.0, 0.0]),
        eye: Vec3::Z,
        watch: Watch::Inside,
    },
    Scene {
        name: "bullets",
        about: "fast balls between walls of 2 cm",
        steps: 300,
        build: |world| bullets::bullets(world, 100),
        bounds: Bounds::new([-6.5, -6.5, 0.0], [6.5, 6.5, 0.0]),
        eye: Vec3::Z,
        watch: Watch::Inside,
    },
    Scene {
        name: "bridge",
        about: "a bridge of planks on joints, and heavy balls on chains",
        steps: 600,
        build: |world| bridge::bridge(world, 14),
        bounds: Bounds::new([-14.0, -1.5, 0.0], [14.0, 9.0, 0.0]),
        eye: Vec3::Z,
        watch: Watch::Inside,
    },
    Scene {
        name: "ragdolls",
        about: "humans of capsules fall down a flight of stairs",
        steps: 600,
        build: |world| ragdolls::ragdolls(world, 4),
        bounds: Bounds::new([-7.0, -1.0, 0.0], [7.0, 14.0, 0.0]),
        eye: Vec3::Z,
        watch: Watch::Inside,
    },
    Scene {
        name: "cars",
        about: "cars on springs drive over bumps into stacks of boxes",
        steps: 600,
        build: |world| cars::cars(world, 3),
        bounds: Bounds::new([-26.0, -1.0, 0.0], [26.0, 8.0, 0.0]),
        eye: Vec3::Z,
        watch: Watch::Inside,
    },
    Scene {
        name: "breaking",
        about: "heavy balls break a wall of bricks that joints hold together",
        steps: 300,
        build: |world| breaking::breaking(world),
        bounds: Bounds::new([-20.0, -1.0, 0.0], [20.0, 9.0, 0.0]),
        eye: Vec3::Z,
        watch: Watch::Inside,
    },
    Scene {
        name: "walkers",
        about: "characters walk to and fro over stairs and slopes, and push boxes",
        steps: 600,
        build: |world| walkers::walkers(world),
        bounds: Bounds::new([-13.0, -1.0, 0.0], [13.0, 6.0, 0.0]),
        eye: Vec3::Z,
        watch: Watch::Inside,
    },
    Scene {
        name: "blasts",
        about: "what a query finds near the middle is blown away, every two seconds",
        steps: 600,
        build: |world| blast::blasts(world),
        bounds: Bounds::new([-8.0, -1.5, 0.0], [8.0, 14.0, 0.0]),
        eye: Vec3::Z,
        watch: Watch::Inside,
    },
    Scene {
        name: "growing",
        about: "balls grow while they lie on each other",
        steps: 600,
        build: |world| growing::growing(world),
        bounds: Bounds::new([-8.0, -1.5, 0.0], [8.0, 14.0, 0.0]),
        eye: Vec3::Z,
        watch: Watch::Inside,
    },
    Scene {
        name: "scaled",
        about: "ramps and pieces scaled by their transforms",
        steps: 600,
        build: |world| scaled::scaled(world),
        bounds: Bounds::new([-8.0, -1.5, 0.0], [8.0, 23.0, 0.0]),
        eye: Vec3::Z,
        watch: Watch::Inside,
    },
];

/// Parry's pose for a transform in the plane: a turn by φ about z is the quaternion (0, 0, sin φ/2, cos φ/2).
pub fn pose(transform: &Transform) -> Pose {
    let (z, w) = (transform.rotation.z, transform.rotation.w);
    let rotation = Rotation2::from_cos_sin_unchecked(w * w - z * z, 2.0 * w * z);
    Pose::from_parts(transform.translation.truncate(), rotation)
}

/// A vector along y.
pub fn upwards(length: f32) -> Vector {
    Vector::new(0.0, length)
}

/// The part of a vector in the plane.
pub fn vector(of: Vec3) -> Vector {
    of.truncate()
}

/// A velocity of turning in the plane, counter-clockwise, in rad/s.
pub fn spin(rate: f32) -> AngularVelocity {
    AngularVelocity(rate)
}

/// A box by its side lengths; the depth is ignored.
pub fn block(width: f32, height: f32, _depth: f32) -> Collider {
    Collider::rectangle(width, height)
}

/// A circle.
pub fn ball(radius: f32) -> Collider {
    Collider::circle(radius)
}

/// A box whose only part can have a material of its own.
pub fn belt(width: f32, height: f32, depth: f32) -> Collider {
    Collider::compound(vec![(Vec2::ZERO, 0.0, block(width, height, depth))])
}

/// A height field by its width and its height at x and z.
pub fn hills(width: f32, height: impl Fn(f32, f32) -> f32) -> Collider {
    let at = |i: u8| width * (f32::from(i) / 40.0 - 0.5);
    Collider::heightfield((0..=40).map(|i| height(at(i), 0.0)).collect(), Vec2::new(width, 1.0))
}

/// A roof by its width and height: a closed line.
pub fn roof(width: f32, height: f32) -> Collider {
    let corners = vec![Vec2::new(-0.5 * width, 0.0), Vec2::new(0.5 * width, 0.0), Vec2::new(0.0, height)];
    Collider::polyline(corners, Some(vec![[0, 1], [1, 2], [2, 0]]))
}

/// The 2D version of a rolling cylinder: a circle.
pub fn roller(radius: f32, _length: f32) -> Collider {
    Collider::circle(radius)
}

/// A wheel at a place of its chassis, that spins across the plane.
pub fn wheel(chassis: Entity, wheel: Entity, [x, y, _]: [f32; 3]) -> WheelJoint {
    WheelJoint::new(chassis, wheel).with_local_anchor1(Vector::new(x, y))
}

/// z of the wheels of an axle.
pub fn wheels_across(_distance: f32) -> [f32; 1] {
    [0.0]
}

/// The rotation that puts a cylinder's axis across the slope.
pub fn roller_turn() -> Quat {
    Quat::IDENTITY
}

/// The middle of the ramp of a lane: two columns of ramps above each other.
pub fn lane(index: usize) -> Vec3 {
    let (column, row) = (index % 2, index / 2);
    Vec3::new(column as f32 * 26.0 - 13.0, 15.0 - 10.0 * row as f32, 0.0)
}

/// z and glass of the walls in front and behind.
pub fn walls_across(_distance: f32) -> [(f32, bool); 0] {
    []
}

/// The place of a row of pyramids.
pub fn pyramid_row(row: u32, _rows: u32, _width: f32, pitch: f32) -> Vec3 {
    Vec3::new(0.0, row as f32 * pitch, 0.0)
}

/// A segment under each row of pyramids.
pub fn spawn_pyramid_floors(world: &mut World, rows: u32, width: f32, pitch: f32) {
    for row in 0..rows {
        let floor = Collider::segment(Vector::new(-0.5 * width, 0.0), Vector::new(0.5 * width, 0.0));
        spawn_body(world, RigidBody::Static, floor, at(0.0, row as f32 * pitch, 0.0));
    }
}

/// Foot and heading of each domino: a line to the right.
pub fn domino_path(count: u32) -> Vec<(Vec3, f32)> {
    let middle = 0.5 * (count as f32 - 1.0);
    (0..count).map(|i| (Vec3::new((i as f32 - middle) * dominoes::PITCH, 0.0, 0.0), 0.0)).collect()
}

/// The floor below the line.
pub fn spawn_domino_floor(world: &mut World, count: u32) {
    spawn_block(world, [count as f32 * dominoes::PITCH + 4.0, 2.0, 1.0], at(0.0, -1.0, 0.0));
}

/// A further rotation of a piece of the pile, out of the plane.
pub fn piece_turn(_angle: f32) -> Quat {
    Quat::IDENTITY
}

/// The colliders of a piece of the pile, each with its place on the body: the first is the body's own.
pub fn piece(kind: u32) -> Vec<(Collider, Transform)> {
    let single = |collider: Collider| vec![(collider, Transform::IDENTITY)];
    let hull = [(-0.5, -0.3), (0.1, -0.5), (0.55, -0.1), (0.4, 0.4), (-0.2, 0.55)];
    match kind {
        0 => single(Collider::circle(0.45)),
        1 => single(Collider::capsule(0.3, 0.5)),
        2 => single(Collider::rectangle(0.9, 0.7)),
        3 => {
            let points = hull.iter().map(|&(x, y)| Vec2::new(x, y)).collect();
            single(Collider::convex_hull(points).expect("five corners of a pentagon"))
        }
        4 => single(Collider::triangle(Vec2::new(-0.5, -0.4), Vec2::new(0.5, -0.4), Vec2::new(0.0, 0.5))),
        5 => single(Collider::ellipse(0.55, 0.35)),
        6 => single(Collider::round_rectangle(0.6, 0.5, 0.12)),
        7 => single(Collider::regular_polygon(0.5, 6)),
        _ => vec![
            (Collider::rectangle(0.8, 0.2), Transform::IDENTITY),
            (Collider::circle(0.23), at(-0.37, 0.0, 0.0)),
            (Collider::circle(0.23), at(0.37, 0.0, 0.0)),
        ],
    }
}
