//! The life cycle in avian2d. The files are shared with avian3d.

#[path = "../../../tests/clones.rs"]
mod clones;
#[path = "../../../tests/follow.rs"]
mod follow;
#[path = "../../../tests/lifecycle.rs"]
mod lifecycle;
#[path = "../../../tests/paused.rs"]
mod paused;
#[path = "../../../tests/rates.rs"]
mod rates;
#[path = "../../../tests/reload.rs"]
mod reload;
#[path = "../../../tests/respawn.rs"]
mod respawn;
#[path = "../../../tests/rest.rs"]
mod rest;
#[path = "../../../tests/spawn.rs"]
mod spawn;
#[path = "../../../tests/within.rs"]
mod within;
