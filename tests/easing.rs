//! What the app writes to the `Transform` of an eased body between two ticks, and what is drawn.
//!
//! Twins without easing show where physics should be, and eased twins that nothing writes to show what
//! should be drawn.

use avian::{math::Vector, prelude::*};
use bevy_app::prelude::*;
use bevy_ecs::{
    prelude::*,
    schedule::{Schedules, SingleThreadedExecutor},
};
use bevy_math::{Quat, Vec3};
use bevy_time::{TimePlugin, TimeUpdateStrategy, prelude::*};
use bevy_transform::{
    TransformPlugin,
    components::{GlobalTransform, Transform},
};
use core::time::Duration;
use scenes::dim::{ball, spin};

const RATES: [u32; 4] = [30, 60, 144, 250];
const DIM: usize = Vector::AXES.len();

/// Every kind of easing.
const EASINGS: [fn(&mut EntityWorldMut); 9] = [
    |body| insert(body, TransformInterpolation),
    |body| insert(body, TransformExtrapolation),
    |body| insert(body, TranslationInterpolation),
    |body| insert(body, RotationInterpolation),
    |body| insert(body, ScaleInterpolation),
    |body| insert(body, TranslationExtrapolation),
    |body| insert(body, RotationExtrapolation),
    |body| insert(body, (TransformInterpolation, TransformHermiteEasing)),
    |body| insert(body, (TransformExtrapolation, TransformHermiteEasing)),
];

fn insert(body: &mut EntityWorldMut, bundle: impl Bundle) {
    body.insert(bundle);
}

/// The app writes to this entity.
#[derive(Component)]
struct Written;

/// What is written, given the number of the frame.
#[derive(Resource)]
struct Writes(fn(&mut Transform, u16));

#[derive(Resource, Default)]
struct Frame(u16);

fn nothing(_: &mut Transform, _: u16) {}

fn write(writes: Res<Writes>, frame: Res<Frame>, mut written: Query<&mut Transform, With<Written>>) {
    written.iter_mut().for_each(|mut transform| writes.0(&mut transform, frame.0));
}

/// Where in the frame the app writes.
#[derive(Clone, Copy, Debug)]
enum Place {
    PreUpdate,
    BeforeTicks,
    AfterTicks,
    Update,
    PostUpdate,
}

fn app_with(rate: u32, place: Place, plugins: PhysicsPlugins) -> App {
    let mut app = App::new();
    app.add_plugins((TaskPoolPlugin::default(), TimePlugin, TransformPlugin, plugins))
        .insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs(1) / rate))
        .insert_resource(Writes(nothing))
        .init_resource::<Frame>()
        .add_systems(First, |mut frame: ResMut<Frame>| frame.0 += 1);
    match place {
        Place::PreUpdate => app.add_systems(PreUpdate, write),
        Place::BeforeTicks => {
            app.add_systems(RunFixedMainLoop, write.in_set(RunFixedMainLoopSystems::BeforeFixedMainLoop))
        }
        Place::AfterTicks => app.add_systems(RunFixedMainLoop, write.after(TransformEasingSystems::Ease)),
        Place::Update => app.add_systems(Update, write),
        Place::PostUpdate => app.add_systems(PostUpdate, write),
    };
    app.finish();
    app.cleanup();
    // Handing systems of nearly empty schedules between threads would take most of the time.
    for (_, schedule) in app.world_mut().resource_mut::<Schedules>().iter_mut() {
        schedule.set_executor(SingleThreadedExecutor::new());
    }
    app
}

fn app(rate: u32) -> App {
    app_with(rate, Place::Update, PhysicsPlugins::default())
}

/// A spinning body that is thrown sideways and falls.
fn thrown() -> impl Bundle {
    (RigidBody::Dynamic, LinearVelocity(Vector::X * 3.0), spin(2.0), Transform::from_xyz(1.0, 2.0, 0.0))
}

