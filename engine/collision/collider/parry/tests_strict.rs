//! Constructors that return errors, and the parts of colliders.

use super::*;
use crate::math::{ComputeMassProperties, DIM, Scalar};
use crate::parry::math::IVector;
use crate::physics_transform::{Position, Rotation};
use ColliderError as Error;

/// Invalid sizes.
pub(super) const BAD: [Scalar; 7] =
    [0.0, -1.0, Scalar::NAN, Scalar::INFINITY, Scalar::NEG_INFINITY, Scalar::MAX, Scalar::MIN_POSITIVE];

/// Asserts that a constructor failed with an error.
#[track_caller]
pub(super) fn fails(made: Result<Collider, Error>, error: Error) {
    assert_eq!(made.err(), Some(error));
}

/// The corners and elements of a unit simplex: an outline in 2D, a surface in 3D.
fn simplex() -> (Vec<Vector>, Vec<[u32; DIM]>) {
    let axis = |i: usize| Vector::from_array(core::array::from_fn(|k| if k + 1 == i { 1.0 } else { 0.0 }));
    let corners = (0..=DIM).map(axis).collect();
    // Each element lacks one corner.
    let element = |lacks: usize| {
        let mut rest = (0..=DIM as u32).filter(|i| *i != lacks as u32);
        core::array::from_fn(|_| rest.next().expect("one more corner than an element has"))
    };
    (corners, (0..=DIM).map(element).collect())
}

#[test]
fn bad_sizes_and_points_are_errors() {
    let far = Vector::splat(Scalar::INFINITY);
    for bad in BAD {
        fails(Collider::try_capsule(bad, 1.0), Error::InvalidSize);
        fails(Collider::try_capsule_endpoints(bad, Vector::ZERO, Vector::X), Error::InvalidSize);
        fails(Collider::try_voxels(Vector::splat(bad), &[IVector::ZERO]), Error::InvalidSize);
        fails(Collider::try_voxels_from_points(Vector::splat(bad), &[Vector::ZERO]), Error::InvalidSize);
        if !(0.0..1.0).contains(&bad) {
            fails(Collider::try_capsule(1.0, bad), Error::NegativeSize);
        }
        if bad.abs() > 1.0 || bad.is_nan() {
            let point = Vector::splat(bad);
            fails(Collider::try_capsule_endpoints(1.0, point, Vector::X), Error::InvalidPoint);
            fails(Collider::try_segment(Vector::X, point), Error::InvalidPoint);
            fails(Collider::try_triangle(Vector::ZERO, Vector::X, point), Error::InvalidPoint);
            fails(Collider::try_polyline(vec![point, Vector::ZERO], None), Error::InvalidPoint);
            fails(Collider::try_convex_hull(vec![point; 9]), Error::InvalidPoint);
            fails(Collider::try_voxels_from_points(Vector::ONE, &[Vector::X, point]), Error::InvalidVoxel(1));
        }
    }
    for normal in [Vector::ZERO, far, Vector::splat(Scalar::NAN)] {
        fails(Collider::try_half_space(normal), Error::NoDirection);
    }
    fails(Collider::try_segment(Vector::ONE, Vector::ONE), Error::NoLength);
    fails(Collider::try_triangle(Vector::ZERO, Vector::X, Vector::X * 2.0), Error::NoArea);
    fails(Collider::try_convex_hull(vec![]), Error::NoHull);
    fails(Collider::try_convex_hull((0..9).map(|i| Vector::ONE * i as Scalar).collect()), Error::NoHull);
}

#[test]
fn bad_indices_and_nothing_are_errors() {
    let (corners, elements) = simplex();
    let parameters = VhacdParameters::default();
    let decomposed = |elements: Vec<[u32; DIM]>, parameters: &VhacdParameters| {
        Collider::try_convex_decomposition_with_config(corners.clone(), elements, parameters)
    };
    let mut out_of_range = elements.clone();
    out_of_range[1][0] = u32::MAX;
    let mut repeated = elements.clone();
    repeated[0][1] = repeated[0][0];
    for (bad, index) in [(out_of_range, 1), (repeated, 0)] {
        fails(decomposed(bad.clone(), &parameters), Error::InvalidElement(index));
        let voxels = Collider::try_voxelized_convex_decomposition_with_config(&corners, &bad, &parameters);
        assert_eq!(voxels.err(), Some(Error::InvalidElement(index)));
    }
    fails(decomposed(vec![], &parameters), Error::NoElements);
    for concavity in [-1.0, 2.0, Scalar::NAN] {
        let parameters = VhacdParameters { concavity, ..parameters.clone() };
        fails(decomposed(elements.clone(), &parameters), Error::InvalidParameters);
    }
    let parameters0 = VhacdParameters { resolution: 0, ..parameters.clone() };
    fails(decomposed(elements.clone(), &parameters0), Error::InvalidParameters);
    assert!(decomposed(elements, &parameters).is_ok());

    let line = |indices| Collider::try_polyline(vec![Vector::ZERO, Vector::X], indices);
    fails(line(Some(vec![[0, 1], [0, 2]])), Error::InvalidElement(1));
    fails(line(Some(vec![])), Error::NoElements);
    fails(Collider::try_polyline(vec![Vector::X], None), Error::NoElements);
    assert!(line(None).is_ok() && line(Some(vec![[1, 0]])).is_ok());

    fails(Collider::try_voxels(Vector::ONE, &[]), Error::NoVoxels);
    fails(Collider::try_voxels_from_points(Vector::ONE, &[]), Error::NoVoxels);
    fails(Collider::try_voxels(Vector::ONE, &[IVector::ZERO, IVector::MAX]), Error::InvalidVoxel(1));
    fails(Collider::try_voxels(Vector::ONE, &[IVector::MIN]), Error::InvalidVoxel(0));
}

