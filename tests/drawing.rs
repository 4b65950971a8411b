//! Debug drawing, read from the buffers of gizmos in headless apps.

use avian::{
    math::{Scalar, Vector},
    prelude::*,
};
use bevy_app::prelude::*;
use bevy_asset::{Assets, Handle};
use bevy_camera::visibility::{InheritedVisibility, Visibility};
use bevy_color::{Color, LinearRgba};
use bevy_ecs::prelude::*;
use bevy_gizmos::{GizmoHandles, prelude::*};
use bevy_math::Vec3;
use bevy_mesh::Mesh3d;
use bevy_time::{Time, TimePlugin, TimeUpdateStrategy};
use bevy_transform::{TransformPlugin, components::Transform};
use core::{any::TypeId, time::Duration};

const RED: Color = Color::srgb(1.0, 0.0, 0.0);
const GREEN: Color = Color::srgb(0.0, 1.0, 0.0);

/// An app that draws what is given.
fn app(gizmos: PhysicsGizmos) -> App {
    let mut app = App::new();
    app.add_plugins((
        TaskPoolPlugin::default(),
        TransformPlugin,
        PhysicsPlugins::new(Update),
        PhysicsDebugPlugin,
    ));
    app.insert_gizmo_config(gizmos, GizmoConfig::default());
    app
}

fn frame(app: &mut App) {
    app.world_mut().resource_mut::<Time>().advance_by(Duration::from_secs_f64(1.0 / 60.0));
    app.update();
}

/// The points drawn in the last frame, with their colors.
fn drawn(app: &App) -> Vec<(Vec3, LinearRgba)> {
    let handles = app.world().resource::<GizmoHandles>().handles();
    let Some(handle) = handles[&TypeId::of::<PhysicsGizmos>()].clone() else { return Vec::new() };
    let asset = app.world().resource::<Assets<GizmoAsset>>().get(&handle).expect("the handle is in use");
    let view = asset.buffer().buffer();
    let strips = view.strip_positions.iter().copied().zip(view.strip_colors.iter().copied());
    strips.filter(|(point, _)| !point.is_nan()).collect()
}

/// The middle of the drawn points.
fn middle(app: &App) -> Vec3 {
    let points = drawn(app);
    let (low, high) =
        points.iter().fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(l, h), (p, _)| (l.min(*p), h.max(*p)));
    (low + high) / 2.0
}

fn cube(half: Scalar) -> Collider {
    let mut corners = vec![Vector::ZERO];
    for axis in Vector::AXES {
        corners = corners.iter().flat_map(|c| [*c - axis * half, *c + axis * half]).collect();
    }
    Collider::convex_hull(corners).expect("a box is convex")
}

fn spawn_body(app: &mut App, at: f32) -> Entity {
    app.world_mut()
        .spawn((
            RigidBody::Kinematic,
            LinearVelocity(Vector::X * 6.0),
            cube(0.5),
            Transform::from_xyz(at, 2.0, 0.0),
        ))
        .id()
}

#[test]
fn outlines_are_where_the_meshes_of_the_frame_are() {
    let mut app = app(PhysicsGizmos::colliders(RED));
    let body = spawn_body(&mut app, 1.0);
    for i in 0..20 {
        frame(&mut app);
        let at = app.world().get::<Transform>(body).unwrap().translation;
        assert!((middle(&app) - at).length() < 1.0e-5, "frame {i}: {} for {at}", middle(&app));
    }
    // What the app moves after physics is drawn there in the same frame.
    app.add_systems(PreUpdate, |mut bodies: Query<&mut Transform>| {
        bodies.iter_mut().for_each(|mut transform| transform.translation.y = 5.0);
    });
    frame(&mut app);
    assert!((middle(&app).y - 5.0).abs() < 1.0e-5);
}

