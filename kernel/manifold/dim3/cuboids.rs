//! Two boxes: the hot pair, with its own separating-axis test and clipping.
//!
//! Fifteen axes (Gottschalk, Lin and Manocha, "OBBTree", 1996): three face normals each, nine products
//! of edges. The choice rules are those of [`convex`](super::convex).

use super::convex::{self, CACHE_TOLERANCE, EDGES, EXACT, FACE_A, FACE_B, PREFER_FACES};
use super::gjk;
use super::reduce::{Planar, reduce_planar};
use super::view::{Frame, Small};
use crate::manifold::{FeatureCache, LocalManifold};
use crate::math::{F32x4, Lane, Num, Pose, Vector, clamp, max, min};

/// Products of edges with a smaller squared sine between them have no direction.
const PARALLEL: f32 = 2.5e-5;
/// The reference rectangle is widened by this share of the smaller extent: equal boxes on each other
/// then keep their own corners in spite of rounding.
const MARGIN: f32 = 1.0e-3;
/// Clipping gives at most four corners, four entries, four exits and four reference corners.
const MAX_CLIPPED: usize = 16;

/// Two boxes and where they are to each other.
struct Pair {
    half_a: Vector,
    half_b: Vector,
    frame: Frame,
    /// The centre of B in A's frame, and of A in B's but for the sign.
    offset: [Vector; 2],
    prediction: f32,
    smaller: f32,
    larger: f32,
}

/// What a face contact is made of, in the frame of the box whose face it is.
struct FaceClip {
    /// The axis of the face.
    axis: usize,
    /// On which side of the box the face lies, 1 or −1.
    side: f32,
    /// How far the face is from the centre.
    face: f32,
    /// Corners of the clipped face, along the two axes after `axis`.
    points: [Planar; MAX_CLIPPED],
    names: [u32; MAX_CLIPPED],
    count: usize,
    /// The smallest height of the clipped incident face over the reference face.
    least: f32,
}

/// The components turned so that `axis` comes first.
#[inline(always)]
fn cycled(v: Vector, axis: usize) -> Vector {
    match axis {
        0 => v,
        1 => Vector { x: v.y, y: v.z, z: v.x },
        _ => Vector { x: v.z, y: v.x, z: v.y },
    }
}

/// The inverse of [`cycled`].
#[inline(always)]
fn uncycled(v: Vector, axis: usize) -> Vector {
    match axis {
        0 => v,
        1 => Vector { x: v.z, y: v.x, z: v.y },
        _ => Vector { x: v.y, y: v.z, z: v.x },
    }
}

/// The contact of two boxes with the given half extents; see the module.
pub(super) fn collide(
    half_a: Vector,
    half_b: Vector,
    pose: &Pose,
    prediction: f32,
    cache: &mut FeatureCache,
    out: &mut LocalManifold,
) {
    let frame = Frame::new(pose);
    let (size_a, size_b) = (half_a.max_element(), half_b.max_element());
    let (larger, smaller) = (max(size_a, size_b), min(size_a, size_b));
    let offset = [frame.position, frame.direction_in(frame.position)];
    let pair = Pair { half_a, half_b, frame, offset, prediction, smaller, larger };
    let exact = match pair.cached(cache) {
        Some(separation) if separation > prediction => return,
        Some(separation) if (separation - cache.separation).abs() < CACHE_TOLERANCE * smaller => {
            let exact = pair.build(cache.kind, cache.a, cache.b, separation, out);
            exact || (out.count > 0 && separation <= gjk::resolution(larger, smaller))
        }
        _ => false,
    };
    if exact {
        return;
    }
    *cache = pair.search();
    let separation = cache.separation;
    out.count = 0;
    if separation > prediction {
        return;
    }
    let exact = pair.build(cache.kind, cache.a, cache.b, separation, out);
    if !exact && separation > gjk::resolution(larger, smaller) {
        pair.build_apart(pose, separation, out);
    }
}

