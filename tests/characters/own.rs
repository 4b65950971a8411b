//! Programs of apps on the interface of Avian: controllers of their own, as its documentation describes them.

use super::{SKIN, app, block, fixed, floor, step, toward, turned};
use avian::{math::*, prelude::*};
use bevy_app::prelude::*;
use bevy_ecs::{entity::EntityHashSet, prelude::*};
use bevy_time::Time;
use bevy_transform::components::Transform;
use core::time::Duration;

/// The velocity of a body that only its app moves, and what it touched.
#[derive(Component, Default)]
#[require(RigidBody::Kinematic, TransformInterpolation)]
struct Motion {
    velocity: Vector,
    wish: Scalar,
    touched: EntityHashSet,
    grounded: bool,
}

fn place(transform: &Transform) -> Vector {
    Vector::X * transform.translation.x as Scalar + Vector::Y * transform.translation.y as Scalar
}

/// Moves each body along what it meets, by its transform; as in an example that only slides.
fn slide(
    mut bodies: Query<(Entity, &Collider, &Rotation, &mut Transform, &mut Motion)>,
    mover: MoveAndSlide,
    time: Res<Time>,
) {
    for (entity, shape, rotation, mut transform, mut motion) in &mut bodies {
        let Motion { velocity, wish, touched, grounded } = &mut *motion;
        velocity.x = *wish;
        velocity.y -= 9.81 * time.delta_secs() as Scalar;
        touched.clear();
        *grounded = false;
        let config = MoveAndSlideConfig { move_and_slide_iterations: 6, ..Default::default() };
        let filter = SpatialQueryFilter::from_excluded_entities([entity]);
        let from = place(&transform);
        let MoveAndSlideOutput { position, projected_velocity } = mover.move_and_slide(
            shape,
            from,
            (*rotation).into(),
            *velocity,
            time.delta(),
            &config,
            &filter,
            |hit| {
                touched.insert(hit.entity);
                *grounded |= hit.normal.y > 0.7;
                MoveAndSlideHitResponse::Accept
            },
        );
        *velocity = projected_velocity;
        let way = position - from;
        transform.translation.x += way.x as f32;
        transform.translation.y += way.y as f32;
    }
}

/// Pushes what was touched; as in an example of a character among dynamic bodies.
fn push(movers: Query<&Motion>, mut bodies: Query<(&RigidBody, Forces)>) {
    for motion in &movers {
        for entity in &motion.touched {
            if let Ok((RigidBody::Dynamic, mut forces)) = bodies.get_mut(*entity) {
                forces.apply_linear_impulse(Vector::X * (motion.wish * 0.5));
            }
        }
    }
}

/// The ground below, by a cast of the shape.
fn ground_below(queries: &SpatialQuery, shape: &Collider, at: Vector, own: Entity) -> Option<Entity> {
    let filter = SpatialQueryFilter::from_excluded_entities([own]);
    let config = ShapeCastConfig::from_max_distance(0.1);
    let hit = queries.cast_shape(shape, at, Rotation::IDENTITY.into(), Dir::NEG_Y, &config, &filter)?;
    (hit.normal1.y > 0.7).then_some(hit.entity)
}

fn run(app: &mut App, player: Entity, wish: Scalar, ticks: u32) -> (Vector, bool) {
    app.world_mut().get_mut::<Motion>(player).expect("a body").wish = wish;
    for _ in 0..ticks {
        step(app, Duration::from_nanos(16_666_667));
    }
    let entity = app.world().entity(player);
    (
        place(entity.get::<Transform>().expect("it has one")),
        entity.get::<Motion>().expect("it has one").grounded,
    )
}

#[test]
fn an_app_writes_a_controller_on_move_and_slide() {
    let shape = Collider::capsule(0.4, 1.0);
    let mut app = app();
    app.add_systems(Update, (slide, push).chain().before(PhysicsSystems::First));
    let ground = floor(&mut app);
    fixed(&mut app, block(Vector::ONE * 4.0), Vector::X * -6.0 + Vector::Y * 2.0, Rotation::IDENTITY);
    // 30 degrees up from x = 4.
    let angle: Scalar = 30.0_f64.to_radians() as Scalar;
    let out = toward((angle + 0.5 * PI) as f32);
    fixed(&mut app, block(Vector::ONE * 20.0), Vector::X * 4.0 - out * 10.0, turned(angle));
    let bundle = (Motion::default(), shape.clone(), Transform::from_xyz(0.0, 2.0, 0.0));
    let player = app.world_mut().spawn(bundle).id();
    let load =
        (RigidBody::Dynamic, block(Vector::ONE), Position(Vector::X * -1.5 + Vector::Y * 0.5), Mass(5.0));
    let load = app.world_mut().spawn(load).id();

    let (at, grounded) = run(&mut app, player, 0.0, 90);
    assert!(grounded, "{at}");
    assert!((at.y - 0.9 - SKIN).abs() < 5.0e-4, "{at}");
    let below = super::ask(&mut app, move |mover| ground_below(&mover.spatial_query, &shape, at, player));
    assert_eq!(below, Some(ground));
    // Into the crate, which is pushed to the wall, and no farther.
    run(&mut app, player, -2.0, 180);
    let crate_at = app.world().get::<Position>(load).expect("a body").0;
    assert!(crate_at.x < -2.5, "it is pushed: {crate_at}");
    let (at, _) = run(&mut app, player, -2.0, 120);
    assert!(at.x > -4.0 + 0.4 && (at.y - 0.9 - SKIN).abs() < 5.0e-3, "{at}");
    // Up the slope.
    let (at, grounded) = run(&mut app, player, 3.0, 240);
    assert!(grounded && at.x > 5.0, "{at}");
    let height = (at.x - 4.0) * angle.tan() + (0.4 + SKIN) / angle.cos() + 0.5;
    assert!((at.y - height).abs() < 2.0e-3, "{at}, not at {height}");
}
