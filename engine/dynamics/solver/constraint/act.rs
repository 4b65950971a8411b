//! The kernel's adapter for a constraint of the app.

use core::any::Any;
use kernel::solver::{CustomBody, CustomConstraint, SubstepParams};

use super::{Constraint, ConstraintBody, ConstraintStep};
use crate::math::Scalar;

/// The kernel's copy of a constraint.
pub(super) struct Act<C: Constraint> {
    pub(super) constraint: C,
    /// The rows of this step, and the rows of the last step.
    rows: Option<C::Rows>,
    pub(super) last: Option<C::Rows>,
}

impl<C: Constraint> Act<C> {
    pub(super) fn new(constraint: C) -> Self {
        Self { constraint, rows: None, last: None }
    }
}

fn step_of(params: &SubstepParams) -> ConstraintStep {
    let [delta, step_delta, warm_start] = [params.h, params.dt, params.warm_start].map(Scalar::from);
    ConstraintStep { delta, step_delta, warm_start }
}

impl<C: Constraint> CustomConstraint for Act<C> {
    fn prepare(&mut self, [a, b]: [&CustomBody; 2], params: &SubstepParams) {
        let (mut a, mut b) = (*a, *b);
        let bodies = [ConstraintBody(&mut a), ConstraintBody(&mut b)];
        self.rows = Some(self.constraint.prepare(&bodies, &step_of(params), self.last.as_ref()));
    }

    fn warm_start(&mut self, [a, b]: [&mut CustomBody; 2], params: &SubstepParams) {
        if let Some(rows) = &mut self.rows {
            let mut bodies = [ConstraintBody(a), ConstraintBody(b)];
            self.constraint.warm_start(rows, &mut bodies, &step_of(params));
        }
    }

    fn solve(&mut self, [a, b]: [&mut CustomBody; 2], params: &SubstepParams, use_bias: bool) {
        if let Some(rows) = &mut self.rows {
            let mut bodies = [ConstraintBody(a), ConstraintBody(b)];
            self.constraint.solve(rows, &mut bodies, &step_of(params), use_bias);
        }
    }

    fn store(&mut self) {
        self.last = self.rows.take();
    }

    fn boxed(&self) -> Box<dyn CustomConstraint> {
        let Self { constraint, rows, last } = self;
        Box::new(Self { constraint: constraint.clone(), rows: rows.clone(), last: last.clone() })
    }

    fn as_any_mut(&mut self) -> &mut dyn Any {
        self
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}
