//! Sums of parts against closed forms, and the changes that recompute a body's mass.
//!
//! Only the inertia about z is checked, because both dimensions have it.

#[cfg_attr(feature = "2d", path = "dim2.rs")]
#[cfg_attr(feature = "3d", path = "dim3.rs")]
mod dim;

use bevy_app::prelude::*;
use bevy_ecs::{prelude::*, system::RunSystemOnce};
use bevy_transform::prelude::Transform;

use self::dim::{about_z, inertia};
use super::{
    MassPropertyHelper, MassPropertyPlugin,
    components::*,
    inertia::{Part, PartFrame, Vector64},
};
use crate::{
    collision::collider::{
        ColliderDisabled, Sensor, collider_hierarchy::ColliderOf, collider_transform::ColliderTransform,
    },
    dynamics::rigid_body::RigidBody,
    math::{Scalar, Vector, VectorF32},
};

/// A shape with a mass of 1 kg per unit of density, and an inertia of 0.5 m about every axis.
struct Lump {
    center: VectorF32,
}

/// Inertia per mass, in kg·m² per kg.
const UNIT_INERTIA: f32 = 0.5;

/// A collider of `mass` kg whose centroid is its origin.
fn lump(mass: f32) -> ColliderMassProperties {
    ColliderMassProperties::from_shape(&Lump { center: VectorF32::ZERO }, mass)
}

fn at_x(x: Scalar) -> ColliderTransform {
    ColliderTransform { translation: Vector::X * x, ..ColliderTransform::default() }
}

struct Scale {
    app: App,
}

impl Scale {
    fn new() -> Self {
        let mut app = App::new();
        app.add_plugins(MassPropertyPlugin::new(Update));
        Self { app }
    }

    fn world(&mut self) -> &mut World {
        self.app.world_mut()
    }

    /// A dynamic body with a collider of its own.
    fn body(&mut self, components: impl Bundle) -> Entity {
        let body = self.world().spawn((RigidBody::Dynamic, components)).id();
        if self.world().entity(body).contains::<ColliderMassProperties>() {
            self.world().entity_mut(body).insert(ColliderOf { body });
        }
        body
    }

    /// A collider on a child entity.
    fn collider(&mut self, body: Entity, components: impl Bundle) -> Entity {
        self.world().spawn((ChildOf(body), ColliderOf { body }, components)).id()
    }

    /// Mass, inertia about z, and x of the centre.
    fn weigh(&mut self, body: Entity) -> (Scalar, Scalar, Scalar) {
        self.app.update();
        let body = self.app.world().entity(body);
        assert!(!body.contains::<RecomputeMassProperties>(), "the mark is taken off");
        (
            body.get::<ComputedMass>().expect("required").value(),
            about_z(body.get::<ComputedAngularInertia>().expect("required")),
            body.get::<ComputedCenterOfMass>().expect("required").x,
        )
    }

    #[track_caller]
    fn expect(&mut self, body: Entity, expected: (Scalar, Scalar, Scalar)) {
        let found = self.weigh(body);
        let close = |a: Scalar, b: Scalar| (a - b).abs() <= 1e-5 * b.abs().max(1.0);
        assert!(
            close(found.0, expected.0) && close(found.1, expected.1) && close(found.2, expected.2),
            "mass, inertia, centre are {found:?}, should be {expected:?}"
        );
    }
}

#[test]
fn own_components_are_the_total_of_a_lone_body() {
    let mut scale = Scale::new();
    let center = CenterOfMass(VectorF32::X * 0.25);
    let body = scale.body((Mass(4.0), inertia(3.0), center));
    scale.expect(body, (4.0, 3.0, 0.25));
    let body = scale.body(());
    scale.expect(body, (0.0, 0.0, 0.0));
}

#[test]
fn a_collider_gives_its_body_mass() {
    let mut scale = Scale::new();
    let body = scale.body(lump(2.0));
    scale.expect(body, (2.0, 1.0, 0.0));
}

#[test]
fn own_components_replace_the_collider_on_the_same_entity() {
    let mut scale = Scale::new();
    // A mass alone scales the inertia.
    let body = scale.body((lump(2.0), Mass(6.0)));
    scale.expect(body, (6.0, 3.0, 0.0));
    let body = scale.body((lump(2.0), inertia(7.0)));
    scale.expect(body, (2.0, 7.0, 0.0));
    let body = scale.body((lump(2.0), CenterOfMass(VectorF32::X)));
    scale.expect(body, (2.0, 1.0, 1.0));
    // After removal the collider counts again.
    scale.world().entity_mut(body).remove::<CenterOfMass>();
    scale.expect(body, (2.0, 1.0, 0.0));
}

#[test]
fn colliders_add_up_by_the_parallel_axis_theorem() {
    let mut scale = Scale::new();
    let body = scale.body(());
    scale.collider(body, (lump(1.0), at_x(-2.0)));
    scale.collider(body, (lump(3.0), at_x(2.0)));
    // Centre (−2 · 1 + 2 · 3) / 4 = 1; inertia 0.5 + 1.5 + 1 · 3² + 3 · 1².
    scale.expect(body, (4.0, 14.0, 1.0));
}

