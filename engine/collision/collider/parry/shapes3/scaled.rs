//! Scales of shapes that only 3D has, or that differ from 2D. `shapes2` exports the same names.

use super::super::handedness::{stretched_border, turns_winding};
use crate::math::{Scalar, Vector};
use crate::parry::math::{Pose, Rotation};
use crate::parry::shape::{
    Cone, ConvexPolyhedron, Cylinder, HeightField, HeightFieldCellStatus, Polyline, RoundShape, SharedShape,
    TypedShape,
};
use crate::parry::utils::Array2;

/// The rotation M R M of a part, with the mirror M: its axis n becomes det(M) M n.
pub(in super::super) fn mirrored_rotation(rotation: Rotation, signs: Vector) -> Rotation {
    let hand = if turns_winding(signs) { -1.0 } else { 1.0 };
    let axis = Vector::new(rotation.x, rotation.y, rotation.z) * signs * hand;
    Rotation::from_xyzw(axis.x, axis.y, axis.z, rotation.w)
}

/// A shape with axes mirrored; `None` to leave it to parry.
pub(in super::super) fn mirrored(shape: TypedShape<'_>, signs: Vector) -> Option<SharedShape> {
    match shape {
        TypedShape::Cylinder(cylinder) => Some(SharedShape::new(*cylinder)),
        TypedShape::RoundCylinder(round) => Some(SharedShape::new(*round)),
        TypedShape::Cone(cone) => Some(mirrored_cone(SharedShape::new(*cone), signs)),
        TypedShape::RoundCone(round) => Some(mirrored_cone(SharedShape::new(*round), signs)),
        TypedShape::ConvexPolyhedron(hull) => Some(SharedShape::new(scaled_hull(hull, signs)?)),
        TypedShape::RoundConvexPolyhedron(round) => Some(SharedShape::new(RoundShape {
            inner_shape: scaled_hull(&round.inner_shape, signs)?,
            border_radius: round.border_radius,
        })),
        TypedShape::Polyline(line) => {
            let vertices = line.vertices().iter().map(|v| *v * signs).collect();
            Some(SharedShape::new(Polyline::new(vertices, Some(line.indices().to_vec()))))
        }
        TypedShape::HeightField(field) => Some(mirrored_heights(field, signs)),
        _ => None,
    }
}

/// A shape with positive scales along its axes; `None` to leave it to parry.
pub(in super::super) fn stretched(shape: TypedShape<'_>, size: Vector) -> Option<SharedShape> {
    match shape {
        TypedShape::ConvexPolyhedron(hull) if size != Vector::splat(size.x) => {
            Some(SharedShape::new(scaled_hull(hull, size)?))
        }
        TypedShape::RoundConvexPolyhedron(round) => Some(SharedShape::new(RoundShape {
            inner_shape: scaled_hull(&round.inner_shape, size)?,
            border_radius: stretched_border(round.border_radius, size),
        })),
        TypedShape::RoundCylinder(round) if size.x == size.z => {
            let Cylinder { half_height, radius } = round.inner_shape;
            let border_radius = stretched_border(round.border_radius, size);
            let reach = |length: Scalar, size| (length + round.border_radius) * size - border_radius;
            let inner_shape = Cylinder::new(reach(half_height, size.y), reach(radius, size.x));
            Some(SharedShape::new(RoundShape { inner_shape, border_radius }))
        }
        TypedShape::RoundCone(round) if size.x == size.z => {
            let Cone { half_height, radius } = round.inner_shape;
            let border_radius = stretched_border(round.border_radius, size);
            let inner_shape = Cone::new(half_height * size.y, radius * size.x);
            Some(SharedShape::new(RoundShape { inner_shape, border_radius }))
        }
        _ => None,
    }
}

/// A cone points along y. An inverted cone is a compound with a rotated cone as its part, which stays round.
fn mirrored_cone(cone: SharedShape, signs: Vector) -> SharedShape {
    if signs.y > 0.0 {
        return cone;
    }
    let half_turn = Rotation::from_xyzw(1.0, 0.0, 0.0, 0.0);
    SharedShape::compound(vec![(Pose::from_parts(Vector::ZERO, half_turn), cone)])
}

/// A hull with its corners scaled, and faces that are counter-clockwise from outside.
fn scaled_hull(hull: &ConvexPolyhedron, scale: Vector) -> Option<ConvexPolyhedron> {
    let (mut corners, mut triangles) = hull.to_trimesh();
    corners.iter_mut().for_each(|corner| *corner *= scale);
    if turns_winding(scale) {
        triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
    }
    ConvexPolyhedron::from_convex_mesh(corners.clone(), &triangles)
        .or_else(|| ConvexPolyhedron::from_convex_hull(&corners))
}

/// Columns follow x, rows follow z. A mirror of one of them swaps the diagonals of cells; left is the side
/// with the smallest x.
fn mirrored_heights(field: &HeightField, signs: Vector) -> SharedShape {
    let (heights, cells) = (field.heights(), field.cells_statuses());
    let (back_rows, back_columns) = (signs.z < 0.0, signs.x < 0.0);
    let from = |at: usize, count: usize, back: bool| if back { count - 1 - at } else { at };
    let height = |row, column| {
        let row = from(row, heights.nrows(), back_rows);
        heights[(row, from(column, heights.ncols(), back_columns))] * signs.y
    };
    let status = |row, column| {
        let row = from(row, cells.nrows(), back_rows);
        mirrored_cell(cells[(row, from(column, cells.ncols(), back_columns))], back_rows, back_columns)
    };
    let mirrored = Array2::from_fn(heights.nrows(), heights.ncols(), height);
    let mut mirrored = HeightField::with_flags(mirrored, field.scale(), field.flags());
    *mirrored.cells_statuses_mut() = Array2::from_fn(cells.nrows(), cells.ncols(), status);
    SharedShape::new(mirrored)
}

fn mirrored_cell(cell: HeightFieldCellStatus, back_rows: bool, back_columns: bool) -> HeightFieldCellStatus {
    use HeightFieldCellStatus as Status;
    let mut mirrored = cell;
    mirrored.set(
        Status::ZIGZAG_SUBDIVISION,
        cell.contains(Status::ZIGZAG_SUBDIVISION) ^ back_rows ^ back_columns,
    );
    if back_columns {
        mirrored.set(Status::LEFT_TRIANGLE_REMOVED, cell.contains(Status::RIGHT_TRIANGLE_REMOVED));
        mirrored.set(Status::RIGHT_TRIANGLE_REMOVED, cell.contains(Status::LEFT_TRIANGLE_REMOVED));
    }
    mirrored
}
