//! Constraints of the app that are solved by XPBD, written against the interface of Avian.

use super::*;
use avian::{
    dynamics::{
        joints::EntityConstraint,
        solver::{
            solver_body::{SolverBody, SolverBodyInertia},
            xpbd::*,
        },
    },
    math::Scalar,
    physics_transform::PreSolveDeltaPosition,
};
use bevy_ecs::entity::MapEntities;
use bevy_time::Time;

/// Holds two points of two bodies at a distance.
#[derive(Component, MapEntities)]
#[require(StickData)]
struct Stick {
    #[entities]
    bodies: [Entity; 2],
    anchors: [Vector; 2],
    length: Scalar,
    compliance: Scalar,
}

impl Stick {
    fn new(a: Entity, b: Entity, length: Scalar) -> Self {
        Self { bodies: [a, b], anchors: [Vector::ZERO; 2], length, compliance: 0.0 }
    }
}

#[derive(Component, Default)]
struct StickData {
    arms: [Vector; 2],
    offset: Vector,
    lagrange: Scalar,
    direction: Vector,
}

impl XpbdConstraintSolverData for StickData {
    fn clear_lagrange_multipliers(&mut self) {
        self.lagrange = 0.0;
    }

    fn total_position_lagrange(&self) -> Vector {
        self.direction * self.lagrange
    }
}

impl EntityConstraint<2> for Stick {
    fn entities(&self) -> [Entity; 2] {
        self.bodies
    }
}

impl PositionConstraint for Stick {}

impl XpbdConstraint<2> for Stick {
    type SolverData = StickData;

    fn prepare(&mut self, bodies: [&RigidBodyQueryReadOnlyItem; 2], data: &mut StickData) {
        let [a, b] = bodies;
        data.arms = [
            *a.rotation * (self.anchors[0] - a.center_of_mass.0),
            *b.rotation * (self.anchors[1] - b.center_of_mass.0),
        ];
        let center =
            |body: &RigidBodyQueryReadOnlyItem| body.position.0 + *body.rotation * body.center_of_mass.0;
        data.offset = center(a) - center(b);
    }

    fn solve(
        &mut self,
        bodies: [&mut SolverBody; 2],
        inertias: [&SolverBodyInertia; 2],
        data: &mut StickData,
        dt: Scalar,
    ) {
        let [a, b] = bodies;
        let [r1, r2] = [a.delta_rotation * data.arms[0], b.delta_rotation * data.arms[1]];
        let offset = data.offset + (a.delta_position - b.delta_position) + (r1 - r2);
        let distance = offset.length();
        if distance < 1e-6 {
            return;
        }
        let n = offset / distance;
        data.direction = n;
        let inverse = [(inertias[0], r1), (inertias[1], r2)].map(|(inertia, r)| {
            let mass = inertia.effective_inv_mass().max_element();
            self.compute_generalized_inverse_mass(mass, inertia.effective_inv_angular_inertia(), r, n)
        });
        let update =
            compute_lagrange_update(data.lagrange, distance - self.length, &inverse, self.compliance, dt);
        data.lagrange += update;
        self.apply_positional_impulse(a, b, inertias[0], inertias[1], n * update, r1, r2);
    }
}

fn with_sticks(mut rig: Rig) -> Rig {
    rig.app.add_systems(PhysicsSchedule, prepare_xpbd_joint::<Stick>.in_set(SolverSystems::PrepareJoints));
    rig.app.add_systems(
        SubstepSchedule,
        solve_xpbd_joint::<Stick>.in_set(XpbdSolverSystems::SolveUserConstraints),
    );
    rig
}

#[test]
fn a_stick_holds_a_pendulum() {
    let mut rig = with_sticks(Rig::new());
    let post = rig.post(0.0, 0.0);
    let rod = rig.rod(1.0, 0.0);
    let stick = rig.spawn(Stick::new(post, rod, 1.0));
    let mut lowest: Scalar = 0.0;
    for _ in 0..128 {
        rig.step();
        lowest = lowest.min(rig.place(rod).y);
        let length = rig.place(rod).length();
        assert!((length - 1.0).abs() < 2e-3, "{length}");
    }
    assert!(lowest < -0.99, "it swings: {lowest}");
    let force = rig.get::<StickData>(stick).total_position_lagrange() / (DT / 8.0 * DT / 8.0);
    assert!(force.length() > 1.0 && force.length() < 3.5 * MASS * G, "{force}");
}

#[test]
fn a_soft_stick_stretches_by_its_load() {
    let mut rig = with_sticks(Rig::new());
    let (post, rod) = (rig.post(0.0, 0.0), rig.rod(0.0, -1.0));
    // It would sleep before it hangs still.
    rig.insert(rod, (LinearDamping(4.0), SleepingDisabled));
    rig.spawn(Stick { compliance: 0.01, ..Stick::new(post, rod, 1.0) });
    rig.steps(320);
    let stretch = -rig.place(rod).y - 1.0;
    assert!((stretch / (0.01 * MASS * G) - 1.0).abs() < 1e-2, "{stretch}");
}

