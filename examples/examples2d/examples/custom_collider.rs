//! A collider type of the app: circles that compute their own contacts, without parry. 200 of them fall into a bowl of larger
//! ones. The colour tells how hard a circle is pushed by others.
//!
//! `cargo run --release -p examples2d --example custom_collider`

use avian2d::{math::*, prelude::*};
use bevy::prelude::*;
use examples2d::Scenery;

/// On the screen.
const HINT: &str = "Circles of a collider type of the app. The color tells how hard a circle is pushed.";

fn main() {
    App::new()
        .add_plugins((
            DefaultPlugins,
            // The default collider stays out of this app.
            PhysicsPlugins::default()
                .build()
                .disable::<ColliderBackendPlugin<Collider>>()
                .disable::<NarrowPhasePlugin<Collider>>(),
            ColliderBackendPlugin::<CircleCollider>::default(),
            ColliderTreePlugin::<CircleCollider>::default(),
            NarrowPhasePlugin::<CircleCollider>::default(),
            Scenery::default().with_hint(HINT),
        ))
        .add_systems(Startup, setup)
        .add_systems(Update, paint)
        .run();
}

#[derive(Component)]
struct CircleCollider {
    radius: Scalar,
}

impl AnyCollider for CircleCollider {
    // No other data is needed.
    type Context = ();

    fn aabb_with_context(
        &self,
        position: Vector,
        _: impl Into<Rotation>,
        _: AabbContext<Self::Context>,
    ) -> ColliderAabb {
        ColliderAabb::new(position, Vector::splat(self.radius))
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
        _: ContactManifoldContext<Self::Context>,
    ) {
        manifolds.clear();
        let apart = position2 - position1;
        let penetration = self.radius + other.radius - apart.length();
        if penetration > -prediction_distance {
            let normal = apart.normalize_or(Vector::Y);
            let (anchor1, anchor2) = (normal * self.radius, -normal * other.radius);
            let middle = (position1 + anchor1).midpoint(position2 + anchor2);
            let point = ContactPoint::new(anchor1, anchor2, middle, penetration);
            manifolds.push(ContactManifold::new([point], normal));
        }
    }
}

impl ScalableCollider for CircleCollider {
    fn scale(&self) -> Vector {
        Vector::ONE
    }

    fn set_scale(&mut self, _: Vector, _: u32) {}
}

impl ComputeMassProperties2d for CircleCollider {
    fn mass(&self, density: f32) -> f32 {
        Circle::new(self.radius).mass(density)
    }

    fn unit_angular_inertia(&self) -> f32 {
        Circle::new(self.radius).unit_angular_inertia()
    }

    fn center_of_mass(&self) -> Vec2 {
        Vec2::ZERO
    }
}

fn paint(
    circles: Query<(Entity, &MeshMaterial2d<ColorMaterial>, &RigidBody)>,
    collisions: Collisions,
    mut materials: ResMut<Assets<ColorMaterial>>,
) {
    for (entity, material, body) in &circles {
        if let Some(mut material) = materials.get_mut(&material.0).filter(|_| body.is_dynamic()) {
            let load: f32 =
                collisions.collisions_with(entity).map(|pair| pair.total_normal_impulse_magnitude()).sum();
            material.color = Color::hsl(200.0 - 180.0 * (load / 0.2).min(1.0), 0.7, 0.55);
        }
    }
}

fn setup(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<ColorMaterial>>,
) {
    let mut spawn = |body: RigidBody, radius: f32, x: f32, y: f32| {
        commands.spawn((
            body,
            CircleCollider { radius },
            Transform::from_xyz(x, y, 0.0),
            Mesh2d(meshes.add(Circle::new(radius))),
            MeshMaterial2d(materials.add(Color::srgb(0.35, 0.4, 0.45))),
        ));
    };
    for i in -12..=12 {
        let x = i as f32;
        spawn(RigidBody::Static, 1.0, x, 0.04 * x * x - 1.0);
    }
    for i in 0..200 {
        spawn(RigidBody::Dynamic, 0.2, (i % 20) as f32 * 0.5 - 4.75, 2.0 + (i / 20) as f32 * 0.5);
    }
}