#[test]
fn compounds_of_nothing_and_at_no_pose_are_errors() {
    let ball = || Collider::capsule(0.5, 1.0);
    fails(Collider::try_compound(Vec::<(Position, Rotation, Collider)>::new()), Error::NoParts);
    for at in [Vector::splat(Scalar::NAN), Vector::splat(Scalar::MAX)] {
        let part = (at, Rotation::default(), ball());
        fails(Collider::try_compound(vec![part]), Error::InvalidPose);
    }
    let good = Collider::try_compound(vec![(Vector::X, Rotation::default(), ball())]).expect("a part");
    assert!(tests::close(good.mass(1.0), ball().mass(1.0)));
}

#[test]
fn good_values_make_what_the_constructors_make() {
    let (corners, _) = simplex();
    let pairs = [
        (Collider::try_capsule(0.5, 0.0), Collider::capsule(0.5, 0.0)),
        (
            Collider::try_capsule_endpoints(0.5, Vector::X, Vector::ONE),
            Collider::capsule_endpoints(0.5, Vector::X, Vector::ONE),
        ),
        (Collider::try_segment(Vector::X, Vector::Y), Collider::segment(Vector::X, Vector::Y)),
        (Collider::try_half_space(Vector::X * 1.0e-20), Collider::half_space(Vector::X)),
        (
            Collider::try_convex_hull(corners.clone()),
            Collider::convex_hull(corners).expect("a simplex has a hull"),
        ),
        (
            Collider::try_voxels(Vector::ONE, &[IVector::ZERO]),
            Collider::voxels(Vector::ONE, &[IVector::ZERO]),
        ),
    ];
    for (made, expected) in pairs {
        let made = made.expect("the values are good");
        assert_eq!(format!("{:?}", made.shape()), format!("{:?}", expected.shape()));
    }
}

#[test]
fn a_scale_that_is_none_is_an_error_and_changes_nothing() {
    let mut collider = Collider::capsule(0.5, 1.0);
    collider.try_set_scale(Vector::splat(2.0), 8).expect("a good scale");
    for bad in [0.0, Scalar::NAN, Scalar::INFINITY, 1.0e-9] {
        assert_eq!(collider.try_set_scale(Vector::splat(bad), 8), Err(Error::InvalidScale));
        assert_eq!(collider.scale(), Vector::splat(2.0));
    }
    // Lengths twice as large have 2^n times the volume.
    let volume = Collider::capsule(0.5, 1.0).mass(1.0) * f32::powi(2.0, DIM as i32);
    assert!(tests::close(collider.mass(1.0), volume));
}

#[test]
fn errors_read_as_sentences() {
    let text = Error::InvalidElement(7).to_string();
    assert_eq!(text, "element 7 has corners that do not exist, are the same or cannot be used");
}

#[test]
fn parts_have_the_mass_and_the_places_of_the_whole() {
    let ball = || Collider::capsule(0.5, 1.0);
    let inner = Collider::compound(vec![(Vector::X * 3.0, Rotation::default(), ball())]);
    let whole = Collider::compound(vec![
        (Vector::Y * 4.0, Rotation::default(), inner),
        (Vector::ZERO, Rotation::default(), ball()),
    ]);
    let parts: Vec<_> = whole.parts().collect();
    assert_eq!(parts.len(), 2);
    assert!((parts[0].0.0 - (Vector::X * 3.0 + Vector::Y * 4.0)).length() < 1.0e-5);
    let mass: f32 = parts.iter().map(|(_, _, part)| part.mass(1.0)).sum();
    assert!(tests::close(mass, whole.mass(1.0)));
    // A convex shape is its own part, at its scale.
    let mut scaled = ball();
    scaled.set_scale(Vector::splat(2.0), 8);
    let own: Vec<_> = scaled.parts().collect();
    assert_eq!(own.len(), 1);
    let (position, _, part) = &own[0];
    assert_eq!((position.0, part.scale()), (Vector::ZERO, Vector::ONE));
    assert!(tests::close(part.mass(1.0), scaled.mass(1.0)));
    // Two voxels side by side.
    let cells = [IVector::ZERO, IVector::X];
    let boxes: Vec<_> = Collider::voxels(Vector::ONE, &cells).parts().collect();
    assert_eq!(boxes.len(), 2);
    assert!(((boxes[1].0.0 - boxes[0].0.0).length() - 1.0).abs() < 1.0e-5);
}
