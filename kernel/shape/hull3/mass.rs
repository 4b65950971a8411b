//! The mass properties of a polyhedron by exact integrals over tetrahedra.

use super::wide::{Wide, narrow, widen};
use crate::math::{Inertia, Vector};
use crate::shape::MassProperties;

/// Mass properties at 1 kg/m³ of a closed surface of counter-clockwise polygons.
///
/// The solid is the signed sum of the tetrahedra from a point o inside to the triangles of each face. A
/// tetrahedron with corners o, o+a, o+b, o+c has the volume V = a · (b × c) / 6, its centre at o + s/4
/// with s = a + b + c, and ∫ x xᵀ = V/20 (aaᵀ + bbᵀ + ccᵀ + ssᵀ) about o (Blow and Binstock, "How to find the
/// inertia tensor (or other mass properties) of a 3D solid body represented by a triangle mesh", 2004). With
/// o inside there is no cancellation; sums are in `f64`.
pub(super) fn of_polyhedron(vertices: &[Vector], outlines: &[Vec<u32>]) -> MassProperties {
    let mut moments = Moments::about(center_of(vertices));
    add_polyhedron(&mut moments, vertices, outlines.iter().map(Vec::as_slice));
    moments.finish()
}

/// The mean of some points.
pub(super) fn center_of(vertices: &[Vector]) -> Wide {
    vertices.iter().fold(Wide::ZERO, |sum, v| sum + widen(*v)) * (1.0 / vertices.len() as f64)
}

/// Adds a polyhedron.
pub(super) fn add_polyhedron<'a>(
    moments: &mut Moments,
    vertices: &[Vector],
    outlines: impl Iterator<Item = &'a [u32]>,
) {
    let origin = moments.origin;
    let at = |i: u32| widen(vertices[i as usize]) - origin;
    for outline in outlines {
        for k in 2..outline.len() {
            let (a, b, c) = (at(outline[0]), at(outline[k - 1]), at(outline[k]));
            let v = a.dot(b.cross(c)) / 6.0;
            let s = a + b + c;
            moments.volume += v;
            moments.first += s * (v / 4.0);
            for p in [a, b, c, s] {
                moments.add_second(p, p, v / 20.0);
            }
        }
    }
}

/// Sums of volume, first and second moments about a point.
pub(super) struct Moments {
    pub origin: Wide,
    pub volume: f64,
    pub first: Wide,
    /// xx, yy, zz, xy, xz, yz.
    second: [f64; 6],
}

impl Moments {
    pub fn about(origin: Wide) -> Self {
        Self { origin, volume: 0.0, first: Wide::ZERO, second: [0.0; 6] }
    }

    /// Adds k/2 (abᵀ + baᵀ) to the second moment.
    pub fn add_second(&mut self, a: Wide, b: Wide, k: f64) {
        let half = |p: f64, q: f64| 0.5 * k * (p + q);
        let products = [
            k * a.x * b.x,
            k * a.y * b.y,
            k * a.z * b.z,
            half(a.x * b.y, a.y * b.x),
            half(a.x * b.z, a.z * b.x),
            half(a.y * b.z, a.z * b.y),
        ];
        for (sum, product) in self.second.iter_mut().zip(products) {
            *sum += product;
        }
    }

    /// The mass properties at 1 kg/m³.
    pub fn finish(&self) -> MassProperties {
        let Self { volume, second, .. } = *self;
        if !(volume > 0.0) {
            return MassProperties::ZERO;
        }
        let center = self.first * (1.0 / volume);
        // To the centre of mass (Steiner's theorem), then from second moments to the inertia tensor.
        let [xx, yy, zz] = [
            second[0] - volume * center.x * center.x,
            second[1] - volume * center.y * center.y,
            second[2] - volume * center.z * center.z,
        ];
        let inertia = Inertia {
            xx: (yy + zz) as f32,
            yy: (xx + zz) as f32,
            zz: (xx + yy) as f32,
            xy: -(second[3] - volume * center.x * center.y) as f32,
            xz: -(second[4] - volume * center.x * center.z) as f32,
            yz: -(second[5] - volume * center.y * center.z) as f32,
        };
        MassProperties { mass: volume as f32, center: narrow(self.origin + center), inertia }
    }
}

/// The signed volume of a closed surface of polygons, in m³.
pub(super) fn signed_volume(vertices: &[Vector], outlines: &[Vec<u32>]) -> f64 {
    let count = vertices.len() as f64;
    let origin = vertices.iter().fold(Wide::ZERO, |sum, v| sum + widen(*v)) * (1.0 / count);
    let at = |i: u32| widen(vertices[i as usize]) - origin;
    let of_outline = |o: &Vec<u32>| -> f64 {
        (2..o.len()).map(|k| at(o[0]).dot(at(o[k - 1]).cross(at(o[k]))) / 6.0).sum()
    };
    outlines.iter().map(of_outline).sum()
}