#[test]
fn sticks_keep_momentum() {
    let mut rig = with_sticks(Rig::weightless());
    let rods = [0.0, 1.0, 2.0].map(|x| rig.rod(x, 0.0));
    for pair in rods.windows(2) {
        let anchors = [Vector::X * 0.4, Vector::X * -0.4];
        rig.spawn(Stick { anchors, ..Stick::new(pair[0], pair[1], 0.2) });
    }
    rig.insert(rods[0], LinearVelocity(Vector::Y * 2.0));
    rig.steps(128);
    let sum = momentum(&rig, &rods);
    assert!((sum - Vector::Y * 2.0 * MASS).length() < 1e-3, "{sum}");
    assert!(rig.get::<LinearVelocity>(rods[2]).0.length() > 0.05, "the last one is pulled along");
    assert!(rig.app.world().entity(rods[0]).contains::<PreSolveDeltaPosition>());
}

#[test]
fn what_a_stick_holds_sleeps_and_wakes_together() {
    let mut rig = with_sticks(Rig::weightless());
    let rods = [0.0, 1.0].map(|x| rig.rod(x, 0.0));
    let stick = rig.spawn(Stick::new(rods[0], rods[1], 1.0));
    rig.steps(80);
    assert!(rods.iter().all(|rod| rig.sleeps(*rod)));
    assert!(!rig.app.world().entity(rods[0]).contains::<PreSolveDeltaPosition>());
    rig.insert(rods[0], LinearVelocity(Vector::X * -1.0));
    rig.step();
    assert!(rods.iter().all(|rod| !rig.sleeps(*rod)));
    rig.steps(8);
    assert!(rig.get::<LinearVelocity>(rods[1]).x < -0.4, "it is pulled along");
    rig.despawn(stick);
    rig.steps(100);
}

#[test]
fn a_stick_follows_its_bodies() {
    let mut rig = with_sticks(Rig::new());
    let [post, rod, stick] = core::array::from_fn(|_| rig.spawn(()));
    rig.insert(stick, Stick::new(post, rod, 1.0));
    rig.step();
    rig.insert(rod, (super::super::joints_dim::rod(), at(0.0, -1.0)));
    rig.step();
    rig.insert(post, (RigidBody::Static, at(0.0, 0.0)));
    rig.steps(32);
    let hangs = |rig: &Rig| rig.place(rod).length() < 1.1;
    assert!(hangs(&rig));
    for _ in 0..2 {
        rig.insert(stick, JointDisabled);
        rig.steps(2);
        rig.remove::<JointDisabled>(stick);
        rig.insert(rod, RigidBodyDisabled);
        rig.steps(2);
        rig.remove::<RigidBodyDisabled>(rod);
        rig.steps(4);
        assert!(hangs(&rig));
    }
    rig.insert(rod, RigidBody::Static);
    rig.steps(2);
    rig.insert(rod, RigidBody::Kinematic);
    rig.steps(2);
    rig.insert(rod, RigidBody::Dynamic);
    rig.app.world_mut().resource_mut::<Time<Physics>>().pause();
    rig.steps(2);
    rig.app.world_mut().resource_mut::<Time<Physics>>().unpause();
    rig.steps(8);
    assert!(hangs(&rig));
    for ends in [[rod, rod], [Entity::PLACEHOLDER, rod], [rod, stick]] {
        rig.app.world_mut().get_mut::<Stick>(stick).expect("a stick").bodies = ends;
        rig.steps(2);
    }
    rig.app.world_mut().get_mut::<Stick>(stick).expect("a stick").bodies = [rod, post];
    rig.steps(2);
    rig.despawn(post);
    rig.steps(32);
    assert!(rig.get::<LinearVelocity>(rod).y < -3.0, "it falls");
}

#[test]
fn a_dominant_body_is_not_pulled() {
    let mut rig = with_sticks(Rig::weightless());
    let rods = [0.0, 1.0].map(|x| rig.rod(x, 0.0));
    rig.insert(rods[0], Dominance(1));
    rig.insert(rods[1], LinearVelocity(Vector::X));
    rig.spawn(Stick::new(rods[0], rods[1], 1.0));
    rig.steps(16);
    assert_eq!(rig.place(rods[0]), Vector::ZERO);
    assert!((rig.place(rods[1]).x - 1.0).abs() < 2e-3);
}

#[test]
fn aligned_bodies_keep_their_spin() {
    use super::super::users_dim::Align;
    let mut rig = Rig::weightless();
    rig.app.add_systems(PhysicsSchedule, prepare_xpbd_joint::<Align>.in_set(SolverSystems::PrepareJoints));
    rig.app.add_systems(
        SubstepSchedule,
        solve_xpbd_joint::<Align>.in_set(XpbdSolverSystems::SolveUserConstraints),
    );
    let rods = [0.0, 1.0].map(|x| rig.rod(x, 0.0));
    rig.insert(rods[0], super::super::joints::turned(0.2));
    rig.spawn(Align(rods));
    rig.steps(2);
    let spins = rods.map(|rod| rig.spin(rod));
    assert!((rig.angle(rods[0]) - rig.angle(rods[1])).abs() < 1e-3);
    assert!((spins[0] + spins[1]).abs() < 1e-3, "{spins:?}");
}
