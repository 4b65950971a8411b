//! When a collision starts: as the surfaces meet, not when they come near.

use super::*;

/// The gap between a ball of radius 0.5 and the floor, y = 0, at the end of the step in which their
/// collision starts.
fn gap_at_start(app: &mut App, ball: Entity) -> Option<Scalar> {
    for _ in 0..300 {
        step(app);
        if said(app).iter().any(|said| matches!(said, Started(..))) {
            return app.world().get::<Position>(ball).map(|position| position.y - 0.5);
        }
        assert_eq!(touched(app, ball), []);
    }
    None
}

#[test]
fn issue_a_collision_started_two_centimetres_before_the_surfaces_met() {
    let floors: [fn(&mut EntityWorldMut); 4] = [
        |floor| _ = floor.insert((RigidBody::Static, Collider::half_space(Vector::Y))),
        |floor| _ = floor.insert((RigidBody::Static, block(20.0, 2.0, 20.0), at(0.0, -1.0))),
        |floor| _ = floor.insert((RigidBody::Kinematic, block(20.0, 2.0, 20.0), at(0.0, -1.0))),
        |floor| _ = floor.insert((RigidBody::Static, block(20.0, 2.0, 20.0), at(0.0, -1.0), Sensor)),
    ];
    for (kind, floor) in floors.into_iter().enumerate() {
        for (body, speed) in [
            (RigidBody::Dynamic, 0.05),
            (RigidBody::Dynamic, 0.3),
            (RigidBody::Dynamic, 1.3),
            (RigidBody::Dynamic, 7.0),
            (RigidBody::Kinematic, 0.3),
            (RigidBody::Kinematic, 1.3),
        ] {
            let what = format!("floor {kind}, {body:?} at {speed} m/s");
            let mut app = app();
            let mut entity = app.world_mut().spawn_empty();
            floor(&mut entity);
            let reporting = (CollisionEventsEnabled, CollidingEntities::default());
            let down = LinearVelocity(Vector::NEG_Y * speed);
            let falling = (body, ball(0.5), at(0.0, 0.62), down, reporting, SleepingDisabled);
            let falling = app.world_mut().spawn(falling).id();
            let gap = gap_at_start(&mut app, falling);
            let gap = gap.unwrap_or_else(|| panic!("{what}: no collision started"));
            // What nothing stops may be as deep as it moves in a step.
            assert!(gap < 1.0e-3 && gap > -speed / 60.0 - 1.0e-3, "{what}: {gap} m");
        }
    }
}

#[test]
fn what_passes_by_at_a_centimetre_starts_no_collision() {
    let mut app = app();
    app.world_mut().spawn((RigidBody::Static, Collider::half_space(Vector::Y), CollisionEventsEnabled));
    let reporting = (CollisionEventsEnabled, CollidingEntities::default());
    let body = (RigidBody::Dynamic, ball(0.5), at(0.0, 0.51), right(3.0), reporting);
    let body = app.world_mut().spawn(body).id();
    steps(&mut app, 100);
    assert_eq!((said(&mut app), touched(&app, body)), (vec![], vec![]));
    // Pushed onto the floor it touches, and then a hop of a millimetre is no end.
    app.insert_resource(Gravity(Vector::NEG_Y * 9.81));
    steps(&mut app, 10);
    assert_eq!(said(&mut app).len(), 3, "two observers and one message");
    app.world_mut().get_mut::<LinearVelocity>(body).expect("a body").y = 0.14;
    steps(&mut app, 60);
    assert_eq!(said(&mut app), []);
    app.world_mut().get_mut::<LinearVelocity>(body).expect("a body").y = 2.0;
    steps(&mut app, 15);
    assert_eq!(said(&mut app).len(), 3, "it left the floor");
}
