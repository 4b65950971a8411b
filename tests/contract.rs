//! Names, paths, signatures, derives and defaults that apps and other crates rely on: those of Avian 0.7 that
//! exist here. Most is proven by compiling.

use std::{fmt::Debug, hash::Hash, ops};

use avian::{
    collider_tree::{ColliderTreeDiagnostics, ColliderTreeSystems},
    collision::{
        CollisionDiagnostics,
        collider::{ColliderConstructorHierarchyConfig, EnlargedAabb, TrimeshBuilderError},
        narrow_phase::CollisionEventSystems,
    },
    dynamics::{
        integrator::{IntegrationSystems, VelocityIntegrationData},
        rigid_body::{
            forces::{AccumulatedLocalAcceleration, ForcesItem, ForcesReadOnlyItem, NonWakingForcesItem},
            mass_properties::{
                MassPropertyChanged, MassPropertySystems, WithComputedMassProperty,
                components::{AngularInertiaError, MassError, RecomputeMassProperties},
            },
        },
        solver::{
            ContactSoftnessCoefficients, SolverConfig, SolverDiagnostics,
            schedule::SubstepSolverSystems,
            softness_parameters::{SoftnessCoefficients, SoftnessParameters},
        },
    },
    math::{AdjustPrecision, AsF32, DIM, Dir, MatExt, Matrix, Quaternion, RecipOrZero, Scalar, Vector},
    physics_transform::{
        ApplyPosToTransform, PhysicsTransformConfig, PhysicsTransformSystems, position_to_transform,
        transform_to_position,
    },
    schedule::LastPhysicsTick,
};
// By name, so that a missing one is reported.
#[rustfmt::skip]
use avian::prelude::{
    AabbContext, AngularDamping, AngularInertia, AngularInertiaTensor, AngularInertiaTensorError, AngularVelocity,
    AnyCollider, BroadPhaseCorePlugin, BroadPhaseSystems, BvhBroadPhasePlugin, CenterOfMass, CoefficientCombine,
    Collider, ColliderAabb, ColliderBackendPlugin, ColliderCachePlugin, ColliderConstructor,
    ColliderConstructorHierarchy, ColliderConstructorHierarchyReady, ColliderConstructorReady, ColliderDensity, ColliderDisabled, ColliderHierarchyPlugin,
    ColliderMarker, ColliderMassProperties, ColliderOf, ColliderTransform, ColliderTransformPlugin,
    ColliderTreeOptimization, ColliderTreePlugin, CollisionLayers, CollisionMargin, ComputeMassProperties2d,
    ComputeMassProperties3d, ComputedAngularInertia, ComputedCenterOfMass, ComputedMass, ConstantAngularAcceleration,
    ConstantForce, ConstantLinearAcceleration, ConstantLocalForce, ConstantLocalLinearAcceleration, ConstantTorque,
    CustomPositionIntegration,
    CustomVelocityIntegration, DefaultFriction, DefaultRestitution, Dominance, FillMode, ForcePlugin,
    ForceSystems, Forces, Friction, Gravity,
    GravityScale, IntegratorPlugin, IntoCollider, IslandPlugin, IslandSleepingPlugin, LayerMask, LinearDamping,
    LinearVelocity, LockedAxes, Mass, MassProperties2d, MassProperties3d, MassPropertiesBundle, MassPropertiesExt,
    MassPropertyHelper, MassPropertyPlugin, MaxAngularSpeed, MaxLinearSpeed, NarrowPhaseConfig, NarrowPhasePlugin,
    NarrowPhaseSystems, NoAutoAngularInertia, NoAutoCenterOfMass, NoAutoMass, NoRotationEasing, NoScaleEasing,
    NoTransformEasing, NoTranslationEasing, Physics, PhysicsInterpolationPlugin, PhysicsLayer, PhysicsLengthUnit,
    PhysicsPlugins, PhysicsSchedule, PhysicsSchedulePlugin, PhysicsStepSystems, PhysicsSystems, PhysicsTime,
    PhysicsTransformHelper, PhysicsTransformPlugin, Position, ReadRigidBodyForces, Restitution, RigidBody, RigidBodyColliders,
    RigidBodyDisabled, RigidBodyForces, RigidBodyQuery, RigidBodyQueryItem, RigidBodyQueryReadOnly,
    RigidBodyQueryReadOnlyItem, Rotation, RotationExtrapolation, RotationHermiteEasing, RotationInterpolation,
    ScalableCollider, ScaleInterpolation, Sensor, SimpleCollider, SleepBody, SleepThreshold, SleepTimer, Sleeping,
    SleepingDisabled, SolverBodyPlugin, SolverPlugin, SolverPlugins, SolverSchedulePlugin, SolverSystems,
    SpeculativeMargin, SubstepCount, SubstepSchedule, Substeps, TimeToSleep, 
    TransformEasingSystems, TransformExtrapolation, TransformHermiteEasing, TransformInterpolation,
    TranslationExtrapolation, TranslationHermiteEasing, TranslationInterpolation, TreeOptimizationMode,
    TrimeshFlags, VhacdParameters, WakeBody, WriteRigidBodyForces, dynamics, forces, mass_properties, sleeping,
};
use bevy_app::{Plugin, PluginGroup, PostUpdate};
use bevy_ecs::{
    component::{Immutable, Mutable},
    entity::Entity,
    prelude::*,
    schedule::ScheduleLabel,
    system::{Command, SystemParam},
};
use bevy_math::curve::Ease;
use bevy_mesh::Mesh;
use bevy_reflect::Reflect;
use bevy_time::Time;
use bevy_transform::components::{GlobalTransform, Transform};

