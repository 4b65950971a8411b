//! Reflection: every public component and resource of the engine is registered, by name.

use bevy_app::{App, Plugin};

/// Registers the engine's components, resources and their parts for reflection, whether or not the app registers types automatically.
///
/// Without it scenes, inspectors and remote tools do not know them; the simulation does not need it.
pub struct PhysicsTypeRegistrationPlugin;

/// `app.register_type` for each of a list of types.
macro_rules! register {
    ($app:ident: $($type:ty),* $(,)?) => {
        $( $app.register_type::<$type>(); )*
    };
}

impl Plugin for PhysicsTypeRegistrationPlugin {
    fn build(&self, app: &mut App) {
        register_schedule(app);
        register_dynamics(app);
        register_collision(app);
    }
}

fn register_schedule(app: &mut App) {
    use crate::schedule::{LastPhysicsTick, Physics, Substeps};
    use bevy_time::Time;

    register!(app: Physics, Substeps, Time<Physics>, Time<Substeps>, LastPhysicsTick);
}

fn register_dynamics(app: &mut App) {
    use crate::dynamics::{
        ccd::SpeculativeMargin,
        integrator::{CustomPositionIntegration, CustomVelocityIntegration, Gravity},
        solver::{
            ContactSoftnessCoefficients, PhysicsLengthUnit, SolverConfig,
            schedule::SubstepCount,
            softness_parameters::{SoftnessCoefficients, SoftnessParameters},
        },
    };

    register!(app:
        SpeculativeMargin, Gravity, CustomVelocityIntegration, CustomPositionIntegration,
        PhysicsLengthUnit, SolverConfig, ContactSoftnessCoefficients, SubstepCount,
        SoftnessParameters, SoftnessCoefficients,
    );
}

fn register_collision(app: &mut App) {
    use crate::{
        collider_tree::{ColliderTreeOptimization, TreeOptimizationMode},
        collision::narrow_phase::NarrowPhaseConfig,
    };

    register!(app: NarrowPhaseConfig, ColliderTreeOptimization, TreeOptimizationMode);
}
