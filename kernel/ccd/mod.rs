//! Continuous collision: the fraction of the step that a body may move before it passes into other geometry.
//!
//! The solver keeps bodies apart whose contacts are known at the start of the step. It does not see a body
//! that a blow within the step sends through a thin wall, or a corner that turns into a wall. So after the
//! substeps each body that moved far for its size, or turned a corner far, is swept from its start pose to
//! its end pose, and stops at the first impact. It keeps its velocity, less the energy of the height that it
//! is put back to: the next step begins with the contact. (Sweeps after the solver, by conservative
//! advancement, and the smaller ball for shapes that touch already, are E. Catto's, as in Box2D.)
//!
//! A sweep asks a pair only for its manifolds at a relative pose (`cast.rs`). Each body stops at the first of
//! its own times of impact. So results do not depend on the order of bodies or on threads.

mod cast;
mod path;
mod stop;

pub use path::Path;
pub use stop::{SweepBuffers, SweepInput, Swept};