#[test]
fn what_is_off_or_gone_is_not_drawn() {
    let mut app = app(PhysicsGizmos::colliders(RED));
    let body = spawn_body(&mut app, 1.0);
    frame(&mut app);
    let count = drawn(&app).len();
    assert!(count > 4);
    assert!(drawn(&app).iter().all(|(_, color)| *color == LinearRgba::from(RED)));

    app.world_mut().entity_mut(body).insert(ColliderDisabled);
    frame(&mut app);
    assert_eq!(drawn(&app).len(), 0);
    app.world_mut().entity_mut(body).remove::<ColliderDisabled>();
    frame(&mut app);
    assert_eq!(drawn(&app).len(), count);

    app.world_mut().resource_mut::<GizmoConfigStore>().config_mut::<PhysicsGizmos>().0.enabled = false;
    frame(&mut app);
    assert_eq!(drawn(&app).len(), 0);
    app.world_mut().resource_mut::<GizmoConfigStore>().config_mut::<PhysicsGizmos>().0.enabled = true;
    app.world_mut().entity_mut(body).despawn();
    frame(&mut app);
    assert_eq!(drawn(&app).len(), 0);
}

#[test]
fn a_changed_collider_gets_a_new_outline() {
    let mut app = app(PhysicsGizmos::colliders(RED));
    let body = spawn_body(&mut app, 0.0);
    frame(&mut app);
    let width = |app: &App| {
        let x: Vec<f32> = drawn(app).iter().map(|(point, _)| point.x).collect();
        x.iter().copied().fold(f32::MIN, f32::max) - x.iter().copied().fold(f32::MAX, f32::min)
    };
    assert!((width(&app) - 1.0).abs() < 1.0e-4);
    *app.world_mut().get_mut::<Collider>(body).unwrap() = cube(1.5);
    frame(&mut app);
    assert!((width(&app) - 3.0).abs() < 1.0e-4);
    // A new entity in the place of the old one.
    app.world_mut().entity_mut(body).despawn();
    app.world_mut().spawn((cube(0.25), Transform::default()));
    frame(&mut app);
    assert!((width(&app) - 0.5).abs() < 1.0e-4);
}

#[test]
fn debug_render_replaces_the_settings_of_the_group() {
    let mut app = app(PhysicsGizmos::none());
    let body = spawn_body(&mut app, 0.0);
    frame(&mut app);
    assert_eq!(drawn(&app).len(), 0);
    app.world_mut().entity_mut(body).insert(DebugRender::collider(GREEN));
    frame(&mut app);
    assert!(
        drawn(&app).iter().all(|(_, color)| *color == LinearRgba::from(GREEN)) && !drawn(&app).is_empty()
    );
    app.world_mut().entity_mut(body).insert(DebugRender::axes(Vector::splat(2.0)));
    frame(&mut app);
    assert_eq!(drawn(&app).len(), 2 * Vector::AXES.len());
    app.world_mut().entity_mut(body).insert(DebugRender::aabb(GREEN));
    frame(&mut app);
    assert!(drawn(&app).len() >= 5);
    app.world_mut().entity_mut(body).insert(DebugRender::none());
    frame(&mut app);
    assert_eq!(drawn(&app).len(), 0);
}

#[test]
fn sleeping_bodies_are_darker() {
    let mut app = app(PhysicsGizmos::default().without_axes());
    app.insert_resource(Gravity(Vector::ZERO));
    app.world_mut().spawn((RigidBody::Dynamic, cube(0.5), Transform::default()));
    frame(&mut app);
    let awake = drawn(&app)[0].1;
    for _ in 0..200 {
        frame(&mut app);
    }
    let asleep = drawn(&app)[0].1;
    assert!(asleep.red < 0.5 * awake.red, "{asleep:?} for {awake:?}");
}

