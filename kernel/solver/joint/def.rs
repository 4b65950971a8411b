//! Joint definition: two frames, and a setting for each coordinate of B's frame relative to A's.

use super::dim::coordinate::DISTANCE;
use super::dim::{AXES, BLOCK, parts_of};
use crate::math::{Angular, DIM, Rot, Vector};
use core::fmt;

/// Stiffness and damping, given as the frequency and damping ratio of an oscillator with the mass that the
/// coordinate moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spring {
    /// Frequency of the undamped oscillation, in Hz. Positive.
    pub frequency: f32,
    /// Damping ratio: 0 for none, 1 for critical damping.
    pub damping_ratio: f32,
}

/// Softness of a coordinate at a limit, or at the value where it is locked.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Give {
    /// As stiff as the substeps resolve.
    #[default]
    Rigid,
    /// Metres per newton, or radians per newton metre; without damping. Positive.
    Compliance(f32),
    /// A spring.
    Spring(Spring),
}

/// The law of a motor. Force = k (target position − position) + c (target velocity − velocity); torque
/// likewise.
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
    /// Target velocity, m/s or rad/s.
    pub target_velocity: f32,
    /// Target position, m or rad. An angle without limits takes the shorter way round.
    pub target_position: f32,
    /// Maximum force in N, or torque in N·m. May be infinite.
    pub max_force: f32,
    /// The law.
    pub drive: Drive,
}

/// A spring along or about one coordinate, in addition to a motor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisSpring {
    /// Rest value, at which the spring has no force, m or rad. An angle without limits is pulled the
    /// shorter way round.
    pub rest: f32,
    /// The law, with `rest` as target position and target velocity 0.
    pub law: Drive,
}

/// A motor of all angles at once: it rotates B's frame to a rotation in A's frame along the shortest arc.
///
/// The error is the rotation vector from the target to the current rotation. In 2D it is the angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrientationMotor {
    /// Target rotation of B's frame in A's.
    pub target_rotation: Rot,
    /// Target angular velocity of B relative to A, in A's frame, rad/s.
    pub target_velocity: Angular,
    /// Maximum magnitude of the torque, N·m. May be infinite.
    pub max_torque: f32,
    /// The law.
    pub drive: Drive,
}

/// Settings of a joint for one coordinate.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Axis {
    /// Minimum and maximum value, m or rad; equal if the coordinate is locked. `None` if it has no limits.
    pub limits: Option<[f32; 2]>,
    /// Softness of the limits.
    pub give: Give,
    /// The spring. It has no effect on a coordinate that is locked and rigid.
    pub spring: Option<AxisSpring>,
    /// The motor. It has no effect on a coordinate that is locked and rigid.
    pub motor: Option<Motor>,
}

impl Drive {
    pub(super) fn is_valid(&self) -> bool {
        match self {
            Self::Spring(spring) => spring.is_valid(),
            Self::Acceleration { stiffness, damping } | Self::Force { stiffness, damping } => {
                [stiffness, damping].iter().all(|x| x.is_finite() && **x >= 0.0)
            }
        }
    }
}

impl Spring {
    fn is_valid(&self) -> bool {
        let [frequency, damping] = [self.frequency, self.damping_ratio];
        frequency.is_finite() && frequency > 0.0 && damping.is_finite() && damping >= 0.0
    }
}

impl Give {
    pub(super) fn is_valid(&self) -> bool {
        match self {
            Self::Rigid => true,
            Self::Compliance(compliance) => compliance.is_finite() && *compliance > 0.0,
            Self::Spring(spring) => spring.is_valid(),
        }
    }
}

impl OrientationMotor {
    fn is_valid(&self) -> bool {
        self.target_rotation.is_finite()
            && self.target_velocity.is_finite()
            && self.max_torque >= 0.0
            && self.drive.is_valid()
    }
}

/// Whether limits are in order.
pub(super) fn are_in_order([min, max]: [f32; 2]) -> bool {
    min <= max && min < f32::INFINITY && max > f32::NEG_INFINITY
}

impl Axis {
    /// No limits, spring or motor.
    pub const FREE: Self = Self { limits: None, give: Give::Rigid, spring: None, motor: None };
    /// Locked at 0.
    pub const LOCKED: Self = Self::limited(0.0, 0.0);

    /// Whether it has limits, a spring or a motor.
    fn is_set(&self) -> bool {
        self.limits.is_some() || self.spring.is_some() || self.motor.is_some()
    }

    /// Limited to an interval.
    pub const fn limited(min: f32, max: f32) -> Self {
        Self { limits: Some([min, max]), ..Self::FREE }
    }

    /// With another softness.
    pub const fn with_give(self, give: Give) -> Self {
        Self { give, ..self }
    }

    /// The value at which it is locked, if it is.
    pub(super) fn locked_at(&self) -> Option<f32> {
        self.limits.filter(|[min, max]| min == max).map(|[min, _]| min)
    }

    fn is_valid(&self) -> bool {
        let drives = self.motor.as_ref().is_none_or(|motor| {
            motor.drive.is_valid()
                && motor.target_velocity.is_finite()
                && motor.target_position.is_finite()
                && motor.max_force >= 0.0
        });
        let springs =
            self.spring.as_ref().is_none_or(|spring| spring.law.is_valid() && spring.rest.is_finite());
        self.limits.is_none_or(are_in_order) && self.give.is_valid() && springs && drives
    }
}

/// A frame of a joint on a body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JointFrame {
    /// Origin in the body's frame, in metres.
    pub anchor: Vector,
    /// Rotation from the joint's frame to the body's.
    pub basis: Rot,
}

