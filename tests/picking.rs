//! Picking as apps do it: a camera, a pointer in its viewport, and events on entities with colliders.

use super::picking_dim::shape;
use avian::prelude::*;
use bevy_app::prelude::*;
use bevy_camera::{Camera, ComputedCameraValues, NormalizedRenderTarget, RenderTarget, RenderTargetInfo};
use bevy_ecs::prelude::*;
use bevy_math::{Mat4, UVec2, Vec2, Vec3};
use bevy_picking::{
    InteractionPlugin, Pickable, PickingPlugin,
    backend::{HitData, PointerHits, ray::RayMap},
    events::{Click, Over, Pointer},
    pointer::{Location, PointerAction, PointerButton, PointerId, PointerInput, PointerLocation},
};
use bevy_time::Time;
use bevy_transform::{
    TransformPlugin,
    components::{GlobalTransform, Transform},
};
use bevy_window::{PrimaryWindow, Window};
use core::time::Duration;

/// Pixels along each side of the viewport.
const SIZE: u32 = 200;

/// What observers saw.
#[derive(Resource, Default)]
pub struct Seen {
    over: Vec<Entity>,
    clicks: Vec<Entity>,
}

/// An app with physics, picking and a pointer in the middle of the viewport.
pub fn app() -> App {
    let mut app = App::new();
    app.add_plugins((
        TaskPoolPlugin::default(),
        TransformPlugin,
        PhysicsPlugins::new(Update),
        PickingPlugin,
        InteractionPlugin,
        PhysicsPickingPlugin,
    ));
    app.insert_resource(Gravity::ZERO).init_resource::<Seen>();
    app.add_observer(|over: On<Pointer<Over>>, mut seen: ResMut<Seen>| {
        seen.over.push(over.original_event_target());
    });
    app.add_observer(|click: On<Pointer<Click>>, mut seen: ResMut<Seen>| {
        seen.clicks.push(click.original_event_target());
    });
    app.world_mut().spawn((Window::default(), PrimaryWindow));
    app.world_mut().spawn((PointerId::Mouse, PointerLocation::new(location(middle()))));
    app.finish();
    app.cleanup();
    app
}

fn middle() -> Vec2 {
    Vec2::splat(SIZE as f32 / 2.0)
}

fn location(position: Vec2) -> Location {
    Location { target: NormalizedRenderTarget::None { width: SIZE, height: SIZE }, position }
}

/// A perspective that sees 90 degrees.
pub fn perspective() -> Mat4 {
    Mat4::perspective_infinite_reverse_rh(core::f32::consts::FRAC_PI_2, 1.0, 0.1)
}

/// The components of a camera.
pub fn camera(pose: Transform, clip_from_view: Mat4) -> impl Bundle {
    let computed = ComputedCameraValues {
        clip_from_view,
        target_info: Some(RenderTargetInfo { physical_size: UVec2::splat(SIZE), scale_factor: 1.0 }),
        ..Default::default()
    };
    let target = RenderTarget::None { size: UVec2::splat(SIZE) };
    (Camera { computed, ..Default::default() }, target, pose, GlobalTransform::from(pose))
}

/// A camera 10 m above the plane, which looks down.
pub fn spawn_camera(app: &mut App) -> Entity {
    app.world_mut().spawn(camera(Transform::from_xyz(0.0, 0.0, 10.0), perspective())).id()
}

/// Moves the pointer by metres on the plane z = 0 below that camera.
pub fn point_at(app: &mut App, x: f32, y: f32) {
    let pixels_per_metre = SIZE as f32 / 20.0;
    let at = location(middle() + Vec2::new(x, -y) * pixels_per_metre);
    let mut pointers = app.world_mut().query::<&mut PointerLocation>();
    pointers.single_mut(app.world_mut()).expect("one pointer").location = Some(at);
}

pub fn frame(app: &mut App) {
    app.world_mut().resource_mut::<Time>().advance_by(Duration::from_millis(16));
    app.update();
}

/// What was picked in a frame, nearest first.
pub fn picked(app: &mut App) -> Vec<(Entity, HitData)> {
    app.world_mut().resource_mut::<Messages<PointerHits>>().clear();
    frame(app);
    let hits: Vec<_> = app.world_mut().resource_mut::<Messages<PointerHits>>().drain().collect();
    let mut picks: Vec<_> = hits.into_iter().flat_map(|hits| hits.picks).collect();
    picks.sort_by(|(_, a), (_, b)| a.depth.total_cmp(&b.depth));
    picks
}

/// The entities of [`picked`].
pub fn entities(app: &mut App) -> Vec<Entity> {
    picked(app).into_iter().map(|(entity, _)| entity).collect()
}

pub fn at(x: f32, y: f32, z: f32) -> Transform {
    Transform::from_xyz(x, y, z)
}