#[test]
fn contact_normals_are_as_long_as_the_force() {
    let scale = 0.1;
    let mut app =
        app(PhysicsGizmos::contact_normals(RED).with_contact_normal_scale(ContactGizmoScale::Scaled(scale)));
    app.insert_resource(Gravity(Vector::NEG_Y * 10.0));
    app.world_mut().spawn((RigidBody::Static, cube(10.0), Transform::from_xyz(0.0, -10.0, 0.0)));
    app.world_mut().spawn((
        RigidBody::Dynamic,
        cube(0.5),
        Mass(1.5),
        SleepingDisabled,
        Transform::from_xyz(0.0, 0.5, 0.0),
    ));
    for _ in 0..120 {
        frame(&mut app);
    }
    // An arrow is a shaft, and a line to its tip from each side.
    let points = drawn(&app);
    let lines = if Vector::AXES.len() == 2 { 3 } else { 5 };
    let shafts = points.chunks(2 * lines).map(|arrow| arrow[0].0.distance(arrow[1].0));
    let sum: f32 = shafts.sum();
    assert!((sum - 15.0 * scale as f32).abs() < 0.02 * sum, "{sum} m for 15 N");
}

#[test]
fn normals_of_heavy_loads_are_a_metre_long() {
    for (limit, unit, longest) in [(Some(1.0), 1.0, 1.0), (Some(0.5), 2.0, 1.0), (None, 1.0, 25.0)] {
        let mut app = app(PhysicsGizmos::contact_normals(RED).with_max_contact_normal_length(limit));
        assert_eq!(PhysicsGizmos::default().max_contact_normal_length, Some(1.0));
        app.insert_resource(Gravity(Vector::NEG_Y * 10.0));
        app.insert_resource(avian::dynamics::solver::PhysicsLengthUnit(unit));
        app.world_mut().spawn((RigidBody::Static, cube(10.0), Transform::from_xyz(0.0, -10.0, 0.0)));
        let block = (RigidBody::Dynamic, cube(0.5), Transform::from_xyz(0.0, 0.5, 0.0));
        app.world_mut().spawn((block, Mass(400.0), SleepingDisabled));
        (0..60).for_each(|_| frame(&mut app));
        let lines = if Vector::AXES.len() == 2 { 3 } else { 5 };
        let points = drawn(&app);
        let shafts = points.chunks(2 * lines).map(|arrow| arrow[0].0.distance(arrow[1].0));
        let most = shafts.fold(0.0, f32::max);
        assert!(most > longest * 0.99 && (limit.is_none() || most < 1.001), "{limit:?}: {most} m");
    }
}

/// The color of the outlines within 1 m of a place on the X axis.
fn color_at(app: &App, x: f32) -> LinearRgba {
    let near = |point: &Vec3| (point.x - x).abs() < 1.0;
    let mut colors: Vec<_> =
        drawn(app).iter().filter(|(point, _)| near(point)).map(|(_, color)| *color).collect();
    colors.dedup();
    assert_eq!(colors.len(), 1, "one color at {x}");
    colors[0]
}

#[test]
fn outlines_tell_what_a_collider_is() {
    let spawn = |app: &mut App| {
        app.insert_resource(Gravity(Vector::ZERO));
        let world = app.world_mut();
        let at = |x: f32| Transform::from_xyz(x, 0.0, 0.0);
        world.spawn((RigidBody::Dynamic, cube(0.5), at(0.0), SleepingDisabled));
        world.spawn((RigidBody::Kinematic, cube(0.5), at(5.0), LinearVelocity(Vector::Y)));
        world.spawn((RigidBody::Static, cube(0.5), at(10.0)));
        world.spawn((cube(0.5), at(15.0)));
        world.spawn((RigidBody::Static, cube(0.5), at(20.0), Sensor));
        world.spawn((RigidBody::Static, cube(0.5), at(25.0), DebugRender::collider(GREEN)));
        (0..3).for_each(|_| frame(app));
    };
    let gizmos = PhysicsGizmos::default;
    let color = |color: Option<Color>| LinearRgba::from(color.expect("a default"));
    let mut app = app(gizmos().without_axes());
    spawn(&mut app);
    let all = [0.0, 5.0, 10.0, 15.0, 20.0].map(|x| color_at(&app, x));
    let kinds = [gizmos().collider_color, gizmos().kinematic_color, gizmos().static_color];
    let [dynamic, kinematic, fixed] = kinds.map(color);
    assert_eq!(all, [dynamic, kinematic, fixed, fixed, color(gizmos().sensor_color)]);
    assert!([kinematic, fixed, all[4]].iter().all(|color| *color != dynamic) && kinematic != fixed);
    assert_eq!(color_at(&app, 25.0), GREEN.into(), "its own");
    // One color that the app chose is that of all.
    let mut app = self::app(gizmos().without_axes().with_collider_color(RED));
    spawn(&mut app);
    assert!([0.0, 5.0, 10.0, 15.0, 20.0].iter().all(|x| color_at(&app, *x) == RED.into()));
    let mut app = self::app(gizmos().without_axes().without_colliders());
    spawn(&mut app);
    assert!(drawn(&app).iter().all(|(point, _)| (point.x - 25.0).abs() < 1.0), "only its own");
}