use super::contract_dim::{MassProperties, Segment};

#[derive(PhysicsLayer, Clone, Copy, Default)]
enum Layer {
    #[default]
    Ground,
    Player,
}

/// Fails to compile unless every type has every trait.
macro_rules! have {
    ($($($bound:path),+ => $($kind:ty),+ $(,)?;)+) => {
        $({
            fn has<T: 'static $(+ $bound)+>() {}
            $(has::<$kind>();)+
        })+
    };
}

/// Fails to compile unless every function has the signature.
macro_rules! are {
    ($($signature:ty = $($function:expr),+ $(,)?;)+) => {
        $($(let _: $signature = $function;)+)+
    };
}

#[test]
fn components_derive_what_they_derive_in_avian() {
    fn immutable<C: Component<Mutability = Immutable>>() {}
    fn mutable<C: Component<Mutability = Mutable>>() {}
    immutable::<RigidBody>();
    immutable::<CollisionLayers>();
    immutable::<ColliderOf>();
    immutable::<avian::prelude::ActiveCollisionHooks>();
    mutable::<Collider>();
    mutable::<Position>();
    have! {
        Component, Reflect, Clone, Debug =>
            RigidBody, RigidBodyDisabled, LinearVelocity, AngularVelocity, MaxLinearSpeed, MaxAngularSpeed,
            GravityScale, LinearDamping, AngularDamping, Dominance, LockedAxes, Friction, Restitution, Position,
            Rotation, Mass, AngularInertia, CenterOfMass, ComputedMass, ComputedAngularInertia,
            ComputedCenterOfMass, ColliderDensity, ColliderMassProperties, NoAutoMass, NoAutoAngularInertia,
            NoAutoCenterOfMass, RecomputeMassProperties, Sleeping, SleepingDisabled, SleepThreshold, SleepTimer,
            ColliderMarker, ColliderAabb, EnlargedAabb, ColliderDisabled, Sensor, CollisionLayers, CollisionMargin,
            ColliderOf, RigidBodyColliders, ColliderTransform, SpeculativeMargin;
        Component, Reflect, Clone, Debug, Default, PartialEq =>
            ConstantForce, ConstantTorque, ConstantLocalForce, ConstantLinearAcceleration,
            ConstantAngularAcceleration, ConstantLocalLinearAcceleration, AccumulatedLocalAcceleration;
        Component, Reflect, Debug, Default, PartialEq => VelocityIntegrationData;
        Component, Reflect, Clone, Debug, Default, PartialEq =>
            ColliderConstructor, ColliderConstructorHierarchy;
        Reflect, Clone, Debug, Default, PartialEq => ColliderConstructorHierarchyConfig;
        EntityEvent, Clone, Copy, Debug, PartialEq =>
            ColliderConstructorReady, ColliderConstructorHierarchyReady;
        Copy =>
            RigidBody, RigidBodyDisabled, LinearVelocity, AngularVelocity, GravityScale, Friction, Restitution,
            Position, Rotation, Mass, AngularInertia, CenterOfMass, ComputedMass, ComputedAngularInertia,
            SleepThreshold, ColliderAabb, CollisionLayers, LayerMask, ColliderTransform, SoftnessCoefficients;
        PartialEq =>
            RigidBody, LinearVelocity, AngularVelocity, MaxLinearSpeed, MaxAngularSpeed, GravityScale,
            LinearDamping, AngularDamping, Dominance, Friction, Restitution, Position, Rotation, Mass,
            AngularInertia, CenterOfMass, ComputedMass, ComputedAngularInertia, ColliderDensity, Sleeping,
            SleepThreshold, SleepTimer, ColliderAabb, CollisionLayers, CollisionMargin, ColliderOf,
            RigidBodyColliders, ColliderTransform, SpeculativeMargin, MassPropertiesBundle;
        PartialOrd =>
            GravityScale, LinearDamping, AngularDamping, Dominance, Friction, Restitution, SleepThreshold,
            TimeToSleep, ColliderDensity, CoefficientCombine, LayerMask;
        Default =>
            RigidBody, RigidBodyDisabled, LinearVelocity, AngularVelocity, MaxLinearSpeed, MaxAngularSpeed,
            GravityScale, LinearDamping, AngularDamping, Dominance, LockedAxes, Friction, Restitution, Position,
            Rotation, Mass, AngularInertia, CenterOfMass, ComputedMass, ComputedAngularInertia,
            ComputedCenterOfMass, ColliderDensity, ColliderMassProperties, MassPropertiesBundle, SleepThreshold,
            SleepTimer, Sleeping, SleepingDisabled, ColliderAabb, EnlargedAabb, CollisionLayers, CollisionMargin,
            RigidBodyColliders, ColliderTransform, Collider, Sensor, ColliderDisabled;
        From<Scalar> =>
            MaxLinearSpeed, MaxAngularSpeed, GravityScale, LinearDamping, AngularDamping, Friction, Restitution,
            CollisionMargin, SpeculativeMargin, ComputedMass;
        From<Vector> => LinearVelocity, Position, ComputedCenterOfMass;
        From<f32> => Mass, ColliderDensity;
        From<i8> => Dominance;
        From<u8> => LockedAxes;
        From<Mass> => ComputedMass;
        From<ComputedMass> => Mass;
        From<CenterOfMass> => ComputedCenterOfMass;
        From<ComputedCenterOfMass> => CenterOfMass;
        From<AngularInertia> => ComputedAngularInertia;
        From<ComputedAngularInertia> => AngularInertia;
        From<Transform> => Rotation, ColliderTransform;
        From<GlobalTransform> => Position, Rotation;
        From<&'static GlobalTransform> => Position, Rotation;
        From<bevy_math::Quat> => Rotation;
        From<bevy_math::DQuat> => Rotation;
        From<Rotation> => Quaternion;
        From<avian::parry::shape::SharedShape> => Collider;
        ops::Deref<Target = Vector> =>
            LinearVelocity, Position, ComputedCenterOfMass, ConstantForce, ConstantLocalForce,
            ConstantLinearAcceleration, ConstantLocalLinearAcceleration;
        ops::DerefMut<Target = Vector> =>
            LinearVelocity, Position, ComputedCenterOfMass, ConstantForce, ConstantLocalForce,
            ConstantLinearAcceleration, ConstantLocalLinearAcceleration;
        ops::Deref<Target = Scalar> =>
            MaxLinearSpeed, MaxAngularSpeed, GravityScale, LinearDamping, AngularDamping, CollisionMargin,
            SpeculativeMargin, PhysicsLengthUnit;
        ops::Deref<Target = f32> => Mass, ColliderDensity;
        ops::Deref<Target = [Entity]> => RigidBodyColliders;
        ops::Deref<Target = ColliderAabb> => EnlargedAabb;
        ops::Deref<Target = Friction> => DefaultFriction;
        ops::Deref<Target = Restitution> => DefaultRestitution;
        Ease => Position, Rotation;
        ops::Mul<Output = Rotation> => Rotation;
        ops::MulAssign => Rotation;
        ops::Mul<Vector, Output = Vector> => Rotation, &'static Rotation, &'static mut Rotation, ComputedAngularInertia;
        ops::Mul<&'static Vector, Output = Vector> => Rotation, &'static Rotation, &'static mut Rotation;
        ops::Mul<&'static mut Vector, Output = Vector> => Rotation, &'static Rotation, &'static mut Rotation;
        ops::Mul<Dir, Output = Dir> => Rotation, &'static Rotation, &'static mut Rotation;
        ops::Mul<&'static Dir, Output = Dir> => Rotation, &'static Rotation, &'static mut Rotation;
        ops::Mul<&'static mut Dir, Output = Dir> => Rotation, &'static Rotation, &'static mut Rotation;
        Bundle => MassPropertiesBundle;
        FromWorld => ColliderOf;
    }
}

