//! A constraint of the app's own: soft ropes, which pull where they are stretched. Look at the weights: a heavier one stretches its
//! rope further, and all three swing without losing their ropes.
//!
//! `cargo run --release -p examples2d --example custom_constraint`

use avian2d::{
    dynamics::{joints::EntityConstraint, solver::constraint::*},
    prelude::*,
};
use bevy::{ecs::entity::MapEntities, prelude::*};
use examples2d::Scenery;

/// On the screen.
const HINT: &str = "Ropes are a constraint of this example: the heavier a weight, the longer its rope.";

fn main() {
    App::new()
        .add_plugins((DefaultPlugins, PhysicsPlugins::default(), Scenery::default().with_hint(HINT)))
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
    ends: [Vec2; 2],
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
    fn stretched(&self, bodies: &[ConstraintBody; 2]) -> ([Vec2; 2], Vec2, f32) {
        let arms = [bodies[0].arm_of(self.ends[0]), bodies[1].arm_of(self.ends[1])];
        let offset = ConstraintBody::offset(bodies, arms);
        (arms, offset.normalize_or_zero(), offset.length())
    }
}

fn pull([a, b]: &mut [ConstraintBody; 2], arms: [Vec2; 2], impulse: Vec2) {
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
    mut materials: ResMut<Assets<ColorMaterial>>,
) {
    let beam = commands.spawn((
        RigidBody::Static,
        Collider::rectangle(8.0, 0.2),
        Transform::from_xyz(0.0, 9.0, 0.0),
        Mesh2d(meshes.add(Rectangle::new(8.0, 0.2))),
        MeshMaterial2d(materials.add(Color::srgb(0.5, 0.4, 0.3))),
    ));
    let beam = beam.id();
    for (i, size) in [0.5, 0.7, 0.9].into_iter().enumerate() {
        let x = 2.5 * (i as f32 - 1.0);
        let weight = commands.spawn((
            RigidBody::Dynamic,
            Collider::rectangle(size, size),
            ColliderDensity(20.0),
            // Aside, so that it swings.
            Transform::from_xyz(x + 1.0, 7.0, 0.0),
            Mesh2d(meshes.add(Rectangle::from_length(size))),
            MeshMaterial2d(materials.add(Color::srgb(0.85, 0.45, 0.3))),
        ));
        let bodies = [beam, weight.id()];
        let ends = [Vec2::new(x, -0.1), Vec2::Y * 0.5 * size];
        commands.spawn(Rope { bodies, ends, length: 2.0, stiffness: 120.0, damping: 3.0 });
    }
}

fn draw_ropes(ropes: Query<&Rope>, bodies: Query<&Transform>, mut gizmos: Gizmos) {
    for rope in &ropes {
        if let Ok([a, b]) = bodies.get_many(rope.bodies) {
            let end = |body: &Transform, end: Vec2| body.transform_point(end.extend(0.0)).truncate();
            gizmos.line_2d(end(a, rope.ends[0]), end(b, rope.ends[1]), Color::srgb(0.9, 0.85, 0.6));
        }
    }
}
