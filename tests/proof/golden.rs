//! Golden hashes: final states of whole scenes, bit by bit, with any number of workers and any width of rows.
//!
//! The expected hashes are in `golden2.rs` and `golden3.rs`. If a change of the simulation is intended,
//! the table printed by the failing test replaces the old one, and the commit says why. The kernel's own
//! golden hashes (`tests/kernel/golden.rs`) hold on every machine, and as far as is known those of
//! native shapes here. Parry's results may differ between instruction sets, so scenes with its shapes
//! are listed separately.

use avian::{
    collision::CollisionDiagnostics,
    dynamics::solver::{RowWidth, WorkerCount},
    math::{Scalar, Vector},
    prelude::*,
};
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use scenes::{
    Rng, card_house, dominoes, pile, pyramid,
    scene::{at, turned},
    slopes, towers, tumbler,
};

use super::{
    dim,
    golden_dim::{FOREIGN, NATIVE, TUMBLER_SIDE, spin_bits},
    world::Lab,
};

/// Name of a scene, and the function that builds and runs it.
type Scene = (&'static str, fn(&mut Lab));

/// Scenes of the kernel's shapes only.
const OF_NATIVE: [Scene; 11] = [
    ("pyramid", large_pyramid),
    ("pyramids", many_pyramids),
    ("tumbler", in_tumbler),
    ("dominoes", falling_dominoes),
    ("card_house", house_of_cards),
    ("towers", straight_towers),
    ("smash", smash),
    ("crowd", crowd),
    ("sleepers", sleepers),
    ("bounces", bounces),
    ("settings", settings),
];

/// Scenes with other shapes.
const WITH_FOREIGN: [Scene; 2] = [("pile", mixed_pile), ("slopes", on_slopes)];

/// Minimum number of contacts for which threads are woken.
const MANY: u32 = 1024;

#[track_caller]
fn assert_many_contacts(lab: &Lab) {
    let count = lab.app.world().resource::<CollisionDiagnostics>().contact_count;
    assert!(count > MANY, "{count} contacts call no helpers");
}

/// A large pyramid that a ball hits.
fn large_pyramid(lab: &mut Lab) {
    pyramid::large(lab.app.world_mut(), 34);
    let ball = lab.ball(1.5, at(-28.0, 6.0, 0.0));
    lab.insert(ball, LinearVelocity(Vector::X * 40.0));
    lab.steps(60);
    assert_many_contacts(lab);
}

fn many_pyramids(lab: &mut Lab) {
    pyramid::many(lab.app.world_mut(), 3, 3, 6);
    lab.steps(60);
}

fn in_tumbler(lab: &mut Lab) {
    tumbler::tumbler(lab.app.world_mut(), TUMBLER_SIDE);
    lab.steps(150);
}

fn falling_dominoes(lab: &mut Lab) {
    dominoes::dominoes(lab.app.world_mut(), 30);
    lab.steps(150);
}

fn house_of_cards(lab: &mut Lab) {
    card_house::card_house(lab.app.world_mut(), 4);
    lab.steps(90);
}

fn straight_towers(lab: &mut Lab) {
    towers::towers(lab.app.world_mut(), &[5, 10, 20]);
    lab.steps(120);
}

fn mixed_pile(lab: &mut Lab) {
    pile::mixed(lab.app.world_mut(), if dim::LAYER.1 == 1 { 8 } else { 2 });
    lab.steps(150);
}

fn on_slopes(lab: &mut Lab) {
    slopes::slopes(lab.app.world_mut());
    lab.steps(90);
}

/// A heavy ball breaks through a wall of boxes.
fn smash(lab: &mut Lab) {
    lab.floor();
    for i in 0..600 {
        let (column, row) = ((i % 30) as f32, (i / 30) as f32);
        lab.unit_box(at(column + 0.25 * (row % 2.0), row + 0.5, 0.0));
    }
    let ball = lab.ball(2.0, at(-6.0, 8.0, 0.0));
    lab.insert(ball, (LinearVelocity(Vector::X * 50.0), ColliderDensity(20.0)));
    lab.steps(90);
    assert_many_contacts(lab);
}

/// A hundred bodies in one place.
fn crowd(lab: &mut Lab) {
    lab.floor();
    for i in 0..100 {
        let pose = at(0.0, 2.0, 0.0).with_rotation(turned(0.1 * i as f32));
        if i % 3 == 0 {
            lab.ball(0.5, pose)
        } else {
            lab.unit_box(pose)
        };
    }
    lab.steps(30);
    assert_many_contacts(lab);
}

/// A heap falls asleep, and is hit.
fn sleepers(lab: &mut Lab) {
    lab.floor();
    let mut heap = Vec::new();
    for i in 0..60 {
        let (column, row) = (i % 10, i / 10);
        heap.push(lab.unit_box(at(1.01 * column as f32, 0.5 + row as f32, 0.1 * (row % 2) as f32)));
    }
    lab.steps(90);
    assert!(heap.iter().all(|&body| lab.has::<Sleeping>(body)), "all sleep by now");
    let ball = lab.ball(0.8, at(-4.0, 3.5, 0.0));
    lab.insert(ball, LinearVelocity(Vector::X * 20.0));
    lab.steps(30);
    assert!(!heap.iter().any(|&body| lab.has::<Sleeping>(body)), "the hit woke all");
    lab.steps(60);
}

/// Restitution of several values.
fn bounces(lab: &mut Lab) {
    let floor = lab.floor();
    lab.insert(floor, Restitution::new(0.6));
    for i in 0..60 {
        let pose = at((i % 12) as f32 * 1.3, 1.5 + 1.6 * (i / 12) as f32, 0.0);
        let pose = pose.with_rotation(turned(0.3 * (i % 7) as f32));
        let body = if i % 2 == 0 { lab.ball(0.5, pose) } else { lab.unit_box(pose) };
        lab.insert(body, Restitution::new(0.25 * (i % 5) as Scalar));
    }
    lab.steps(120);
}

/// Bodies with different settings.
fn settings(lab: &mut Lab) {
    lab.floor();
    let mut rng = Rng::new(5);
    for i in 0..80 {
        let pose = at((i % 16) as f32 * 1.1, 0.6 + 1.1 * (i / 16) as f32, rng.between(-0.2, 0.2));
        let pose = pose.with_translation(pose.translation * scenes::dim::PLANE + Vec3::Y * 0.1);
        let body = if i % 4 == 0 { lab.ball(0.5, pose) } else { lab.unit_box(pose) };
        match i % 8 {
            0 => lab.insert(body, GravityScale(-0.5)),
            1 => lab.insert(body, (LinearDamping(2.0), AngularDamping(5.0))),
            2 => lab.insert(body, dim::upright()),
            3 => lab.insert(body, LockedAxes::new().lock_translation_x()),
            4 => lab.insert(body, Dominance((i % 7) as i8 - 3)),
            5 => lab.insert(body, (MaxLinearSpeed(1.5), MaxAngularSpeed(1.0))),
            6 => lab.insert(body, (Friction::new(0.1), ColliderDensity(5.0))),
            _ => lab.insert(body, (RigidBody::Kinematic, LinearVelocity(Vector::X * 0.4))),
        }
    }
    lab.steps(120);
}

/// FNV-1a of 64 bits (Fowler, Noll and Vo) over positions, rotations and velocities of all moving bodies, in
/// the order of spawning.
fn hash(lab: &mut Lab) -> u64 {
    let world = lab.app.world_mut();
    let mut query = world.query::<(Entity, &RigidBody)>();
    let moves = |(entity, kind): (Entity, &RigidBody)| (!kind.is_static()).then_some(entity);
    let mut bodies: Vec<Entity> = query.iter(world).filter_map(moves).collect();
    bodies.sort();
    let mut bits = lab.bits(&bodies);
    bits.extend(bodies.iter().flat_map(|&body| spin_bits(lab.get(body))));
    assert!(bits.iter().all(|&bits| Scalar::from_bits(bits).is_finite()));
    bits.into_iter().flat_map(u32::to_le_bytes).fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3)
    })
}

