//! The constructors and mass properties of 2D colliders.

use super::super::Collider;
use super::super::constructors::{speck, usable_vertices};
use super::super::dim::{cuboid_shape, is_solid};
use super::super::input::{Input, MIN_LENGTH, checked, is_usable};
use super::super::params::{FillMode, VhacdParameters};
use super::ellipse::EllipseColliderShape;
use super::regular_polygon::RegularPolygonColliderShape;
use crate::math::{AdjustPrecision, AsF32, Scalar, Vector};
use crate::parry::shape::SharedShape;
use bevy_heavy::{ComputeMassProperties2d, MassProperties2d};
use bevy_math::Vec2;
use bevy_math::primitives::{Ellipse, RegularPolygon};
use kernel::shape::Shape as NativeShape;

impl FillMode {
    /// The default of [`VhacdParameters::fill_mode`].
    pub(in super::super) const USUAL: Self =
        Self::FloodFill { detect_cavities: false, detect_self_intersections: false };
}

impl From<FillMode> for crate::parry::transformation::voxelization::FillMode {
    fn from(mode: FillMode) -> Self {
        match mode {
            FillMode::SurfaceOnly => Self::SurfaceOnly,
            FillMode::FloodFill { detect_cavities, detect_self_intersections } => {
                Self::FloodFill { detect_cavities, detect_self_intersections }
            }
        }
    }
}

/// Mass properties at density 1.
fn unit_mass_properties(collider: &Collider) -> MassProperties2d {
    match collider.native() {
        NativeShape::Composite(_) | NativeShape::Foreign(_) => {
            foreign_mass_properties(collider.shape_scaled())
        }
        native => {
            let properties = native.mass_properties(1.0);
            MassProperties2d {
                mass: properties.mass,
                angular_inertia: properties.inertia,
                center_of_mass: Vec2::from_array(properties.center.to_array()),
            }
        }
    }
}

/// The mass properties by parry, corrected for clockwise outlines, which have a negative area in parry.
fn foreign_mass_properties(shape: &SharedShape) -> MassProperties2d {
    let properties = shape.mass_properties(1.0);
    let mass = (properties.mass() as f32).abs();
    let inertia = (properties.principal_inertia() as f32).abs();
    let center = properties.local_com.f32();
    if mass.is_finite() && inertia.is_finite() && center.is_finite() {
        MassProperties2d { mass, angular_inertia: inertia, center_of_mass: center }
    } else {
        MassProperties2d::ZERO
    }
}

impl ComputeMassProperties2d for Collider {
    fn mass(&self, density: f32) -> f32 {
        unit_mass_properties(self).mass * density
    }

    fn unit_angular_inertia(&self) -> f32 {
        unit_mass_properties(self).unit_angular_inertia()
    }

    fn center_of_mass(&self) -> Vec2 {
        unit_mass_properties(self).center_of_mass
    }

    fn mass_properties(&self, density: f32) -> MassProperties2d {
        let unit = unit_mass_properties(self);
        MassProperties2d {
            mass: unit.mass * density,
            angular_inertia: unit.angular_inertia * density,
            ..unit
        }
    }
}

impl Collider {
    /// A disc around the origin.
    pub fn circle(radius: Scalar) -> Self {
        checked!("circle", |input| SharedShape::ball(input.length(radius)).into())
    }

    /// An ellipse around the origin, along the axes.
    pub fn ellipse(half_width: Scalar, half_height: Scalar) -> Self {
        checked!("ellipse", |input| {
            let half = Vector::new(input.length(half_width), input.length(half_height)).f32();
            SharedShape::new(EllipseColliderShape(Ellipse { half_size: half })).into()
        })
    }

    /// A rectangle around the origin with the given side lengths.
    pub fn rectangle(x_length: Scalar, y_length: Scalar) -> Self {
        checked!("rectangle", |input| {
            cuboid_shape(Vector::new(input.length(x_length), input.length(y_length)) * 0.5).into()
        })
    }

    /// A rectangle with `border_radius` around it. Its total width is `x_length + 2 * border_radius`.
    pub fn round_rectangle(x_length: Scalar, y_length: Scalar, border_radius: Scalar) -> Self {
        checked!("round_rectangle", |input| {
            let half = Vector::new(input.length(x_length), input.length(y_length)) * 0.5;
            SharedShape::round_cuboid(half.x, half.y, input.length_or_zero(border_radius)).into()
        })
    }

    /// A triangle. The order of the corners does not matter. A triangle without an area becomes its longest
    /// side.
    pub fn triangle(a: Vector, b: Vector, c: Vector) -> Self {
        checked!("triangle", |input| {
            let [a, b, c] = [a, b, c].map(|p| input.point(p));
            let area = (b - a).perp_dot(c - a);
            if is_flat([a, b, c], area) {
                let (a, b) = longest_side([a, b, c]);
                let (a, b) = input.segment(a, b);
                input.repair(SharedShape::segment(a, b)).into()
            } else if area < 0.0 {
                SharedShape::triangle(a, c, b).into()
            } else {
                SharedShape::triangle(a, b, c).into()
            }
        })
    }

    /// A triangle whose corners must be in counter-clockwise order and not collinear.
    pub fn triangle_unchecked(a: Vector, b: Vector, c: Vector) -> Self {
        checked!("triangle_unchecked", |input| {
            let [a, b, c] = [a, b, c].map(|p| input.point(p));
            SharedShape::triangle(a, b, c).into()
        })
    }