#[test]
fn resources_derive_what_they_derive_in_avian() {
    have! {
        Resource, Reflect =>
            Gravity, SubstepCount, PhysicsLengthUnit, SolverConfig, ContactSoftnessCoefficients, NarrowPhaseConfig,
            DefaultFriction, DefaultRestitution, TimeToSleep, PhysicsTransformConfig, LastPhysicsTick,
            SolverDiagnostics, CollisionDiagnostics, ColliderTreeDiagnostics, ColliderTreeOptimization,
            Time<Physics>, Time<Substeps>;
        Default =>
            Gravity, SubstepCount, PhysicsLengthUnit, SolverConfig, ContactSoftnessCoefficients, NarrowPhaseConfig,
            DefaultFriction, DefaultRestitution, TimeToSleep, PhysicsTransformConfig, LastPhysicsTick,
            SolverDiagnostics, CollisionDiagnostics, ColliderTreeDiagnostics, ColliderTreeOptimization,
            TreeOptimizationMode, VhacdParameters, Physics, Substeps;
        Clone, PartialEq => SolverConfig, NarrowPhaseConfig, PhysicsLengthUnit, PhysicsTransformConfig;
        Clone, PartialEq, Debug, Reflect => VhacdParameters, FillMode, TrimeshFlags, TreeOptimizationMode;
        Hash, Eq => FillMode, TrimeshFlags;
    }
    let config = PhysicsTransformConfig::default();
    assert!(config.propagate_before_physics && config.transform_to_position && config.position_to_transform);
    assert!(config.transform_to_collider_scale);
    let tree = ColliderTreeOptimization::default();
    assert!(tree.use_async_tasks);
    let _ = (tree.optimize_in_place, tree.optimization_mode.resolve(0.5));
    let softness = ContactSoftnessCoefficients::default();
    let of = |hz: Scalar| SoftnessParameters::new(10.0, hz).compute_coefficients(1.0 / 60.0);
    assert_eq!((softness.dynamic, softness.non_dynamic), (of(30.0), of(60.0)));
    let _ = (softness.dynamic.bias, softness.dynamic.mass_scale, softness.dynamic.impulse_scale);
    let params = VhacdParameters::default();
    assert_eq!((params.alpha, params.beta, params.max_convex_hulls), (0.05, 0.05, 1024));
    assert_eq!((params.concavity, params.resolution), if DIM == 2 { (0.1, 256) } else { (0.01, 64) });
    assert_eq!((params.plane_downsampling, params.convex_hull_downsampling), (4, 4));
    assert!(params.convex_hull_approximation);
}

