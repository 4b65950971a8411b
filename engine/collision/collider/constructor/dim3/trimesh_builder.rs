//! Triangle meshes of colliders, for drawing, navigation meshes and export.

use bevy_reflect::{Reflect, std_traits::ReflectDefault};
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};
use core::num::NonZeroU32;
use thiserror::Error;

use crate::{
    collision::collider::Collider,
    math::Vector,
    parry::{
        math::Pose,
        shape::{Capsule, Compound, SharedShape, TypedShape},
    },
    physics_transform::{Position, Rotation},
};

/// Default number of subdivisions of curved shapes.
const DEFAULT_SUBDIVISIONS: NonZeroU32 = NonZeroU32::new(16).expect("16 is not zero");

/// Maximum number of subdivisions: a ball has one or two triangles for each pair of subdivisions.
const MAX_SUBDIVISIONS: u32 = 1024;

/// Makes a triangle mesh of the surface of a collider.
///
/// Curved shapes are subdivided. The border of rounded shapes is left out. Triangles of solid shapes are
/// counter-clockwise from outside.
///
/// Subdivisions are at least 3 around an axis, 2 from pole to pole, and at most 1024. Zero, or a number that
/// does not fit, is ignored with a warning.
///
/// ```
/// # use avian::prelude::*;
/// let ball = Collider::sphere(1.0);
/// let coarse = ball.trimesh_builder().build().expect("balls have a surface");
/// let fine = ball.trimesh_builder().sphere_subdivisions(64u32, 32u32).build().expect("balls have a surface");
/// assert!(fine.indices.len() > coarse.indices.len());
/// ```
#[derive(Debug, Clone)]
pub struct TrimeshBuilder {
    /// The shape.
    pub shape: SharedShape,
    /// The position of the shape in the mesh, in metres.
    pub position: Position,
    /// The rotation of the shape in the mesh.
    pub rotation: Rotation,
    /// Whether a compound with a part that has no surface is an error. Otherwise the part is left out.
    /// Default true.
    pub fail_on_compound_error: bool,
    /// Number of subdivisions of shapes without their own setting. Default 16.
    pub fallback_subdivisions: NonZeroU32,
    /// Subdivisions of balls, around the Y axis and from pole to pole.
    pub sphere_subdivisions: Option<(NonZeroU32, NonZeroU32)>,
    /// Subdivisions of capsules, around their axis and from pole to pole.
    pub capsule_subdivision: Option<(NonZeroU32, NonZeroU32)>,
    /// Subdivisions of cylinders around their axis.
    pub cylinder_subdivisions: Option<NonZeroU32>,
    /// Subdivisions of cones around their axis.
    pub cone_subdivisions: Option<NonZeroU32>,
}

/// A triangle mesh: corners in metres, and three indices per triangle.
#[derive(Debug, Clone, PartialEq, Reflect, Default)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[reflect(type_path = false, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
pub struct Trimesh {
    /// The corners.
    pub vertices: Vec<Vector>,
    /// The triangles.
    pub indices: Vec<[u32; 3]>,
}

crate::type_path::type_path!(Trimesh, "collision::collider::trimesh_builder");

impl Trimesh {
    /// Appends another mesh.
    pub fn extend(&mut self, other: Trimesh) {
        let before = self.vertices.len() as u32;
        self.vertices.extend(other.vertices);
        // Indices out of range stay out of range.
        self.indices.extend(other.indices.into_iter().map(|t| t.map(|i| i.saturating_add(before))));
    }
}

/// Why a [`TrimeshBuilder`] made no mesh.
#[derive(Debug, Error)]
pub enum TrimeshBuilderError {
    /// The shape has no surface of triangles, or an infinite surface. Contains the type of the shape.
    #[error("a shape of type {0} has no surface of triangles")]
    UnsupportedShape(String),
}

impl TrimeshBuilder {
    /// A builder for a shape at the origin.
    pub fn new(shape: SharedShape) -> Self {
        Self {
            shape,
            position: Position::default(),
            rotation: Rotation::default(),
            fail_on_compound_error: true,
            fallback_subdivisions: DEFAULT_SUBDIVISIONS,
            sphere_subdivisions: None,
            capsule_subdivision: None,
            cylinder_subdivisions: None,
            cone_subdivisions: None,
        }
    }

