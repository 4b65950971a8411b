//! The broad phase's systems: updating fat boxes, and finding new pairs.

use bevy_ecs::{prelude::*, system::SystemParam};
use bevy_time::Time;
use kernel::{
    bvh::{FoundPairs, Known, Movers},
    contact::ContactFlags,
    data::{BitSet, PairSet},
    table::{BodyTable, ColliderTable, Fattening, NONE},
};

use crate::{
    collider_tree::{diagnostics::ColliderTreeDiagnostics, optimization::ColliderTreeOptimization},
    collision::{
        collider::{ColliderAabb, EnlargedAabb},
        diagnostics::CollisionDiagnostics,
    },
    columns::{Column, PIECE, Put, is_change_tracked},
    dynamics::{
        ids::ColliderId,
        solver::config::PhysicsLengthUnit,
        tables::{Bodies, Colliders, Contacts, Tables, is_minority},
    },
    math::vector_from_kernel,
    scan::IN_TABLES,
    schedule::Physics,
    threads::Threads,
};

/// Growth of a fat box on every side, times the length unit. Small shapes get less. A larger margin finds
/// more pairs that never touch; a smaller margin updates the trees more often.
const FAT_MARGIN: f32 = 0.05;

/// Settings of fat boxes.
#[derive(SystemParam)]
pub(crate) struct FatBoxes<'w> {
    unit: Res<'w, PhysicsLengthUnit>,
    time: Res<'w, Time<Physics>>,
}

impl FatBoxes<'_> {
    fn fattening(&self) -> Fattening {
        Fattening { margin: FAT_MARGIN * self.unit.metres(), dt: self.time.delta_secs() }
    }
}

