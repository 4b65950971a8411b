//! The displacements of bodies before constraints of the app move them.

use bevy_derive::{Deref, DerefMut};
use bevy_ecs::{component::Component, reflect::ReflectComponent};
use bevy_reflect::{Reflect, std_traits::ReflectDefault};
use derive_more::From;

use super::Rotation;
use crate::math::Vector;

/// The displacement of a body since the start of the step, stored before constraints move the body, in m; see
/// [`SolverBody::delta_position`](crate::dynamics::solver::solver_body::SolverBody::delta_position).
///
/// Awake bodies have this component while XPBD solves constraints of the app.
#[derive(Reflect, Clone, Copy, Component, Debug, Default, Deref, DerefMut, PartialEq, From)]
#[reflect(type_path = false, Debug, Component, Default, PartialEq)]
pub struct PreSolveDeltaPosition(pub Vector);

crate::type_path::type_path!(PreSolveDeltaPosition, "physics_transform::transform");

/// The rotation of a body since the start of the step, stored before constraints rotate the body; see
/// [`SolverBody::delta_rotation`](crate::dynamics::solver::solver_body::SolverBody::delta_rotation).
///
/// Awake bodies have this component while XPBD solves constraints of the app.
#[derive(Reflect, Clone, Copy, Component, Debug, Default, Deref, DerefMut, PartialEq, From)]
#[reflect(type_path = false, Debug, Component, Default, PartialEq)]
pub struct PreSolveDeltaRotation(pub Rotation);

crate::type_path::type_path!(PreSolveDeltaRotation, "physics_transform::transform");