    /// Sets the position of the shape in the mesh, in metres.
    pub fn translated(&mut self, position: impl Into<Position>) -> &mut Self {
        self.position = position.into();
        self
    }

    /// Sets the rotation of the shape in the mesh, about its own origin.
    pub fn rotated(&mut self, rotation: impl Into<Rotation>) -> &mut Self {
        self.rotation = rotation.into();
        self
    }

    /// Sets the subdivisions of shapes without their own setting.
    pub fn fallback_subdivisions(&mut self, subdivisions: impl TryInto<NonZeroU32>) -> &mut Self {
        if let Some(subdivisions) = count(subdivisions) {
            self.fallback_subdivisions = subdivisions;
        }
        self
    }

    /// Sets the subdivisions of balls, around the Y axis and from pole to pole.
    pub fn sphere_subdivisions(
        &mut self,
        theta: impl TryInto<NonZeroU32>,
        phi: impl TryInto<NonZeroU32>,
    ) -> &mut Self {
        self.sphere_subdivisions = count(theta).zip(count(phi)).or(self.sphere_subdivisions);
        self
    }

    /// Sets the subdivisions of capsules, around their axis and from pole to pole.
    pub fn capsule_subdivisions(
        &mut self,
        theta: impl TryInto<NonZeroU32>,
        phi: impl TryInto<NonZeroU32>,
    ) -> &mut Self {
        self.capsule_subdivision = count(theta).zip(count(phi)).or(self.capsule_subdivision);
        self
    }

    /// Sets the subdivisions of cylinders around their axis.
    pub fn cylinder_subdivisions(&mut self, subdivisions: impl TryInto<NonZeroU32>) -> &mut Self {
        self.cylinder_subdivisions = count(subdivisions).or(self.cylinder_subdivisions);
        self
    }

    /// Sets the subdivisions of cones around their axis.
    pub fn cone_subdivisions(&mut self, subdivisions: impl TryInto<NonZeroU32>) -> &mut Self {
        self.cone_subdivisions = count(subdivisions).or(self.cone_subdivisions);
        self
    }

    /// Sets whether a compound with a part that has no surface is an error. Otherwise the part is left out.
    pub fn fail_on_compound_error(&mut self, fail_on_compound_error: bool) -> &mut Self {
        self.fail_on_compound_error = fail_on_compound_error;
        self
    }

    /// Makes the mesh.
    ///
    /// # Errors
    ///
    /// [`UnsupportedShape`](TrimeshBuilderError::UnsupportedShape) for half-spaces, segments, polylines and
    /// shapes of the app's own, which have no surface of triangles.
    pub fn build(&self) -> Result<Trimesh, TrimeshBuilderError> {
        let mut mesh = self.mesh_of(&self.shape)?;
        let pose = Pose::from_parts(self.position.0, self.rotation.0);
        for vertex in &mut mesh.vertices {
            *vertex = pose * *vertex;
        }
        Ok(mesh)
    }

