//! Clocks of a step: [`Time<Physics>`](Physics), advanced once per step, and [`Time<Substeps>`](Substeps),
//! advanced once per substep. The generic [`Time`] is set to one of the clocks while a schedule runs.

use bevy_ecs::world::World;
use bevy_log::warn_once;
use bevy_reflect::{Reflect, std_traits::ReflectDefault};
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};
use bevy_time::Time;
use core::time::Duration;

use crate::math::Scalar;

/// The clock of the simulation, a context of [`Time`].
///
/// `Time<Physics>` advances once per step by the delta of the hosting schedule, times the [relative
/// speed](PhysicsTime::relative_speed), or not at all while [paused](PhysicsTime::pause). Within
/// [`PhysicsSchedule`](super::PhysicsSchedule) the generic `Time` has the same values.
///
/// ```
/// # use avian::prelude::*;
/// # use bevy_ecs::prelude::*;
/// # use bevy_time::prelude::*;
/// fn bullet_time(mut time: ResMut<Time<Physics>>) {
///     time.set_relative_speed(0.25);
/// }
///
/// fn pause_menu(mut time: ResMut<Time<Physics>>) {
///     time.pause();
/// }
/// ```
///
/// # Stepping by hand
///
/// While the clock is paused, every `advance_by` counts as a request for one step. Either run the step
/// immediately,
///
/// ```
/// # use avian::prelude::*;
/// # use bevy_ecs::prelude::*;
/// # use bevy_time::prelude::*;
/// # use core::time::Duration;
/// fn ten_steps(world: &mut World) {
///     world.resource_mut::<Time<Physics>>().pause();
///     for _ in 0..10 {
///         world.resource_mut::<Time<Physics>>().advance_by(Duration::from_secs_f64(1.0 / 120.0));
///         world.run_schedule(PhysicsSchedule);
///     }
/// }
/// ```
///
/// or only advance the clock: the next run of the hosting schedule then takes that step, including reading
/// and writing transforms.
#[derive(Reflect, Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Default, Clone, PartialEq)]
pub struct Physics {
    paused: bool,
    #[cfg_attr(feature = "serialize", serde(deserialize_with = "deserialize_speed"))]
    relative_speed: f64,
}

/// A stored speed, if it is a valid [relative speed](PhysicsTime::set_relative_speed).
#[cfg(feature = "serialize")]
fn deserialize_speed<'de, D: serde::Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    let speed: f64 = serde::Deserialize::deserialize(deserializer)?;
    if speed.is_finite() && speed >= 0.0 {
        Ok(speed)
    } else {
        Err(serde::de::Error::custom("a relative speed is a finite ratio of 0 or more"))
    }
}

impl Default for Physics {
    fn default() -> Self {
        Self { paused: false, relative_speed: 1.0 }
    }
}

/// Pausing and speed of [`Time<Physics>`](Physics).
///
/// A relative speed must be finite and not negative. Other values are ignored, with one warning.
pub trait PhysicsTime {
    /// Simulated seconds per second of the hosting schedule; 1 by default.
    fn relative_speed(&self) -> f32;

    /// [`relative_speed`](Self::relative_speed) in double precision.
    fn relative_speed_f64(&self) -> f64;

    /// The clock with this [relative speed](Self::set_relative_speed).
    fn with_relative_speed(self, ratio: f32) -> Self;

    /// The clock with this [relative speed](Self::set_relative_speed), in double precision.
    fn with_relative_speed_f64(self, ratio: f64) -> Self;

    /// Sets the number of simulated seconds per second of the hosting schedule: 0.5 is slow motion, 0 stops.
    /// It scales the *length* of each step, not the number of steps, so large values reduce accuracy.
    /// Negative, infinite and NaN ratios are ignored with a warning.
    fn set_relative_speed(&mut self, ratio: f32);

    /// [`set_relative_speed`](Self::set_relative_speed) in double precision.
    fn set_relative_speed_f64(&mut self, ratio: f64);

    /// Whether the clock is paused.
    fn is_paused(&self) -> bool;

    /// Pauses the clock. Only steps [by hand](Physics#stepping-by-hand) are taken.
    fn pause(&mut self);

    /// Resumes the clock at its previous speed.
    fn unpause(&mut self);
}

impl PhysicsTime for Time<Physics> {
    fn relative_speed(&self) -> f32 {
        self.relative_speed_f64() as f32
    }

    fn relative_speed_f64(&self) -> f64 {
        self.context().relative_speed
    }

    fn with_relative_speed(self, ratio: f32) -> Self {
        self.with_relative_speed_f64(f64::from(ratio))
    }

