//! Joints connect a frame on each of two bodies. Each coordinate of B's frame in A's is free, locked,
//! limited, driven or sprung. Kinds of joints are settings of these coordinates; no kind has rows of its
//! own.
//!
//! The coordinates locked in A's frame are solved as one block, K = J M⁻¹ Jᵀ + Γ, by LDLᵀ. Limits, motors
//! and distances are one-dimensional rows after it, each in the space that the block leaves free (the Schur
//! complement): hitting a limit does not open a hinge. Every coordinate is an oscillator, integrated
//! implicitly: with stiffness k and damping c it has Γ = 1 / (h (c + h k)) and the bias k x / (c + h k).
//! Rigid coordinates have the highest frequency that the substeps resolve. Directions follow the exact
//! motion of the bodies in every pass, so that long swings keep their length.
//!
//! Couplings limit the weighted sum of two coordinates, one at each of two bodies, in world frames
//! (`coupling.rs`).
//!
//! Trees of joints are solved directly, before all rows (`tree.rs`).
//!
//! After Catto, "Soft Constraints" (GDC 2011), and his Box2D v3.

mod block;
mod class;
mod coupling;
mod coupling_row;
mod def;
#[cfg_attr(feature = "2d", path = "dim2.rs")]
#[cfg_attr(feature = "3d", path = "dim3.rs")]
mod dim;
mod elimination;
mod forest;
mod gap;
mod joint_batch;
mod orientation;
mod place;
mod records;
mod row;
mod single;
mod state;
mod table;
mod tree;
mod tree_blow;
mod tree_group;
mod tree_joint;
mod tree_motor;
mod tree_parts;
mod tree_pass;
mod tree_scratch;
mod tree_single;
mod tree_view;

pub use coupling::{CouplingDef, CouplingEnd, EndCoordinate};
pub use def::{
    Axis, AxisSpring, Drive, Give, JointDef, JointError, JointFrame, JointSolver, Motor, OrientationMotor,
    Spring,
};
pub use dim::{AXES, coordinate};
pub use gap::JointGap;
pub(super) use joint_batch::{JOINT_BATCHES, JointRows, JointViews, joints, sort_joints};
pub(super) use records::Records;
pub use state::JointReaction;
pub(super) use table::InertiaFloors;
pub use table::JointTable;
pub(super) use tree::JointTrees;
pub(super) use tree_blow::TreeBlows;
