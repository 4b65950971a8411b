//! Lines of physics for systems of the app.

use bevy_color::Color;
use bevy_gizmos::gizmos::Gizmos;

use super::{
    PhysicsGizmos, dim,
    lines::{Strips, draw_strip},
};
#[cfg(feature = "default-collider")]
use crate::{
    collision::collider::Collider,
    math::{AdjustPrecision, Dir, VectorF32},
    spatial_query::{RayHitData, ShapeHitData},
};
use crate::{
    math::{Scalar, Vector},
    physics_transform::{Position, Rotation},
};

/// Draws points, shapes and casts with `Gizmos<PhysicsGizmos>`.
///
/// Needs only the gizmo group, not [`PhysicsDebugPlugin`](super::PhysicsDebugPlugin):
/// `app.init_gizmo_group::<PhysicsGizmos>()`. A pose that is not finite draws nothing.
///
/// ```
/// # use avian::prelude::*;
/// # use bevy_color::Color;
/// # use bevy_ecs::prelude::*;
/// # use bevy_gizmos::prelude::*;
/// fn preview(mut gizmos: Gizmos<PhysicsGizmos>, ghosts: Query<(&Collider, &Position, &Rotation)>) {
///     for (collider, position, rotation) in &ghosts {
///         gizmos.draw_collider(collider, *position, *rotation, Color::WHITE);
///     }
/// }
/// ```
pub trait PhysicsGizmoExt {
    /// Draws a line.
    fn draw_line(&mut self, a: Vector, b: Vector, color: Color);

    /// Draws a line through points in the frame of a pose, and back to the first point if `closed`.
    fn draw_line_strip(
        &mut self,
        points: Vec<Vector>,
        position: impl Into<Position>,
        rotation: impl Into<Rotation>,
        closed: bool,
        color: Color,
    );

    /// Draws lines between pairs of vertices in the frame of a pose. Indices out of range are left out.
    fn draw_polyline(
        &mut self,
        vertices: &[Vector],
        indices: &[[u32; 2]],
        position: impl Into<Position>,
        rotation: impl Into<Rotation>,
        color: Color,
    );

    /// Draws an arrow from `a` to `b`, with a head of the given length.
    fn draw_arrow(&mut self, a: Vector, b: Vector, head_length: Scalar, color: Color);

    /// Draws the outline of a collider.
    #[cfg(feature = "default-collider")]
    fn draw_collider(
        &mut self,
        collider: &Collider,
        position: impl Into<Position>,
        rotation: impl Into<Rotation>,
        color: Color,
    );

    /// Draws a ray, its hit points and its hit normals. `length_unit` is the size of a metre.
    #[cfg(feature = "default-collider")]
    #[allow(clippy::too_many_arguments, reason = "Avian's signature")]
    fn draw_raycast(
        &mut self,
        origin: Vector,
        direction: Dir,
        max_distance: Scalar,
        hits: &[RayHitData],
        ray_color: Color,
        point_color: Color,
        normal_color: Color,
        length_unit: Scalar,
    );

    /// Draws the path of a shape, the shape at its origin and at hits, the hit points and the hit normals.
    /// `length_unit` is the size of a metre.
    #[cfg(feature = "default-collider")]
    #[allow(clippy::too_many_arguments, reason = "Avian's signature")]
    fn draw_shapecast(
        &mut self,
        shape: &Collider,
        origin: Vector,
        shape_rotation: impl Into<Rotation>,
        direction: Dir,
        max_distance: Scalar,
        hits: &[ShapeHitData],
        ray_color: Color,
        shape_color: Color,
        point_color: Color,
        normal_color: Color,
        length_unit: Scalar,
    );
}

/// The length of an endless ray, in metres.
#[cfg(feature = "default-collider")]
const LONGEST: Scalar = 1.0e4;

impl PhysicsGizmoExt for Gizmos<'_, '_, PhysicsGizmos> {
    fn draw_line(&mut self, a: Vector, b: Vector, color: Color) {
        if a.is_finite() && b.is_finite() {
            draw_strip([a, b].map(dim::point), color, self);
        }
    }

