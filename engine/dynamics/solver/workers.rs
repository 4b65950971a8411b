//! How many threads a step uses, and how many contacts each of them solves side by side.

use bevy_ecs::prelude::*;
use bevy_reflect::prelude::*;
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};
use bevy_tasks::ComputeTaskPool;

/// How many threads a step uses, the one that runs the schedule among them. The result has the same bits with
/// any number.
///
/// With 0, the default, they are as many as the machine has cores for this process, but no more than Bevy's
/// compute task pool has threads, plus one: on two cores Bevy gives that pool one thread, so a step uses both.
/// 1 keeps physics on the calling thread; more than 256 count as 256.
///
/// The threads are the engine's own. They are started by the first step with more than a thousand contacts of
/// awake bodies, work in such steps only, and sleep otherwise. Without the feature `parallel` there are none.
#[derive(Resource, Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Resource, Debug, Default, PartialEq)]
pub struct WorkerCount(pub usize);

impl WorkerCount {
    /// How many threads that is on this machine.
    pub(crate) fn resolve(self) -> usize {
        if !cfg!(feature = "parallel") {
            return 1;
        }
        match self.0 {
            0 => {
                let cores = std::thread::available_parallelism().map_or(1, usize::from);
                let pool = ComputeTaskPool::try_get().map_or(0, |pool| pool.thread_num());
                cores.min(pool + 1)
            }
            count => count.min(MOST),
        }
    }
}

/// How many contacts are computed side by side. The result has the same bits with any; this is for comparing and
/// measuring.
#[derive(Resource, Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Resource, Debug, Default, PartialEq)]
pub enum RowWidth {
    /// As many as the CPU can: eight with AVX2, else four.
    #[default]
    Widest,
    /// Four, as on a CPU without AVX2.
    Four,
}

/// More threads than this are a slip of the keyboard.
const MOST: usize = 256;
