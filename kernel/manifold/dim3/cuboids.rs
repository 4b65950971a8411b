//! Two boxes, the most frequent pair, with a separating-axis test and clipping of its own.
//!
//! Fifteen axes (Gottschalk, Lin and Manocha, "OBBTree", 1996): three face normals each, nine products of
//! edges. The axis is selected as in [`axis`](super::axis).

use super::axis::{self, Axis, EDGES, EdgeAxis, FACE_A, FACE_B, FaceAxis, Pair as _, Sizes};
use super::clip::Patch;
use super::convex;
use super::view::{MatrixPose, Small};
use crate::manifold::{FeatureCache, LocalManifold, PairInput};
use crate::math::{F32x4, Lane, Num, Vector, clamp, max, min};
use crate::shape::Cuboid;
use crate::tuning::manifold::{MARGIN, PARALLEL};

/// The two axes that follow each axis, cyclically.
const NEXT: [usize; 3] = [1, 2, 0];

/// Two boxes and their relative pose.
struct Pair<'a> {
    half_a: Vector,
    half_b: Vector,
    frame: MatrixPose,
    /// The centre of B in A's frame, and minus the centre of A in B's frame.
    offset: [Vector; 2],
    input: PairInput<'a>,
    sizes: Sizes,
}

/// The contact of two boxes; see the module.
pub(in crate::manifold) fn collide(a: &Cuboid, b: &Cuboid, input: PairInput, out: &mut LocalManifold) {
    let (half_a, half_b) = (a.half, b.half);
    let frame = MatrixPose::new(input.pose);
    let offset = [frame.position, frame.direction_in(frame.position)];
    let sizes = Sizes::new(input.prediction, 0.0, [half_a.max_element(), half_b.max_element()]);
    Pair { half_a, half_b, frame, offset, input, sizes }.collide(input.cache, out);
}

/// The face with the largest of the separations along the three axes.
#[inline(always)]
fn largest_of(separations: Vector, of_b: bool) -> FaceAxis {
    let v = separations.to_array();
    let i = usize::from(v[1] > v[0]);
    let face = if v[2] > v[i] { 2 } else { i };
    FaceAxis { face, of_b, separation: v[face], lowest: 0 }
}

