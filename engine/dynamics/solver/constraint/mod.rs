//! Constraints of the app, solved by the kernel with contacts and joints. Beyond Avian.
//!
//! A [`Constraint`] is a component on its own entity. [`ConstraintPlugin`] activates a type of constraints.
//! In each substep a constraint changes the velocities of two bodies, in turn with contacts and joints and on
//! all threads. The bodies are in one island: they sleep and wake together.
//!
//! This example is a spring that pulls its bodies towards each other. It is implicit in each substep, and
//! therefore stable at any stiffness:
//!
//! ```
//! # use avian::{
//! #     dynamics::{joints::EntityConstraint, solver::constraint::*},
//! #     math::{Scalar, Vector},
//! #     prelude::*,
//! # };
//! # use bevy_app::App;
//! # use bevy_ecs::{entity::MapEntities, prelude::*};
//! #[derive(Component, Clone, MapEntities)]
//! struct Spring {
//!     #[entities]
//!     bodies: [Entity; 2],
//!     /// In N/m.
//!     stiffness: Scalar,
//! }
//!
//! impl EntityConstraint<2> for Spring {
//!     fn entities(&self) -> [Entity; 2] {
//!         self.bodies
//!     }
//! }
//!
//! impl Constraint for Spring {
//!     /// The impulse of a substep.
//!     type Rows = Vector;
//!
//!     fn prepare(&self, _: &[ConstraintBody; 2], _: &ConstraintStep, last: Option<&Vector>) -> Vector {
//!         last.copied().unwrap_or_default()
//!     }
//!
//!     fn warm_start(&self, impulse: &mut Vector, [a, b]: &mut [ConstraintBody; 2], step: &ConstraintStep) {
//!         *impulse *= step.warm_start;
//!         a.apply_impulse(-*impulse, Vector::ZERO);
//!         b.apply_impulse(*impulse, Vector::ZERO);
//!     }
//!
//!     fn solve(&self, impulse: &mut Vector, bodies: &mut [ConstraintBody; 2], step: &ConstraintStep, use_bias: bool) {
//!         if !use_bias {
//!             return;
//!         }
//!         let offset = ConstraintBody::offset(bodies, [Vector::ZERO; 2]);
//!         let [a, b] = bodies;
//!         let speed = b.linear_velocity() - a.linear_velocity();
//!         // λ = −h k (x + h v'), with the velocity v' = v + w Δλ after it.
//!         let (h, w) = (step.delta, a.inverse_mass() + b.inverse_mass());
//!         let softness = h * self.stiffness;
//!         let change = -(*impulse + softness * (offset + h * speed)) / (Vector::ONE + softness * h * w);
//!         *impulse += change;
//!         a.apply_impulse(-change, Vector::ZERO);
//!         b.apply_impulse(change, Vector::ZERO);
//!     }
//! }
//!
//! # let mut app = App::new();
//! # app.add_plugins((bevy_transform::TransformPlugin, PhysicsPlugins::default()));
//! app.add_plugins(ConstraintPlugin::<Spring>::default());
//! ```

mod act;
mod body;
mod plugin;
pub(crate) mod ties;

pub use body::ConstraintBody;
pub use plugin::{ConstraintPlugin, ConstraintRows};

use bevy_ecs::component::Component;

use crate::{dynamics::joints::EntityConstraint, math::Scalar};

/// A constraint between two bodies that the kernel solves; see the [module](self).
///
/// The constraint acts while both entities are bodies in the simulation and it has no
/// [`JointDisabled`](crate::dynamics::joints::JointDisabled). The kernel works on a copy: a change of the
/// component takes effect in the next step, and wakes the bodies. Constraints of all types are solved in a
/// fixed order, or by several threads at once if they share no moving body. Therefore an implementation must
/// not depend on any state but its own, and the same input must give the same output. Then results have the
/// same bits for any number of threads.
pub trait Constraint: Component + EntityConstraint<2> + Clone {
    /// The data computed once per step, with the impulses that its substeps accumulate.
    type Rows: Clone + Send + Sync + 'static;

    /// Prepares the constraint for a step. The bodies are at their poses at the start of the step. `last` are
    /// the rows of the last step in which the constraint acted. May be called more than once in a step, with
    /// the same `last`.
    fn prepare(
        &self,
        bodies: &[ConstraintBody; 2],
        step: &ConstraintStep,
        last: Option<&Self::Rows>,
    ) -> Self::Rows;

    /// At the start of a substep, applies the impulses of the last substep. Then only their change is left to
    /// solve.
    fn warm_start(&self, _rows: &mut Self::Rows, _bodies: &mut [ConstraintBody; 2], _step: &ConstraintStep) {}

    /// Changes velocities to satisfy the constraint.
    ///
    /// Called twice in a substep. The first call, before positions are integrated, has `use_bias` and also
    /// reduces position errors. The second call, after the integration, has no bias and removes the velocity
    /// caused by the bias. Springs do nothing in the second call.
    fn solve(
        &self,
        rows: &mut Self::Rows,
        bodies: &mut [ConstraintBody; 2],
        step: &ConstraintStep,
        use_bias: bool,
    );
}

/// The lengths of a step and its substeps, and settings common to all constraints.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct ConstraintStep {
    /// The length of a substep, in s.
    pub delta: Scalar,
    /// The length of the step, in s.
    pub step_delta: Scalar,
    /// The fraction of the last impulses to apply in the warm start, 0 to 1.
    pub warm_start: Scalar,
}
