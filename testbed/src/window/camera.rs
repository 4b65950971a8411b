//! The camera: rotate, pan, zoom.

use bevy::ecs::system::SystemParam;
use bevy::input::mouse::{AccumulatedMouseMotion, AccumulatedMouseScroll, MouseScrollUnit};
use bevy::prelude::*;

use super::stage::Stage;

/// Vertical field of view in radians.
const FIELD_OF_VIEW: f32 = 0.6;

/// The camera, relative to its target.
#[derive(Resource, Default)]
pub struct Orbit {
    /// Index of the scene that it was placed for.
    scene: Option<usize>,
    target: Vec3,
    yaw: f32,
    pitch: f32,
    distance: f32,
    flat: bool,
}

impl Orbit {
    fn backward(&self) -> Vec3 {
        let (sin, cos) = self.pitch.sin_cos();
        Vec3::new(self.yaw.sin() * cos, sin, self.yaw.cos() * cos)
    }

    /// The initial camera of the running scene: all of its bounds in view.
    fn reset(&mut self, stage: &Stage) {
        let Some(entry) = stage.entry() else { return };
        self.scene = Some(stage.chosen);
        let (min, max) = (entry.view.min, entry.view.max);
        let half = 0.5 * (max - min);
        self.flat = entry.dimension == 2;
        let eye = if self.flat { Vec3::Z } else { entry.view.eye.normalize_or(Vec3::Z) };
        self.target = 0.5 * (min + max);
        self.yaw = eye.x.atan2(eye.z);
        self.pitch = eye.y.clamp(-1.0, 1.0).asin();
        // The list takes a part of the width, hence not the full aspect ratio.
        let extent =
            if self.flat { half.y.max(half.x / 1.2) } else { half.length().min(1.6 * half.max_element()) };
        self.distance = 1.1 * extent / (0.5 * FIELD_OF_VIEW).tan();
    }
}

/// Camera and sun.
pub fn spawn(mut commands: Commands) {
    let projection = PerspectiveProjection { fov: FIELD_OF_VIEW, far: 5000.0, ..default() };
    commands.spawn((Camera3d::default(), Projection::Perspective(projection)));
    let sun = DirectionalLight { illuminance: 7000.0, shadow_maps_enabled: true, ..default() };
    commands.spawn((sun, Transform::from_xyz(-0.45, 1.0, 0.55).looking_at(Vec3::ZERO, Vec3::Y)));
}

/// Mouse input, and the area under the mouse.
#[derive(SystemParam)]
pub struct Mouse<'w, 's> {
    buttons: Res<'w, ButtonInput<MouseButton>>,
    motion: Res<'w, AccumulatedMouseMotion>,
    scroll: Res<'w, AccumulatedMouseScroll>,
    window: Single<'w, 's, &'static Window>,
    list: Query<'w, 's, &'static Interaction>,
}

/// Rotates with the left button (pans in 2D), pans with the right one, zooms with the wheel. A change of the
/// scene resets the camera, a restart of the same does not.
pub fn read_mouse(
    mut orbit: ResMut<Orbit>,
    stage: NonSend<Stage>,
    keys: Res<ButtonInput<KeyCode>>,
    mouse: Mouse,
) {
    if orbit.scene != Some(stage.chosen) || keys.just_pressed(KeyCode::Home) {
        orbit.reset(&stage);
    }
    let lines = match mouse.scroll.unit {
        MouseScrollUnit::Line => mouse.scroll.delta.y,
        MouseScrollUnit::Pixel => mouse.scroll.delta.y / 40.0,
    };
    orbit.distance = (orbit.distance * 0.9f32.powf(lines)).clamp(0.1, 4000.0);
    if mouse.list.iter().any(|interaction| *interaction != Interaction::None) {
        return;
    }
    let shifting =
        mouse.buttons.pressed(MouseButton::Right) || orbit.flat && mouse.buttons.pressed(MouseButton::Left);
    if shifting {
        let backward = orbit.backward();
        let right = Vec3::Y.cross(backward).normalize_or(Vec3::X);
        let up = backward.cross(right);
        let metres = 2.0 * orbit.distance * (0.5 * FIELD_OF_VIEW).tan() / mouse.window.height().max(1.0);
        orbit.target += (up * mouse.motion.delta.y - right * mouse.motion.delta.x) * metres;
    } else if mouse.buttons.pressed(MouseButton::Left) {
        orbit.yaw -= 0.006 * mouse.motion.delta.x;
        orbit.pitch = (orbit.pitch + 0.006 * mouse.motion.delta.y).clamp(-1.5, 1.5);
    }
}

/// Places the camera.
pub fn place(orbit: Res<Orbit>, mut camera: Single<&mut Transform, With<Camera3d>>) {
    let eye = orbit.target + orbit.backward() * orbit.distance;
    **camera = Transform::from_translation(eye).looking_at(orbit.target, Vec3::Y);
}