#[test]
fn plugins_and_sets_are_where_they_were() {
    fn schedule_plugins<S: ScheduleLabel + Clone>(s: S) -> [Box<dyn Plugin>; 7] {
        [
            Box::new(PhysicsSchedulePlugin::new(s.clone())),
            Box::new(MassPropertyPlugin::new(s.clone())),
            Box::new(ColliderTransformPlugin::new(s.clone())),
            Box::new(ColliderBackendPlugin::<Collider>::new(s.clone())),
            Box::new(IntegratorPlugin::new(s.clone())),
            Box::new(PhysicsTransformPlugin::new(s.clone())),
            Box::new(NarrowPhasePlugin::<Collider>::new(s, true)),
        ]
    }
    schedule_plugins(PostUpdate);
    have! {
        Plugin, Default =>
            PhysicsSchedulePlugin, MassPropertyPlugin, ColliderTransformPlugin, ColliderBackendPlugin<Collider>,
            ColliderTreePlugin<Collider>, NarrowPhasePlugin<Collider>, SolverPlugin, SolverSchedulePlugin,
            IntegratorPlugin, BvhBroadPhasePlugin, PhysicsTransformPlugin, PhysicsInterpolationPlugin;
        Plugin =>
            ForcePlugin, ColliderHierarchyPlugin, ColliderCachePlugin, SolverBodyPlugin, IslandPlugin, IslandSleepingPlugin, BroadPhaseCorePlugin,
            avian::PhysicsTypeRegistrationPlugin;
        PluginGroup, Default => PhysicsPlugins, SolverPlugins;
        SystemSet, Copy, Debug, Eq, Hash =>
            PhysicsSystems, PhysicsStepSystems, SolverSystems, SubstepSolverSystems, IntegrationSystems,
            BroadPhaseSystems, NarrowPhaseSystems, CollisionEventSystems, ColliderTreeSystems, MassPropertySystems,
            PhysicsTransformSystems, ForceSystems;
        ScheduleLabel, Clone, Debug, Eq, Hash => PhysicsSchedule, SubstepSchedule;
        SystemParam => MassPropertyHelper<'static, 'static>, PhysicsTransformHelper<'static, 'static>;
        Command => SleepBody, WakeBody;
    }
    SolverPlugin::new_with_length_unit(2.0);
    SolverPlugins::new_with_length_unit(2.0);
    are! {
        fn() -> PhysicsInterpolationPlugin =
            PhysicsInterpolationPlugin::interpolate_all, PhysicsInterpolationPlugin::interpolate_translation_all,
            PhysicsInterpolationPlugin::interpolate_rotation_all, PhysicsInterpolationPlugin::extrapolate_all,
            PhysicsInterpolationPlugin::extrapolate_translation_all,
            PhysicsInterpolationPlugin::extrapolate_rotation_all;
    }
    use {
        BroadPhaseSystems as B, ColliderTreeSystems as T, IntegrationSystems as I, MassPropertySystems as M,
        NarrowPhaseSystems as N, PhysicsTransformSystems as P, SolverSystems as S, SubstepSolverSystems as U,
    };
    let _ = [B::First, B::CollectCollisions, B::Last];
    let _ = [N::First, N::Update, N::Last];
    let _ = [I::UpdateVelocityIncrements, I::Velocity, I::Position, I::ClearVelocityIncrements];
    let _ = [U::WarmStart, U::SolveConstraints, U::Relax, U::Damping];
    let _ = [ForceSystems::ApplyConstantForces, ForceSystems::ApplyLocalAcceleration, ForceSystems::Clear];
    let _ = [T::UpdateAabbs, T::BeginOptimize, T::EndOptimize];
    let _ = [M::UpdateColliderMassProperties, M::QueueRecomputation, M::UpdateComputedMassProperties];
    let _ = [P::Propagate, P::TransformToPosition, P::PositionToTransform];
    let _ =
        [S::PrepareSolverBodies, S::PrepareJoints, S::PrepareContactConstraints, S::PreSubstep, S::Substep];
    let _ = [S::PostSubstep, S::Restitution, S::Finalize, S::StoreContactImpulses];
}

