//! The threads that share the work of a step.

use bevy_ecs::prelude::*;
use kernel::team::Team;

/// Waking a helper takes as long as some hundred contacts.
const MANY_CONTACTS: usize = 1024;

/// The team of the engine's steps, and the setting it was made for.
#[derive(Resource, Clone, Debug, Default)]
pub(crate) struct Threads {
    pub(crate) team: Team,
    setting: Option<usize>,
}

impl Threads {
    /// Wakes the helpers where there are many contacts. `members` is asked for how many members `setting` stands for only
    /// when that changed: to ask the system takes long.
    pub(crate) fn call(&mut self, contacts: usize, setting: usize, members: impl FnOnce() -> usize) {
        let many = contacts >= MANY_CONTACTS;
        // Until there are many for the first time there is no team.
        if self.setting != Some(setting) && (many || self.setting.is_some()) {
            *self = Self { team: Team::new(members()), setting: Some(setting) };
        }
        if many {
            self.team.wake();
        }
    }
}
