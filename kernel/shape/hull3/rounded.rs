//! The effect of a radius around a polyhedron on its mass and on ray hits.
//!
//! Around the polyhedron are a prism on each face, a wedge of a cylinder along each edge, and a sector of a
//! ball at each vertex.

use super::mass::{Moments, add_polyhedron, center_of};
use super::wide::{Wide, widen};
use super::{Face, Hull};
use crate::math::{Vector, atan2, max, min, sin_cos};
use crate::shape::primitives::{Stretch, checked_length, direction_or, hit_of_stretch};
use crate::shape::{Capsule, MassProperties, RayHit, ShapeError};
use core::f64::consts::TAU;

/// The sector of a ball at a vertex: the directions between the normals of its faces.
#[derive(Clone, Copy)]
struct Sector {
    /// Ω, the solid angle of the sector: a full turn less the angles of the faces at the vertex (Descartes).
    angle: f64,
    /// ∫ n dΩ.
    first: Wide,
}

/// The mass properties at 1 kg/m³.
///
/// By Stokes' theorem on the unit sphere, with ν the outward direction across each arc that bounds Ω:
/// ∫ n dΩ = −½ Σ φ ν for arcs of the angles φ, and 3 ∫ n nᵀ dΩ = Ω 1 − Σ (∫ n ds) νᵀ. The arcs belong to the
/// edges of the vertex, and ν points along these edges.
fn mass_of(hull: &Hull) -> MassProperties {
    let r = f64::from(hull.radius);
    let mut moments = Moments::about(center_of(&hull.vertices));
    let origin = moments.origin;
    let at = |i: u32| widen(hull.vertices[i as usize]) - origin;
    add_polyhedron(&mut moments, &hull.vertices, hull.faces.iter().map(|f| hull.outline(f)));
    let mut sectors = vec![Sector { angle: TAU, first: Wide::ZERO }; hull.vertices.len()];
    for face in &hull.faces {
        let outline = hull.outline(face);
        add_prism(&mut moments, outline, widen(face.normal), at, r);
        for (k, i) in outline.iter().enumerate() {
            let corner = at(*i);
            let before = at(outline[(k + outline.len() - 1) % outline.len()]) - corner;
            let after = at(outline[(k + 1) % outline.len()]) - corner;
            sectors[*i as usize].angle -= atan2(before.cross(after).length(), before.dot(after));
        }
    }
    for edge in &hull.edges {
        let [p, q] = [edge.tail, edge.head].map(at);
        let [left, right] = [edge.left, edge.right].map(|f| widen(hull.faces[f as usize].normal));
        let length = (q - p).length();
        if !(length > 0.0) {
            continue;
        }
        let along = (q - p) * (1.0 / length);
        let angle = atan2(left.cross(right).length(), left.dot(right));
        // The direction midway between the normals; for a flat hull it is across the edge.
        let between = left + right;
        let middle =
            if between.length() > 1.0e-6 { between * (1.0 / between.length()) } else { along.cross(left) };
        let sum = middle * (2.0 * sin_cos(0.5 * angle).0);
        add_wedge(&mut moments, [p, q], [middle, along.cross(middle)], angle, r);
        for (vertex, outward) in [(edge.tail, along), (edge.head, -along)] {
            sectors[vertex as usize].first -= outward * (0.5 * angle);
            moments.add_second(sum, outward, -r * r * r * r * r / 15.0);
        }
    }
    for (sector, vertex) in sectors.iter().zip(0..) {
        let (v, r2) = (at(vertex), r * r);
        let volume = sector.angle * r2 * r / 3.0;
        moments.volume += volume;
        moments.first += v * volume + sector.first * (r2 * r2 / 4.0);
        moments.add_second(v, v, volume);
        moments.add_second(v, sector.first, r2 * r2 / 2.0);
        add_isotropic(&mut moments, sector.angle * r2 * r2 * r / 15.0);
    }
    moments.finish()
}

/// Adds k times the unit tensor to the second moment.
fn add_isotropic(moments: &mut Moments, k: f64) {
    for axis in Vector::AXES.map(widen) {
        moments.add_second(axis, axis, k);
    }
}

