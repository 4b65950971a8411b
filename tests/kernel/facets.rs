//! Materials of single facets: ice beside rubber, conveyor belts and bouncy tiles in one surface.

use super::dim::{sized, terrain};
use super::sim::Sim;
use crate::kernel;
use kernel::contact::Contact;
use kernel::math::{Rot, Vector};
use kernel::shape::{Ball, Cuboid, Shape};
use kernel::table::{BodyKind, Combine, FacetMaterial, FacetMaterials, Material, Surface};
use std::sync::Arc;

/// The gravity of the simulation, m/s².
const G: f32 = 10.0;
/// Half sizes of a box so flat that friction hardly shifts its weight, and so short that it hardly matters
/// which of its points carry the weight across a border.
const LENGTH: f32 = 0.1;
const HEIGHT: f32 = 0.02;

/// A material whose coefficients are multiplied by those of the other side.
fn material(friction: f32, restitution: f32, velocity: Vector) -> FacetMaterial {
    let surface = |coefficient| Surface { coefficient, rule: Combine::Multiply };
    FacetMaterial {
        material: Material { friction: surface(friction), restitution: surface(restitution) },
        velocity,
    }
}

/// The materials of a surface: facet by facet, by the x of its centre.
fn by_place(
    shape: &Shape,
    materials: Vec<FacetMaterial>,
    choose: impl Fn(f32) -> u8,
) -> Option<Arc<FacetMaterials>> {
    let Shape::Composite(composite) = shape else { panic!("a surface") };
    let surface = composite.surface().expect("a surface");
    let center = |facet: u32| {
        let corners = surface.corners(facet);
        corners.iter().map(|corner| corner.x).sum::<f32>() / corners.len() as f32
    };
    let facets: Vec<u8> = (0..composite.len() as u32).map(|facet| choose(center(facet))).collect();
    Some(Arc::new(FacetMaterials::new(materials, &facets)))
}

/// A flat surface with materials and a body of friction 1 and restitution 1 on it. The surface is added
/// first or last.
fn world(
    materials: Vec<FacetMaterial>,
    choose: impl Fn(f32) -> u8,
    body: Shape,
    at: Vector,
    surface_is_first: bool,
) -> (Sim, u32, u32) {
    let mut sim = Sim::new();
    sim.sleeping = true;
    let ground = terrain(0.5, |_, _| 0.0);
    let facets = by_place(&ground, materials, choose);
    let add_ground =
        |sim: &mut Sim| sim.add_with(BodyKind::Static, ground.clone(), Vector::ZERO, Rot::IDENTITY, 0.6, 0.0);
    let add_body = |sim: &mut Sim| sim.add_with(BodyKind::Dynamic, body.clone(), at, Rot::IDENTITY, 1.0, 1.0);
    let (ground, body) = if surface_is_first {
        let ground = add_ground(&mut sim);
        (ground, add_body(&mut sim))
    } else {
        let body = add_body(&mut sim);
        (add_ground(&mut sim), body)
    };
    sim.contact_manager().set_facets(ground, facets);
    (sim, ground, body)
}

fn slab() -> Shape {
    Shape::Cuboid(Cuboid { half: sized(LENGTH, HEIGHT, LENGTH) })
}

/// The contact of two colliders with all its manifolds' groups.
fn groups(sim: &Sim, ground: u32, body: u32) -> Vec<[u8; 2]> {
    let Some(id) = sim.contacts.find(ground, body) else { return Vec::new() };
    let contact: &Contact = sim.contacts.get(id);
    let all = core::iter::once(&contact.manifold).chain(sim.contacts.extra_of(contact));
    let mut groups: Vec<[u8; 2]> = all.filter(|m| m.count > 0).map(|m| m.groups).collect();
    groups.sort_unstable();
    groups
}

#[test]
fn a_box_slides_over_ice_and_stops_on_rubber() {
    let (mu, v0) = (0.5, 3.0f32);
    for surface_is_first in [true, false] {
        let materials = vec![material(0.0, 0.0, Vector::ZERO), material(mu, 0.0, Vector::ZERO)];
        let start = Vector::X * -2.0 + Vector::Y * HEIGHT;
        let (mut sim, ground, body) =
            world(materials, |x| u8::from(x > 1.0), slab(), start, surface_is_first);
        sim.steps(10);
        sim.bodies.velocities[body as usize].linear = Vector::X * v0;
        // On ice it keeps its speed, until its front is at the border.
        while sim.position(body).to_local().x < 1.0 - LENGTH - 0.1 {
            sim.step();
            let v = sim.bodies.velocities[body as usize].linear;
            assert!((v.x - v0).abs() < 1e-4 * v0, "{v:?} on ice");
        }
        let mut seen = Vec::new();
        while sim.bodies.velocities[body as usize].linear.x > 0.01 {
            sim.step();
            seen.push(groups(&sim, ground, body));
        }
        // Across the border there is one manifold for each material.
        let on_b = |group: u8| if surface_is_first { [group, 0] } else { [0, group] };
        assert!(seen.contains(&vec![on_b(1), on_b(2)]), "{seen:?}");
        assert_eq!(seen.last(), Some(&vec![on_b(2)]));
        // The border counts where the middle passes it, give or take half the length.
        let (way, wanted) = (sim.position(body).to_local().x - 1.0, v0 * v0 / (2.0 * mu * G));
        assert!((way - wanted).abs() < LENGTH, "{way} m of {wanted}");
    }
}

