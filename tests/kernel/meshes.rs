//! Bodies that are closed meshes or polylines, on floors of pieces and at walls.

use super::dim::floors::{bent, blocks, wall_and_floor};
use super::dim::{any_rotation, sized, tiles};
use super::extreme::Dice;
use super::sim::Sim;
use crate::kernel;
use kernel::math::{DIM, Rot, Vector};
use kernel::shape::{Cuboid, Shape, Surface};
use kernel::table::BodyKind;

/// Solids, convex or not, with their convex hulls and their meshes.
fn all() -> Vec<(&'static str, Shape, Shape)> {
    blocks().into_iter().chain(bent()).collect()
}

/// The same surface as exporters leave it: each facet has corners of its own, and one facet is without area.
fn messy(mesh: &Shape) -> Shape {
    let Shape::Composite(composite) = mesh else { panic!("a mesh") };
    let surface = composite.surface().expect("a surface");
    let count = composite.len() as u32;
    let corners: Vec<Vector> = (0..count).flat_map(|f| surface.corners(f)).collect();
    let mut facets: Vec<[u32; DIM]> =
        (0..count).map(|f| core::array::from_fn(|k| f * DIM as u32 + k as u32)).collect();
    facets.push([0; DIM]);
    Shape::surface(Surface::new(corners, facets).expect("a surface"))
}

/// The lowest point of a shape with a rotation, over its origin.
fn lowest(hull: &Shape, rotation: Rot) -> f32 {
    let down = rotation.inverse_rotate(-Vector::Y);
    rotation.rotate(hull.support(down).expect("bounded")).y
}

/// How much faster a mesh is after 6 m over pieces of ground without friction, and how far it
/// went up or down.
fn slide(pieces: &[(Shape, Vector)], (hull, mesh): (&Shape, &Shape), speed: f32) -> [f32; 2] {
    let mut sim = Sim::new();
    sim.checked = false;
    for (shape, place) in pieces {
        sim.add_with(BodyKind::Static, shape.clone(), *place, Rot::IDENTITY, 0.0, 0.0);
    }
    let start = Vector::Y * -lowest(hull, Rot::IDENTITY);
    let id = sim.add_with(BodyKind::Dynamic, mesh.clone(), start, Rot::IDENTITY, 0.0, 0.0);
    sim.weigh(id, hull);
    sim.steps(30);
    let from = sim.position(id).to_local();
    sim.bodies.velocities[id as usize].linear = Vector::X * speed;
    let mut bump = 0.0f32;
    for _ in 0..(6.0 / speed / sim.dt) as usize {
        sim.step();
        bump = bump.max((sim.position(id).to_local() - from).y.abs());
    }
    [sim.bodies.velocities[id as usize].linear.x / speed - 1.0, bump]
}

/// A mesh or polyline that is closed slides as the solid does. Planks sank into meshes by their thickness,
/// and cubes stopped on compounds.
#[test]
fn meshes_slide_over_floors_of_pieces() {
    for (floor, pieces) in tiles() {
        for (name, hull, mesh) in all() {
            // A polyline with an inner corner meets ghosts on the ends of boxes and segments.
            if name.contains("corners") || name == "wedge" || DIM == 2 && name == "ell" {
                continue;
            }
            for speed in [1.0, 5.0] {
                for mesh in [&mesh, &messy(&mesh)] {
                    // Facets of a bent mesh hold it one by one.
                    let most = if name == "ell" { 4e-3 } else { 1.5e-3 };
                    let [gained, bump] = slide(&pieces, (&hull, mesh), speed);
                    assert!(
                        gained.abs() < 2e-3 && bump < most,
                        "{name} over {floor} at {speed} m/s: {gained} faster, {bump} m up or down"
                    );
                }
            }
        }
    }
}