#[test]
fn casts_contacts_islands_and_trees_are_drawn() {
    let gizmos = [
        PhysicsGizmos::none().with_raycast_colors(Some(RED), Some(RED), Some(RED)),
        PhysicsGizmos::none().with_shapecast_colors(Some(RED), Some(RED), Some(RED), Some(RED)),
        PhysicsGizmos { island_color: Some(RED), ..PhysicsGizmos::none() },
        PhysicsGizmos { collider_tree_color: Some(RED), ..PhysicsGizmos::none() },
        PhysicsGizmos::contact_points(RED),
        PhysicsGizmos::aabbs(RED),
        PhysicsGizmos::axes(Vector::ONE),
        PhysicsGizmos::all(),
    ];
    for (i, gizmos) in gizmos.into_iter().enumerate() {
        let mut app = app(gizmos);
        app.world_mut().spawn((RigidBody::Static, cube(10.0), Transform::from_xyz(0.0, -10.0, 0.0)));
        for x in 0..3 {
            let at = Transform::from_xyz(x as f32 * 2.0, 0.499, 0.0);
            app.world_mut().spawn((RigidBody::Dynamic, cube(0.5), at));
        }
        let down = avian::math::Dir::NEG_Y;
        app.world_mut().spawn((Transform::from_xyz(1.0, 5.0, 0.0), RayCaster::new(Vector::ZERO, down)));
        app.world_mut().spawn((
            Transform::from_xyz(1.0, 5.0, 0.0),
            ShapeCaster::new(cube(0.2), Vector::ZERO, Default::default(), down),
        ));
        for _ in 0..3 {
            frame(&mut app);
        }
        let points = drawn(&app);
        assert!(!points.is_empty(), "nothing is drawn for the settings {i}");
        assert!(points.iter().all(|(point, _)| point.is_finite()));
    }
}

