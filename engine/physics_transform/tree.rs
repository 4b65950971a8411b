//! The part of Bevy's hierarchy with physics in it: entities with a [`Position`] and their ancestors, with
//! child links only to these entities.
//!
//! A level may have a hundred thousand images and one body under one root. Traversing `Children` from the
//! root would visit all of them; this copy of the hierarchy visits only the body. Roots without physics below
//! need no node. Observers append to one queue. Only [`TransformTree::follow`] changes links, before a step
//! and again before transforms are written, according to the hierarchy at that time. Therefore the order of
//! changes does not matter.
//!
//! Each node counts the poses below it that are written to transforms: a body with only its colliders below
//! is written like a body without children.

use bevy_ecs::{
    change_detection::Tick, entity::EntityHashMap, entity_disabling::Disabled, prelude::*, query::Allow,
    system::SystemChangeTick,
};
use bevy_transform::components::Transform;

use super::{ApplyPosToTransform, Position, Rotation};
use crate::{dynamics::rigid_body::RigidBody, noted::Noted, schedule::OnThisThread};

/// Marks a collider on another entity than its body. The body determines its pose.
#[derive(Component, Clone, Copy, Debug, Default)]
pub(crate) struct FollowsBody {
    /// The nearest body above in the hierarchy. `None` if the app inserted the link.
    #[entities]
    pub(crate) above: Option<Entity>,
}

/// Entities whose parent, body or collider was added, removed or changed since the last step.
#[derive(Resource, Clone, Debug, Default)]
pub(crate) struct HierarchyQueue {
    /// Entities that may be alive.
    noted: Noted,
    /// Despawned entities that are still in the tree.
    gone: Vec<Entity>,
    /// Entities that lost Bevy's `Disabled`. Scans for changes have not seen them.
    enabled: Noted,
}

impl HierarchyQueue {
    fn note(&mut self, entity: Entity, tree: &TransformTree) {
        self.gone.extend(self.noted.note(entity).filter(|gone| tree.contains(*gone)));
    }

    /// Whether the tree is up to date.
    pub(crate) fn is_empty(&self) -> bool {
        self.noted.is_empty() && self.gone.is_empty() && self.enabled.is_empty()
    }

    /// The queued entities.
    pub(crate) fn entities(&self) -> Vec<Entity> {
        self.gone.iter().copied().chain(self.noted.entities()).collect()
    }

    /// The number of queued entities.
    #[cfg(test)]
    pub(crate) fn len(&self) -> usize {
        self.gone.len() + self.noted.len()
    }
}

/// Changes found by [`update_tree`], for later systems of this step.
#[derive(Resource, Clone, Debug, Default)]
pub(crate) struct TreeChanges {
    /// The queue of this step, with each entity once, in order.
    pub(crate) queued: Vec<Entity>,
    /// Entities whose parent changed, or that were enabled.
    pub(crate) reparented: Vec<Entity>,
    /// Entities that the last step's write-back already processed. They are still in the queue.
    pub(crate) early: Vec<Entity>,
    /// Entities whose `Transform` may differ from the pose, because it changed, or because the entity was
    /// reparented or enabled. Descendants may be missing.
    pub(crate) transforms: Vec<Entity>,
    /// Entities whose `Transform` was written after a step, and whose `GlobalTransform` was not updated
    /// since.
    pub(crate) written: Vec<Entity>,
}

#[derive(Clone, Debug, Default)]
struct Node {
    parent: Option<Entity>,
    /// Index of this node among the parent's children.
    slot: usize,
    children: Vec<Entity>,
    /// Whether the node's pose is written to its transform. Only valid with a parent.
    is_written: bool,
    /// Number of nodes below whose poses are written.
    written_below: usize,
    visit: u64,
}

impl Node {
    /// Number of poses that are written at this node and below.
    fn written(&self) -> usize {
        usize::from(self.is_written) + self.written_below
    }
}

/// The nodes. See the [module](self).
#[derive(Resource, Clone, Debug, Default)]
pub(crate) struct TransformTree {
    nodes: EntityHashMap<Node>,
    walk: u64,
    /// Number of entities that traversals have visited.
    pub(crate) visited: u64,
}

/// The current hierarchy.
pub(crate) type Parents<'w, 's> = Query<'w, 's, &'static ChildOf, Allow<Disabled>>;
pub(crate) type Physical<'w, 's> =
    Query<'w, 's, (Has<RigidBody>, Has<ApplyPosToTransform>), (With<Position>, Allow<Disabled>)>;

/// Whether an entity's pose is written to its transform.
fn is_written(entity: Entity, physical: &Physical) -> bool {
    physical.get(entity).is_ok_and(|(is_body, is_asked)| is_body || is_asked)
}