/// Bodies with the same motion.
#[derive(Clone, Copy)]
struct Twins {
    /// Not eased: the truth.
    bare: Entity,
    /// Eased, and left alone.
    eased: Entity,
    /// Eased, and written to.
    written: Entity,
}

fn spawn(app: &mut App, easing: fn(&mut EntityWorldMut)) -> Twins {
    let world = app.world_mut();
    let bare = world.spawn(thrown()).id();
    let [eased, written] = [(); 2].map(|()| {
        let mut body = world.spawn(thrown());
        easing(&mut body);
        body.id()
    });
    world.entity_mut(written).insert(Written);
    Twins { bare, eased, written }
}

fn get<C: Component + Copy>(app: &App, entity: Entity) -> C {
    *app.world().get::<C>(entity).expect("the component")
}

/// The position, and the rotated x axis.
fn pose(app: &App, entity: Entity) -> (Vector, Vector) {
    (get::<Position>(app, entity).0, get::<Rotation>(app, entity) * Vector::X)
}

impl Twins {
    /// Physics is the same as without easing and writing.
    #[track_caller]
    fn check_motion(&self, app: &App, what: &str) {
        for twin in [self.eased, self.written] {
            assert_eq!(pose(app, twin), pose(app, self.bare), "{what}");
        }
    }

    /// The same is drawn as without writing, on spatial axes.
    #[track_caller]
    fn check_drawn(&self, app: &App, what: &str) {
        let [eased, written] = [self.eased, self.written].map(|twin| get::<Transform>(app, twin));
        let spatial = |t: &Transform| t.translation.to_array()[..2].to_vec();
        assert_eq!(spatial(&written), spatial(&eased), "{what}");
        assert_eq!(written.rotation, eased.rotation, "{what}");
    }
}

fn frames(rate: u32) -> u32 {
    rate / 2
}

/// Values that change with each frame.
fn sorted(transform: &mut Transform, frame: u16) {
    transform.translation.z = f32::from(frame) * 0.01;
}

fn pulsed(transform: &mut Transform, frame: u16) {
    transform.scale = Vec3::splat(1.0 + f32::from(frame % 10) * 0.1);
}

fn turned(transform: &mut Transform, frame: u16) {
    transform.rotation = Quat::from_rotation_z(f32::from(frame) * 0.01);
}

fn sorted_and_pulsed(transform: &mut Transform, frame: u16) {
    sorted(transform, frame);
    pulsed(transform, frame);
}

fn rewritten(transform: &mut Transform, _: u16) {
    transform.scale = Vec3::ONE;
}

#[test]
fn writing_depth_or_scale_of_an_eased_body_changes_neither_its_motion_nor_how_it_is_drawn() {
    for rate in RATES {
        for (index, easing) in EASINGS.into_iter().enumerate() {
            for writes in [sorted, pulsed] {
                let mut app = app(rate);
                let twins = spawn(&mut app, easing);
                app.insert_resource(Writes(writes));
                for frame in 0..frames(rate) {
                    app.update();
                    let what = format!("{rate} fps, easing {index}, frame {frame}");
                    let [bare, written] = [twins.bare, twins.written].map(|twin| pose(&app, twin));
                    // In 3D, z is a spatial axis.
                    assert_eq!(bare.0.to_array()[..2], written.0.to_array()[..2], "{what}");
                    assert_eq!(bare.1, written.1, "{what}");
                    twins.check_drawn(&app, &what);
                }
            }
        }
    }
}

