//! Dynamics: [rigid bodies](rigid_body), [joints], [gravity and integration](integrator), [continuous
//! collision detection](ccd) and the [solver].

pub mod ccd;
pub(crate) mod drain;
pub(crate) mod ids;
pub mod integrator;
pub mod joints;
pub(crate) mod lifecycle;
pub(crate) mod materials;
pub(crate) mod quarantine;
pub(crate) mod reports;
pub mod rigid_body;
pub(crate) mod sleep;
pub mod solver;
pub(crate) mod tables;
#[cfg(feature = "validate")]
pub(crate) mod validate;

/// The names of this module that most apps use.
pub mod prelude {
    #[cfg(feature = "default-collider")]
    pub use super::solver::LengthUnitCheckPlugin;
    #[cfg(feature = "xpbd_joints")]
    pub use super::solver::xpbd::XpbdSolverPlugin;
    #[expect(deprecated, reason = "former names stay importable")]
    pub use super::{
        ccd::SweptCcdSet,
        rigid_body::sleeping::{DeactivationTime, SleepingThreshold, TimeSleeping},
        solver::schedule::SolverSet,
    };
    pub use super::{
        ccd::{CcdPlugin, SpeculativeMargin, SweepMode, SweptCcd},
        integrator::{CustomPositionIntegration, CustomVelocityIntegration, Gravity, IntegratorPlugin},
        joints::{
            AngleLimit, AngularMotor, AxisMotor, AxisSpring, DistanceJoint, DistanceLimit, FixedJoint,
            GearJoint, GenericJoint, JointAnchor, JointAxis, JointBasis, JointBreakThreshold, JointBroken,
            JointCollisionDisabled, JointCoordinate, JointDamping, JointDisabled, JointError, JointForces,
            JointFrame, JointPlugin, JointSoftness, JointSolver, LinearMotor, MotorModel, MouseJoint,
            PrismaticJoint, PulleyJoint, RackAndPinionJoint, RevoluteJoint, WheelJoint,
        },
        rigid_body::{
            forces::{
                ConstantAngularAcceleration, ConstantForce, ConstantLinearAcceleration, ConstantLocalForce,
                ConstantLocalLinearAcceleration, ConstantTorque, ForcePlugin, ForceSystems, Forces,
                ReadRigidBodyForces, RigidBodyForces, WriteRigidBodyForces,
            },
            mass_properties::{
                MassPropertiesExt, MassPropertyHelper, MassPropertyPlugin,
                bevy_heavy::{
                    AngularInertiaTensor, AngularInertiaTensorError, ComputeMassProperties2d,
                    ComputeMassProperties3d, MassProperties2d, MassProperties3d,
                },
                components::{
                    AngularInertia, CenterOfMass, ColliderDensity, ColliderMassProperties,
                    ComputedAngularInertia, ComputedCenterOfMass, ComputedMass, Mass, MassPropertiesBundle,
                    NoAutoAngularInertia, NoAutoCenterOfMass, NoAutoMass,
                },
            },
            sleeping::{SleepThreshold, SleepTimer, Sleeping, SleepingDisabled, TimeToSleep},
            *,
        },
        solver::{
            PhysicsLengthUnit, SolverPlugin, SolverPlugins,
            islands::{IslandPlugin, IslandSleepingPlugin, SleepBody, WakeBody},
            schedule::{SolverSchedulePlugin, SolverSystems, SubstepCount, SubstepSchedule},
            solver_body::SolverBodyPlugin,
        },
    };
    #[cfg(feature = "3d")]
    pub use super::{
        joints::{AngularDrive, SphericalDrive, SphericalJoint, SphericalMotor},
        rigid_body::forces::{ConstantLocalAngularAcceleration, ConstantLocalTorque},
    };
}