    fn with_relative_speed_f64(mut self, ratio: f64) -> Self {
        self.set_relative_speed_f64(ratio);
        self
    }

    fn set_relative_speed(&mut self, ratio: f32) {
        self.set_relative_speed_f64(f64::from(ratio));
    }

    fn set_relative_speed_f64(&mut self, ratio: f64) {
        if ratio.is_finite() && ratio >= 0.0 {
            self.context_mut().relative_speed = ratio;
        } else {
            warn_once!(
                "`Time<Physics>` keeps its relative speed of {}: {ratio} is not a finite ratio of 0 or more",
                self.context().relative_speed
            );
        }
    }

    fn is_paused(&self) -> bool {
        self.context().paused
    }

    fn pause(&mut self) {
        self.context_mut().paused = true;
    }

    fn unpause(&mut self) {
        self.context_mut().paused = false;
    }
}

/// The clock of the substeps, a context of [`Time`]. Its delta is the delta of [`Time<Physics>`](Physics)
/// divided by the [`SubstepCount`](crate::dynamics::solver::schedule::SubstepCount).
///
/// It advances once per substep. From the start of a step it shows the end of the first substep, and after
/// the step the end of the last substep.
///
/// Within [`SubstepSchedule`](crate::dynamics::solver::schedule::SubstepSchedule) the generic `Time` has
/// the same values.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Default, Clone, PartialEq)]
pub struct Substeps;

/// The delta of a clock in the precision of the simulation.
pub(crate) trait TimePrecisionAdjusted {
    /// The delta in seconds.
    fn delta_seconds_adjusted(&self) -> Scalar;
}

impl<T: Default> TimePrecisionAdjusted for Time<T> {
    fn delta_seconds_adjusted(&self) -> Scalar {
        self.delta_secs_f64() as Scalar
    }
}

/// The advance of a running physics clock when its host advances by `host_delta`.
///
/// A result beyond the range of [`Duration`] saturates instead of panicking.
pub(super) fn scaled_delta(clock: &Time<Physics>, host_delta: Duration) -> Duration {
    let speed = clock.relative_speed_f64();
    // At normal speed it is exactly the host's delta, without rounding.
    let delta = if speed == 1.0 {
        host_delta
    } else {
        Duration::try_from_secs_f64(host_delta.as_secs_f64() * speed).unwrap_or(Duration::MAX)
    };
    delta.min(Duration::MAX - clock.elapsed())
}

/// Runs `body` with the generic [`Time`] set to `clock`, and restores it afterwards.
pub(crate) fn with_generic_time<R>(world: &mut World, clock: Time, body: impl FnOnce(&mut World) -> R) -> R {
    let host = core::mem::replace(&mut *world.resource_mut::<Time>(), clock);
    let result = body(world);
    *world.resource_mut::<Time>() = host;
    result
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn speeds_that_are_no_ratio_are_ignored() {
        let mut time = Time::<Physics>::default().with_relative_speed(0.5);
        for wrong in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -1.0, -f32::MIN_POSITIVE] {
            time.set_relative_speed(wrong);
            assert_eq!(time.relative_speed(), 0.5);
            assert_eq!(time.with_relative_speed(wrong).relative_speed(), 0.5);
        }
        time.set_relative_speed(0.0);
        assert_eq!(time.relative_speed_f64(), 0.0);
    }

    #[test]
    fn normal_speed_passes_every_delta_on_unrounded() {
        let clock = Time::<Physics>::default();
        for delta in
            [Duration::from_nanos(1), Duration::from_secs(10), Duration::from_nanos(u64::MAX), Duration::MAX]
        {
            assert_eq!(scaled_delta(&clock, delta), delta);
        }
    }

    proptest! {
        #[test]
        fn no_speed_and_no_delta_breaks_the_clock(speed: f64, secs: u64, nanos in 0u32..1_000_000_000, start: u64) {
            let mut clock = Time::<Physics>::default().with_relative_speed_f64(speed);
            clock.advance_by(Duration::from_secs(start));
            for _ in 0..3 {
                let before = clock.elapsed();
                let delta = scaled_delta(&clock, Duration::new(secs, nanos));
                clock.advance_by(delta);
                prop_assert_eq!(clock.elapsed(), before + delta);
            }
        }

        #[test]
        fn deltas_scale_with_the_speed(speed in 0.0f64..100.0, millis in 0u64..10_000) {
            let clock = Time::<Physics>::default().with_relative_speed_f64(speed);
            let scaled = scaled_delta(&clock, Duration::from_millis(millis));
            // A duration counts whole nanoseconds.
            prop_assert!((scaled.as_secs_f64() - speed * millis as f64 * 1e-3).abs() <= 1e-9);
        }
    }
}
