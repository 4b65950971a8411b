//! Constraints of the app that the kernel solves.

use super::*;
use avian::{
    dynamics::{joints::EntityConstraint, solver::constraint::*},
    math::Scalar,
};
use bevy_app::{PluginGroup, Update};
use bevy_ecs::{entity::MapEntities, system::SystemState};
use bevy_time::Time;

/// Pulls two points together where they are farther apart than its length.
#[derive(Component, Clone, MapEntities)]
struct Rope {
    #[entities]
    bodies: [Entity; 2],
    anchors: [Vector; 2],
    length: Scalar,
    /// In N/m.
    stiffness: Scalar,
    /// In N·s/m.
    damping: Scalar,
}

impl Rope {
    fn new(a: Entity, b: Entity, length: Scalar) -> Self {
        Self { bodies: [a, b], anchors: [Vector::ZERO; 2], length, stiffness: 500.0, damping: 20.0 }
    }
}

impl EntityConstraint<2> for Rope {
    fn entities(&self) -> [Entity; 2] {
        self.bodies
    }
}

impl Constraint for Rope {
    type Rows = Scalar;

    fn prepare(&self, _: &[ConstraintBody; 2], _: &ConstraintStep, last: Option<&Scalar>) -> Scalar {
        last.copied().unwrap_or_default()
    }

    fn warm_start(&self, impulse: &mut Scalar, bodies: &mut [ConstraintBody; 2], step: &ConstraintStep) {
        *impulse *= step.warm_start;
        let (arms, direction, _) = self.now(bodies);
        push(bodies, direction * *impulse, arms);
    }

    fn solve(
        &self,
        impulse: &mut Scalar,
        bodies: &mut [ConstraintBody; 2],
        step: &ConstraintStep,
        use_bias: bool,
    ) {
        if !use_bias {
            return;
        }
        let (arms, n, length) = self.now(bodies);
        let h = step.delta;
        let give = h * (self.damping + h * self.stiffness);
        let bias = (length - self.length) * h * self.stiffness / give;
        let speed = n.dot(bodies[1].velocity_at(arms[1]) - bodies[0].velocity_at(arms[0]));
        let mass = bodies[0].inverse_mass_along(n, arms[0]) + bodies[1].inverse_mass_along(n, arms[1]);
        let old = *impulse;
        *impulse = (old - (speed + bias + old / give) / (mass + 1.0 / give)).min(0.0);
        push(bodies, n * (*impulse - old), arms);
    }
}

impl Rope {
    fn now(&self, bodies: &[ConstraintBody; 2]) -> ([Vector; 2], Vector, Scalar) {
        let arms = [bodies[0].arm_of(self.anchors[0]), bodies[1].arm_of(self.anchors[1])];
        let offset = ConstraintBody::offset(bodies, arms);
        (arms, offset.normalize_or_zero(), offset.length())
    }
}

fn push([a, b]: &mut [ConstraintBody; 2], impulse: Vector, arms: [Vector; 2]) {
    a.apply_impulse(-impulse, arms[0]);
    b.apply_impulse(impulse, arms[1]);
}

fn rig_with_ropes() -> Rig {
    Rig::with(PhysicsPlugins::new(Update).build().add(ConstraintPlugin::<Rope>::default()))
}

/// The impulse of a rope in the last substep, in N·s.
fn impulse(rig: &mut Rig, rope: Entity) -> Option<Scalar> {
    let world = rig.app.world_mut();
    let mut state = SystemState::<ConstraintRows<Rope>>::new(world);
    state.get(world).expect("the plugin is there").get(rope).copied()
}

#[test]
fn a_rope_holds_a_weight() {
    let mut rig = rig_with_ropes();
    let (post, rod) = (rig.post(0.0, 0.0), rig.rod(0.0, -1.0));
    let rope = rig.spawn(Rope::new(post, rod, 1.0));
    assert_eq!(impulse(&mut rig, rope), None);
    // It would sleep before it hangs still.
    rig.insert(rod, SleepingDisabled);
    rig.steps(640);
    let stretch = -rig.place(rod).y - 1.0;
    assert!((stretch / (MASS * G / 500.0) - 1.0).abs() < 1e-2, "{stretch}");
    let force = -impulse(&mut rig, rope).expect("it acts") * 8.0 / DT;
    assert!((force / (MASS * G) - 1.0).abs() < 1e-2, "{force}");
    // The weight sleeps on its rope; a change wakes it.
    rig.remove::<SleepingDisabled>(rod);
    rig.steps(64);
    assert!(rig.sleeps(rod));
    rig.app.world_mut().get_mut::<Rope>(rope).expect("a rope").length = 2.0;
    rig.steps(1);
    assert!(!rig.sleeps(rod));
    rig.steps(320);
    assert!((rig.place(rod).y + 2.0 + MASS * G / 500.0).abs() < 1e-2);
}

