//! Continuous collision: how far into the step a body may move before it is where it must not be.
//!
//! The solver keeps bodies apart whose contacts are known when the step begins. What a blow within the step sends through a
//! thin wall, or a corner that turns into one, it does not see. So after the substeps each body that moved far for its size,
//! or turned a corner far, is swept from where it was to where it is, and stops where it meets something. Its velocity stays,
//! but for the height that it is put back to: the next step begins with the contact. (Sweeps after the solver, by
//! conservative advancement, and the smaller ball for what touches already, are E. Catto's, as in Box2D.)
//!
//! A sweep asks a pair only for its manifolds at a relative pose (`cast.rs`). Each body stops at the first of its own times of
//! impact. So results do not depend on the order of bodies or on threads.

mod cast;
mod path;
mod stop;

pub use path::Path;
pub use stop::{SweepBuffers, SweepInput, Swept};
