//! Applies forces to the solver's rows: bodies with forces wake and are accelerated in the substeps of one
//! step.

use bevy_app::App;
use bevy_ecs::{
    change_detection::Tick,
    prelude::*,
    query::QueryData,
    system::{SystemChangeTick, SystemParam},
};
use bevy_log::warn_once;
use bevy_platform::time::Instant;
use kernel::{
    data::BitSet,
    solver::{BodyRow, BodyRows, Thrust},
    table::{BodyKind, NONE},
};

use super::{
    constant::{
        ConstantAngularAcceleration, ConstantForce, ConstantLinearAcceleration, ConstantLocalForce,
        ConstantLocalLinearAcceleration, ConstantTorque,
    },
    dim::{
        AccumulatedLocalAcceleration, ChangedConstant, Constants, HasConstant, LocalTorques, local_torques,
        to_body, to_world,
    },
    pushed::{PushedVelocity, Quantity},
    response::Response,
};
use crate::{
    dynamics::{
        ids::BodyId,
        integrator::{CustomVelocityIntegration, VelocityIntegrationData},
        rigid_body::{
            AngularVelocity, LinearVelocity, LockedAxes, RigidBody, RigidBodyDisabled,
            mass_properties::components::{ComputedAngularInertia, ComputedMass},
        },
        solver::{diagnostics::SolverDiagnostics, substeps::StepSolver},
        tables::{Bodies, Tables, is_minority},
    },
    math::{AngularVector, Vector, angular_to_kernel, vector_to_kernel},
    noted::Noted,
    physics_transform::Rotation,
    scan::{IN_TABLES, Since},
};

/// Bodies with forces, from detection to the end of the step that applies them.
#[derive(Resource, Debug, Default)]
pub(crate) struct ForceList {
    /// Bodies with detected forces that are not applied yet.
    found: Noted,
    /// Bodies that lost a constant force.
    released: Noted,
    /// Bodies whose forces act in this step, with the accelerations read from them.
    applied: Vec<Applied>,
    /// Ids of bodies whose constant forces were already added.
    done: BitSet,
    /// Ticks of the last scans for forces in world axes and for forces in the frame of bodies.
    scanned: [Tick; 2],
}

/// The accelerations of a body in this step.
#[derive(Debug)]
struct Applied {
    entity: Entity,
    linear: Vector,
    angular: AngularVector,
    local: AccumulatedLocalAcceleration,
}

/// Adds the list, and the observer of removed constant forces.
pub(crate) fn watch(app: &mut App) {
    app.init_resource::<ForceList>().add_observer(
        |on: On<Remove, Constants>, mut list: ResMut<ForceList>| _ = list.released.note(on.entity),
    );
}

/// The accumulated forces of a body, and a pending change of velocity.
type Sums = (
    Entity,
    Ref<'static, VelocityIntegrationData>,
    Ref<'static, AccumulatedLocalAcceleration>,
    &'static mut PushedVelocity,
);

/// The velocity of a body.
type Velocities = (&'static mut LinearVelocity, &'static mut AngularVelocity);

/// Whether a body has no accelerations.
pub(super) fn is_idle(data: &VelocityIntegrationData, local: &AccumulatedLocalAcceleration) -> bool {
    data.is_idle() && local.linear == Vector::ZERO && local.local_angular() == AngularVector::default()
}

/// Queries for the forces of bodies and their velocities.
#[derive(SystemParam)]
pub(crate) struct Pushed<'w, 's> {
    sums: Query<'w, 's, Sums, With<BodyId>>,
    velocities: Query<'w, 's, Velocities>,
}

impl Pushed<'_, '_> {
    /// Writes the velocity of a body if a change is pending. Returns whether it was written.
    fn write(&mut self, entity: Entity) -> bool {
        let Ok((.., mut pushed)) = self.sums.get_mut(entity) else { return false };
        let Ok((mut linear, mut angular)) = self.velocities.get_mut(entity) else { return false };
        let pushed = pushed.bypass_change_detection();
        let (to, turn) = (pushed.linear.take(linear.0), pushed.angular.take(angular.0));
        to.is_some_and(|to| linear.set_if_neq(LinearVelocity(to)))
            | turn.is_some_and(|turn| angular.set_if_neq(AngularVelocity(turn)))
    }

    /// The velocity of a body, if it is finite.
    fn velocity(&self, entity: Entity) -> Option<BodyRow> {
        let (linear, angular) = self.velocities.get(entity).ok()?;
        let (v, w) = (vector_to_kernel(linear.0), angular_to_kernel(angular.0));
        (v.is_finite() && w.is_finite()).then(|| BodyRow::new(v, w))
    }
}