/// Of several tiles under a face that slaps down, only the one that it touched first held it: hulls came 5 cm
/// deep, and meshes stayed 8 cm deep in meshes.
#[test]
fn what_tips_over_on_pieces_lies_on_them() {
    let mut dice = Dice::new(11);
    for (floor, pieces) in tiles() {
        for (name, hull, mesh) in all() {
            // A bent mesh comes 4 cm deep into a half-space, and a bent polyline falls through segments.
            if ["half-space", "segments"].contains(&floor) && name == "ell" {
                continue;
            }
            for (rate, height) in [(60.0f32, 0.1), (60.0, 1.0), (30.0, 0.1), (30.0, 1.0)] {
                for shape in [&hull, &mesh] {
                    let mut sim = Sim::new();
                    (sim.checked, sim.sleeping, sim.dt) = (false, true, 1.0 / rate);
                    for (shape, place) in &pieces {
                        sim.add(BodyKind::Static, shape.clone(), *place, Rot::IDENTITY);
                    }
                    let rotation = any_rotation(&mut dice);
                    let start =
                        sized(3.0 + dice.unit(), height - lowest(&hull, rotation), 0.5 * dice.signed());
                    let id = sim.add(BodyKind::Dynamic, shape.clone(), start, rotation);
                    sim.weigh(id, &hull);
                    let (mut low, mut deep) = (0.0, 0.0f32);
                    for _ in 0..(8.0 * rate) as usize {
                        sim.step();
                        let frame = sim.bodies.frame(id);
                        low = frame.position.to_local().y + lowest(&hull, frame.rotation);
                        deep = deep.min(low);
                    }
                    let what = format!("{name} on {floor} from {height} m at {rate} Hz");
                    let most = if rate == 60.0 { 0.05 } else { 0.12 };
                    assert!(deep > -most, "{what}: {deep} m deep");
                    assert!(low > -0.003 && !sim.bodies[id].awake, "{what}: lies at {low} m");
                }
            }
        }
    }
}

#[test]
fn meshes_that_are_driven_at_walls_stop_there() {
    for size in [2.0, 0.5] {
        let wall = wall_and_floor(size, 0.0);
        for (name, hull, mesh) in all() {
            for (rate, speed) in [(60.0f32, 3.0), (60.0, 10.0), (30.0, 3.0), (30.0, 10.0)] {
                let mut sim = Sim::new();
                (sim.checked, sim.dt) = (false, 1.0 / rate);
                sim.add_with(BodyKind::Static, wall.clone(), Vector::ZERO, Rot::IDENTITY, 0.2, 0.0);
                let start = sized(-1.2, -lowest(&hull, Rot::IDENTITY), 0.03);
                let id = sim.add_with(BodyKind::Dynamic, mesh.clone(), start, Rot::IDENTITY, 0.2, 0.0);
                sim.weigh(id, &hull);
                sim.bodies.velocities[id as usize].linear = Vector::X * speed;
                sim.gravity = sized(20.0, -10.0, 0.0);
                let (mut ahead, mut low) = (0.0f32, 0.0f32);
                for _ in 0..(3.0 * rate) as usize {
                    sim.step();
                    let frame = sim.bodies.frame(id);
                    let far = hull.support(frame.rotation.inverse_rotate(Vector::X)).expect("bounded");
                    ahead = ahead.max(frame.position.to_local().x + frame.rotation.rotate(far).x);
                    low = low.min(frame.position.to_local().y + lowest(&hull, frame.rotation));
                }
                let most = if rate == 60.0 { 0.08 } else { 0.15 };
                assert!(
                    ahead < most && low > -most,
                    "{name} at {speed} m/s, {rate} Hz, squares of {size} m: {ahead} m ahead, {low} m low"
                );
            }
        }
    }
}

/// Closed convex meshes are rooms to what is in them, whatever size it has.
#[test]
fn what_starts_in_a_closed_mesh_stays_in_it() {
    for (name, _, mesh) in blocks() {
        for (kind, gravity) in
            [(BodyKind::Static, 10.0), (BodyKind::Kinematic, 10.0), (BodyKind::Dynamic, 0.0)]
        {
            for radius in [0.03f32, 0.08] {
                let mut sim = Sim::new();
                sim.gravity = Vector::Y * -gravity;
                let room = sim.add(kind, mesh.clone(), Vector::ZERO, Rot::IDENTITY);
                sim.weigh(room, &Shape::Cuboid(Cuboid { half: Vector::ONE * 0.5 }));
                let id = sim.ball(radius, Vector::ZERO);
                sim.bodies.velocities[id as usize].linear = Vector::X * 2.0;
                for step in 0..300 {
                    sim.step();
                    let at = (sim.position(id) - sim.position(room)).to_local();
                    assert!(
                        at.length() < 1.0,
                        "{name}, {kind:?}: a ball of {radius} m is at {at:?} in step {step}"
                    );
                }
            }
        }
    }
}
