//! The constructors and mass properties of 3D colliders.

use super::super::Collider;
use super::super::constructors::speck;
use super::super::dim::cuboid_shape;
use super::super::input::{MIN_LENGTH, checked};
use super::super::params::{FillMode, VhacdParameters};
use crate::math::{AsF32, Scalar, Vector};
use crate::parry::bounding_volume::BoundingVolume;
use crate::parry::mass_properties::MassProperties;
use crate::parry::shape::SharedShape;
use crate::parry::utils::Array2;
use bevy_heavy::{ComputeMassProperties3d, MassProperties3d};
use bevy_math::{Quat, Vec3};
use kernel::shape::Shape as NativeShape;

impl FillMode {
    /// The default of [`VhacdParameters::fill_mode`].
    pub(in super::super) const USUAL: Self = Self::FloodFill { detect_cavities: false };
}

impl From<FillMode> for crate::parry::transformation::voxelization::FillMode {
    fn from(mode: FillMode) -> Self {
        match mode {
            FillMode::SurfaceOnly => Self::SurfaceOnly,
            FillMode::FloodFill { detect_cavities } => Self::FloodFill { detect_cavities },
        }
    }
}

/// Mass properties at density 1.
fn unit_mass_properties(collider: &Collider) -> MassProperties3d {
    match collider.native() {
        NativeShape::Composite(_) | NativeShape::Foreign(_) => {
            foreign_mass_properties(collider.shape_scaled())
        }
        native => native_mass_properties(native),
    }
}

/// The mass properties by the kernel, with the inertia tensor in principal axes.
fn native_mass_properties(shape: &NativeShape) -> MassProperties3d {
    let p = shape.mass_properties(1.0);
    let i = p.inertia;
    let tensor = bevy_heavy::AngularInertiaTensor::from_mat3_unchecked(bevy_math::Mat3::from_cols_array(&[
        i.xx, i.xy, i.xz, i.xy, i.yy, i.yz, i.xz, i.yz, i.zz,
    ]));
    let center = Vec3::from_array(p.center.to_array());
    if i.xy == 0.0 && i.xz == 0.0 && i.yz == 0.0 {
        return MassProperties3d::new(p.mass, Vec3::new(i.xx, i.yy, i.zz), center);
    }
    MassProperties3d::new_with_angular_inertia_tensor(p.mass, tensor, center)
}

/// The mass properties by parry, corrected for inward triangles, which have a negative volume in parry. A mesh
/// that is not closed has no volume: if its centre of mass comes to be outside of its box, it counts as a
/// shape that fills the box.
fn foreign_mass_properties(shape: &SharedShape) -> MassProperties3d {
    let bounds = shape.compute_local_aabb();
    let mut properties = shape.mass_properties(1.0);
    if !bounds.loosened(0.01 * bounds.half_extents().length()).contains_local_point(properties.local_com) {
        properties = MassProperties::from_cuboid(1.0, bounds.half_extents());
        properties.local_com = bounds.center();
    }
    let mass = (properties.mass() as f32).abs();
    let inertia = properties.principal_inertia().f32().abs();
    let frame = properties.principal_inertia_local_frame.f32();
    let center = properties.local_com.f32();
    if mass.is_finite() && inertia.is_finite() && frame.is_finite() && center.is_finite() {
        MassProperties3d::new_with_local_frame(mass, inertia, frame, center)
    } else {
        MassProperties3d::ZERO
    }
}

impl ComputeMassProperties3d for Collider {
    fn mass(&self, density: f32) -> f32 {
        unit_mass_properties(self).mass * density
    }

    fn unit_principal_angular_inertia(&self) -> Vec3 {
        unit_mass_properties(self).unit_principal_angular_inertia()
    }

    fn local_inertial_frame(&self) -> Quat {
        unit_mass_properties(self).local_inertial_frame
    }

    fn center_of_mass(&self) -> Vec3 {
        unit_mass_properties(self).center_of_mass
    }

    fn mass_properties(&self, density: f32) -> MassProperties3d {
        let unit = unit_mass_properties(self);
        MassProperties3d {
            mass: unit.mass * density,
            principal_angular_inertia: unit.principal_angular_inertia * density,
            ..unit
        }
    }
}

impl Collider {
    /// A ball around the origin.
    pub fn sphere(radius: Scalar) -> Self {
        checked!("sphere", |input| SharedShape::ball(input.length(radius)).into())
    }

