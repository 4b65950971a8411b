//! The broad phase's systems: boxes that outgrew their fat box, and the pairs they came into.

use bevy_ecs::prelude::*;
use bevy_time::Time;
use kernel::{
    bvh::{Movers, find_pairs},
    data::BitSet,
    table::{Fattening, NONE},
};

use crate::{
    collision::collider::{ColliderAabb, EnlargedAabb},
    dynamics::{
        lifecycle::ColliderId,
        solver::PhysicsLengthUnit,
        tables::{Bodies, Colliders, Tables},
    },
    math::vector_from_kernel,
    schedule::Physics,
};

/// What is added to a box on every side when it is made fat, times the length unit. Larger boxes change
/// less often but make more pairs.
const FAT_MARGIN: f32 = 0.05;

fn fattening(unit: &PhysicsLengthUnit, time: &Time<Physics>) -> Fattening {
    Fattening { margin: FAT_MARGIN * unit.metres(), dt: time.delta_secs() }
}

/// Puts what entered or was changed by hand where it is, and in its tree.
pub(crate) fn update_stale_boxes(
    unit: Res<PhysicsLengthUnit>,
    time: Res<Time<Physics>>,
    bodies: Res<Bodies>,
    mut colliders: ResMut<Colliders>,
) {
    if colliders.stale.is_empty() {
        return;
    }
    let fattening = fattening(&unit, &time);
    let Colliders { table, trees, moved, stale, .. } = &mut *colliders;
    let mut changed = BitSet::default();
    for id in stale.iter() {
        let live = table.ids.is_live(id);
        if live && (table.refresh(id, &bodies.table, fattening) || trees.is_new(id)) {
            changed.insert(id);
        }
    }
    stale.clear();
    trees.update(&changed, &table.fat);
    moved.union_with(&changed);
}

/// After the solver: boxes of bodies that moved, in the trees and in the components.
pub(crate) fn refit_awake(
    unit: Res<PhysicsLengthUnit>,
    time: Res<Time<Physics>>,
    bodies: Res<Bodies>,
    mut colliders: ResMut<Colliders>,
    mut boxes: Query<(&ColliderId, &mut ColliderAabb, &mut EnlargedAabb)>,
) {
    let fattening = fattening(&unit, &time);
    let Colliders { table, trees, moved, .. } = &mut *colliders;
    let mut changed = BitSet::default();
    for (id, mut tight, mut enlarged) in &mut boxes {
        let id = id.0;
        if id == NONE {
            continue;
        }
        let body = table[id].def.body;
        if body == NONE || bodies.table.rows[body as usize] == 0 {
            if *tight == ColliderAabb::INVALID {
                *tight = to_public(&table.tight(id));
            }
            continue;
        }
        if table.refresh(id, &bodies.table, fattening) {
            changed.insert(id);
            *enlarged = EnlargedAabb::new(to_public(&table.fat[id as usize]));
        }
        *tight = to_public(&table.tight(id));
    }
    trees.update(&changed, &table.fat);
    moved.union_with(&changed);
}

fn to_public(aabb: &kernel::shape::Aabb) -> ColliderAabb {
    ColliderAabb { min: vector_from_kernel(aabb.min), max: vector_from_kernel(aabb.max) }
}

/// Pairs found in a step, kept for their memory.
#[derive(Resource, Default)]
pub(crate) struct FoundPairs {
    pairs: Vec<(u32, u32)>,
    movers: Movers,
}

/// Finds the pairs that moved boxes came into, and makes contacts of those that may collide, in the order
/// of ids.
pub(crate) fn find_new_pairs(mut found: ResMut<FoundPairs>, mut tables: Tables) {
    let FoundPairs { pairs, movers } = &mut *found;
    {
        let Colliders { table, trees, moved, .. } = &mut *tables.colliders;
        if moved.is_empty() {
            return;
        }
        trees.movers(moved, &table.fat, movers);
        moved.clear();
        let contacts = &tables.contacts.table;
        find_pairs(&trees.trees, movers, |a, b| contacts.find(a, b).is_some(), pairs);
    }
    for &(a, b) in pairs.iter() {
        if may_collide(a, b, &tables) {
            tables.link().create(a, b);
        }
    }
}

/// Whether two colliders may form a contact: of different bodies, with layers that see each other, and one
/// of them can be pushed or detects.
fn may_collide(a: u32, b: u32, tables: &Tables) -> bool {
    use kernel::table::BodyKind;
    let [da, db] = [a, b].map(|c| &tables.colliders.table[c].def);
    if da.body == db.body && da.body != NONE {
        return false;
    }
    let kind = |body: u32| (body != NONE).then(|| tables.bodies.table[body].kind);
    let kinds = [kind(da.body), kind(db.body)];
    let pushed = kinds.contains(&Some(BodyKind::Dynamic));
    let detects = da.flags.sensor || db.flags.sensor;
    (pushed || detects) && da.layers.interacts_with(db.layers)
}
