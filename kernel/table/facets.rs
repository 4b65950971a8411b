//! Materials of single facets of a collider's shape.

use super::Material;
use crate::math::Vector;

/// Maximum number of materials of one collider: manifolds name them by a byte.
pub const MAX_FACET_MATERIALS: usize = 255;

/// The surface of some facets.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FacetMaterial {
    /// Friction and restitution.
    pub material: Material,
    /// The velocity at which the surface carries objects that lie on it, in the collider's frame, m/s.
    pub velocity: Vector,
}

/// A table of materials, and the group of each facet: 0 for the collider's own material, k for entry k − 1 of
/// the table.
///
/// Facets are the parts of a composite shape in its order: triangles (in 2D segments) of a surface, solids of
/// a compound.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FacetMaterials {
    materials: Vec<FacetMaterial>,
    groups: Vec<u8>,
}

impl FacetMaterials {
    /// Facet i has `materials[facets[i]]`. Facets without an entry, and facets whose material is not among
    /// the first [`MAX_FACET_MATERIALS`], have the material of the collider.
    pub fn new(mut materials: Vec<FacetMaterial>, facets: &[u8]) -> Self {
        materials.truncate(MAX_FACET_MATERIALS);
        let group = |facet: &u8| if usize::from(*facet) < materials.len() { facet + 1 } else { 0 };
        Self { groups: facets.iter().map(group).collect(), materials }
    }

    /// The group of each facet.
    pub fn groups(&self) -> &[u8] {
        &self.groups
    }

    /// The material of a group; `None` for the collider's own material.
    #[inline]
    pub fn of_group(&self, group: u8) -> Option<&FacetMaterial> {
        self.materials.get(usize::from(group).checked_sub(1)?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn facets_without_a_material_have_that_of_the_collider() {
        let material = |x: f32| FacetMaterial { velocity: Vector::X * x, ..FacetMaterial::default() };
        let table = FacetMaterials::new(vec![material(1.0), material(2.0)], &[1, 0, 2, 255]);
        assert_eq!(table.groups(), [2, 1, 0, 0]);
        assert_eq!(table.of_group(2), Some(&material(2.0)));
        assert_eq!((table.of_group(0), table.of_group(3)), (None, None));
        let full = FacetMaterials::new(vec![material(0.0); 300], &[254, 255]);
        assert_eq!(full.groups(), [255, 0]);
    }
}