    /// A box around the origin with the given side lengths.
    pub fn cuboid(x_length: Scalar, y_length: Scalar, z_length: Scalar) -> Self {
        checked!("cuboid", |input| {
            let size = [x_length, y_length, z_length].map(|v| input.length(v));
            cuboid_shape(Vector::from_array(size) * 0.5).into()
        })
    }

    /// A box with `border_radius` around it. Its total width is `x_length + 2 * border_radius`.
    pub fn round_cuboid(x_length: Scalar, y_length: Scalar, z_length: Scalar, border_radius: Scalar) -> Self {
        checked!("round_cuboid", |input| {
            let [x, y, z] = [x_length, y_length, z_length].map(|v| input.length(v) * 0.5);
            SharedShape::round_cuboid(x, y, z, input.length_or_zero(border_radius)).into()
        })
    }

    /// A cylinder along the Y axis, around the origin.
    pub fn cylinder(radius: Scalar, height: Scalar) -> Self {
        checked!("cylinder", |input| {
            SharedShape::cylinder(input.length(height) * 0.5, input.length(radius)).into()
        })
    }

    /// A cone along the Y axis with its tip up; the origin is half way up.
    pub fn cone(radius: Scalar, height: Scalar) -> Self {
        checked!("cone", |input| {
            SharedShape::cone(input.length(height) * 0.5, input.length(radius)).into()
        })
    }

    /// A triangle: a surface without thickness. A triangle without an area becomes its longest side.
    pub fn triangle(a: Vector, b: Vector, c: Vector) -> Self {
        checked!("triangle", |input| {
            let [a, b, c] = [a, b, c].map(|p| input.point(p));
            if is_flat([a, b, c]) {
                let (a, b) = longest_side([a, b, c]);
                let (a, b) = input.segment(a, b);
                input.repair(SharedShape::segment(a, b)).into()
            } else {
                SharedShape::triangle(a, b, c).into()
            }
        })
    }

    /// Convex polyhedra that together approximate the inside of a closed surface.
    pub fn convex_decomposition(vertices: Vec<Vector>, indices: Vec<[u32; 3]>) -> Self {
        Self::convex_decomposition_with_config(vertices, indices, VhacdParameters::default())
    }

    /// Convex polyhedra that together approximate the inside of a closed surface, with parameters.
    pub fn convex_decomposition_with_config(
        vertices: Vec<Vector>,
        indices: Vec<[u32; 3]>,
        params: VhacdParameters,
    ) -> Self {
        checked!("convex_decomposition", |input| Self::decomposition(&vertices, indices, &params, &mut input))
    }

    /// The boxes that a surface passes through, and the boxes inside it as set by `fill_mode`.
    pub fn voxelized_trimesh(
        vertices: &[Vector],
        indices: &[[u32; 3]],
        voxel_size: Scalar,
        fill_mode: FillMode,
    ) -> Self {
        checked!("voxelized_trimesh", |input| {
            Self::voxelized(vertices, indices, voxel_size, fill_mode, &mut input)
        })
    }

    /// A height field: heights on a grid over the XZ plane, times `scale.y`. It is centred on the origin, and
    /// `scale.x` by `scale.z` in total.
    ///
    /// `heights[i][j]` is at place i along X and j along Z. At least two heights in each direction. If the
    /// inner lists differ in length, the shortest one counts.
    pub fn heightfield(heights: Vec<Vec<Scalar>>, scale: Vector) -> Self {
        checked!("heightfield", |input| {
            let along_z = heights.iter().map(Vec::len).min().unwrap_or(0);
            if heights.len() < 2 || along_z < 2 {
                return speck(&mut input).into();
            }
            input.repaired |= heights.iter().any(|line| line.len() != along_z);
            let along_x = heights.len();
            let lines = heights.iter().flat_map(|line| &line[..along_z]);
            let (data, factor) = input.heights(lines.copied(), scale.y);
            let scale = Vector::new(input.length(scale.x), factor, input.length(scale.z));
            // Parry's rows run along Z and are stored by column: one inner list after the other.
            SharedShape::heightfield(Array2::new(along_z, along_x, data), scale).into()
        })
    }
}

/// Whether three points are collinear.
fn is_flat([a, b, c]: [Vector; 3]) -> bool {
    let longest = a.distance_squared(b).max(b.distance_squared(c)).max(c.distance_squared(a));
    let area = (b - a).cross(c - a).length();
    area <= MIN_LENGTH * MIN_LENGTH || area <= 8.0 * Scalar::EPSILON * longest
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
