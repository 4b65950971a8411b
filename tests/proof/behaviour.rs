//! Effects of components: hierarchies, layers, mass, locked axes, dominance, sensors, disabling.

use avian::{
    math::{Scalar, Vector},
    prelude::*,
};
use bevy_ecs::prelude::*;
use bevy_transform::components::{GlobalTransform, Transform};
use scenes::scene::at;

use super::{
    dim,
    world::{G, Lab, assert_close},
};

/// A bar on two feet, whose body has no collider of its own. Returns body and feet.
fn table(lab: &mut Lab, height: f32) -> (Entity, Vec<Entity>) {
    let body = lab.spawn((RigidBody::Dynamic, at(0.0, height, 0.0)));
    let parts = [([3.0, 0.2, 1.0], 0.0, 0.0), ([0.2, 1.0, 1.0], -1.3, -0.5), ([0.2, 1.0, 1.0], 1.3, -0.5)];
    let parts = parts
        .map(|(size, x, y)| {
            lab.spawn((dim::sized_block(size[0], size[1], size[2]), at(x, y, 0.0), ChildOf(body)))
        })
        .into();
    (body, parts)
}

#[test]
fn child_colliders_make_one_body_that_falls_and_rests_on_its_feet() {
    let mut lab = Lab::new();
    lab.floor();
    let (body, parts) = table(&mut lab, 4.0);
    lab.seconds(0.5);
    let fallen = 4.0 - lab.at(body).y;
    assert_close(fallen, 0.5 * G * 0.5 * (0.5 + 1.0 / 240.0), 1e-3, "it falls as one");
    lab.seconds(3.0);
    assert!((lab.at(body).y - 1.0).abs() < 0.02, "it stands on its feet: {:?}", lab.at(body));
    assert!(lab.uprightness(body) > 0.999);
    for (&part, x) in parts.iter().zip([0.0, -1.3, 1.3]) {
        assert_eq!(lab.get::<ColliderOf>(part).body, body);
        assert!(
            (lab.at(part).x - lab.at(body).x - x).abs() < 1e-3,
            "the part moves along: {:?}",
            lab.at(part)
        );
        let global = lab.get::<GlobalTransform>(part).translation();
        assert!((global.x - lab.at(part).x).abs() < 1e-3 && (global.y - lab.at(part).y).abs() < 1e-3);
    }
    assert_eq!(lab.get::<RigidBodyColliders>(body).iter().count(), 3);
}

#[test]
fn a_leg_sawn_off_makes_the_table_fall() {
    let mut lab = Lab::new();
    lab.floor();
    let (body, parts) = table(&mut lab, 1.0);
    lab.seconds(2.0);
    lab.despawn(parts[1]);
    lab.seconds(2.0);
    assert!(lab.uprightness(body) < 0.98, "it leans: {}", lab.uprightness(body));
}

#[test]
fn a_child_body_moves_on_its_own() {
    let mut lab = Lab::weightless();
    let parent = lab.spawn((RigidBody::Dynamic, scenes::dim::ball(0.5), at(0.0, 0.0, 0.0)));
    lab.insert(parent, LinearVelocity(Vector::X));
    let child = lab.spawn((RigidBody::Dynamic, scenes::dim::ball(0.5), at(0.0, 3.0, 0.0), ChildOf(parent)));
    lab.seconds(1.0);
    assert_close(lab.at(parent).x, 1.0, 1e-4, "the parent moves");
    assert!((lab.at(child) - Vector::Y * 3.0).length() < 1e-4, "the child stays: {:?}", lab.at(child));
    let local = lab.get::<Transform>(child).translation;
    assert!((local.x + 1.0).abs() < 1e-3, "its transform is relative: {local}");
}

#[derive(PhysicsLayer, Clone, Copy, Debug, Default)]
enum Layer {
    #[default]
    World,
    Ghost,
    Player,
}

