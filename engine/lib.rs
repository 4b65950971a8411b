//! Rigid-body physics for [Bevy](https://bevy.org), in two dimensions (`avian2d`) and three (`avian3d`).
//!
//! It has the API of Avian: bodies, shapes and settings are components and resources, and each stage of a
//! step is a plugin that can be configured, disabled or replaced. Inside is a dense, wide and deterministic
//! solver with soft contacts and substeps.
//!
//! # Quick start
//!
//! Add [`PhysicsPlugins`] to the app, give an entity a [`RigidBody`](prelude::RigidBody) and a `Collider`,
//! and it falls. `PhysicsDebugPlugin` draws colliders as lines. In 3D:
//!
//! ```ignore
//! use avian3d::prelude::*;
//! use bevy::prelude::*;
//!
//! fn main() {
//!     App::new()
//!         .add_plugins((DefaultPlugins, PhysicsPlugins::default(), PhysicsDebugPlugin))
//!         .add_systems(Startup, setup)
//!         .run();
//! }
//!
//! fn setup(
//!     mut commands: Commands,
//!     mut meshes: ResMut<Assets<Mesh>>,
//!     mut materials: ResMut<Assets<StandardMaterial>>,
//! ) {
//!     let looking = |x, y, z| Transform::from_xyz(x, y, z).looking_at(Vec3::Y * 1.5, Vec3::Y);
//!     commands.spawn((Camera3d::default(), looking(-7.0, 6.0, 11.0)));
//!     commands.spawn((DirectionalLight::default(), looking(-3.0, 8.0, 5.0)));
//!     // A floor that nothing moves, seen by the lines of the debug plugin ...
//!     commands.spawn((RigidBody::Static, Collider::cuboid(12.0, 0.1, 12.0)));
//!     // ... and a pile that falls on it.
//!     let (mesh, amber) = (meshes.add(Cuboid::from_length(0.8)), materials.add(Color::srgb(0.9, 0.6, 0.2)));
//!     for i in 0..125u8 {
//!         let [x, y, z] = [i % 5, i / 25, i / 5 % 5].map(f32::from);
//!         commands.spawn((
//!             RigidBody::Dynamic,
//!             Collider::cuboid(0.8, 0.8, 0.8),
//!             Transform::from_xyz(x - 2.0, y + 1.0, z - 2.0).with_rotation(Quat::from_rotation_y(y)),
//!             (Mesh3d(mesh.clone()), MeshMaterial3d(amber.clone())),
//!         ));
//!     }
//! }
//! ```
//!
//! Without compiler optimisation physics is slow: 200 boxes take 38 ms per frame, in release builds 0.3 ms.
//! In the `Cargo.toml` of your workspace:
//!
//! ```toml
//! [profile.dev.package."*"]
//! opt-level = 3
//! ```
//!
//! The same without a window, as on a server:
//!
//! ```
//! # use avian::{math::Vector, prelude::*};
//! # use bevy_app::prelude::*;
//! # use bevy_ecs::prelude::*;
//! # use bevy_time::TimePlugin;
//! # use bevy_transform::prelude::*;
//! fn main() {
//!     App::new()
//!         // An app with a window has these, and a loop, from `DefaultPlugins`.
//!         .add_plugins((TaskPoolPlugin::default(), TimePlugin, TransformPlugin))
//!         .add_plugins(PhysicsPlugins::default())
//!         .insert_resource(Gravity(Vector::NEG_Y * 9.81))
//!         .add_systems(Startup, setup)
//!         .run();
//! }
//!
//! fn setup(mut commands: Commands) {
//!     // A floor: everything below y = 0. And a capsule that falls on it.
//!     commands.spawn((RigidBody::Static, Collider::half_space(Vector::Y)));
//!     commands.spawn((
//!         RigidBody::Dynamic,
//!         Collider::capsule(0.4, 1.0),
//!         Transform::from_xyz(0.0, 4.0, 0.0),
//!     ));
//! }
//! ```
//!
//! # Finding the right type
//!
//! | I want to | look at |
//! |---|---|
//! | make something fall, stand or move on rails | [`RigidBody`](prelude::RigidBody) |
//! | give it a shape | `Collider` and its constructors; child entities with a `Collider` for a body of several shapes |
//! | make colliders from meshes, scenes and files | `ColliderConstructor`, `ColliderConstructorHierarchy` |
//! | set its mass | `ColliderDensity`, [`Mass`](prelude::Mass), [`AngularInertia`](prelude::AngularInertia), [`CenterOfMass`](prelude::CenterOfMass) |
//! | move it | [`LinearVelocity`](prelude::LinearVelocity), [`AngularVelocity`](prelude::AngularVelocity); [`Position`](prelude::Position) or `Transform` to teleport |
//! | let it carry what stands on it while its `Transform` is animated | [`FollowTransform`](prelude::FollowTransform) |
//! | push it | [`Forces`](prelude::Forces), [`ConstantForce`](prelude::ConstantForce), [`forces`](dynamics::rigid_body::forces) |
//! | change how it falls | [`Gravity`](prelude::Gravity), [`GravityScale`](prelude::GravityScale), [`LinearDamping`](prelude::LinearDamping), [`MaxLinearSpeed`](prelude::MaxLinearSpeed) |
//! | hold it along or about axes | [`LockedAxes`](prelude::LockedAxes) |
//! | join it to another: hinges, sliders, ropes, motors | [joints](dynamics::joints), [`RevoluteJoint`](prelude::RevoluteJoint), [`DistanceJoint`](prelude::DistanceJoint) |
//! | put it on wheels, drag it, choose each axis of a joint | [`WheelJoint`](prelude::WheelJoint), [`MouseJoint`](prelude::MouseJoint), [`GenericJoint`](prelude::GenericJoint) |
//! | let it tear off | [`JointBreakThreshold`](prelude::JointBreakThreshold) |
//! | join it by a law of my own | [`Constraint`](dynamics::solver::constraint::Constraint) |
//! | make a human fall | `HumanRagdoll` |
//! | make it slide or bounce | [`Friction`](prelude::Friction), [`Restitution`](prelude::Restitution) |
//! | choose what it collides with | [`CollisionLayers`](prelude::CollisionLayers), [`Sensor`](prelude::Sensor), [`Dominance`](prelude::Dominance) |
//! | know what touches what | [`CollisionStart`](prelude::CollisionStart), [`CollisionEnd`](prelude::CollisionEnd), [`CollidingEntities`](prelude::CollidingEntities), [`Collisions`](prelude::Collisions) |
//! | know how hard something was hit | [`CollisionHit`](prelude::CollisionHit) |
//! | let some pairs pass, or change their contacts | [`CollisionHooks`](prelude::CollisionHooks) |
//! | let it sleep, or wake it | [`Sleeping`](prelude::Sleeping), [`SleepingDisabled`](prelude::SleepingDisabled), [`WakeBody`](prelude::WakeBody) |
//! | cast rays and shapes, find what is near | [`spatial_query`], [`RayCaster`](prelude::RayCaster) |
//! | let a character walk, or move a shape by hand | `CharacterController`, `MoveAndSlide` |
//! | let pointers hover, click and drag it | `PhysicsPickingPlugin` |
//! | take it out of the simulation | [`RigidBodyDisabled`](prelude::RigidBodyDisabled), [`ColliderDisabled`](prelude::ColliderDisabled) |
//! | draw it smoothly between steps | [`TransformInterpolation`](prelude::TransformInterpolation), [`TransformExtrapolation`](prelude::TransformExtrapolation) |
//! | pause, slow down or step by hand | [`Time<Physics>`](schedule::Physics), [`PhysicsSchedule`](prelude::PhysicsSchedule) |
//! | run a system within the step | [`PhysicsStepSystems`](schedule::PhysicsStepSystems), [`SubstepSchedule`](prelude::SubstepSchedule) |
//! | make it more accurate | [`SubstepCount`](prelude::SubstepCount), [`JointSolver`](prelude::JointSolver), [`SolverConfig`](dynamics::solver::SolverConfig), [`SpeculativeMargin`](prelude::SpeculativeMargin) |
//! | see shapes, contacts and casts as lines | `PhysicsDebugPlugin`, `PhysicsGizmos`, `DebugRender` |
//! | see where time goes | [`StepTimes`](schedule::StepTimes), [`diagnostics`] |
//!
//! # Examples
//!
//! `cargo run --release -p examples3d --example hello`, or `-p examples2d`. In both: `hello`, `readme`,
//! `forces`, `collision_events`, `picking`, `ccd`, `chain`, `joint_motors`, `wheels`, `ragdolls`, `player`.
//!
//! | | 2D | 3D |
//! |---|---|---|
//! | games | `character`, `player`, `moving_platform`, `one_way_platform` | `character`, `player`, `car`, `shooting`, `explosion`, `conveyor_belt`, `save_and_load`, `time_control` |
//! | bodies | `locked_axes`, `sleeping`, `interpolation`, `bridge` | `hinged_door`, `crane`, `breakable_wall`, `spherical_motors`, `generic_joint`, `child_colliders`, `materials`, `layers`, `dominoes` |
//! | colliders and queries | `ray_caster`, `custom_collider`, `custom_constraint` | `collider_constructors`, `spatial_queries`, `custom_broad_phase`, `custom_constraint` |
//! | tools | `step_times` | `debug_drawing`, `diagnostics` |
//!
//! # When physics runs
//!
//! Physics takes one step per run of the schedule given to [`PhysicsPlugins::new`], by default
//! `FixedPostUpdate`: 64 times a second at any frame rate. [`schedule::PhysicsSystems`] are its system sets
//! in that schedule, [`schedule::PhysicsStepSystems`] are the stages of a step, and
//! [`Time<Physics>`](schedule::Physics) is its clock.
//!
//! # Units
//!
//! Metres, seconds, kilograms and radians. If a metre is 100 pixels in your game, set
//! [`PhysicsPlugins::with_length_unit`] to 100 and [`Gravity`](prelude::Gravity) to 981.
//!
//! # Features
//!
//! | feature | |
//! |---|---|
//! | `f32` (default), `f64` | precision of positions: one of them |
//! | `parry-f32` (default), `parry-f64` | the default `Collider`, of the same precision; both turn on `default-collider` |
//! | `debug-plugin` (default) | `PhysicsDebugPlugin`; an app with Bevy features of its own choice needs `bevy_gizmos_render` |
//! | `bevy_picking` (default) | `PhysicsPickingPlugin` |
//! | `collider-from-mesh`, `bevy_scene` (default) | colliders from meshes; hierarchies that wait for their scene |
//! | `parallel` (default) | Bevy's threads, which physics uses too |
//! | `bevy_diagnostic`, `diagnostic_ui` | timers and counters in Bevy's diagnostics, and in a panel |
//! | `serialize` | serde for components, resources and `Collider`, which Bevy's `DynamicWorldBuilder` then saves, too |
//! | `validate` | expensive checks of whole tables, for tests |
//! | `xpbd_joints` (default) | constraints of the app by XPBD, [`dynamics::solver::xpbd`] |
//! | `simd`, `enhanced-determinism` | empty, so that crates resolve: both are always on |