/// Wakes bodies with forces, and bodies whose constant force changed or ended.
pub(crate) fn follow_forces(
    mut pushed: Pushed,
    (ids, changed): (Query<&BodyId>, Query<&BodyId, ChangedConstant>),
    mut list: ResMut<ForceList>,
    mut tables: Tables,
    system: SystemChangeTick,
) {
    let ForceList { found, released, scanned, .. } = &mut *list;
    let since = Since::new(scanned[0], system);
    scanned[0] = system.this_run();
    for (entities, data, local, waiting) in pushed.sums.contiguous_iter_mut().expect(IN_TABLES) {
        since.rows([data.changed_ticks_slice()], |row| {
            if !is_idle(&data[row], &local[row]) || waiting[row].is_set() {
                found.note(entities[row]);
            }
        });
    }
    for entity in found.entities() {
        pushed.write(entity);
        // A force that wakes the body has reset its `SleepTimer`.
        if let Ok((_, data, local, _)) = pushed.sums.get(entity)
            && !is_idle(&data, &local)
            && let Ok(id) = ids.get(entity)
            && id.0 != NONE
            && !tables.bodies.table[id.0].awake
        {
            wake(id.0, &mut tables);
        }
    }
    if changed.is_empty() && released.is_empty() {
        return;
    }
    // Bodies that were put to sleep in this step fell asleep with this force, because a level may be spawned
    // asleep.
    let flipped = tables.bodies.table.flipped_set();
    for id in changed.iter().filter(|id| !flipped.contains(id.0)) {
        wake(id.0, &mut tables);
    }
    for (entity, ()) in released.drain() {
        if let Ok(id) = ids.get(entity) {
            wake(id.0, &mut tables);
        }
    }
}

fn wake(id: u32, tables: &mut Tables) {
    if id != NONE && tables.bodies.table[id].kind == BodyKind::Dynamic {
        tables.contact_manager().wake_body(id);
    }
}

/// The properties of a body that determine its acceleration.
#[derive(QueryData)]
pub(crate) struct ForceInput {
    id: &'static BodyId,
    body: &'static RigidBody,
    rotation: &'static Rotation,
    mass: &'static ComputedMass,
    inertia: &'static ComputedAngularInertia,
    locks: Option<&'static LockedAxes>,
    data: &'static VelocityIntegrationData,
    local: &'static AccumulatedLocalAcceleration,
    force: Option<&'static ConstantForce>,
    torque: Option<&'static ConstantTorque>,
    local_force: Option<&'static ConstantLocalForce>,
    linear: Option<&'static ConstantLinearAcceleration>,
    angular: Option<&'static ConstantAngularAcceleration>,
    local_linear: Option<&'static ConstantLocalLinearAcceleration>,
    local_torques: LocalTorques,
    is_disabled: Has<RigidBodyDisabled>,
    integrates: Has<CustomVelocityIntegration>,
}

impl ForceInputItem<'_, '_> {
    /// The acceleration of the body from accumulated and constant forces.
    fn thrust(&self) -> Thrust {
        let response = Response::new(self.mass, self.inertia, self.rotation, self.locks);
        let linear = self.linear.map_or(Vector::ZERO, |a| response.free_linear(a.0));
        let angular = self.angular.map_or(AngularVector::default(), |a| response.free_angular(a.0));
        let local_linear = self.local_linear.map_or(Vector::ZERO, |a| a.0);
        let (local_torque, local_angular) = local_torques(&self.local_torques);
        let turning = to_body(self.rotation, response.angular(to_world(self.rotation, local_torque)));
        let by_force = self.force.map_or(Vector::ZERO, |f| response.linear(f.0));
        let by_torque = self.torque.map_or(AngularVector::default(), |t| response.angular(t.0));
        let by_local_force = self.local_force.map_or(Vector::ZERO, |f| f.0 * self.mass.inverse());
        Thrust {
            linear: vector_to_kernel(self.data.linear_increment + by_force + linear),
            angular: angular_to_kernel(self.data.angular_increment + by_torque + angular),
            local_linear: vector_to_kernel(self.local.linear + by_local_force + local_linear),
            local_angular: angular_to_kernel(self.local.local_angular() + turning + local_angular),
        }
    }
}