#[test]
fn own_collider_and_children_add_up() {
    let mut scale = Scale::new();
    let body = scale.body((lump(2.0), Mass(4.0)));
    let child = scale.collider(body, (lump(2.0), Mass(4.0), at_x(1.0)));
    // Inertia 2 + 2 + 4 · 0.5² + 4 · 0.5².
    scale.expect(body, (8.0, 6.0, 0.5));
    // The child's mass is mutated.
    scale.world().get_mut::<Mass>(child).expect("spawned with it").0 = 12.0;
    // Centre 12 / 16; inertia 2 + 6 + 4 · 0.75² + 12 · 0.25².
    scale.expect(body, (16.0, 11.0, 0.75));
    scale.world().entity_mut(child).despawn();
    scale.expect(body, (4.0, 2.0, 0.0));
}

#[test]
fn a_moved_collider_moves_the_centre() {
    let mut scale = Scale::new();
    let body = scale.body(());
    let child = scale.collider(body, (lump(2.0), at_x(1.0)));
    scale.expect(body, (2.0, 1.0, 1.0));
    scale.world().get_mut::<ColliderTransform>(child).expect("spawned with it").translation = Vector::X * 3.0;
    scale.expect(body, (2.0, 1.0, 3.0));
}

#[test]
fn a_collider_that_changes_bodies_is_counted_where_it_is() {
    let mut scale = Scale::new();
    let (first, second) = (scale.body(Mass(1.0)), scale.body(Mass(1.0)));
    let child = scale.collider(first, (lump(2.0), at_x(0.0)));
    scale.expect(first, (3.0, 1.0, 0.0));
    scale.world().entity_mut(child).insert((ChildOf(second), ColliderOf { body: second }));
    scale.expect(first, (1.0, 0.0, 0.0));
    scale.expect(second, (3.0, 1.0, 0.0));
}

#[test]
fn descendants_without_collider_count_where_their_transform_puts_them() {
    let mut scale = Scale::new();
    let body = scale.body((Transform::from_scale(bevy_math::Vec3::splat(2.0)), Mass(1.0)));
    let middle = scale.world().spawn((ChildOf(body), Transform::from_xyz(1.0, 0.0, 0.0))).id();
    let turn = bevy_math::Quat::from_rotation_z(core::f32::consts::PI);
    let leaf = Transform::from_xyz(1.0, 0.0, 0.0).with_rotation(turn);
    let center = CenterOfMass(VectorF32::X * 0.5);
    let leaf = scale.world().spawn((ChildOf(middle), leaf, Mass(3.0), inertia(1.0), center)).id();
    // The leaf's origin is at 2 · (1 + 1) = 4, its centre half a metre back: 3.5. Together 3.5 · 3 / 4.
    scale.expect(body, (4.0, 1.0 + 3.5 * 3.5 * 0.75, 2.625));
    scale.world().get_mut::<Transform>(leaf).expect("spawned with it").translation.x = -1.0;
    scale.expect(body, (4.0, 1.0 + 0.5 * 0.5 * 0.75, -0.375));
    // Removing it from the body removes its mass.
    scale.world().entity_mut(leaf).remove::<ChildOf>();
    scale.expect(body, (1.0, 0.0, 0.0));
}

#[test]
fn a_body_below_a_body_weighs_by_itself() {
    let mut scale = Scale::new();
    let body = scale.body(Mass(1.0));
    let inner =
        scale.world().spawn((ChildOf(body), RigidBody::Dynamic, Mass(2.0), Transform::default())).id();
    scale.world().spawn((ChildOf(inner), Mass(4.0), Transform::default()));
    scale.expect(body, (1.0, 0.0, 0.0));
    scale.expect(inner, (6.0, 0.0, 0.0));
}

#[test]
fn no_auto_restricts_a_total_to_the_own_component() {
    let mut scale = Scale::new();
    let body = scale.body((Mass(4.0), inertia(2.0), CenterOfMass::ZERO));
    scale.collider(body, (lump(4.0), at_x(1.0)));
    let all = (8.0, 6.0, 0.5);
    scale.expect(body, all);
    scale.world().entity_mut(body).insert(NoAutoMass);
    scale.expect(body, (4.0, 6.0, 0.5));
    scale.world().entity_mut(body).insert(NoAutoAngularInertia);
    scale.expect(body, (4.0, 2.0, 0.5));
    scale.world().entity_mut(body).insert(NoAutoCenterOfMass);
    scale.expect(body, (4.0, 2.0, 0.0));
    scale.world().entity_mut(body).remove::<(NoAutoMass, NoAutoAngularInertia, NoAutoCenterOfMass)>();
    scale.expect(body, all);
}

#[test]
fn without_a_component_no_auto_keeps_what_the_user_computed() {
    let mut scale = Scale::new();
    let body = scale.body((lump(2.0), NoAutoMass, ComputedMass::new(9.0)));
    scale.expect(body, (9.0, 1.0, 0.0));
}

