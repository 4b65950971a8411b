//! Composite shapes: surfaces and compounds, against the same parts one by one, and as ground for piles.

use super::dim::{any_rotation, riders, sized, terrain};
use super::extreme::Dice;
use super::sim::{Outcome, Sim};
use crate::kernel;
use kernel::manifold::{
    CompositeBuffers, FeatureCache, LocalManifold, ManifoldQuery, collide, collide_composite,
};
use kernel::math::{Pose, Rot, Vector};
use kernel::shape::{Ball, Cuboid, Part, Shape};
use kernel::table::BodyKind;

fn block(half: Vector) -> Shape {
    Shape::Cuboid(Cuboid { half })
}

/// Heights between 0 and 1 that go up and down every 4 m.
fn waves(x: f32, z: f32) -> f32 {
    let wave = |t: f32| (t / 4.0 - (t / 4.0).floor() - 0.5).abs();
    wave(x) + wave(z + 1.0)
}

/// A basin of waves: they rise towards the borders of the surface.
fn basin(x: f32, z: f32) -> f32 {
    waves(x, z) + 2.0 * ((z + 0.13).abs() - 1.3).max(0.0) + 2.0 * (-1.0 - x).max(x - 12.0).max(0.0)
}

/// A number from an interval.
fn between(dice: &mut Dice, low: f32, high: f32) -> f32 {
    low + (high - low) * dice.unit()
}

/// Three blocks that overlap at right angles: no convex shape.
fn corner() -> Shape {
    let parts = [sized(0.6, 0.15, 0.15), sized(0.15, 0.6, 0.15), sized(0.15, 0.15, 0.6)];
    let parts = parts.into_iter().map(|half| (Pose::IDENTITY, block(half))).collect();
    Shape::compound(parts).expect("blocks are solid")
}

fn manifolds(a: &Shape, b: &Shape, pose: &Pose, prediction: f32) -> (Vec<LocalManifold>, f32) {
    let mut all = Vec::new();
    let query = ManifoldQuery::up_to(prediction);
    let gap = collide_composite(a, b, pose, query, &mut CompositeBuffers::default(), &mut all);
    (all, gap)
}

/// The least separation from any part alone, no farther than the prediction; infinite if there is none.
fn nearest_part(composite: &Shape, other: &Shape, pose: &Pose, prediction: f32) -> f32 {
    let Shape::Composite(composite) = composite else { panic!("a composite shape") };
    let mut least = f32::INFINITY;
    for part in 0..composite.len() as u32 {
        let (shape, pose) = match composite.part(part) {
            Part::Facet(facet) => (Shape::from(facet), *pose),
            Part::Solid(at, solid) => (solid.clone(), at.inverse().then(pose)),
        };
        let mut local = LocalManifold::default();
        collide(&shape, other, &pose, prediction, &mut FeatureCache::default(), &mut local);
        least = local.points().iter().fold(least, |least, p| least.min(p.separation));
    }
    least
}

#[test]
fn a_surface_is_as_near_as_its_nearest_facet() {
    let mut dice = Dice::new(7);
    let ground = terrain(1.0, waves);
    let (mut near, mut apart) = (0, 0);
    for round in 0..20_000 {
        let shapes = riders();
        let (name, rider) = &shapes[round % shapes.len()];
        let at = sized(
            between(&mut dice, -1.0, 12.0),
            between(&mut dice, 0.3, 2.2),
            between(&mut dice, -1.0, 1.0),
        );
        let pose = Pose::new(at, any_rotation(&mut dice));
        let (found, gap) = manifolds(&ground, rider, &pose, 0.1);
        let least = nearest_part(&ground, rider, &pose, 0.1);
        let own =
            found.iter().flat_map(LocalManifold::points).fold(f32::INFINITY, |l, p| l.min(p.separation));
        for m in &found {
            assert!((m.normal.length() - 1.0).abs() < 1.0e-4, "{name}: {:?}", m.normal);
            assert!(m.points().iter().all(|p| p.separation <= 0.1), "{name} beyond the prediction");
        }
        if least == f32::INFINITY {
            apart += 1;
            assert!(found.is_empty() && gap >= 0.0, "{name} at {pose:?} is apart: {found:?}");
        } else if least > 1.0e-3 {
            // Apart, the nearest points are those of convex parts, whatever their borders.
            near += 1;
            assert!((own - least).abs() < 2.0e-3, "{name} at {pose:?}: {own}, by facet {least}");
        } else {
            assert!(!found.is_empty(), "{name} at {pose:?} overlaps by {least} without a contact");
        }
    }
    assert!(near > 300 && apart > 300, "{near} near, {apart} apart");
}