impl Pair {
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
        const NEXT: [usize; 3] = [1, 2, 0];
        let (i1, i2, j1, j2) = (NEXT[i], NEXT[NEXT[i]], NEXT[j], NEXT[NEXT[j]]);
        let (ha, hb, t) = (self.half_a.to_array(), self.half_b.to_array(), self.offset[0].to_array());
        let axes = self.frame.axes;
        let b = axes[j].to_array();
        let distance = t[i2] * b[i1] - t[i1] * b[i2];
        let of_a = ha[i1] * b[i2].abs() + ha[i2] * b[i1].abs();
        let of_b = hb[j1] * axes[j2].to_array()[i].abs() + hb[j2] * axes[j1].to_array()[i].abs();
        (distance.abs() - of_a - of_b, distance, b[i1] * b[i1] + b[i2] * b[i2])
    }

    /// The separation along the cached axis now.
    #[inline(always)]
    fn cached(&self, cache: &FeatureCache) -> Option<f32> {
        let (i, j) = (cache.a as usize, cache.b as usize);
        if i > 2 || j > 2 {
            return None;
        }
        match cache.kind {
            FACE_A => Some(self.faces_of_a().to_array()[i]),
            FACE_B => Some(self.faces_of_b().to_array()[j]),
            EDGES => {
                let (value, _, square) = self.edges(i, j);
                (square > PARALLEL).then(|| value / square.sqrt())
            }
            _ => None,
        }
    }

    /// The best axis, or the first beyond the prediction distance.
    fn search(&self) -> FeatureCache {
        let best = |v: Vector| {
            let v = v.to_array();
            let i = usize::from(v[1] > v[0]);
            let i = if v[2] > v[i] { 2 } else { i };
            (i as u8, v[i])
        };
        let (a, of_a) = best(self.faces_of_a());
        let mut found = FeatureCache { kind: FACE_A, a, b: 0, separation: of_a };
        if of_a > self.prediction {
            return found;
        }
        let (b, of_b) = best(self.faces_of_b());
        let preference = PREFER_FACES * self.smaller;
        if of_b > of_a + 0.1 * preference {
            found = FeatureCache { kind: FACE_B, a: 0, b, separation: of_b };
            if of_b > self.prediction {
                return found;
            }
        }
        let mut least = found.separation + preference;
        // For a negative value, division by a length below 1 only lowers it: most pairs end here,
        // without a root.
        for i in 0..3 {
            for j in 0..3 {
                let (value, _, square) = self.edges(i, j);
                if value > min(least, 0.0) && square > PARALLEL {
                    let separation = value / square.sqrt();
                    if separation > least {
                        least = separation;
                        found = FeatureCache { kind: EDGES, a: i as u8, b: j as u8, separation };
                    }
                }
            }
        }
        found
    }

    /// Fills the manifold from an axis. Whether its nearest point is as near as the axis says.
    #[inline(always)]
    fn build(&self, kind: u8, a: u8, b: u8, separation: f32, out: &mut LocalManifold) -> bool {
        match kind {
            FACE_A => self.build_face_of_a(a as usize, separation, out),
            FACE_B => self.build_face_of_b(b as usize, separation, out),
            _ => self.build_edges(a as usize, b as usize, separation, out),
        }
    }

    fn build_face_of_a(&self, axis: usize, separation: f32, out: &mut LocalManifold) -> bool {
        let clipped = self.clip_face(axis, &self.frame, self.half_a, self.half_b);
        out.normal = Vector::AXES[axis] * clipped.side;
        self.emit(&clipped, axis as u32, None, separation, out)
    }

    fn build_face_of_b(&self, axis: usize, separation: f32, out: &mut LocalManifold) -> bool {
        let inverse = self.frame.inverse();
        let clipped = self.clip_face(axis, &inverse, self.half_b, self.half_a);
        out.normal = self.frame.axes[axis] * -clipped.side;
        self.emit(&clipped, axis as u32 | 4, Some(&self.frame), separation, out)
    }

    /// Reduces the clipped points and writes them. `frame` takes them to A's frame.
    #[inline(always)]
    fn emit(
        &self,
        clipped: &FaceClip,
        face: u32,
        frame: Option<&Frame>,
        separation: f32,
        out: &mut LocalManifold,
    ) -> bool {
        out.count = 0;
        let list = &clipped.points[..clipped.count];
        let (kept, count) = reduce_planar(list);
        // The axis and its side: the reference face.
        let base = (face * 2 + u32::from(clipped.side > 0.0)) << 8;
        for k in &kept[..count] {
            let c = list[*k];
            let middle = Vector { x: clipped.side * (clipped.face + 0.5 * c.separation), y: c.x, z: c.y };
            let point = uncycled(middle, clipped.axis);
            out.push(frame.map_or(point, |f| f.point(point)), c.separation, base | clipped.names[*k]);
        }
        if out.count == 0 && separation <= gjk::resolution(self.larger, self.smaller) {
            self.emit_deepest(base, separation, out);
        }
        clipped.least <= separation + EXACT * self.smaller
    }

    /// Overlap beside the reference face: the deepest corner alone.
    #[cold]
    fn emit_deepest(&self, base: u32, separation: f32, out: &mut LocalManifold) {
        let n = out.normal;
        let sign = |v: f32| if v < 0.0 { -1.0 } else { 1.0 };
        let of_b = base & 4 << 9 != 0;
        let point = if of_b {
            Vector { x: sign(n.x), y: sign(n.y), z: sign(n.z) }.scale(self.half_a) + n * (0.5 * separation)
        } else {
            let d = self.frame.direction_in(-n);
            let corner = Vector { x: sign(d.x), y: sign(d.y), z: sign(d.z) }.scale(self.half_b);
            self.frame.point(corner) - n * (0.5 * separation)
        };
        out.push(point, separation, base | 0xff);
    }

    /// Clips the face of the other box (`frame`, `other`) that looks most against it by the face of
    /// this box on `axis`. Coordinates are turned so that this axis comes first.
    #[inline(always)]
    fn clip_face(&self, axis: usize, frame: &Frame, this: Vector, other: Vector) -> FaceClip {
        let position = cycled(frame.position, axis);
        let [a, b, c] = frame.axes.map(|v| cycled(v, axis));
        let h = cycled(this, axis);
        let side = if position.x < 0.0 { -1.0 } else { 1.0 };
        let (sa, sb, sc) = (a.x.abs(), b.x.abs(), c.x.abs());
        // The axis of the other box across its incident face, and the two along it.
        let (incident, across, p, q, reach) = if sa >= sb && sa >= sc {
            (0, a, b * other.y, c * other.z, other.x)
        } else if sb >= sc {
            (1, b, c * other.z, a * other.x, other.y)
        } else {
            (2, c, a * other.x, b * other.y, other.z)
        };
        let away = if across.x * side > 0.0 { -1.0 } else { 1.0 };
        let center = position + across * (away * reach);
        // Across the reference face, and the height over it.
        let local = |w: Vector| Vector { x: w.y, y: w.z, z: w.x * side };
        let mut center = local(center);
        center.z -= h.x;
        let quad = Quad { center, p: local(p), q: local(q) };
        let margin = MARGIN * self.smaller;
        // Which face of the other box.
        let name = (incident * 2 + u32::from(away > 0.0)) << 5;
        let mut clipped = FaceClip {
            axis,
            side,
            face: h.x,
            points: [Planar::default(); MAX_CLIPPED],
            names: [0; MAX_CLIPPED],
            count: 0,
            least: f32::INFINITY,
        };
        quad.clip(h.y + margin, h.z + margin, &mut |x, y, height, corner| {
            clipped.least = min(height, clipped.least);
            if height <= self.prediction && clipped.count < MAX_CLIPPED {
                clipped.points[clipped.count] = Planar { x, y, separation: height };
                clipped.names[clipped.count] = name | corner;
                clipped.count += 1;
            }
        });
        clipped
    }

    /// See [`convex::collide_apart`].
    #[inline(never)]
    fn build_apart(&self, pose: &Pose, separation: f32, out: &mut LocalManifold) {
        let (a, b) = (Small::cuboid(self.half_a), Small::cuboid(self.half_b));
        convex::collide_apart(&a.view(), &b.view(), pose, separation, self.prediction, out);
    }

    fn build_edges(&self, i: usize, j: usize, separation: f32, out: &mut LocalManifold) -> bool {
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
        let between = on_b - on_a;
        let (cos, u, v) = (direction.to_array()[i], between.to_array()[i], between.dot(direction));
        let (s, t) = ((u - cos * v) / square, (cos * u - v) / square);
        let inside = s.abs() <= ha[i] + EXACT * self.smaller && t.abs() <= hb[j] + EXACT * self.smaller;
        let on_a = on_a + Vector::AXES[i] * clamp(s, -ha[i], ha[i]);
        let on_b = on_b + direction * clamp(t, -hb[j], hb[j]);
        (out.count, out.normal) = (0, normal);
        let feature = 1 << 16 | ((i * 3 + j) as u32) << 8 | name;
        out.push((on_a + on_b) * 0.5, separation, feature);
        inside
    }
}