/// Definition of a joint.
///
/// Coordinates describe B's frame in A's: [`X`](super::coordinate) and so on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointDef {
    /// A and B: two different bodies.
    pub bodies: [u32; 2],
    /// The frames on A and on B.
    pub frames: [JointFrame; 2],
    /// The settings of each coordinate, by number.
    pub axes: [Axis; AXES],
    /// A motor of all angles at once, in addition to motors of single angles.
    pub orientation: Option<OrientationMotor>,
    /// Rate at which the bodies lose relative velocity: linear and angular, 1/s. Not negative.
    pub damping: [f32; 2],
}

impl JointDef {
    /// A joint at two points that leaves all coordinates free.
    pub fn free(bodies: [u32; 2], anchors: [Vector; 2]) -> Self {
        let frames = anchors.map(|anchor| JointFrame { anchor, ..JointFrame::default() });
        Self { bodies, frames, axes: [Axis::FREE; AXES], orientation: None, damping: [0.0; 2] }
    }

    /// This joint with a setting for some coordinates.
    pub fn with(mut self, coordinates: impl IntoIterator<Item = usize>, axis: Axis) -> Self {
        coordinates.into_iter().for_each(|i| self.axes[i] = axis);
        self
    }

    /// Whether the definition is valid. It is not checked whether the bodies exist.
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
        // A distance and an angle between axes are never negative.
        let is_below = |number: &usize| self.axes[*number].limits.is_some_and(|[_, max]| max < 0.0);
        if let Some(number) = (BLOCK..AXES).find(is_below) {
            return Err(JointError::Axis(number));
        }
        if self.orientation.as_ref().is_some_and(|motor| !motor.is_valid()) {
            return Err(JointError::Orientation);
        }
        match self.damping.iter().find(|damping| !(damping.is_finite() && **damping >= 0.0)) {
            Some(damping) => Err(JointError::Damping(*damping)),
            None => Ok(()),
        }
    }

    /// Whether a coordinate is solved in the block: a locked coordinate of the frame. A soft lock with a
    /// spring or motor is solved on its own.
    pub(super) fn is_in_block(&self, number: usize) -> bool {
        let axis = &self.axes[number];
        let is_driven = axis.give != Give::Rigid && (axis.motor.is_some() || axis.spring.is_some());
        number < BLOCK && axis.locked_at().is_some() && !is_driven
    }

    /// Whether the joint locks only the distance of its anchors. A tree solves this distance as a
    /// coordinate of the block.
    pub(super) fn is_rod(&self) -> bool {
        let distance = &self.axes[DISTANCE];
        let is_driven = distance.motor.is_some() || distance.spring.is_some();
        let has_block = (0..BLOCK).any(|number| self.is_in_block(number));
        distance.locked_at().is_some_and(|length| length > 0.0) && !is_driven && !has_block
    }

    /// Whether all shifts are locked at 0 with the same softness, so that any axes may be used.
    pub(super) fn is_locked_alike(&self) -> bool {
        (0..DIM).all(|k| self.axes[k].locked_at() == Some(0.0) && self.axes[k].give == self.axes[0].give)
    }

    /// Whether the joint may be in a tree: it locks something, and no settings contradict each other.
    pub(super) fn may_branch(&self) -> bool {
        self.holds() && !self.sets_twice()
    }

    /// Whether the joint locks something.
    pub(super) fn holds(&self) -> bool {
        self.is_rod() || (0..BLOCK).any(|number| self.is_in_block(number))
    }

    /// Whether a distance or an angle between axes is limited or driven, and one of its component
    /// coordinates has limits: such settings may contradict each other.
    pub(super) fn sets_twice(&self) -> bool {
        (BLOCK..AXES).any(|number| self.axes[number].is_set() && self.has_set_parts(number))
    }

    /// Whether a coordinate is a distance or an angle between axes, and one of its component coordinates
    /// has limits.
    pub(super) fn has_set_parts(&self, number: usize) -> bool {
        number >= BLOCK && parts_of(number).any(|part| self.axes[part].limits.is_some())
    }

    /// Whether a coordinate is solved on its own: outside the block, with limits, a spring or a motor.
    pub(super) fn is_single(&self, number: usize) -> bool {
        !self.is_in_block(number) && self.axes[number].is_set()
    }
}

/// How joints are solved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum JointSolver {
    /// Trees of three or more joints directly, all others one by one.
    #[default]
    Auto,
    /// One by one.
    Rows,
    /// Directly and without softness, for cranes and machines. Fast swings of light bodies that carry heavy
    /// ones may gain energy.
    Rigid,
}

/// Reason why a joint cannot be added, changed or removed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum JointError {
    /// Both ends are on the same body.
    SameBody(u32),
    /// There is no body with this id.
    NoBody(u32),
    /// There is no joint with this id.
    NoJoint(u32),
    /// An anchor or a basis is not finite.
    Frame(JointFrame),
    /// The setting of this coordinate has limits in the wrong order, or a number that is negative or not
    /// finite.
    Axis(usize),
    /// The orientation motor has a number that is negative or not finite.
    Orientation,
    /// A frame of this end of a coupling is not finite.
    End(usize),
    /// The ratio, limits or softness of a coupling are not finite, out of order, or the ratio is 0.
    Coupling,
    /// A damping is negative or not finite.
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
                write!(
                    f,
                    "limits, give, spring or motor of coordinate {number} are not in order or not finite"
                )
            }
            Self::Orientation => write!(f, "a number of the orientation motor is not finite, or negative"),
            Self::End(number) => write!(f, "a frame of end {number} is not finite"),
            Self::Coupling => {
                write!(f, "ratio, limits or give are not in order or not finite, or the ratio is 0")
            }
            Self::Damping(damping) => write!(f, "a damping of {damping} is not finite, or negative"),
        }
    }
}

impl core::error::Error for JointError {}
