//! Updates the tables from the components of bodies and colliders. See [`lifecycle`](super::lifecycle).

use bevy_ecs::{entity_disabling::Disabled, prelude::*, system::SystemParam};
use bevy_log::warn;
use kernel::{
    bvh::TreeKind,
    data::BitSet,
    math::{Pose, WorldPose},
    table::{BodyKind, ColliderDef, ColliderFlags, Layers, NONE, Velocity},
};

use crate::{
    collision::{
        collider::{
            Collider, ColliderDisabled, CollidingEntities, CollisionLayers, Sensor,
            collider_hierarchy::ColliderOf, collider_transform::ColliderTransform, custom::CustomShape,
        },
        collision_events::CollisionEventsEnabled,
        collision_hits::CollisionHitsEnabled,
        hooks::ActiveCollisionHooks,
    },
    dynamics::{
        ids::{BodyId, ColliderId},
        joints::table::JointTables,
        lifecycle::{IsComplete, LifecycleQueue},
        materials::{SurfaceQuery, Surfaces},
        quarantine::{is_finite, quarantine},
        rigid_body::{
            Dominance, RigidBody, RigidBodyDisabled, mass_properties::components::ComputedCenterOfMass,
        },
        sleep::SleepRequests,
        tables::{Colliders, Contacts, Tables, may_collide},
    },
    math::vector_to_kernel,
    physics_transform::{Position, Rotation, said_pose, unit_rotation, world_pose},
};

/// Components that define a body's record.
type BodyState = (
    &'static RigidBody,
    Has<RigidBodyDisabled>,
    Has<Disabled>,
    &'static Position,
    &'static Rotation,
    &'static ComputedCenterOfMass,
    Option<&'static Dominance>,
);

/// Components that define a collider's record.
type ColliderState = (
    AnyOf<(&'static Collider, &'static CustomShape)>,
    Option<&'static ColliderOf>,
    Option<&'static ColliderTransform>,
    Option<(&'static Position, &'static Rotation)>,
    Option<&'static CollisionLayers>,
    Has<Sensor>,
    Has<ColliderDisabled>,
    Has<Disabled>,
);

/// Queries of the drain.
#[derive(SystemParam)]
pub(crate) struct Census<'w, 's> {
    bodies: Query<'w, 's, BodyState, (With<BodyId>, IsComplete, Allow<Disabled>)>,
    colliders: Query<'w, 's, ColliderState, (With<ColliderId>, Allow<Disabled>)>,
    body_ids: Query<'w, 's, &'static mut BodyId, Allow<Disabled>>,
    collider_ids: Query<'w, 's, &'static mut ColliderId, Allow<Disabled>>,
    reports: Query<
        'w,
        's,
        (
            Has<CollisionEventsEnabled>,
            Has<CollidingEntities>,
            Has<CollisionHitsEnabled>,
            Option<&'static ActiveCollisionHooks>,
        ),
        Allow<Disabled>,
    >,
    surfaces: SurfaceQuery<'w, 's>,
    commands: Commands<'w, 's>,
}

/// Drains the queue: first removes lost ids, then adds, removes or retypes queued bodies, then processes
/// queued colliders. Ids follow the order in which entities were queued, not the order of entities.
pub(crate) fn drain_lifecycle(
    mut queue: ResMut<LifecycleQueue>,
    sleep: Option<Res<SleepRequests>>,
    mut tables: Tables,
    mut joints: JointTables,
    mut census: Census,
) {
    // With the sleeping plugin the set is kept: it holds only bodies that woke since the last step, because a
    // body that held them was despawned.
    if sleep.is_none() {
        tables.bodies.table.flipped.clear();
    }
    queue.is_within_step = true;
    queue.restart_log();
    let Contacts { changed, met, parted, .. } = &mut *tables.contacts;
    [changed, met, parted].into_iter().for_each(BitSet::clear);
    remove_lost(&mut queue, &mut tables, &mut joints, &mut census);
    // This also recycles ids of entities that were despawned since the last step, so a level that is replaced
    // in one go gets the same ids.
    tables.bodies.table.ids.recycle();
    tables.colliders.table.recycle_ids();
    tables.contacts.table.recycle_ids();

    let mut bodies = core::mem::take(&mut queue.bodies);
    for (entity, ()) in bodies.drain() {
        census.settle_body(entity, &mut tables, &mut joints, &mut queue);
    }
    queue.bodies = bodies;

    let mut colliders = core::mem::take(&mut queue.colliders);
    for (entity, ()) in colliders.drain() {
        census.settle_collider(entity, &mut tables, &mut queue);
    }
    queue.colliders = colliders;
    let LifecycleQueue { colliders, bereft, later, .. } = &mut *queue;
    bereft.clear();
    colliders.extend(later.drain(..));
}