#[test]
fn layers_decide_who_meets_and_may_change() {
    let mut lab = Lab::new();
    let floor = lab.floor();
    lab.insert(floor, CollisionLayers::new(Layer::World, [Layer::Player, Layer::World]));
    let ghost = lab.unit_box(at(0.0, 0.5, 0.0));
    lab.insert(ghost, CollisionLayers::new(Layer::Ghost, LayerMask::ALL));
    let player = lab.unit_box(at(3.0, 0.5, 0.0));
    lab.insert(player, CollisionLayers::new(Layer::Player, Layer::World));
    lab.seconds(1.0);
    assert!(lab.at(ghost).y < -3.0, "the floor filters ghosts: {:?}", lab.at(ghost));
    assert!((lab.at(player).y - 0.5).abs() < 0.01);

    // Asleep or not, a body without a floor falls, and lands when the floor is back.
    lab.seconds(2.0);
    assert!(lab.has::<Sleeping>(player));
    lab.insert(player, CollisionLayers::new(Layer::Player, LayerMask::NONE));
    lab.seconds(0.3);
    let y = lab.at(player).y;
    assert!(y < 0.4, "fell to {y}");
    lab.insert(
        player,
        (CollisionLayers::new(Layer::Player, Layer::World), Position(dim::sized(3.0, 2.0, 0.0))),
    );
    lab.seconds(3.0);
    assert!((lab.at(player).y - 0.5).abs() < 0.01, "landed at {:?}", lab.at(player));
}

#[test]
fn mass_follows_shape_density_and_what_the_user_says() {
    let mut lab = Lab::weightless();
    let ball = lab.ball(0.5, at(0.0, 0.0, 0.0));
    let dense = lab.ball(0.5, at(5.0, 0.0, 0.0));
    lab.insert(dense, ColliderDensity(3.0));
    let said = lab.ball(0.5, at(10.0, 0.0, 0.0));
    lab.insert(said, Mass(7.0));
    lab.steps(1);
    let mass = |lab: &Lab, body| lab.get::<ComputedMass>(body).value();
    assert_close(mass(&lab, ball), dim::ball_mass(0.5), 1e-5, "density 1");
    assert_close(mass(&lab, dense), 3.0 * dim::ball_mass(0.5), 1e-5, "density 3");
    assert_close(mass(&lab, said), 7.0, 1e-6, "said");
    lab.insert(ball, scenes::dim::ball(1.0));
    lab.steps(1);
    assert_close(mass(&lab, ball), dim::ball_mass(1.0), 1e-5, "larger");
}

#[test]
fn a_body_turns_about_its_centre_of_mass() {
    // Without gravity, the centre of mass of a rotating body moves on a straight line.
    let mut lab = Lab::weightless();
    let body = lab.unit_box(at(0.0, 0.0, 0.0));
    lab.insert(body, (CenterOfMass(dim::sized(0.4, 0.1, 0.0)), scenes::dim::spin(3.0)));
    lab.insert(body, LinearVelocity(Vector::Y));
    let center =
        |lab: &Lab| lab.at(body) + lab.get::<Rotation>(body) * lab.get::<ComputedCenterOfMass>(body).0;
    lab.steps(1);
    let start = center(&lab);
    for i in 1..120 {
        lab.steps(1);
        let want = start + Vector::Y * i as Scalar / 60.0;
        assert!((center(&lab) - want).length() < 1e-3, "after {i} steps at {:?}", center(&lab));
    }
}

#[test]
fn a_platform_carries_its_load() {
    let mut lab = Lab::new();
    let platform = lab.spawn((RigidBody::Kinematic, dim::sized_block(10.0, 1.0, 10.0), at(0.0, -0.5, 0.0)));
    let load = lab.unit_box(at(0.0, 0.5, 0.0));
    lab.seconds(0.5);
    lab.insert(platform, LinearVelocity(dim::sized(0.5, 0.0, 0.0)));
    lab.seconds(4.0);
    assert_close(lab.at(platform).x, 2.0, 1e-4, "the platform moves as told");
    assert_eq!(lab.at(platform).y, -0.5, "and is pressed by nobody");
    assert_close(lab.velocity(load).x, 0.5, 0.01, "the load has its speed");
    assert!((lab.at(load).x - 2.0).abs() < 0.1, "and its place: {:?}", lab.at(load));
}

#[test]
fn locked_axes_hold() {
    let mut lab = Lab::new();
    lab.floor();
    let hung = lab.unit_box(at(0.0, 5.0, 0.0));
    lab.insert(hung, LockedAxes::new().lock_translation_y());
    let stiff = lab.block([0.4, 2.0, 0.4], at(5.0, 1.0, 0.0));
    lab.insert(stiff, dim::upright());
    let ball = lab.ball(0.3, at(3.0, 1.8, 0.0));
    lab.insert(ball, LinearVelocity(Vector::X * 8.0));
    let pushed = lab.ball(0.3, at(-1.5, 5.0, 0.0));
    lab.insert(pushed, (LinearVelocity(Vector::X * 6.0), GravityScale(0.0)));
    lab.seconds(2.0);
    assert_eq!(lab.at(hung).y, 5.0, "held up");
    assert!(lab.at(hung).x > 0.3, "but free to be pushed along: {:?}", lab.at(hung));
    assert!(lab.uprightness(stiff) > 0.9999, "not tipped: {}", lab.uprightness(stiff));
    assert!(lab.at(stiff).x > 5.0, "but pushed: {:?}", lab.at(stiff));
}

