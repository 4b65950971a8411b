//! Manifolds and contact updates do not allocate.

use crate::kernel;
use counting::taken;
use kernel::manifold::{FeatureCache, LocalManifold, collide};
use measure::{Contacts, KINDS, MIXED, PREDICTION, pairs};

#[path = "counting.rs"]
mod counting;
#[path = "measure/mod.rs"]
mod measure;

/// On this thread only: the test harness may allocate on its own.
#[test]
fn manifolds_and_contacts_allocate_nothing() {
    for (name, a, b) in KINDS {
        let pairs = pairs(64, &MIXED, &mut |dice| [a(dice), b(dice)]);
        let (manifolds, _) = taken(|| {
            for pair in &pairs {
                for (pose, mut cache) in pair.poses.iter().zip([FeatureCache::NONE, pair.cache]) {
                    let [a, b] = &pair.shapes;
                    collide(a, b, pose, PREDICTION, &mut cache, &mut LocalManifold::default());
                    collide(b, a, &pose.inverse(), PREDICTION, &mut cache, &mut LocalManifold::default());
                }
            }
        });
        assert_eq!(manifolds, 0, "manifolds of {name}");
        // Buffers that persist are created in the first step.
        let mut all = Contacts::of(&pairs);
        all.update(false);
        all.update(true);
        for recycle in [true, false] {
            all.nudge();
            assert_eq!(taken(|| all.update(recycle)).0, 0, "contacts of {name}, recycled: {recycle}");
        }
    }
}