impl TransformTree {
    /// Whether the entity has tracked relatives.
    pub(crate) fn contains(&self, entity: Entity) -> bool {
        self.nodes.contains_key(&entity)
    }

    /// The tracked parent.
    pub(crate) fn parent(&self, entity: Entity) -> Option<Entity> {
        self.nodes.get(&entity)?.parent
    }

    /// Whether the entity's transform is relative to a parent, or poses written below are relative to it.
    pub(crate) fn is_tied(&self, entity: Entity) -> bool {
        self.nodes.get(&entity).is_some_and(|node| node.parent.is_some() || node.written_below > 0)
    }

    /// The tracked children: entities with physics, or with physics below.
    pub(crate) fn children(&self, entity: Entity) -> &[Entity] {
        self.nodes.get(&entity).map_or(&[], |node| &node.children)
    }

    /// Begins a series of traversals that visit no entity twice.
    pub(crate) fn begin_walk(&mut self) {
        self.walk += 1;
    }

    /// Visits `root` and the tracked entities below it, parents first. `visit` gets its own result for the
    /// parent, and returns `None` to skip descendants. Entities that were visited since
    /// [`begin_walk`](Self::begin_walk) are skipped with all their descendants.
    pub(crate) fn descend<C: Clone>(
        &mut self,
        root: Entity,
        context: C,
        mut visit: impl FnMut(Entity, &C) -> Option<C>,
    ) {
        let mut stack = vec![(root, context)];
        while let Some((entity, context)) = stack.pop() {
            if let Some(node) = self.nodes.get_mut(&entity) {
                if node.visit == self.walk {
                    continue;
                }
                node.visit = self.walk;
            }
            self.visited += 1;
            if let Some(below) = visit(entity, &context) {
                stack.extend(self.children(entity).iter().rev().map(|&child| (child, below.clone())));
            }
        }
    }

    /// Updates the links of entities. `moved` receives the entities whose parent changed.
    ///
    /// Removed links are processed first, because together with new links they could form a cycle.
    pub(crate) fn follow(
        &mut self,
        entities: &[Entity],
        parents: &Parents,
        physical: &Physical,
        moved: &mut Vec<Entity>,
    ) {
        for &entity in entities {
            if self.wanted_parent(entity, parents, physical) != self.parent(entity) {
                self.unlink(entity, physical);
                moved.push(entity);
            }
        }
        for &entity in entities {
            if let Some(parent) = self.wanted_parent(entity, parents, physical)
                && self.parent(entity).is_none()
            {
                self.link(entity, parent, parents, physical);
            }
            self.recount(entity, is_written(entity, physical));
            self.prune(entity, physical);
        }
    }

    /// The parent of an entity that has physics in it or below.
    fn wanted_parent(&self, entity: Entity, parents: &Parents, physical: &Physical) -> Option<Entity> {
        let tracked = physical.contains(entity) || !self.children(entity).is_empty();
        if tracked { parents.get(entity).ok().map(ChildOf::parent) } else { None }
    }

    /// Links `entity` below `parent`, and adds untracked ancestors.
    fn link(&mut self, entity: Entity, parent: Entity, parents: &Parents, physical: &Physical) {
        let (mut entity, mut parent) = (entity, parent);
        loop {
            let above = self.nodes.entry(parent).or_default();
            above.children.push(entity);
            let (slot, linked) = (above.children.len() - 1, above.parent.is_some());
            let node = self.nodes.entry(entity).or_default();
            (node.parent, node.slot) = (Some(parent), slot);
            node.is_written = is_written(entity, physical);
            let written = node.written();
            self.count(parent, |below| below + written);
            match parents.get(parent) {
                Ok(next) if !linked => (entity, parent) = (parent, next.parent()),
                _ => return,
            }
        }
    }

    fn unlink(&mut self, entity: Entity, physical: &Physical) {
        let Some(node) = self.nodes.get_mut(&entity) else { return };
        let (slot, Some(parent)) = (node.slot, node.parent.take()) else { return };
        let written = node.written();
        self.count(parent, |below| below - written);
        if let Some(above) = self.nodes.get_mut(&parent) {
            above.children.swap_remove(slot);
            if let Some(&moved) = above.children.get(slot)
                && let Some(moved) = self.nodes.get_mut(&moved)
            {
                moved.slot = slot;
            }
        }
        self.prune(parent, physical);
    }

    /// Changes the number of poses written below `at` and its ancestors.
    fn count(&mut self, at: Entity, change: impl Fn(usize) -> usize) {
        let mut next = Some(at);
        while let Some(node) = next.and_then(|at| self.nodes.get_mut(&at)) {
            node.written_below = change(node.written_below);
            next = node.parent;
        }
    }

