//! Reflection: registers every public component and resource of the engine by name.

use bevy_app::{App, Plugin};

/// Registers the engine's components, resources and nested types for reflection, whether or not the app
/// registers types automatically.
///
/// Scenes, inspectors and remote tools need it. The simulation does not.
pub struct PhysicsTypeRegistrationPlugin;

/// Calls `app.register_type` for each type of a list.
macro_rules! register {
    ($app:ident: $($type:ty),* $(,)?) => {
        $( $app.register_type::<$type>(); )*
    };
}

impl Plugin for PhysicsTypeRegistrationPlugin {
    fn build(&self, app: &mut App) {
        register_schedule(app);
        register_dynamics(app);
        register_joints(app);
        register_bodies(app);
        register_mass_properties(app);
        register_collision(app);
        register_queries(app);
        #[cfg(feature = "debug-plugin")]
        register_drawing(app);
        #[cfg(all(feature = "bevy_picking", feature = "default-collider"))]
        register_picking(app);
        #[cfg(feature = "bevy_diagnostic")]
        register_diagnostics(app);
        register_collider_settings(app);
    }
}

fn register_schedule(app: &mut App) {
    use crate::schedule::{LastPhysicsTick, Physics, StepTimes, Substeps};
    use bevy_time::Time;

    register!(app: Physics, Substeps, Time<Physics>, Time<Substeps>, LastPhysicsTick, StepTimes);
}

#[cfg(all(feature = "bevy_picking", feature = "default-collider"))]
fn register_picking(app: &mut App) {
    use crate::picking::{
        PhysicsPickable, PhysicsPickingDiagnostics, PhysicsPickingFilter, PhysicsPickingSettings,
    };

    register!(app: PhysicsPickable, PhysicsPickingFilter, PhysicsPickingSettings, PhysicsPickingDiagnostics);
}

#[cfg(feature = "bevy_diagnostic")]
fn register_diagnostics(app: &mut App) {
    use crate::diagnostics::{PhysicsEntityDiagnostics, PhysicsTotalDiagnostics};

    register!(app: PhysicsEntityDiagnostics, PhysicsTotalDiagnostics);
    #[cfg(feature = "diagnostic_ui")]
    register!(app: crate::diagnostics::ui::PhysicsDiagnosticsUiSettings);
}

fn register_dynamics(app: &mut App) {
    use crate::{
        dynamics::{
            ccd::{SpeculativeMargin, SweepMode, SweptCcd},
            integrator::{
                CustomPositionIntegration, CustomVelocityIntegration, Gravity, VelocityIntegrationData,
            },
            rigid_body::sleeping::TimeToSleep,
            solver::{
                ContactSoftnessCoefficients, PhysicsLengthUnit, RowWidth, SolverConfig, SolverDiagnostics,
                WorkerCount,
                schedule::SubstepCount,
                softness_parameters::{SoftnessCoefficients, SoftnessParameters},
                solver_body::{InertiaFlags, SolverBody, SolverBodyFlags, SolverBodyInertia},
            },
        },
        physics_transform::{PhysicsTransformConfig, PreSolveDeltaPosition, PreSolveDeltaRotation},
    };

    register!(app:
        SpeculativeMargin, SweptCcd, SweepMode, Gravity, CustomVelocityIntegration, CustomPositionIntegration,
        VelocityIntegrationData,
        PhysicsLengthUnit, SolverConfig, SolverDiagnostics, ContactSoftnessCoefficients, SubstepCount, WorkerCount,
        RowWidth,
        SoftnessParameters, SoftnessCoefficients, TimeToSleep, PhysicsTransformConfig,
        SolverBody, SolverBodyFlags, SolverBodyInertia, InertiaFlags,
        PreSolveDeltaPosition, PreSolveDeltaRotation,
    );
}

fn register_joints(app: &mut App) {
    use crate::dynamics::{
        joints::{
            AngleLimit, AngularMotor, AxisMotor, AxisSpring, DistanceLimit, JointAnchor, JointAxis,
            JointBasis, JointBreakThreshold, JointCollisionDisabled, JointDamping, JointDisabled, JointError,
            JointForces, JointFrame, JointSoftness, JointSolver, LinearMotor, MotorModel, dim,
        },
        solver::joint_graph::{JointComponentId, JointGraphEdge, JointId},
    };

    dim::register_kinds(app);
    register!(app:
        AngleLimit, AngularMotor, AxisMotor, AxisSpring, DistanceLimit, JointAnchor, JointAxis, JointSoftness, JointBasis, JointBreakThreshold, JointCollisionDisabled, JointDamping,
        JointDisabled, JointError, JointForces, JointFrame, JointSolver, LinearMotor, MotorModel, JointComponentId, JointGraphEdge, JointId,
    );
}

