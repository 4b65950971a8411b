//! The queue of bodies whose mass is recomputed, and the systems that recompute it.

use bevy_ecs::{
    entity::{Entities, EntityHashSet},
    entity_disabling::Disabled,
    event::EntityEvent,
    prelude::*,
    system::{SystemParam, SystemState},
};
use bevy_transform::prelude::Transform;

use super::{
    MassPropertyChanged, MassPropertyHelper,
    components::{AngularInertia, CenterOfMass, ComputedMass, Mass, NoAutoMass, RecomputeMassProperties},
};
use crate::{
    collision::collider::{
        ColliderDisabled, Sensor, collider_hierarchy::ColliderOf, collider_transform::ColliderTransform,
    },
    dynamics::rigid_body::RigidBody,
    schedule::OnThisThread,
};

/// Filters for entities with a mass property set by the app.
type WithOwnMass = Or<(With<Mass>, With<AngularInertia>, With<CenterOfMass>)>;

/// Marks bodies for recomputation, given an entity that belongs to a body.
#[derive(SystemParam)]
pub struct MassPropertyQueue<'w, 's> {
    commands: Commands<'w, 's>,
    bodies: Query<'w, 's, Has<RecomputeMassProperties>, (With<RigidBody>, Allow<Disabled>)>,
    colliders: Query<'w, 's, &'static ColliderOf, Allow<Disabled>>,
    parents: Query<'w, 's, &'static ChildOf, Allow<Disabled>>,
}

impl MassPropertyQueue<'_, '_> {
    /// Marks the body of an entity: the entity itself, the body of a collider, or the nearest ancestor. Does
    /// nothing without a body. The mass is computed at the end of the command, and again before the next
    /// step.
    pub(crate) fn push(&mut self, entity: Entity) {
        if let Some(body) = self.mark(entity) {
            // One command per call, because the commands in between create links.
            self.commands.queue(move |world: &mut World| weigh_now(world, body));
        }
    }

    /// Marks the body to be computed before the next step.
    pub(crate) fn mark(&mut self, entity: Entity) -> Option<Entity> {
        let body = self.body_of(entity)?;
        if self.bodies.get(body) == Ok(false) {
            self.commands.entity(body).try_insert(RecomputeMassProperties);
        }
        Some(body)
    }

    fn body_of(&self, entity: Entity) -> Option<Entity> {
        if self.bodies.contains(entity) {
            return Some(entity);
        }
        if let Ok(collider) = self.colliders.get(entity) {
            return Some(collider.body);
        }
        self.parents.iter_ancestors(entity).find(|ancestor| self.bodies.contains(*ancestor))
    }
}

/// Maximum number of parts of a body that is computed after each command. If the parts of a larger body are
/// added one by one, summing all of them each time would be quadratic. Larger bodies are computed only before
/// the next step.
const MOST_PARTS_AT_ONCE: usize = 256;

/// Kept between calls, because building it takes longer than using it.
#[derive(Resource)]
struct Scales(Option<SystemState<MassPropertyHelper<'static, 'static>>>);

impl FromWorld for Scales {
    fn from_world(world: &mut World) -> Self {
        Self(Some(SystemState::new(world)))
    }
}

/// Computes the mass of a body between two commands.
fn weigh_now(world: &mut World, body: Entity) {
    let scales = |world: &mut World| world.get_resource_mut::<Scales>()?.0.take();
    let Some(mut scales) = scales(world) else { return };
    if let Ok(mut helper) = scales.get_mut(world)
        && helper.count_parts(body) <= MOST_PARTS_AT_ONCE
    {
        helper.update_mass_properties(body);
    }
    world.resource_mut::<Scales>().0 = Some(scales);
}

/// Adds the observers that mark bodies.
pub(super) fn observe(app: &mut bevy_app::App) {
    app.init_resource::<ReportedMassless>()
        .init_resource::<Scales>()
        .add_observer(weigh_new)
        .add_observer(on_event::<Remove, (Mass, AngularInertia, CenterOfMass)>)
        .add_observer(on_event::<Add, (Sensor, ColliderDisabled, Disabled)>)
        .add_observer(on_event::<Remove, (Sensor, ColliderDisabled, Disabled)>)
        .add_observer(on_event::<Insert, ColliderOf>)
        .add_observer(on_event::<Discard, ColliderOf>)
        .add_observer(on_part_detached);
}

fn on_event<E: EntityEvent, B: Bundle>(event: On<E, B>, mut queue: MassPropertyQueue) {
    queue.push(event.event_target());
}

/// Computes the mass of a new body at once, without descendants. Descendants are linked later, and then
/// included.
fn weigh_new(inserted: On<Insert, RigidBody>, mut helper: MassPropertyHelper) {
    helper.update_mass_properties(inserted.entity);
}

