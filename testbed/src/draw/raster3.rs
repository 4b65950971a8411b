//! 3D pictures: a z-buffer in perspective, sunlight with shadows, ambient occlusion, edges.

use bevy_math::{Vec2, Vec3};

use super::color;
use super::form::{Form, Solid};
use super::shadow::ShadowMap;
use super::{Drawable, Image, View, triangle};

/// How many times larger than the result, in each direction, the picture is drawn.
const OVERSAMPLING: usize = 2;
/// Half the camera's vertical field of view, as a tangent: 32 degrees in all.
const TAN_HALF_FOV: f32 = 0.287;
/// Nearest distance that is drawn, relative to the distance of the scene's middle.
const NEAR: f32 = 0.02;
/// No drawable: the sky.
const NOTHING: u32 = u32::MAX;

/// Draws the colliders in sunlight, the view's bounds filling the picture.
pub fn draw(drawables: &[Drawable], view: View, width: usize, height: usize) -> Image {
    let light = Vec3::new(-0.45, 1.0, 0.55).normalize();
    let shadows = ShadowMap::new(drawables, view, light);
    let camera = Camera::framing(view, width * OVERSAMPLING, height * OVERSAMPLING);
    let buffer = Buffer::render(drawables, &camera);
    let colors: Vec<Vec3> = drawables.iter().map(|d| color::to_linear(color::of(d))).collect();
    let mut image = Image::filled(camera.width, camera.height, [0; 3]);
    for y in 0..camera.height {
        for x in 0..camera.width {
            let lit = shade(&buffer, &camera, &shadows, (x, y), light, &colors);
            image.pixels[y * camera.width + x] = color::to_bytes(lit);
        }
    }
    image.reduced(OVERSAMPLING)
}

/// A perspective camera.
struct Camera {
    eye: Vec3,
    right: Vec3,
    up: Vec3,
    forward: Vec3,
    /// Pixels per unit of tangent.
    focal: f32,
    near: f32,
    /// Distance of the scene's middle.
    distance: f32,
    width: usize,
    height: usize,
}

impl Camera {
    /// A camera in the view's direction that has all corners of the view's bounds in the picture, in its
    /// middle, and as large as that allows.
    fn framing(view: View, width: usize, height: usize) -> Self {
        let backward = view.eye.normalize_or(Vec3::Z);
        let right = Vec3::Y.cross(backward).normalize_or(Vec3::X);
        let up = backward.cross(right);
        let middle = 0.5 * (view.min + view.max);
        let corners: [Vec3; 8] = std::array::from_fn(|i| {
            let pick = |axis: usize| if i >> axis & 1 == 0 { view.min[axis] } else { view.max[axis] };
            let offset = Vec3::new(pick(0), pick(1), pick(2)) - middle;
            Vec3::new(offset.dot(right), offset.dot(up), offset.dot(backward))
        });
        let tan = Vec2::new(TAN_HALF_FOV * width as f32 / height as f32, TAN_HALF_FOV) * 0.95;
        // For a camera at (c, d) in this frame, each corner (p, q) asks for |p − c| ≤ (d − q) tan. Two
        // corners of opposite sides bind: p + q tan and p − q tan are linear, so their extremes give c and d
        // in closed form.
        let (mut low, mut high) = (Vec2::INFINITY, Vec2::NEG_INFINITY);
        for corner in corners {
            high = high.max(corner.truncate() + corner.z * tan);
            low = low.min(corner.truncate() - corner.z * tan);
        }
        let shift = 0.5 * (low + high);
        let distance = (0.5 * (high - low) / tan).max_element().max(1e-2);
        Self {
            eye: middle + right * shift.x + up * shift.y + backward * distance,
            right,
            up,
            forward: -backward,
            focal: 0.5 * height as f32 / TAN_HALF_FOV,
            near: NEAR * distance,
            distance,
            width,
            height,
        }
    }

    /// Into the camera's frame: right, up, forward.
    fn seen(&self, point: Vec3) -> Vec3 {
        let offset = point - self.eye;
        Vec3::new(offset.dot(self.right), offset.dot(self.up), offset.dot(self.forward))
    }

    /// Pixel, and the inverse of the distance along the camera's axis, which is linear over the picture.
    fn project(&self, seen: Vec3) -> Vec3 {
        let inverse = 1.0 / seen.z;
        let scale = self.focal * inverse;
        let (x, y) = (0.5 * self.width as f32 + seen.x * scale, 0.5 * self.height as f32 - seen.y * scale);
        Vec3::new(x, y, inverse)
    }

