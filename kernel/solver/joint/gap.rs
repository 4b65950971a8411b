//! Errors of joints.

use super::coupling::{CouplingRecord, EndCoordinate};
use super::def::JointDef;
use super::dim::{ANGLE_AXES, AXES, TURNING, angles, coordinate};
use super::single::turns_near;
use crate::math::{DIM, Vector};
use crate::table::BodyTable;

/// Errors of the locked coordinates and limits of a joint.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JointGap {
    /// Error of shifts and distances, m.
    pub length: f32,
    /// Error of angles, rad.
    pub angle: f32,
}

/// The distance by which a value exceeds limits.
fn past([min, max]: [f32; 2], value: f32) -> f32 {
    (min - value).max(value - max).max(0.0)
}

impl JointGap {
    /// The current error of a coupling.
    pub(super) fn of_coupling(coupling: &CouplingRecord, bodies: &BodyTable) -> Self {
        let def = &coupling.def;
        let [a, b] = coupling.values_now(bodies);
        let zero = coupling.zero();
        let sum = (a + f64::from(def.ratio) * b - zero) as f32;
        let off = past(def.limits.map(|limit| (f64::from(limit) - zero) as f32), sum);
        match def.ends[0].coordinate {
            EndCoordinate::Turn => Self { length: 0.0, angle: off },
            _ => Self { length: off, angle: 0.0 },
        }
    }

    /// The current error of a joint; over several coordinates, the root of the sum of squares. `angle` is
    /// the turning angle at the end of the last step.
    pub(super) fn of_joint(def: &JointDef, angle: f32, bodies: &BodyTable) -> Self {
        let [(a, of_a), (b, of_b)] = [0, 1].map(|side| {
            let (frame, pose) = (&def.frames[side], bodies.frame(def.bodies[side]));
            (pose.transform(frame.anchor), pose.rotation.mul(frame.basis).normalized())
        });
        let (between, turns) = ((b - a).to_local(), angles([of_a, of_b]));
        let mut values = [0.0; AXES];
        for (value, axis) in values[..DIM].iter_mut().zip(Vector::AXES) {
            *value = of_a.rotate(axis).dot(between);
        }
        values[coordinate::DISTANCE] = between.length();
        for (number, (value, _)) in ANGLE_AXES.into_iter().zip(turns) {
            values[number] = value;
        }
        let turning = ANGLE_AXES[TURNING];
        if let Some([min, max]) = def.axes[turning].limits {
            let near = if angle.is_nan() { 0.5 * (min + max) } else { angle };
            values[turning] += turns_near(values[turning], near);
        }
        let mut squares = [0.0f32; 2];
        for (number, value) in values.into_iter().enumerate() {
            let off = def.axes[number].limits.map_or(0.0, |limits| past(limits, value));
            squares[usize::from(ANGLE_AXES.contains(&number))] += off * off;
        }
        let [length, angle] = squares.map(f32::sqrt);
        Self { length, angle }
    }
}
