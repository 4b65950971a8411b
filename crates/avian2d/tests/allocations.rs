//! What a step of avian2d allocates, in a process of its own; the file is shared with avian3d.

#[path = "../../../tests/allocations.rs"]
mod allocations;