#[test]
fn writing_scale_at_any_place_of_the_frame_changes_no_motion() {
    for place in [Place::PreUpdate, Place::BeforeTicks, Place::AfterTicks, Place::Update, Place::PostUpdate] {
        for rate in [60, 144] {
            for easing in EASINGS {
                let mut app = app_with(rate, place, PhysicsPlugins::default());
                let twins = spawn(&mut app, easing);
                app.insert_resource(Writes(if DIM == 2 { sorted_and_pulsed } else { pulsed }));
                for frame in 1..frames(rate) {
                    app.update();
                    let what = format!("{place:?}, {rate} fps, frame {frame}");
                    twins.check_motion(&app, &what);
                    twins.check_drawn(&app, &what);
                    let mut expected = Transform::default();
                    pulsed(&mut expected, frame as u16);
                    assert_eq!(get::<Transform>(&app, twins.written).scale, expected.scale, "{what}");
                }
            }
        }
    }
}

#[test]
fn what_was_written_once_stays() {
    for rate in RATES {
        for easing in EASINGS {
            let mut app = app(rate);
            let twins = spawn(&mut app, easing);
            (0..rate / 4).for_each(|_| app.update());
            let mut transform = app.world_mut().get_mut::<Transform>(twins.written).expect("it has one");
            (transform.translation.z, transform.scale) = (7.0, Vec3::splat(2.0));
            for frame in 0..rate / 4 {
                app.update();
                let drawn = get::<Transform>(&app, twins.written);
                assert_eq!((drawn.translation.z, drawn.scale), (7.0, Vec3::splat(2.0)), "{rate}: {frame}");
                twins.check_drawn(&app, &format!("{rate} fps, frame {frame}"));
            }
        }
    }
}

/// The written values are not moved by physics or easing either, while nothing ticks.
#[test]
fn pauses_lose_nothing() {
    for rate in [30, 144] {
        for easing in EASINGS {
            for pauses_all in [false, true] {
                let mut app = app(rate);
                let twins = spawn(&mut app, easing);
                (0..rate / 4).for_each(|_| app.update());
                if pauses_all {
                    app.world_mut().resource_mut::<Time<Virtual>>().pause();
                } else {
                    app.world_mut().resource_mut::<Time<Physics>>().pause();
                }
                app.insert_resource(Writes(if DIM == 2 { sorted_and_pulsed } else { pulsed }));
                (0..5).for_each(|_| app.update());
                app.insert_resource(Writes(nothing));
                let set = get::<Transform>(&app, twins.written);
                for _ in 0..12 {
                    app.update();
                    twins.check_motion(&app, "paused");
                    twins.check_drawn(&app, "paused");
                    let [bare, eased] =
                        [twins.bare, twins.eased].map(|twin| get::<Transform>(&app, twin).translation);
                    assert!(pauses_all || bare == eased, "{rate} fps: {eased} is drawn, and not {bare}");
                    let kept = get::<Transform>(&app, twins.written);
                    assert_eq!((kept.translation.z, kept.scale), (set.translation.z, set.scale));
                }
                app.world_mut().resource_mut::<Time<Virtual>>().unpause();
                app.world_mut().resource_mut::<Time<Physics>>().unpause();
                for _ in 0..rate / 4 {
                    app.update();
                    twins.check_motion(&app, "after the pause");
                    twins.check_drawn(&app, "after the pause");
                }
            }
        }
    }
}

#[test]
fn a_teleport_along_one_axis_leaves_the_others_and_the_rotation() {
    for rate in RATES {
        for (index, easing) in EASINGS.into_iter().enumerate() {
            let mut app = app(rate);
            let twins = spawn(&mut app, easing);
            (0..rate / 4).for_each(|_| app.update());
            app.world_mut().get_mut::<Transform>(twins.written).expect("it has one").translation.x = 50.0;
            let from = pose(&app, twins.bare).0.x;
            for frame in 0..rate / 4 {
                app.update();
                let what = format!("{rate} fps, easing {index}, frame {frame}");
                let [bare, written] = [twins.bare, twins.written].map(|twin| pose(&app, twin));
                assert_eq!(bare.0.to_array()[1..], written.0.to_array()[1..], "{what}");
                assert_eq!(bare.1, written.1, "{what}");
                let ahead = get::<Transform>(&app, twins.written).translation.x - 50.0;
                assert!((0.0..6.0).contains(&ahead), "{what}: drawn {ahead} m from there");
                if bare.0.x != from {
                    let [moved, expected] = [written.0.x - 50.0, bare.0.x - from];
                    assert!((moved - expected).abs() < 2.0e-5, "{what}: {moved} m and not {expected} m");
                }
            }
        }
    }
}

