//! 3D parts of the scenes, and the list of 3D scenes.

use avian::math::Vector;
use avian::parry::math::Pose;
use avian::prelude::*;
use bevy_ecs::{entity::Entity, world::World};
use bevy_math::{Quat, Vec3};
use bevy_transform::components::Transform;

use crate::numbers::{Rng, half_turn_parts, sin_cos};
use crate::scene::{Bounds, Scene, Watch, at, spawn_block, spawn_body};
use crate::{
    belts, blast, breaking, bridge, bullets, card_house, cars, dominoes, growing, pile, pyramid, ragdolls,
    scaled, sensors, slopes, terrain, towers, tumbler, walkers,
};

/// Density of the bodies in kg/m³.
pub const DENSITY: f32 = 100.0;
/// Keeps all three coordinates of positions.
pub const PLANE: Vec3 = Vec3::ONE;
/// Width of the large pyramid's floor in metres.
pub const FLOOR_WIDTH: f32 = 800.0;
/// Columns and rows of one layer of the pile.
pub const PILE_GRID: (u32, u32) = (7, 7);
/// Kinds of pieces in the pile.
pub const PIECES: u32 = 8;
/// Layers of boxes in the tumbler, front to back.
pub const TUMBLER_DEPTH: u32 = 5;
/// Room between the tumbler's front and back in metres.
pub const TUMBLER_SPACE: f32 = 6.0;
/// Side and pitch of the tumbler's boxes in metres.
pub const TUMBLER_BOX: (f32, f32) = (0.6, 1.0);

/// No rotation.
pub const NO_TURN: Quat = Quat::IDENTITY;