#[test]
#[expect(deprecated, reason = "former names stay importable")]
fn former_names_are_still_there() {
    use avian::{
        dynamics::{integrator::IntegrationSet, solver::schedule::SubstepSolverSet},
        physics_transform::PhysicsTransformSet,
        prelude::{
            DeactivationTime, NarrowPhaseSet, PhysicsSet, PhysicsStepSet, SleepingThreshold, SolverSet,
            TimeSleeping, TransformEasingSet,
        },
    };
    have! {
        SystemSet =>
            IntegrationSet, SubstepSolverSet, PhysicsTransformSet, NarrowPhaseSet, PhysicsSet, PhysicsStepSet, SolverSet, TransformEasingSet;
        Component => SleepingThreshold, TimeSleeping;
        Resource => DeactivationTime;
    }
}

#[test]
fn methods_have_the_signatures_they_had() {
    type Item = ForcesItem<'static, 'static>;
    type ReadItem = ForcesReadOnlyItem<'static, 'static>;
    type QuietItem = NonWakingForcesItem<'static, 'static>;
    type Body = RigidBodyQueryItem<'static, 'static>;
    type ReadBody = RigidBodyQueryReadOnlyItem<'static, 'static>;
    are! {
        fn(&RigidBody) -> bool = RigidBody::is_dynamic, RigidBody::is_static, RigidBody::is_kinematic;
        fn(Vector, Vector) -> ColliderAabb = ColliderAabb::new, ColliderAabb::from_min_max;
        fn(ColliderAabb) -> Vector = ColliderAabb::center, ColliderAabb::size;
        fn(ColliderAabb, ColliderAabb) -> ColliderAabb = ColliderAabb::merged;
        fn(&ColliderAabb, Vector) -> ColliderAabb = ColliderAabb::grow, ColliderAabb::shrink;
        fn(&ColliderAabb, &ColliderAabb) -> bool = ColliderAabb::intersects, ColliderAabb::contains;
        fn(&avian::parry::shape::SharedShape) -> ColliderAabb = ColliderAabb::from_shape;
        fn(ColliderAabb) -> EnlargedAabb = EnlargedAabb::new;
        fn(&mut EnlargedAabb, &ColliderAabb, Scalar) -> bool = EnlargedAabb::update;
        fn(&EnlargedAabb) -> ColliderAabb = EnlargedAabb::get;
        fn(&ColliderTransform, Vector) -> Vector = ColliderTransform::transform_point;
        fn(u32, u32) -> CollisionLayers = CollisionLayers::from_bits;
        fn(CollisionLayers, CollisionLayers) -> bool = CollisionLayers::interacts_with;
        fn(Scalar) -> Friction = Friction::new;
        fn(Scalar) -> Restitution = Restitution::new;
        fn(&Friction, CoefficientCombine) -> Friction = Friction::with_combine_rule;
        fn(&Friction, Scalar) -> Friction = Friction::with_dynamic_coefficient, Friction::with_static_coefficient;
        fn(&Friction, Friction) -> Friction = Friction::combine;
        fn(&Restitution, CoefficientCombine) -> Restitution = Restitution::with_combine_rule;
        fn(&Restitution, Restitution) -> Restitution = Restitution::combine;
        fn(&CoefficientCombine, Scalar, Scalar) -> Scalar = CoefficientCombine::mix;
        fn() -> LockedAxes = LockedAxes::new;
        fn(u8) -> LockedAxes = LockedAxes::from_bits;
        fn(&LockedAxes) -> u8 = LockedAxes::to_bits;
        fn(&mut VelocityIntegrationData, Vector) = VelocityIntegrationData::apply_linear_acceleration;
        fn(&mut VelocityIntegrationData, Scalar, Scalar) =
            VelocityIntegrationData::update_linear_damping_rhs, VelocityIntegrationData::update_angular_damping_rhs;
        fn(&Item) -> Vector =
            ReadRigidBodyForces::linear_velocity, ReadRigidBodyForces::accumulated_linear_acceleration;
        fn(&ReadItem) -> &Position = ReadRigidBodyForces::position;
        fn(&QuietItem) -> &Rotation = ReadRigidBodyForces::rotation;
        fn(&ReadItem, Vector) -> Vector = ReadRigidBodyForces::velocity_at_point;
        fn(&mut Item, Vector) =
            WriteRigidBodyForces::apply_force, WriteRigidBodyForces::apply_local_force,
            WriteRigidBodyForces::apply_linear_impulse, WriteRigidBodyForces::apply_local_linear_impulse,
            WriteRigidBodyForces::apply_linear_acceleration,
            WriteRigidBodyForces::apply_local_linear_acceleration;
        fn(&mut QuietItem, Vector, Vector) =
            WriteRigidBodyForces::apply_force_at_point, WriteRigidBodyForces::apply_linear_impulse_at_point,
            WriteRigidBodyForces::apply_linear_acceleration_at_point;
        fn(&mut Item) -> &mut Vector = WriteRigidBodyForces::linear_velocity_mut;
        fn(&mut Item) =
            WriteRigidBodyForces::reset_accumulated_linear_acceleration,
            WriteRigidBodyForces::reset_accumulated_angular_acceleration;
        fn(&Body, Vector) -> Vector = RigidBodyQueryItem::velocity_at_point;
        fn(&ReadBody, Vector) -> Vector = RigidBodyQueryReadOnlyItem::velocity_at_point;
        fn(&Body) -> Vector = RigidBodyQueryItem::effective_inverse_mass;
        fn(&Body) -> i16 = RigidBodyQueryItem::dominance;
        fn(&Body) -> ComputedAngularInertia =
            RigidBodyQueryItem::angular_inertia, RigidBodyQueryItem::effective_global_angular_inertia;
        fn(&ReadBody) -> ComputedMass = RigidBodyQueryReadOnlyItem::mass;
        fn(LockedAxes) -> LockedAxes =
            LockedAxes::lock_translation_x, LockedAxes::lock_translation_y, LockedAxes::unlock_translation_x,
            LockedAxes::unlock_translation_y;
        fn(&LockedAxes) -> bool =
            LockedAxes::is_translation_x_locked, LockedAxes::is_translation_y_locked,
            LockedAxes::is_translation_locked, LockedAxes::is_rotation_locked;
        fn(&Mesh) -> Option<Collider> =
            Collider::trimesh_from_mesh, Collider::convex_hull_from_mesh,
            Collider::convex_decomposition_from_mesh;
        fn(&Mesh, TrimeshFlags) -> Option<Collider> = Collider::trimesh_from_mesh_with_config;
        fn(&Mesh, &VhacdParameters) -> Option<Collider> = Collider::convex_decomposition_from_mesh_with_config;
        fn(&Mesh, Scalar, FillMode) -> Option<Collider> = Collider::voxelized_trimesh_from_mesh;
        fn(ColliderConstructor, Option<&Mesh>) -> Option<Collider> = Collider::try_from_constructor;
        fn(&ColliderConstructor) -> bool = ColliderConstructor::requires_mesh;
        fn(Vec<(Vector, Rotation, ColliderConstructor)>) -> ColliderConstructor = ColliderConstructor::compound;
        fn(ColliderConstructor) -> ColliderConstructorHierarchy = ColliderConstructorHierarchy::new;
        fn(Option<ColliderConstructor>) -> ColliderConstructorHierarchy = ColliderConstructorHierarchy::new;
        fn(ColliderConstructorHierarchy, CollisionLayers) -> ColliderConstructorHierarchy =
            ColliderConstructorHierarchy::with_default_layers;
        fn(ColliderConstructorHierarchy, f32) -> ColliderConstructorHierarchy =
            ColliderConstructorHierarchy::with_default_density;
        fn(ColliderConstructorHierarchy, &str, ColliderConstructor) -> ColliderConstructorHierarchy =
            ColliderConstructorHierarchy::with_constructor_for_name;
        fn(ColliderConstructorHierarchy, &str, CollisionLayers) -> ColliderConstructorHierarchy =
            ColliderConstructorHierarchy::with_layers_for_name;
        fn(ColliderConstructorHierarchy, &str, f32) -> ColliderConstructorHierarchy =
            ColliderConstructorHierarchy::with_density_for_name;
        fn(ColliderConstructorHierarchy, &str) -> ColliderConstructorHierarchy =
            ColliderConstructorHierarchy::without_constructor_for_name;
        fn(Scalar) -> ComputedMass = ComputedMass::new, ComputedMass::from_inverse;
        fn(Scalar) -> Result<ComputedMass, MassError> = ComputedMass::try_new, ComputedMass::try_from_inverse;
        fn(ComputedMass) -> Scalar = ComputedMass::value, ComputedMass::inverse;
        fn(ComputedMass) -> bool = ComputedMass::is_finite, ComputedMass::is_infinite, ComputedMass::is_nan;
        fn(&mut ComputedMass, Scalar) = ComputedMass::set;
        fn(&mut ComputedMass, Mass) = ComputedMass::set;
        fn(&Collider, f32) -> Mass = Mass::from_shape::<Collider>;
        fn(&Collider, f32) -> AngularInertia = AngularInertia::from_shape::<Collider>;
        fn(&Collider) -> CenterOfMass = CenterOfMass::from_shape::<Collider>;
        fn(&Collider, f32) -> MassPropertiesBundle = MassPropertiesBundle::from_shape::<Collider>;
        fn(&Collider, f32) -> ColliderMassProperties = ColliderMassProperties::from_shape::<Collider>;
        fn(Scalar, Scalar) -> SoftnessParameters = SoftnessParameters::new;
        fn(SoftnessParameters) -> Scalar =
            SoftnessParameters::damping_ratio, SoftnessParameters::frequency, SoftnessParameters::angular_frequency;
        fn(Vector) -> Position = Position::new;
        fn(Rotation, Rotation) -> Scalar = Rotation::angle_between;
        fn(Rotation, Rotation, Scalar) -> Rotation = Rotation::nlerp, Rotation::slerp;
        fn(Rotation) -> Rotation = Rotation::fast_renormalize;
        fn(&Time<Physics>) -> f32 = PhysicsTime::relative_speed;
        fn(&Time<Physics>) -> f64 = PhysicsTime::relative_speed_f64;
        fn(Time<Physics>, f32) -> Time<Physics> = PhysicsTime::with_relative_speed;
        fn(Time<Physics>, f64) -> Time<Physics> = PhysicsTime::with_relative_speed_f64;
        fn(&mut Time<Physics>, f32) = PhysicsTime::set_relative_speed;
        fn(&mut Time<Physics>, f64) = PhysicsTime::set_relative_speed_f64;
        fn(&Time<Physics>) -> bool = PhysicsTime::is_paused;
        fn(&mut Time<Physics>) = PhysicsTime::pause, PhysicsTime::unpause;
    }
    assert_eq!(
        (MassError::Negative == MassError::NaN, AngularInertiaError::NaN),
        (false, AngularInertiaError::NaN)
    );
    assert_eq!((LayerMask::ALL.0, LayerMask::NONE.0, LayerMask::DEFAULT.0), (u32::MAX, 0, 1));
    for (layers, bits) in [
        (CollisionLayers::DEFAULT, (1, u32::MAX)),
        (CollisionLayers::ALL, (u32::MAX, u32::MAX)),
        (CollisionLayers::NONE, (0, 0)),
        (CollisionLayers::ALL_MEMBERSHIPS, (u32::MAX, 0)),
        (CollisionLayers::ALL_FILTERS, (0, u32::MAX)),
    ] {
        assert_eq!((layers.memberships.0, layers.filters.0), bits);
    }
    assert_eq!(
        [LockedAxes::TRANSLATION_LOCKED, LockedAxes::ROTATION_LOCKED, LockedAxes::ALL_LOCKED]
            .map(|l| l.to_bits()),
        [0b111_000, 0b000_111, 0b111_111]
    );
    assert_eq!((Position::PLACEHOLDER.0, SpeculativeMargin::MAX.0), (Vector::MAX, Scalar::MAX));
    assert_eq!(
        (ColliderAabb::INVALID.min, ColliderAabb::INVALID.max),
        (Vector::INFINITY, Vector::NEG_INFINITY)
    );
    use CoefficientCombine::{Average, GeometricMean, Max, Min, Multiply};
    assert_eq!([Average, GeometricMean, Min, Multiply, Max].map(|rule| rule as u8), [1, 2, 3, 4, 5]);
    assert_eq!(Friction::from(0.2), Friction::new(0.2));
    assert_eq!(
        (Restitution::PERFECTLY_ELASTIC.coefficient, Restitution::PERFECTLY_INELASTIC),
        (1.0, Restitution::ZERO)
    );
    assert_eq!((LayerMask::from([Layer::Ground, Layer::Player]), Layer::all_bits()), (LayerMask(3), 3));
    let layers = (LayerMask::from(6) & 3 | 8) ^ !LayerMask::ALL;
    assert_eq!((layers, layers == 10, layers.has_all([2, 8])), (LayerMask(10), true, true));
    let mut layers = layers;
    layers.add(1);
    layers.remove([2, 8]);
    layers |= 4;
    layers &= 5;
    layers ^= 1;
    assert_eq!(layers.0, 4);
}