/// The components with a collider's boxes.
type Boxes = (&'static ColliderId, &'static mut ColliderAabb, &'static mut EnlargedAabb);

/// Updates the boxes and leaves of colliders that the app added or changed. If the app set the velocity of a
/// body, its boxes are swept along the velocity, because it may hit something in this step.
pub(crate) fn update_stale_boxes(
    (fat_boxes, threads): (FatBoxes, Res<Threads>),
    mut tables: Tables,
    mut boxes: Query<Boxes>,
    optimization: Res<ColliderTreeOptimization>,
    mut diagnostics: ResMut<ColliderTreeDiagnostics>,
) {
    mark_pushed(&mut tables.bodies.table, &mut tables.colliders);
    if tables.colliders.stale.is_empty() {
        return;
    }
    let start = bevy_platform::time::Instant::now();
    let fattening = fat_boxes.fattening();
    let bodies = &tables.bodies.table;
    let Colliders { table, trees, moved, stale, entities, .. } = &mut *tables.colliders;
    let mut changed = BitSet::default();
    let mut resting = Vec::new();
    for id in stale.iter() {
        if !table.ids.is_live(id) {
            continue;
        }
        let outgrown = table.refresh(id, bodies, fattening);
        if outgrown || trees.is_new(id) {
            changed.insert(id);
        }
        let body = table.body(id);
        if body == NONE || !bodies[body].awake {
            resting.push(id);
        }
        if let Ok((_, mut shown, mut enlarged)) = boxes.get_mut(entities[id as usize]) {
            *shown = to_public(&table.tight[id as usize]);
            *enlarged = EnlargedAabb::new(to_public(&table.fat[id as usize]));
        }
    }
    stale.clear();
    let (mode, pool) = (optimization.optimization_mode, &threads.pool);
    diagnostics.optimize += trees.update(&changed, &table.fat, mode, pool);
    moved.union_with(&changed);
    let mut manager = tables.contact_manager();
    resting.into_iter().for_each(|id| manager.visit_of_collider(id));
    diagnostics.update += start.elapsed();
}

/// Marks the colliders of bodies whose velocity was set by hand as stale.
fn mark_pushed(bodies: &mut BodyTable, colliders: &mut Colliders) {
    for body in bodies.pushed.iter() {
        for id in colliders.table.of_body(body, bodies) {
            colliders.stale.insert(id);
        }
    }
    bodies.pushed.clear();
}

/// Runs after the solver: updates the boxes of moved bodies in trees and components.
pub(crate) fn refit_awake(
    (fat_boxes, threads): (FatBoxes, Res<Threads>),
    bodies: Res<Bodies>,
    mut colliders: ResMut<Colliders>,
    mut boxes: Query<Boxes>,
    optimization: Res<ColliderTreeOptimization>,
    mut diagnostics: ResMut<ColliderTreeDiagnostics>,
    mut changed: Local<BitSet>,
) {
    let start = bevy_platform::time::Instant::now();
    let pool = &threads.pool;
    let Colliders { table, trees, moved, entities, .. } = &mut *colliders;
    table.refresh_listed(&bodies.listed, &bodies.table, fat_boxes.fattening(), pool, &mut changed);

    let shown = Shown { bodies: &bodies.table, colliders: table };
    if is_minority(bodies.listed.len(), [boxes.iter().size_hint()]) || is_change_tracked() {
        let of_body = |body: &u32| table.of_body(*body, &bodies.table);
        let mut found =
            boxes.iter_many_mut(bodies.listed.iter().flat_map(of_body).map(|id| entities[id as usize]));
        while let Some((id, tight, fat)) = found.fetch_next() {
            shown.put(*id, tight, fat);
        }
    } else {
        for (mut ids, tight, fat) in boxes.contiguous_iter_mut().expect(IN_TABLES) {
            let mut ticks = (None, None);
            let (mut tight, mut fat) = (Column::new(tight, &mut ticks.0), Column::new(fat, &mut ticks.1));
            let pieces = core::iter::from_fn(|| {
                let ids = ids.split_off(..PIECE.min(ids.len())).filter(|ids| !ids.is_empty())?;
                Some((ids, tight.cut(), fat.cut()))
            });
            pool.each(pieces, |(ids, tight, fat)| {
                for ((id, tight), fat) in ids.iter().zip(tight.slots()).zip(fat.slots()) {
                    shown.put(*id, tight, fat);
                }
            });
        }
    }
    diagnostics.optimize += trees.update(&changed, &table.fat, optimization.optimization_mode, pool);
    moved.union_with(&changed);
    changed.clear();
    diagnostics.update += start.elapsed();
}

/// Access to the boxes that are written to components.
struct Shown<'a> {
    bodies: &'a BodyTable,
    colliders: &'a ColliderTable,
}

impl Shown<'_> {
    /// Writes the boxes of one collider, if its body took part in the step.
    #[inline(always)]
    fn put(&self, id: ColliderId, tight: impl Put<ColliderAabb>, fat: impl Put<EnlargedAabb>) {
        let id = id.0;
        let body = if id == NONE { NONE } else { self.colliders.body(id) };
        if body != NONE && self.bodies.row(body) != 0 {
            tight.put(to_public(&self.colliders.tight[id as usize]));
            fat.put(EnlargedAabb::new(to_public(&self.colliders.fat[id as usize])));
        }
    }
}

fn to_public(aabb: &kernel::shape::Aabb) -> ColliderAabb {
    ColliderAabb { min: vector_from_kernel(aabb.min), max: vector_from_kernel(aabb.max) }
}

/// Pairs found in a step. Kept for its buffers.
#[derive(Resource, Default)]
pub(crate) struct PairSearch {
    found: FoundPairs,
    movers: Movers,
    /// Indices of pairs that hooks rejected.
    rejected: BitSet,
}

impl PairSearch {
    /// Rejects pairs of this step.
    pub(crate) fn reject(&mut self, mut is_rejected: impl FnMut((u32, u32)) -> bool) {
        for (place, pair) in self.found.pairs().iter().enumerate() {
            if is_rejected(*pair) {
                self.rejected.insert(place as u32);
            }
        }
    }
}

