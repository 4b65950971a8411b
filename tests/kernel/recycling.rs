//! When a manifold is recycled in the next step, and when it must be recomputed.

use super::dim::{sized, spin, turned};
use super::sim::{Outcome, Sim};
use crate::kernel;
use kernel::contact::ContactFlags;
use kernel::math::{Pose, Rot, Vector, WorldPose};
use kernel::shape::{Ball, Cuboid, Shape};
use kernel::table::{BodyKind, ColliderDef, Velocity};

/// A box that has come to rest on a floor: the floor, and the box.
fn at_rest() -> (Sim, [u32; 2]) {
    let mut sim = Sim::new();
    let floor = sim.floor();
    let id = sim.cuboid(Vector::ONE * 0.5, Vector::Y * 0.5);
    sim.steps(30);
    assert_eq!(sim.look(floor, id).0, Outcome::Recycled, "nothing moves");
    (sim, [floor, id])
}

/// Moves a body as a step does, not by hand.
fn shift(sim: &mut Sim, id: u32, by: Vector, turn: Rot) {
    let pose = &mut sim.bodies.poses[id as usize];
    pose.center += by.to_world();
    pose.rotation = turn.mul(pose.rotation);
    pose.travel = pose.travel.wrapping_add(1 << 30);
    sim.colliders.refresh(id, &sim.bodies, sim.fattening());
}

fn redefine(sim: &mut Sim, id: u32, change: impl FnOnce(&mut ColliderDef)) {
    let mut def = sim.colliders[id].def.clone();
    change(&mut def);
    sim.colliders.redefine(id, def, &mut sim.bodies);
}

/// The outcome for the contact of a box at rest after a change to box and floor.
fn after(change: impl FnOnce(&mut Sim, [u32; 2])) -> Outcome {
    let (mut sim, ids) = at_rest();
    change(&mut sim, ids);
    sim.look(ids[0], ids[1]).0
}

#[test]
fn small_motion_is_followed() {
    let (mut sim, [floor, id]) = at_rest();
    shift(&mut sim, id, Vector::Y * 0.002 + Vector::X * 0.01, turned(0.01));
    let (found, followed) = sim.look(floor, id);
    assert_eq!(found, Outcome::Recycled);
    sim.recycle = false;
    let (found, computed) = sim.look(floor, id);
    assert_eq!(found, Outcome::Recomputed);
    assert_eq!(followed.manifold.count, computed.manifold.count);
    for p in computed.manifold.points() {
        let same = followed.manifold.points().iter().find(|f| f.feature == p.feature).expect("same corners");
        assert!((same.separation - p.separation).abs() < 5e-5, "{} for {}", same.separation, p.separation);
    }
}

#[test]
fn motion_beyond_the_limits_is_computed_anew() {
    assert_eq!(after(|sim, [_, id]| shift(sim, id, Vector::X * 0.045, Rot::IDENTITY)), Outcome::Recycled);
    assert_eq!(after(|sim, [_, id]| shift(sim, id, Vector::X * 0.055, Rot::IDENTITY)), Outcome::Recomputed);
    assert_eq!(after(|sim, [_, id]| shift(sim, id, Vector::ZERO, turned(0.09))), Outcome::Recomputed);
    assert_eq!(after(|sim, _| sim.recycle = false), Outcome::Recomputed);
    // Fast enough to need a larger prediction than the manifold was computed with.
    let fast = Velocity { linear: Vector::X * 3.0, angular: spin(0.0) };
    assert_eq!(after(|sim, [_, id]| sim.bodies.set_velocity(id, fast)), Outcome::Recomputed);
}

