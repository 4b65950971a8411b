//! A constraint of the app's own: soft ropes, which pull where they are stretched. Look at the weights: a heavier one stretches its
//! rope further, and all three swing without losing their ropes.
//!
//! `cargo run --release -p examples3d --example custom_constraint`

use avian3d::{
    dynamics::{joints::EntityConstraint, solver::constraint::*},
    prelude::*,
};
use bevy::{ecs::entity::MapEntities, prelude::*};
use examples3d::Scenery;

/// On the screen.
const HINT: &str = "Ropes are a constraint of this example: the heavier a weight, the longer its rope.";

fn main() {
    let scenery =
        Scenery::new(Vec3::new(2.0, 4.5, 12.0), Vec3::new(0.0, 3.0, 0.0)).with_floor().with_hint(HINT);
    App::new()
        .add_plugins((DefaultPlugins, PhysicsPlugins::default(), scenery))
        .add_plugins(ConstraintPlugin::<Rope>::default())
        .add_systems(Startup, hang_weights)
        .add_systems(Update, draw_ropes)
        .run();
}

/// A rope between two bodies. It pulls where it is stretched, as a spring with damping.
#[derive(Component, Clone, MapEntities)]
struct Rope {
    #[entities]
    bodies: [Entity; 2],
    /// Its ends, in the frames of the bodies.
    ends: [Vec3; 2],
    length: f32,
    /// In N/m.
    stiffness: f32,
    /// In N·s/m.
    damping: f32,
}

impl EntityConstraint<2> for Rope {
    fn entities(&self) -> [Entity; 2] {
        self.bodies
    }
}

impl Rope {
    /// The arms of the ends, the direction from the first to the second, and their distance.
    fn stretched(&self, bodies: &[ConstraintBody; 2]) -> ([Vec3; 2], Vec3, f32) {
        let arms = [bodies[0].arm_of(self.ends[0]), bodies[1].arm_of(self.ends[1])];
        let offset = ConstraintBody::offset(bodies, arms);
        (arms, offset.normalize_or_zero(), offset.length())
    }
}

fn pull([a, b]: &mut [ConstraintBody; 2], arms: [Vec3; 2], impulse: Vec3) {
    a.apply_impulse(-impulse, arms[0]);
    b.apply_impulse(impulse, arms[1]);
}

impl Constraint for Rope {
    /// The impulse of a substep along the rope, negative where it pulls.
    type Rows = f32;

    fn prepare(&self, _: &[ConstraintBody; 2], _: &ConstraintStep, last: Option<&f32>) -> f32 {
        last.copied().unwrap_or(0.0)
    }

    fn warm_start(&self, impulse: &mut f32, bodies: &mut [ConstraintBody; 2], step: &ConstraintStep) {
        *impulse *= step.warm_start;
        let (arms, direction, _) = self.stretched(bodies);
        pull(bodies, arms, direction * *impulse);
    }

    /// λ = −h (k x + c v), with length and speed after the substep. So it is stable however stiff.
    fn solve(
        &self,
        impulse: &mut f32,
        bodies: &mut [ConstraintBody; 2],
        step: &ConstraintStep,
        use_bias: bool,
    ) {
        if !use_bias {
            return;
        }
        let (arms, direction, length) = self.stretched(bodies);
        let [a, b] = &*bodies;
        let speed = direction.dot(b.velocity_at(arms[1]) - a.velocity_at(arms[0]));
        let inverse_mass =
            a.inverse_mass_along(direction, arms[0]) + b.inverse_mass_along(direction, arms[1]);
        let give = step.delta * (self.damping + step.delta * self.stiffness);
        let force = step.delta * self.stiffness * (length - self.length);
        let last = *impulse;
        *impulse = (last - (last + give * speed + force) / (1.0 + give * inverse_mass)).min(0.0);
        pull(bodies, arms, direction * (*impulse - last));
    }
}

fn hang_weights(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let beam = commands.spawn((
        RigidBody::Static,
        Collider::cuboid(8.0, 0.2, 0.4),
        Transform::from_xyz(0.0, 7.0, 0.0),
        Mesh3d(meshes.add(Cuboid::new(8.0, 0.2, 0.4))),
        MeshMaterial3d(materials.add(Color::srgb(0.5, 0.4, 0.3))),
    ));
    let beam = beam.id();
    for (i, size) in [0.5, 0.7, 0.9].into_iter().enumerate() {
        let x = 2.5 * (i as f32 - 1.0);
        let weight = commands.spawn((
            RigidBody::Dynamic,
            Collider::cuboid(size, size, size),
            ColliderDensity(20.0),
            // Aside, so that it swings.
            Transform::from_xyz(x, 5.0, 1.5),
            Mesh3d(meshes.add(Cuboid::from_length(size))),
            MeshMaterial3d(materials.add(Color::srgb(0.85, 0.45, 0.3))),
        ));
        let bodies = [beam, weight.id()];
        let ends = [Vec3::new(x, -0.1, 0.0), Vec3::Y * 0.5 * size];
        commands.spawn(Rope { bodies, ends, length: 2.0, stiffness: 120.0, damping: 3.0 });
    }
}

fn draw_ropes(ropes: Query<&Rope>, bodies: Query<&Transform>, mut gizmos: Gizmos) {
    for rope in &ropes {
        if let Ok([a, b]) = bodies.get_many(rope.bodies) {
            let [start, end] = [a.transform_point(rope.ends[0]), b.transform_point(rope.ends[1])];
            gizmos.line(start, end, Color::srgb(0.9, 0.85, 0.6));
        }
    }
}