    /// The point of the world seen at a pixel.
    fn point(&self, x: usize, y: usize, inverse: f32) -> Vec3 {
        let right = (x as f32 + 0.5 - 0.5 * self.width as f32) / self.focal;
        let up = (0.5 * self.height as f32 - y as f32 - 0.5) / self.focal;
        self.eye + (self.forward + self.right * right + self.up * up) / inverse
    }
}

/// The surface at each pixel.
struct Buffer {
    /// Inverse distance; 0 is infinitely far.
    nearness: Vec<f32>,
    normal: Vec<Vec3>,
    drawable: Vec<u32>,
    /// Panes of glass in front.
    panes: Vec<u8>,
}

impl Buffer {
    fn render(drawables: &[Drawable], camera: &Camera) -> Self {
        let count = camera.width * camera.height;
        let mut buffer = Self {
            nearness: vec![0.0; count],
            normal: vec![Vec3::ZERO; count],
            drawable: vec![NOTHING; count],
            panes: vec![0; count],
        };
        // Glass last, since it is blended over opaque surfaces.
        for glass in [false, true] {
            for (index, drawable) in drawables.iter().enumerate().filter(|(_, d)| d.glass == glass) {
                if let Form::Solid(solid) = &*drawable.form {
                    buffer.add(index as u32, drawable, solid, camera);
                }
            }
        }
        buffer
    }

    fn add(&mut self, index: u32, drawable: &Drawable, solid: &Solid, camera: &Camera) {
        let normals: Vec<Vec3> = solid.normals.iter().map(|&n| drawable.rotation * n).collect();
        let corners: Vec<Vec3> = solid
            .positions
            .iter()
            .map(|&p| camera.seen(drawable.translation + drawable.rotation * p))
            .collect();
        for indices in &solid.triangles {
            let [a, b, c] = indices.map(|i| corners[i as usize]);
            if (b - a).cross(c - a).dot(a) >= 0.0 && drawable.glass {
                continue; // Only the near side of glass tints.
            }
            let triangle = indices.map(|i| (corners[i as usize], normals[i as usize]));
            let (clipped, count) = clip(triangle, camera.near);
            for i in 2..count {
                self.plot(index, drawable.glass, [clipped[0], clipped[i - 1], clipped[i]], camera);
            }
        }
    }

    fn plot(&mut self, index: u32, glass: bool, triangle: [(Vec3, Vec3); 3], camera: &Camera) {
        let screen = triangle.map(|(seen, _)| camera.project(seen));
        triangle::fill(screen, camera.width, camera.height, |pixel, weights| {
            let nearness = screen[0].z * weights[0] + screen[1].z * weights[1] + screen[2].z * weights[2];
            if nearness <= self.nearness[pixel] {
                return;
            }
            if glass {
                self.panes[pixel] = self.panes[pixel].saturating_add(1);
                return;
            }
            let normal = triangle[0].1 * weights[0] + triangle[1].1 * weights[1] + triangle[2].1 * weights[2];
            self.nearness[pixel] = nearness;
            self.normal[pixel] = normal.normalize_or_zero();
            self.drawable[pixel] = index;
        });
    }
}

/// Cuts off what lies nearer than `near` (Sutherland and Hodgman's clipping by one plane). Gives up to
/// four corners.
fn clip(triangle: [(Vec3, Vec3); 3], near: f32) -> ([(Vec3, Vec3); 4], usize) {
    let mut kept = [(Vec3::ZERO, Vec3::ZERO); 4];
    let mut count = 0;
    let mut keep = |corner: (Vec3, Vec3)| {
        kept[count] = corner;
        count += 1;
    };
    for i in 0..3 {
        let (a, b) = (triangle[i], triangle[(i + 1) % 3]);
        if a.0.z >= near {
            keep(a);
        }
        if (a.0.z >= near) != (b.0.z >= near) {
            let share = (near - a.0.z) / (b.0.z - a.0.z);
            keep((a.0.lerp(b.0, share).with_z(near), a.1.lerp(b.1, share)));
        }
    }
    (kept, count)
}