/// The incident face: a parallelogram, in coordinates across the reference face and over it.
struct Quad {
    center: Vector,
    /// Half of one side.
    p: Vector,
    /// Half of the other.
    q: Vector,
}

/// Four values side by side.
#[inline(always)]
fn lanes(v: [f32; 4]) -> F32x4 {
    let mut out = F32x4::splat(v[0]);
    out.set(1, v[1]);
    out.set(2, v[2]);
    out.set(3, v[3]);
    out
}

#[inline(always)]
fn absolute(v: F32x4) -> F32x4 {
    v.max(-v)
}

impl Quad {
    /// Gives the corners of the part with |x| ≤ `half_u`, |y| ≤ `half_v` to `add`, in no order.
    ///
    /// Unlike cutting side by side this is four lanes wide: each edge of the quad is cut by both pairs
    /// of sides at once (Liang and Barsky, 1984), then the corners of the rectangle are looked up in
    /// the quad.
    #[inline(always)]
    fn clip(&self, half_u: f32, half_v: f32, add: &mut impl FnMut(f32, f32, f32, u32)) {
        let (c, p, q) = (self.center, self.p, self.q);
        let along = |c: f32, p: f32, q: f32| lanes([c - p - q, c + p - q, c + p + q, c - p + q]);
        let (x, y, z) = (along(c.x, p.x, q.x), along(c.y, p.y, q.y), along(c.z, p.z, q.z));
        let (hu, hv) = (F32x4::splat(half_u), F32x4::splat(half_v));
        let inside = F32x4::and(absolute(x).le(hu), absolute(y).le(hv));
        let inside = F32x4::select(inside, F32x4::ONE, F32x4::ZERO);
        let inside: [bool; 4] = core::array::from_fn(|k| inside.get(k) != 0.0);
        for (k, is_inside) in inside.iter().enumerate() {
            if *is_inside {
                add(x.get(k), y.get(k), z.get(k), k as u32);
            }
        }
        if inside == [true; 4] {
            return;
        }
        self.cut_edges([x, y, z], [hu, hv], inside, add);
        self.covered_corners(half_u, half_v, add);
    }

