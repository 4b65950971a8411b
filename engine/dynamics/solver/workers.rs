//! Number of threads of a step, and number of SIMD lanes.

use bevy_ecs::prelude::*;
use bevy_reflect::prelude::*;
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};
use bevy_tasks::ComputeTaskPool;

/// Number of threads of a step, including the thread that runs the schedule. Results have the same bits with
/// any number of threads.
///
/// With 0, the default, it is the number of CPU cores available to this process, but at most the number of
/// threads in Bevy's compute task pool plus one. (On two cores Bevy's pool has one thread, and a step uses
/// both cores.) 1 keeps physics on the calling thread. Values above 256 count as 256.
///
/// The engine owns the threads. They start in the first step with more than a thousand contacts of awake
/// bodies, or with 64 characters or dynamic movers. They work in these steps, and in steps where 256
/// colliders move far, and are parked otherwise. Without the feature `parallel` there are no threads.
#[derive(Resource, Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Resource, Debug, Default, PartialEq)]
pub struct WorkerCount(pub usize);

impl WorkerCount {
    /// The number of threads on this machine.
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

/// Number of contacts per SIMD row. Results have the same bits with any width. For comparisons and
/// measurements.
#[derive(Resource, Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Resource, Debug, Default, PartialEq)]
pub enum RowWidth {
    /// As many as the CPU supports: eight with AVX2, otherwise four.
    #[default]
    Widest,
    /// Four.
    Four,
}

/// Maximum number of threads. A larger setting is a mistake.
const MOST: usize = 256;