/// The scenes of the tour.
pub static SCENES: [Scene; 20] = [
    Scene {
        name: "large_pyramid",
        about: "5,050 unit boxes, 100 at the base, sleeping off",
        steps: 200,
        build: |world| drop(pyramid::large(world, 100)),
        bounds: Bounds::new([-51.0, 0.0, -1.0], [51.0, 100.0, 1.0]),
        eye: Vec3::new(0.35, 0.18, 1.0),
        watch: Watch::Rest,
    },
    Scene {
        name: "many_pyramids",
        about: "14 x 14 pyramids of base 10, 10,780 boxes, sleeping off",
        steps: 100,
        build: |world| pyramid::many(world, 14, 14, 10),
        bounds: Bounds::new([-77.0, 0.0, -77.0], [77.0, 10.0, 77.0]),
        eye: Vec3::new(0.5, 0.55, 1.0),
        watch: Watch::Rest,
    },
    Scene {
        name: "mixed_pile",
        about: "every shape falls into a container",
        steps: 900,
        build: |world| pile::mixed(world, 9),
        bounds: Bounds::new([-8.0, -1.0, -8.0], [8.0, 9.0, 8.0]),
        eye: Vec3::new(0.35, 0.7, 1.0),
        watch: Watch::Inside,
    },
    Scene {
        name: "tumbler",
        about: "boxes in a kinematic drum that turns 25 degrees a second",
        steps: 750,
        build: |world| {
            tumbler::tumbler(world, 16);
        },
        bounds: Bounds::new([-15.0, -5.0, -4.0], [15.0, 25.0, 4.0]),
        eye: Vec3::new(0.25, 0.15, 1.0),
        watch: Watch::Inside,
    },
    Scene {
        name: "dominoes",
        about: "200 dominoes along a spiral, the outermost one falling",
        steps: 1800,
        build: |world| drop(dominoes::dominoes(world, 200)),
        bounds: Bounds::new([-10.0, -0.5, -10.0], [10.0, 1.5, 10.0]),
        eye: Vec3::new(0.1, 0.9, 1.0),
        watch: Watch::Inside,
    },
    Scene {
        name: "card_house",
        about: "a house of cards of 5 storeys",
        steps: 600,
        build: |world| card_house::card_house(world, 5),
        bounds: Bounds::new([-2.5, 0.0, -0.5], [2.5, 5.0, 0.5]),
        eye: Vec3::new(0.5, 0.25, 1.0),
        watch: Watch::Rest,
    },
    Scene {
        name: "slopes",
        about: "balls and cylinders roll or slip, boxes slide or stick on slopes of 20 degrees",
        steps: 240,
        build: |world| drop(slopes::slopes(world)),
        bounds: Bounds::new([-12.0, -4.5, -10.0], [12.0, 5.5, 10.0]),
        eye: Vec3::new(-0.4, 0.6, 1.0),
        watch: Watch::Rest,
    },
    Scene {
        name: "towers",
        about: "towers of 10, 20 and 50 boxes",
        steps: 900,
        build: |world| towers::towers(world, &[10, 20, 50]),
        bounds: Bounds::new([-8.0, 0.0, -2.0], [8.0, 50.5, 2.0]),
        eye: Vec3::new(0.6, 0.25, 1.0),
        watch: Watch::Rest,
    },
    Scene {
        name: "terrain",
        about: "every shape falls over a height field and a mesh",
        steps: 600,
        build: |world| terrain::terrain(world, 3),
        bounds: Bounds::new([-8.0, -1.0, -8.0], [8.0, 10.0, 8.0]),
        eye: Vec3::new(0.35, 0.45, 1.0),
        watch: Watch::Inside,
    },
    Scene {
        name: "sensors",
        about: "balls bob at the surface of a pool: a sensor and its events",
        steps: 600,
        build: |world| sensors::pool(world),
        bounds: Bounds::new([-8.0, -1.0, -8.0], [8.0, 14.0, 8.0]),
        eye: Vec3::new(0.35, 0.45, 1.0),
        watch: Watch::Inside,
    },
    Scene {
        name: "belts",
        about: "belts carry boxes to and fro, by the velocity of their surface",
        steps: 900,
        build: |world| belts::belts(world),
        bounds: Bounds::new([-8.0, -1.0, -8.0], [8.0, 14.0, 8.0]),
        eye: Vec3::new(0.35, 0.45, 1.0),
        watch: Watch::Inside,
    },
    Scene {
        name: "bullets",
        about: "fast balls between walls of 2 cm",
        steps: 300,
        build: |world| bullets::bullets(world, 100),
        bounds: Bounds::new([-6.5, -6.5, -6.5], [6.5, 6.5, 6.5]),
        eye: Vec3::new(0.35, 0.45, 1.0),
        watch: Watch::Inside,
    },
    Scene {
        name: "bridge",
        about: "a bridge of planks on joints, and heavy balls on chains",
        steps: 600,
        build: |world| bridge::bridge(world, 14),
        bounds: Bounds::new([-14.0, -1.0, -6.0], [14.0, 8.0, 6.0]),
        eye: Vec3::new(0.35, 0.45, 1.0),
        watch: Watch::Inside,
    },
    Scene {
        name: "ragdolls",
        about: "humans of capsules fall down a flight of stairs",
        steps: 600,
        build: |world| ragdolls::ragdolls(world, 2),
        bounds: Bounds::new([-7.0, -1.0, -7.0], [7.0, 14.0, 7.0]),
        eye: Vec3::new(0.35, 0.45, 1.0),
        watch: Watch::Inside,
    },
    Scene {
        name: "cars",
        about: "cars on springs drive over bumps into stacks of boxes",
        steps: 600,
        build: |world| cars::cars(world, 8),
        bounds: Bounds::new([-26.0, -1.0, -8.5], [26.0, 8.0, 8.5]),
        eye: Vec3::new(0.35, 0.45, 1.0),
        watch: Watch::Inside,
    },
    Scene {
        name: "breaking",
        about: "heavy balls break a wall of bricks that joints hold together",
        steps: 300,
        build: |world| breaking::breaking(world),
        bounds: Bounds::new([-20.0, -1.0, -8.0], [20.0, 9.0, 8.0]),
        eye: Vec3::new(0.35, 0.45, 1.0),
        watch: Watch::Inside,
    },
    Scene {
        name: "walkers",
        about: "characters walk to and fro over stairs and slopes, and push boxes",
        steps: 600,
        build: |world| walkers::walkers(world),
        bounds: Bounds::new([-13.0, -1.0, -6.5], [13.0, 6.0, 6.5]),
        eye: Vec3::new(0.35, 0.45, 1.0),
        watch: Watch::Inside,
    },
    Scene {
        name: "blasts",
        about: "what a query finds near the middle is blown away, every two seconds",
        steps: 600,
        build: |world| blast::blasts(world),
        bounds: Bounds::new([-8.0, -1.0, -8.0], [8.0, 14.0, 8.0]),
        eye: Vec3::new(0.35, 0.45, 1.0),
        watch: Watch::Inside,
    },
    Scene {
        name: "growing",
        about: "balls grow while they lie on each other",
        steps: 600,
        build: |world| growing::growing(world),
        bounds: Bounds::new([-8.0, -1.0, -8.0], [8.0, 14.0, 8.0]),
        eye: Vec3::new(0.35, 0.45, 1.0),
        watch: Watch::Inside,
    },
    Scene {
        name: "scaled",
        about: "ramps and pieces scaled by their transforms",
        steps: 600,
        build: |world| scaled::scaled(world),
        bounds: Bounds::new([-8.0, -1.0, -8.0], [8.0, 23.0, 8.0]),
        eye: Vec3::new(0.35, 0.45, 1.0),
        watch: Watch::Inside,
    },
];

