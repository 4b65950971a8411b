//! Symmetric tensors: moments of inertia and their inverses.

use super::{Angular, AxisLocks, Lane, Num, SymTensor, Vector};

impl<N: Num> SymTensor<N> {
    /// All entries 0.
    pub const ZERO: Self =
        Self { xx: N::ZERO, yy: N::ZERO, zz: N::ZERO, xy: N::ZERO, xz: N::ZERO, yz: N::ZERO };

    /// Every entry times a factor.
    #[inline(always)]
    pub fn scaled(self, factor: N) -> Self {
        Self {
            xx: self.xx * factor,
            yy: self.yy * factor,
            zz: self.zz * factor,
            xy: self.xy * factor,
            xz: self.xz * factor,
            yz: self.yz * factor,
        }
    }

    /// The product with a vector. For an [`InvInertia`](super::InvInertia) it is the change of angular
    /// velocity by an angular impulse.
    #[inline(always)]
    pub fn apply(self, v: Angular<N>) -> Angular<N> {
        Vector {
            x: self.xx * v.x + self.xy * v.y + self.xz * v.z,
            y: self.xy * v.x + self.yy * v.y + self.yz * v.z,
            z: self.xz * v.x + self.yz * v.y + self.zz * v.z,
        }
    }
}

impl<N: Lane> SymTensor<N> {
    /// `a` where the mask is set, else `b`.
    #[inline(always)]
    pub(crate) fn select(mask: N::Mask, a: Self, b: Self) -> Self {
        Self {
            xx: N::select(mask, a.xx, b.xx),
            yy: N::select(mask, a.yy, b.yy),
            zz: N::select(mask, a.zz, b.zz),
            xy: N::select(mask, a.xy, b.xy),
            xz: N::select(mask, a.xz, b.xz),
            yz: N::select(mask, a.yz, b.yz),
        }
    }

    /// Sum of the eigenvalues.
    #[inline(always)]
    pub fn trace(self) -> N {
        self.xx + self.yy + self.zz
    }

    /// Reads lane `i`.
    #[inline(always)]
    pub fn get(&self, i: usize) -> SymTensor {
        SymTensor {
            xx: self.xx.get(i),
            yy: self.yy.get(i),
            zz: self.zz.get(i),
            xy: self.xy.get(i),
            xz: self.xz.get(i),
            yz: self.yz.get(i),
        }
    }

    /// Writes lane `i`.
    #[inline(always)]
    pub fn set(&mut self, i: usize, v: SymTensor) {
        self.xx.set(i, v.xx);
        self.yy.set(i, v.yy);
        self.zz.set(i, v.zz);
        self.xy.set(i, v.xy);
        self.xz.set(i, v.xz);
        self.yz.set(i, v.yz);
    }
}

impl SymTensor {
    /// A diagonal tensor.
    #[inline]
    pub const fn from_diagonal(v: Vector) -> Self {
        Self { xx: v.x, yy: v.y, zz: v.z, xy: 0.0, xz: 0.0, yz: 0.0 }
    }