    fn mesh_of(&self, shape: &SharedShape) -> Result<Trimesh, TrimeshBuilderError> {
        let around = |own: Option<NonZeroU32>| clamped(own.unwrap_or(self.fallback_subdivisions), 3);
        let of_ball = |own: Option<(NonZeroU32, NonZeroU32)>| {
            let (theta, phi) = own.unwrap_or((self.fallback_subdivisions, self.fallback_subdivisions));
            (clamped(theta, 3), clamped(phi, 2))
        };
        let (vertices, indices) = match shape.as_typed_shape() {
            TypedShape::Ball(ball) => {
                let (theta, phi) = of_ball(self.sphere_subdivisions);
                ball.to_trimesh(theta, phi)
            }
            TypedShape::Capsule(capsule) => {
                let (theta, phi) = of_ball(self.capsule_subdivision);
                mesh_of_capsule(capsule, theta, phi)
            }
            TypedShape::Cylinder(cylinder) => cylinder.to_trimesh(around(self.cylinder_subdivisions)),
            TypedShape::RoundCylinder(round) => {
                round.inner_shape.to_trimesh(around(self.cylinder_subdivisions))
            }
            TypedShape::Cone(cone) => cone.to_trimesh(around(self.cone_subdivisions)),
            TypedShape::RoundCone(round) => round.inner_shape.to_trimesh(around(self.cone_subdivisions)),
            TypedShape::Cuboid(cuboid) => cuboid.to_trimesh(),
            TypedShape::RoundCuboid(round) => round.inner_shape.to_trimesh(),
            TypedShape::ConvexPolyhedron(hull) => hull.to_trimesh(),
            TypedShape::RoundConvexPolyhedron(round) => round.inner_shape.to_trimesh(),
            TypedShape::Triangle(t) => (vec![t.a, t.b, t.c], vec![[0, 1, 2]]),
            TypedShape::RoundTriangle(round) => {
                let t = &round.inner_shape;
                (vec![t.a, t.b, t.c], vec![[0, 1, 2]])
            }
            TypedShape::TriMesh(mesh) => (mesh.vertices().to_vec(), mesh.indices().to_vec()),
            TypedShape::HeightField(field) => field.to_trimesh(),
            TypedShape::Voxels(voxels) => voxels.to_trimesh(),
            TypedShape::Compound(compound) => return self.mesh_of_compound(compound),
            TypedShape::HalfSpace(_)
            | TypedShape::Segment(_)
            | TypedShape::Polyline(_)
            | TypedShape::Custom(_) => {
                return Err(TrimeshBuilderError::UnsupportedShape(format!("{:?}", shape.shape_type())));
            }
        };
        Ok(Trimesh { vertices, indices })
    }

    fn mesh_of_compound(&self, compound: &Compound) -> Result<Trimesh, TrimeshBuilderError> {
        let mut whole = Trimesh::default();
        for (pose, part) in compound.shapes() {
            match self.mesh_of(part) {
                Ok(mut mesh) => {
                    mesh.vertices.iter_mut().for_each(|vertex| *vertex = *pose * *vertex);
                    whole.extend(mesh);
                }
                Err(error) if self.fail_on_compound_error => return Err(error),
                Err(_) => {}
            }
        }
        Ok(whole)
    }
}

/// A capsule whose segment is a point is a ball: parry's capsule mesh would have no direction.
fn mesh_of_capsule(capsule: &Capsule, theta: u32, phi: u32) -> (Vec<Vector>, Vec<[u32; 3]>) {
    if capsule.half_height() > 0.0 {
        return capsule.to_trimesh(theta, phi);
    }
    let (mut vertices, indices) = crate::parry::shape::Ball::new(capsule.radius).to_trimesh(theta, phi);
    vertices.iter_mut().for_each(|vertex| *vertex += capsule.segment.a);
    (vertices, indices)
}

/// A number of subdivisions, unless it is invalid.
fn count(subdivisions: impl TryInto<NonZeroU32>) -> Option<NonZeroU32> {
    let count = subdivisions.try_into().ok();
    if count.is_none() {
        bevy_log::warn_once!(
            "a number of subdivisions for a triangle mesh is zero or too large; it is ignored"
        );
    }
    count
}

/// A number of subdivisions within its limits.
fn clamped(subdivisions: NonZeroU32, least: u32) -> u32 {
    subdivisions.get().clamp(least, MAX_SUBDIVISIONS)
}

impl Collider {
    /// A builder for a triangle mesh of the collider's surface, with its scale.
    pub fn trimesh_builder(&self) -> TrimeshBuilder {
        TrimeshBuilder::new(self.shape_scaled().clone())
    }

    /// The triangles of the collider's surface, with its scale and the default subdivisions of curved shapes.
    ///
    /// # Errors
    ///
    /// As [`TrimeshBuilder::build`].
    ///
    /// ```
    /// # use avian::prelude::*;
    /// let mesh = Collider::cuboid(1.0, 2.0, 3.0).to_trimesh().expect("it has a surface");
    /// assert_eq!((mesh.vertices.len(), mesh.indices.len()), (8, 12));
    /// ```
    pub fn to_trimesh(&self) -> Result<Trimesh, TrimeshBuilderError> {
        self.trimesh_builder().build()
    }
}

