//! Collider types of the app, beside the default one.

use super::custom_colliders_dim::place;
use avian::{
    math::{Scalar, Vector},
    parry::shape::SharedShape,
    prelude::*,
};
use bevy_app::prelude::*;
use bevy_ecs::{prelude::*, system::RunSystemOnce};
use bevy_time::Time;
use bevy_transform::TransformPlugin;
use core::time::Duration;

/// A ball that computes its own contacts. Each `TYPE` is a collider type.
#[derive(Component, Clone, Debug)]
pub struct Globe<const TYPE: usize> {
    pub radius: Scalar,
    scale: Scalar,
}

impl<const TYPE: usize> Globe<TYPE> {
    fn new(radius: Scalar) -> Self {
        Self { radius, scale: 1.0 }
    }

    fn size(&self) -> Scalar {
        self.radius * self.scale
    }

    /// The same ball as a collider of the engine.
    pub fn ball(&self) -> Collider {
        SharedShape::ball(self.size()).into()
    }
}

/// What an entity's globe is multiplied by: a component that is not the collider.
#[derive(Component, Clone, Copy)]
pub struct Swell(Scalar);

/// The closed form of two balls.
fn touch(
    [r1, r2]: [Scalar; 2],
    [at1, at2]: [Vector; 2],
    prediction_distance: Scalar,
    manifolds: &mut Vec<ContactManifold>,
) {
    manifolds.clear();
    let apart = at2 - at1;
    let distance = apart.length();
    if distance > r1 + r2 + prediction_distance {
        return;
    }
    let normal = if distance > 0.0 { apart / distance } else { Vector::Y };
    let [anchor1, anchor2] = [normal * r1, -normal * r2];
    let middle = ((at1 + anchor1) + (at2 + anchor2)) * 0.5;
    let point = ContactPoint::new(anchor1, anchor2, middle, r1 + r2 - distance);
    manifolds.push(ContactManifold::new([point], normal));
}

impl<const TYPE: usize> AnyCollider for Globe<TYPE> {
    type Context = Query<'static, 'static, &'static Swell>;

    fn aabb_with_context(
        &self,
        position: Vector,
        _: impl Into<Rotation>,
        context: AabbContext<Self::Context>,
    ) -> ColliderAabb {
        let swell = context.get(context.entity).map_or(1.0, |swell| swell.0);
        ColliderAabb::new(position, Vector::splat(self.size() * swell))
    }

    fn contact_manifolds_with_context(
        &self,
        other: &Self,
        position1: Vector,
        _: impl Into<Rotation>,
        position2: Vector,
        _: impl Into<Rotation>,
        prediction_distance: Scalar,
        manifolds: &mut Vec<ContactManifold>,
        context: ContactManifoldContext<Self::Context>,
    ) {
        let swell = |entity| context.get(entity).map_or(1.0, |swell| swell.0);
        let radii = [self.size() * swell(context.entity1), other.size() * swell(context.entity2)];
        touch(radii, [position1, position2], prediction_distance, manifolds);
    }
}

impl<const TYPE: usize> ScalableCollider for Globe<TYPE> {
    fn scale(&self) -> Vector {
        Vector::splat(self.scale)
    }

    fn set_scale(&mut self, scale: Vector, _: u32) {
        self.scale = scale.x;
    }
}

/// An app with two collider types of its own.
fn app() -> App {
    let mut app = App::new();
    app.add_plugins((TaskPoolPlugin::default(), TransformPlugin, PhysicsPlugins::new(Update))).add_plugins((
        ColliderBackendPlugin::<Globe<0>>::new(Update),
        ColliderTreePlugin::<Globe<0>>::default(),
        NarrowPhasePlugin::<Globe<0>>::default(),
        ColliderBackendPlugin::<Globe<1>>::new(Update),
        ColliderTreePlugin::<Globe<1>>::default(),
        NarrowPhasePlugin::<Globe<1>>::default(),
    ));
    app.add_plugins((ColliderBackendPlugin::<Liar>::new(Update), NarrowPhasePlugin::<Liar>::default()));
    app.insert_resource(Gravity(Vector::NEG_Y * 10.0));
    app.finish();
    app.cleanup();
    app
}

fn steps(app: &mut App, count: usize) {
    for _ in 0..count {
        app.world_mut().resource_mut::<Time>().advance_by(Duration::from_secs_f64(1.0 / 60.0));
        app.update();
    }
}

/// A static ball whose top is the origin.
fn ground<const TYPE: usize>(app: &mut App) -> Entity {
    let globe = Globe::<TYPE>::new(50.0);
    app.world_mut().spawn((RigidBody::Static, globe, place(0.0, -50.0))).id()
}

