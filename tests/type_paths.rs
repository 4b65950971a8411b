//! Type paths in files: scenes, glTF extras and exports of editors name a reflected type by its module
//! path in Avian.

use super::reflection::registered;
use std::collections::BTreeMap;

/// Every reflected type of Avian 0.7 without type parameters, by its path within the crate. Types that this
/// engine does not have yet are listed as well, so that they get the right path from the start.
const PATHS: &str = "
character_controller::move_and_slide::DepenetrationConfig
character_controller::move_and_slide::MoveAndSlideConfig
character_controller::move_and_slide::MoveAndSlideOutput
character_controller::move_and_slide::MoveHitData
collider_tree::diagnostics::ColliderTreeDiagnostics
collider_tree::optimization::ColliderTreeOptimization
collider_tree::optimization::TreeOptimizationMode
collider_tree::proxy_key::ColliderTreeProxyKey
collider_tree::proxy_key::ColliderTreeType
collider_tree::proxy_key::ProxyId
collider_tree::tree::ColliderTreeProxyFlags
collision::collider::ColliderAabb
collision::collider::ColliderDisabled
collision::collider::CollidingEntities
collision::collider::CollisionMargin
collision::collider::EnlargedAabb
collision::collider::Sensor
collision::collider::backend::ColliderMarker
collision::collider::collider_hierarchy::ColliderOf
collision::collider::collider_hierarchy::RigidBodyColliders
collision::collider::collider_transform::ColliderTransform
collision::collider::constructor::ColliderConstructor
collision::collider::constructor::ColliderConstructorHierarchy
collision::collider::constructor::ColliderConstructorHierarchyConfig
collision::collider::layers::CollisionLayers
collision::collider::layers::LayerMask
collision::collider::parry::FillMode
collision::collider::parry::TrimeshFlags
collision::collider::parry::VhacdParameters
collision::collider::parry::contact_query::ClosestPoints
collision::collider::trimesh_builder::Trimesh
collision::collision_events::CollisionEventsEnabled
collision::contact_types::ContactEdgeFlags
collision::contact_types::ContactId
collision::contact_types::ContactPairFlags
collision::contact_types::feature_id::PackedFeatureId
collision::diagnostics::CollisionDiagnostics
collision::hooks::ActiveCollisionHooks
collision::narrow_phase::NarrowPhaseConfig
data_structures::bit_vec::BitVec
debug_render::configuration::ContactGizmoScale
debug_render::configuration::DebugRender
debug_render::configuration::PhysicsGizmos
diagnostics::entity_counters::PhysicsEntityDiagnostics
diagnostics::total::PhysicsTotalDiagnostics
diagnostics::ui::PhysicsDiagnosticsUiSettings
dynamics::ccd::SpeculativeMargin
dynamics::ccd::SweepMode
dynamics::ccd::SweptCcd
dynamics::integrator::CustomPositionIntegration
dynamics::integrator::CustomVelocityIntegration
dynamics::integrator::Gravity
dynamics::integrator::VelocityIntegrationData
dynamics::joints::AngleLimit
dynamics::joints::DistanceLimit
dynamics::joints::JointAnchor
dynamics::joints::JointBasis
dynamics::joints::JointCollisionDisabled
dynamics::joints::JointDamping
dynamics::joints::JointDisabled
dynamics::joints::JointForces
dynamics::joints::JointFrame
dynamics::joints::distance::DistanceJoint
dynamics::joints::fixed::FixedJoint
dynamics::joints::motor::AngularMotor
dynamics::joints::motor::LinearMotor
dynamics::joints::motor::MotorModel
dynamics::joints::prismatic::PrismaticJoint
dynamics::joints::revolute::RevoluteJoint
dynamics::joints::spherical::SphericalJoint
dynamics::rigid_body::AngularDamping
dynamics::rigid_body::AngularVelocity
dynamics::rigid_body::Dominance
dynamics::rigid_body::GravityScale
dynamics::rigid_body::LinearDamping
dynamics::rigid_body::LinearVelocity
dynamics::rigid_body::MaxAngularSpeed
dynamics::rigid_body::MaxLinearSpeed
dynamics::rigid_body::RigidBody
dynamics::rigid_body::RigidBodyDisabled
dynamics::rigid_body::forces::AccumulatedLocalAcceleration
dynamics::rigid_body::forces::ConstantAngularAcceleration
dynamics::rigid_body::forces::ConstantForce
dynamics::rigid_body::forces::ConstantLinearAcceleration
dynamics::rigid_body::forces::ConstantLocalAngularAcceleration
dynamics::rigid_body::forces::ConstantLocalForce
dynamics::rigid_body::forces::ConstantLocalLinearAcceleration
dynamics::rigid_body::forces::ConstantLocalTorque
dynamics::rigid_body::forces::ConstantTorque
dynamics::rigid_body::locked_axes::LockedAxes
dynamics::rigid_body::mass_properties::components::AngularInertia
dynamics::rigid_body::mass_properties::components::CenterOfMass
dynamics::rigid_body::mass_properties::components::Mass
dynamics::rigid_body::mass_properties::components::NoAutoAngularInertia
dynamics::rigid_body::mass_properties::components::NoAutoCenterOfMass
dynamics::rigid_body::mass_properties::components::NoAutoMass
dynamics::rigid_body::mass_properties::components::RecomputeMassProperties
dynamics::rigid_body::mass_properties::components::collider::ColliderDensity
dynamics::rigid_body::mass_properties::components::collider::ColliderMassProperties
dynamics::rigid_body::mass_properties::components::computed::ComputedAngularInertia
dynamics::rigid_body::mass_properties::components::computed::ComputedCenterOfMass
dynamics::rigid_body::mass_properties::components::computed::ComputedMass
dynamics::rigid_body::physics_material::CoefficientCombine
dynamics::rigid_body::physics_material::DefaultFriction
dynamics::rigid_body::physics_material::DefaultRestitution
dynamics::rigid_body::physics_material::Friction
dynamics::rigid_body::physics_material::Restitution
dynamics::rigid_body::sleeping::SleepThreshold
dynamics::rigid_body::sleeping::SleepTimer
dynamics::rigid_body::sleeping::Sleeping
dynamics::rigid_body::sleeping::SleepingDisabled
dynamics::rigid_body::sleeping::TimeToSleep
dynamics::solver::constraint_graph::ConstraintGraph
dynamics::solver::constraint_graph::ContactConstraintHandle
dynamics::solver::constraint_graph::ContactManifoldHandle
dynamics::solver::constraint_graph::GraphColor
dynamics::solver::contact::ContactConstraint
dynamics::solver::contact::ContactConstraintPoint
dynamics::solver::contact::normal_part::ContactNormalPart
dynamics::solver::contact::tangent_part::ContactTangentPart
dynamics::solver::diagnostics::SolverDiagnostics
dynamics::solver::islands::BodyIslandNode
dynamics::solver::islands::IslandId
dynamics::solver::joint_graph::JointGraphEdge
dynamics::solver::joint_graph::JointId
dynamics::solver::joint_graph::plugin::JointComponentId
dynamics::solver::plugin::ContactSoftnessCoefficients
dynamics::solver::plugin::PhysicsLengthUnit
dynamics::solver::plugin::SolverConfig
dynamics::solver::schedule::SubstepCount
dynamics::solver::softness_parameters::SoftnessCoefficients
dynamics::solver::softness_parameters::SoftnessParameters
dynamics::solver::solver_body::InertiaFlags
dynamics::solver::solver_body::SolverBody
dynamics::solver::solver_body::SolverBodyFlags
dynamics::solver::solver_body::SolverBodyInertia
dynamics::solver::xpbd::joints::distance::DistanceJointSolverData
dynamics::solver::xpbd::joints::fixed::FixedJointSolverData
dynamics::solver::xpbd::joints::prismatic::PrismaticJointSolverData
dynamics::solver::xpbd::joints::revolute::RevoluteJointSolverData
dynamics::solver::xpbd::joints::shared::fixed_angle_constraint::FixedAngleConstraintShared
dynamics::solver::xpbd::joints::shared::point_constraint::PointConstraintShared
dynamics::solver::xpbd::joints::spherical::SphericalJointSolverData
physics_transform::PhysicsTransformConfig
physics_transform::transform::Position
physics_transform::transform::PreSolveDeltaPosition
physics_transform::transform::PreSolveDeltaRotation
physics_transform::transform::Rotation
picking::PhysicsPickable
picking::PhysicsPickingDiagnostics
picking::PhysicsPickingFilter
picking::PhysicsPickingSettings
schedule::LastPhysicsTick
schedule::time::Physics
schedule::time::Substeps
spatial_query::diagnostics::SpatialQueryDiagnostics
spatial_query::query_filter::SpatialQueryFilter
spatial_query::ray_caster::RayCaster
spatial_query::ray_caster::RayHitData
spatial_query::ray_caster::RayHits
spatial_query::shape_caster::ShapeCastConfig
spatial_query::shape_caster::ShapeCaster
spatial_query::shape_caster::ShapeHitData
spatial_query::shape_caster::ShapeHits
spatial_query::system_param::PointProjection
";

/// How many of the listed types exist here. It only grows.
const PRESENT: usize = 107;

/// The paths by type names.
fn paths() -> BTreeMap<&'static str, &'static str> {
    PATHS.split_whitespace().map(|path| (path.rsplit("::").next().expect("a name"), path)).collect()
}

#[test]
fn types_have_the_paths_that_files_for_avian_name() {
    let krate = env!("CARGO_PKG_NAME");
    let paths = paths();
    assert_eq!(paths.len(), PATHS.split_whitespace().count(), "names are told apart without their module");
    let (mut present, mut wrong) = (0, Vec::new());
    for path in registered() {
        let Some((_, name)) = path.rsplit_once("::") else { continue };
        let Some(expected) = paths.get(name).filter(|_| path.starts_with(krate)) else { continue };
        present += 1;
        if path != format!("{krate}::{expected}") {
            wrong.push(format!("{path}, in Avian {krate}::{expected}"));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
    assert!(present >= PRESENT, "{present} of the listed types are registered");
}