/// Marks the body of a part without a collider that leaves its parent. [`queue_changed`] detects its new
/// body.
fn on_part_detached(
    event: On<Discard, ChildOf>,
    parts: Query<(), (WithOwnMass, Without<ColliderOf>, Without<RigidBody>)>,
    mut queue: MassPropertyQueue,
) {
    if parts.contains(event.entity) {
        queue.push(event.entity);
    }
}

/// Marks the bodies of mutated components. It scans few entities: entities with a mass property set by the
/// app, and colliders with a parent.
pub(super) fn queue_changed(
    changed: Query<
        (Entity, Option<&Mass>, Option<&AngularInertia>, Option<&CenterOfMass>, Option<&Name>),
        MassPropertyChanged,
    >,
    moved_parts: Query<
        Entity,
        (
            WithOwnMass,
            With<ChildOf>,
            Without<ColliderOf>,
            Without<RigidBody>,
            Or<(Changed<Transform>, Changed<ChildOf>)>,
        ),
    >,
    moved_colliders: Query<&ColliderOf, (With<ChildOf>, Changed<ColliderTransform>)>,
    mut queue: MassPropertyQueue,
    mut reported: Local<Reported>,
    entities: &Entities,
    _: OnThisThread,
) {
    for (entity, mass, inertia, center, name) in &changed {
        queue.mark(entity);
        let wrong = match (mass, inertia, center) {
            (Some(Mass(mass)), ..) if mass.is_nan() || *mass < 0.0 => Some("`Mass` is negative or NaN"),
            (_, Some(inertia), _) if !inertia.is_valid() => Some("`AngularInertia` is negative or NaN"),
            (.., Some(center)) if !center.is_finite() => Some("`CenterOfMass` is infinite or NaN"),
            _ => None,
        };
        if let Some(wrong) = wrong
            && reported.is_new(entity, entities)
        {
            bevy_log::warn!(
                "the {wrong} of {}, and counts as 0; give it a valid value",
                describe(entity, name)
            );
        }
    }
    for entity in &moved_parts {
        queue.mark(entity);
    }
    for collider in &moved_colliders {
        queue.mark(collider.body);
    }
}

/// Computes the marked bodies and removes the marks.
pub(crate) fn recompute(
    marked: Query<Entity, With<RecomputeMassProperties>>,
    mut helper: MassPropertyHelper,
    mut commands: Commands,
    _: OnThisThread,
) {
    if marked.is_empty() {
        return;
    }
    let marked: Vec<Entity> = marked.iter().collect();
    for &entity in &marked {
        helper.update_mass_properties(entity);
    }
    commands.queue(move |world: &mut World| {
        for entity in marked {
            if let Ok(mut entity) = world.get_entity_mut(entity) {
                entity.remove::<RecomputeMassProperties>();
            }
        }
    });
}

/// Entities that were reported once. Despawned entities are dropped from time to time.
#[derive(Default)]
pub(super) struct Reported {
    entities: EntityHashSet,
    /// Number of entities at which despawned entities are dropped.
    full: usize,
}

impl Reported {
    /// Records an entity. Returns whether it is new.
    fn is_new(&mut self, entity: Entity, alive: &Entities) -> bool {
        if self.entities.len() >= self.full {
            self.entities.retain(|entity| alive.contains(*entity));
            self.full = 2 * self.entities.len() + 64;
        }
        self.entities.insert(entity)
    }
}

/// Bodies without mass that were reported.
#[derive(Resource, Default)]
pub(crate) struct ReportedMassless(Reported);

#[cfg(test)]
impl ReportedMassless {
    /// The number of recorded bodies.
    pub fn len(&self) -> usize {
        self.0.entities.len()
    }
}

/// Warns once of each dynamic body without mass.
///
/// Such a body falls, because gravity is an acceleration, but contacts, joints and forces do not move it. A
/// default mass would hide the mistake.
pub(crate) fn warn_of_missing_mass(
    marked: Query<
        (Entity, &RigidBody, &ComputedMass, Option<&Mass>, Has<NoAutoMass>, Option<&Name>),
        With<RecomputeMassProperties>,
    >,
    mut reported: ResMut<ReportedMassless>,
    entities: &Entities,
    _: OnThisThread,
) {
    for (entity, body, computed, mass, no_auto, name) in &marked {
        // Infinite mass may be intended.
        let wanted = mass.is_some_and(|mass| mass.is_infinite()) || no_auto && mass.is_none();
        if body.is_dynamic() && computed.is_infinite() && !wanted && reported.0.is_new(entity, entities) {
            bevy_log::warn!(
                "the dynamic body {} has no mass: it falls, but nothing that touches it moves it; \
                 insert a `Mass`, or a collider with a `ColliderDensity` above 0",
                describe(entity, name)
            );
        }
    }
}

fn describe(entity: Entity, name: Option<&Name>) -> String {
    name.map_or_else(|| entity.to_string(), |name| format!("\"{name}\" ({entity})"))
}