impl axis::Pair for Pair<'_> {
    #[inline(always)]
    fn sizes(&self) -> &Sizes {
        &self.sizes
    }

    #[inline(always)]
    fn cached(&self, cache: FeatureCache) -> Option<Axis> {
        let (i, j) = (cache.a as usize, cache.b as usize);
        if i > 2 || j > 2 {
            return None;
        }
        match cache.kind {
            FACE_A => {
                let along = |k: usize| self.frame.axes[k].to_array()[i].abs();
                let (x, y, z) = (along(0), along(1), along(2));
                let reach = x * self.half_b.x + y * self.half_b.y + z * self.half_b.z;
                let separation = self.offset[0].to_array()[i].abs() - self.half_a.to_array()[i] - reach;
                Some(Axis::Face(FaceAxis { face: i, of_b: false, separation, lowest: 0 }))
            }
            FACE_B => {
                let reach = self.frame.axes[j].abs().dot(self.half_a);
                let separation = self.offset[1].to_array()[j].abs() - self.half_b.to_array()[j] - reach;
                Some(Axis::Face(FaceAxis { face: j, of_b: true, separation, lowest: 0 }))
            }
            EDGES => {
                let (value, _, square) = self.edges(i, j);
                let separation = value / square.sqrt();
                (square > PARALLEL * PARALLEL).then_some(Axis::Edges(EdgeAxis {
                    a: i,
                    b: j,
                    normal: Vector::ZERO,
                    separation,
                }))
            }
            _ => None,
        }
    }

    #[inline(always)]
    fn best_face(&self, of_b: bool) -> FaceAxis {
        largest_of(if of_b { self.faces_of_b() } else { self.faces_of_a() }, of_b)
    }

    /// The normal is not computed.
    #[inline(always)]
    fn best_edges(&self, _: &FaceAxis, _: &FaceAxis, known: f32) -> Option<EdgeAxis> {
        // Row i of the rotation: the components of B's axes along axis i of A.
        let [x, y, z] = self.frame.axes;
        let rows = [[x.x, y.x, z.x], [x.y, y.y, z.y], [x.z, y.z, z.z]];
        let lanes = |r: [f32; 3]| F32x4::new([r[0], r[1], r[2], 0.0]);
        let turned = |r: [f32; 3], k: usize| absolute(lanes([r[k % 3], r[(k + 1) % 3], r[(k + 2) % 3]]));
        let (signed, sizes) = (rows.map(lanes), rows.map(|r| turned(r, 0)));
        let (t, ha, hb) = (self.offset[0].to_array(), self.half_a.to_array(), self.half_b.to_array());
        let of_b = [lanes([hb[1], hb[2], hb[0]]), lanes([hb[2], hb[0], hb[1]])];
        let (bar, parallel) = (F32x4::splat(min(known, 0.0)), F32x4::splat(PARALLEL * PARALLEL));
        let axis = |i: usize| {
            let (i1, i2) = (NEXT[i], NEXT[NEXT[i]]);
            let distance = F32x4::splat(t[i2]) * signed[i1] - F32x4::splat(t[i1]) * signed[i2];
            let of_a = F32x4::splat(ha[i1]) * sizes[i2] + F32x4::splat(ha[i2]) * sizes[i1];
            let of_b = of_b[0] * turned(rows[i], 2) + of_b[1] * turned(rows[i], 1);
            let square = signed[i1] * signed[i1] + signed[i2] * signed[i2];
            let value = absolute(distance) - of_a - of_b;
            // Dividing a negative value by a length below 1 lowers it, so most pairs end here without
            // a square root.
            (value, square, F32x4::and(bar.lt(value), parallel.lt(square)))
        };
        let axes = [axis(0), axis(1), axis(2)];
        if !F32x4::any(F32x4::or(F32x4::or(axes[0].2, axes[1].2), axes[2].2)) {
            return None;
        }
        let (mut found, mut best) = (None, known);
        for (i, (value, square, open)) in axes.into_iter().enumerate() {
            let none = F32x4::splat(f32::NEG_INFINITY);
            let separations = F32x4::select(open, value / square.sqrt(), none);
            for j in 0..3 {
                let separation = separations.get(j);
                if separation > best {
                    best = separation;
                    found = Some(EdgeAxis { a: i, b: j, normal: Vector::ZERO, separation });
                }
            }
        }
        found
    }

    /// Clips the incident face of one box against the reference face on `axis` of the other box, which is A
    /// unless `of_b`.
    ///
    /// Coordinates are permuted so that the axis comes first. Axes and faces are looked up in tables, since
    /// branches on them would be mispredicted.
    fn build_face(&self, face: &FaceAxis, out: &mut LocalManifold) -> bool {
        let &FaceAxis { face: axis, of_b, separation, .. } = face;
        let [x, y, z] = self.frame.axes;
        // The axes and centre of the other box in the frame of the reference box, and the axes and centre of
        // the reference box in A's frame.
        let (axes, position, this, other, columns, origin) = if of_b {
            let axes = [[x.x, y.x, z.x], [x.y, y.y, z.y], [x.z, y.z, z.z]];
            (axes, -self.offset[1], self.half_b, self.half_a, self.frame.axes, self.frame.position)
        } else {
            let axes = [x.to_array(), y.to_array(), z.to_array()];
            (axes, self.offset[0], self.half_a, self.half_b, Vector::AXES, Vector::ZERO)
        };
        let (i0, i1, i2) = (axis, NEXT[axis], NEXT[NEXT[axis]]);
        let (position, half) = (position.to_array(), this.to_array());
        let side = if position[i0] < 0.0 { -1.0 } else { 1.0 };
        // The axis of the other box across its incident face, and the two along it.
        let [sx, sy, sz] = [axes[0][i0].abs(), axes[1][i0].abs(), axes[2][i0].abs()];
        let incident = if sy > sx { 1 } else { 0 };
        let incident = if sz > max(sx, sy) { 2 } else { incident };
        let (across, along) = (incident, [NEXT[incident], NEXT[NEXT[incident]]]);
        let other = other.to_array();
        let away = if axes[across][i0] * side > 0.0 { -1.0 } else { 1.0 };
        // Coordinates across the reference face, and the height over it.
        let local = |j: usize, k: f32| {
            let v = &axes[j];
            Vector { x: v[i1] * k, y: v[i2] * k, z: v[i0] * (k * side) }
        };
        let center = Vector { x: position[i1], y: position[i2], z: position[i0] * side - half[i0] };
        let quad = Quad {
            center: center + local(across, away * other[across]),
            p: local(along[0], other[along[0]]),
            q: local(along[1], other[along[1]]),
        };
        let margin = MARGIN * self.sizes.smaller;
        let clipped = quad.clip(half[i1] + margin, half[i2] + margin, self.sizes.prediction);

        out.count = 0;
        out.normal = columns[i0] * if of_b { -side } else { side };
        // The reference face by its axis and side, and the face of the other box.
        let face = ((axis | usize::from(of_b) << 2) * 2 + usize::from(side > 0.0)) as u32;
        let base = face << 8 | ((incident * 2 + usize::from(away > 0.0)) << 5) as u32;
        let (up, right, ahead) = (columns[i0] * side, columns[i1], columns[i2]);
        let (kept, count) = clipped.patch.reduce::<false>();
        for k in &kept[..count] {
            let height = F32x4::flat(&clipped.patch.separation)[*k];
            let (x, y) = clipped.patch.at(*k);
            let point = origin + up * (half[i0] + 0.5 * height) + right * x + ahead * y;
            out.push(point, height, base | clipped.name(*k));
        }
        clipped.least <= separation + MARGIN * self.sizes.smaller
    }

    fn build_edges(&self, axis: &EdgeAxis, out: &mut LocalManifold) -> bool {
        let &EdgeAxis { a: i, b: j, separation, .. } = axis;
        let direction = self.frame.axes[j];
        let axis = Vector::AXES[i].cross(direction);
        let (_, distance, square) = self.edges(i, j);
        let sign = if distance < 0.0 { -1.0 } else { 1.0 };
        let normal = axis * (sign / square.sqrt());
        let (n, m) = (normal.to_array(), self.frame.direction_in(-normal).to_array());
        let (ha, hb) = (self.half_a.to_array(), self.half_b.to_array());
        let (mut on_a, mut on_b) = ([0.0; 3], [0.0; 3]);
        let mut name = 0;
        for k in 0..3 {
            if k != i {
                on_a[k] = if n[k] < 0.0 { -ha[k] } else { ha[k] };
                name |= u32::from(n[k] < 0.0) << k;
            }
            if k != j {
                on_b[k] = if m[k] < 0.0 { -hb[k] } else { hb[k] };
                name |= u32::from(m[k] < 0.0) << (3 + k);
            }
        }
        let (on_a, on_b) = (Vector::from_array(on_a), self.frame.point(Vector::from_array(on_b)));
        // The closest points of the lines on_a + s e_i and on_b + t b_j.
        let cross = |on_a: Vector, on_b: Vector| {
            let between = on_b - on_a;
            let (cos, u, v) = (direction.to_array()[i], between.to_array()[i], between.dot(direction));
            let (s, t) = ((u - cos * v) / square, (cos * u - v) / square);
            let beyond = max(s.abs() - ha[i], t.abs() - hb[j]);
            let on_a = on_a + Vector::AXES[i] * clamp(s, -ha[i], ha[i]);
            (on_a, on_b + direction * clamp(t, -hb[j], hb[j]), beyond)
        };
        let (first_a, first_b, beyond) = cross(on_a, on_b);
        (out.count, out.normal) = (0, normal);
        let feature = 1 << 16 | ((i * 3 + j) as u32) << 8 | name;
        out.push((first_a + first_b) * 0.5, separation, feature);
        let (next_a, next_b) = (next_edge(&n, &ha, i), next_edge(&m, &hb, j));
        let from_a = Vector::AXES[next_a.0] * next_a.1;
        let from_b = self.frame.axes[next_b.0] * next_b.1;
        for (a, b) in [(1.0, 0.0), (0.0, 1.0), (1.0, 1.0)] {
            let separation = separation + a * next_a.2 + b * next_b.2;
            if separation > self.sizes.prediction {
                continue;
            }
            let (on_a, on_b, beyond) = cross(on_a + from_a * a, on_b + from_b * b);
            if beyond <= 0.0 {
                let flips = ((a as u32) << next_a.0) | ((b as u32) << (3 + next_b.0));
                out.push((on_a + on_b) * 0.5, separation, feature ^ flips);
            }
        }
        beyond <= MARGIN * self.sizes.smaller
    }

    #[inline(never)]
    fn build_apart(&self, axis: &Axis, out: &mut LocalManifold) {
        let (a, b) = (Small::cuboid(self.half_a), Small::cuboid(self.half_b));
        convex::Pair::new(&a.view(), &b.view(), self.input).build_apart(axis, out);
    }

    #[cold]
    fn push_deepest(&self, &FaceAxis { face, of_b, separation, .. }: &FaceAxis, out: &mut LocalManifold) {
        let n = out.normal;
        let sign = |v: f32| if v < 0.0 { -1.0 } else { 1.0 };
        let corner = |d: Vector, half| Vector { x: sign(d.x), y: sign(d.y), z: sign(d.z) }.scale(half);
        let point = if of_b {
            corner(n, self.half_a) + n * (0.5 * separation)
        } else {
            self.frame.point(corner(self.frame.direction_in(-n), self.half_b)) - n * (0.5 * separation)
        };
        out.push(point, separation, (face as u32 | u32::from(of_b) << 2) << 9 | 0xff);
    }
}