#[test]
fn a_rotation_that_is_written_in_every_frame_leaves_the_path() {
    for place in [Place::BeforeTicks, Place::Update] {
        for rate in RATES {
            for easing in EASINGS {
                let mut app = app_with(rate, place, PhysicsPlugins::default());
                let twins = spawn(&mut app, easing);
                app.insert_resource(Writes(turned));
                app.world_mut().entity_mut(twins.written).insert(spin(0.0));
                for frame in 1..frames(rate) {
                    app.update();
                    let what = format!("{place:?}, {rate} fps, frame {frame}");
                    assert_eq!(pose(&app, twins.written).0, pose(&app, twins.bare).0, "{what}");
                    let [eased, written] =
                        [twins.eased, twins.written].map(|twin| get::<Transform>(&app, twin));
                    assert_eq!(written.translation, eased.translation, "{what}");
                    let mut expected = Transform::default();
                    turned(&mut expected, frame as u16);
                    assert!(written.rotation.abs_diff_eq(expected.rotation, 1.0e-6), "{what}");
                }
            }
        }
    }
}

/// A change of an eased body between ticks, after which the motion is that without easing.
fn check_change(mut change: impl FnMut(&mut App, Twins)) {
    for rate in RATES {
        for (index, easing) in EASINGS.into_iter().enumerate() {
            let mut app = app(rate);
            let twins = spawn(&mut app, easing);
            (0..rate / 4 + index as u32 % 3).for_each(|_| app.update());
            change(&mut app, twins);
            for frame in 0..rate / 4 {
                app.update();
                twins.check_motion(&app, &format!("{rate} fps, easing {index}, frame {frame}"));
            }
        }
    }
}

#[test]
fn easing_may_come_and_go() {
    check_change(|app, twins| {
        app.world_mut().entity_mut(twins.written).insert(NoTransformEasing);
    });
    check_change(|app, twins| {
        app.world_mut().entity_mut(twins.written).remove::<(
            TranslationInterpolation,
            RotationInterpolation,
            ScaleInterpolation,
            TranslationExtrapolation,
            RotationExtrapolation,
        )>();
    });
    check_change(|app, twins| {
        let mut body = app.world_mut().entity_mut(twins.written);
        body.remove_with_requires::<(TransformInterpolation, TransformExtrapolation)>();
        body.remove_with_requires::<(TranslationInterpolation, TranslationExtrapolation)>();
        body.remove_with_requires::<(RotationInterpolation, RotationExtrapolation, ScaleInterpolation)>();
    });
    check_change(|app, twins| {
        app.world_mut().entity_mut(twins.bare).insert(TransformInterpolation);
    });
}

#[test]
fn poses_that_are_set_count_at_once() {
    check_change(|app, twins| {
        for twin in [twins.bare, twins.eased, twins.written] {
            let mut body = app.world_mut().entity_mut(twin);
            body.get_mut::<Position>().expect("it has one").0 = Vector::X * 9.0;
            body.get_mut::<Transform>().expect("it has one").scale = Vec3::splat(1.5);
        }
    });
}

#[test]
fn colliders_of_eased_bodies_follow_the_scale() {
    for rate in RATES {
        for easing in EASINGS {
            let mut app = app(rate);
            let twins = spawn(&mut app, easing);
            for twin in [twins.bare, twins.eased, twins.written] {
                app.world_mut().entity_mut(twin).insert((ball(0.5), Sensor));
            }
            (0..rate / 4).for_each(|_| app.update());
            app.insert_resource(Writes(|transform, _| transform.scale = Vec3::splat(3.0)));
            (0..rate / 4).for_each(|_| app.update());
            let scale = app.world().get::<Collider>(twins.written).expect("inserted above").scale();
            assert_eq!(scale, Vector::splat(3.0), "{rate} fps");
            assert_eq!(
                app.world().get::<Collider>(twins.eased).expect("inserted above").scale(),
                Vector::ONE
            );
            assert_eq!(pose(&app, twins.written).0, pose(&app, twins.bare).0);
        }
    }
}