#[test]
fn the_dominant_body_is_not_pushed() {
    let mut lab = Lab::weightless();
    lab.surfaces(0.0, 1.0);
    let strong = lab.ball(0.5, at(0.0, 0.0, 0.0));
    lab.insert(strong, (Dominance(1), Mass(1.0)));
    let weak = lab.ball(0.5, at(-3.0, 0.0, 0.0));
    lab.insert(weak, (Mass(1000.0), LinearVelocity(Vector::X * 4.0)));
    lab.seconds(2.0);
    assert!(lab.velocity(strong).length() < 1e-5, "pushed to {:?}", lab.velocity(strong));
    assert_close(lab.velocity(weak).x, -4.0, 0.01, "thrown back as by a wall");
    // With equal dominance mass counts again.
    lab.insert(strong, Dominance(0));
    lab.insert(weak, (LinearVelocity(Vector::X * 4.0), Position(Vector::X * -3.0)));
    lab.seconds(2.0);
    assert!(lab.velocity(strong).x > 6.0, "{:?}", lab.velocity(strong));
}

#[test]
fn sensors_are_fallen_through_and_weigh_nothing() {
    let mut lab = Lab::new();
    lab.spawn((RigidBody::Static, dim::sized_block(10.0, 1.0, 10.0), Sensor, at(0.0, 0.0, 0.0)));
    let body = lab.unit_box(at(0.0, 2.0, 0.0));
    let alone = lab.spawn((
        RigidBody::Dynamic,
        at(20.0, 0.0, 0.0),
        dim::sized_block(1.0, 1.0, 1.0),
        Sensor,
        Mass(2.0),
    ));
    lab.seconds(1.0);
    assert!(lab.at(body).y < -2.0, "{:?}", lab.at(body));
    assert_close(lab.get::<ComputedMass>(alone).value(), 2.0, 1e-6, "only what is said");
    assert!(lab.at(alone).y < -4.0);
}

#[test]
fn what_is_disabled_waits_where_it_is() {
    let mut lab = Lab::new();
    lab.floor();
    let body = lab.unit_box(at(0.0, 5.0, 0.0));
    lab.seconds(0.2);
    lab.insert(body, RigidBodyDisabled);
    lab.steps(1);
    let held = (lab.at(body), lab.velocity(body));
    let through = lab.ball(0.3, at(0.0, 8.0, 0.0));
    lab.seconds(2.0);
    assert_eq!((lab.at(body), lab.velocity(body)), held);
    assert!(lab.at(through).y < 0.5, "nothing lands on it: {:?}", lab.at(through));
    lab.remove::<RigidBodyDisabled>(body);
    lab.steps(10);
    assert!(lab.at(body).y < held.0.y, "it falls on");
    lab.insert(body, ColliderDisabled);
    lab.seconds(2.0);
    assert!(lab.at(body).y < -5.0, "without collider it falls through: {:?}", lab.at(body));
}

