//! [`ConstraintPlugin`] activates a type of constraints.

use bevy_app::{App, Plugin};
use bevy_ecs::{prelude::*, system::SystemParam};
use core::marker::PhantomData;

use super::{
    Constraint,
    act::Act,
    ties::{self, BodyIds, NoteTies, Ties},
};
use crate::{
    dynamics::{joints::JointDisabled, solver::step_solver::StepSolver, tables::Tables},
    schedule::PhysicsSchedule,
    step,
};

/// Activates constraints of a type; see the [module](super). Add it after
/// [`PhysicsPlugins`](crate::PhysicsPlugins).
pub struct ConstraintPlugin<C: Constraint>(PhantomData<fn() -> C>);

impl<C: Constraint> Default for ConstraintPlugin<C> {
    fn default() -> Self {
        Self(PhantomData)
    }
}

/// The number of types.
#[derive(Resource, Default)]
struct TypeCount(u32);

/// The number of a type: the index of its plugin among the plugins of all types.
#[derive(Resource)]
struct TypeNumber<C>(u32, PhantomData<fn() -> C>);

impl<C: Constraint> Plugin for ConstraintPlugin<C> {
    fn build(&self, app: &mut App) {
        step::install(app);
        ties::install(app);
        let mut count = app.world_mut().get_resource_or_init::<TypeCount>();
        let number = count.0;
        count.0 += 1;
        app.insert_resource(TypeNumber::<C>(number, PhantomData));
        step::add_systems(app, PhysicsSchedule, note_constraints::<C>.in_set(NoteTies));
    }
}

/// Notes the constraints of a type, and sends changes to the kernel.
fn note_constraints<C: Constraint>(
    constraints: Query<(Entity, Ref<C>), Without<JointDisabled>>,
    number: Res<TypeNumber<C>>,
    mut ties: ResMut<Ties>,
    mut solver: ResMut<StepSolver>,
    mut tables: Tables,
    ids: BodyIds,
) {
    let ties = ties.bypass_change_detection();
    for (entity, constraint) in &constraints {
        let key = (number.0, entity);
        let ends = constraint.entities();
        let Some((id, bodies)) = ties.current(key, ends, &tables.bodies.table, &ids) else {
            ties.want(key, ends, Some(Box::new(Act::new(C::clone(&constraint)))));
            continue;
        };
        ties.want(key, ends, None);
        let customs = &mut solver.kernel.customs;
        if customs.is_faulty(id) {
            ties.tell_not_finite(entity);
        }
        if constraint.is_changed()
            && let Some(act) = customs.act_mut(id).and_then(|act| act.as_any_mut().downcast_mut::<Act<C>>())
        {
            act.constraint = C::clone(&constraint);
            bodies.into_iter().for_each(|body| tables.contact_manager().wake_body(body));
        }
    }
}

/// Reads the rows of constraints at the end of the last step in which they acted, for example their impulses.
#[derive(SystemParam)]
pub struct ConstraintRows<'w, C: Constraint> {
    ties: Res<'w, Ties>,
    solver: Res<'w, StepSolver>,
    number: Res<'w, TypeNumber<C>>,
}

impl<C: Constraint> ConstraintRows<'_, C> {
    /// The rows of an entity's constraint. `None` before its first step, and while it does not act.
    pub fn get(&self, entity: Entity) -> Option<&C::Rows> {
        let id = self.ties.id((self.number.0, entity))?;
        self.solver.kernel.customs.act(id)?.as_any().downcast_ref::<Act<C>>()?.last.as_ref()
    }
}
