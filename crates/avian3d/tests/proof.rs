//! Tests of the whole engine in 3D: physics, snippets, changes by the app. The files are shared with avian2d.

#[path = "../../../tests/proof/behaviour.rs"]
mod behaviour;
#[path = "../../../tests/proof/ccd.rs"]
mod ccd;
#[path = "../../../tests/proof/crowds.rs"]
mod crowds;
#[path = "../../../tests/proof/determinism.rs"]
mod determinism;
#[path = "../../../tests/proof/dim3.rs"]
mod dim;
#[path = "../../../tests/proof/ghosts3.rs"]
mod ghosts;
#[path = "../../../tests/proof/golden.rs"]
mod golden;
#[path = "../../../tests/proof/golden3.rs"]
mod golden_dim;
#[path = "../../../tests/proof/impacts.rs"]
mod impacts;
#[path = "../../../tests/proof/invariance.rs"]
mod invariance;
#[path = "../../../tests/proof/mission.rs"]
mod mission;
#[path = "../../../tests/proof/mission_dim3.rs"]
mod mission_dim;
#[path = "../../../tests/proof/motion.rs"]
mod motion;
#[path = "../../../tests/proof/pushed.rs"]
mod pushed;
#[path = "../../../tests/proof/sleep.rs"]
mod sleep;
#[path = "../../../tests/proof/spin3.rs"]
mod spin;
#[path = "../../../tests/proof/stacks.rs"]
mod stacks;
#[path = "../../../tests/proof/world.rs"]
mod world;
