//! Friction, restitution and margins of a collider: from the collider, otherwise from its body, otherwise the
//! default.

use bevy_app::App;
use bevy_ecs::{
    change_detection::ContiguousRef,
    entity::EntityIndexSet,
    entity_disabling::Disabled,
    prelude::*,
    system::{SystemChangeTick, SystemParam},
};
use kernel::table::{self as table, Combine, Material, NONE, Surface};
use std::sync::Arc;

use crate::{
    collision::{
        collider::{
            CollisionMargin,
            collider_hierarchy::{ColliderOf, RigidBodyColliders},
        },
        narrow_phase::NarrowPhaseConfig,
    },
    dynamics::{
        ccd::SpeculativeMargin,
        ids::ColliderId,
        rigid_body::{
            CoefficientCombine, DefaultFriction, DefaultRestitution, FacetMaterial, FacetMaterials, Friction,
            Restitution,
        },
        tables::Tables,
    },
    math::{Scalar, Vector, to_f32, vector_to_kernel},
    scan::{IN_TABLES, Since},
};

/// Surface and margins of a collider.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Surfaces {
    pub(crate) material: Material,
    pub(crate) margin: f32,
    pub(crate) speculative: f32,
}

type SurfaceComponents = (
    Option<&'static Friction>,
    Option<&'static Restitution>,
    Option<&'static CollisionMargin>,
    Option<&'static SpeculativeMargin>,
);

/// Queries for the surface of a collider.
#[derive(SystemParam)]
pub(crate) struct SurfaceQuery<'w, 's> {
    surfaces: Query<'w, 's, SurfaceComponents, Allow<Disabled>>,
    facets: Query<'w, 's, &'static FacetMaterials, Allow<Disabled>>,
    changed_facets: Query<'w, 's, Entity, (Changed<FacetMaterials>, Allow<Disabled>)>,
    colliders: Query<'w, 's, &'static RigidBodyColliders, Allow<Disabled>>,
    friction: Res<'w, DefaultFriction>,
    restitution: Res<'w, DefaultRestitution>,
    config: Res<'w, NarrowPhaseConfig>,
}

impl SurfaceQuery<'_, '_> {
    /// The surface of a collider on a body, which may be the same entity.
    pub(crate) fn of(&self, collider: Entity, body: Option<Entity>) -> Surfaces {
        let own = self.surfaces.get(collider).unwrap_or_default();
        let from_body = body.and_then(|body| self.surfaces.get(body).ok()).unwrap_or_default();
        let friction = own.0.or(from_body.0).unwrap_or(&self.friction.0);
        let restitution = own.1.or(from_body.1).unwrap_or(&self.restitution.0);
        let margin = own.2.or(from_body.2).map_or(0.0, |m| m.0);
        let speculative = own.3.or(from_body.3).map_or(self.config.default_speculative_margin, |m| m.0);
        Surfaces {
            material: material(friction, restitution),
            margin: length(margin),
            speculative: length(speculative),
        }
    }

    /// The materials of a collider's facets.
    pub(crate) fn facets_of(&self, collider: Entity) -> Option<Arc<table::FacetMaterials>> {
        let own = self.facets.get(collider).ok()?;
        let materials = own.materials.iter().map(facet_material).collect();
        Some(Arc::new(table::FacetMaterials::new(materials, &own.facets)))
    }

    /// The colliders of a body.
    pub(crate) fn colliders_of(&self, body: Entity) -> Vec<Entity> {
        self.colliders.get(body).map(|list| list.iter().collect()).unwrap_or_default()
    }
}

/// Maximum friction coefficient, which stops all sliding. Larger values could overflow to NaN when combined,
/// or when multiplied by an impulse of 0.
const MAX_FRICTION: f32 = 1.0e9;

fn material(friction: &Friction, restitution: &Restitution) -> Material {
    Material {
        friction: surface(friction.dynamic_coefficient, friction.combine_rule, MAX_FRICTION),
        restitution: surface(restitution.coefficient, restitution.combine_rule, 1.0),
    }
}

/// The material of facets. A velocity that is not finite becomes 0.
fn facet_material(facet: &FacetMaterial) -> table::FacetMaterial {
    let velocity = vector_to_kernel(facet.tangent_velocity);
    let velocity = if velocity.is_finite() { velocity } else { vector_to_kernel(Vector::ZERO) };
    table::FacetMaterial { material: material(&facet.friction, &facet.restitution), velocity }
}

/// A surface with its coefficient clamped to the valid range.
fn surface(coefficient: Scalar, rule: CoefficientCombine, max: f32) -> Surface {
    let rule = match rule {
        CoefficientCombine::Average => Combine::Average,
        CoefficientCombine::GeometricMean => Combine::GeometricMean,
        CoefficientCombine::Min => Combine::Min,
        CoefficientCombine::Multiply => Combine::Multiply,
        CoefficientCombine::Max => Combine::Max,
    };
    let coefficient = to_f32(coefficient);
    let coefficient = if coefficient.is_nan() { 0.0 } else { coefficient.clamp(0.0, max) };
    Surface { coefficient, rule }
}