impl Pair<'_> {
    /// The separations along A's face normals.
    #[inline(always)]
    fn faces_of_a(&self) -> Vector {
        let [x, y, z] = self.frame.axes;
        let h = self.half_b;
        self.offset[0].abs() - self.half_a - x.abs() * h.x - y.abs() * h.y - z.abs() * h.z
    }

    /// The separations along B's face normals.
    #[inline(always)]
    fn faces_of_b(&self) -> Vector {
        let reach = |axis: Vector| axis.abs().dot(self.half_a);
        let [x, y, z] = self.frame.axes;
        self.offset[1].abs() - self.half_b - Vector { x: reach(x), y: reach(y), z: reach(z) }
    }

    /// The separation along e_i × b_j before its division by the length, the signed distance of the
    /// centres along it, and the squared length.
    #[inline(always)]
    fn edges(&self, i: usize, j: usize) -> (f32, f32, f32) {
        let (i1, i2, j1, j2) = (NEXT[i], NEXT[NEXT[i]], NEXT[j], NEXT[NEXT[j]]);
        let (ha, hb, t) = (self.half_a.to_array(), self.half_b.to_array(), self.offset[0].to_array());
        let axes = self.frame.axes;
        let b = axes[j].to_array();
        let distance = t[i2] * b[i1] - t[i1] * b[i2];
        let of_a = ha[i1] * b[i2].abs() + ha[i2] * b[i1].abs();
        let of_b = hb[j1] * axes[j2].to_array()[i].abs() + hb[j2] * axes[j1].to_array()[i].abs();
        (distance.abs() - of_a - of_b, distance, b[i1] * b[i1] + b[i2] * b[i2])
    }
}

