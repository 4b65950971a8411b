//! Inverse inertia in world axes, including needles, whose moments differ by more than `f32` resolves.

use super::{Lane, Rot, SymTensor, Vector};

/// The largest ratio of principal moments of inertia that `f32` resolves in world axes: the ratio of a box
/// 140 times as long as thick. With larger ratios rounding creates energy.
pub(crate) const MAX_RATIO: f32 = 1.0e4;

/// The relative rounding of an entry.
const ROUNDING: f32 = 2.0e-7;

impl SymTensor {
    /// The tensor in world axes of a body turned by `rotation`: R I R⁻¹.
    ///
    /// A principal value over 10,000 times the others is reduced to that ratio. Its rounding would otherwise
    /// exceed the others: a pole a thousand times as long as thick would turn across its axis as easily as
    /// about it.
    #[inline]
    pub fn rotated(self, rotation: Rot) -> Self {
        self.blunt().turned(rotation)
    }

    /// The tensor that [`rotated`](Self::rotated) turns.
    #[inline]
    pub(crate) fn blunt(self) -> Self {
        self.blunted(MAX_RATIO)
    }

    /// The ratio of one principal value to the mean of the other two, if it is large. Infinite or negative if
    /// the other two are lost in rounding.
    ///
    /// With the trace t = λ1 + λ2 + λ3 and the second invariant s = λ1 λ2 + λ1 λ3 + λ2 λ3 it is 2 t² / s.
    #[inline]
    pub(crate) fn needle_ratio(self) -> f32 {
        let Self { xx, yy, zz, xy, xz, yz } = self.scaled(1.0 / (self.xx + self.yy + self.zz));
        2.0 / ((xx * yy - xy * xy) + (xx * zz - xz * xz) + (yy * zz - yz * yz))
    }

    /// The principal axis of a value much larger than the others, by the power method.
    pub(crate) fn thin_axis(self) -> Vector {
        let unit = self.scaled(1.0 / (self.xx + self.yy + self.zz));
        let (xx, yy, zz) = (unit.xx, unit.yy, unit.zz);
        let start = if xx >= yy && xx >= zz {
            Vector::X
        } else if yy >= zz {
            Vector::Y
        } else {
            Vector::Z
        };
        let axis = (0..4).fold(start, |v, _| unit.apply(v));
        axis * (1.0 / axis.length())
    }

    /// The tensor with its largest principal value reduced to `ratio` times the others.
    #[inline]
    pub(crate) fn blunted(self, ratio: f32) -> Self {
        let actual = self.needle_ratio();
        if actual > 0.0 && actual <= ratio {
            return self;
        }
        self.blunted_from(actual, ratio)
    }

    #[cold]
    fn blunted_from(self, actual: f32, ratio: f32) -> Self {
        let trace = self.xx + self.yy + self.zz;
        if trace <= 0.0 {
            // No valid body has such a tensor. The body does not turn.
            return Self::ZERO;
        }
        if !trace.is_finite() {
            return self;
        }
        // The entries of a diagonal tensor are its principal values. Values of 0 are locked axes.
        let is_diagonal = self.xy == 0.0 && self.xz == 0.0 && self.yz == 0.0;
        if is_diagonal && !actual.is_finite() {
            return self;
        }
        let resolved = is_diagonal || actual > 0.0 && actual * ROUNDING < 1.0;
        let keep = if resolved { ratio / actual } else { ratio * ROUNDING };
        let cut = self.cut(self.thin_axis(), super::min(keep, 1.0));
        // The other values may be negative if they are lost in rounding.
        let lift = if resolved { 0.0 } else { ROUNDING * trace };
        Self { xx: cut.xx + lift, yy: cut.yy + lift, zz: cut.zz + lift, ..cut }
    }

    /// The tensor with its value along a unit vector reduced to the share `keep`: S − (1 − k) (S a)(S a)ᵀ /
    /// aᵀ S a. Locked axes stay locked.
    pub(crate) fn cut(self, axis: Vector, keep: f32) -> Self {
        let column = self.apply(axis);
        let along = axis.dot(column);
        if !(along > 0.0) {
            return self;
        }
        let (r, c) = (column * ((1.0 - keep) / along), column);
        Self {
            xx: self.xx - r.x * c.x,
            yy: self.yy - r.y * c.y,
            zz: self.zz - r.z * c.z,
            xy: self.xy - r.x * c.y,
            xz: self.xz - r.x * c.z,
            yz: self.yz - r.y * c.z,
        }
    }
}

impl<N: Lane> SymTensor<N> {
    /// v I.
    #[inline(always)]
    fn row(self, v: Vector<N>) -> Vector<N> {
        Vector {
            x: v.x * self.xx + v.y * self.xy + v.z * self.xz,
            y: v.x * self.xy + v.y * self.yy + v.z * self.yz,
            z: v.x * self.xz + v.y * self.yz + v.z * self.zz,
        }
    }

    /// R I R⁻¹.
    #[inline(always)]
    pub(crate) fn turned(self, rotation: Rot<N>) -> Self {
        let [cx, cy, cz] = rotation.axes();
        // Rows of R are (cx.x, cy.x, cz.x), …. First T = R I, then T Rᵀ, which has six different entries.
        let r = [
            Vector { x: cx.x, y: cy.x, z: cz.x },
            Vector { x: cx.y, y: cy.y, z: cz.y },
            Vector { x: cx.z, y: cy.z, z: cz.z },
        ];
        let t = [self.row(r[0]), self.row(r[1]), self.row(r[2])];
        Self {
            xx: t[0].dot(r[0]),
            yy: t[1].dot(r[1]),
            zz: t[2].dot(r[2]),
            xy: t[0].dot(r[1]),
            xz: t[0].dot(r[2]),
            yz: t[1].dot(r[2]),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_needle_is_blunted_about_its_axis_only() {
        let turn = Rot::from_axis_angle(Vector::ONE * (1.0 / Vector::ONE.length()), 0.7);
        for thin in [3.0e4f32, 1.0e6, 1.0e9] {
            let needle = SymTensor::from_diagonal(Vector { x: 1.0, y: thin, z: 1.0 });
            let (world, axes) = (needle.rotated(turn), turn.axes());
            let along = axes[1].dot(world.apply(axes[1]));
            assert!((along / MAX_RATIO - 1.0).abs() < 0.1, "{thin} becomes {along}");
            for axis in [axes[0], axes[2]] {
                let across = axis.dot(world.apply(axis));
                assert!((across - 1.0).abs() < 0.02, "{thin}: across it is {across}");
            }
        }
    }

    #[test]
    fn what_is_no_needle_stays_as_it_is() {
        for diagonal in [Vector::ONE, Vector { x: 1.0, y: 1.0, z: 0.5 }, Vector { x: 9.0e3, y: 1.0, z: 1.0 }]
        {
            let tensor = SymTensor::from_diagonal(diagonal);
            assert_eq!(tensor.rotated(Rot::IDENTITY), tensor);
        }
    }
}