#[test]
fn colliders_are_made_the_way_they_were() {
    type Points = Vec<Vector>;
    are! {
        fn(Scalar, Scalar) -> Collider = Collider::capsule;
        fn(Scalar, Vector, Vector) -> Collider = Collider::capsule_endpoints;
        fn(Vector) -> Collider = Collider::half_space;
        fn(Vector, Vector) -> Collider = Collider::segment;
        fn(Vector, Vector, Vector) -> Collider = Collider::triangle;
        fn(Points, Option<Vec<[u32; 2]>>) -> Collider = Collider::polyline;
        fn(Points, Vec<[u32; 3]>) -> Collider = Collider::trimesh;
        fn(Points, Vec<[u32; 3]>) -> Result<Collider, TrimeshBuilderError> = Collider::try_trimesh;
        fn(Points, Vec<[u32; 3]>, TrimeshFlags) -> Collider = Collider::trimesh_with_config;
        fn(Points, Vec<[u32; 3]>, TrimeshFlags) -> Result<Collider, TrimeshBuilderError> =
            Collider::try_trimesh_with_config;
        fn(Points, Vec<[u32; DIM]>) -> Collider = Collider::convex_decomposition;
        fn(Points) -> Option<Collider> = Collider::convex_hull;
        fn(Vector, &[Vector]) -> Collider = Collider::voxels_from_points;
        fn(&[Vector], &[[u32; DIM]]) -> Vec<Collider> = Collider::voxelized_convex_decomposition;
        fn(&[Vector], &[[u32; DIM]], &VhacdParameters) -> Vec<Collider> =
            Collider::voxelized_convex_decomposition_with_config;
        fn(Vec<(Position, Rotation, Collider)>) -> Collider = Collider::compound;
        fn(&Collider) -> &avian::parry::shape::SharedShape = Collider::shape, Collider::shape_scaled;
        fn(&mut Collider) -> &mut avian::parry::shape::SharedShape = Collider::shape_mut;
        fn(&mut Collider, avian::parry::shape::SharedShape) = Collider::set_shape;
        fn(&Collider) -> Vector = Collider::scale;
        fn(&mut Collider, Vector, u32) = Collider::set_scale;
        fn(&Collider, Vector, Rotation, Vector, bool) -> (Vector, bool) = Collider::project_point;
        fn(&Collider, Vector, Rotation, Vector, bool) -> Scalar = Collider::distance_to_point;
        fn(&Collider, Vector, Rotation, Vector) -> bool = Collider::contains_point;
        fn(&Collider, Vector, Rotation, Vector, Vector, Scalar, bool) -> Option<(Scalar, Vector)> = Collider::cast_ray;
        fn(&Collider, Vector, Rotation, Vector, Vector, Scalar) -> bool = Collider::intersects_ray;
        fn(&Collider, Vector, Rotation) -> ColliderAabb = SimpleCollider::aabb;
        fn(&Collider, Vector, Rotation, Vector, Rotation) -> ColliderAabb = SimpleCollider::swept_aabb;
        fn(&Collider, &Collider, Vector, Rotation, Vector, Rotation, Scalar, &mut Vec<avian::prelude::ContactManifold>) =
            SimpleCollider::contact_manifolds;
    }
}