    /// Records whether the pose of an entity with a parent is written.
    fn recount(&mut self, entity: Entity, is_written: bool) {
        let Some(node) = self.nodes.get_mut(&entity) else { return };
        let Some(parent) = node.parent else { return };
        let was = core::mem::replace(&mut node.is_written, is_written);
        if is_written != was {
            self.count(parent, |below| if is_written { below + 1 } else { below - 1 });
        }
    }

    /// Removes a node that has no children, and no parent or no physics.
    fn prune(&mut self, entity: Entity, physical: &Physical) {
        let Some(node) = self.nodes.get(&entity) else { return };
        if !node.children.is_empty() || (node.parent.is_some() && physical.contains(entity)) {
            return;
        }
        self.unlink(entity, physical);
        self.nodes.remove(&entity);
    }

    /// The number of tracked entities.
    #[cfg(test)]
    pub(crate) fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Panics if a link is not mutual, or if the queue is empty and a link differs from the hierarchy.
    #[cfg(test)]
    pub(crate) fn check(&self, world: &World) {
        if !world.resource::<HierarchyQueue>().is_empty() {
            return;
        }
        for (&entity, node) in &self.nodes {
            let actual = world.get::<ChildOf>(entity).map(ChildOf::parent);
            assert_eq!(node.parent, actual, "parent of {entity}");
            assert!(world.get::<Position>(entity).is_some() || !node.children.is_empty());
            assert!(node.parent.is_some() || !node.children.is_empty());
            if let Some(parent) = node.parent {
                assert_eq!(self.nodes[&parent].children[node.slot], entity);
            }
            for child in &node.children {
                assert_eq!(self.nodes[child].parent, Some(entity));
            }
            let is_posed =
                |e| world.get::<RigidBody>(e).is_some() || world.get::<ApplyPosToTransform>(e).is_some();
            if node.parent.is_some() {
                assert_eq!(node.is_written, world.get::<Position>(entity).is_some() && is_posed(entity));
            }
            let below: usize = node.children.iter().map(|child| self.nodes[child].written()).sum();
            assert_eq!(node.written_below, below, "poses written below {entity}");
        }
    }
}

/// Applies the queue to the tree.
pub(crate) fn update_tree(
    mut queue: ResMut<HierarchyQueue>,
    mut tree: ResMut<TransformTree>,
    mut changes: ResMut<TreeChanges>,
    parents: Parents,
    physical: Physical,
    _: OnThisThread,
) {
    let TreeChanges { queued, reparented, early, transforms, written } = &mut *changes;
    queued.clear();
    reparented.clear();
    transforms.clear();
    written.clear();
    if queue.is_empty() {
        return;
    }
    queued.append(&mut queue.gone);
    queued.extend(queue.noted.drain().map(|(entity, ())| entity));
    reparented.append(early);
    reparented.extend(queue.enabled.drain().map(|(entity, ())| entity));
    tree.follow(queued, &parents, &physical, reparented);
}

/// Appends the entity of a life-cycle event to the queue.
pub(crate) fn enqueue<E: EntityEvent, B: Bundle>(
    event: On<E, B>,
    mut queue: ResMut<HierarchyQueue>,
    tree: Res<TransformTree>,
) {
    queue.note(event.event_target(), &tree);
}

/// Appends an entity that loses Bevy's `Disabled`, if there is physics in it or below. If the app set the
/// pose after the transform, the pose is marked as changed instead, and the next write-back finds it.
pub(super) fn enqueue_enabled(
    event: On<Remove, Disabled>,
    mut queue: ResMut<HierarchyQueue>,
    tree: Res<TransformTree>,
    mut poses: Query<(Ref<Transform>, Mut<Position>, Option<Ref<Rotation>>), Allow<Disabled>>,
    system: SystemChangeTick,
) {
    let entity = event.event_target();
    let Ok((transform, mut position, rotation)) = poses.get_mut(entity) else {
        if tree.contains(entity) {
            queue.enabled.note(entity);
        }
        return;
    };
    let is_newer = |tick: Tick| tick.is_newer_than(transform.last_changed(), system.this_run());
    if is_newer(position.last_changed()) || rotation.is_some_and(|rotation| is_newer(rotation.last_changed()))
    {
        position.set_changed();
    } else {
        queue.enabled.note(entity);
    }
}

/// Appends an entity whose parent changed, if there is physics in it or below.
pub(super) fn enqueue_parented<E: EntityEvent>(
    event: On<E, ChildOf>,
    mut queue: ResMut<HierarchyQueue>,
    tree: Res<TransformTree>,
    physical: Physical,
) {
    let entity = event.event_target();
    if tree.contains(entity) || physical.contains(entity) {
        queue.note(entity, &tree);
    }
}
