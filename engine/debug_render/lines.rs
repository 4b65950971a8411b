//! Strips of points, written to the buffer of gizmos.

use bevy_color::{Color, LinearRgba};
use bevy_gizmos::gizmos::Gizmos;
use bevy_math::{Affine3A, Vec3};

use super::PhysicsGizmos;

/// Lines through points, each line ended by a NaN, as in the buffer of gizmos.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Strips(Vec<Vec3>);

impl Strips {
    /// Adds a line.
    pub(super) fn push(&mut self, points: impl IntoIterator<Item = Vec3>) {
        self.0.extend(points);
        self.0.push(Vec3::NAN);
    }

    /// Adds a closed line.
    pub(super) fn push_closed(&mut self, points: impl IntoIterator<Item = Vec3>) {
        let first = self.0.len();
        self.0.extend(points);
        self.0.extend(self.0.get(first).copied());
        self.0.push(Vec3::NAN);
    }

    /// Adds lines from another frame.
    #[cfg(feature = "default-collider")]
    pub(super) fn push_placed(&mut self, lines: &Self, place: &Affine3A) {
        self.0.extend(lines.0.iter().map(|point| place.transform_point3(*point)));
    }

    /// The points, with a NaN after each line.
    #[cfg(all(test, feature = "default-collider"))]
    pub(super) fn points(&self) -> &[Vec3] {
        &self.0
    }

    /// Draws the lines, given in `frame`. Draws nothing if the frame is not finite.
    pub(super) fn draw(&self, frame: &Affine3A, color: LinearRgba, gizmos: &mut Gizmos<PhysicsGizmos>) {
        if !gizmos.config.enabled || !frame.is_finite() {
            return;
        }
        gizmos.strip_positions.extend(self.0.iter().map(|point| frame.transform_point3(*point)));
        let colors = self.0.iter().map(|point| if point.is_nan() { LinearRgba::NAN } else { color });
        gizmos.strip_colors.extend(colors);
    }
}

/// Draws one line.
pub(super) fn draw_strip(
    points: impl IntoIterator<Item = Vec3>,
    color: Color,
    gizmos: &mut Gizmos<PhysicsGizmos>,
) {
    let mut strips = Strips::default();
    strips.push(points);
    strips.draw(&Affine3A::IDENTITY, color.into(), gizmos);
}