fn check(scenes: &[Scene], golden: &[(&str, u64)]) {
    let mut table = Vec::new();
    for &(name, run) in scenes {
        let hash_of = |workers: usize, width: RowWidth| {
            let mut lab = Lab::new();
            lab.app.insert_resource(WorkerCount(workers));
            lab.app.insert_resource(width);
            run(&mut lab);
            hash(&mut lab)
        };
        let alone = hash_of(1, RowWidth::Widest);
        for (workers, width) in
            [(1, RowWidth::Four), (2, RowWidth::Widest), (4, RowWidth::Four), (8, RowWidth::Widest)]
        {
            let same = hash_of(workers, width) == alone;
            assert!(same, "{name}: {workers} workers with rows of width {width:?} differ from one");
        }
        table.push((name, alone));
    }
    let lines: String =
        table.iter().map(|(name, hash)| format!("    (\"{name}\", {hash:#018x}),\n")).collect();
    assert!(table == golden, "scenes do not end as they did. If that is meant, this is the table:\n{lines}");
}

#[test]
fn scenes_of_native_shapes_have_their_golden_hashes() {
    check(&OF_NATIVE, &NATIVE);
}

#[test]
fn scenes_with_foreign_shapes_have_their_golden_hashes() {
    check(&WITH_FOREIGN, &FOREIGN);
}