/// Removes entities that were despawned during the step, before the observers and events at its end.
pub(crate) fn remove_lost_late(
    mut queue: ResMut<LifecycleQueue>,
    mut tables: Tables,
    mut joints: JointTables,
    mut census: Census,
) {
    for id in core::mem::take(&mut queue.shapeless) {
        if tables.colliders.table.ids.is_live(id) {
            tables.end_contacts(id, |_, _| true);
            tables.colliders.moved.insert(id);
        }
    }
    remove_lost(&mut queue, &mut tables, &mut joints, &mut census);
    queue.is_within_step = false;
    queue.restart_log();
    // These entities are queued for the next step anyway.
    queue.bereft.clear();
}

fn remove_lost(
    queue: &mut LifecycleQueue,
    tables: &mut Tables,
    joints: &mut JointTables,
    census: &mut Census,
) {
    for id in core::mem::take(&mut queue.lost_colliders) {
        if tables.colliders.table.ids.is_live(id) {
            remove_collider(id, tables);
        }
    }
    for id in core::mem::take(&mut queue.lost_bodies) {
        if tables.bodies.table.ids.is_live(id) {
            census.remove_body(id, tables, joints, queue);
        }
    }
}

/// The pose of a collider on its body.
pub(crate) fn local_pose(transform: &ColliderTransform) -> Pose {
    Pose::new(vector_to_kernel(transform.translation), unit_rotation(&transform.rotation))
}

fn remove_collider(id: u32, tables: &mut Tables) {
    tables.end_contacts(id, |_, _| true);
    let Tables { bodies, colliders, .. } = tables;
    let colliders = &mut **colliders;
    colliders.trees.remove(id);
    colliders.moved.remove(id);
    colliders.stale.remove(id);
    colliders.table.remove(id, &mut bodies.table);
    colliders.forget(id);
}

/// Removes the contacts of a collider whose pairs are no longer allowed.
fn drop_forbidden(id: u32, tables: &mut Tables) {
    tables.end_contacts(id, |manager, contact| {
        !may_collide(manager.bodies, manager.colliders, contact.colliders)
    });
}

pub(super) fn kind_of(body: &RigidBody) -> BodyKind {
    match body {
        RigidBody::Dynamic => BodyKind::Dynamic,
        RigidBody::Static => BodyKind::Static,
        RigidBody::Kinematic => BodyKind::Kinematic,
    }
}

fn layers_of(layers: CollisionLayers) -> Layers {
    Layers { memberships: layers.memberships.0, filters: layers.filters.0 }
}

/// Writes `value` at `index` of a list, which grows if needed.
fn put<T: Clone>(list: &mut Vec<T>, index: u32, value: T, filler: T) {
    let index = index as usize;
    if list.len() <= index {
        list.resize(index + 1, filler);
    }
    list[index] = value;
}

impl Census<'_, '_> {
    fn settle_body(
        &mut self,
        entity: Entity,
        tables: &mut Tables,
        joints: &mut JointTables,
        queue: &mut LifecycleQueue,
    ) {
        let id = self.body_ids.get(entity).map_or(NONE, |id| id.0);
        let wanted = self.bodies.get(entity).ok().filter(|state| {
            let (_, body_disabled, disabled, position, ..) = state;
            !body_disabled && !disabled && **position != Position::PLACEHOLDER
        });
        let wanted = wanted.filter(|(.., position, rotation, _, _)| {
            let finite = id != NONE || is_finite(&world_pose(position, rotation));
            if !finite {
                quarantine(entity, None, &mut self.commands);
            }
            finite
        });
        match (wanted, id) {
            // The colliders of a disabled body become colliders without a body.
            (None, NONE) => self.note_colliders(entity, queue),
            (None, id) => self.remove_body(id, tables, joints, queue),
            (Some((body, _, _, position, rotation, center, dominance)), NONE) => {
                let kind = kind_of(body);
                let center = vector_to_kernel(center.0);
                let id = tables.bodies.table.add(kind, center, world_pose(position, rotation));
                let dominance = dominance.map_or(0, |d| d.0);
                tables.bodies.table[id].dominance = dominance;
                // The flag stays set, because the dominance of static bodies is not read again.
                tables.bodies.table.any_dominance |= dominance != 0;
                put(&mut tables.bodies.entities, id, entity, Entity::PLACEHOLDER);
                if let Some(kept) = tables.bodies.kept.get_mut(id as usize) {
                    *kept = Velocity::default();
                }
                put(&mut tables.bodies.seen, id, said_pose(position, rotation), WorldPose::IDENTITY);
                tables.contact_manager().enter(id);
                if let Ok(mut component) = self.body_ids.get_mut(entity) {
                    component.0 = id;
                }
                self.note_colliders(entity, queue);
                joints.joints.note_of_body(entity);
            }
            (Some((body, ..)), id) => {
                let kind = kind_of(body);
                if tables.bodies.table[id].kind != kind {
                    tables.contact_manager().retype(id, kind);
                    move_to_tree(id, kind, tables);
                    let colliders = tables.colliders.table.of_body(id, &tables.bodies.table);
                    for collider in colliders.collect::<Vec<_>>() {
                        drop_forbidden(collider, tables);
                    }
                }
            }
        }
    }