/// Bodies below eased parents, all written to.
#[test]
fn writing_to_parents_and_children_changes_no_motion() {
    for rate in RATES {
        for easing in EASINGS {
            let mut app = app(rate);
            let [bare, written] = [false, true].map(|is_eased| {
                let world = app.world_mut();
                let place = Transform::from_xyz(1.0, 2.0, 0.0).with_rotation(Quat::from_rotation_z(1.0));
                let root = world.spawn(place).id();
                let motion = (RigidBody::Kinematic, LinearVelocity(Vector::X * 3.0), spin(1.0));
                let middle = world.spawn((motion, ChildOf(root), Transform::from_xyz(0.0, 1.0, 0.0))).id();
                let leaf = world.spawn((thrown(), ChildOf(middle))).id();
                for body in [middle, leaf].into_iter().filter(|_| is_eased) {
                    let mut body = world.entity_mut(body);
                    easing(&mut body);
                    body.insert(Written);
                }
                [middle, leaf]
            });
            // Scale of a parent moves children; `z` in 3D is along an axis.
            app.insert_resource(Writes(if DIM == 2 { sorted } else { rewritten }));
            for frame in 0..rate / 2 {
                app.update();
                for (bare, written) in bare.into_iter().zip(written) {
                    let [(bare, turn), (at, turned)] = [bare, written].map(|body| pose(&app, body));
                    let off = (at - bare).length().max((turned - turn).length());
                    assert!(off < 1.0e-5, "{rate} fps, frame {frame}: off by {off}");
                }
            }
        }
    }
}

#[test]
fn sleeping_bodies_stay_asleep_while_depth_is_written() {
    for easing in EASINGS {
        let mut app = app(144);
        app.insert_resource(Gravity::ZERO).insert_resource(TimeToSleep(0.1));
        let mut body = app.world_mut().spawn((RigidBody::Dynamic, ball(0.5), Written));
        easing(&mut body);
        let body = body.id();
        (0..72).for_each(|_| app.update());
        assert!(app.world().get::<Sleeping>(body).is_some());
        app.insert_resource(Writes(if DIM == 2 { sorted } else { rewritten }));
        (0..72).for_each(|_| app.update());
        assert!(app.world().get::<Sleeping>(body).is_some());
    }
}

/// Easing is for fixed ticks. It must not take back what physics does elsewhere.
#[test]
fn bodies_move_where_physics_runs_in_update() {
    for rate in RATES {
        // Extrapolation needs velocities of fixed ticks.
        for easing in [0, 2, 3, 4, 7].map(|index| EASINGS[index]) {
            let mut app = app_with(rate, Place::PreUpdate, PhysicsPlugins::new(Update));
            let twins = spawn(&mut app, easing);
            app.insert_resource(Writes(if DIM == 2 { sorted_and_pulsed } else { pulsed }));
            for frame in 0..frames(rate) {
                app.update();
                twins.check_motion(&app, &format!("{rate} fps, frame {frame}"));
                let [bare, written] = [twins.bare, twins.written].map(|twin| get::<Transform>(&app, twin));
                assert_eq!(bare.translation.truncate(), written.translation.truncate());
            }
        }
    }
}