#[test]
fn sensors_and_disabled_colliders_weigh_nothing() {
    let mut scale = Scale::new();
    let body = scale.body(lump(2.0));
    let child = scale.collider(body, (lump(2.0), at_x(1.0)));
    let (both, own) = ((4.0, 3.0, 0.5), (2.0, 1.0, 0.0));
    scale.expect(body, both);
    scale.world().entity_mut(child).insert(Sensor);
    scale.expect(body, own);
    scale.world().entity_mut(child).remove::<Sensor>();
    scale.expect(body, both);
    scale.world().entity_mut(child).insert(ColliderDisabled);
    scale.expect(body, own);
    scale.world().entity_mut(child).remove::<ColliderDisabled>();
    scale.expect(body, both);
    scale.world().entity_mut(body).insert(Sensor);
    scale.expect(body, (2.0, 1.0, 1.0));
}

#[test]
fn static_bodies_have_infinite_mass_until_they_are_dynamic() {
    let mut scale = Scale::new();
    let body = scale.world().spawn((RigidBody::Static, Mass(2.0), inertia(3.0))).id();
    scale.expect(body, (0.0, 0.0, 0.0));
    scale.world().entity_mut(body).insert(RigidBody::Dynamic);
    scale.expect(body, (2.0, 3.0, 0.0));
    scale.world().entity_mut(body).insert(RigidBody::Kinematic);
    scale.expect(body, (2.0, 3.0, 0.0));
}

#[test]
fn what_is_no_mass_counts_as_zero_and_infinity_as_infinite() {
    for mass in [f32::NAN, -1.0, f32::INFINITY, f32::NEG_INFINITY] {
        let mut scale = Scale::new();
        let body = scale.body((Mass(mass), CenterOfMass(VectorF32::NAN)));
        scale.expect(body, (0.0, 0.0, 0.0));
    }
    let mut scale = Scale::new();
    let body = scale.body(Mass(f32::INFINITY));
    scale.collider(body, (lump(2.0), at_x(1.0)));
    // The centre is at the infinite part. The inertia of the finite part about it is 1 + 2 · 1².
    scale.expect(body, (0.0, 3.0, 0.0));
}

#[test]
fn resting_bodies_are_not_computed_again() {
    let mut scale = Scale::new();
    let body = scale.body((lump(2.0), Mass(4.0)));
    scale.weigh(body);
    // A wrong value that only a recomputation corrects.
    scale.world().get_mut::<ComputedMass>(body).expect("required").set(100.0);
    assert_eq!(scale.weigh(body).0, 100.0);
    scale.world().entity_mut(body).insert(RecomputeMassProperties);
    assert_eq!(scale.weigh(body).0, 4.0);
}

#[test]
fn the_helper_tells_own_from_descendants() {
    let mut scale = Scale::new();
    let body = scale.body((lump(2.0), NoAutoMass));
    scale.collider(body, (lump(3.0), at_x(1.0)));
    let none = scale.world().spawn_empty().id();
    let read = move |helper: MassPropertyHelper| {
        assert_eq!(helper.local_mass_properties(none), None);
        assert_eq!(helper.total_mass_properties(none).mass, 0.0);
        let local = helper.local_mass_properties(body).expect("it has a collider");
        let rest = helper.descendants_mass_properties(body);
        let total = helper.total_mass_properties(body);
        assert_eq!((local.mass, rest.mass, total.mass), (2.0, 3.0, 5.0));
        assert_eq!((local.center_of_mass.x, rest.center_of_mass.x), (0.0, 1.0));
        assert!((total.center_of_mass.x - 0.6).abs() < 1e-6);
    };
    scale.world().run_system_once(read).expect("the helper runs in any system");
}

#[test]
fn a_sum_does_not_depend_on_its_order() {
    let place =
        |x: f64| PartFrame { translation: Vector64::X * x, ..PartFrame::scaled_by(&Transform::IDENTITY) };
    let parts: Vec<Part> = (0..7)
        .map(|i| {
            let part = Part::from_collider(&lump(1.0 + i as f32 * 0.37));
            part.moved(&place(f64::from(i * i) * 0.31 - 2.0))
        })
        .collect();
    let forward = Part::sum(&parts).to_properties();
    let reversed: Vec<Part> = parts.into_iter().rev().collect();
    let backward = Part::sum(&reversed).to_properties();
    assert_eq!(forward, backward);
}

#[test]
fn issue_bodies_without_mass_were_remembered_for_ever() {
    let mut scale = Scale::new();
    for _ in 0..20 {
        let bodies: Vec<_> = (0..100).map(|_| scale.world().spawn(RigidBody::Dynamic).id()).collect();
        scale.app.update();
        for body in bodies {
            scale.world().despawn(body);
        }
    }
    let kept = scale.world().resource::<super::queue::ReportedMassless>().len();
    assert!((100..400).contains(&kept), "{kept} of 2,000");
}