#[test]
fn what_a_body_and_a_collider_require_is_there() {
    let mut world = World::new();
    let body = world.spawn((RigidBody::Dynamic, Collider::default())).id();
    macro_rules! has {
        ($($component:ty),+ $(,)?) => { $(assert!(world.get::<$component>(body).is_some());)+ };
    }
    has!(Position, Rotation, LinearVelocity, AngularVelocity, RecomputeMassProperties);
    has!(ComputedMass, ComputedAngularInertia, ComputedCenterOfMass);
    has!(AccumulatedLocalAcceleration, VelocityIntegrationData);
    has!(
        ColliderMarker,
        ColliderAabb,
        CollisionLayers,
        EnlargedAabb,
        ColliderDensity,
        ColliderMassProperties
    );
}

#[test]
fn the_rest_can_be_named() {
    // Items that are not used above.
    fn named<T: ?Sized>() {}
    named::<(AngularInertiaTensor, AngularInertiaTensorError, MassProperties2d, MassProperties3d)>();
    named::<(NoRotationEasing, NoScaleEasing, NoTransformEasing, NoTranslationEasing)>();
    named::<(RotationExtrapolation, RotationHermiteEasing, RotationInterpolation, ScaleInterpolation)>();
    named::<(TransformEasingSystems, TransformExtrapolation, TransformHermiteEasing)>();
    named::<(
        TransformInterpolation,
        TranslationExtrapolation,
        TranslationHermiteEasing,
        TranslationInterpolation,
    )>();
    named::<(CustomPositionIntegration, CustomVelocityIntegration, ApplyPosToTransform, Matrix)>();
    named::<(MassPropertyChanged, WithComputedMassProperty, AabbContext<'static, 'static, 'static, ()>)>();
    named::<(Forces, RigidBodyQuery, RigidBodyQueryReadOnly, forces::ForcePlugin)>();
    fn both<F: RigidBodyForces>() {}
    let _ = (both::<ForcesItem>, both::<NonWakingForcesItem>);
    let _ = |mut forces: ForcesItem| {
        let _ = forces.non_waking().waking().reborrow();
    };
    named::<dynamics::ccd::SpeculativeMargin>();
    named::<dynamics::ccd::SweptCcd>();
    named::<dynamics::ccd::SweepMode>();
    named::<dynamics::ccd::CcdPlugin>();
    named::<dynamics::ccd::SweptCcdSystems>();
    named::<mass_properties::components::Mass>();
    named::<sleeping::SleepThreshold>();
    let _ = (IntoSystem::into_system(transform_to_position), IntoSystem::into_system(position_to_transform));
    let _ = IntoSystem::into_system(avian::collision::collider::update_collider_scale::<Collider>);
    fn traits<
        C: AnyCollider + ScalableCollider,
        T: IntoCollider<C>,
        L: PhysicsLayer,
        M: MassPropertiesExt,
    >() {
    }
    let _ = traits::<Collider, Segment, Layer, MassProperties>;
    let _ = |mut helper: MassPropertyHelper, of| helper.update_mass_properties(of);
    fn shapes<A: ComputeMassProperties2d, B: ComputeMassProperties3d>() {}
    let _ = shapes::<bevy_math::primitives::Circle, bevy_math::primitives::Sphere>;
    assert_eq!((2.0 as Scalar).recip_or_zero() + (0.0 as Scalar).recip_or_zero(), 0.5);
    assert_eq!(Matrix::IDENTITY.inverse_or_zero(), Matrix::IDENTITY);
    assert_eq!(Vector::X.f32().adjust_precision(), Vector::X);
}