    fn draw_line_strip(
        &mut self,
        points: Vec<Vector>,
        position: impl Into<Position>,
        rotation: impl Into<Rotation>,
        closed: bool,
        color: Color,
    ) {
        let mut strips = Strips::default();
        let points = points.into_iter().map(dim::point);
        if closed {
            strips.push_closed(points);
        } else {
            strips.push(points);
        }
        strips.draw(&dim::frame(position.into().0, rotation.into()), color.into(), self);
    }

    fn draw_polyline(
        &mut self,
        vertices: &[Vector],
        indices: &[[u32; 2]],
        position: impl Into<Position>,
        rotation: impl Into<Rotation>,
        color: Color,
    ) {
        let mut strips = Strips::default();
        for [a, b] in indices {
            if let (Some(a), Some(b)) = (vertices.get(*a as usize), vertices.get(*b as usize)) {
                strips.push([*a, *b].map(dim::point));
            }
        }
        strips.draw(&dim::frame(position.into().0, rotation.into()), color.into(), self);
    }

    fn draw_arrow(&mut self, a: Vector, b: Vector, head_length: Scalar, color: Color) {
        self.draw_line(a, b, color);
        let Some(direction) = dim::point(b - a).try_normalize() else { return };
        let (tip, length) = (dim::point(b), head_length as f32);
        if !tip.is_finite() || !length.is_finite() {
            return;
        }
        for side in dim::spread(direction) {
            draw_strip([tip, tip + (side * 0.5 - direction) * length], color, self);
        }
    }

    #[cfg(feature = "default-collider")]
    fn draw_collider(
        &mut self,
        collider: &Collider,
        position: impl Into<Position>,
        rotation: impl Into<Rotation>,
        color: Color,
    ) {
        let frame = dim::frame(position.into().0, rotation.into());
        super::outline::outline(collider).draw(&frame, color.into(), self);
    }

    #[cfg(feature = "default-collider")]
    fn draw_raycast(
        &mut self,
        origin: Vector,
        direction: Dir,
        max_distance: Scalar,
        hits: &[RayHitData],
        ray_color: Color,
        point_color: Color,
        normal_color: Color,
        length_unit: Scalar,
    ) {
        let way = VectorF32::from(direction).adjust_precision();
        let far = way * max_distance.min(LONGEST * length_unit);
        self.draw_line(origin, origin + far, ray_color);
        for hit in hits {
            let point = origin + way * hit.distance;
            draw_cross(point, 0.1 * length_unit, point_color, self);
            self.draw_arrow(point, point + hit.normal * (0.5 * length_unit), 0.1 * length_unit, normal_color);
        }
    }

    #[cfg(feature = "default-collider")]
    fn draw_shapecast(
        &mut self,
        shape: &Collider,
        origin: Vector,
        shape_rotation: impl Into<Rotation>,
        direction: Dir,
        max_distance: Scalar,
        hits: &[ShapeHitData],
        ray_color: Color,
        shape_color: Color,
        point_color: Color,
        normal_color: Color,
        length_unit: Scalar,
    ) {
        let rotation = shape_rotation.into();
        let way = VectorF32::from(direction).adjust_precision();
        let far = way * max_distance.min(LONGEST * length_unit);
        self.draw_line(origin, origin + far, ray_color);
        let outline = super::outline::outline(shape);
        outline.draw(&dim::frame(origin, rotation), shape_color.into(), self);
        for hit in hits {
            outline.draw(&dim::frame(origin + way * hit.distance, rotation), shape_color.into(), self);
            draw_cross(hit.point1, 0.1 * length_unit, point_color, self);
            let tip = hit.point1 + hit.normal1 * (0.5 * length_unit);
            self.draw_arrow(hit.point1, tip, 0.1 * length_unit, normal_color);
        }
    }
}

/// Draws a line along each axis through a point.
pub(super) fn draw_cross(at: Vector, half: Scalar, color: Color, gizmos: &mut Gizmos<PhysicsGizmos>) {
    for axis in Vector::AXES {
        gizmos.draw_line(at - axis * half, at + axis * half, color);
    }
}
