//! What a joint does: two frames, and a setting for each coordinate of B's frame relative to A's.

use super::dim::{AXES, BLOCK, parts_of};
use crate::math::{Rot, Vector};
use core::fmt;

/// Stiffness and damping as those of an oscillator with the mass that the coordinate moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spring {
    /// Frequency of the undamped oscillation, in Hz. Positive.
    pub frequency: f32,
    /// Damping ratio: 0 for none, 1 for critical damping.
    pub damping_ratio: f32,
}

/// How far a coordinate gives way at a limit, or where it is locked.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Give {
    /// As little as the substeps resolve.
    #[default]
    Rigid,
    /// Metres per newton, or radians per newton metre; without damping. Positive.
    Compliance(f32),
    /// A spring.
    Spring(Spring),
}

/// The law of a motor. Force is k (target position − position) + c (target velocity − velocity), and torque alike.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Drive {
    /// k and c of an oscillator with the mass that the coordinate moves.
    Spring(Spring),
    /// k in 1/s² and c in 1/s, times the mass that the coordinate moves.
    Acceleration {
        /// Per mass, 1/s².
        stiffness: f32,
        /// Per mass, 1/s.
        damping: f32,
    },
    /// k in N/m or N·m/rad, c in N·s/m or N·m·s/rad.
    Force {
        /// N/m or N·m/rad.
        stiffness: f32,
        /// N·s/m or N·m·s/rad.
        damping: f32,
    },
}

/// A motor along or about one coordinate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motor {
    /// In m/s or rad/s.
    pub target_velocity: f32,
    /// In m or rad. An angle without limits is reached the shorter way round.
    pub target_position: f32,
    /// Greatest force in N, or torque in N·m. May be infinite.
    pub max_force: f32,
    /// The law.
    pub drive: Drive,
}

/// What a joint does with one coordinate.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Axis {
    /// Least and greatest value, in m or rad; equal where the coordinate is locked. `None` if it is free.
    pub limits: Option<[f32; 2]>,
    /// How far limits give way.
    pub give: Give,
    /// The motor.
    pub motor: Option<Motor>,
}

impl Axis {
    /// Neither limits nor a motor.
    pub const FREE: Self = Self { limits: None, give: Give::Rigid, motor: None };
    /// Held at 0.
    pub const LOCKED: Self = Self::limited(0.0, 0.0);

    /// Kept between two values.
    pub const fn limited(min: f32, max: f32) -> Self {
        Self { limits: Some([min, max]), ..Self::FREE }
    }

    /// With another give.
    pub const fn with_give(self, give: Give) -> Self {
        Self { give, ..self }
    }

    /// The value at which it is locked.
    pub(super) fn locked_at(&self) -> Option<f32> {
        self.limits.filter(|[min, max]| min == max).map(|[min, _]| min)
    }

    fn is_valid(&self) -> bool {
        let is_in_order = |[min, max]: [f32; 2]| min <= max && min < f32::INFINITY && max > f32::NEG_INFINITY;
        let is_spring = |s: &Spring| {
            let [frequency, damping] = [s.frequency, s.damping_ratio];
            frequency.is_finite() && frequency > 0.0 && damping.is_finite() && damping >= 0.0
        };
        let gives = match &self.give {
            Give::Rigid => true,
            Give::Compliance(compliance) => compliance.is_finite() && *compliance > 0.0,
            Give::Spring(spring) => is_spring(spring),
        };
        let drives = self.motor.as_ref().is_none_or(|motor| {
            let law = match &motor.drive {
                Drive::Spring(spring) => is_spring(spring),
                Drive::Acceleration { stiffness, damping } | Drive::Force { stiffness, damping } => {
                    [stiffness, damping].iter().all(|x| x.is_finite() && **x >= 0.0)
                }
            };
            law && motor.target_velocity.is_finite()
                && motor.target_position.is_finite()
                && motor.max_force >= 0.0
        });
        self.limits.is_none_or(is_in_order) && gives && drives
    }
}

/// A frame of a joint on a body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JointFrame {
    /// In the body's frame, in metres.
    pub anchor: Vector,
    /// From the joint's frame to the body's.
    pub basis: Rot,
}

