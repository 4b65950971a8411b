//! The surface of one manifold: that of the contact, or of the facets that made it.

use super::record::{Contact, Manifold, ManifoldSurface};
use crate::math::Vector;
use crate::table::{ColliderTable, FacetMaterial, Material};

impl Manifold {
    /// Whether a facet with a material of its own made it.
    #[inline(always)]
    pub fn has_own_surface(&self) -> bool {
        self.groups != [0; 2]
    }

    /// The surface of the manifold of a contact, by the materials of the colliders and of their facets now.
    pub fn surface(&self, contact: &Contact, colliders: &ColliderTable) -> ManifoldSurface {
        let [friction, restitution] = contact.surface;
        if !self.has_own_surface() {
            return ManifoldSurface { friction, restitution, velocity: Vector::ZERO };
        }
        let [a, b] = [0, 1].map(|side| {
            let id = contact.colliders[side];
            let def = &colliders[id].def;
            let own = def.facets.as_ref().and_then(|facets| facets.of_group(self.groups[side]));
            let of_collider = FacetMaterial { material: def.material, velocity: Vector::ZERO };
            let FacetMaterial { material, velocity } = own.copied().unwrap_or(of_collider);
            (material, colliders.poses[id as usize].rotation.rotate(velocity))
        });
        let (Material { friction, restitution }, other) = (a.0, b.0);
        ManifoldSurface {
            friction: friction.mix(other.friction),
            restitution: restitution.mix(other.restitution),
            // What lies on A is to move along with A's surface, and A along with that of B.
            velocity: a.1 - b.1,
        }
    }
}
