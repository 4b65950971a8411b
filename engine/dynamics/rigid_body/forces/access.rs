//! Write access to a component in queries that may also read the same component.
#![expect(unsafe_code, reason = "`WorldQuery` is an unsafe trait; each method is that of `&T` or `&mut T`")]

use bevy_ecs::{
    archetype::Archetype,
    change_detection::Tick,
    component::{ComponentId, Components, Mutable},
    prelude::*,
    query::{
        ArchetypeQueryData, EcsAccessLevel, EcsAccessType, FilteredAccess, IterQueryData, QueryData,
        ReadOnlyQueryData, ReleaseStateQueryData, SingleEntityQueryData, WorldQuery,
    },
    storage::{Table, TableRow},
    world::unsafe_world_cell::UnsafeWorldCell,
};
use core::{
    marker::PhantomData,
    sync::atomic::{AtomicBool, Ordering::Relaxed},
};

/// Write access to a component, or read access if an earlier part of the same query reads the component.
///
/// `&mut T` would make `Query<(&T, Forces)>` panic, and writing while the query hands out `&T` would be
/// undefined behaviour. With `WRITES` false the access is read-only.
pub struct Access<T, const WRITES: bool>(PhantomData<T>);

/// The state of an [`Access`] in a query.
pub struct AccessState {
    id: ComponentId,
    /// Whether write access was declared.
    declared_write: AtomicBool,
    /// Whether only read access was declared. Once set, nothing is written.
    declared_read: AtomicBool,
}

impl AccessState {
    fn new(id: ComponentId) -> Self {
        Self { id, declared_write: AtomicBool::new(false), declared_read: AtomicBool::new(false) }
    }

    /// Whether all declarations of access for this state were for writing. False before the first
    /// declaration.
    fn may_write(&self) -> bool {
        self.declared_write.load(Relaxed) && !self.declared_read.load(Relaxed)
    }
}

/// A component, writable if possible.
pub enum Accessed<'w, T: Component<Mutability = Mutable>> {
    /// The component is writable.
    Mut(Mut<'w, T>),
    /// The same query reads the component.
    Ref(&'w T),
}

impl<T: Component<Mutability = Mutable>> Accessed<'_, T> {
    /// The component.
    pub(super) fn get(&self) -> &T {
        match self {
            Self::Mut(component) => component,
            Self::Ref(component) => component,
        }
    }

    /// Reborrows the component for a shorter lifetime.
    pub(super) fn reborrow(&mut self) -> Accessed<'_, T> {
        match self {
            Self::Mut(component) => Accessed::Mut(component.reborrow()),
            Self::Ref(component) => Accessed::Ref(component),
        }
    }
}

type Write<T> = &'static mut T;
type Read<T> = &'static T;

// SAFETY: `fetch` writes the component only if `may_write`: then each call of `update_component_access` for
// this state added write access, as `&mut T` does. Otherwise it reads the component, and read access, or
// write access, which includes it, was added. Filters and matching are the same as for `&T` and `&mut T`,
// which agree.
unsafe impl<T: Component<Mutability = Mutable>, const WRITES: bool> WorldQuery for Access<T, WRITES> {
    type Fetch<'w> = (<Write<T> as WorldQuery>::Fetch<'w>, <Read<T> as WorldQuery>::Fetch<'w>);
    type State = AccessState;

