//! Systems in the substeps read and write the state of bodies.

use super::*;
use avian::{
    dynamics::{
        integrator::IntegrationSystems,
        solver::{
            schedule::SubstepSolverSystems,
            solver_body::{SolverBody, SolverBodyInertia},
        },
    },
    math::Scalar,
};
use bevy_time::Time;
use scenes::dim::block;

const SUBSTEPS: usize = 8;

#[derive(Resource, Default)]
struct Seen(Vec<SolverBody>);

fn see(bodies: Query<&SolverBody>, mut seen: ResMut<Seen>) {
    seen.0.extend(bodies.iter().cloned());
}

fn has_state(rig: &Rig, entity: Entity) -> bool {
    let body = rig.app.world().entity(entity);
    assert_eq!(body.contains::<SolverBody>(), body.contains::<SolverBodyInertia>());
    body.contains::<SolverBody>()
}

#[test]
fn bodies_have_no_state_where_nobody_asks() {
    let mut rig = Rig::new();
    rig.rod(0.0, 0.0);
    rig.app.add_systems(SubstepSchedule, || {});
    rig.steps(3);
    assert!(rig.app.world().component_id::<SolverBody>().is_none());
}

#[test]
fn a_substep_system_sees_each_substep() {
    let mut rig = Rig::new();
    rig.app.init_resource::<Seen>();
    rig.app.add_systems(
        SubstepSchedule,
        see.after(IntegrationSystems::Position).before(SubstepSolverSystems::Relax),
    );
    rig.rod(0.0, 0.0);
    rig.steps(2);
    let seen = core::mem::take(&mut rig.app.world_mut().resource_mut::<Seen>().0);
    assert_eq!(seen.len(), 2 * SUBSTEPS, "the first step as well");
    let h = DT / SUBSTEPS as Scalar;
    let mut fallen = 0.0;
    for (i, body) in seen.iter().enumerate() {
        let speed = G * h * (i + 1) as Scalar;
        fallen = if i % SUBSTEPS == 0 { 0.0 } else { fallen } + speed * h;
        assert!((body.linear_velocity.y + speed).abs() < 1e-5, "substep {i}: {}", body.linear_velocity);
        assert!((body.delta_position.y + fallen).abs() < 1e-5, "substep {i}: {}", body.delta_position);
    }
}

#[test]
fn what_a_substep_system_writes_is_what_happens() {
    // In each place, a velocity of 2 m/s, a shift of 0.1 m and a turn of 0.1 rad a substep.
    fn push(mut bodies: Query<&mut SolverBody>) {
        for mut body in &mut bodies {
            body.linear_velocity = Vector::X * 2.0;
            body.delta_position += Vector::Y * 0.1;
            body.delta_rotation = super::super::joints::turned(0.1) * body.delta_rotation;
        }
    }
    for place in 0..3 {
        let mut rig = Rig::weightless();
        match place {
            0 => rig.app.add_systems(SubstepSchedule, push.before(IntegrationSystems::Velocity)),
            1 => rig.app.add_systems(SubstepSchedule, push.in_set(SubstepSolverSystems::SolveConstraints)),
            _ => rig.app.add_systems(SubstepSchedule, push.in_set(SubstepSolverSystems::Damping)),
        };
        let rod = rig.rod(0.0, 0.0);
        rig.step();
        let (velocity, place_now) = (rig.get::<LinearVelocity>(rod).0, rig.place(rod));
        assert!((velocity - Vector::X * 2.0).length() < 1e-6, "{place}: {velocity}");
        assert!((place_now.y - 0.8).abs() < 1e-5, "{place}: {place_now}");
        // In the last place the first substep is integrated before it.
        let moved = 2.0 * DT * if place == 2 { 0.875 } else { 1.0 };
        assert!((place_now.x - moved).abs() < 1e-5, "{place}: {place_now}");
        assert!((rig.angle(rod) - 0.8).abs() < 1e-4, "{place}: {}", rig.angle(rod));
    }
}

#[test]
fn systems_around_the_substeps_read_and_write_it_too() {
    let mut rig = Rig::weightless();
    let stop =
        |mut bodies: Query<&mut SolverBody>| bodies.iter_mut().for_each(|mut b| b.linear_velocity.y = 0.0);
    rig.app.add_systems(PhysicsSchedule, stop.in_set(SolverSystems::PostSubstep));
    let rod = rig.rod(0.0, 0.0);
    rig.insert(rod, LinearVelocity(Vector::ONE));
    rig.step();
    assert!((rig.place(rod).y - DT).abs() < 1e-6, "it moved in the substeps");
    assert_eq!(rig.get::<LinearVelocity>(rod).y, 0.0);
    assert_eq!(rig.get::<LinearVelocity>(rod).x, 1.0);
}