#[test]
fn what_makes_a_manifold_wrong_has_it_computed_anew() {
    let half = Vector::ONE * 0.4;
    let local = Pose { position: Vector::X * 0.01, rotation: Rot::IDENTITY };
    type Change = fn(&mut Sim, [u32; 2]);
    let changes: [(&str, Change); 9] = [
        ("another shape", |sim, [_, id]| sim.reshape(id, Shape::Ball(Ball { radius: 0.5 }))),
        ("another shape of the other", |sim, [floor, _]| {
            let half = Vector::ONE * 199.0;
            redefine(sim, floor, |def| def.shape = Shape::Cuboid(Cuboid { half }));
        }),
        ("collision margin", |sim, [_, id]| redefine(sim, id, |def| def.margin = 0.01)),
        ("speculative margin", |sim, [_, id]| redefine(sim, id, |def| def.speculative = 0.001)),
        ("teleport to the same place", |sim, [_, id]| {
            let frame = sim.bodies.frame(id);
            sim.bodies.teleport(id, frame);
        }),
        ("teleport of the support", |sim, [floor, _]| {
            let frame = sim.bodies.frame(floor);
            sim.bodies.teleport(floor, frame);
        }),
        ("centre of mass", |sim, [_, id]| {
            let frame = sim.bodies.frame(id);
            sim.bodies[id].local_center = Vector::X * 0.02;
            sim.bodies.teleport(id, frame);
        }),
        ("kind", |sim, [_, id]| sim.contact_manager().retype(id, BodyKind::Kinematic)),
        ("kind of the support", |sim, [floor, _]| sim.contact_manager().retype(floor, BodyKind::Kinematic)),
    ];
    for (what, change) in changes {
        assert_eq!(after(change), Outcome::Recomputed, "{what}");
    }
    let found = after(|sim, [_, id]| redefine(sim, id, |def| def.local = local));
    assert_eq!(found, Outcome::Recomputed, "place on the body");
    let found = after(|sim, [_, id]| sim.reshape(id, Shape::Cuboid(Cuboid { half })));
    assert_eq!(found, Outcome::Recomputed, "another size");
}

#[test]
fn a_pair_with_a_new_owner_of_an_id_begins_anew() {
    let (mut sim, [floor, id]) = at_rest();
    sim.contact_manager().destroy_of_collider(id);
    let again = sim.contact_manager().create(floor, id);
    assert_eq!(sim.contacts.get(again).manifold.count, 0, "nothing is left of the last owner");
    assert_eq!(sim.look(floor, id).0, Outcome::Recomputed);
}

#[test]
fn a_new_surface_takes_effect_on_a_recycled_contact() {
    let mut sim = Sim::new();
    let floor = sim.floor();
    let id = sim.cuboid(Vector::ONE * 0.5, Vector::Y * 0.5);
    sim.gravity = Vector::Y * -10.0 + Vector::X * 2.0;
    sim.steps(30);
    let v = sim.bodies.velocities[id as usize].linear.x;
    assert!(v.abs() < 1e-3, "friction holds it: {v}");
    for body in [floor, id] {
        let mut material = sim.colliders[body].def.material;
        material.friction.coefficient = 0.0;
        sim.contact_manager().set_material(body, material);
    }
    assert_eq!(sim.look(floor, id).0, Outcome::Recycled);
    sim.step();
    let v = sim.bodies.velocities[id as usize].linear.x;
    assert!((v - 2.0 / 60.0).abs() < 1e-3, "it slides: {v}");
}

/// The lowest point of a square rotated in the plane.
fn lowest(sim: &Sim, id: u32, half: f32) -> f32 {
    let frame: WorldPose = sim.bodies.frame(id);
    let corners = [(half, half), (half, -half), (-half, half), (-half, -half)];
    let heights = corners.map(|(x, y)| frame.rotation.rotate(sized(x, y, 0.0)).y);
    frame.position.to_local().y + heights.into_iter().fold(f32::MAX, f32::min)
}

