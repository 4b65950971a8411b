//! Forces that were applied in ticks without a step, for example while physics is paused. Forces of the last
//! such tick act in the next step, unless other forces are applied in the tick of that step.

use bevy_ecs::{prelude::*, system::SystemChangeTick};

use super::{apply::is_idle, dim::AccumulatedLocalAcceleration};
use crate::{
    dynamics::{ids::BodyId, integrator::VelocityIntegrationData},
    math::{AngularVector, Vector},
    noted::Noted,
    scan::{IN_TABLES, Since},
};

/// The accelerations of bodies in the last tick without a step that had any: linear and angular accelerations
/// in world axes, and accelerations in the frame of the body.
#[derive(Resource, Debug, Default)]
pub(crate) struct HeldForces(Noted<(Vector, AngularVector, AccumulatedLocalAcceleration)>);

/// The accelerations of bodies.
type Sums = (Entity, &'static mut VelocityIntegrationData, &'static mut AccumulatedLocalAcceleration);

/// Takes the accelerations of a tick without a step. Otherwise the accelerations of many ticks would add up.
pub(crate) fn hold_forces(
    mut sums: Query<Sums, With<BodyId>>,
    mut held: ResMut<HeldForces>,
    system: SystemChangeTick,
) {
    let since = Since::last_run(system);
    for (entities, mut data, mut local) in sums.contiguous_iter_mut().expect(IN_TABLES) {
        let mut found = Vec::new();
        since.rows([data.changed_ticks_slice(), local.changed_ticks_slice()], |row| found.push(row));
        for row in found {
            let data = &mut data.bypass_change_detection()[row];
            let local = &mut local.bypass_change_detection()[row];
            if !is_idle(data, local) {
                let linear = core::mem::take(&mut data.linear_increment);
                let angular = core::mem::take(&mut data.angular_increment);
                held.0.put(entities[row], (linear, angular, core::mem::take(local)));
            }
        }
    }
}

/// Returns the accelerations to bodies that got no new ones since.
pub(crate) fn release_forces(mut sums: Query<Sums>, mut held: ResMut<HeldForces>) {
    for (entity, (linear, angular, turning)) in held.0.drain() {
        if let Ok((_, mut data, mut local)) = sums.get_mut(entity)
            && is_idle(&data, &local)
        {
            (data.linear_increment, data.angular_increment) = (linear, angular);
            *local = turning;
        }
    }
}