/// Parry's pose for a transform without scale.
pub fn pose(transform: &Transform) -> Pose {
    Pose::from_parts(transform.translation, transform.rotation)
}

/// A vector along y.
pub fn upwards(length: f32) -> Vector {
    Vector::new(0.0, length, 0.0)
}

/// A vector of space is one already.
pub fn vector(of: Vec3) -> Vector {
    of
}

/// A velocity of turning about z, counter-clockwise, in rad/s.
pub fn spin(rate: f32) -> AngularVelocity {
    AngularVelocity(Vector::new(0.0, 0.0, rate))
}

/// A box by its side lengths.
pub fn block(width: f32, height: f32, depth: f32) -> Collider {
    Collider::cuboid(width, height, depth)
}

/// A sphere.
pub fn ball(radius: f32) -> Collider {
    Collider::sphere(radius)
}

/// A box whose only part can have a material of its own.
pub fn belt(width: f32, height: f32, depth: f32) -> Collider {
    Collider::compound(vec![(Vec3::ZERO, Quat::IDENTITY, block(width, height, depth))])
}

/// A square height field by its width and its height at x and z.
pub fn hills(width: f32, height: impl Fn(f32, f32) -> f32) -> Collider {
    let at = |i: u8| width * (f32::from(i) / 40.0 - 0.5);
    let heights = (0..=40).map(|i| (0..=40).map(|j| height(at(i), at(j))).collect()).collect();
    Collider::heightfield(heights, Vec3::new(width, 1.0, width))
}

/// A roof by its width and height: a pyramid of triangles.
pub fn roof(width: f32, height: f32) -> Collider {
    let half = 0.5 * width;
    let corners = [(-half, -half), (half, -half), (half, half), (-half, half)];
    let mut points: Vec<Vector> = corners.map(|(x, z)| Vec3::new(x, 0.0, z)).to_vec();
    points.push(Vec3::Y * height);
    let sides = [[1, 0, 4], [2, 1, 4], [3, 2, 4], [0, 3, 4], [0, 1, 2], [0, 2, 3]];
    Collider::trimesh(points, sides.to_vec())
}

/// A rolling body: a cylinder along y, see [`roller_turn`].
pub fn roller(radius: f32, length: f32) -> Collider {
    Collider::cylinder(radius, length)
}

/// A wheel at a place of its chassis, a [`roller`] turned by [`roller_turn`].
pub fn wheel(chassis: Entity, wheel: Entity, place: [f32; 3]) -> WheelJoint {
    WheelJoint::new(chassis, wheel)
        .with_local_anchor1(Vector::from(place))
        .with_local_basis2(roller_turn().inverse())
        .with_axle(Vector::Z)
}

/// z of the wheels of an axle.
pub fn wheels_across(distance: f32) -> [f32; 2] {
    [-distance, distance]
}