    /// A regular polygon around the origin with its corners at `circumradius`, the first one straight up.
    /// At least three sides.
    pub fn regular_polygon(circumradius: f32, sides: u32) -> Self {
        checked!("regular_polygon", |input| {
            let radius = input.length(circumradius.adjust_precision()) as f32;
            let sides = if sides < 3 { input.repair(3) } else { sides };
            SharedShape::new(RegularPolygonColliderShape(RegularPolygon::new(radius, sides))).into()
        })
    }

    /// The polygon with the given corners. `None` if they are not the corners of a convex polygon in order,
    /// in either orientation. Corners in a straight side are left out.
    pub fn convex_polyline(mut points: Vec<Vector>) -> Option<Self> {
        if !points.iter().all(|p| is_usable(*p)) {
            return None;
        }
        let area: Scalar = corners(&points).map(|[a, b, _]| a.perp_dot(b)).sum();
        if area < 0.0 {
            points.reverse();
        }
        // All turns are to the left, and add up to one full turn. A star also has only left turns.
        let tolerance = -1.0e-6 * area.abs();
        let convex = corners(&points).all(|[a, b, c]| (b - a).perp_dot(c - b) >= tolerance);
        let upward = |v: Vector| v.y > 0.0 || v.y == 0.0 && v.x > 0.0;
        let turns = corners(&points).filter(|[a, b, c]| upward(*b - *a) != upward(*c - *b)).count();
        if !convex || turns > 2 {
            return None;
        }
        let shape = SharedShape::convex_polyline(points)?;
        is_solid(&shape).then(|| shape.into())
    }

    /// Convex polygons that together approximate the inside of a closed outline.
    pub fn convex_decomposition(vertices: Vec<Vector>, indices: Vec<[u32; 2]>) -> Self {
        Self::convex_decomposition_with_config(vertices, indices, &VhacdParameters::default())
    }

    /// Convex polygons that together approximate the inside of a closed outline, with parameters.
    pub fn convex_decomposition_with_config(
        vertices: Vec<Vector>,
        indices: Vec<[u32; 2]>,
        params: &VhacdParameters,
    ) -> Self {
        checked!("convex_decomposition", |input| Self::decomposition(&vertices, indices, params, &mut input))
    }

    /// The squares that an outline passes through, and the squares inside it as set by `fill_mode`.
    pub fn voxelized_polyline(
        vertices: &[Vector],
        indices: &[[u32; 2]],
        voxel_size: Scalar,
        fill_mode: FillMode,
    ) -> Self {
        checked!("voxelized_polyline", |input| {
            Self::voxelized(vertices, indices, voxel_size, fill_mode, &mut input)
        })
    }

    /// A height field: heights at equal distances along the X axis, times `scale.y`. It is centred on the
    /// origin and `scale.x` wide in total. At least two heights.
    pub fn heightfield(heights: Vec<Scalar>, scale: Vector) -> Self {
        checked!("heightfield", |input| {
            if heights.len() < 2 {
                return speck(&mut input).into();
            }
            let (heights, factor) = input.heights(heights.into_iter(), scale.y);
            let scale = Vector::new(input.length(scale.x), factor);
            SharedShape::heightfield(heights, scale).into()
        })
    }

    /// The polygon with an outline, decomposed into convex polygons. An outline that crosses itself becomes
    /// its convex hull.
    pub(in super::super) fn polygon(outline: Vec<Vector>, input: &mut Input) -> Self {
        let mut outline = usable_outline(outline, input);
        let area: Scalar = corners(&outline).map(|[a, b, _]| a.perp_dot(b)).sum();
        if area < 0.0 {
            outline.reverse();
        }
        if let Some(convex) = Self::convex_polyline(outline.clone()) {
            return convex;
        }
        let parts = super::super::input::without_panic(|| {
            let mesh = crate::parry::shape::TriMesh::from_polygon(outline.clone())?;
            crate::parry::shape::Compound::decompose_trimesh(&mesh)
        });
        match parts.flatten() {
            Some(compound) => SharedShape::new(compound).into(),
            None => input.repair(Self::convex_hull(outline)).unwrap_or_else(|| speck(input).into()),
        }
    }
}

/// The usable corners of an outline, without consecutive duplicates.
fn usable_outline(outline: Vec<Vector>, input: &mut Input) -> Vec<Vector> {
    let count = outline.len();
    let mut kept: Vec<_> = outline.into_iter().filter(|v| is_usable(*v)).collect();
    input.repaired |= kept.len() != count;
    kept.dedup();
    if kept.len() > 1 && kept.first() == kept.last() {
        kept.pop();
    }
    usable_vertices(kept)
}

/// Each corner of an outline with the next two.
fn corners(points: &[Vector]) -> impl Iterator<Item = [Vector; 3]> + '_ {
    let n = points.len();
    (0..n).map(move |i| [points[i], points[(i + 1) % n], points[(i + 2) % n]])
}

/// Whether three points are collinear, given twice their area.
fn is_flat([a, b, c]: [Vector; 3], area: Scalar) -> bool {
    let longest = a.distance_squared(b).max(b.distance_squared(c)).max(c.distance_squared(a));
    area.abs() <= MIN_LENGTH * MIN_LENGTH || area.abs() <= 8.0 * Scalar::EPSILON * longest
}

/// The two points farthest apart.
fn longest_side([a, b, c]: [Vector; 3]) -> (Vector, Vector) {
    let (ab, bc, ca) = (a.distance_squared(b), b.distance_squared(c), c.distance_squared(a));
    if ab >= bc && ab >= ca {
        (a, b)
    } else if bc >= ca {
        (b, c)
    } else {
        (c, a)
    }
}
