//! Materials of single facets, as apps write them.
#![allow(clippy::unnecessary_cast, reason = "Scalar may be f32 or f64")]

use avian::{
    math::{Scalar, Vector},
    prelude::*,
};
use bevy_app::prelude::*;
use bevy_ecs::prelude::*;
use bevy_time::Time;
use bevy_transform::{TransformPlugin, components::Transform};
use core::time::Duration;

use super::facets_dim::{ground, sides};

const G: Scalar = 10.0;
/// Half sizes of a box so flat that friction hardly shifts its weight, and so short that it hardly matters
/// which of its points carry the weight across a border.
const LENGTH: Scalar = 0.1;
const HEIGHT: Scalar = 0.02;

fn app() -> App {
    let mut app = App::new();
    app.add_plugins((TaskPoolPlugin::default(), TransformPlugin, PhysicsPlugins::new(Update)));
    app.insert_resource(Gravity(Vector::NEG_Y * G));
    app
}

fn steps(app: &mut App, count: u32) {
    for _ in 0..count {
        app.world_mut().resource_mut::<Time>().advance_by(Duration::from_secs_f64(1.0 / 64.0));
        app.update();
    }
}

/// Friction that is multiplied by that of the other side.
fn friction(coefficient: Scalar) -> Friction {
    Friction::new(coefficient).with_combine_rule(CoefficientCombine::Multiply)
}

/// Materials of the left and the right of the ground.
fn halves(left: FacetMaterial, right: FacetMaterial) -> FacetMaterials {
    FacetMaterials { materials: vec![left, right], facets: sides() }
}

fn ice_and_rubber() -> FacetMaterials {
    halves(friction(0.0).into(), friction(0.5).into())
}

fn slab() -> Collider {
    let mut corners = vec![Vector::ZERO];
    for (i, axis) in Vector::AXES.into_iter().enumerate() {
        let half = if i == 1 { HEIGHT } else { LENGTH };
        corners = corners.iter().flat_map(|c| [*c - axis * half, *c + axis * half]).collect();
    }
    Collider::convex_hull(corners).expect("a box is convex")
}

fn spawn_slab(app: &mut App, x: f32) -> Entity {
    let at = Transform::from_xyz(x, HEIGHT as f32, 0.0);
    app.world_mut().spawn((RigidBody::Dynamic, slab(), Friction::new(1.0), at)).id()
}

fn speed(app: &App, entity: Entity) -> Scalar {
    app.world().get::<LinearVelocity>(entity).expect("a body").x
}

fn push(app: &mut App, entity: Entity, speed: Scalar) {
    app.world_mut().get_mut::<LinearVelocity>(entity).expect("a body").x = speed;
}

#[test]
fn a_box_slides_over_ice_and_stops_on_rubber() {
    let mut app = app();
    app.world_mut().spawn((RigidBody::Static, ground(), ice_and_rubber()));
    let slab = spawn_slab(&mut app, -3.0);
    steps(&mut app, 10);
    push(&mut app, slab, 3.0);
    let x = |app: &App| app.world().get::<Position>(slab).expect("a body").0.x;
    while x(&app) < -LENGTH - 0.1 {
        steps(&mut app, 1);
        assert!((speed(&app, slab) - 3.0).abs() < 1.0e-3, "{} m/s on ice", speed(&app, slab));
    }
    steps(&mut app, 120);
    // The border counts where the middle passes it, give or take half the length.
    let (way, wanted) = (x(&app), 9.0 / (2.0 * 0.5 * G));
    assert!((way - wanted).abs() < LENGTH, "{way} m of {wanted}");
    assert!(speed(&app, slab).abs() < 1.0e-3);
}

#[test]
fn materials_may_come_change_and_go() {
    let mut app = app();
    let body = (RigidBody::Static, ground(), Friction::new(0.0).with_combine_rule(CoefficientCombine::Min));
    let floor = app.world_mut().spawn(body).id();
    let slab = spawn_slab(&mut app, 10.0);
    let is_slowed = |app: &mut App, expected: bool| {
        push(app, slab, 2.0);
        steps(app, 16);
        let wanted = if expected { 2.0 - 0.5 * G * 0.25 } else { 2.0 };
        assert!((speed(app, slab) - wanted).abs() < 0.1, "{} m/s of {wanted}", speed(app, slab));
    };
    steps(&mut app, 10);
    is_slowed(&mut app, false);
    app.world_mut().entity_mut(floor).insert(ice_and_rubber());
    is_slowed(&mut app, true);
    app.world_mut().get_mut::<FacetMaterials>(floor).expect("just inserted").materials[1] =
        friction(0.0).into();
    is_slowed(&mut app, false);
    *app.world_mut().get_mut::<FacetMaterials>(floor).expect("just inserted") = ice_and_rubber();
    is_slowed(&mut app, true);
    app.world_mut().entity_mut(floor).remove::<FacetMaterials>();
    is_slowed(&mut app, false);
}

#[test]
fn contacts_show_the_material_of_their_facets() {
    let mut app = app();
    let belt = FacetMaterial { tangent_velocity: Vector::X, ..friction(0.25).into() };
    let floor = app.world_mut().spawn((RigidBody::Static, ground(), halves(friction(0.0).into(), belt))).id();
    let slab = spawn_slab(&mut app, 0.0);
    app.insert_resource(Gravity(Vector::NEG_Y * 1.0e-3));
    steps(&mut app, 2);
    let mut shown: Vec<Scalar> = Vec::new();
    app.world_mut()
        .run_system_cached_with(
            |pair: In<[Entity; 2]>, collisions: Collisions| -> Vec<Scalar> {
                let pair = collisions.get(pair.0[0], pair.0[1]).expect("they touch");
                pair.manifolds.iter().map(|m| m.friction).collect()
            },
            [floor, slab],
        )
        .map(|frictions| shown = frictions)
        .expect("a system");
    shown.sort_by(Scalar::total_cmp);
    assert_eq!(shown, [0.0, 0.25]);
}

#[test]
fn hostile_materials_are_no_harm() {
    let nan = Scalar::NAN;
    let bad = FacetMaterial {
        friction: Friction::new(nan),
        restitution: Restitution::new(nan),
        tangent_velocity: Vector::splat(nan),
    };
    let huge = FacetMaterial {
        friction: Friction::new(Scalar::MAX),
        restitution: Restitution::new(Scalar::MAX),
        tangent_velocity: Vector::splat(Scalar::INFINITY),
    };
    let tables = [
        FacetMaterials::default(),
        FacetMaterials { materials: vec![bad, huge], facets: vec![] },
        FacetMaterials { materials: vec![], facets: vec![0; 1000] },
        FacetMaterials { materials: vec![bad; 300], facets: vec![255; 2] },
        halves(bad, huge),
        halves(huge, bad),
    ];
    for table in tables {
        let mut app = app();
        app.world_mut().spawn((RigidBody::Static, ground(), table.clone()));
        // No effect on a convex shape.
        let slabs = [spawn_slab(&mut app, -1.0), spawn_slab(&mut app, 5.0)];
        app.world_mut().entity_mut(slabs[0]).insert(table);
        push(&mut app, slabs[0], 4.0);
        steps(&mut app, 64);
        for slab in slabs {
            let at = app.world().get::<Position>(slab).expect("a body").0;
            assert!(at.is_finite() && at.y > 0.0 && at.y < 1.0, "{at}");
        }
    }
}