#[test]
fn the_collider_below_the_pointer_gets_events() {
    let mut app = app();
    spawn_camera(&mut app);
    let left = app.world_mut().spawn((RigidBody::Static, shape(), at(-2.0, 0.0, 0.0))).id();
    let right = app.world_mut().spawn((RigidBody::Dynamic, shape(), at(2.0, 1.0, 0.0))).id();
    frame(&mut app);
    point_at(&mut app, -2.0, 0.0);
    frame(&mut app);
    point_at(&mut app, 2.0, 1.0);
    frame(&mut app);
    for action in
        [PointerAction::Press(PointerButton::Primary), PointerAction::Release(PointerButton::Primary)]
    {
        let mut pointers = app.world_mut().query::<&PointerLocation>();
        let at = pointers.single(app.world()).unwrap().location.clone().unwrap();
        app.world_mut().write_message(PointerInput::new(PointerId::Mouse, at, action));
        frame(&mut app);
    }
    let seen = app.world().resource::<Seen>();
    let mut over = seen.over.clone();
    over.dedup();
    assert!(over.ends_with(&[left, right]), "{over:?}");
    assert_eq!(seen.clicks.first(), Some(&right));
    let taken = app.world().resource::<avian::picking::PhysicsPickingDiagnostics>();
    assert!(taken.update_hits > Duration::ZERO);
}

#[test]
fn nothing_is_picked_beside_a_collider() {
    let mut app = app();
    let camera = spawn_camera(&mut app);
    let body = app.world_mut().spawn((RigidBody::Static, shape(), Transform::default())).id();
    frame(&mut app);
    let found = picked(&mut app);
    assert_eq!((found[0].0, found[0].1.camera), (body, camera));
    // Sides of 1 m.
    point_at(&mut app, 0.4, 0.0);
    assert_eq!(entities(&mut app), [body]);
    point_at(&mut app, 0.6, 0.0);
    assert_eq!(entities(&mut app), []);
    // An inactive pointer has no location.
    let mut pointers = app.world_mut().query::<&mut PointerLocation>();
    pointers.single_mut(app.world_mut()).unwrap().location = None;
    assert_eq!(entities(&mut app), []);
}

/// Colliders are seen as they are, though physics took no step since.
#[test]
fn bodies_are_picked_while_physics_is_paused() {
    let mut app = app();
    spawn_camera(&mut app);
    frame(&mut app);
    app.world_mut().resource_mut::<Time<Physics>>().pause();
    let body = app.world_mut().spawn((RigidBody::Static, shape(), Transform::default())).id();
    frame(&mut app);
    assert_eq!(entities(&mut app), [body]);
    app.world_mut().entity_mut(body).insert(ColliderDisabled);
    assert_eq!(entities(&mut app), []);
    app.world_mut().entity_mut(body).remove::<ColliderDisabled>();
    assert_eq!(entities(&mut app), [body]);
    app.world_mut().despawn(body);
    assert_eq!(entities(&mut app), []);
}

/// Two colliders above each other: the upper one comes first, whatever the order of spawning.
#[test]
fn what_is_nearer_to_the_camera_is_picked_first() {
    for upper_first in [false, true] {
        let mut app = app();
        spawn_camera(&mut app);
        let z = if upper_first { [2.0, 0.0] } else { [0.0, 2.0] };
        let glass = Pickable { should_block_lower: false, is_hoverable: true };
        let both =
            z.map(|z| app.world_mut().spawn((RigidBody::Static, shape(), at(0.0, 0.0, z), glass)).id());
        frame(&mut app);
        let upper = both[if upper_first { 0 } else { 1 }];
        let found = entities(&mut app);
        assert_eq!((found.len(), found[0]), (2, upper));
        let mut observed = app.world().resource::<Seen>().over.clone();
        observed.sort();
        observed.dedup();
        assert_eq!(observed.len(), 2, "glass lets the lower one be hovered");
        // Opaque, the upper one hides the lower.
        app.world_mut().entity_mut(upper).remove::<Pickable>();
        app.world_mut().resource_mut::<Seen>().over.clear();
        point_at(&mut app, 5.0, 0.0);
        frame(&mut app);
        point_at(&mut app, 0.0, 0.0);
        frame(&mut app);
        assert_eq!(app.world().resource::<Seen>().over, [upper]);
        // What is ignored does not hide.
        app.world_mut().entity_mut(upper).insert(Pickable::IGNORE);
        let lower = both[if upper_first { 1 } else { 0 }];
        assert_eq!(entities(&mut app), [lower]);
        // What only hides does.
        let shade = Pickable { should_block_lower: true, is_hoverable: false };
        app.world_mut().entity_mut(upper).insert(shade);
        app.world_mut().resource_mut::<Seen>().over.clear();
        point_at(&mut app, 5.0, 0.0);
        frame(&mut app);
        point_at(&mut app, 0.0, 0.0);
        frame(&mut app);
        assert_eq!(app.world().resource::<Seen>().over, []);
    }
}