#[test]
fn a_belt_carries_what_lies_on_it_and_no_other_facet_does() {
    let (mu, u) = (0.4f32, 1.5);
    for surface_is_first in [true, false] {
        let materials = vec![material(mu, 0.0, Vector::X * u)];
        let start = Vector::X * -2.0 + Vector::Y * HEIGHT;
        // Facets beyond x = 4 have the friction of the collider.
        let (mut sim, _, body) =
            world(materials, |x| if x < 4.0 { 0 } else { 9 }, slab(), start, surface_is_first);
        let dt = 1.0 / 60.0;
        for i in 1..=60 {
            sim.step();
            let wanted = (mu * G * i as f32 * dt).min(u);
            let v = sim.bodies.velocities[body as usize].linear.x;
            // The first step or two settle.
            assert!((v - wanted).abs() < mu * G * 2.5 * dt, "step {i}: {v} m/s of {wanted}");
        }
        let v = sim.bodies.velocities[body as usize].linear.x;
        assert!((v - u).abs() < 1e-3, "{v}");
        sim.steps(400);
        let (x, v) = (sim.position(body).to_local().x, sim.bodies.velocities[body as usize].linear.x);
        // It stops where it leaves the belt: with a part of its length on either.
        assert!(
            v.abs() < 0.05 && x > 4.0 - LENGTH && x < 4.0 + LENGTH + u * u / (2.0 * 0.8 * G),
            "{x} m, {v} m/s"
        );
    }
}

#[test]
fn a_ball_bounces_by_the_facet_it_hits() {
    for (x, e) in [(-1.6f32, 0.0f32), (3.4, 0.8)] {
        let materials = vec![material(0.0, 0.0, Vector::ZERO), material(0.0, 0.8, Vector::ZERO)];
        let ball = Shape::Ball(Ball { radius: 0.25 });
        let start = Vector::X * x + Vector::Y * 1.25;
        let (mut sim, _, body) = world(materials, |x| u8::from(x > 1.0), ball, start, true);
        let (mut top, mut has_hit) = (0.0f32, false);
        for _ in 0..90 {
            sim.step();
            has_hit |=
                sim.bodies.velocities[body as usize].linear.y > -0.1 && sim.position(body).to_local().y < 0.5;
            if has_hit {
                top = top.max(sim.position(body).to_local().y - 0.25);
            }
        }
        assert!(has_hit && (top - e * e).abs() < 0.04, "{top} m of {}", e * e);
    }
}

#[test]
fn equal_materials_are_one_manifold_and_rest_as_without() {
    let rest = |materials: Option<u8>| {
        let table = vec![material(0.6, 0.0, Vector::ZERO); 2];
        let at = Vector::X * 0.97 + Vector::Y * HEIGHT;
        let (mut sim, ground, body) =
            world(table, |x| u8::from(x > 1.0) * materials.unwrap_or(0), slab(), at, true);
        if materials.is_none() {
            sim.contact_manager().set_facets(ground, None);
        }
        sim.steps(30);
        let found = groups(&sim, ground, body);
        sim.steps(270);
        (found, sim.position(body).to_local(), sim.bodies[body].awake)
    };
    let (none, one, two) = (rest(None), rest(Some(0)), rest(Some(1)));
    assert_eq!((none.0, one.0, two.0), (vec![[0, 0]], vec![[1, 0]], vec![[1, 0], [2, 0]]));
    assert_eq!(none.1, one.1, "groups do not change what is solved");
    assert!(!none.2 && !one.2 && !two.2, "all sleep");
    assert!((two.1 - none.1).length() < 1e-3);
}

#[test]
fn other_materials_count_from_the_next_step_also_while_asleep() {
    let materials = || vec![material(0.5, 0.0, Vector::ZERO)];
    let start = Vector::X * -2.0 + Vector::Y * HEIGHT;
    let (mut sim, ground, body) = world(materials(), |_| 0, slab(), start, true);
    sim.steps(120);
    assert!(!sim.bodies[body].awake, "it sleeps");
    let ice = by_place(&terrain(0.5, |_, _| 0.0), vec![material(0.0, 0.0, Vector::ZERO)], |_| 0);
    sim.contact_manager().set_facets(ground, ice);
    sim.contact_manager().wake_body(body);
    sim.bodies.velocities[body as usize].linear = Vector::X * 2.0;
    sim.steps(30);
    assert!((sim.bodies.velocities[body as usize].linear.x - 2.0).abs() < 1e-4, "it slides on ice");
    let rubber = by_place(&terrain(0.5, |_, _| 0.0), materials(), |_| 0);
    sim.contact_manager().set_facets(ground, rubber);
    sim.steps(12);
    let v = sim.bodies.velocities[body as usize].linear.x;
    assert!((v - (2.0 - 0.5 * G * 0.2)).abs() < 0.1, "{v} m/s on rubber");
    // A table that is shorter than the surface, or empty, leaves the material of the collider.
    sim.contact_manager().set_facets(ground, Some(Arc::new(FacetMaterials::new(vec![], &[0, 1]))));
    sim.steps(60);
    assert!(sim.bodies.velocities[body as usize].linear.x.abs() < 1e-3);
}
