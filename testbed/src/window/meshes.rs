//! Colliders as meshes: one entity each, meshes shared by equal shapes, materials by equal colours.

use std::collections::HashMap;
use std::sync::Arc;

use bevy::asset::RenderAssetUsages;
use bevy::mesh::{Indices, PrimitiveTopology};
use bevy::prelude::*;

use super::stage::Stage;
use crate::draw::form::{Form, Outline, Solid};
use crate::draw::{Drawable, color};

/// Half the thickness in metres of what is drawn of a line in the plane.
const LINE: f32 = 0.06;

/// Distance in metres between the planes that flat shapes are drawn in, so that parts of one body
/// do not flicker.
const PLY: f32 = 1e-3;

/// What has been uploaded for the scene on stage.
#[derive(Resource, Default)]
pub struct Library {
    generation: u32,
    /// By address of the form, which is kept here so that the address stays its own.
    meshes: HashMap<usize, (Arc<Form>, Handle<Mesh>)>,
    materials: HashMap<[u8; 4], Handle<StandardMaterial>>,
    entities: Vec<Entity>,
}

impl Library {
    fn mesh(&mut self, form: &Arc<Form>, assets: &mut Assets<Mesh>) -> Handle<Mesh> {
        let make = || (form.clone(), assets.add(mesh(form)));
        self.meshes.entry(Arc::as_ptr(form).addr()).or_insert_with(make).1.clone()
    }

    fn material(
        &mut self,
        drawable: &Drawable,
        assets: &mut Assets<StandardMaterial>,
    ) -> Handle<StandardMaterial> {
        let flat = matches!(*drawable.form, Form::Flat(_));
        let [r, g, b] = color::stored_bytes(color::of(drawable));
        let alpha = if drawable.glass { 40 } else { 255 };
        let make = || {
            assets.add(StandardMaterial {
                base_color: Color::srgba_u8(r, g, b, alpha),
                alpha_mode: if drawable.glass { AlphaMode::Blend } else { AlphaMode::Opaque },
                perceptual_roughness: 0.8,
                unlit: flat,
                cull_mode: None,
                ..default()
            })
        };
        self.materials.entry([r, g, b, alpha]).or_insert_with(make).clone()
    }
}

/// Brings the entities in line with what is on stage.
pub fn show(
    mut commands: Commands,
    mut stage: NonSendMut<Stage>,
    mut library: ResMut<Library>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
    mut shown: Query<(&mut Transform, &mut MeshMaterial3d<StandardMaterial>)>,
) {
    if library.generation != stage.generation {
        for entity in library.entities.drain(..) {
            commands.entity(entity).despawn();
        }
        *library = Library { generation: stage.generation, ..default() };
    }
    let drawables = stage.drawables();
    let fresh = library.entities.is_empty();
    for (i, drawable) in drawables.iter().enumerate() {
        let material = library.material(drawable, &mut materials);
        let lift = if matches!(*drawable.form, Form::Flat(_)) { PLY * (i % 16) as f32 } else { 0.0 };
        let place = drawable.translation + Vec3::Z * lift;
        let pose = Transform::from_translation(place).with_rotation(drawable.rotation);
        if fresh || i >= library.entities.len() {
            let mesh = library.mesh(&drawable.form, &mut meshes);
            let entity = commands.spawn((Mesh3d(mesh), MeshMaterial3d(material), pose)).id();
            library.entities.push(entity);
        } else if let Ok((mut transform, mut painted)) = shown.get_mut(library.entities[i]) {
            transform.set_if_neq(pose);
            if painted.0 != material {
                painted.0 = material;
            }
        }
    }
}

fn mesh(form: &Form) -> Mesh {
    match form {
        Form::Solid(solid) => upload(solid),
        Form::Flat(outlines) => {
            let mut solid = Solid::default();
            for outline in outlines {
                solid.append(&flattened(outline), |p| p, |n| n);
            }
            upload(&solid)
        }
    }
}

fn upload(solid: &Solid) -> Mesh {
    let to_arrays = |vectors: &[Vec3]| vectors.iter().map(|v| v.to_array()).collect::<Vec<_>>();
    Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default())
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, to_arrays(&solid.positions))
        .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, to_arrays(&solid.normals))
        .with_inserted_indices(Indices::U32(solid.triangles.as_flattened().to_vec()))
}

/// A plane outline as triangles: a fan where filled, with a notch at the first corner of round ones to see
/// them turn; else a thin band along each part of the line.
fn flattened(outline: &Outline) -> Solid {
    let points: Vec<Vec3> = outline.points.iter().map(|p| p.extend(0.0)).collect();
    if outline.filled {
        let count = points.len() as u32;
        return match outline.spoke {
            Some(middle) => {
                let mut round = points;
                round.push(middle.extend(0.0));
                Solid::faceted(&round, (1..count).map(|i| [count, i, (i + 1) % count]).filter(|t| t[2] != 0))
            }
            None => Solid::faceted(&points, (2..count).map(|i| [0, i - 1, i])),
        };
    }
    let mut solid = Solid::default();
    for pair in points.windows(2) {
        let across = (pair[1] - pair[0]).cross(Vec3::Z).normalize_or_zero() * LINE;
        let corners = [pair[0] + across, pair[1] + across, pair[1] - across, pair[0] - across];
        solid.append(&Solid::faceted(&corners, [[0, 1, 2], [0, 2, 3]]), |p| p, |n| n);
    }
    solid
}