/// A hinge at a post draws the ways from the bodies to the anchor, the gap between the anchors,
/// and its range.
#[test]
fn joints_are_drawn_with_their_anchors_gap_and_limits() {
    let mut app = app(PhysicsGizmos::joints(Some(GREEN), Some(RED)));
    app.insert_resource(Gravity(Vector::ZERO));
    let world = app.world_mut();
    let post = world.spawn((RigidBody::Static, Transform::from_xyz(1.0, 0.0, 0.0))).id();
    let door = world.spawn((RigidBody::Static, Transform::from_xyz(4.0, 0.0, 0.0))).id();
    let hinge =
        RevoluteJoint::new(post, door).with_local_anchor1(Vector::X).with_local_anchor2(Vector::NEG_X);
    let hinge = world.spawn(hinge).id();
    frame(&mut app);
    frame(&mut app);
    let has = |app: &App, at: f32, color: Color| {
        let near = |point: Vec3| point.distance(Vec3::X * at) < 1e-5;
        drawn(app).iter().any(|(point, drawn)| near(*point) && *drawn == color.into())
    };
    for (at, color) in [(1.0, GREEN), (2.0, GREEN), (4.0, GREEN), (3.0, GREEN), (2.0, RED), (3.0, RED)] {
        assert!(has(&app, at, color), "{at} m, {color:?}");
    }
    let without = drawn(&app).len();
    app.world_mut().get_mut::<RevoluteJoint>(hinge).expect("a hinge").angle_limit = Some((-1.0, 1.0).into());
    frame(&mut app);
    assert!(drawn(&app).len() > without + 10, "its range is drawn");
    app.world_mut().entity_mut(hinge).insert(JointDisabled);
    frame(&mut app);
    assert!(drawn(&app).is_empty(), "it is off");
    // Other joints, and numbers that are not finite.
    app.world_mut().spawn(PrismaticJoint::new(post, door).with_limits(-1.0, 1.0));
    app.world_mut().spawn(DistanceJoint::new(post, door).with_max_distance(5.0));
    app.world_mut().spawn(FixedJoint::new(post, door).with_anchor(Vector::X * 2.0));
    let marks = |app: &App| drawn(app).len();
    let mut before = marks(&app);
    let mut more = |app: &mut App, what: &str| {
        frame(app);
        frame(app);
        assert!(marks(app) > before, "{what} draws nothing");
        before = marks(app);
    };
    more(&mut app, "a slider");
    let generic = GenericJoint::new(post, door).with_local_anchor1(Vector::X);
    app.world_mut().spawn(generic.with_limits(JointCoordinate::Y, -1.0, Scalar::INFINITY));
    more(&mut app, "a generic joint");
    app.world_mut().spawn(WheelJoint::new(post, door).with_suspension_limits(-0.2, 0.2));
    more(&mut app, "a wheel");
    app.world_mut().spawn((MouseJoint::new(door), Transform::from_xyz(0.0, 1.0, 0.0)));
    more(&mut app, "a mouse joint");
    app.world_mut().spawn(PulleyJoint::new(post, door, [Vector::Y, Vector::Y * 2.0]));
    more(&mut app, "a pulley");
    app.world_mut().spawn(GearJoint::new(post, door));
    more(&mut app, "a gear");
    app.world_mut().spawn(PulleyJoint::new(post, door, [Vector::NAN, Vector::Y]));
    app.world_mut()
        .spawn(PrismaticJoint::new(post, door).with_slider_axis(Vector::NAN).with_limits(0.0, 1.0));
    app.world_mut().spawn(RevoluteJoint::new(post, door).with_local_anchor1(Vector::NAN));
    app.world_mut().spawn(RevoluteJoint::new(post, door).with_angle_limits(Scalar::NAN, Scalar::INFINITY));
    frame(&mut app);
    assert!(drawn(&app).len() > 10 && drawn(&app).iter().all(|(point, _)| point.is_finite()));
}

#[test]
fn meshes_are_hidden_and_shown_again() {
    let mut app = app(PhysicsGizmos::default());
    let mut spawn = |visibility| {
        app.world_mut().spawn((cube(0.5), Transform::default(), Mesh3d(Handle::default()), visibility)).id()
    };
    let meshes = [spawn(Visibility::Inherited), spawn(Visibility::Visible), spawn(Visibility::Hidden)];
    let seen = |app: &App| meshes.map(|mesh| *app.world().get::<Visibility>(mesh).unwrap());
    let before = seen(&app);
    let hide = |app: &mut App, hides| {
        app.world_mut().resource_mut::<GizmoConfigStore>().config_mut::<PhysicsGizmos>().1.hide_meshes =
            hides;
        frame(app);
    };
    hide(&mut app, true);
    assert_eq!(seen(&app), [Visibility::Hidden; 3]);
    hide(&mut app, false);
    assert_eq!(seen(&app), before);
    app.world_mut().entity_mut(meshes[0]).insert(DebugRender::default().with_mesh_visibility(false));
    frame(&mut app);
    assert_eq!(seen(&app)[0], Visibility::Hidden);
    app.world_mut().entity_mut(meshes[0]).remove::<DebugRender>();
    frame(&mut app);
    assert_eq!(seen(&app), before);
}

