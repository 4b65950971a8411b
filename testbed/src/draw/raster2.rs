//! 2D pictures: filled polygons with outlines, anti-aliased by supersampling.

use bevy_math::{Vec2, Vec3};

use super::color;
use super::form::{Form, Outline};
use super::{Drawable, Image, View};

/// How many times larger than the result, in each direction, the picture is drawn.
const OVERSAMPLING: usize = 3;

/// Space left free around what the view asks for.
const MARGIN: f32 = 1.04;

/// Draws the colliders onto a light ground, the view's bounds filling the picture.
pub fn draw(drawables: &[Drawable], view: View, width: usize, height: usize) -> Image {
    let (wide, high) = (width * OVERSAMPLING, height * OVERSAMPLING);
    let mut canvas = Image::filled(wide, high, color::stored_bytes(color::BACKGROUND));
    let span = (view.max - view.min).truncate().max(Vec2::splat(1e-3)) * MARGIN;
    let scale = (wide as f32 / span.x).min(high as f32 / span.y);
    let middle = (0.5 * (view.min + view.max)).truncate();
    let to_pixels = |p: Vec2| {
        let offset = (p - middle) * scale;
        Vec2::new(0.5 * wide as f32 + offset.x, 0.5 * high as f32 - offset.y)
    };
    for drawable in drawables {
        let Form::Flat(outlines) = &*drawable.form else { continue };
        let paint = color::of(drawable);
        for outline in outlines {
            draw_outline(&mut canvas, outline, drawable, paint, &to_pixels);
        }
    }
    canvas.reduced(OVERSAMPLING)
}

fn draw_outline(
    canvas: &mut Image,
    outline: &Outline,
    drawable: &Drawable,
    paint: Vec3,
    to_pixels: &impl Fn(Vec2) -> Vec2,
) {
    let place = |p: Vec2| to_pixels((drawable.translation + drawable.rotation * p.extend(0.0)).truncate());
    let points: Vec<Vec2> = outline.points.iter().map(|&p| place(p)).collect();
    let (mut low, mut high) = (Vec2::INFINITY, Vec2::NEG_INFINITY);
    for &point in &points {
        low = low.min(point);
        high = high.max(point);
    }
    // Lines of about a pixel of the result, thinner where a shape has only a few pixels.
    let line_width = (0.14 * (high - low).max_element()).clamp(0.7, 1.25 * OVERSAMPLING as f32);
    let ink = color::stored_bytes(paint.lerp(color::INK, 0.72));
    if outline.filled && !drawable.glass {
        fill_polygon(canvas, &points, color::stored_bytes(paint));
    }
    let closing = usize::from(outline.filled);
    for i in 0..(points.len() + closing).saturating_sub(1) {
        draw_line(canvas, points[i], points[(i + 1) % points.len()], line_width, ink);
    }
    if let (Some(spoke), Some(&rim)) = (outline.spoke, points.first()) {
        draw_line(canvas, place(spoke), rim, line_width, ink);
    }
}

/// A straight line with square, slightly overlapping ends.
fn draw_line(canvas: &mut Image, a: Vec2, b: Vec2, width: f32, ink: [u8; 3]) {
    let along = (b - a).normalize_or(Vec2::X) * (0.5 * width);
    let across = along.perp();
    let (a, b) = (a - 0.5 * along, b + 0.5 * along);
    fill_polygon(canvas, &[a + across, b + across, b - across, a - across], ink);
}

/// Fills a simple polygon, row by row between pairs of crossed edges.
fn fill_polygon(canvas: &mut Image, points: &[Vec2], ink: [u8; 3]) {
    if points.len() < 3 || points.iter().any(|p| !p.is_finite()) {
        return;
    }
    let low = points.iter().map(|p| p.y).fold(f32::INFINITY, f32::min);
    let high = points.iter().map(|p| p.y).fold(f32::NEG_INFINITY, f32::max);
    let rows =
        ((low - 0.5).ceil().max(0.0) as usize, ((high + 0.5).floor().max(0.0) as usize).min(canvas.height));
    let mut crossings: Vec<f32> = Vec::new();
    for row in rows.0..rows.1 {
        let y = row as f32 + 0.5;
        crossings.clear();
        for (i, &a) in points.iter().enumerate() {
            let b = points[(i + 1) % points.len()];
            if (a.y <= y) != (b.y <= y) {
                crossings.push(a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x));
            }
        }
        crossings.sort_by(f32::total_cmp);
        for pair in crossings.chunks_exact(2) {
            let left = ((pair[0] - 0.5).ceil().max(0.0) as usize).min(canvas.width);
            let right = ((pair[1] + 0.5).floor().max(0.0) as usize).min(canvas.width);
            if left < right {
                canvas.pixels[row * canvas.width + left..row * canvas.width + right].fill(ink);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_polygon_covers_its_area() {
        let mut canvas = Image::filled(100, 100, [0; 3]);
        let points: Vec<Vec2> = Outline::circle(40.0).points.iter().map(|&p| p + Vec2::splat(50.0)).collect();
        fill_polygon(&mut canvas, &points, [255; 3]);
        let filled = canvas.pixels.iter().filter(|p| p[0] > 0).count() as f32;
        let area = std::f32::consts::PI * 1600.0;
        assert!((filled / area - 1.0).abs() < 0.01, "{filled} of {area}");
    }

    #[test]
    fn what_is_outside_or_not_a_number_is_left_out() {
        let mut canvas = Image::filled(10, 10, [0; 3]);
        let far = [Vec2::new(-1e9, -50.0), Vec2::new(-1e8, -50.0), Vec2::new(-1e8, 50.0)];
        fill_polygon(&mut canvas, &far, [255; 3]);
        fill_polygon(&mut canvas, &[Vec2::NAN, Vec2::ZERO, Vec2::ONE], [255; 3]);
        assert!(canvas.pixels.iter().all(|p| p[0] == 0));
    }
}