#[test]
fn what_lands_sinks_no_deeper_for_recycling() {
    // From heights that differ by less than one step's motion, and at all angles: the deepest and the
    // mean penetration.
    let drops = |recycle: bool, tilted: bool| {
        let (mut deepest, mut sum) = (0.0f32, 0.0f32);
        for k in 0..100 {
            let mut sim = Sim::new();
            sim.recycle = recycle;
            sim.floor();
            let half = Vector::ONE * 0.5;
            let (height, turn) =
                if tilted { (0.725, 0.0079 * k as f32) } else { (0.53 + 0.0014 * k as f32, 0.0) };
            let cuboid = Shape::Cuboid(Cuboid { half });
            let id = sim.add(BodyKind::Dynamic, cuboid, Vector::Y * height, turned(turn));
            let mut deep = 0.0f32;
            for _ in 0..90 {
                sim.step();
                deep = deep.max(-lowest(&sim, id, 0.5));
            }
            deepest = deepest.max(deep);
            sum += deep;
        }
        (deepest, sum / 100.0)
    };
    for tilted in [false, true] {
        let (deepest, mean) = drops(true, tilted);
        let (deepest_fresh, mean_fresh) = drops(false, tilted);
        assert!(deepest < deepest_fresh + 1e-3, "{deepest} m for {deepest_fresh} m, tilted: {tilted}");
        assert!(mean < mean_fresh + 1e-3, "mean {mean} m for {mean_fresh} m, tilted: {tilted}");
    }
}

/// Compares the contact points of two bodies in every step with those of a recomputed manifold. Returns how
/// often a contact without points was recycled, and how often it was recomputed.
fn watch(mut sim: Sim, [a, b]: [u32; 2], steps: usize, what: &str) -> [usize; 2] {
    let mut counts = [0; 2];
    let mut was_left_alone = false;
    for _ in 0..steps {
        sim.step();
        if sim.contacts.find(a, b).is_none() {
            was_left_alone = false;
            continue;
        }
        let (found, known) = sim.look(a, b);
        sim.recycle = false;
        let (anew, fresh) = sim.look(a, b);
        sim.recycle = true;
        assert_ne!(anew, Outcome::Recycled, "{what}: not looked at anew");
        let nearest = fresh.manifold.points().iter().fold(f32::MAX, |least, p| least.min(p.separation));
        let is_near = anew == Outcome::Recomputed && nearest < -1e-3;
        assert!(!(was_left_alone && is_near), "{what}: met, {nearest} m deep, while left alone");
        was_left_alone = found == Outcome::Recycled && known.manifold.count == 0;
        if found != Outcome::Separated && known.manifold.count == 0 {
            counts[usize::from(found == Outcome::Recomputed)] += 1;
            assert!(nearest > 0.005, "{what}: nobody knew of a point {nearest} m away");
        }
    }
    counts
}

/// A stick approaches a box from a distance, slowly or fast, rotating or not. Either may have the lower id.
fn approach(k: u32) -> [usize; 2] {
    let fraction = |by: u32| (k * by % 101) as f32 / 101.0;
    let mut sim = Sim::new();
    sim.gravity = Vector::ZERO;
    let from = turned(6.3 * fraction(13)).rotate(Vector::X);
    let fixed = |sim: &mut Sim| {
        let cube = Shape::Cuboid(Cuboid { half: Vector::ONE * 0.5 });
        sim.add(BodyKind::Static, cube, Vector::ZERO, turned(fraction(7)))
    };
    let moving = |sim: &mut Sim| {
        let stick = Shape::Cuboid(Cuboid { half: sized(0.8, 0.05, 0.05) });
        let id = sim.add(BodyKind::Dynamic, stick, from * 1.8, turned(3.1 * fraction(29)));
        let linear =
            turned(0.8 * fraction(37) - 0.4).rotate(from) * -(0.05 + 8.0 * fraction(41) * fraction(43));
        sim.bodies.set_velocity(id, Velocity { linear, angular: spin(12.0 * fraction(53) - 6.0) });
        id
    };
    let ids = if k.is_multiple_of(2) {
        [fixed(&mut sim), moving(&mut sim)]
    } else {
        [moving(&mut sim), fixed(&mut sim)]
    };
    watch(sim, ids, 150, &format!("approach {k}"))
}