#[cfg(feature = "collider-from-mesh")]
impl From<Trimesh> for bevy_mesh::Mesh {
    /// A mesh of Bevy with positions and smooth normals. Triangles with missing corners are left out.
    fn from(mesh: Trimesh) -> Self {
        use crate::math::AsF32;

        let count = mesh.vertices.len() as u32;
        let triangles = mesh.indices.into_iter().filter(|t| t.iter().all(|i| *i < count));
        let indices = bevy_mesh::Indices::U32(triangles.flatten().collect());
        let positions: Vec<_> = mesh.vertices.iter().map(|v| v.f32().to_array()).collect();
        Self::new(bevy_mesh::PrimitiveTopology::TriangleList, bevy_asset::RenderAssetUsages::default())
            .with_inserted_attribute(Self::ATTRIBUTE_POSITION, positions)
            .with_inserted_indices(indices)
            .with_computed_smooth_normals()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{PI, Scalar};
    use std::collections::BTreeMap;

    /// The volume in a mesh with outward triangles.
    fn volume(mesh: &Trimesh) -> Scalar {
        let corner = |i: u32| mesh.vertices[i as usize];
        mesh.indices.iter().map(|t| corner(t[0]).cross(corner(t[1])).dot(corner(t[2]))).sum::<Scalar>() / 6.0
    }

    /// Whether each side of a triangle is also the side of another triangle, in the opposite direction.
    fn is_closed(mesh: &Trimesh) -> bool {
        let place = |i: u32| mesh.vertices[i as usize].to_array().map(|c| (c * 4096.0).round() as i64);
        let mut sides = BTreeMap::new();
        for [a, b, c] in mesh.indices.iter().map(|t| t.map(place)) {
            for side in [(a, b), (b, c), (c, a)] {
                *sides.entry(side).or_insert(0) += 1;
            }
        }
        sides.iter().all(|((a, b), count)| a == b || sides.get(&(*b, *a)) == Some(count))
    }

    #[track_caller]
    fn mesh(collider: &Collider) -> Trimesh {
        collider.trimesh_builder().build().expect("a surface")
    }

    #[test]
    fn solids_have_closed_outward_meshes_with_their_volume() {
        let corner = |i: u32| Vector::new((i & 1) as _, (i >> 1 & 1) as _, (i >> 2) as _);
        let solids = [
            (Collider::cuboid(1.0, 2.0, 3.0), 6.0, 1.0e-5),
            (Collider::round_cuboid(1.0, 2.0, 3.0, 0.1), 6.0, 1.0e-5),
            (Collider::convex_hull((0..8).map(corner).collect()).expect("a box"), 1.0, 1.0e-5),
            (Collider::voxels(Vector::ONE, &[[0, 0, 0].into(), [1, 0, 0].into()]), 2.0, 1.0e-5),
            // 16 subdivisions cut off less than a tenth.
            (Collider::sphere(1.5), 4.5 * PI, 0.1),
            (Collider::capsule(0.5, 2.0), 0.5 * PI + PI / 6.0, 0.1),
            (
                Collider::capsule_endpoints(0.5, Vector::ONE, Vector::X * 3.0),
                0.25 * PI * 6.0_f32.sqrt() as Scalar + PI / 6.0,
                0.1,
            ),
            (Collider::capsule(0.5, 0.0), PI / 6.0, 0.1),
            (Collider::cylinder(0.5, 2.0), 0.5 * PI, 0.1),
            (Collider::cone(0.5, 3.0), 0.25 * PI, 0.1),
        ];
        for (solid, exact, part) in solids {
            let mesh = mesh(&solid);
            let found = volume(&mesh);
            assert!(is_closed(&mesh), "{:?}", solid.shape().shape_type());
            assert!(found <= exact * 1.00001 && found > exact * (1.0 - part), "{found} {exact} {solid:?}");
            let bounds = solid.shape().compute_local_aabb();
            let inside =
                |v: &Vector| (*v - bounds.center()).abs().cmple(bounds.half_extents() + 1.0e-4).all();
            assert!(mesh.vertices.iter().all(inside));
        }
    }

    #[test]
    fn surfaces_keep_their_triangles() {
        let triangle = Collider::triangle(Vector::ZERO, Vector::X, Vector::Y);
        assert_eq!(mesh(&triangle).vertices, [Vector::ZERO, Vector::X, Vector::Y]);
        let again = mesh(&Collider::trimesh(vec![Vector::ZERO, Vector::X, Vector::Y], vec![[0, 1, 2]]));
        assert_eq!(again, mesh(&triangle));
        let field = mesh(&Collider::heightfield(vec![vec![0.0; 3]; 4], Vector::ONE));
        assert_eq!(field.indices.len(), 2 * 2 * 3);
    }

    #[test]
    fn compounds_have_the_triangles_of_their_parts() {
        let cube = || Collider::cuboid(1.0, 1.0, 1.0);
        let both = Collider::compound(vec![
            (Vector::X * 3.0, Rotation::default(), cube()),
            (Vector::Y * 2.0, Rotation::default(), Collider::segment(Vector::ZERO, Vector::X)),
            (Vector::X * -3.0, Rotation::default(), cube()),
        ]);
        let mut builder = both.trimesh_builder();
        assert!(
            matches!(builder.build(), Err(TrimeshBuilderError::UnsupportedShape(name)) if name == "Segment")
        );
        let mesh = builder.fail_on_compound_error(false).translated(Vector::Z).build().expect("two cubes");
        assert_eq!((mesh.vertices.len(), mesh.indices.len()), (16, 24));
        assert!((volume(&mesh) - 2.0).abs() < 1.0e-4);
        assert!(mesh.vertices.iter().all(|v| (v.x.abs() - 3.0).abs() < 0.51 && (v.z - 1.0).abs() < 0.51));
    }

    #[test]
    fn a_mesh_is_that_of_the_scaled_and_turned_shape() {
        let mut cube = Collider::cuboid(1.0, 1.0, 1.0);
        cube.set_scale(Vector::new(2.0, 1.0, 1.0), 8);
        let turned = Rotation::from(bevy_math::Quat::from_rotation_z(core::f32::consts::FRAC_PI_2));
        let mesh = cube.trimesh_builder().rotated(turned).build().expect("a box");
        let half = mesh.vertices.iter().fold(Vector::ZERO, |half, v| half.max(v.abs()));
        assert!((half - Vector::new(0.5, 1.0, 0.5)).length() < 1.0e-5, "{half}");
    }

    #[test]
    fn any_number_of_subdivisions_makes_a_mesh() {
        let shapes = [
            Collider::sphere(1.0),
            Collider::capsule(1.0, 1.0),
            Collider::cylinder(1.0, 1.0),
            Collider::cone(1.0, 1.0),
        ];
        for shape in shapes {
            for count in [1u32, 2, 3, 5] {
                let mesh = shape.trimesh_builder().fallback_subdivisions(count).build().expect("a surface");
                assert!(is_closed(&mesh) && volume(&mesh) > 0.1, "{count} of {shape:?}");
            }
            let mut builder = shape.trimesh_builder();
            builder.fallback_subdivisions(0u32).sphere_subdivisions(0u32, 9u32).cone_subdivisions(0u32);
            assert_eq!(builder.fallback_subdivisions, DEFAULT_SUBDIVISIONS);
            assert!(builder.sphere_subdivisions.is_none());
        }
        assert_eq!(clamped(NonZeroU32::MAX, 3), MAX_SUBDIVISIONS);
    }

    #[test]
    fn shapes_without_a_surface_are_refused() {
        for shape in [
            Collider::half_space(Vector::Y),
            Collider::segment(Vector::ZERO, Vector::X),
            Collider::polyline(vec![Vector::ZERO, Vector::X], None),
        ] {
            assert!(shape.trimesh_builder().build().is_err());
        }
    }

    #[cfg(feature = "collider-from-mesh")]
    #[test]
    fn a_mesh_becomes_one_of_bevy_and_a_collider_again() {
        let mut mesh = mesh(&Collider::cuboid(1.0, 2.0, 3.0));
        mesh.indices.push([0, 1, 99]);
        let bevy = bevy_mesh::Mesh::from(mesh);
        let hull = Collider::convex_hull_from_mesh(&bevy).expect("a box");
        assert!((crate::math::ComputeMassProperties::mass(&hull, 1.0) - 6.0).abs() < 1.0e-4);
        let again = Collider::trimesh_from_mesh(&bevy).expect("triangles");
        assert_eq!(again.shape().as_trimesh().map(|mesh| mesh.num_triangles()), Some(12));
    }
}
