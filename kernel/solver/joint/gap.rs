//! How far joints are off.

use super::coupling::EndCoordinate;
use super::dim::{ANGLE_AXES, AXES, TURNING, angles, coordinate};
use super::single::turns_near;
use super::table::Record;
use crate::math::{DIM, Vector};
use crate::table::BodyTable;

/// How far the locked coordinates and limits of a joint are off.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JointGap {
    /// Of shifts and distances, m.
    pub length: f32,
    /// Of angles, rad.
    pub angle: f32,
}

/// How far a value is beyond limits.
fn past([min, max]: [f32; 2], value: f32) -> f32 {
    (min - value).max(value - max).max(0.0)
}

impl Record {
    /// How far the joint is off now. Of several coordinates the root of the sum of squares.
    pub(super) fn gap(&self, bodies: &BodyTable) -> JointGap {
        if let Some(coupling) = &self.coupling {
            let def = &coupling.def;
            let [a, b] = coupling.values_now(bodies);
            let zero = coupling.zero();
            let sum = (a + f64::from(def.ratio) * b - zero) as f32;
            let off = past(def.limits.map(|limit| (f64::from(limit) - zero) as f32), sum);
            return match def.ends[0].coordinate {
                EndCoordinate::Turn => JointGap { length: 0.0, angle: off },
                _ => JointGap { length: off, angle: 0.0 },
            };
        }
        let def = &self.def;
        let [(a, of_a), (b, of_b)] = [0, 1].map(|side| {
            let (frame, pose) = (&def.frames[side], bodies.frame(def.bodies[side]));
            (pose.transform(frame.anchor), pose.rotation.mul(frame.basis).normalized())
        });
        let (between, angles) = ((b - a).to_local(), angles([of_a, of_b]));
        let mut values = [0.0; AXES];
        for (value, axis) in values[..DIM].iter_mut().zip(Vector::AXES) {
            *value = of_a.rotate(axis).dot(between);
        }
        values[coordinate::DISTANCE] = between.length();
        for (number, (angle, _)) in ANGLE_AXES.into_iter().zip(angles) {
            values[number] = angle;
        }
        let turning = ANGLE_AXES[TURNING];
        if let Some([min, max]) = def.axes[turning].limits {
            let near = if self.angle.is_nan() { 0.5 * (min + max) } else { self.angle };
            values[turning] += turns_near(values[turning], near);
        }
        let mut squares = [0.0f32; 2];
        for (number, value) in values.into_iter().enumerate() {
            let off = def.axes[number].limits.map_or(0.0, |limits| past(limits, value));
            squares[usize::from(ANGLE_AXES.contains(&number))] += off * off;
        }
        let [length, angle] = squares.map(f32::sqrt);
        JointGap { length, angle }
    }
}