#[test]
fn ropes_keep_momentum_and_pull_what_sleeps() {
    let mut rig = rig_with_ropes();
    rig.app.insert_resource(Gravity::ZERO);
    let rods = [0.0, 1.0, 2.0].map(|x| rig.rod(x, 0.0));
    for pair in rods.windows(2) {
        let anchors = [Vector::Y * 0.3, Vector::Y * -0.3];
        rig.spawn(Rope { anchors, ..Rope::new(pair[0], pair[1], 1.2) });
    }
    rig.steps(80);
    assert!(rods.iter().all(|rod| rig.sleeps(*rod)));
    rig.insert(rods[0], LinearVelocity(Vector::X * -3.0));
    rig.step();
    assert!(rods.iter().all(|rod| !rig.sleeps(*rod)), "they are in one island");
    rig.steps(120);
    let sum = momentum(&rig, &rods);
    assert!((sum - Vector::X * (-3.0 * MASS)).length() < 1e-4, "{sum}");
    assert!(rig.get::<LinearVelocity>(rods[2]).x < -0.1, "the last one is pulled along");
}

#[test]
fn a_rope_follows_its_bodies() {
    let mut rig = rig_with_ropes();
    let [post, rod, rope] = core::array::from_fn(|_| rig.spawn(()));
    // Before its bodies.
    rig.insert(rope, Rope::new(post, rod, 1.0));
    rig.step();
    rig.insert(rod, (super::super::joints_dim::rod(), at(0.0, -1.0)));
    rig.step();
    rig.insert(post, (RigidBody::Static, at(0.0, 0.0)));
    rig.steps(64);
    let hangs = |rig: &Rig, rod: Entity| rig.place(rod).y > -1.5;
    assert!(hangs(&rig, rod));
    // Off and on.
    rig.insert(rope, JointDisabled);
    rig.steps(2);
    assert_eq!(impulse(&mut rig, rope), None);
    rig.remove::<JointDisabled>(rope);
    rig.steps(64);
    assert!(hangs(&rig, rod));
    // A body that is out for a while, in and out within a step, and of another type.
    rig.insert(rod, RigidBodyDisabled);
    rig.steps(2);
    rig.remove::<RigidBodyDisabled>(rod);
    rig.steps(2);
    rig.remove::<RigidBody>(rod);
    rig.insert(rod, RigidBody::Dynamic);
    rig.steps(64);
    assert!(hangs(&rig, rod) && impulse(&mut rig, rope).is_some());
    for body in [RigidBody::Static, RigidBody::Kinematic, RigidBody::Dynamic] {
        rig.insert(rod, body);
        rig.steps(2);
    }
    // To another body, to one twice, to none.
    let other = rig.rod(0.3, -1.0);
    rig.app.world_mut().get_mut::<Rope>(rope).expect("a rope").bodies[1] = other;
    rig.steps(64);
    assert!(hangs(&rig, other) && !hangs(&rig, rod));
    for ends in [[other, other], [other, Entity::PLACEHOLDER], [rope, other]] {
        rig.app.world_mut().get_mut::<Rope>(rope).expect("a rope").bodies = ends;
        rig.steps(2);
        assert_eq!(impulse(&mut rig, rope), None);
    }
    rig.app.world_mut().get_mut::<Rope>(rope).expect("a rope").bodies = [post, other];
    rig.step();
    rig.app.world_mut().resource_mut::<Time<Physics>>().pause();
    rig.steps(3);
    rig.despawn(other);
    rig.app.world_mut().resource_mut::<Time<Physics>>().unpause();
    rig.steps(3);
    let last = rig.rod(0.0, -1.0);
    rig.app.world_mut().get_mut::<Rope>(rope).expect("a rope").bodies[1] = last;
    rig.steps(3);
    rig.despawn(rope);
    rig.steps(32);
    assert!(rig.get::<LinearVelocity>(last).y < -4.0, "it falls");
}

#[test]
fn what_is_not_finite_is_ignored() {
    let mut rig = rig_with_ropes();
    let (post, rod) = (rig.post(0.0, 0.0), rig.rod(0.0, -1.0));
    rig.spawn(Rope { stiffness: Scalar::NAN, ..Rope::new(post, rod, 0.5) });
    let good = rig.spawn(Rope::new(post, rod, 1.0));
    rig.steps(64);
    assert!(rig.place(rod).is_finite() && impulse(&mut rig, good).is_some_and(Scalar::is_finite));
}
