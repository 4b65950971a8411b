//! The mass properties of a polyhedron by exact integrals over tetrahedra.

use super::wide::{Wide, narrow, widen};
use crate::math::{Inertia, Vector};
use crate::shape::MassProperties;

/// Mass properties at 1 kg/m³ of a closed surface of counter-clockwise polygons.
///
/// The solid is the signed sum of the tetrahedra from a point o inside to the triangles of each face.
/// One with corners o, o+a, o+b, o+c has the volume V = a · (b × c) / 6, its centre at o + s/4 with
/// s = a + b + c, and ∫ x xᵀ = V/20 (aaᵀ + bbᵀ + ccᵀ + ssᵀ) about o (Blow and Binstock, "How to find
/// the inertia tensor (or other mass properties) of a 3D solid body represented by a triangle mesh",
/// 2004). With o inside there is no cancellation; sums are in `f64`.
pub(super) fn of_polyhedron(vertices: &[Vector], outlines: &[Vec<u32>]) -> MassProperties {
    let count = vertices.len() as f64;
    let origin = vertices.iter().fold(Wide::ZERO, |sum, v| sum + widen(*v)) * (1.0 / count);
    let at = |i: u32| widen(vertices[i as usize]) - origin;
    let (mut volume, mut moment) = (0.0, Wide::ZERO);
    // Second moments: xx, yy, zz, xy, xz, yz.
    let mut second = [0.0f64; 6];
    for outline in outlines {
        for k in 2..outline.len() {
            let (a, b, c) = (at(outline[0]), at(outline[k - 1]), at(outline[k]));
            let v = a.dot(b.cross(c)) / 6.0;
            let s = a + b + c;
            volume += v;
            moment += s * (v / 4.0);
            for p in [a, b, c, s] {
                let products = [p.x * p.x, p.y * p.y, p.z * p.z, p.x * p.y, p.x * p.z, p.y * p.z];
                for (sum, product) in second.iter_mut().zip(products) {
                    *sum += v / 20.0 * product;
                }
            }
        }
    }
    if !(volume > 0.0) {
        return MassProperties::ZERO;
    }
    let center = moment * (1.0 / volume);
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
    MassProperties { mass: volume as f32, center: narrow(origin + center), inertia }
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