    /// Queues the colliders of a body that was added. They belong to this body from now on.
    fn note_colliders(&self, body: Entity, queue: &mut LifecycleQueue) {
        queue.colliders.extend(self.colliders_of(body));
    }

    fn is_disabled(&self, body: Entity) -> bool {
        self.bodies.get(body).is_ok_and(|(_, body_disabled, disabled, ..)| body_disabled || disabled)
    }

    fn colliders_of(&self, body: Entity) -> Vec<Entity> {
        self.surfaces.colliders_of(body)
    }

    fn remove_body(
        &mut self,
        id: u32,
        tables: &mut Tables,
        joints: &mut JointTables,
        queue: &mut LifecycleQueue,
    ) {
        joints.release_of_body(tables.bodies.entities[id as usize], tables);
        loop {
            let first = tables.bodies.table[id].first_collider;
            if first == NONE {
                break;
            }
            // The collider may outlive the body, so it is queued again.
            let entity = tables.colliders.entities[first as usize];
            remove_collider(first, tables);
            if let Ok(mut component) = self.collider_ids.get_mut(entity) {
                component.0 = NONE;
                queue.colliders.note(entity);
                queue.bereft.insert(entity);
            }
        }
        tables.contact_manager().leave(id);
        let entity = core::mem::replace(&mut tables.bodies.entities[id as usize], Entity::PLACEHOLDER);
        if let Ok(mut component) = self.body_ids.get_mut(entity) {
            component.0 = NONE;
        }
    }

    fn dismiss_collider(&mut self, entity: Entity, id: u32, tables: &mut Tables) {
        if id != NONE {
            remove_collider(id, tables);
            if let Ok(mut component) = self.collider_ids.get_mut(entity) {
                component.0 = NONE;
            }
        }
    }

    fn settle_collider(&mut self, entity: Entity, tables: &mut Tables, queue: &mut LifecycleQueue) {
        let was_refused = queue.refused.swap_remove(&entity);
        queue.detached.swap_remove(&entity);
        let id = self.collider_ids.get(entity).map_or(NONE, |id| id.0);
        let state = self.colliders.get(entity).ok().filter(|state| !state.6 && !state.7);
        let Some(((collider, custom), of, transform, pose, layers, sensor, ..)) = state else {
            return self.dismiss_collider(entity, id, tables);
        };
        let Some(shape) = collider.map(Collider::native).or(custom.map(|custom| &custom.0)) else {
            return self.dismiss_collider(entity, id, tables);
        };
        let body_entity = of.map(|of| of.body);
        let body = body_entity.and_then(|body| self.body_ids.get(body).ok()).map_or(NONE, |id| id.0);
        let is_detached = body == NONE && body_entity.is_some();
        if is_detached {
            queue.detached.insert(entity);
        }
        let inactive = is_detached && body_entity.is_some_and(|body| self.is_disabled(body));
        // Its collisions as a part of the old body end before it forms contacts on its own.
        if body == NONE && !inactive && queue.bereft.contains(&entity) {
            queue.later.push(entity);
            return;
        }
        let Surfaces { material, margin, speculative } = self.surfaces.of(entity, body_entity);
        let local = transform.filter(|_| body_entity != Some(entity)).map_or(Pose::IDENTITY, local_pose);
        let def = ColliderDef {
            shape: shape.clone(),
            body,
            local,
            material,
            facets: self.surfaces.facets_of(entity),
            layers: layers_of(layers.copied().unwrap_or_default()),
            flags: ColliderFlags { sensor, inactive },
            margin,
            speculative,
        };
        let world = match pose {
            _ if body != NONE => tables.bodies.table.frame(body).then(&local),
            Some((position, rotation)) if *position != Position::PLACEHOLDER => {
                world_pose(position, rotation)
            }
            _ => return self.dismiss_collider(entity, id, tables),
        };
        if !is_finite(&world) {
            queue.refused.insert(entity);
            // If the body is not finite either, the body has been reported.
            if !was_refused && (body != NONE || body_entity.is_none()) {
                warn!("the place of the collider {entity} is not finite; it takes no part until it is");
            }
            return self.dismiss_collider(entity, id, tables);
        }
        // A contact stores its bodies, and a collider that changes its body gets a new id.
        if id != NONE && tables.colliders.table[id].def.body != body {
            remove_collider(id, tables);
        }
        let id = if id != NONE && tables.colliders.table.ids.is_live(id) {
            redefine(id, def, tables);
            id
        } else {
            let Tables { bodies, colliders, .. } = &mut *tables;
            let id = colliders.table.add(def, world, &mut bodies.table);
            colliders.name(id, entity);
            // Contacts of a sleeping body are not computed, so the body wakes.
            tables.contact_manager().wake_body(body);
            id
        };
        let kind = match body {
            NONE => TreeKind::Standalone,
            body => tree_of(tables.bodies.table[body].kind),
        };
        let colliders = &mut *tables.colliders;
        if body == NONE {
            colliders.table.poses[id as usize] = world;
        }
        colliders.trees.place(id, kind);
        colliders.stale.insert(id);
        if let Ok(mut component) = self.collider_ids.get_mut(entity) {
            component.0 = id;
        }
        self.settle_reports(entity, id, tables);
    }