#[test]
fn issue_a_disabled_body_stayed_behind_the_body_that_carries_it() {
    let mut lab = Lab::weightless();
    let carrier = lab.ball(0.5, at(0.0, 0.0, 0.0));
    lab.insert(carrier, (LinearVelocity(Vector::X * 2.0), scenes::dim::spin(1.0)));
    let bag = lab.spawn((Transform::from_xyz(0.0, 1.0, 0.0), ChildOf(carrier)));
    let item = lab.unit_box(at(0.0, 3.0, 0.0));
    lab.insert(item, (RigidBodyDisabled, Transform::from_xyz(1.0, 0.0, 0.0), ChildOf(bag)));
    let place = |lab: &Lab| {
        let turn = lab.get::<Rotation>(carrier);
        lab.at(carrier) + turn * (Vector::X + Vector::Y)
    };
    for step in 0..90 {
        lab.steps(1);
        let off = lab.at(item) - place(&lab);
        assert!(off.length() < 1e-4, "step {step}: {off} off");
        let shown = lab.get::<Transform>(item);
        assert_eq!(shown, Transform::from_xyz(1.0, 0.0, 0.0), "step {step}");
    }
    // The box of its collider is that of its last place but one: colliders of disabled bodies are read
    // before a step.
    let off = lab.get::<ColliderAabb>(item).center() - lab.at(item);
    assert!(off.length() < 0.1, "{off}");
    // Its own pose wins, and it is carried on from there.
    let put = lab.at(item) + Vector::Y * 2.0;
    lab.insert(item, Position(put));
    lab.steps(1);
    let kept = lab.get::<Transform>(item);
    assert!((lab.at(item) - put).length() < 0.2, "{:?}", lab.at(item));
    lab.steps(10);
    assert_eq!(lab.get::<Transform>(item), kept);
    // Put down, it stays where it is and falls.
    lab.remove::<ChildOf>(item);
    let there = lab.at(item);
    lab.insert(item, Position(there));
    lab.gravity(Vector::Y * -10.0);
    lab.remove::<RigidBodyDisabled>(item);
    lab.steps(6);
    let fell = there.y - lab.at(item).y;
    assert!(fell > 0.02 && fell < 0.1, "{fell}");
}

#[test]
fn the_box_of_a_disabled_body_follows_its_position() {
    let mut lab = Lab::new();
    let body = lab.unit_box(at(0.0, 5.0, 0.0));
    lab.insert(body, RigidBodyDisabled);
    lab.steps(2);
    let moved = lab.at(body) + Vector::X * 3.0;
    lab.insert(body, Position(moved));
    lab.steps(2);
    assert!(
        (lab.get::<ColliderAabb>(body).center() - moved).length() < 1e-4,
        "{:?}",
        lab.get::<ColliderAabb>(body)
    );
}

#[test]
fn a_body_may_change_its_type() {
    let mut lab = Lab::new();
    lab.floor();
    let body = lab.unit_box(at(0.0, 3.0, 0.0));
    lab.insert(body, RigidBody::Static);
    lab.seconds(1.0);
    assert_eq!(lab.at(body).y, 3.0);
    lab.insert(body, RigidBody::Dynamic);
    lab.seconds(3.0);
    assert!((lab.at(body).y - 0.5).abs() < 0.01 && lab.has::<Sleeping>(body));
    lab.insert(body, (RigidBody::Kinematic, LinearVelocity(Vector::Y)));
    lab.seconds(1.0);
    assert_close(lab.at(body).y, 1.5, 0.02, "it rises through gravity");
}

#[test]
fn friction_and_restitution_of_a_pair_follow_the_higher_rule() {
    let mut lab = Lab::new();
    let floor = lab.floor();
    lab.insert(floor, Friction::new(0.0).with_combine_rule(CoefficientCombine::Multiply));
    let slides = lab.block([0.5, 0.25, 0.5], at(0.0, 0.125, 0.0));
    lab.insert(slides, (Friction::new(1.0), LinearVelocity(Vector::X * 3.0)));
    let sticks = lab.block([0.5, 0.25, 0.5], at(0.0, 0.125, 0.0));
    lab.insert(sticks, Friction::new(1.0).with_combine_rule(CoefficientCombine::Max));
    lab.insert(sticks, (LinearVelocity(Vector::X * -3.0), Position(dim::sized(-2.0, 0.125, 0.0))));
    lab.seconds(1.0);
    assert_close(lab.velocity(slides).x, 3.0, 1e-3, "1 times 0");
    assert!(lab.velocity(sticks).length() < 1e-3, "the greater of 1 and 0");
}

#[test]
fn a_resting_world_changes_nothing() {
    let mut lab = Lab::new();
    lab.floor();
    let body = lab.unit_box(at(0.0, 0.5, 0.0));
    lab.seconds(3.0);
    #[derive(Resource, Default)]
    struct Changes(usize);
    lab.app.init_resource::<Changes>();
    lab.app.add_systems(
        bevy_app::Last,
        |changed: Query<
            (),
            Or<(Changed<Position>, Changed<Rotation>, Changed<Transform>, Changed<LinearVelocity>)>,
        >,
         mut count: ResMut<Changes>| count.0 += changed.iter().count(),
    );
    // A new system detects everything as changed once.
    lab.steps(1);
    lab.app.world_mut().resource_mut::<Changes>().0 = 0;
    lab.seconds(1.0);
    assert!(lab.has::<Sleeping>(body));
    assert_eq!(lab.app.world().resource::<Changes>().0, 0, "no component of a sleeping world is written");
}
