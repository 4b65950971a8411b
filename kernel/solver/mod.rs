//! The TGS-Soft contact solver: dense body rows, wide contact rows, and the stages of a substep.
//!
//! A step fills [`Solver::bodies`] and builds the constraint rows. Each substep integrates velocities,
//! solves blows, warm-starts, solves with soft bias, integrates positions and relaxes. After the last
//! substep, blows are solved once more and impulses are stored.
//!
//! The method is Erin Catto's (Solver2D, Box2D v3, Box3D): soft constraints, relaxation, positions as
//! displacements over the step. Rows differ in three ways. Both dimensions have one central friction row
//! per manifold (in 2D the two points of an edge have the same tangent Jacobian up to the edge's slope).
//! Anchors are stored relative to body A; the anchor relative to body B is the first minus one offset per
//! manifold. Deep overlap is pushed out by split impulses, which do not change velocities
//! ([`SplitImpulseRow`]).
//!
//! Each kind of constraint is a file that implements `Batch` (`batch.rs`) and is listed in `all_rows.rs`.
//! The plan and its stages know a row only by its batch and number.

mod all_rows;
mod batch;
mod blow;
mod body;
mod color_layer;
mod compression;
mod contact_batch;
mod contact_fill;
mod continuous;
mod custom;
mod deep_overlap;
#[cfg_attr(feature = "2d", path = "dim2.rs")]
#[cfg_attr(feature = "3d", path = "dim3.rs")]
mod dim;
mod exclusive;
mod fast_turn;
mod fill;
mod finish;
mod friction;
#[cfg_attr(feature = "2d", path = "gyro2.rs")]
#[cfg_attr(feature = "3d", path = "gyro3.rs")]
mod gyro;
mod impact;
mod impact_group;
mod input;
mod integrate;
mod inv_mass;
mod joint;
mod mass_scaling;
mod pair;
mod partition;
mod plan;
mod release;
mod resistance;
mod row;
mod softness;
#[cfg_attr(feature = "2d", path = "spin2.rs")]
#[cfg_attr(feature = "3d", path = "spin3.rs")]
mod spin;
mod stages;
mod struck;
mod view;
mod warm_start;

pub use blow::ManifoldBlow;
pub use body::{BodyRows, Limits, Motion, Thrust};
pub use custom::{CustomBody, CustomConstraint, CustomError, CustomTable};
pub use dim::{BodyRow, MassRow, Twist};
use dim::{GainRow, about, resist_rolling};
pub use fill::{BodyFiller, FilledBody, SpecialBodies};
pub use impact::ImpactRow;
pub use input::RowInput;
pub use inv_mass::InvMass;
pub use joint::{
    AXES, Axis, AxisSpring, CouplingDef, CouplingEnd, Drive, EndCoordinate, Give, JointDef, JointError,
    JointFrame, JointGap, JointReaction, JointSolver, JointTable, Motor, OrientationMotor, Spring,
    coordinate,
};
pub use row::{ContactRow, PointRow, SplitImpulseRow};
pub use softness::{Softness, SubstepParams};
pub use stages::Solver;
use view::RowView;