    fn shrink_fetch<'wlong: 'wshort, 'wshort>(fetch: Self::Fetch<'wlong>) -> Self::Fetch<'wshort> {
        (<Write<T> as WorldQuery>::shrink_fetch(fetch.0), <Read<T> as WorldQuery>::shrink_fetch(fetch.1))
    }

    unsafe fn init_fetch<'w>(
        world: UnsafeWorldCell<'w>,
        state: &Self::State,
        last_run: Tick,
        this_run: Tick,
    ) -> Self::Fetch<'w> {
        // SAFETY: the caller's contract is passed on. Neither fetch accesses a component before `fetch`.
        unsafe {
            (
                <Write<T> as WorldQuery>::init_fetch(world, &state.id, last_run, this_run),
                <Read<T> as WorldQuery>::init_fetch(world, &state.id, last_run, this_run),
            )
        }
    }

    const IS_DENSE: bool = <Read<T> as WorldQuery>::IS_DENSE;

    unsafe fn set_archetype<'w>(
        fetch: &mut Self::Fetch<'w>,
        state: &Self::State,
        archetype: &'w Archetype,
        table: &'w Table,
    ) {
        // SAFETY: the caller's contract is passed on.
        unsafe {
            <Write<T> as WorldQuery>::set_archetype(&mut fetch.0, &state.id, archetype, table);
            <Read<T> as WorldQuery>::set_archetype(&mut fetch.1, &state.id, archetype, table);
        }
    }

    unsafe fn set_table<'w>(fetch: &mut Self::Fetch<'w>, state: &Self::State, table: &'w Table) {
        // SAFETY: the caller's contract is passed on.
        unsafe {
            <Write<T> as WorldQuery>::set_table(&mut fetch.0, &state.id, table);
            <Read<T> as WorldQuery>::set_table(&mut fetch.1, &state.id, table);
        }
    }

    fn update_component_access(state: &Self::State, access: &mut FilteredAccess) {
        if WRITES && !access.access().has_read(state.id) {
            <Write<T> as WorldQuery>::update_component_access(&state.id, access);
            state.declared_write.store(true, Relaxed);
        } else {
            // Panics if the same query writes the component.
            <Read<T> as WorldQuery>::update_component_access(&state.id, access);
            state.declared_read.store(true, Relaxed);
        }
    }

    fn init_state(world: &mut World) -> Self::State {
        AccessState::new(<Read<T> as WorldQuery>::init_state(world))
    }

    fn get_state(components: &Components) -> Option<Self::State> {
        <Read<T> as WorldQuery>::get_state(components).map(AccessState::new)
    }

    fn matches_component_set(state: &Self::State, set_contains_id: &impl Fn(ComponentId) -> bool) -> bool {
        <Read<T> as WorldQuery>::matches_component_set(&state.id, set_contains_id)
    }
}

// SAFETY: the read-only variant has the same state, matches the same tables, and only reads.
unsafe impl<T: Component<Mutability = Mutable>, const WRITES: bool> QueryData for Access<T, WRITES> {
    const IS_READ_ONLY: bool = !WRITES;
    const IS_ARCHETYPAL: bool = true;
    type ReadOnly = Access<T, false>;
    type Item<'w, 's> = Accessed<'w, T>;

    fn shrink<'wlong: 'wshort, 'wshort, 's>(item: Self::Item<'wlong, 's>) -> Self::Item<'wshort, 's> {
        item
    }

    unsafe fn fetch<'w, 's>(
        state: &'s Self::State,
        fetch: &mut Self::Fetch<'w>,
        entity: Entity,
        table_row: TableRow,
    ) -> Option<Self::Item<'w, 's>> {
        // SAFETY: the caller's contract is passed on. Write access was declared if it is used.
        unsafe {
            if WRITES && state.may_write() {
                <Write<T> as QueryData>::fetch(&state.id, &mut fetch.0, entity, table_row).map(Accessed::Mut)
            } else {
                <Read<T> as QueryData>::fetch(&state.id, &mut fetch.1, entity, table_row).map(Accessed::Ref)
            }
        }
    }

    fn iter_access(state: &Self::State) -> impl Iterator<Item = EcsAccessType<'_>> {
        let level = if WRITES && state.may_write() {
            EcsAccessLevel::Write(state.id)
        } else {
            EcsAccessLevel::Read(state.id)
        };
        core::iter::once(EcsAccessType::Component(level))
    }
}

// SAFETY: only the current entity is accessed.
unsafe impl<T: Component<Mutability = Mutable>, const WRITES: bool> IterQueryData for Access<T, WRITES> {}

// SAFETY: only the current entity is accessed.
unsafe impl<T: Component<Mutability = Mutable>, const WRITES: bool> SingleEntityQueryData
    for Access<T, WRITES>
{
}

// SAFETY: with `WRITES` false components are only read.
unsafe impl<T: Component<Mutability = Mutable>> ReadOnlyQueryData for Access<T, false> {}

impl<T: Component<Mutability = Mutable>, const WRITES: bool> ReleaseStateQueryData for Access<T, WRITES> {
    fn release_state<'w>(item: Self::Item<'w, '_>) -> Self::Item<'w, 'static> {
        item
    }
}

impl<T: Component<Mutability = Mutable>, const WRITES: bool> ArchetypeQueryData for Access<T, WRITES> {}
