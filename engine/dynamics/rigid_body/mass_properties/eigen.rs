//! Principal axes of a symmetric 3 × 3 matrix, with the same arithmetic on every machine.
//!
//! Cyclic Jacobi rotations (Golub & Van Loan, *Matrix Computations*, §8.5) in `f64`. They use only square
//! roots and the four operations, while closed forms need an arc cosine. They are accurate for repeated
//! eigenvalues and for bodies of any size, because there are no absolute tolerances.

use bevy_math::{DMat3, DVec3};
use glam_matrix_extras::SymmetricDMat3;

/// Maximum number of sweeps over the three off-diagonal entries. Convergence is quadratic; five are usual.
const MAX_SWEEPS: usize = 16;

/// The eigenvalues of a finite matrix, and the rotation whose columns are their axes. A diagonal matrix gives
/// its diagonal and the identity.
pub(super) fn principal_axes(matrix: SymmetricDMat3) -> (DVec3, DMat3) {
    let mut a = matrix.to_cols_array_2d();
    let mut v = DMat3::IDENTITY.to_cols_array_2d();
    let size = a.iter().flatten().fold(0.0_f64, |largest, entry| largest.max(entry.abs()));
    for _ in 0..MAX_SWEEPS {
        let off = a[0][1].abs().max(a[0][2].abs()).max(a[1][2].abs());
        if off <= size * 1e-17 || off.is_nan() {
            break;
        }
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            rotate(&mut a, &mut v, p, q);
        }
    }
    (DVec3::new(a[0][0], a[1][1], a[2][2]), DMat3::from_cols_array_2d(&v))
}

/// A ← Jᵀ A J and V ← V J, with J the rotation in the plane of axes p and q that makes A[p][q] zero: its
/// tangent t is the smaller root of t² + 2 θ t − 1 = 0, θ = (A[q][q] − A[p][p]) / (2 A[p][q]).
fn rotate(a: &mut [[f64; 3]; 3], v: &mut [[f64; 3]; 3], p: usize, q: usize) {
    if a[p][q] == 0.0 {
        return;
    }
    let theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
    let t = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
    let c = 1.0 / (t * t + 1.0).sqrt();
    let s = t * c;
    let shift = t * a[p][q];
    a[p][p] -= shift;
    a[q][q] += shift;
    a[p][q] = 0.0;
    a[q][p] = 0.0;
    let r = 3 - p - q;
    let (rp, rq) = (a[r][p], a[r][q]);
    a[r][p] = c * rp - s * rq;
    a[r][q] = s * rp + c * rq;
    a[p][r] = a[r][p];
    a[q][r] = a[r][q];
    // V is stored by columns.
    let (vp, vq) = (v[p], v[q]);
    v[p] = core::array::from_fn(|row| c * vp[row] - s * vq[row]);
    v[q] = core::array::from_fn(|row| s * vp[row] + c * vq[row]);
}

/// R diag(values) Rᵀ for a rotation matrix R.
pub(super) fn from_principal_axes(values: DVec3, axes: DMat3) -> SymmetricDMat3 {
    let (x, y, z) = (axes.x_axis, axes.y_axis, axes.z_axis);
    let (kx, ky, kz) = (x * values.x, y * values.y, z * values.z);
    SymmetricDMat3::new(
        kx.x * x.x + ky.x * y.x + kz.x * z.x,
        kx.x * x.y + ky.x * y.y + kz.x * z.y,
        kx.x * x.z + ky.x * y.z + kz.x * z.z,
        kx.y * x.y + ky.y * y.y + kz.y * z.y,
        kx.y * x.z + ky.y * y.z + kz.y * z.z,
        kx.z * x.z + ky.z * y.z + kz.z * z.z,
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_diagonal_matrix_is_its_own_answer() {
        let values = DVec3::new(3.0, 1.0, 2.0);
        assert_eq!(principal_axes(SymmetricDMat3::from_diagonal(values)), (values, DMat3::IDENTITY));
        assert_eq!(principal_axes(SymmetricDMat3::ZERO).0, DVec3::ZERO);
    }

    proptest! {
        #[test]
        fn the_axes_are_orthonormal_and_give_the_matrix_back(
            entries in prop::array::uniform6(-1.0..1.0_f64),
            exponent in -12..12_i32,
        ) {
            let size = 10.0_f64.powi(exponent);
            let [a, b, c, d, e, f] = entries.map(|entry| entry * size);
            let matrix = SymmetricDMat3::new(a, b, c, d, e, f);
            let (values, axes) = principal_axes(matrix);
            prop_assert!((axes * axes.transpose()).abs_diff_eq(DMat3::IDENTITY, 1e-13));
            prop_assert!((axes.determinant() - 1.0).abs() < 1e-13);
            let back = from_principal_axes(values, axes).to_mat3();
            prop_assert!(back.abs_diff_eq(matrix.to_mat3(), 1e-13 * size));
        }
    }
}
