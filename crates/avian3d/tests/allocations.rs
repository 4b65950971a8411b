//! What a step of avian3d allocates, in a process of its own; the file is shared with avian2d.

#[path = "../../../tests/allocations.rs"]
mod allocations;