/// Definition of a joint.
///
/// Coordinates are those of B's frame in A's: [`X`](super::coordinate) and so on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointDef {
    /// A and B: two different bodies.
    pub bodies: [u32; 2],
    /// The frames on them.
    pub frames: [JointFrame; 2],
    /// What it does with each coordinate, by number.
    pub axes: [Axis; AXES],
    /// Rate at which the bodies lose relative velocity: linear and angular, 1/s. Not negative.
    pub damping: [f32; 2],
}

impl JointDef {
    /// A joint at two points that leaves all coordinates free.
    pub fn free(bodies: [u32; 2], anchors: [Vector; 2]) -> Self {
        let frames = anchors.map(|anchor| JointFrame { anchor, ..JointFrame::default() });
        Self { bodies, frames, axes: [Axis::FREE; AXES], damping: [0.0; 2] }
    }

    /// This joint with a setting for some coordinates.
    pub fn with(mut self, coordinates: impl IntoIterator<Item = usize>, axis: Axis) -> Self {
        coordinates.into_iter().for_each(|i| self.axes[i] = axis);
        self
    }

    /// Whether it and a pair of bodies can be used. Bodies are not looked at.
    pub(super) fn check(&self) -> Result<(), JointError> {
        let [a, b] = self.bodies;
        if a == b {
            return Err(JointError::SameBody(a));
        }
        if let Some(frame) = self.frames.iter().find(|f| !(f.anchor.is_finite() && f.basis.is_finite())) {
            return Err(JointError::Frame(*frame));
        }
        if let Some(number) = self.axes.iter().position(|axis| !axis.is_valid()) {
            return Err(JointError::Axis(number));
        }
        // A distance and an angle between axes are not negative.
        let is_below = |number: &usize| self.axes[*number].limits.is_some_and(|[_, max]| max < 0.0);
        if let Some(number) = (BLOCK..AXES).find(is_below) {
            return Err(JointError::Axis(number));
        }
        match self.damping.iter().find(|damping| !(damping.is_finite() && **damping >= 0.0)) {
            Some(damping) => Err(JointError::Damping(*damping)),
            None => Ok(()),
        }
    }

    /// The coordinates that are solved as one block: those of the frame that are locked.
    pub(super) fn is_in_block(&self, number: usize) -> bool {
        number < BLOCK && self.axes[number].locked_at().is_some()
    }

    /// Whether a distance or an angle between axes is set, and one of the coordinates of which it is made: such settings may
    /// contradict each other.
    pub(super) fn sets_twice(&self) -> bool {
        let is_set = |number: usize| self.axes[number] != Axis::FREE;
        (BLOCK..AXES).any(|number| is_set(number) && parts_of(number).any(is_set))
    }

    /// The coordinates that are solved one by one: those with a limit outside the block, or with a motor.
    pub(super) fn is_single(&self, number: usize) -> bool {
        let axis = &self.axes[number];
        !self.is_in_block(number) && (axis.limits.is_some() || axis.motor.is_some())
    }
}

/// How joints are solved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum JointSolver {
    /// Trees of three joints and more directly, all others one by one.
    #[default]
    Auto,
    /// One by one.
    Rows,
    /// Directly and without softness, for cranes and machines. Fast swings of light bodies that hold heavy ones may gain energy.
    Rigid,
}

/// Why a joint cannot be added, changed or removed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum JointError {
    /// Both ends are on one body.
    SameBody(u32),
    /// There is no body with this id.
    NoBody(u32),
    /// There is no joint with this id.
    NoJoint(u32),
    /// An anchor or a basis is not finite.
    Frame(JointFrame),
    /// The setting of the coordinate with this number has limits in the wrong order, or a number that is not finite, or negative.
    Axis(usize),
    /// A damping is not finite, or negative.
    Damping(f32),
}

impl fmt::Display for JointError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::SameBody(body) => write!(f, "both ends are on body {body}"),
            Self::NoBody(body) => write!(f, "there is no body {body}"),
            Self::NoJoint(id) => write!(f, "there is no joint {id}"),
            Self::Frame(frame) => write!(f, "{frame:?} is not finite"),
            Self::Axis(number) => {
                write!(f, "limits, give or motor of coordinate {number} are not in order or not finite")
            }
            Self::Damping(damping) => write!(f, "a damping of {damping} is not finite and positive"),
        }
    }
}

impl core::error::Error for JointError {}