/// Pairs that the search skips: colliders of one body, and pairs with a contact.
struct Contacted<'a> {
    colliders: &'a ColliderTable,
    pairs: &'a PairSet,
}

impl Known for Contacted<'_> {
    /// Colliders of one body may overlap in thousands of pairs. The search does not even list these pairs.
    #[inline]
    fn is_plain(&self, a: u32, b: u32) -> bool {
        let body = self.colliders.body(a);
        body == self.colliders.body(b) && body != NONE
    }

    #[inline]
    fn prefetch(&self, a: u32, b: u32) {
        self.pairs.prefetch(a, b);
    }

    #[inline]
    fn contains(&self, a: u32, b: u32) -> bool {
        self.pairs.contains(a, b)
    }
}

/// Finds pairs of moved boxes that have no contact yet.
pub(crate) fn find_new_pairs(
    mut search: ResMut<PairSearch>,
    mut threads: ResMut<Threads>,
    mut colliders: ResMut<Colliders>,
    contacts: Res<Contacts>,
    mut diagnostics: ResMut<CollisionDiagnostics>,
) {
    let start = bevy_platform::time::Instant::now();
    let PairSearch { found, movers, rejected, .. } = &mut *search;
    rejected.clear();
    let Colliders { table, trees, moved, .. } = &mut *colliders;
    if moved.is_empty() {
        found.clear();
        threads.wake_for_pairs(0);
    } else {
        trees.movers(moved, &table.fat, movers);
        moved.clear();
        let known = Contacted { colliders: table, pairs: contacts.table.pairs() };
        threads.wake_for_pairs(movers.list().len());
        found.find(&trees.trees, movers, &known, &threads.pool);
    }
    diagnostics.broad_phase = start.elapsed();
}

/// Adds contacts for the found pairs that may collide, in order of ids. Pairs that were
/// [left out](ContactManager::left_out) are searched again in the next step.
pub(crate) fn add_contacts(
    mut search: ResMut<PairSearch>,
    mut tables: Tables,
    mut diagnostics: ResMut<CollisionDiagnostics>,
) {
    let start = bevy_platform::time::Instant::now();
    let PairSearch { found, rejected, .. } = &mut *search;
    found.retain(|place, (a, b)| {
        tables.bodies.may_pair(&tables.colliders.table, [a, b]) && !rejected.contains(place)
    });
    let left_out = tables.contact_manager().left_out(found.pairs());
    let mut sleepers = Vec::new();
    for (place, &(a, b)) in found.pairs().iter().enumerate() {
        if left_out.contains(place as u32) {
            tables.colliders.moved.insert(a);
        } else {
            sleepers.extend(add_contact(&mut tables, [a, b], ContactFlags::default()));
        }
    }
    wake_beset(&sleepers, &mut tables);
    diagnostics.broad_phase += start.elapsed();
}

/// Adds the contact of a new pair, with `flags` in addition to the flags that follow from the colliders.
/// Returns a sleeping body for [`wake_beset`].
pub(crate) fn add_contact(tables: &mut Tables, [a, b]: [u32; 2], flags: ContactFlags) -> Option<u32> {
    let mut manager = tables.contact_manager();
    let id = manager.create_with(a, b, flags);
    manager.visit(id);
    manager.unseen_sleeper(id)
}

/// The hooks that filter pairs, between the search and [`add_contacts`].
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct FilterPairs;

/// Wakes sleeping bodies if a static collider, or a kinematic one at rest, appeared beside them. Bodies put
/// to sleep in this step stay asleep: a level may be spawned asleep.
pub(crate) fn wake_beset(sleepers: &[u32], tables: &mut Tables) {
    if sleepers.is_empty() {
        return;
    }
    let flipped = tables.bodies.table.flipped_set();
    for &body in sleepers.iter().filter(|body| !flipped.contains(**body)) {
        tables.contact_manager().wake_body(body);
    }
}