/// Adds forces to the rows of awake bodies.
pub(crate) fn apply_forces(
    mut pushed: Pushed,
    inputs: Query<ForceInput>,
    constants: Query<(Entity, &BodyId), HasConstant>,
    (mut solver, bodies): (ResMut<StepSolver>, Res<Bodies>),
    mut list: ResMut<ForceList>,
    mut diagnostics: ResMut<SolverDiagnostics>,
    system: SystemChangeTick,
) {
    let start = Instant::now();
    find(&mut pushed, &bodies, &mut list, system);
    let ForceList { found, applied, done, .. } = &mut *list;
    applied.clear();
    if found.is_empty() && constants.is_empty() {
        return;
    }
    done.clear();
    let rows = &mut solver.kernel.bodies;
    for entity in found.take() {
        let Ok(body) = inputs.get(entity) else { continue };
        let id = body.id.0;
        let row = if id == NONE { 0 } else { bodies.table.row(id) };
        if pushed.write(entity)
            && row != 0
            && let Some(velocity) = pushed.velocity(entity)
            && let Some(row) = rows.rows.get_mut(row as usize)
        {
            *row = velocity;
        }
        if is_idle(body.data, body.local) {
            continue;
        }
        if row == 0 && body.body.is_dynamic() && !body.is_disabled {
            // The body was spawned or pushed within the step. It enters or wakes in the next step.
            found.note(entity);
            continue;
        }
        applied.push(Applied {
            entity,
            linear: body.data.linear_increment,
            angular: body.data.angular_increment,
            local: body.local.clone(),
        });
        if row != 0 {
            done.insert(id);
            thrust(entity, &body, &pushed, &bodies, rows);
        }
    }
    for (entity, id) in &constants {
        if id.0 != NONE
            && bodies.table.row(id.0) != 0
            && !done.contains(id.0)
            && let Ok(body) = inputs.get(entity)
        {
            thrust(entity, &body, &pushed, &bodies, rows);
        }
    }
    diagnostics.update_velocity_increments += start.elapsed();
}

/// Adds the forces on a body to its row, if the body responds to forces.
fn thrust(entity: Entity, body: &ForceInputItem, pushed: &Pushed, bodies: &Bodies, rows: &mut BodyRows) {
    let row = bodies.table.row(body.id.0);
    let is_dynamic = row >= rows.first_dynamic() && (row as usize) < rows.rows.len();
    let moves = is_dynamic && !body.is_disabled && !body.integrates;
    // A body with a velocity that is not finite is disabled at the end of the stage.
    if !moves || pushed.velocity(entity).is_none() {
        return;
    }
    let thrust = body.thrust();
    if thrust.is_finite() {
        rows.thrust(row as usize, &thrust, bodies.table.poses[body.id.0 as usize].rotation);
    } else {
        warn_once!("the forces on {entity} are not finite or too large, and are ignored in this step");
    }
}

/// Finds forces on awake bodies, including forces that were applied within this step.
fn find(pushed: &mut Pushed, bodies: &Bodies, list: &mut ForceList, system: SystemChangeTick) {
    let ForceList { found, scanned, .. } = list;
    if is_minority(bodies.listed.len(), [pushed.sums.iter().size_hint()]) {
        let awake = bodies.listed.iter().map(|id| bodies.entities[*id as usize]);
        for (entity, data, local, waiting) in pushed.sums.iter_many(awake) {
            if !is_idle(&data, &local) || waiting.is_set() {
                found.note(entity);
            }
        }
        return;
    }
    let since = scanned.map(|tick| Since::new(tick, system));
    *scanned = [system.this_run(); 2];
    for (entities, data, local, waiting) in pushed.sums.contiguous_iter_mut().expect(IN_TABLES) {
        let mut note = |row: usize| {
            if !is_idle(&data[row], &local[row]) || waiting[row].is_set() {
                found.note(entities[row]);
            }
        };
        since[0].rows([data.changed_ticks_slice()], &mut note);
        since[1].rows([local.changed_ticks_slice()], &mut note);
    }
}

/// Sets the accelerations of this step to zero. Accelerations that were added after they were read remain for
/// the next step.
pub(crate) fn clear_forces(
    mut sums: Query<(&mut VelocityIntegrationData, &mut AccumulatedLocalAcceleration)>,
    mut list: ResMut<ForceList>,
) {
    for read in list.applied.drain(..) {
        let Ok((mut data, mut local)) = sums.get_mut(read.entity) else { continue };
        let (data, local) = (data.bypass_change_detection(), local.bypass_change_detection());
        data.linear_increment = data.linear_increment.less(read.linear);
        data.angular_increment = data.angular_increment.less(read.angular);
        local.linear = local.linear.less(read.local.linear);
        local.subtract_angular(&read.local);
    }
}