#[test]
fn what_is_apart_is_not_looked_at_and_yet_found_in_time() {
    let counts = (0..400).map(approach).fold([0; 2], |[a, b], [c, d]| [a + c, b + d]);
    assert!(2 * counts[0] > counts[1], "{counts:?} kept and computed while apart");
}

#[test]
fn what_turns_as_it_falls_far_from_the_middle_of_a_large_floor_is_found_in_time() {
    // Its motion is a rotation about the floor's centre of mass: relative to the body, the floor
    // only rotates.
    for below in [false, true] {
        for shape in [Shape::Cuboid(Cuboid { half: Vector::ONE * 0.5 }), Shape::Ball(Ball { radius: 0.5 })] {
            let mut sim = Sim::new();
            sim.gravity = Vector::ZERO;
            let slab = Shape::Cuboid(Cuboid { half: sized(100.0, 1.0, 100.0) });
            let add_slab =
                |sim: &mut Sim| sim.add(BodyKind::Static, slab.clone(), Vector::Y * -1.0, Rot::IDENTITY);
            let floor = below.then(|| add_slab(&mut sim));
            let id = sim.add(BodyKind::Dynamic, shape, Vector::X * 50.0 + Vector::Y * 0.65, Rot::IDENTITY);
            let floor = floor.unwrap_or_else(|| add_slab(&mut sim));
            let velocity = Velocity { linear: Vector::X * 0.1 + Vector::Y * -3.0, angular: spin(-0.06) };
            sim.bodies.set_velocity(id, velocity);
            watch(sim, [floor, id], 60, &format!("floor first: {below}"));
        }
    }
}

#[test]
fn what_rests_is_not_looked_at() {
    let (mut sim, [floor, id]) = at_rest();
    let contact = sim.contacts.find(floor, id).unwrap();
    let until = |sim: &Sim| sim.contacts.get(contact).calm_until;
    sim.steps(30);
    let before = until(&sim);
    sim.steps(30);
    assert_eq!(until(&sim), before, "each look sets it anew");
    sim.bodies.set_velocity(id, Velocity { linear: Vector::X * 0.2, ..Velocity::default() });
    sim.steps(3);
    assert_ne!(until(&sim), before, "what slides is looked at");
}

/// Separations that were followed through steps without a look differ from those of a look by the square
/// of small turns.
#[test]
fn separations_without_a_look_are_those_of_a_look() {
    let mut sim = Sim::new();
    sim.sleeping = false;
    sim.floor();
    for i in 0..10 {
        let (half, at) = (sized(0.5, 0.25, 0.5), sized(0.1 * (i % 3) as f32, 0.3 + 0.55 * i as f32, 0.0));
        sim.add(BodyKind::Dynamic, Shape::Cuboid(Cuboid { half }), at, turned(0.03 * (i % 4) as f32));
    }
    let (mut calm, mut all) = (0, 0);
    for _ in 0..300 {
        sim.step();
        let ids: Vec<u32> = sim.contacts.active().collect();
        for id in ids {
            let contact = sim.contacts.get(id);
            all += 1;
            if contact.manifold.count == 0 || !contact.flags.has(ContactFlags::CALM) {
                continue;
            }
            calm += 1;
            let [a, b] = contact.colliders;
            let known = contact.manifold;
            sim.recycle = false;
            let (_, fresh) = sim.look(a, b);
            sim.recycle = true;
            for p in fresh.manifold.points() {
                let Some(same) = known.points().iter().find(|q| q.feature == p.feature) else { continue };
                let wrong = (same.separation - p.separation).abs();
                assert!(wrong < 5.0e-4, "{wrong} m of contact {id}");
            }
        }
    }
    assert!(2 * calm > all, "{calm} of {all} calm");
}
