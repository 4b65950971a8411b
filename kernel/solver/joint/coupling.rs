//! Coupling definition, for gears, racks and pulleys: limits of the weighted sum of two coordinates, one of
//! each body's frame in a world frame.

use super::def::{Give, JointDef, JointError, JointFrame, are_in_order};
use super::dim::{TURNING, angles};
use crate::math::{Rot, Vector, WorldPose, WorldVector};
use crate::table::BodyTable;

/// A coordinate of a body's frame in a world frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EndCoordinate {
    /// The angle about the x axes in 3D, the angle in 2D, rad. Whole turns are counted.
    Turn,
    /// The displacement of the anchor along the x axis of the world frame, m.
    Shift,
    /// The distance of the anchor from the origin of the world frame, m.
    Distance,
}

/// One end of a coupling.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CouplingEnd {
    /// The coordinate of the body's frame.
    pub coordinate: EndCoordinate,
    /// The frame on the body.
    pub frame: JointFrame,
    /// The world frame.
    pub ground: WorldPose,
}

/// Definition of a coupling: limits of the sum of a coordinate at A and `ratio` times a coordinate at B.
///
/// - Gears: two turns. With radii r and s of wheels that mesh outside, the ratio is s / r; inside, −s / r.
/// - Rack and pinion: a turn and a shift, ratio ±1 / r.
/// - Pulley: two distances. A rope has no lower limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CouplingDef {
    /// A and B: two different bodies.
    pub bodies: [u32; 2],
    /// The ends at A and at B.
    pub ends: [CouplingEnd; 2],
    /// The weight of the coordinate at B. Not 0.
    pub ratio: f32,
    /// Minimum and maximum of the sum, in units of the coordinate at A; equal to couple the coordinates in
    /// both directions.
    pub limits: [f32; 2],
    /// Softness of the limits.
    pub give: Give,
}

impl CouplingEnd {
    /// The body's frame in world axes: the arm from the centre of mass to the anchor, and the rotation.
    pub(super) fn place(&self, bodies: &BodyTable, body: u32) -> (Vector, Rot) {
        let rotation = bodies.poses[body as usize].rotation;
        let arm = self.frame.anchor - bodies[body].local_center;
        (rotation.rotate(arm), rotation.mul(self.frame.basis).normalized())
    }

    /// Vector from the origin of the world frame to a body's centre of mass.
    pub(super) fn offset(&self, bodies: &BodyTable, body: u32) -> WorldVector {
        bodies.poses[body as usize].center - self.ground.position
    }

    /// The current coordinate. An angle gets the whole turns that bring it closest to `near`.
    pub(super) fn value(&self, bodies: &BodyTable, body: u32, near: f64) -> f64 {
        let (arm, basis) = self.place(bodies, body);
        let from = self.offset(bodies, body) + arm.to_world();
        match self.coordinate {
            EndCoordinate::Turn => {
                let (angle, full) =
                    (f64::from(angles([self.ground.rotation, basis])[TURNING].0), core::f64::consts::TAU);
                angle + ((near - angle) / full).round() * full
            }
            EndCoordinate::Shift => {
                let axis = self.ground.rotation.rotate(Vector::X);
                f64::from(from.to_local().dot(axis))
            }
            EndCoordinate::Distance => f64::from(from.to_local().length()),
        }
    }

    fn is_valid(&self) -> bool {
        let Self { frame, ground, .. } = self;
        frame.anchor.is_finite()
            && frame.basis.is_finite()
            && ground.position.is_finite_world()
            && ground.rotation.is_finite()
    }
}

impl CouplingDef {
    /// The current sum of the coordinates, with angles from −π to π. Limits equal to this sum hold the
    /// bodies as they are.
    ///
    /// # Panics
    /// If a body is not in the table.
    pub fn sum(&self, bodies: &BodyTable) -> f32 {
        let [a, b] = core::array::from_fn(|side| self.ends[side].value(bodies, self.bodies[side], 0.0));
        (a + f64::from(self.ratio) * b) as f32
    }

    /// A joint without effect, with the bodies and anchors of the coupling.
    pub(super) fn joint(&self) -> JointDef {
        JointDef::free(self.bodies, self.ends.map(|end| end.frame.anchor))
    }

    /// Whether the definition is valid. It is not checked whether the bodies exist.
    pub(super) fn check(&self) -> Result<(), JointError> {
        let [a, b] = self.bodies;
        if a == b {
            return Err(JointError::SameBody(a));
        }
        if let Some(number) = self.ends.iter().position(|end| !end.is_valid()) {
            return Err(JointError::End(number));
        }
        let has_ratio = self.ratio.is_finite() && self.ratio != 0.0;
        if !(has_ratio && are_in_order(self.limits) && self.give.is_valid()) {
            return Err(JointError::Coupling);
        }
        Ok(())
    }
}

/// State of a coupling between steps.
#[derive(Clone, Debug)]
pub(super) struct CouplingRecord {
    pub(super) def: CouplingDef,
    /// Impulses of the lower and the upper limit, N·s or N·m·s.
    pub(super) impulses: [f32; 2],
    /// The coordinates at the end of the last step. Angles include whole turns.
    pub(super) values: [f64; 2],
    /// The force along the coordinate at A in the last substep, N or N·m.
    pub(super) force: f32,
}

impl CouplingRecord {
    pub(super) fn new(def: CouplingDef) -> Self {
        Self { def, impulses: [0.0; 2], values: [0.0; 2], force: 0.0 }
    }

    /// The current coordinates, with the whole turns since the coupling was created.
    pub(super) fn values_now(&self, bodies: &BodyTable) -> [f64; 2] {
        let Self { def, values, .. } = self;
        core::array::from_fn(|side| def.ends[side].value(bodies, def.bodies[side], values[side]))
    }

    /// The limit relative to which the sum is measured.
    pub(super) fn zero(&self) -> f64 {
        let [min, max] = self.def.limits;
        f64::from(if min.is_finite() { min } else { max })
    }
}
