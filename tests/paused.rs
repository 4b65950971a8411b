//! Spawning, despawning and changes while physics is paused: afterwards the world is as if it had been
//! spawned in its final state.

use avian::{
    math::{Scalar, Vector},
    prelude::*,
};
use bevy_app::prelude::*;
use bevy_ecs::prelude::*;
use bevy_time::Time;
use bevy_transform::{TransformPlugin, components::Transform};
use core::time::Duration;
use proptest::prelude::*;

/// The intended state of one entity.
#[derive(Clone, Debug, PartialEq)]
struct Spec {
    body: Option<RigidBody>,
    /// Half the side of a box, in steps of 0.1 m.
    size: u8,
    place: [i8; 2],
    velocity: i8,
    disabled: bool,
    collider_disabled: bool,
    friction: Option<u8>,
}

impl Spec {
    fn place(&self) -> (Transform, Position) {
        let [x, y] = self.place.map(|c| f32::from(c) * 0.4);
        let position = Vector::X * Scalar::from(x) + Vector::Y * Scalar::from(y);
        (Transform::from_xyz(x, y, 0.0), Position(position))
    }

    fn velocity(&self) -> LinearVelocity {
        LinearVelocity(Vector::X * Scalar::from(self.velocity))
    }

    fn collider(&self) -> Collider {
        let half = 0.1 * Scalar::from(self.size);
        let mut corners = vec![Vector::ZERO];
        for axis in Vector::AXES {
            corners = corners.iter().flat_map(|c| [*c - axis * half, *c + axis * half]).collect();
        }
        Collider::convex_hull(corners).expect("a box is convex")
    }

    fn spawn(&self, world: &mut World) -> Entity {
        let mut entity = world.spawn((self.collider(), self.place()));
        if let Some(body) = self.body {
            entity.insert((body, self.velocity()));
        }
        if self.disabled {
            entity.insert(RigidBodyDisabled);
        }
        if self.collider_disabled {
            entity.insert(ColliderDisabled);
        }
        if let Some(friction) = self.friction {
            entity.insert(Friction::new(Scalar::from(friction) * 0.25));
        }
        entity.id()
    }

    /// Changes an entity from the state `old` to this state, component by component.
    fn change(&self, old: &Self, entity: &mut EntityWorldMut) {
        if self.body != old.body || self.velocity != old.velocity {
            match self.body {
                Some(body) => _ = entity.insert((body, self.velocity())),
                None => _ = entity.remove::<RigidBody>(),
            }
        }
        if self.size != old.size {
            entity.insert(self.collider());
        }
        if self.place != old.place {
            entity.insert(self.place());
        }
        toggle::<RigidBodyDisabled>(entity, self.disabled);
        toggle::<ColliderDisabled>(entity, self.collider_disabled);
        match self.friction {
            Some(friction) => _ = entity.insert(Friction::new(Scalar::from(friction) * 0.25)),
            None => _ = entity.remove::<Friction>(),
        }
    }
}

/// Inserts a component or removes it.
fn toggle<C: Component + Default>(entity: &mut EntityWorldMut, wanted: bool) {
    match wanted {
        true => _ = entity.insert(C::default()),
        false => _ = entity.remove::<C>(),
    }
}

fn spec() -> impl Strategy<Value = Spec> {
    let kinds = prop_oneof![
        1 => Just(None),
        1 => Just(Some(RigidBody::Static)),
        1 => Just(Some(RigidBody::Kinematic)),
        5 => Just(Some(RigidBody::Dynamic)),
    ];
    let rarely = || prop::bool::weighted(0.1);
    (kinds, 2..5u8, [-6..6i8, 1..12i8], -2..3i8, rarely(), rarely(), prop::option::of(0..6u8)).prop_map(
        |(body, size, place, velocity, disabled, collider_disabled, friction)| Spec {
            body,
            size,
            place,
            velocity,
            disabled,
            collider_disabled,
            friction,
        },
    )
}

/// An operation while physics is paused.
#[derive(Clone, Debug)]
enum Change {
    /// Spawns into a free slot, or changes the entity there.
    Put(usize, Spec),
    Despawn(usize),
    Frame,
}

const SLOTS: usize = 12;

fn changes() -> impl Strategy<Value = Vec<Change>> {
    let change = prop_oneof![
        6 => (0..SLOTS, spec()).prop_map(|(slot, spec)| Change::Put(slot, spec)),
        3 => (0..SLOTS).prop_map(Change::Despawn),
        3 => Just(Change::Frame),
    ];
    prop::collection::vec(change, 1..120)
}

fn app() -> App {
    let mut app = App::new();
    app.add_plugins((TaskPoolPlugin::default(), TransformPlugin, PhysicsPlugins::new(Update)))
        .insert_resource(SubstepCount(2));
    app.finish();
    app.cleanup();
    app.world_mut().spawn((RigidBody::Static, Collider::half_space(Vector::Y)));
    app.world_mut().resource_mut::<Time<Physics>>().pause();
    app
}

/// Position, rotation and velocities after a second, of entities that have them.
fn run(app: &mut App, entities: &[Entity]) -> Vec<String> {
    app.world_mut().resource_mut::<Time<Physics>>().unpause();
    for _ in 0..60 {
        app.world_mut().resource_mut::<Time>().advance_by(Duration::from_millis(16));
        app.update();
    }
    let show = |entity: &Entity| {
        let of = app.world().entity(*entity);
        let pose = (of.get::<Position>(), of.get::<Rotation>());
        // An entity that is not a body has a velocity only if it was a body.
        let moves = of.get::<RigidBody>().map(|_| (of.get::<LinearVelocity>(), of.get::<AngularVelocity>()));
        // Floats are printed with enough digits to be unique.
        format!("{pose:?} {moves:?} {}", of.contains::<Sleeping>())
    };
    entities.iter().map(show).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]
    /// Whether the schedule that hosts physics runs meanwhile or not.
    #[test]
    fn changes_while_physics_is_paused_leave_no_trace(changes in changes(), hosted: bool) {
        let mut app = app();
        // By slot, and in the order of spawning.
        let mut living: Vec<(usize, Entity, Spec)> = Vec::new();
        for change in changes {
            match change {
                Change::Put(slot, spec) => {
                    if let Some((_, entity, old)) = living.iter_mut().find(|(held, ..)| *held == slot) {
                        spec.change(old, &mut app.world_mut().entity_mut(*entity));
                        *old = spec;
                    } else {
                        living.push((slot, spec.spawn(app.world_mut()), spec));
                    }
                }
                Change::Despawn(slot) => {
                    if let Some(i) = living.iter().position(|(held, ..)| *held == slot) {
                        app.world_mut().despawn(living.remove(i).1);
                    }
                }
                Change::Frame if hosted => app.update(),
                Change::Frame => {}
            }
        }
        let entities: Vec<Entity> = living.iter().map(|(_, entity, _)| *entity).collect();
        let mut fresh = self::app();
        let twins: Vec<Entity> = living.iter().map(|(.., spec)| spec.spawn(fresh.world_mut())).collect();
        prop_assert_eq!(run(&mut app, &entities), run(&mut fresh, &twins));
    }
}