#[test]
fn markers_are_required_of_cameras_and_targets() {
    let mut app = app();
    let camera = spawn_camera(&mut app);
    let body = app.world_mut().spawn((RigidBody::Static, shape(), Transform::default())).id();
    app.world_mut().resource_mut::<PhysicsPickingSettings>().require_markers = true;
    frame(&mut app);
    assert_eq!(entities(&mut app), []);
    app.world_mut().entity_mut(body).insert(PhysicsPickable);
    assert_eq!(entities(&mut app), []);
    app.world_mut().entity_mut(camera).insert(PhysicsPickable);
    assert_eq!(entities(&mut app), [body]);
    app.world_mut().entity_mut(body).remove::<PhysicsPickable>();
    assert_eq!(entities(&mut app), []);
}

#[test]
fn cameras_filter_what_they_pick() {
    let mut app = app();
    let camera = spawn_camera(&mut app);
    let layers = CollisionLayers::new([LayerMask(2)], LayerMask::ALL);
    let body = app.world_mut().spawn((RigidBody::Static, shape(), Transform::default(), layers)).id();
    frame(&mut app);
    let mut with = |filter: PhysicsPickingFilter| {
        app.world_mut().entity_mut(camera).insert(filter);
        entities(&mut app)
    };
    assert_eq!(with(PhysicsPickingFilter::default()), [body]);
    assert_eq!(with(PhysicsPickingFilter::from_mask(LayerMask(1))), []);
    assert_eq!(with(PhysicsPickingFilter::from_mask(LayerMask(2))), [body]);
    assert_eq!(with(PhysicsPickingFilter::from_excluded_entities([body])), []);
    let nothing = PhysicsPickingFilter::from_mask(LayerMask(2)).with_excluded_entities([body]);
    assert_eq!(with(nothing.clone()), []);
    assert_eq!(with(nothing.with_excluded_entities([]).with_mask(LayerMask(3))), [body]);
}

/// The events of a child collider are those of the child, and bubble to its body.
#[test]
fn child_colliders_are_picked() {
    let mut app = app();
    spawn_camera(&mut app);
    let body = app.world_mut().spawn((RigidBody::Dynamic, Transform::default())).id();
    let child = app.world_mut().spawn((shape(), at(3.0, 0.0, 0.0), ChildOf(body))).id();
    frame(&mut app);
    point_at(&mut app, 3.0, 0.0);
    assert_eq!(entities(&mut app), [child]);
}

/// Cameras that are inactive, gone or bad, rays that are not finite, and apps without Bevy's
/// picking or physics.
#[test]
fn bad_rays_pick_nothing() {
    let mut app = app();
    let camera = spawn_camera(&mut app);
    app.world_mut().spawn((RigidBody::Static, shape(), Transform::default()));
    frame(&mut app);
    assert_eq!(entities(&mut app).len(), 1);
    app.world_mut().get_mut::<Camera>(camera).unwrap().is_active = false;
    assert_eq!(entities(&mut app), []);
    app.world_mut().get_mut::<Camera>(camera).unwrap().is_active = true;
    app.world_mut().entity_mut(camera).insert(at(f32::NAN, 0.0, 10.0));
    frame(&mut app);
    assert_eq!(entities(&mut app), []);
    app.world_mut().entity_mut(camera).insert(at(f32::MAX, 0.0, f32::MAX));
    frame(&mut app);
    assert_eq!(entities(&mut app), []);
    app.world_mut().despawn(camera);
    assert_eq!(entities(&mut app), []);

    let mut bare = App::new();
    bare.add_plugins((
        TaskPoolPlugin::default(),
        TransformPlugin,
        PhysicsPlugins::new(Update),
        PhysicsPickingPlugin,
    ));
    bare.update();
    assert!(bare.world().get_resource::<RayMap>().is_none());
    let mut bare = App::new();
    bare.add_plugins((TaskPoolPlugin::default(), PickingPlugin, PhysicsPickingPlugin));
    bare.world_mut().spawn((Window::default(), PrimaryWindow));
    bare.update();
    bare.update();
}

/// The points of two cameras, of which the upper one is drawn later, are told with its order.
#[test]
fn hits_have_the_order_of_the_camera() {
    let mut app = app();
    let camera = spawn_camera(&mut app);
    app.world_mut().get_mut::<Camera>(camera).unwrap().order = 7;
    app.world_mut().spawn((RigidBody::Static, shape(), Transform::default()));
    frame(&mut app);
    app.world_mut().resource_mut::<Messages<PointerHits>>().clear();
    frame(&mut app);
    let hits: Vec<_> = app.world_mut().resource_mut::<Messages<PointerHits>>().drain().collect();
    let hits: Vec<_> = hits.iter().filter(|hits| !hits.picks.is_empty() && hits.order == 7.0).collect();
    assert_eq!(hits.len(), 1);
    assert_eq!(hits[0].picks[0].1.position.map(|p: Vec3| p.truncate()), Some(Vec2::ZERO));
}