    /// Reads whether a collider reports or tracks collisions, and which hooks it uses.
    fn settle_reports(&self, entity: Entity, id: u32, tables: &mut Tables) {
        let (reports, tracks, hits, hooks) = self.reports.get(entity).unwrap_or_default();
        let has = |flag| hooks.is_some_and(|hooks| hooks.contains(flag));
        let (filters, modifies) =
            (has(ActiveCollisionHooks::FILTER_PAIRS), has(ActiveCollisionHooks::MODIFY_CONTACTS));
        let colliders = &tables.colliders;
        let hooked = [colliders.filtering.contains(id), colliders.modifying.contains(id)];
        // A new collider has no contacts, and a level may be spawned asleep.
        if hooked != [filters, modifies] && colliders.table[id].first_contact != NONE {
            let body = colliders.table.body(id);
            tables.contact_manager().wake_with_touching(body);
        }
        let Colliders { reporting, tracking, hitting, filtering, modifying, .. } = &mut *tables.colliders;
        for (set, is_in) in [
            (reporting, reports),
            (tracking, tracks),
            (hitting, hits),
            (filtering, filters),
            (modifying, modifies),
        ] {
            if is_in {
                set.insert(id);
            } else {
                set.remove(id);
            }
        }
        if tracks {
            tables.contacts.reports.trackers.insert(entity);
        }
    }
}

/// Changes a collider in place if its definition differs. Bodies that touch the collider wake, and pairs that
/// its new layers forbid are removed.
fn redefine(id: u32, def: ColliderDef, tables: &mut Tables) {
    let body = def.body;
    let old = &tables.colliders.table[id].def;
    if old.is_same(&def) {
        return;
    }
    // A collider that becomes a sensor, or is no longer a sensor, needs other pairs.
    let repaired = old.layers != def.layers || old.flags != def.flags;
    let mut manager = tables.contact_manager();
    manager.wake_with_touching(body);
    manager.colliders.redefine(id, def, manager.bodies);
    if repaired {
        drop_forbidden(id, tables);
        // New pairs are found as for a collider that moved.
        tables.colliders.moved.insert(id);
    }
    tables.contact_manager().reflag_of_collider(id);
}

pub(super) fn tree_of(kind: BodyKind) -> TreeKind {
    match kind {
        BodyKind::Static => TreeKind::Static,
        BodyKind::Kinematic => TreeKind::Kinematic,
        BodyKind::Dynamic => TreeKind::Dynamic,
    }
}

fn move_to_tree(body: u32, kind: BodyKind, tables: &mut Tables) {
    let Tables { bodies, colliders, .. } = tables;
    let colliders = &mut **colliders;
    let mut next = bodies.table[body].first_collider;
    while next != NONE {
        colliders.trees.place(next, tree_of(kind));
        colliders.stale.insert(next);
        colliders.moved.insert(next);
        next = colliders.table.next_of_body(next);
    }
}