/// The light that comes from a pixel, linear.
fn shade(
    buffer: &Buffer,
    camera: &Camera,
    shadows: &ShadowMap,
    (x, y): (usize, usize),
    light: Vec3,
    colors: &[Vec3],
) -> Vec3 {
    let pixel = y * camera.width + x;
    let sky = color::to_linear(color::BACKGROUND);
    let drawable = buffer.drawable[pixel];
    let mut seen = sky;
    if drawable != NOTHING {
        let point = camera.point(x, y, buffer.nearness[pixel]);
        let facing = buffer.normal[pixel].dot(point - camera.eye) > 0.0;
        let normal = if facing { -buffer.normal[pixel] } else { buffer.normal[pixel] };
        let sun = normal.dot(light).max(0.0);
        let sun = if sun > 0.0 { sun * shadows.light_at(point, normal) } else { 0.0 };
        let ambient = (0.34 + 0.16 * normal.y) * openness(buffer, camera, (x, y), point, normal);
        seen = colors[drawable as usize] * (ambient + 0.78 * sun) * edge_tone(buffer, camera, x, y);
        // Floors fade into the sky well behind the scene.
        let far = (1.0 / buffer.nearness[pixel] / camera.distance - 1.6) / 4.0;
        seen = seen.lerp(sky, far.clamp(0.0, 1.0));
    }
    if buffer.panes[pixel] > 0 { seen.lerp(Vec3::new(0.62, 0.74, 0.82), 0.16) } else { seen }
}

/// The share of the hemisphere over a point that is open, by testing whether pixels around it rise above its
/// tangent plane: 1 in the open, less in creases. the open, less in creases.
fn openness(buffer: &Buffer, camera: &Camera, at: (usize, usize), point: Vec3, normal: Vec3) -> f32 {
    const DIRECTIONS: [(f32, f32); 8] = [
        (1.0, 0.2),
        (-0.5, 0.11),
        (0.2, -1.0),
        (-0.11, 0.5),
        (0.38, 0.33),
        (-0.72, -0.66),
        (0.66, -0.72),
        (-0.33, 0.38),
    ];
    let reach = 0.03 * camera.distance;
    let pixels = (reach * camera.focal * buffer.nearness[at.1 * camera.width + at.0]).clamp(2.0, 120.0);
    let mut hidden = 0.0;
    for (u, v) in DIRECTIONS {
        let (x, y) = (at.0 as f32 + u * pixels, at.1 as f32 + v * pixels);
        if x < 0.0 || y < 0.0 || x >= camera.width as f32 || y >= camera.height as f32 {
            continue;
        }
        let (x, y) = (x as usize, y as usize);
        let nearness = buffer.nearness[y * camera.width + x];
        if nearness > 0.0 {
            let offset = camera.point(x, y, nearness) - point;
            let length = offset.length();
            if length < 1.5 * reach && offset.dot(normal) > 0.15 * length {
                hidden += 1.0 - length / (1.5 * reach);
            }
        }
    }
    1.0 - 0.8 * hidden / DIRECTIONS.len() as f32
}

/// Darker where another body or another face begins to the right or below.
fn edge_tone(buffer: &Buffer, camera: &Camera, x: usize, y: usize) -> f32 {
    let here = y * camera.width + x;
    let mut tone: f32 = 1.0;
    for there in
        [(x + 1 < camera.width).then(|| here + 1), (y + 1 < camera.height).then(|| here + camera.width)]
    {
        let Some(there) = there else { continue };
        if buffer.drawable[there] != buffer.drawable[here] {
            tone = tone.min(0.45);
        } else if buffer.normal[there].dot(buffer.normal[here]) < 0.7 {
            tone = tone.min(0.7);
        }
    }
    tone
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clipping_keeps_what_is_in_front() {
        let corner = |z: f32| (Vec3::new(z, 0.0, z), Vec3::Y);
        assert_eq!(clip([corner(-1.0), corner(-2.0), corner(0.5)], 1.0).1, 0);
        assert_eq!(clip([corner(2.0), corner(3.0), corner(4.0)], 1.0).1, 3);
        let (kept, count) = clip([corner(0.0), corner(2.0), corner(3.0)], 1.0);
        assert_eq!(count, 4);
        assert!(kept[..count].iter().all(|c| c.0.z >= 1.0 && (c.0.x - c.0.z).abs() < 1e-6));
    }

    #[test]
    fn a_pixel_leads_back_to_its_point() {
        let view = View { min: Vec3::splat(-3.0), max: Vec3::splat(4.0), eye: Vec3::new(0.4, 0.7, 1.0) };
        let camera = Camera::framing(view, 300, 200);
        for corner in [view.min, view.max, Vec3::new(-3.0, 4.0, 4.0), Vec3::new(4.0, -3.0, 4.0)] {
            let p = camera.project(camera.seen(corner));
            assert!((0.0..300.0).contains(&p.x) && (0.0..200.0).contains(&p.y), "{p}");
            let back = camera.point(p.x as usize, p.y as usize, p.z);
            assert!(back.distance(corner) < 1.5 / (camera.focal * p.z), "{back} {corner}");
        }
    }
}