/// The next parallel edge of a box along axis `edge`, with the least rise along `normal`: the axis towards
/// it, its distance, and its additional separation along the normal.
fn next_edge(normal: &[f32; 3], half: &[f32; 3], edge: usize) -> (usize, f32, f32) {
    let (k, l) = (NEXT[edge], NEXT[NEXT[edge]]);
    let rise = |k: usize| 2.0 * half[k] * normal[k].abs();
    let k = if rise(k) < rise(l) { k } else { l };
    (k, if normal[k] < 0.0 { 2.0 } else { -2.0 } * half[k], rise(k))
}

/// The incident face: a parallelogram, in coordinates across the reference face and over it.
struct Quad {
    center: Vector,
    /// Half of one side vector.
    p: Vector,
    /// Half of the other side vector.
    q: Vector,
}

/// The points of a clipped quad: its four corners, four points where an edge enters the rectangle, four where
/// an edge leaves it, and four corners of the rectangle.
struct Clipped {
    patch: Patch<4>,
    /// The points where an edge meets the second pair of sides, as bits.
    across: u32,
    /// The smallest height over the rectangle.
    least: f32,
}

impl Clipped {
    /// The feature id of a point: its corner, or its edge and the side that cuts it.
    #[inline(always)]
    fn name(&self, point: usize) -> u32 {
        (point as u32) << 1 | self.across >> (point & 15) & 1
    }
}

#[inline(always)]
fn absolute(v: F32x4) -> F32x4 {
    v.max(-v)
}

/// The values with set bits, and infinity for the others.
#[inline(always)]
fn only(bits: u32, values: F32x4) -> F32x4 {
    const LANES: [F32x4; 16] = {
        let mut table = [F32x4::ZERO; 16];
        let mut i = 0;
        while i < 16 {
            table[i] =
                F32x4::new([(i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2 & 1) as f32, (i >> 3) as f32]);
            i += 1;
        }
        table
    };
    F32x4::select(F32x4::ZERO.lt(LANES[bits as usize & 15]), values, F32x4::splat(f32::INFINITY))
}

