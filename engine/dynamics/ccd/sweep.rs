//! The system that sweeps bodies after the substeps.

use bevy_ecs::{prelude::*, system::SystemParam};
use bevy_time::Time;
use kernel::{
    ccd::{SweepBuffers, SweepInput, Swept},
    table::NONE,
};

use super::{SweepMode, SweptCcd};
use crate::{
    collision::{
        collider::Collider, contacts::Foreign, custom_contacts::CustomContacts, narrow_phase::ContactResponse,
    },
    dynamics::{
        ids::BodyId,
        solver::{
            config::{LINEAR_SLOP, PhysicsLengthUnit},
            diagnostics::SolverDiagnostics,
            substeps::{OwnSubstepSystems, StepSolver},
        },
        tables::{Bodies, Colliders, Contacts},
    },
    math::to_f32,
    schedule::Physics,
    threads::Threads,
};

/// Buffers of sweeps, reused between steps.
#[derive(Default)]
pub(crate) struct Buffers {
    workers: Vec<SweepBuffers>,
    swept: Vec<(u32, Swept)>,
}

/// Resources that decide whether and how bodies are swept.
#[derive(SystemParam)]
pub(crate) struct Settings<'w> {
    substeps: Res<'w, OwnSubstepSystems>,
    response: Option<Res<'w, ContactResponse>>,
    unit: Res<'w, PhysicsLengthUnit>,
    time: Res<'w, Time<Physics>>,
}

/// Moves bodies that penetrated an obstacle during the substeps back to the time of impact.
pub(crate) fn sweep_bodies(
    swept: Query<(&BodyId, &SweptCcd)>,
    shapes: Query<&Collider>,
    settings: Settings,
    (bodies, colliders, contacts, custom): (Res<Bodies>, Res<Colliders>, Res<Contacts>, Res<CustomContacts>),
    (mut solver, threads): (ResMut<StepSolver>, Res<Threads>),
    mut buffers: Local<Buffers>,
    mut diagnostics: ResMut<SolverDiagnostics>,
) {
    // Without contact response there are no sweeps.
    if !settings.substeps.solves || settings.response.is_none_or(|response| !response.0) {
        return;
    }
    let start = bevy_platform::time::Instant::now();
    let input = SweepInput {
        bodies: &bodies.table,
        colliders: &colliders.table,
        trees: &colliders.trees.trees,
        contacts: &contacts.table,
        source: &Foreign { colliders: &shapes, entities: &colliders.entities, custom: &custom },
        tolerance: LINEAR_SLOP as f32 * settings.unit.metres(),
        dt: settings.time.delta_secs(),
    };
    let Buffers { workers, swept: listed } = &mut *buffers;
    solver.kernel.stop_fast(&input, &bodies.listed, workers, &threads.pool);
    listed.clear();
    let known = swept.iter().filter(|(id, _)| id.0 != NONE);
    listed.extend(known.map(|(id, swept)| (id.0, to_kernel(swept))));
    listed.sort_unstable_by_key(|(id, _)| *id);
    solver.kernel.stop_swept(&input, listed, workers, &threads.pool);
    diagnostics.swept_ccd += start.elapsed();
}

fn to_kernel(swept: &SweptCcd) -> Swept {
    Swept {
        turns: swept.mode == SweepMode::NonLinear,
        include_dynamic: swept.include_dynamic,
        linear_threshold: to_f32(swept.linear_threshold),
        angular_threshold: to_f32(swept.angular_threshold),
    }
}