fn ball<const TYPE: usize>(app: &mut App, x: f32, y: f32) -> Entity {
    app.world_mut().spawn((RigidBody::Dynamic, Globe::<TYPE>::new(0.5), place(x, y))).id()
}

fn at(app: &App, entity: Entity) -> Vector {
    app.world().get::<Position>(entity).expect("a body").0
}

#[test]
fn each_type_collides_with_itself() {
    let mut app = app();
    ground::<0>(&mut app);
    let [first, second] = [ball::<0>(&mut app, 0.0, 1.0), ball::<1>(&mut app, 0.0, 1.0)];
    let default = app
        .world_mut()
        .spawn((RigidBody::Dynamic, Collider::from(SharedShape::ball(0.5)), place(0.0, 1.0)))
        .id();
    steps(&mut app, 120);
    assert!((at(&app, first).y - 0.5).abs() < 0.01, "{}", at(&app, first));
    assert!(at(&app, second).y < -10.0 && at(&app, default).y < -10.0);
    ground::<1>(&mut app);
    let late = ball::<1>(&mut app, 0.0, 1.0);
    steps(&mut app, 120);
    assert!((at(&app, late).y - 0.5).abs() < 0.01);
}

/// The engine's balls and those of the app take the same way.
#[test]
fn a_type_of_the_app_moves_as_the_engines_does() {
    let run = |custom: bool| {
        let mut app = app();
        let mut spawn = |body: RigidBody, radius: Scalar, x: f32, y: f32| {
            let globe = Globe::<0>::new(radius);
            let mut entity =
                app.world_mut().spawn((body, place(x, y), Restitution::new(0.5), Friction::ZERO));
            if custom {
                entity.insert(globe)
            } else {
                entity.insert(globe.ball())
            };
            entity.id()
        };
        spawn(RigidBody::Static, 50.0, 0.0, -50.0);
        // One falls and rebounds, one slides downhill.
        let balls = [(0.0, 2.0), (10.0, 0.1)].map(|(x, y)| spawn(RigidBody::Dynamic, 0.5, x, y));
        steps(&mut app, 90);
        let mass = app.world().get::<ComputedMass>(balls[0]).expect("a body").value();
        (mass, balls.map(|ball| at(&app, ball)))
    };
    let ((mass, custom), (expected_mass, expected)) = (run(true), run(false));
    assert_eq!(mass, expected_mass);
    assert!(expected[1].x > 11.0, "it slides: {expected:?}");
    for (a, b) in custom.iter().zip(&expected) {
        assert!(a.distance(*b) < 0.02, "{custom:?} for {expected:?}");
    }
}

/// A changed radius, one that depends on another component, and a scale by the method.
#[test]
fn shapes_may_change() {
    let mut app = app();
    ground::<0>(&mut app);
    let body = ball::<0>(&mut app, 0.0, 0.6);
    steps(&mut app, 60);
    let rests_at = |app: &mut App, height: Scalar| {
        steps(app, 90);
        assert!((at(app, body).y - height).abs() < 0.02, "{} for {height}", at(app, body).y);
    };
    app.world_mut().get_mut::<Globe<0>>(body).unwrap().radius = 1.0;
    rests_at(&mut app, 1.0);
    app.world_mut().entity_mut(body).insert(Swell(2.0));
    app.world_mut().entity_mut(body).insert(LinearVelocity(Vector::Y));
    rests_at(&mut app, 2.0);
    app.world_mut().entity_mut(body).remove::<Swell>();
    app.world_mut().entity_mut(body).insert(Globe::<0>::new(0.25));
    app.world_mut().entity_mut(body).insert(LinearVelocity(Vector::Y));
    rests_at(&mut app, 0.25);
}

#[test]
fn colliders_leave_and_return() {
    let mut app = app();
    let floor = ground::<0>(&mut app);
    let body = ball::<0>(&mut app, 0.0, 0.5);
    steps(&mut app, 30);
    app.world_mut().entity_mut(floor).insert(ColliderDisabled);
    steps(&mut app, 30);
    let fallen = at(&app, body).y;
    assert!(fallen < 0.0, "{fallen}");
    app.world_mut().entity_mut(body).insert((Position(Vector::Y * 0.5), LinearVelocity::ZERO));
    app.world_mut().entity_mut(floor).remove::<ColliderDisabled>();
    steps(&mut app, 30);
    assert!((at(&app, body).y - 0.5).abs() < 0.02);
    app.world_mut().entity_mut(floor).remove::<Globe<0>>();
    steps(&mut app, 30);
    assert!(at(&app, body).y < 0.0);
    assert!(app.world().get::<ColliderMarker>(floor).is_none());
    app.world_mut().despawn(floor);
    steps(&mut app, 2);
}

