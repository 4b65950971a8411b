//! The plugin that solves contacts, and the group of all plugins of the solver.

use bevy_app::{App, Plugin, PluginGroup, PluginGroupBuilder};
use bevy_ecs::{
    component::{Component, Mutable},
    schedule::ScheduleLabel,
};

#[cfg(feature = "xpbd_joints")]
use super::xpbd::XpbdSolverPlugin;
use super::{
    config::{ContactSoftnessCoefficients, PhysicsLengthUnit, SolverConfig},
    diagnostics::SolverDiagnostics,
    islands::{IslandPlugin, IslandSleepingPlugin},
    joint_graph::JointGraphPlugin,
    schedule::{SolverSchedulePlugin, SubstepSchedule},
    solver_body::SolverBodyPlugin,
};
use crate::{
    diagnostics::{Within, list},
    dynamics::{
        ccd::CcdPlugin,
        integrator::IntegratorPlugin,
        joints::{
            EntityConstraint,
            dim::each_kind,
            kind::{JointKind, KindVisitor},
        },
    },
    math::Scalar,
    schedule::PhysicsSchedule,
    step::{self, Owner},
};

/// The plugins of the solver; part of [`PhysicsPlugins`](crate::PhysicsPlugins).
///
/// | Plugin | Gives |
/// | --- | --- |
/// | [`SolverBodyPlugin`] | the bodies the solver works on |
/// | [`SolverSchedulePlugin`] | the stages of the solver and the substeps |
/// | [`IntegratorPlugin`] | gravity, the motion of bodies |
/// | [`SolverPlugin`] | contacts |
/// | [`CcdPlugin`] | sweeps of fast bodies |
/// | [`IslandPlugin`] | which bodies rest on which |
/// | [`IslandSleepingPlugin`] | sleep |
/// | `XpbdSolverPlugin` | constraints of the app, solved by XPBD |
/// | `LengthUnitCheckPlugin` | a warning if the length unit was forgotten |
/// | [`JointGraphPlugin`], for each type of joint | which joints hold which bodies |
#[derive(Debug, Default)]
pub struct SolverPlugins {
    length_unit: Option<Scalar>,
}

impl SolverPlugins {
    /// The plugins with a [`PhysicsLengthUnit`] of `unit`.
    pub fn new_with_length_unit(unit: Scalar) -> Self {
        Self { length_unit: Some(unit) }
    }
}

impl PluginGroup for SolverPlugins {
    fn build(self) -> PluginGroupBuilder {
        let group = PluginGroupBuilder::start::<Self>()
            .add(SolverBodyPlugin)
            .add(SolverSchedulePlugin)
            .add(IntegratorPlugin::default())
            .add(self.length_unit.map_or_else(SolverPlugin::default, SolverPlugin::new_with_length_unit))
            .add(CcdPlugin)
            .add(IslandPlugin)
            .add(IslandSleepingPlugin);
        #[cfg(feature = "xpbd_joints")]
        let group = group.add(XpbdSolverPlugin);
        #[cfg(feature = "default-collider")]
        let group = group.add(LengthUnitCheckPlugin);
        let mut graphs = Graphs(group);
        each_kind(&mut graphs);
        graphs.0
    }
}

/// Adds the graph plugins of all kinds of joints.
struct Graphs(PluginGroupBuilder);

impl KindVisitor for Graphs {
    fn visit<J: JointKind + EntityConstraint<2> + Component<Mutability = Mutable>>(&mut self) {
        let group = core::mem::replace(&mut self.0, PluginGroupBuilder::start::<SolverPlugins>());
        self.0 = group.add(JointGraphPlugin::<J>::default());
    }
}

/// Warns once if all moving bodies are too large or too small for gravity. Then [`PhysicsLengthUnit`] was
/// probably forgotten: in a 2D game in pixels with a length unit of 1, or in a game in metres with a length
/// unit of 100.
///
/// It checks the first second of physics at most, and stops at the first dynamic or kinematic collider of
/// ordinary size. Beyond Avian.
#[cfg(feature = "default-collider")]
pub struct LengthUnitCheckPlugin;

#[cfg(feature = "default-collider")]
impl Plugin for LengthUnitCheckPlugin {
    fn build(&self, app: &mut App) {
        use super::length_unit::{Search, check_length_unit, goes_on};
        use bevy_ecs::schedule::IntoScheduleConfigs;
        app.init_resource::<Search>().add_systems(bevy_app::Last, check_length_unit.run_if(goes_on));
    }
}

/// Solves contacts, in the stages of [`SolverSystems`](super::schedule::SolverSystems).
#[derive(Default)]
pub struct SolverPlugin {
    length_unit: Option<Scalar>,
}

impl SolverPlugin {
    /// The plugin with a [`PhysicsLengthUnit`] of `unit`. The default plugin keeps the existing resource,
    /// or 1.
    pub fn new_with_length_unit(unit: Scalar) -> Self {
        Self { length_unit: Some(unit) }
    }
}

impl Plugin for SolverPlugin {
    fn build(&self, app: &mut App) {
        if let Some(unit) = self.length_unit {
            app.insert_resource(PhysicsLengthUnit::valid_or_default(unit));
        }
        app.init_resource::<PhysicsLengthUnit>()
            .init_resource::<SolverConfig>()
            .init_resource::<ContactSoftnessCoefficients>();

        list::<SolverDiagnostics>(app, Within::Step);
        step::install(app);
        step::add_substep_systems_of(Owner::Solver, app, SubstepSchedule.intern());
        step::add_systems_of(Owner::Solver, app, PhysicsSchedule.intern());
    }
}