/// A margin. Negative values and NaN become 0.
fn length(value: Scalar) -> f32 {
    let value = to_f32(value);
    if value > 0.0 { value.min(f32::MAX) } else { 0.0 }
}

/// Components of a surface.
type SurfaceParts = (
    Entity,
    Option<Ref<'static, Friction>>,
    Option<Ref<'static, Restitution>>,
    Option<Ref<'static, CollisionMargin>>,
    Option<Ref<'static, SpeculativeMargin>>,
);

/// The filter for entities with a surface component.
type HasSurface = Or<(With<Friction>, With<Restitution>, With<CollisionMargin>, With<SpeculativeMargin>)>;

/// Colliders and bodies in the tables that lost a surface component since the last step, in the order of
/// removal. Bevy's own record of removals lasts for two frames, and steps may be further apart.
#[derive(Resource, Clone, Debug, Default)]
pub(crate) struct LostSurfaces(EntityIndexSet);

/// Registers the observer of removals.
pub(crate) fn watch_surfaces(app: &mut App) {
    app.init_resource::<LostSurfaces>().add_observer(note_lost_surface);
}

/// Records only entities in the tables. Others are read when they enter.
fn note_lost_surface(
    lost: On<Remove, (Friction, Restitution, CollisionMargin, SpeculativeMargin, FacetMaterials)>,
    ids: Query<&ColliderId, Allow<Disabled>>,
    colliders: Query<&RigidBodyColliders, Allow<Disabled>>,
    mut noted: ResMut<LostSurfaces>,
) {
    let entity = lost.entity;
    let is_known = |collider: Entity| ids.get(collider).is_ok_and(|id| id.0 != NONE);
    if is_known(entity) || colliders.get(entity).is_ok_and(|all| all.iter().any(is_known)) {
        noted.0.insert(entity);
    }
}

/// Updates surfaces in the table: for changed colliders, and for colliders that inherit from changed bodies.
pub(crate) fn refresh_surfaces(
    surfaces: Query<SurfaceParts, HasSurface>,
    mut lost: ResMut<LostSurfaces>,
    ids: Query<(&ColliderId, Option<&ColliderOf>)>,
    query: SurfaceQuery,
    mut tables: Tables,
    system: SystemChangeTick,
) {
    let defaults = query.friction.is_changed() || query.restitution.is_changed() || query.config.is_changed();
    let mut entities: Vec<Entity> = Vec::new();
    let since = Since::last_run(system);
    for (all, friction, restitution, margin, speculative) in surfaces.contiguous_iter().expect(IN_TABLES) {
        let parts = [
            friction.as_ref().map(ContiguousRef::changed_ticks_slice),
            restitution.as_ref().map(ContiguousRef::changed_ticks_slice),
            margin.as_ref().map(ContiguousRef::changed_ticks_slice),
            speculative.as_ref().map(ContiguousRef::changed_ticks_slice),
        ];
        // Any component identifies the entity.
        if let Some(any) = parts.into_iter().flatten().next() {
            since.rows(parts.map(|part| part.unwrap_or(any)), |row| entities.push(all[row]));
        }
    }
    entities.extend(query.changed_facets.iter());
    entities.extend(lost.0.drain(..));
    if defaults {
        entities.extend(tables.colliders.entities.iter().copied());
    }
    for entity in entities {
        let own = core::iter::once(entity);
        for collider in own.chain(query.colliders_of(entity)) {
            let Ok((id, of)) = ids.get(collider) else { continue };
            if !tables.colliders.table.ids.is_live(id.0) {
                continue;
            }
            let Surfaces { material, margin, speculative } = query.of(collider, of.map(|of| of.body));
            let facets = query.facets_of(collider);
            let def = &tables.colliders.table[id.0].def;
            let reaches = def.margin != margin || def.speculative != speculative;
            if !reaches && def.material == material && def.facets == facets {
                continue;
            }
            let mut manager = tables.contact_manager();
            // Bodies that rest on the surface may start to slide or bounce.
            manager.wake_with_touching(manager.colliders.body(id.0));
            manager.set_material(id.0, material);
            manager.set_facets(id.0, facets);
            if reaches {
                let Tables { bodies, colliders, .. } = &mut tables;
                let colliders = &mut **colliders;
                let entry = &mut colliders.table[id.0];
                (entry.def.margin, entry.def.speculative) = (margin, speculative);
                colliders.table.update_reach(id.0, &mut bodies.table);
                colliders.stale.insert(id.0);
            }
        }
    }
}