    /// The inverse of this symmetric matrix; zero if it is singular, or if the inverse is not finite.
    ///
    /// Computed in `f64`: the determinant is a product of three entries, which in `f32` underflows for bodies
    /// of millimetres.
    ///
    /// In axes other than the principal axes, the smallest moment of a needle may be less than the rounding
    /// of the others, or negative. It is then raised to about that rounding.
    pub fn inverse(self) -> Self {
        let [mut xx, mut yy, mut zz] = [self.xx, self.yy, self.zz].map(f64::from);
        let [xy, xz, yz] = [self.xy, self.xz, self.yz].map(f64::from);
        let askew = xy != 0.0 || xz != 0.0 || yz != 0.0;
        let trace = xx + yy + zz;
        let minors = (xx * yy - xy * xy) + (xx * zz - xz * xz) + (yy * zz - yz * yz);
        // For moments (e, 1, 1) the determinant is e / 2 times the product of trace and minors.
        let determinant = xx * (yy * zz - yz * yz) + xy * (xz * yz - xy * zz) + xz * (xy * yz - xz * yy);
        if askew && minors > 1.0e-3 * trace * trace && determinant <= 1.0e-7 * trace * minors {
            let lift = 2.0e-7 * trace;
            (xx, yy, zz) = (xx + lift, yy + lift, zz + lift);
        }
        let (a, b, c) = (yy * zz - yz * yz, xz * yz - xy * zz, xy * yz - xz * yy);
        let determinant = xx * a + xy * b + xz * c;
        let k = 1.0 / determinant;
        let inverse = Self {
            xx: (a * k) as f32,
            yy: ((xx * zz - xz * xz) * k) as f32,
            zz: ((xx * yy - xy * xy) * k) as f32,
            xy: (b * k) as f32,
            xz: (c * k) as f32,
            yz: ((xy * xz - xx * yz) * k) as f32,
        };
        // An infinite or NaN entry makes the sum NaN.
        let Self { xx, yy, zz, xy, xz, yz } = inverse.scaled(0.0);
        if xx + yy + zz + xy + xz + yz == 0.0 { inverse } else { Self::ZERO }
    }

    /// The inverse inertia, in world axes, of a body that does not turn about the axes in `locks`.
    ///
    /// A locked axis has an infinite moment of inertia. In the inverse this is a rank-one downdate per locked
    /// axis: I⁻¹ − (I⁻¹ e)(I⁻¹ e)ᵀ / (eᵀ I⁻¹ e).
    ///
    /// Meanwhile entries are scaled by a power of two near the largest entry, which rounds nothing: squares
    /// of the entries of tiny bodies would overflow.
    pub fn locked(self, locks: AxisLocks) -> Self {
        let size = Vector { x: self.xx, y: self.yy, z: self.zz }.max_element();
        let scale = power_of_two_of(size);
        let mut m = self.scaled(1.0 / scale);
        for (bit, axis) in [(0b100, Vector::X), (0b010, Vector::Y), (0b001, Vector::Z)] {
            if locks.0 & bit != 0 {
                let column = m.apply(axis);
                let pivot = axis.dot(column);
                if pivot > 0.0 {
                    m.xx -= column.x * column.x / pivot;
                    m.yy -= column.y * column.y / pivot;
                    m.zz -= column.z * column.z / pivot;
                    m.xy -= column.x * column.y / pivot;
                    m.xz -= column.x * column.z / pivot;
                    m.yz -= column.y * column.z / pivot;
                }
            }
        }
        // Entries of locked axes are exactly zero, without the rounding.
        let f = locks.rotation_factors();
        Self {
            xx: m.xx * f.x,
            yy: m.yy * f.y,
            zz: m.zz * f.z,
            xy: m.xy * f.x * f.y,
            xz: m.xz * f.x * f.z,
            yz: m.yz * f.y * f.z,
        }
        .scaled(scale)
    }
}

/// The power of two with the exponent of a number, within the range whose inverses are normal numbers.
fn power_of_two_of(size: f32) -> f32 {
    let exponent = (size.to_bits() >> 23 & 0xff).clamp(1, 253);
    f32::from_bits(exponent << 23)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Regression: the inertia of characters of a tenth of a millimetre was NaN.
    #[test]
    fn issue_locks_of_tiny_bodies_were_not_finite() {
        let tensor = SymTensor { xx: 3.0, yy: 2.0, zz: 1.5, xy: 0.2, xz: -0.3, yz: 0.1 };
        let huge = (1u64 << 62) as f32;
        for locks in 0..8 {
            let locked = tensor.locked(AxisLocks(locks));
            assert_eq!(
                tensor.scaled(huge * 32.0).locked(AxisLocks(locks)),
                locked.scaled(huge * 32.0),
                "{locks}"
            );
            assert_eq!(
                tensor.scaled(1.0 / huge).locked(AxisLocks(locks)),
                locked.scaled(1.0 / huge),
                "{locks}"
            );
        }
    }
}