/// Adds the prism above a face, up to the height `r`.
fn add_prism(moments: &mut Moments, outline: &[u32], normal: Wide, at: impl Fn(u32) -> Wide, r: f64) {
    for k in 2..outline.len() {
        let (a, b, c) = (at(outline[0]), at(outline[k - 1]), at(outline[k]));
        let area = 0.5 * normal.dot((b - a).cross(c - a));
        let (s, volume) = (a + b + c, area * r);
        moments.volume += volume;
        moments.first += (s * (1.0 / 3.0) + normal * (0.5 * r)) * volume;
        for p in [a, b, c, s] {
            moments.add_second(p, p, volume / 12.0);
        }
        moments.add_second(s, normal, volume * r / 3.0);
        moments.add_second(normal, normal, volume * r * r / 3.0);
    }
}

/// Adds the wedge of a cylinder along an edge. `across` contains the directions to the middle of its angle,
/// and at right angles to it.
fn add_wedge(moments: &mut Moments, [p, q]: [Wide; 2], across: [Wide; 2], angle: f64, r: f64) {
    let (middle, along) = ((p + q) * 0.5, q - p);
    let (length, sin_half) = (along.length(), sin_cos(0.5 * angle).0);
    let volume = 0.5 * length * angle * r * r;
    // ∫ n dφ, and the two parts of ∫ n nᵀ dφ.
    let first = across[0] * (2.0 * sin_half * length * r * r * r / 3.0);
    let sine = 0.5 * sin_cos(angle).0;
    moments.volume += volume;
    moments.first += middle * volume + first;
    moments.add_second(middle, middle, volume);
    moments.add_second(along, along, volume / 12.0);
    moments.add_second(middle, first, 2.0);
    let k = length * r * r * r * r / 4.0;
    moments.add_second(across[0], across[0], k * (0.5 * angle + sine));
    moments.add_second(across[1], across[1], k * (0.5 * angle - sine));
}

impl Hull {
    /// All points within `radius` metres of this hull. `radius` replaces the hull's own radius.
    ///
    /// # Errors
    ///
    /// `NotFinite` or `Negative` for a bad radius.
    pub fn rounded(mut self, radius: f32) -> Result<Self, ShapeError> {
        let old = core::mem::replace(&mut self.radius, checked_length(radius)?);
        if old != self.radius {
            self.unit_mass = mass_of(&self);
        }
        Ok(self)
    }

    /// The hull is the union of its polyhedron, the prisms on its faces and the capsules around its edges.
    /// All of these and their union are convex, so the range inside ends at the outermost ends of their
    /// ranges.
    pub(super) fn cast_ray_rounded(
        &self,
        origin: Vector,
        line: Vector,
        max_distance: f32,
        solid: bool,
    ) -> Option<RayHit> {
        let mut range: Option<Stretch> = None;
        let mut normals = [Vector::ZERO; 2];
        let mut add = |(enter, exit): Stretch, normal_at: &dyn Fn(f32) -> Vector| {
            let (low, high) = range.unwrap_or((f32::INFINITY, f32::NEG_INFINITY));
            if enter < low {
                normals[0] = normal_at(enter);
            }
            if exit > high {
                normals[1] = normal_at(exit);
            }
            range = Some((min(enter, low), max(exit, high)));
        };
        for edge in &self.edges {
            let [a, b] = [edge.tail, edge.head].map(|i| self.vertices[i as usize]);
            let capsule = Capsule { a, b, radius: self.radius };
            if let Some(stretch) = capsule.stretch(origin, line) {
                add(stretch, &|t| capsule.normal_at(origin + line * t, -line));
            }
        }
        for face in &self.faces {
            let slope = face.normal.dot(line);
            let t = (face.offset + self.radius - face.normal.dot(origin)) / slope;
            if slope != 0.0 && self.is_over(face, origin + line * t) {
                add((t, t), &|_| face.normal);
            }
        }
        hit_of_stretch(range?, max_distance, solid, |entering, _| {
            direction_or(normals[usize::from(!entering)], -line)
        })
    }

    /// Whether a point is over a face, as seen along its normal.
    fn is_over(&self, face: &Face, point: Vector) -> bool {
        let outline = self.outline(face);
        let mut tail = self.vertices[outline[outline.len() - 1] as usize];
        outline.iter().all(|i| {
            let head = self.vertices[*i as usize];
            let is_inside = (head - tail).cross(face.normal).dot(point - tail) <= 0.0;
            tail = head;
            is_inside
        })
    }
}