fn register_bodies(app: &mut App) {
    use crate::{
        dynamics::rigid_body::{
            AngularDamping, AngularVelocity, CoefficientCombine, DefaultFriction, DefaultRestitution,
            Dominance, FacetMaterials, Friction, GravityScale, LinearDamping, LinearVelocity, LockedAxes,
            MaxAngularSpeed, MaxLinearSpeed, Restitution, RigidBody, RigidBodyDisabled,
            forces::{
                self, ConstantAngularAcceleration, ConstantForce, ConstantLinearAcceleration,
                ConstantLocalForce, ConstantLocalLinearAcceleration, ConstantTorque,
            },
            sleeping::{SleepThreshold, SleepTimer, Sleeping, SleepingDisabled},
        },
        physics_transform::{FollowTransform, Position, Rotation},
    };

    register!(app:
        RigidBody, RigidBodyDisabled, FollowTransform, Position, Rotation, LinearVelocity, AngularVelocity, MaxLinearSpeed,
        MaxAngularSpeed, GravityScale, LinearDamping, AngularDamping, Dominance, LockedAxes,
        Friction, Restitution, CoefficientCombine, DefaultFriction, DefaultRestitution, FacetMaterials,
        Sleeping, SleepingDisabled, SleepThreshold, SleepTimer,
        ConstantForce, ConstantTorque, ConstantLocalForce, ConstantLinearAcceleration, ConstantAngularAcceleration,
        ConstantLocalLinearAcceleration,
    );
    forces::register_types(app);
}

fn register_mass_properties(app: &mut App) {
    use crate::dynamics::rigid_body::mass_properties::components::{
        AngularInertia, CenterOfMass, ColliderDensity, ColliderMassProperties, ComputedAngularInertia,
        ComputedCenterOfMass, ComputedMass, Mass, NoAutoAngularInertia, NoAutoCenterOfMass, NoAutoMass,
        RecomputeMassProperties,
    };

    register!(app:
        Mass, AngularInertia, CenterOfMass, ComputedMass, ComputedAngularInertia, ComputedCenterOfMass,
        NoAutoMass, NoAutoAngularInertia, NoAutoCenterOfMass, RecomputeMassProperties,
        ColliderDensity, ColliderMassProperties,
    );
}

fn register_collision(app: &mut App) {
    use crate::{
        collider_tree::{ColliderTreeDiagnostics, ColliderTreeOptimization, TreeOptimizationMode},
        collision::{
            CollisionDiagnostics,
            collider::{
                ColliderAabb, ColliderDisabled, ColliderMarker, CollidingEntities, CollisionLayers,
                CollisionMargin, EnlargedAabb, LayerMask, Sensor,
                collider_hierarchy::{ColliderOf, RigidBodyColliders},
                collider_transform::ColliderTransform,
            },
            collision_events::CollisionEventsEnabled,
            collision_hits::CollisionHitsEnabled,
            contact_types::{ContactEdgeFlags, ContactId, ContactPairFlags, PackedFeatureId},
            hooks::ActiveCollisionHooks,
            narrow_phase::NarrowPhaseConfig,
        },
    };

    register!(app:
        NarrowPhaseConfig, CollisionDiagnostics, ColliderTreeOptimization, TreeOptimizationMode,
        ColliderTreeDiagnostics, ColliderMarker, ColliderAabb, EnlargedAabb, ColliderDisabled, Sensor,
        CollisionLayers, LayerMask, CollisionMargin, ColliderOf, RigidBodyColliders, ColliderTransform,
        CollidingEntities, CollisionEventsEnabled, CollisionHitsEnabled, ActiveCollisionHooks, ContactId, ContactEdgeFlags, ContactPairFlags, PackedFeatureId,
    );
}

#[cfg(feature = "debug-plugin")]
fn register_drawing(app: &mut App) {
    use crate::debug_render::{ContactGizmoScale, DebugRender, PhysicsGizmos};

    register!(app: PhysicsGizmos, ContactGizmoScale, DebugRender);
}

fn register_queries(app: &mut App) {
    use crate::spatial_query::{RayCaster, RayHitData, RayHits, SpatialQueryDiagnostics, SpatialQueryFilter};

    register!(app: SpatialQueryFilter, SpatialQueryDiagnostics, RayCaster, RayHits, RayHitData);
}

/// Colliders, their constructors and settings.
#[cfg(feature = "default-collider")]
fn register_collider_settings(app: &mut App) {
    use crate::{
        collision::collider::{
            Collider, FillMode, TrimeshFlags, VhacdParameters,
            constructor::{self, ColliderConstructorHierarchy, ColliderConstructorHierarchyConfig},
            contact_query::ClosestPoints,
        },
        spatial_query::{PointProjection, ShapeCastConfig, ShapeCaster, ShapeHitData, ShapeHits},
    };

    register!(app:
        Collider, VhacdParameters, FillMode, TrimeshFlags, ShapeCaster, ShapeHits, ShapeHitData, ShapeCastConfig, PointProjection,
        ClosestPoints, ColliderConstructorHierarchy, ColliderConstructorHierarchyConfig,
    );
    constructor::register_types(app);
    register_characters(app);
}

#[cfg(feature = "default-collider")]
fn register_characters(app: &mut App) {
    use crate::character_controller::{
        controller::{
            Carrier, CharacterController, CharacterInput, CharacterState, GroundState, SurfaceVelocity,
        },
        crouch::CharacterCrouch,
        dynamic_mover::DynamicMover,
        move_and_slide::{DepenetrationConfig, MoveAndSlideConfig, MoveAndSlideOutput, MoveHitData},
    };

    register!(app:
        CharacterController, CharacterInput, CharacterState, GroundState, Carrier, SurfaceVelocity,
        CharacterCrouch, DynamicMover, MoveAndSlideConfig, DepenetrationConfig, MoveAndSlideOutput, MoveHitData,
    );
}

#[cfg(not(feature = "default-collider"))]
fn register_collider_settings(_: &mut App) {}