    #[inline(always)]
    fn cut_edges(
        &self,
        [x, y, z]: [F32x4; 3],
        [hu, hv]: [F32x4; 2],
        inside: [bool; 4],
        add: &mut impl FnMut(f32, f32, f32, u32),
    ) {
        let (p, q) = (self.p * 2.0, self.q * 2.0);
        let sides = |p: f32, q: f32| lanes([p, q, -p, -q]);
        let (dx, dy, dz) = (sides(p.x, q.x), sides(p.y, q.y), sides(p.z, q.z));
        let slab = |at: F32x4, d: F32x4, half: F32x4| {
            // An edge along the slab: any tiny slope says whether it is inside.
            let tiny = F32x4::splat(1.0e-20);
            let d = F32x4::select(absolute(d).lt(tiny), tiny, d);
            let (s, t) = ((-half - at) / d, (half - at) / d);
            (s.min(t), s.max(t))
        };
        let ((enter_u, exit_u), (enter_v, exit_v)) = (slab(x, dx, hu), slab(y, dy, hv));
        let (enter, exit) = (enter_u.max(enter_v), exit_u.min(exit_v));
        for k in 0..4 {
            let (t0, t1) = (enter.get(k), exit.get(k));
            if !(t0 <= t1) {
                continue;
            }
            let mut cut = |t: f32, name: u32| {
                add(x.get(k) + t * dx.get(k), y.get(k) + t * dy.get(k), z.get(k) + t * dz.get(k), name);
            };
            if !inside[k] && t0 > 0.0 && t0 <= 1.0 {
                let across = u32::from(enter_v.get(k) > enter_u.get(k));
                cut(t0, 0x8 | (k as u32) << 1 | across);
            }
            if !inside[(k + 1) & 3] && (0.0..1.0).contains(&t1) {
                let across = u32::from(exit_v.get(k) < exit_u.get(k));
                cut(t1, 0x10 | (k as u32) << 1 | across);
            }
        }
    }

    /// The corners of the reference rectangle that lie over the quad.
    #[inline(always)]
    fn covered_corners(&self, half_u: f32, half_v: f32, add: &mut impl FnMut(f32, f32, f32, u32)) {
        let (c, p, q) = (self.center, self.p, self.q);
        let inverse = 1.0 / (p.x * q.y - p.y * q.x);
        for k in 0..4u32 {
            let (x, y) =
                (if k & 1 == 0 { -half_u } else { half_u }, if k & 2 == 0 { -half_v } else { half_v });
            let (dx, dy) = (x - c.x, y - c.y);
            // The corner is c + s p + t q.
            let (s, t) = ((dx * q.y - dy * q.x) * inverse, (p.x * dy - p.y * dx) * inverse);
            if s.abs() < 1.0 && t.abs() < 1.0 {
                add(x, y, c.z + s * p.z + t * q.z, 0x18 | k);
            }
        }
    }
}
