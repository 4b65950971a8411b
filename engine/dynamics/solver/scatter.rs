//! From rows back to components, and which bodies have come to rest.

use bevy_ecs::{prelude::*, query::QueryData, system::SystemChangeTick};
use bevy_time::Time;
use kernel::{
    math::{Rot, Vector as KernelVector, WorldPose},
    solver::BodyRows,
    table::{BodyTable, NONE, Velocity},
};

use crate::{
    dynamics::{
        ids::BodyId,
        integrator::CustomPositionIntegration,
        quarantine::quarantine,
        rigid_body::{
            AngularVelocity, LinearVelocity, RigidBodyDisabled,
            sleeping::{SleepThreshold, SleepTimer, SleepingDisabled},
        },
        solver::{config::PhysicsLengthUnit, diagnostics::SolverDiagnostics, substeps::StepSolver},
        tables::{Bodies, is_minority},
    },
    math::{angular_from_kernel, vector_from_kernel},
    physics_transform::{Position, Rotation, set_pose},
    schedule::Physics,
};

/// What a body's motion is written to.
#[derive(QueryData)]
#[query_data(mutable)]
pub(crate) struct Output {
    entity: Entity,
    id: &'static BodyId,
    position: &'static mut Position,
    rotation: &'static mut Rotation,
    linear: &'static mut LinearVelocity,
    angular: &'static mut AngularVelocity,
    sleepless: Has<SleepingDisabled>,
}

/// What most bodies do not have.
#[derive(QueryData)]
#[query_data(mutable)]
pub(crate) struct OutputOptions {
    threshold: Option<&'static SleepThreshold>,
    timer: Option<&'static mut SleepTimer>,
    own_position: Has<CustomPositionIntegration>,
    disabled: Has<RigidBodyDisabled>,
}

impl OutputOptionsItem<'_, '_> {
    /// None of it.
    const NONE: Self = Self { threshold: None, timer: None, own_position: false, disabled: false };
}

/// The bodies that have none of the options. Bodies are walked through in two loops: asking each for what nearly none
/// has would be a quarter of the work.
type Plain = (
    Without<SleepThreshold>,
    Without<SleepTimer>,
    Without<CustomPositionIntegration>,
    Without<RigidBodyDisabled>,
);
/// All others.
type Special =
    Or<(With<SleepThreshold>, With<SleepTimer>, With<CustomPositionIntegration>, With<RigidBodyDisabled>)>;

/// Folds each awake body's motion into its pose, and writes pose and velocity where they changed.
///
/// A body whose result is not finite keeps the pose it had, stops, and is disabled with one warning: a NaN
/// must not spread.
pub(crate) fn scatter_bodies(
    (mut plain, mut special): (Query<Output, Plain>, Query<(Output, OutputOptions), Special>),
    solver: Res<StepSolver>,
    (time, unit): (Res<Time<Physics>>, Res<PhysicsLengthUnit>),
    mut bodies: ResMut<Bodies>,
    mut diagnostics: ResMut<SolverDiagnostics>,
    mut commands: Commands,
    system: SystemChangeTick,
) {
    let start = bevy_platform::time::Instant::now();
    bodies.written = system.this_run();
    let Bodies { table, seen, listed, entities, some, .. } = &mut *bodies;
    let scatter = Scatter { rows: &solver.kernel.bodies, dt: time.delta_secs(), unit: unit.metres() };
    if is_minority(listed.len(), [plain.iter().size_hint(), special.iter().size_hint()]) {
        some.clear();
        some.extend(listed.iter().map(|id| entities[*id as usize]));
        let mut found = plain.iter_many_mut(&*some);
        while let Some(item) = found.fetch_next() {
            scatter.body(item, OutputOptionsItem::NONE, table, seen, &mut commands);
        }
        let mut found = special.iter_many_mut(&*some);
        while let Some((item, options)) = found.fetch_next() {
            scatter.body(item, options, table, seen, &mut commands);
        }
    } else {
        for item in &mut plain {
            scatter.body(item, OutputOptionsItem::NONE, table, seen, &mut commands);
        }
        for (item, options) in &mut special {
            scatter.body(item, options, table, seen, &mut commands);
        }
    }
    diagnostics.finalize += start.elapsed();
}

/// What is the same for all bodies.
struct Scatter<'a> {
    rows: &'a BodyRows,
    dt: f32,
    unit: f32,
}

impl Scatter<'_> {
    #[inline(always)]
    fn body(
        &self,
        item: OutputItem,
        options: OutputOptionsItem,
        bodies: &mut BodyTable,
        seen: &mut [WorldPose],
        commands: &mut Commands,
    ) {
        let OutputItem { entity, id, position, rotation, linear, angular, sleepless } = item;
        let id = id.0;
        let row = if id == NONE { 0 } else { bodies.row(id) };
        if row == 0 || options.disabled {
            return;
        }
        let body = &self.rows.rows[row as usize];
        let (v, w) = body.velocity();
        let (moved, turned) = if options.own_position { Default::default() } else { body.delta() };
        let old = bodies.poses[id as usize];
        let mut pose = old;
        pose.center = old.center + moved.to_world();
        pose.rotation = turned.mul(old.rotation).renormalized();
        let placed = pose.center.is_finite_world() & pose.rotation.is_finite();
        if !(placed & v.is_finite() & w.is_finite()) {
            quarantine(entity, Some(bodies.frame(id)), commands);
            return;
        }
        if row >= self.rows.first_dynamic() {
            pose.speed = v.length();
            bodies.velocities[id as usize] = Velocity { linear: v, angular: w };
            write_changed(linear, LinearVelocity(vector_from_kernel(v)));
            write_changed(angular, AngularVelocity(angular_from_kernel(w)));
        }
        bodies.poses[id as usize] = pose;
        let body = &mut bodies[id];
        if (pose.center, pose.rotation) != (old.center, old.rotation) {
            let frame = pose.frame(body.local_center);
            seen[id as usize] = frame;
            set_pose(position, rotation, frame);
        }
        let threshold = options.threshold.copied().unwrap_or_default();
        // Where the app moves the body, this step has not: its velocity says how fast it means to.
        let motion = || match options.own_position {
            true => (v * self.dt, w.length_squared() * self.dt * self.dt),
            false => (moved, Rot::IDENTITY.difference(turned).length_squared()),
        };
        let rests = !sleepless && self.is_slow(&threshold, motion());
        let timer = &mut body.sleep_timer;
        *timer = if rests { *timer + self.dt } else { 0.0 };
        if let Some(mut shown) = options.timer {
            shown.0 = *timer;
        }
    }

    /// Whether a body has moved by `way`, and turned by the root of `angle_squared`, less in this step than
    /// its thresholds allow. Judged on displacement, not velocity: what jitters in place rests.
    fn is_slow(&self, threshold: &SleepThreshold, (way, angle_squared): (KernelVector, f32)) -> bool {
        let (far, wide) = (threshold.linear * self.unit * self.dt, threshold.angular * self.dt);
        // A negative threshold, or NaN, never rests.
        far >= 0.0 && wide >= 0.0 && way.length_squared() <= far * far && angle_squared <= wide * wide
    }
}

/// Writes, and marks as changed, only what differs.
fn write_changed<T: PartialEq>(mut target: Mut<T>, value: T) {
    if *target != value {
        *target = value;
    }
}