#[test]
fn the_order_of_two_shapes_does_not_matter() {
    let mut dice = Dice::new(11);
    let ground = terrain(1.0, waves);
    let deepest = |all: &[LocalManifold]| {
        all.iter().flat_map(LocalManifold::points).fold(f32::INFINITY, |least, p| least.min(p.separation))
    };
    for round in 0..3000 {
        let shapes = riders();
        let other = if round % 4 == 0 { corner() } else { shapes[round % shapes.len()].1.clone() };
        let at = sized(
            between(&mut dice, -1.0, 12.0),
            between(&mut dice, 0.0, 1.5),
            between(&mut dice, -1.0, 1.0),
        );
        let pose = Pose::new(at, any_rotation(&mut dice));
        let [(first, _), (second, _)] =
            [manifolds(&ground, &other, &pose, 0.1), manifolds(&other, &ground, &pose.inverse(), 0.1)];
        // Two composites are taken apart in another order, and may have other borders.
        if round % 4 == 0 {
            assert_eq!(first.is_empty(), second.is_empty());
            continue;
        }
        let depths = [deepest(&first), deepest(&second)];
        assert!(depths[0] == depths[1] || (depths[0] - depths[1]).abs() < 1.0e-4, "{depths:?}");
        for m in &second {
            let back = m.flipped(&pose.inverse());
            let is_same = |o: &LocalManifold| o.normal.dot(back.normal) > 0.99;
            assert!(first.iter().any(is_same), "{:?} is in both", back.normal);
        }
    }
}

/// Drops bodies on ground, and returns the simulation after some seconds.
fn dropped(ground: &Shape, bodies: &[Shape], seconds: usize) -> (Sim, Vec<u32>) {
    let mut sim = Sim::new();
    (sim.sleeping, sim.checked) = (true, false);
    sim.add_with(BodyKind::Static, ground.clone(), Vector::ZERO, Rot::IDENTITY, 0.6, 0.0);
    let mut dice = Dice::new(3);
    let ids = bodies.iter().enumerate().map(|(i, shape)| {
        let at = sized(0.5 + 1.2 * (i % 8) as f32, 1.6 + 0.9 * (i / 8) as f32, 0.1 * (i % 3) as f32);
        sim.add_with(BodyKind::Dynamic, shape.clone(), at, any_rotation(&mut dice), 0.6, 0.0)
    });
    let ids = ids.collect();
    sim.steps(60 * seconds);
    (sim, ids)
}

#[test]
fn what_falls_on_waves_stays_on_them_and_sleeps() {
    let (names, mut shapes): (Vec<_>, Vec<_>) = riders().into_iter().unzip();
    shapes.push(corner());
    let bodies: Vec<Shape> = (0..24).map(|i| shapes[i % shapes.len()].clone()).collect();
    for size in [2.0, 0.5, 0.17] {
        let (sim, ids) = dropped(&terrain(size, basin), &bodies, 15);
        for id in &ids {
            let at = sim.position(*id);
            assert!(at.y > 0.1 && at.y < 4.0, "body {id} of size {size} at {at:?}");
        }
        // What is round may still roll to and fro.
        let rolls = |id: &u32| {
            let name = names.get((*id as usize - 1) % shapes.len());
            name.is_some_and(|name| !["box", "hull"].contains(name))
        };
        let awake: Vec<u32> = sim.bodies.awake_dynamic().filter(|id| !rolls(id)).collect();
        assert!(awake.is_empty(), "on facets of {size} m are awake: {awake:?}");
    }
}

#[test]
fn a_ceiling_holds_from_below() {
    let mut sim = Sim::new();
    sim.gravity = Vector::Y * 10.0;
    sim.add(BodyKind::Static, terrain(1.0, |_, _| 0.0), Vector::ZERO, Rot::IDENTITY);
    for (i, (_, rider)) in riders().into_iter().enumerate() {
        sim.add(BodyKind::Dynamic, rider, sized(2.0 * i as f32, -0.5, 0.0), Rot::IDENTITY);
    }
    sim.steps(120);
    for id in 1..=riders().len() as u32 {
        let at = sim.position(id);
        assert!(at.y < -0.15 && at.y > -0.5, "body {id} is at {at:?}");
    }
}