#[test]
fn what_the_app_hides_is_not_drawn() {
    let mut app = app(PhysicsGizmos::colliders(RED).with_mesh_visibility(false));
    let mesh = (cube(0.5), Transform::default(), Mesh3d(Handle::default()), Visibility::Visible);
    let body = app.world_mut().spawn(mesh).id();
    let is_drawn = |app: &mut App, visibility: InheritedVisibility| {
        // As Bevy propagates it.
        app.world_mut().entity_mut(body).insert(visibility);
        frame(app);
        !drawn(app).is_empty()
    };
    // Its mesh is hidden by the settings, and its outline drawn instead.
    assert!(
        is_drawn(&mut app, InheritedVisibility::VISIBLE) && is_drawn(&mut app, InheritedVisibility::HIDDEN)
    );
    app.world_mut().resource_mut::<GizmoConfigStore>().config_mut::<PhysicsGizmos>().1.hide_meshes = false;
    frame(&mut app);
    assert!(
        is_drawn(&mut app, InheritedVisibility::VISIBLE) && !is_drawn(&mut app, InheritedVisibility::HIDDEN)
    );
    // The app had hidden it before the settings did.
    app.world_mut().entity_mut(body).insert(Visibility::Hidden);
    app.world_mut().resource_mut::<GizmoConfigStore>().config_mut::<PhysicsGizmos>().1.hide_meshes = true;
    frame(&mut app);
    assert!(!is_drawn(&mut app, InheritedVisibility::HIDDEN));
}

#[test]
fn the_group_is_there_when_the_plugin_is_built_and_without_physics() {
    let mut app = App::new();
    app.add_plugins((TaskPoolPlugin::default(), PhysicsDebugPlugin));
    let mut store = app.world_mut().resource_mut::<GizmoConfigStore>();
    assert_eq!(store.config_mut::<PhysicsGizmos>().1.axis_lengths, Some(Vector::splat(0.5)));
    app.update();
    app.update();
}

#[test]
fn systems_of_the_app_draw_without_the_plugin() {
    let mut app = App::new();
    app.add_plugins((TaskPoolPlugin::default(), TransformPlugin, PhysicsPlugins::new(Update)));
    app.init_resource::<Assets<GizmoAsset>>().init_gizmo_group::<PhysicsGizmos>();
    app.add_systems(Update, |mut gizmos: Gizmos<PhysicsGizmos>| {
        gizmos.draw_line(Vector::ZERO, Vector::X, RED);
        gizmos.draw_arrow(Vector::ZERO, Vector::Y, 0.1, RED);
        gizmos.draw_line_strip(vec![Vector::X, Vector::Y], Vector::ONE, Rotation::default(), true, RED);
        gizmos.draw_polyline(
            &[Vector::X, Vector::Y],
            &[[0, 1], [1, 7]],
            Vector::ONE,
            Rotation::default(),
            RED,
        );
        gizmos.draw_collider(&cube(0.5), Vector::ONE, Rotation::default(), RED);
    });
    frame(&mut app);
    assert!(drawn(&app).len() > 10 && drawn(&app).iter().all(|(point, _)| point.is_finite()));
}