#[test]
fn eased_bodies_do_not_go_back_in_slow_motion() {
    for rate in RATES {
        for (index, easing) in EASINGS.into_iter().enumerate() {
            let mut app = app(rate);
            app.world_mut().resource_mut::<Time<Physics>>().set_relative_speed(0.25);
            let twins = spawn(&mut app, easing);
            let mut last = 0.0;
            for frame in 0..frames(rate) {
                app.update();
                let x = get::<Transform>(&app, twins.eased).translation.x;
                assert!(x > last - 1.0e-5, "{rate} fps, easing {index}, frame {frame}: from {last} to {x}");
                last = x;
            }
            assert!(last > 1.2);
        }
    }
}

/// Eased entities need not be bodies.
#[test]
fn what_the_app_moves_in_fixed_ticks_is_eased_too() {
    let mut app = app(144);
    app.add_systems(FixedUpdate, |mut moved: Query<&mut Transform, Without<RigidBody>>| {
        moved.iter_mut().for_each(|mut transform| transform.translation.x += 1.0);
    });
    app.insert_resource(Writes(|t, frame| t.translation.y = f32::from(frame)));
    let [left, written] =
        [(); 2].map(|()| app.world_mut().spawn((Transform::IDENTITY, TransformInterpolation)).id());
    app.world_mut().entity_mut(written).insert(Written);
    let mut last = 0.0;
    for frame in 1..144_u16 {
        app.update();
        let [left, written] = [left, written].map(|entity| get::<Transform>(&app, entity).translation);
        assert_eq!((left.x, f32::from(frame)), (written.x, written.y));
        assert!(left.x >= last && left.x - last < 0.5, "not smooth");
        last = left.x;
    }
    assert!(last > 60.0);
}

/// A parent with a thrown body below, and the same body without a parent. What is drawn differs by less
/// than `tolerance`.
fn check_below(rate: u32, parent: impl Bundle, tolerance: f32) {
    let mut app = app(rate);
    let world = app.world_mut();
    let above = world.spawn(parent).id();
    let free = world.spawn((thrown(), TransformExtrapolation)).id();
    let pose = (Position(Vector::X + Vector::Y * 2.0), Rotation::default());
    let below = world.spawn((thrown(), pose, TransformExtrapolation, ChildOf(above))).id();
    for frame in 0..rate / 2 {
        app.update();
        let [free, below] = [free, below].map(|body| get::<GlobalTransform>(&app, body));
        let off = (free.translation() - below.translation()).length();
        assert!(off < tolerance, "{rate} fps, frame {frame}: {off} m off");
        // The axis has the other sign below a mirror.
        let [axis, other] =
            [free, below].map(|global| Vec3::from(global.affine().matrix3.x_axis).normalize());
        let off = (axis - other).length().min((axis + other).length());
        assert!(off < tolerance, "{rate} fps, frame {frame}: turned by {off} rad");
    }
}

#[test]
fn extrapolation_below_a_parent_that_turns_scales_or_mirrors_is_as_without_it() {
    let turned = Transform::from_xyz(3.0, -1.0, 0.0).with_rotation(Quat::from_rotation_z(2.0));
    let tilted = turned.with_rotation(if DIM == 2 { turned.rotation } else { Quat::from_rotation_x(1.2) });
    let scaled = turned.with_scale(Vec3::splat(2.5));
    let mirrored = tilted.with_scale(Vec3::new(-0.5, 0.5, 0.5));
    for rate in RATES {
        for parent in [turned, tilted, scaled, mirrored] {
            check_below(rate, parent, 2.0e-4);
        }
    }
}

/// Both are extrapolated along straight lines. The rest is of second order in the tick.
#[test]
fn extrapolation_below_an_extrapolated_body_counts_its_motion_once() {
    let place = Transform::from_xyz(0.0, 1.0, 0.0).with_rotation(Quat::from_rotation_z(2.0));
    for rate in RATES {
        let motion = (LinearVelocity(Vector::X * 5.0), spin(1.5));
        check_below(rate, (RigidBody::Kinematic, motion, place, TransformExtrapolation), 5.0e-3);
        check_below(rate, (RigidBody::Kinematic, motion, place), 2.0e-4);
    }
}