/// The rotation that puts a cylinder's axis across the slope.
pub fn roller_turn() -> Quat {
    let (sin, cos) = half_turn_parts(core::f32::consts::FRAC_PI_2);
    Quat::from_xyzw(sin, 0.0, 0.0, cos)
}

/// The middle of the ramp of a lane: beside each other.
pub fn lane(index: usize) -> Vec3 {
    Vec3::new(0.0, 0.0, (index as f32 - 3.5) * 2.5)
}

/// z and glass of the walls in front and behind.
pub fn walls_across(distance: f32) -> [(f32, bool); 2] {
    [(-distance, false), (distance, true)]
}

/// The place of a row of pyramids.
pub fn pyramid_row(row: u32, rows: u32, width: f32, _pitch: f32) -> Vec3 {
    let reach = 0.5 * width - 1.0;
    let step = 2.0 * reach / (rows.max(2) - 1) as f32;
    Vec3::new(0.0, 0.0, row as f32 * step - reach)
}

/// One floor for all pyramids.
pub fn spawn_pyramid_floors(world: &mut World, _rows: u32, width: f32, _pitch: f32) {
    spawn_body(world, RigidBody::Static, block(width, 2.0, width), at(0.0, -1.0, 0.0));
}

/// Foot and heading of each domino: an Archimedean spiral inwards, r = r₀ − c φ, walked in steps of
/// equal length.
pub fn domino_path(count: u32) -> Vec<(Vec3, f32)> {
    let (mut radius, mut angle) = (8.5, 0.0f32);
    let shrink = 1.8 / core::f32::consts::TAU;
    (0..count)
        .map(|_| {
            let (sin, cos) = sin_cos(angle);
            let foot = Vec3::new(radius * cos, 0.0, radius * sin);
            // The way on is (−sin, cos) in (x, z); a yaw ψ turns x into (cos ψ, −sin ψ).
            let heading = -angle - core::f32::consts::FRAC_PI_2;
            let step = dominoes::PITCH / radius;
            angle += step;
            radius -= shrink * step;
            (foot, heading)
        })
        .collect()
}

/// The floor below the spiral.
pub fn spawn_domino_floor(world: &mut World, _count: u32) {
    spawn_block(world, [24.0, 2.0, 24.0], at(0.0, -1.0, 0.0));
}

/// A further rotation of a piece of the pile, out of the plane.
pub fn piece_turn(angle: f32) -> Quat {
    let (sin, cos) = half_turn_parts(1.7 * angle);
    Quat::from_xyzw(sin, 0.0, 0.0, cos)
}

/// The colliders of a piece of the pile, each with its place on the body: the first is the body's own.
pub fn piece(kind: u32) -> Vec<(Collider, Transform)> {
    let single = |collider: Collider| vec![(collider, Transform::IDENTITY)];
    match kind {
        0 => single(Collider::sphere(0.45)),
        1 => single(Collider::capsule(0.3, 0.5)),
        2 => single(Collider::cuboid(0.9, 0.6, 0.7)),
        3 => single(Collider::convex_hull(rock(0.6)).expect("points around a sphere")),
        4 => single(Collider::cylinder(0.4, 0.8)),
        5 => single(Collider::cone(0.5, 0.9)),
        6 => single(Collider::round_cuboid(0.6, 0.5, 0.4, 0.12)),
        _ => vec![
            (Collider::cuboid(0.8, 0.2, 0.2), Transform::IDENTITY),
            (Collider::sphere(0.23), at(-0.37, 0.0, 0.0)),
            (Collider::sphere(0.23), at(0.37, 0.0, 0.0)),
        ],
    }
}

/// Twelve random points at the given distance from the origin.
fn rock(radius: f32) -> Vec<Vector> {
    let mut rng = Rng::new(3);
    let mut points = Vec::new();
    while points.len() < 12 {
        let mut coordinate = || rng.between(-1.0, 1.0);
        let point = Vec3::new(coordinate(), coordinate(), coordinate());
        if (0.1..1.0).contains(&point.length_squared()) {
            points.push(point * (radius / point.length()));
        }
    }
    points
}