#[test]
fn a_body_at_rest_on_a_surface_is_recycled() {
    let mut sim = Sim::new();
    let ground = sim.add(BodyKind::Static, terrain(0.5, waves), Vector::ZERO, Rot::IDENTITY);
    // A valley holds it from both sides.
    let cube = sim.add(BodyKind::Dynamic, block(Vector::ONE * 0.3), sized(2.0, 0.7, 1.0), Rot::IDENTITY);
    sim.steps(240);
    let before = sim.position(cube);
    assert_eq!(sim.look(ground, cube).0, Outcome::Recycled);
    sim.steps(240);
    assert!((sim.position(cube) - before).length() < 1.0e-3);
    let contact = sim.contacts.get(sim.contacts.find(ground, cube).expect("it lies there"));
    assert!(contact.extra_count > 0, "it touches several slopes");
}

#[test]
fn a_ball_that_slides_over_waves_keeps_its_energy() {
    let mut sim = Sim::new();
    (sim.checked, sim.dt) = (false, 1.0 / 240.0);
    sim.add_with(BodyKind::Static, terrain(0.5, waves), Vector::ZERO, Rot::IDENTITY, 0.0, 0.0);
    let ball = Shape::Ball(Ball { radius: 0.25 });
    let id = sim.add_with(BodyKind::Dynamic, ball, sized(1.0, 1.4, 1.0), Rot::IDENTITY, 0.0, 0.0);
    let start = sim.energy();
    for _ in 0..2000 {
        sim.step();
        assert!(sim.energy() < 1.001 * start, "{} of {start}", sim.energy());
    }
    assert!(sim.position(id).y > 0.2, "it is on the surface: {:?}", sim.position(id));
}

#[test]
fn nothing_fast_passes_through_a_surface() {
    let mut dice = Dice::new(5);
    let ball = Shape::Ball(Ball { radius: 0.05 });
    let grounds = [("flat", terrain(1.0, |_, _| 0.0)), ("waves", terrain(0.5, waves))];
    for speed in [20.0, 100.0, 500.0, 2000.0] {
        for round in 0..80 {
            let (floor, ground) = &grounds[round % 2];
            let mut sim = Sim::new();
            (sim.checked, sim.gravity) = (false, Vector::ZERO);
            sim.add_with(BodyKind::Static, ground.clone(), Vector::ZERO, Rot::IDENTITY, 0.0, 0.0);
            let at = sized(between(&mut dice, 3.0, 8.0), 1.6, between(&mut dice, -0.5, 0.5));
            let id = sim.add_with(BodyKind::Dynamic, ball.clone(), at, Rot::IDENTITY, 0.0, 0.0);
            let aim = sized(between(&mut dice, -1.0, 1.0), -1.0, between(&mut dice, -0.5, 0.5));
            let velocity = aim * (speed / aim.length());
            sim.bodies.set_velocity(id, kernel::table::Velocity { linear: velocity, ..Default::default() });
            for _ in 0..20 {
                sim.step();
                let at = sim.position(id).to_local();
                let is_over = at.x > -2.5 && at.x < 13.5 && super::dim::across(at).abs() < 1.5;
                assert!(!is_over || at.y > -0.05, "{floor} at {speed} m/s, round {round}: it came to {at:?}");
            }
        }
    }
}

#[test]
fn what_flies_over_a_surface_is_not_deflected() {
    let ball = Shape::Ball(Ball { radius: 0.1 });
    for speed in [20.0, 100.0, 300.0] {
        let mut sim = Sim::new();
        (sim.checked, sim.gravity) = (false, Vector::ZERO);
        sim.add_with(BodyKind::Static, terrain(0.5, waves), Vector::ZERO, Rot::IDENTITY, 0.0, 0.0);
        // The ridges at z = 1 are half a metre high.
        let id =
            sim.add_with(BodyKind::Dynamic, ball.clone(), sized(-4.0, 1.15, -1.0), Rot::IDENTITY, 0.0, 0.0);
        sim.bodies
            .set_velocity(id, kernel::table::Velocity { linear: Vector::X * speed, ..Default::default() });
        while sim.position(id).x < 16.0 {
            sim.step();
            let velocity = sim.bodies.velocities[id as usize].linear;
            assert!((velocity - Vector::X * speed).length() < 1.0e-3 * speed, "at {speed} m/s: {velocity:?}");
        }
    }
}