#[cfg(not(any(feature = "2d", feature = "3d")))]
compile_error!("enable feature `2d` of avian2d or `3d` of avian3d: one dimension is needed");
#[cfg(all(feature = "2d", feature = "3d"))]
compile_error!("features `2d` and `3d` exclude each other: use avian2d and avian3d side by side instead");
#[cfg(not(any(feature = "f32", feature = "f64")))]
compile_error!("enable feature `f32` or `f64`: one precision is needed");
#[cfg(all(feature = "f32", feature = "f64"))]
compile_error!("features `f32` and `f64` exclude each other");
#[cfg(all(feature = "default-collider", not(any(feature = "parry-f32", feature = "parry-f64"))))]
compile_error!("feature `default-collider` needs `parry-f32` or `parry-f64`, as the precision is");

#[cfg(feature = "default-collider")]
pub mod character_controller;
pub mod collider_tree;
pub mod collision;
pub mod data_structures;
#[cfg(feature = "debug-plugin")]
pub mod debug_render;
pub mod diagnostics;
pub mod dynamics;
pub mod interpolation;
pub mod math;
pub mod physics_transform;
#[cfg(all(feature = "bevy_picking", feature = "default-collider"))]
pub mod picking;
#[cfg(feature = "default-collider")]
pub mod ragdoll;
pub mod schedule;
pub mod spatial_query;