#[test]
fn values_that_are_not_finite_draw_nothing_and_harm_nothing() {
    let mut app = App::new();
    app.add_plugins((TaskPoolPlugin::default(), TransformPlugin, PhysicsPlugins::new(Update)));
    app.init_resource::<Assets<GizmoAsset>>().init_gizmo_group::<PhysicsGizmos>();
    app.add_systems(Update, |mut gizmos: Gizmos<PhysicsGizmos>| {
        for bad in [Scalar::NAN, Scalar::INFINITY, Scalar::MAX] {
            let v = Vector::splat(bad);
            gizmos.draw_line(Vector::ZERO, v, RED);
            gizmos.draw_arrow(v, Vector::ZERO, bad, RED);
            gizmos.draw_arrow(Vector::ZERO, Vector::ZERO, bad, RED);
            gizmos.draw_collider(&cube(0.5), v, Rotation::default(), RED);
            gizmos.draw_raycast(v, avian::math::Dir::X, bad, &[], RED, RED, RED, bad);
            gizmos.draw_line_strip(vec![], v, Rotation::default(), true, RED);
        }
    });
    frame(&mut app);
    frame(&mut app);
}

/// The outline has the scale once, and mirrors as the mesh does.
#[test]
fn a_scaled_and_mirrored_collider_is_drawn_where_its_points_are() {
    let corners = [[0.2, 0.1, 0.0], [1.0, 0.3, 0.1], [0.4, 0.9, -0.2], [0.3, 0.4, 0.8]];
    let hull = corners.map(|c| Vector::from_array(core::array::from_fn(|i| c[i] as Scalar)));
    for sign in 0..8 {
        let factor = |axis: i32, size: f32| if sign >> axis & 1 == 1 { -size } else { size };
        let deep = if Vector::AXES.len() == 2 { 1.0 } else { factor(2, 0.5) };
        let transform = Transform::from_xyz(3.0, -2.0, 0.0)
            .with_scale(Vec3::new(factor(0, 2.0), factor(1, 3.0), deep))
            .with_rotation(bevy_math::Quat::from_rotation_z(0.7));
        let mut app = app(PhysicsGizmos::colliders(RED));
        let collider = Collider::convex_hull(hull.to_vec()).expect("a hull");
        app.world_mut().spawn((RigidBody::Static, collider, transform));
        frame(&mut app);
        frame(&mut app);
        let drawn = drawn(&app);
        let expected = hull.map(|corner| {
            let mut local = [0.0; 3];
            local.iter_mut().zip(corner.to_array()).for_each(|(to, from)| *to = from as f32);
            transform.transform_point(Vec3::from_array(local))
        });
        let is_corner = |at: Vec3| expected.iter().any(|corner| corner.distance(at) < 1.0e-3);
        assert!(
            !drawn.is_empty() && drawn.iter().all(|(at, _)| is_corner(*at)),
            "{sign}: {drawn:?} {expected:?}"
        );
    }
}

/// As in Avian's example `bvh`: neither narrow phase nor solver.
#[test]
fn trees_are_drawn_where_plugins_are_added_one_by_one() {
    fn by_default<P: Plugin + Default>() -> P {
        P::default()
    }
    let mut app = App::new();
    app.add_plugins((TaskPoolPlugin::default(), TimePlugin, TransformPlugin)).add_plugins((
        PhysicsSchedulePlugin::default(),
        PhysicsTransformPlugin::default(),
        MassPropertyPlugin::default(),
        ColliderHierarchyPlugin,
        ColliderTransformPlugin::default(),
        ColliderBackendPlugin::<Collider>::default(),
        ColliderTreePlugin::<Collider>::default(),
        BroadPhaseCorePlugin,
        BvhBroadPhasePlugin::<()>::default(),
        SpatialQueryPlugin::default(),
        by_default::<PhysicsDebugPlugin>(),
    ));
    app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs(1) / 64));
    let gizmos = PhysicsGizmos { collider_tree_color: Some(RED), ..PhysicsGizmos::none() };
    app.insert_gizmo_config(gizmos, GizmoConfig::default());
    app.finish();
    app.cleanup();
    for x in [3.0, 5.0] {
        app.world_mut().spawn((RigidBody::Kinematic, cube(0.5), Transform::from_xyz(x, 2.0, 0.0)));
    }
    (0..4).for_each(|_| app.update());
    assert!(!drawn(&app).is_empty());
}
