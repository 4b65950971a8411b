//! Hooks of the app in collision detection: [`CollisionHooks`] filter pairs and change contacts.

use bevy_ecs::{
    prelude::*,
    system::{ReadOnlySystemParam, StaticSystemParam, SystemParamItem},
};
use bevy_reflect::{Reflect, std_traits::ReflectDefault};
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};
use kernel::contact::ContactFlags;

use super::{
    contact_types::{ContactPair, views::Source},
    pairs::PairSearch,
};
use crate::dynamics::{
    solver::schedule::SubstepCount,
    tables::{Bodies, Colliders, Contacts},
};

/// Filters pairs and changes contacts. The hooks are a read-only system parameter with access to the world.
///
/// The methods run for colliders with [`ActiveCollisionHooks`], one pair at a time, in order of the engine's
/// ids. Calls can affect each other only through `commands`, which are applied within the step.
///
/// Add hooks with [`PhysicsPlugins::with_collision_hooks`](crate::PhysicsPlugins::with_collision_hooks). An
/// app has one set of hooks. Hooks must not read [`Collisions`](super::contact_types::Collisions), which are
/// changing at that time.
///
/// ```
/// # use avian::prelude::*;
/// # use bevy_app::prelude::*;
/// # use bevy_ecs::{prelude::*, system::SystemParam};
/// #[derive(Component)]
/// struct Ghost;
///
/// #[derive(SystemParam)]
/// struct GhostHooks<'w, 's> {
///     ghosts: Query<'w, 's, (), With<Ghost>>,
/// }
///
/// impl CollisionHooks for GhostHooks<'_, '_> {
///     // Ghosts do not touch each other.
///     fn filter_pairs(&self, collider1: Entity, collider2: Entity, _: &mut Commands) -> bool {
///         !(self.ghosts.contains(collider1) && self.ghosts.contains(collider2))
///     }
/// }
///
/// fn build(app: &mut App) {
///     app.add_plugins(PhysicsPlugins::default().with_collision_hooks::<GhostHooks>());
/// }
///
/// fn spawn(mut commands: Commands) {
///     commands.spawn((Ghost, RigidBody::Dynamic, Collider::default(), ActiveCollisionHooks::FILTER_PAIRS));
/// }
/// ```
pub trait CollisionHooks: ReadOnlySystemParam + Send + Sync {
    /// Whether two colliders may form a pair. Called when their boxes begin to overlap, if one of the
    /// colliders has [`ActiveCollisionHooks::FILTER_PAIRS`]. After `false` it is called again when one of the
    /// boxes has moved. Of bodies placed into each other, some pairs wait for their contact; they are asked
    /// in each step until they get it.
    fn filter_pairs(&self, _collider1: Entity, _collider2: Entity, _commands: &mut Commands) -> bool {
        true
    }

    /// Changes the contact of two touching colliders: its points, normals, friction, restitution and surface
    /// velocity. Called in every step in which one of the bodies is awake, if one of the colliders has
    /// [`ActiveCollisionHooks::MODIFY_CONTACTS`]. `false` drops the contact in this step: the colliders do
    /// not touch.
    ///
    /// Manifolds that are not finite, or whose normal is not of unit length, are dropped. Without
    /// [`GENERATE_CONSTRAINTS`](super::contact_types::ContactPairFlags::GENERATE_CONSTRAINTS) the contact
    /// is not solved.
    fn modify_contacts(&self, _contacts: &mut ContactPair, _commands: &mut Commands) -> bool {
        true
    }
}

/// No hooks.
impl CollisionHooks for () {}

/// The [`CollisionHooks`] methods that run for a collider. None by default.
///
/// Immutable: insert it again to change it.
#[repr(transparent)]
#[derive(Component, Hash, Clone, Copy, Default, PartialEq, Eq, Debug, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Component, Hash, Default, PartialEq, Debug)]
#[component(immutable)]
pub struct ActiveCollisionHooks(u8);

bitflags::bitflags! {
    impl ActiveCollisionHooks: u8 {
        /// Runs [`CollisionHooks::filter_pairs`].
        const FILTER_PAIRS = 0b0000_0001;
        /// Runs [`CollisionHooks::modify_contacts`].
        const MODIFY_CONTACTS = 0b0000_0010;
    }
}

/// Runs the hooks that filter the found pairs.
pub(crate) fn filter_pairs<H: CollisionHooks + 'static>(
    hooks: StaticSystemParam<H>,
    mut search: ResMut<PairSearch>,
    bodies: Res<Bodies>,
    colliders: Res<Colliders>,
    mut commands: Commands,
) where
    for<'w, 's> SystemParamItem<'w, 's, H>: CollisionHooks,
{
    if colliders.filtering.is_empty() {
        return;
    }
    let hooks = hooks.into_inner();
    search.reject(|(a, b)| {
        let is_asked = colliders.filtering.contains(a) || colliders.filtering.contains(b);
        let [entity1, entity2] = [a, b].map(|id| colliders.entities[id as usize]);
        is_asked
            && bodies.may_pair(&colliders.table, [a, b])
            && !hooks.filter_pairs(entity1, entity2, &mut commands)
    });
}

/// Runs the hooks that change contacts, after the narrow phase.
pub(crate) fn modify_contacts<H: CollisionHooks + 'static>(
    hooks: StaticSystemParam<H>,
    bodies: Res<Bodies>,
    colliders: Res<Colliders>,
    mut contacts: ResMut<Contacts>,
    substeps: Option<Res<SubstepCount>>,
    mut commands: Commands,
) where
    for<'w, 's> SystemParamItem<'w, 's, H>: CollisionHooks,
{
    if colliders.modifying.is_empty() {
        return;
    }
    let hooks = hooks.into_inner();
    let table = &contacts.table;
    let of_hooked = colliders.modifying.iter().flat_map(|id| table.of_collider(id, &colliders.table));
    let is_new = |id: &u32| {
        let flags = table.get(*id).flags;
        table.is_active(*id) && flags.has(ContactFlags::TOUCHING) && !flags.has(ContactFlags::SEPARATED)
    };
    let mut ids: Vec<u32> = of_hooked.filter(is_new).collect();
    ids.sort_unstable();
    ids.dedup();
    let substeps = substeps.map_or(1, |count| count.0.max(1));
    for id in ids {
        let source = Source { bodies: &bodies, colliders: &colliders, contacts: &contacts, substeps };
        let mut pair = source.pair(id);
        let is_kept = hooks.modify_contacts(&mut pair, &mut commands);
        if !is_kept {
            pair.manifolds.clear();
        }
        let manifolds = source.manifolds_to_kernel(id, &pair);
        let Contacts { table, changed, .. } = &mut *contacts;
        table.change(id, manifolds.into_iter(), changed);
    }
}
