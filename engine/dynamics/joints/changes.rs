//! Finds mutated joints by change ticks.

use bevy_ecs::prelude::*;

use crate::scan::{IN_TABLES, Since};

/// Calls `found` with each entity whose component changed.
pub(super) fn each_changed<C: Component>(
    components: &Query<(Entity, Ref<C>)>,
    since: Since,
    mut found: impl FnMut(Entity),
) {
    for (entities, component) in components.contiguous_iter().expect(IN_TABLES) {
        since.rows([component.changed_ticks_slice()], |row| found(entities[row]));
    }
}
