//! Filling a triangle, pixel by pixel: the loop that both the picture and the shadow map are made with.

use bevy_math::Vec3;

/// Calls `plot(index, weights)` for every pixel whose middle lies in the triangle. Corners are in pixels (z
/// is not looked at), in either winding; weights belong to the corners and sum to one.
pub fn fill(corners: [Vec3; 3], width: usize, height: usize, mut plot: impl FnMut(usize, [f32; 3])) {
    let [a, b, c] = corners.map(|v| [f64::from(v.x), f64::from(v.y)]);
    // Twice the signed area of the triangle (p, q, r). In f64, since near floors reach far
    // outside the picture.
    let area =
        |p: [f64; 2], q: [f64; 2], r: [f64; 2]| (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
    let whole = area(a, b, c);
    if !whole.is_finite() || whole.abs() < 1e-12 {
        return;
    }
    let range = |axis: usize, size: usize| {
        let low = a[axis].min(b[axis]).min(c[axis]) - 0.5;
        let high = a[axis].max(b[axis]).max(c[axis]) - 0.5;
        // `as` saturates: what lies outside becomes an empty range.
        (low.ceil().max(0.0) as usize, (high.floor() + 1.0).clamp(0.0, size as f64) as usize)
    };
    let ((left, right), (top, bottom)) = (range(0, width), range(1, height));
    let scale = 1.0 / whole;
    for y in top..bottom {
        for x in left..right {
            let p = [x as f64 + 0.5, y as f64 + 0.5];
            let (u, v) = (area(b, c, p) * scale, area(c, a, p) * scale);
            let w = 1.0 - u - v;
            if u >= 0.0 && v >= 0.0 && w >= 0.0 {
                plot(y * width + x, [u as f32, v as f32, w as f32]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_halves_fill_a_square_once() {
        let corner = |x: f32, y: f32| Vec3::new(x, y, 0.0);
        let mut hits = vec![0; 20 * 20];
        let square = [corner(2.0, 3.0), corner(15.0, 3.0), corner(15.0, 18.0), corner(2.0, 18.0)];
        fill([square[0], square[1], square[2]], 20, 20, |i, _| hits[i] += 1);
        fill([square[0], square[3], square[2]], 20, 20, |i, _| hits[i] += 1);
        let expected = |i: usize| (2..15).contains(&(i % 20)) && (3..18).contains(&(i / 20));
        assert!((0..400).all(|i| (hits[i] > 0) == expected(i)));
    }

    #[test]
    fn weights_give_the_pixel_back() {
        let corners = [Vec3::new(-5.0, 1.0, 0.0), Vec3::new(30.0, 4.0, 0.0), Vec3::new(8.0, 40.0, 0.0)];
        fill(corners, 20, 20, |i, w| {
            let p = corners[0] * w[0] + corners[1] * w[1] + corners[2] * w[2];
            let middle = Vec3::new((i % 20) as f32 + 0.5, (i / 20) as f32 + 0.5, 0.0);
            assert!(p.distance(middle) < 1e-4);
        });
    }
}
