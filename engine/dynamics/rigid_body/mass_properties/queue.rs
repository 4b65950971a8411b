//! Which bodies have to be weighed again, and the systems that weigh them.

use bevy_ecs::{
    entity::EntityHashSet, entity_disabling::Disabled, event::EntityEvent, prelude::*, system::SystemParam,
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

/// Entities with a mass property that the user gave.
type WithOwnMass = Or<(With<Mass>, With<AngularInertia>, With<CenterOfMass>)>;

/// Marks bodies for recomputation, given an entity that belongs to one.
#[derive(SystemParam)]
pub struct MassPropertyQueue<'w, 's> {
    commands: Commands<'w, 's>,
    bodies: Query<'w, 's, Has<RecomputeMassProperties>, (With<RigidBody>, Allow<Disabled>)>,
    colliders: Query<'w, 's, &'static ColliderOf, Allow<Disabled>>,
    parents: Query<'w, 's, &'static ChildOf, Allow<Disabled>>,
}

impl MassPropertyQueue<'_, '_> {
    /// Marks the body that `entity` is, or that it is a collider of, or below which it hangs; none if there is
    /// no such body.
    pub(crate) fn push(&mut self, entity: Entity) {
        let Some(body) = self.body_of(entity) else {
            return;
        };
        if self.bodies.get(body) == Ok(false) {
            self.commands.entity(body).try_insert(RecomputeMassProperties);
        }
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

/// Registers what makes bodies be weighed again without a scan.
pub(super) fn observe(app: &mut bevy_app::App) {
    app.init_resource::<ToldOfNoMass>()
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

/// A new body has its mass at once, as far as it is its own: what hangs on it is linked to it afterwards.
fn weigh_new(inserted: On<Insert, RigidBody>, mut helper: MassPropertyHelper) {
    helper.update_mass_properties(inserted.entity);
}

/// A descendant that weighs something without being a collider leaves its parent. Where it arrives is seen by
/// [`queue_changed`].
fn on_part_detached(
    event: On<Discard, ChildOf>,
    parts: Query<(), (WithOwnMass, Without<ColliderOf>, Without<RigidBody>)>,
    mut queue: MassPropertyQueue,
) {
    if parts.contains(event.entity) {
        queue.push(event.entity);
    }
}

/// Marks the bodies of what changed in place. Scans few entities: those with a mass property of the user's, and
/// colliders that have a parent.
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
    mut warned: Local<EntityHashSet>,
    _: OnThisThread,
) {
    for (entity, mass, inertia, center, name) in &changed {
        queue.push(entity);
        let wrong = match (mass, inertia, center) {
            (Some(Mass(mass)), ..) if mass.is_nan() || *mass < 0.0 => Some("`Mass` is negative or NaN"),
            (_, Some(inertia), _) if !inertia.is_valid() => Some("`AngularInertia` is negative or NaN"),
            (.., Some(center)) if !center.is_finite() => Some("`CenterOfMass` is infinite or NaN"),
            _ => None,
        };
        if let Some(wrong) = wrong
            && warned.insert(entity)
        {
            bevy_log::warn!(
                "the {wrong} of {}, and counts as 0; give it a valid value",
                describe(entity, name)
            );
        }
    }
    for entity in &moved_parts {
        queue.push(entity);
    }
    for collider in &moved_colliders {
        queue.push(collider.body);
    }
}

/// Weighs the marked bodies and takes the marks off.
pub(super) fn recompute(
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

/// Bodies without mass that the app was told of.
#[derive(Resource, Default)]
pub(super) struct ToldOfNoMass(EntityHashSet);

/// Names dynamic bodies that came out without mass, each once.
///
/// Such a body falls, as gravity is an acceleration, but contacts, joints and forces do not move it: the
/// alternative, a mass made up by the engine, would hide the mistake and be wrong by any factor.
pub(super) fn warn_of_missing_mass(
    marked: Query<
        (Entity, &RigidBody, &ComputedMass, Option<&Mass>, Has<NoAutoMass>, Option<&Name>),
        With<RecomputeMassProperties>,
    >,
    mut warned: ResMut<ToldOfNoMass>,
    _: OnThisThread,
) {
    for (entity, body, computed, mass, no_auto, name) in &marked {
        // Infinite mass may be wanted.
        let wanted = mass.is_some_and(|mass| mass.is_infinite()) || no_auto && mass.is_none();
        if body.is_dynamic() && computed.is_infinite() && !wanted && warned.0.insert(entity) {
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
