//! Tests of avian3d in an app. The files are shared with avian2d.

#[path = "../../../../tests/characters/mod.rs"]
mod characters;
#[path = "../../../../tests/characters/dim3.rs"]
mod characters_dim;
#[path = "../../../../tests/collision_hits.rs"]
mod collision_hits;
#[path = "../../../../tests/collisions/mod.rs"]
mod collisions;
#[path = "../../../../tests/constructors.rs"]
mod constructors;
#[path = "../../../../tests/constructors3.rs"]
mod constructors_dim;
#[path = "../../../../tests/contact_query.rs"]
mod contact_query;
#[path = "../../../../tests/contact_query3.rs"]
mod contact_query_dim;
#[path = "../../../../tests/contract.rs"]
mod contract;
#[path = "../../../../tests/contract3.rs"]
mod contract_dim;
#[path = "../../../../tests/custom_colliders.rs"]
mod custom_colliders;
#[path = "../../../../tests/custom_colliders3.rs"]
mod custom_colliders_dim;
#[path = "../../../../tests/diagnostics.rs"]
mod diagnostics;
#[path = "../../../../tests/drawing.rs"]
mod drawing;
#[path = "../../../../tests/easing.rs"]
mod easing;
#[path = "../../../../tests/facets.rs"]
mod facets;
#[path = "../../../../tests/facets3.rs"]
mod facets_dim;
#[path = "../../../../tests/forces/mod.rs"]
mod forces;
#[path = "../../../../tests/forces/dim3.rs"]
mod forces_dim;
#[path = "../../../../tests/gltf.rs"]
mod gltf;
#[path = "../../../../tests/hooks.rs"]
mod hooks;
#[path = "../../../../tests/hooks3.rs"]
mod hooks_dim;
#[path = "../../../../tests/joints/mod.rs"]
mod joints;
#[path = "../../../../tests/joints/dim3.rs"]
mod joints_dim;
#[path = "../../../../tests/landings.rs"]
mod landings;
#[path = "../../../../tests/landings3.rs"]
mod landings_dim;
#[path = "../../../../tests/length_unit.rs"]
mod length_unit;
#[path = "../../../../tests/levels.rs"]
mod levels;
#[path = "../../../../tests/marble3.rs"]
mod marble;
#[path = "../../../../tests/picking.rs"]
mod picking;
#[path = "../../../../tests/picking3.rs"]
mod picking_dim;
#[path = "../../../../tests/plugins.rs"]
mod plugins;
#[path = "../../../../tests/queries.rs"]
mod queries;
#[path = "../../../../tests/query_contract.rs"]
mod query_contract;
#[path = "../../../../tests/reflection.rs"]
mod reflection;
#[path = "../../../../tests/saved_worlds.rs"]
mod saved_worlds;
#[path = "../../../../tests/scale/mod.rs"]
mod scale;
#[path = "../../../../tests/scale/dim3.rs"]
mod scale_dim;
#[path = "../../../../tests/schedule.rs"]
mod schedule;
#[path = "../../../../tests/stored.rs"]
mod stored;
#[path = "../../../../tests/switching.rs"]
mod switching;
#[path = "../../../../tests/type_paths.rs"]
mod type_paths;
#[path = "../../../../tests/users/mod.rs"]
mod users;
#[path = "../../../../tests/users/dim3.rs"]
mod users_dim;
#[path = "../../../../tests/walls.rs"]
mod walls;