impl Quad {
    /// The part with |x| ≤ `half_u`, |y| ≤ `half_v` and a height up to `prediction`, in no order.
    ///
    /// Four lanes wide and without branches: all edges of the quad are cut by both pairs of sides (Liang and
    /// Barsky, 1984), then the corners of the rectangle are tested against the quad.
    #[inline(always)]
    fn clip(&self, half_u: f32, half_v: f32, prediction: f32) -> Clipped {
        const P: F32x4 = F32x4::new([-1.0, 1.0, 1.0, -1.0]);
        const Q: F32x4 = F32x4::new([-1.0, -1.0, 1.0, 1.0]);
        let (c, p, q) = (self.center, self.p, self.q);
        let corners = |c: f32, p: f32, q: f32| F32x4::splat(c) + P * F32x4::splat(p) + Q * F32x4::splat(q);
        let (x, y, z) = (corners(c.x, p.x, q.x), corners(c.y, p.y, q.y), corners(c.z, p.z, q.z));
        let (hu, hv) = (F32x4::splat(half_u), F32x4::splat(half_v));
        let inside = F32x4::bits(F32x4::and(absolute(x).le(hu), absolute(y).le(hv)));
        let none = F32x4::splat(f32::INFINITY);
        let mut clipped = Clipped {
            patch: Patch { x: [x; 4], y: [y; 4], separation: [only(inside, z), none, none, none] },
            across: 0,
            least: 0.0,
        };
        if inside != 0xf {
            self.cut_edges([x, y, z], [hu, hv], inside, &mut clipped);
            self.covered_corners(half_u, half_v, &mut clipped.patch);
        }
        let [a, b, c, d] = clipped.patch.separation;
        let least = a.min(b).min(c.min(d));
        clipped.least = min(min(least.get(0), least.get(1)), min(least.get(2), least.get(3)));
        let limit = F32x4::splat(prediction);
        clipped.patch.separation = [a, b, c, d].map(|s| F32x4::select(s.le(limit), s, none));
        clipped
    }

    #[inline(always)]
    fn cut_edges(&self, [x, y, z]: [F32x4; 3], [hu, hv]: [F32x4; 2], inside: u32, clipped: &mut Clipped) {
        let (p, q) = (self.p * 2.0, self.q * 2.0);
        let sides = |p: f32, q: f32| F32x4::new([p, q, -p, -q]);
        let (dx, dy, dz) = (sides(p.x, q.x), sides(p.y, q.y), sides(p.z, q.z));
        let slab = |at: F32x4, d: F32x4, half: F32x4| {
            // For an edge along the slab, any tiny slope decides whether it is inside.
            let tiny = F32x4::splat(1.0e-20);
            let d = F32x4::select(absolute(d).lt(tiny), tiny, d);
            let (s, t) = ((-half - at) / d, (half - at) / d);
            (s.min(t), s.max(t))
        };
        let ((enter_u, exit_u), (enter_v, exit_v)) = (slab(x, dx, hu), slab(y, dy, hv));
        let (enter, exit) = (enter_u.max(enter_v), exit_u.min(exit_v));
        let meets = enter.le(exit);
        let enters = F32x4::and(F32x4::and(F32x4::ZERO.lt(enter), enter.le(F32x4::ONE)), meets);
        let exits = F32x4::and(F32x4::and(F32x4::ZERO.le(exit), exit.lt(F32x4::ONE)), meets);
        let next_inside = inside >> 1 | (inside & 1) << 3;
        let patch = &mut clipped.patch;
        for (block, t, bits) in
            [(1, enter, F32x4::bits(enters) & !inside), (2, exit, F32x4::bits(exits) & !next_inside)]
        {
            // Places without a point may be NaN.
            (patch.x[block], patch.y[block]) = (x + t * dx, y + t * dy);
            patch.separation[block] = only(bits, z + t * dz);
        }
        clipped.across = F32x4::bits(enter_u.lt(enter_v)) << 4 | F32x4::bits(exit_v.lt(exit_u)) << 8;
    }

    /// The corners of the reference rectangle that lie over the quad.
    #[inline(always)]
    fn covered_corners(&self, half_u: f32, half_v: f32, patch: &mut Patch<4>) {
        const U: F32x4 = F32x4::new([-1.0, 1.0, -1.0, 1.0]);
        const V: F32x4 = F32x4::new([-1.0, -1.0, 1.0, 1.0]);
        let (c, p, q) = (self.center, self.p, self.q);
        let inverse = F32x4::splat(1.0 / (p.x * q.y - p.y * q.x));
        let wide = |v: Vector| Vector::<F32x4>::splat(v);
        let (c, p, q) = (wide(c), wide(p), wide(q));
        let (x, y) = (U * F32x4::splat(half_u), V * F32x4::splat(half_v));
        let (dx, dy) = (x - c.x, y - c.y);
        // The corner is c + s p + t q.
        let (s, t) = ((dx * q.y - dy * q.x) * inverse, (p.x * dy - p.y * dx) * inverse);
        let covered = F32x4::and(absolute(s).lt(F32x4::ONE), absolute(t).lt(F32x4::ONE));
        (patch.x[3], patch.y[3]) = (x, y);
        let height = c.z + s * p.z + t * q.z;
        patch.separation[3] = F32x4::select(covered, height, F32x4::splat(f32::INFINITY));
    }
}
