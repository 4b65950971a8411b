//! The bodies connected by constraints of the app, in one table for all types of constraints.
//!
//! At the start of a step each type notes its constraints. A noted constraint that is not in the kernel is
//! added, and a constraint in the kernel that was not noted is removed. Therefore a constraint may be spawned
//! before its bodies, and a body may leave and return.

use bevy_app::App;
use bevy_ecs::{
    entity::EntityHashMap,
    entity_disabling::Disabled,
    prelude::*,
    schedule::{IntoScheduleConfigs, SystemSet},
};
use bevy_log::warn;
use kernel::{
    graph::ConstraintKind,
    solver::CustomConstraint,
    table::{BodyTable, NONE},
};
use std::collections::BTreeMap;

use crate::{
    collision::contact_types::views::forget_views,
    dynamics::{ids::BodyId, solver::step_solver::StepSolver, tables::Tables},
    schedule::PhysicsSchedule,
    step::{self, Stage},
};

/// The number of the first type that XPBD solves. The kernel solves types with lower numbers.
#[cfg(feature = "xpbd_joints")]
pub(crate) const FIRST_XPBD: u32 = 1 << 31;

/// A constraint: the number of its type, and its entity. An entity may have one constraint of each type.
pub(crate) type Key = (u32, Entity);

/// A constraint noted by the app.
struct Wanted {
    key: Key,
    ends: [Entity; 2],
    /// Its implementation, if the constraint is new.
    act: Option<Box<dyn CustomConstraint>>,
}

impl Clone for Wanted {
    fn clone(&self) -> Self {
        Self { key: self.key, ends: self.ends, act: self.act.as_ref().map(|act| act.boxed()) }
    }
}

/// A constraint in the kernel.
#[derive(Clone, Copy, Debug)]
struct Tied {
    id: u32,
    /// Entities of the bodies, and their ids.
    ends: [Entity; 2],
    bodies: [u32; 2],
}

impl Tied {
    /// Whether the constraint is in the kernel between the current bodies of these ends.
    fn is_current(&self, ends: [Entity; 2], bodies: &BodyTable, ids: &BodyIds) -> bool {
        let is_live = bodies.constraints(ConstraintKind::Custom).is_live(self.id);
        let found = ends.map(|end| ids.get(end).ok().map(|id| id.0));
        is_live && ends == self.ends && found == self.bodies.map(Some)
    }
}

/// Ids of bodies by entity.
pub(crate) type BodyIds<'w, 's> = Query<'w, 's, &'static BodyId, Allow<Disabled>>;

/// Why a constraint has no effect, as reported to the app.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Complaint {
    SameBody,
    NoBody(Entity),
    NotFinite,
}

/// All constraints of the app.
#[derive(Resource, Clone, Default)]
pub(crate) struct Ties {
    wanted: Vec<Wanted>,
    /// Constraints in the kernel, ordered by type and entity. They get their ids in this order.
    held: BTreeMap<Key, Tied>,
    told: EntityHashMap<Complaint>,
}

impl Ties {
    /// Notes a constraint of the app. `act` is its implementation, if the kernel does not [have](Self::id) it
    /// yet.
    pub(crate) fn want(&mut self, key: Key, ends: [Entity; 2], act: Option<Box<dyn CustomConstraint>>) {
        self.wanted.push(Wanted { key, ends, act });
    }

    /// The id of a constraint in the kernel.
    pub(crate) fn id(&self, key: Key) -> Option<u32> {
        self.held.get(&key).map(|tied| tied.id)
    }

    /// The ids of a constraint and its bodies, if it is in the kernel between the current bodies of its ends.
    pub(crate) fn current(
        &self,
        key: Key,
        ends: [Entity; 2],
        bodies: &BodyTable,
        ids: &BodyIds,
    ) -> Option<(u32, [u32; 2])> {
        let tied = self.held.get(&key)?;
        tied.is_current(ends, bodies, ids).then_some((tied.id, tied.bodies))
    }

    /// Warns once that a constraint gave velocities that are not finite.
    pub(crate) fn tell_not_finite(&mut self, entity: Entity) {
        if self.told.insert(entity, Complaint::NotFinite) != Some(Complaint::NotFinite) {
            warn!("the constraint {entity} gave a velocity that is not finite, which is ignored");
        }
    }

    fn tell(&mut self, entity: Entity, complaint: Complaint) {
        if self.told.insert(entity, complaint) == Some(complaint) {
            return;
        }
        match complaint {
            Complaint::SameBody => warn!("the constraint {entity} has no effect: both its bodies are one"),
            Complaint::NoBody(end) => {
                warn!("the constraint {entity} has no effect: {end} is no `RigidBody` yet, or no more");
            }
            Complaint::NotFinite => {}
        }
    }
}

/// The systems that note constraints, before [`settle_ties`].
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct NoteTies;

/// Adds the table, and the system that updates it.
pub(crate) fn install(app: &mut App) {
    if app.world().contains_resource::<Ties>() {
        return;
    }
    app.init_resource::<Ties>();
    app.configure_sets(PhysicsSchedule, NoteTies.in_set(Stage::SettleConstraints));
    let settle = settle_ties.pipe(forget_views).in_set(Stage::SettleConstraints).after(NoteTies);
    step::add_systems(app, PhysicsSchedule, settle);
}

/// Adds noted constraints to the kernel, and removes constraints that were not noted.
fn settle_ties(mut ties: ResMut<Ties>, mut solver: ResMut<StepSolver>, mut tables: Tables, ids: BodyIds) {
    let ties = ties.bypass_change_detection();
    if ties.wanted.is_empty() && ties.held.is_empty() {
        return;
    }
    let mut wanted = core::mem::take(&mut ties.wanted);
    wanted.sort_by_key(|wanted| wanted.key);
    let id_of = |end: Entity| ids.get(end).ok().map(|id| id.0);
    let find = |key: Key| wanted.binary_search_by_key(&key, |wanted| wanted.key).ok();
    let customs = &mut solver.kernel.customs;
    // Constraints are removed first: a body that left has removed its constraints, and their ids may be
    // reused.
    ties.held.retain(|&key, tied| {
        let is_live = tables.bodies.table.constraints(ConstraintKind::Custom).is_live(tied.id);
        let is_same = |wanted: &Wanted| tied.is_current(wanted.ends, &tables.bodies.table, &ids);
        let stays = find(key).is_some_and(|place| is_same(&wanted[place]));
        if is_live && !stays {
            let removed = customs.remove(&mut tables.contact_manager(), tied.id);
            debug_assert!(removed.is_ok(), "{key:?} is in the kernel: {removed:?}");
        }
        stays
    });
    ties.told.retain(|entity, _| wanted.iter().any(|wanted| wanted.key.1 == *entity));
    for Wanted { key, ends, act } in wanted.drain(..) {
        if ties.held.contains_key(&key) {
            continue;
        }
        if ends[0] == ends[1] {
            ties.tell(key.1, Complaint::SameBody);
            continue;
        }
        let bodies = match ends.map(|end| id_of(end).ok_or(end)) {
            [Ok(a), Ok(b)] => [a, b],
            [Err(end), _] | [_, Err(end)] => {
                ties.tell(key.1, Complaint::NoBody(end));
                continue;
            }
        };
        // A constraint waits for its bodies.
        if !bodies.contains(&NONE)
            && let Ok(id) = customs.add(&mut tables.contact_manager(), bodies, act)
        {
            ties.held.insert(key, Tied { id, ends, bodies });
        }
    }
    ties.wanted = wanted;
}