#[test]
fn contacts_and_events_are_told() {
    #[derive(Resource, Default)]
    struct Told(Vec<[Entity; 2]>);
    let mut app = app();
    app.init_resource::<Told>().add_observer(|on: On<CollisionStart>, mut told: ResMut<Told>| {
        told.0.push([on.collider1, on.collider2]);
    });
    let floor = ground::<0>(&mut app);
    let body = ball::<0>(&mut app, 0.0, 0.7);
    let sensor = (RigidBody::Static, Globe::<0>::new(0.2), Sensor, place(0.0, 0.5));
    let sensor = app.world_mut().spawn((sensor, CollidingEntities::default())).id();
    app.world_mut().entity_mut(body).insert((CollisionEventsEnabled, Mass(2.0)));
    steps(&mut app, 60);
    let told = app.world().resource::<Told>();
    assert!(told.0.iter().any(|pair| pair.contains(&floor) && pair.contains(&body)), "{:?}", told.0);
    assert!(app.world().get::<CollidingEntities>(sensor).unwrap().contains(&body));
    let weight = app.world_mut().run_system_once(move |collisions: Collisions| {
        collisions.get(floor, body).expect("they touch").total_normal_impulse_magnitude()
    });
    assert!((weight.unwrap() - 2.0 * 10.0 / 60.0).abs() < 0.01);
}

/// A collider type that answers nonsense.
#[derive(Component, Clone, Copy, Debug)]
pub struct Liar(usize);

impl Liar {
    /// What the mass is that of.
    pub fn ball(&self) -> Collider {
        SharedShape::ball(0.5).into()
    }
}

const BAD: [Scalar; 4] = [Scalar::NAN, Scalar::INFINITY, Scalar::MAX, -1.0];

impl AnyCollider for Liar {
    type Context = ();

    fn aabb_with_context(
        &self,
        position: Vector,
        _: impl Into<Rotation>,
        _: AabbContext<()>,
    ) -> ColliderAabb {
        match self.0 {
            0..4 => ColliderAabb::new(position, Vector::splat(BAD[self.0])),
            _ => ColliderAabb::new(position, Vector::splat(0.5)),
        }
    }

    fn contact_manifolds_with_context(
        &self,
        _: &Self,
        position1: Vector,
        _: impl Into<Rotation>,
        position2: Vector,
        _: impl Into<Rotation>,
        _: Scalar,
        manifolds: &mut Vec<ContactManifold>,
        _: ContactManifoldContext<()>,
    ) {
        let middle = (position1 + position2) * 0.5;
        let good = ContactPoint::new(Vector::Y, Vector::NEG_Y, middle, 0.01);
        let point = |value: Scalar| ContactPoint::new(Vector::Y, Vector::Y, Vector::splat(value), value);
        for value in BAD {
            manifolds.push(ContactManifold::new([point(value)], Vector::Y));
            manifolds.push(ContactManifold::new([good], Vector::splat(value)));
        }
        manifolds.push(ContactManifold::new([good], Vector::ZERO));
        manifolds.push(ContactManifold::new([], Vector::Y));
        manifolds.push(ContactManifold::new([good, good], Vector::Y));
    }
}

impl ScalableCollider for Liar {
    fn scale(&self) -> Vector {
        Vector::ONE
    }

    fn set_scale(&mut self, _: Vector, _: u32) {}
}

#[test]
fn nonsense_of_a_collider_type_does_no_harm() {
    let mut app = app();
    let bodies: Vec<_> = (0..12)
        .map(|i| app.world_mut().spawn((RigidBody::Dynamic, Liar(i % 6), place(0.1 * i as f32, 0.0))).id())
        .collect();
    let bystander = ball::<0>(&mut app, 30.0, 0.0);
    steps(&mut app, 60);
    for body in bodies {
        assert!(at(&app, body).is_finite());
    }
    let fallen = at(&app, bystander).y;
    assert!((fallen + 5.0).abs() < 0.2, "{fallen}");
}

/// Methods of the trait, without an app.
#[test]
fn simple_colliders_need_no_context() {
    let ball = Collider::from(SharedShape::ball(0.5));
    let mut manifolds = Vec::new();
    let turn = Rotation::default();
    ball.contact_manifolds(&ball, Vector::ZERO, turn, Vector::X * 0.9, turn, 0.0, &mut manifolds);
    let [manifold] = &manifolds[..] else { panic!("{manifolds:?}") };
    assert!(manifold.normal.distance(Vector::X) < 1.0e-5);
    assert!((manifold.points[0].penetration - 0.1).abs() < 1.0e-5);
}
