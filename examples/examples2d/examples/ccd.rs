//! Continuous collision, four modes side by side. Look at the balls that are shot at spinning bars, and at the counts below:
//! without prediction and sweep most fly through. Space changes the speed of the balls, Enter that of the bars.
//!
//! `cargo run --release -p examples2d --example ccd`

use avian2d::prelude::*;
use bevy::prelude::*;
use examples2d::Scenery;

/// On the screen.
const HINT: &str = "Balls are shot at spinning bars. Without prediction and sweep many fly through.
Space: speed of the balls. Enter: speed of the bars.";

fn main() {
    App::new().add_plugins((DefaultPlugins, plugin)).run();
}

pub(crate) fn plugin(app: &mut App) {
    app.add_plugins((PhysicsPlugins::default(), Scenery::default().with_hint(HINT)))
        .insert_resource(Gravity(Vec2::ZERO))
        .insert_resource(Speeds { ball: 100.0, bar: 25.0 })
        .add_systems(Startup, setup)
        .add_systems(Update, (change_speeds, draw_trails))
        .add_systems(FixedUpdate, (shoot, remove_far));
}

/// Speed of new balls in m/s, and of the bars in rad/s.
#[derive(Resource)]
struct Speeds {
    ball: f32,
    bar: f32,
}

#[derive(Component)]
struct Bar;

/// A ball, with the mode of its column.
#[derive(Component)]
struct Bullet(usize);

/// The text below a column.
#[derive(Component)]
struct Label(usize);

#[derive(Resource)]
struct Look(Handle<Mesh>, Handle<ColorMaterial>);

/// Of a ball, in metres.
const RADIUS: f32 = 0.12;

/// The modes, with the place of each.
const MODES: [(&str, f32); 4] =
    [("neither", -9.0), ("speculative (default)", -3.0), ("swept, linear", 3.0), ("swept, non-linear", 9.0)];

/// Gives a bar or ball the mode of its column.
fn set_mode(body: &mut EntityCommands, mode: usize) {
    match mode {
        0 => body.insert(SpeculativeMargin::ZERO),
        1 => body,
        2 => body.insert((SpeculativeMargin::ZERO, SweptCcd::LINEAR)),
        _ => body.insert((SpeculativeMargin::ZERO, SweptCcd::NON_LINEAR)),
    };
}

fn shoot(mut commands: Commands, look: Res<Look>, speeds: Res<Speeds>, mut steps: Local<u32>) {
    *steps += 1;
    if !steps.is_multiple_of(6) {
        return;
    }
    for (mode, (_, x)) in MODES.into_iter().enumerate() {
        let mut ball = commands.spawn((
            Bullet(mode),
            RigidBody::Dynamic,
            Collider::circle(RADIUS),
            LinearVelocity(Vec2::new(0.0, -speeds.ball)),
            Transform::from_xyz(x + 0.03 * (*steps % 60) as f32 - 0.9, 11.0, 0.0),
            Mesh2d(look.0.clone()),
            MeshMaterial2d(look.1.clone()),
        ));
        set_mode(&mut ball, mode);
    }
}

/// Removes balls that have left the screen. Those that were hit have left their vertical line.
fn remove_far(
    mut commands: Commands,
    balls: Query<(Entity, &Bullet, &Position, &LinearVelocity)>,
    mut counts: Local<[(u32, u32); 4]>,
    mut labels: Query<(&Label, &mut Text2d)>,
) {
    for (ball, Bullet(mode), position, velocity) in &balls {
        if position.y < -3.0 || position.length() > 20.0 {
            commands.entity(ball).despawn();
            counts[*mode].0 += u32::from(velocity.x != 0.0);
            counts[*mode].1 += 1;
        }
    }
    for (Label(mode), mut text) in &mut labels {
        text.0 = format!("{}\n{} of {} hit", MODES[*mode].0, counts[*mode].0, counts[*mode].1);
    }
}

/// A line along the way of a tick.
fn draw_trails(balls: Query<(&Position, &LinearVelocity), With<Bullet>>, mut gizmos: Gizmos) {
    for (position, velocity) in &balls {
        gizmos.line_2d(position.0 - velocity.0 / 64.0, position.0, Color::srgb(0.6, 0.4, 0.2));
    }
}

fn change_speeds(
    keys: Res<ButtonInput<KeyCode>>,
    mut speeds: ResMut<Speeds>,
    mut bars: Query<&mut AngularVelocity, With<Bar>>,
) {
    if keys.just_pressed(KeyCode::Space) {
        speeds.ball = if speeds.ball < 400.0 { 2.0 * speeds.ball } else { 25.0 };
    }
    if keys.just_pressed(KeyCode::Enter) {
        speeds.bar = if speeds.bar < 40.0 { speeds.bar + 5.0 } else { 0.0 };
        bars.iter_mut().for_each(|mut spin| spin.0 = speeds.bar);
    }
}

fn setup(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<ColorMaterial>>,
) {
    let (bar, grey) = (meshes.add(Rectangle::new(4.0, 0.04)), materials.add(Color::srgb(0.6, 0.65, 0.7)));
    for (mode, (_, x)) in MODES.into_iter().enumerate() {
        commands.spawn((
            Label(mode),
            Text2d::default(),
            Transform::from_xyz(x, -1.0, 0.0).with_scale(Vec3::splat(0.02)),
        ));
        let mut body = commands.spawn((
            Bar,
            RigidBody::Kinematic,
            Collider::rectangle(4.0, 0.04),
            AngularVelocity(25.0),
            Transform::from_xyz(x, 5.0, 0.0),
            Mesh2d(bar.clone()),
            MeshMaterial2d(grey.clone()),
        ));
        if mode != 1 {
            body.insert(SpeculativeMargin::ZERO);
        }
    }
    commands
        .insert_resource(Look(meshes.add(Circle::new(RADIUS)), materials.add(Color::srgb(0.9, 0.6, 0.2))));
}
