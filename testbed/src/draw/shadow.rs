//! A shadow map: what the light sees, as depths on a grid.

use bevy_math::{Quat, Vec3};

use super::form::Form;
use super::{Drawable, View, triangle};

/// Cells along each side of the map.
const SIZE: usize = 3072;

/// Depths along the light's direction, seen from the light.
pub struct ShadowMap {
    to_light: Quat,
    middle: Vec3,
    scale: f32,
    bias: f32,
    depths: Vec<f32>,
}

impl ShadowMap {
    /// Renders the depths of all that is not glass, for light from the unit direction `light`.
    pub fn new(drawables: &[Drawable], view: View, light: Vec3) -> Self {
        let radius = (0.5 * (view.max - view.min).length()).max(1e-3);
        let mut map = Self {
            to_light: Quat::from_rotation_arc(light, Vec3::Z),
            middle: 0.5 * (view.min + view.max),
            scale: 0.5 * SIZE as f32 / radius,
            bias: 3.0 * radius / SIZE as f32,
            depths: vec![f32::NEG_INFINITY; SIZE * SIZE],
        };
        for drawable in drawables.iter().filter(|d| !d.glass) {
            let Form::Solid(solid) = &*drawable.form else { continue };
            let corners: Vec<Vec3> = solid
                .positions
                .iter()
                .map(|&p| map.project(drawable.translation + drawable.rotation * p))
                .collect();
            for &indices in &solid.triangles {
                let corners = indices.map(|i| corners[i as usize]);
                let depths = &mut map.depths;
                triangle::fill(corners, SIZE, SIZE, |cell, weights| {
                    let depth =
                        corners[0].z * weights[0] + corners[1].z * weights[1] + corners[2].z * weights[2];
                    depths[cell] = depths[cell].max(depth);
                });
            }
        }
        map
    }

    /// Cell coordinates in x and y, depth towards the light in z.
    fn project(&self, point: Vec3) -> Vec3 {
        let seen = self.to_light * (point - self.middle);
        Vec3::new(seen.x * self.scale + 0.5 * SIZE as f32, seen.y * self.scale + 0.5 * SIZE as f32, seen.z)
    }

    /// The share of light that reaches a point of a surface with the given normal, averaged over nine cells.
    /// All of it outside the map.
    pub fn light_at(&self, point: Vec3, normal: Vec3) -> f32 {
        let seen = self.project(point + 1.5 * self.bias * normal);
        let (x, y) = (seen.x.floor(), seen.y.floor());
        let inside = 1.0..(SIZE - 2) as f32;
        if !inside.contains(&x) || !inside.contains(&y) {
            return 1.0;
        }
        let corner = (y as usize - 1) * SIZE + x as usize - 1;
        let lit = (0..9).filter(|i| self.depths[corner + i / 3 * SIZE + i % 3] < seen.z + self.bias).count();
        lit as f32 / 9.0
    }
}