/// A heap with some spin, and its poses after a second.
fn heap(prepare: impl Fn(&mut Rig)) -> String {
    let mut rig = Rig::new();
    prepare(&mut rig);
    rig.spawn((RigidBody::Static, Collider::half_space(Vector::Y)));
    let spin = AngularVelocity::default();
    let mut bodies = Vec::new();
    for i in 0..12 {
        let place = at((i % 3) as Scalar * 0.3, 1.0 + i as Scalar * 0.7);
        let turned = super::super::joints::turned(0.4 * i as Scalar);
        bodies.push(rig.spawn((RigidBody::Dynamic, block(0.5, 0.5, 0.5), place, turned, spin)));
    }
    let rod = rig.rod(-3.0, 3.0);
    rig.spawn(RevoluteJoint::new(bodies[0], rod));
    rig.steps(64);
    let state = |body: &Entity| format!("{:?} {:?}", rig.place(*body), rig.get::<Rotation>(*body));
    bodies.iter().map(state).collect()
}

#[test]
fn reading_changes_no_bit() {
    let expected = heap(|_| {});
    let reads = |rig: &mut Rig| {
        rig.app.init_resource::<Seen>();
        rig.app.add_systems(SubstepSchedule, see.in_set(SubstepSolverSystems::SolveConstraints));
    };
    assert_eq!(heap(reads), expected);
    let reads_after = |rig: &mut Rig| {
        rig.app.init_resource::<Seen>();
        rig.app.add_systems(PhysicsSchedule, see.in_set(SolverSystems::PostSubstep));
    };
    assert_eq!(heap(reads_after), expected);
}

#[test]
fn awake_bodies_have_a_state_and_others_none() {
    let mut rig = Rig::weightless();
    rig.app.init_resource::<Seen>().add_systems(SubstepSchedule, see.in_set(SubstepSolverSystems::Damping));
    let post = rig.post(0.0, 0.0);
    let rod = rig.rod(3.0, 0.0);
    let lift = rig.spawn((RigidBody::Kinematic, at(6.0, 0.0), LinearVelocity(Vector::Y)));
    rig.step();
    assert!(!has_state(&rig, post) && has_state(&rig, rod) && has_state(&rig, lift));
    assert!(rig.get::<SolverBody>(lift).flags.is_kinematic());
    assert_eq!(rig.get::<SolverBodyInertia>(lift).effective_inv_mass(), Vector::ZERO);
    assert!((rig.get::<SolverBodyInertia>(rod).effective_inv_mass().x * MASS - 1.0).abs() < 1e-6);
    rig.steps(64);
    assert!(rig.sleeps(rod) && !has_state(&rig, rod));
    rig.insert(rod, LinearVelocity(Vector::X));
    rig.step();
    assert!(has_state(&rig, rod), "it is awake again");
    rig.insert(rod, RigidBodyDisabled);
    rig.step();
    assert!(!has_state(&rig, rod));
    rig.remove::<RigidBodyDisabled>(rod);
    rig.step();
    rig.insert(rod, RigidBody::Static);
    rig.insert(lift, RigidBody::Dynamic);
    rig.step();
    assert!(!has_state(&rig, rod) && rig.get::<SolverBody>(lift).flags.is_dynamic());
    rig.despawn(lift);
    rig.steps(2);
    // While nothing passes, nothing changes.
    rig.app.world_mut().resource_mut::<Time<Physics>>().pause();
    rig.steps(3);
    rig.despawn(rod);
    rig.app.world_mut().resource_mut::<Time<Physics>>().unpause();
    rig.step();
}

#[test]
fn a_state_that_is_not_finite_stops_its_body_alone() {
    #[derive(Resource)]
    struct Victim(Entity, bool);
    fn spoil(mut bodies: Query<&mut SolverBody>, mut victim: ResMut<Victim>) {
        if core::mem::take(&mut victim.1)
            && let Ok(mut body) = bodies.get_mut(victim.0)
        {
            body.linear_velocity.x = Scalar::NAN;
            body.delta_rotation = Rotation::from(bevy_math::Quat::from_xyzw(0.0, 0.0, 0.0, 0.0));
        }
    }
    let mut rig = Rig::new();
    rig.spawn((RigidBody::Static, Collider::half_space(Vector::Y)));
    let below = rig.spawn((RigidBody::Dynamic, block(1.0, 1.0, 1.0), at(0.0, 0.5)));
    let above = rig.spawn((RigidBody::Dynamic, block(1.0, 1.0, 1.0), at(0.0, 1.5)));
    rig.steps(4);
    rig.app
        .insert_resource(Victim(above, true))
        .add_systems(SubstepSchedule, spoil.in_set(SubstepSolverSystems::Relax));
    rig.steps(4);
    assert!(rig.app.world().entity(above).contains::<RigidBodyDisabled>());
    assert!(
        (rig.place(above) - Vector::Y * 1.5).length() < 0.02
            && (rig.place(below) - Vector::Y * 0.5).length() < 0.02
    );
}