mod asked;
mod columns;
mod noted;
mod plugins;
mod scan;
mod step;
mod threads;
mod type_path;
mod type_registration;

#[cfg(feature = "parry-f32")]
pub use parry_f32 as parry;
#[cfg(feature = "parry-f64")]
pub use parry_f64 as parry;
pub use plugins::{PhysicsPlugins, PhysicsPluginsWithHooks};
pub use type_registration::PhysicsTypeRegistrationPlugin;

/// The names that most apps use.
pub mod prelude {
    #[cfg(feature = "default-collider")]
    pub use crate::character_controller::prelude::*;
    #[cfg(feature = "debug-plugin")]
    pub use crate::debug_render::*;
    #[cfg(feature = "bevy_diagnostic")]
    pub use crate::diagnostics::PhysicsDiagnosticsPlugin;
    #[cfg(feature = "diagnostic_ui")]
    pub use crate::diagnostics::ui::{PhysicsDiagnosticsUiPlugin, PhysicsDiagnosticsUiSettings};
    #[cfg(all(feature = "bevy_picking", feature = "default-collider"))]
    pub use crate::picking::{
        PhysicsPickable, PhysicsPickingFilter, PhysicsPickingPlugin, PhysicsPickingSettings,
    };
    #[cfg(feature = "default-collider")]
    pub use crate::ragdoll::{Bone, HumanRagdoll, Ragdoll, RagdollJoints};
    #[expect(deprecated, reason = "former names stay importable")]
    pub use crate::schedule::{PhysicsSet, PhysicsStepSet};
    pub use crate::{
        PhysicsPlugins,
        collider_tree::{ColliderTreeOptimization, ColliderTreePlugin, TreeOptimizationMode},
        collision::prelude::*,
        dynamics::{self, ccd::SpeculativeMargin, prelude::*},
        interpolation::*,
        physics_transform::{
            FollowTransform, PhysicsTransformHelper, PhysicsTransformPlugin, Position, Rotation,
        },
        schedule::{
            Physics, PhysicsSchedule, PhysicsSchedulePlugin, PhysicsStepSystems, PhysicsSystems, PhysicsTime,
            Substeps,
        },
        spatial_query::{self, *},
    };
}
