//! Shapes of many convex parts: surfaces of facets, and compounds of solids.

use super::Aabb;
use super::dim::Facet;
use super::part_tree::PartTree;
use super::surface::Surface;
use crate::math::Pose;

/// A shape of convex parts, with a tree over them. `S` is the shape of solids.
#[derive(Clone, Debug)]
pub struct Composite<S> {
    parts: Parts<S>,
    tree: PartTree,
    /// The solid that a closed convex surface bounds.
    solid: Option<Box<Self>>,
}

#[derive(Clone, Debug)]
enum Parts<S> {
    Surface(Surface),
    Solids(Vec<(Pose, S)>),
}

/// One part of a composite shape.
pub enum Part<'a, S> {
    /// A triangle in 3D, a segment in 2D.
    Facet(Facet),
    /// A solid, at a pose in the composite's frame.
    Solid(&'a Pose, &'a S),
}

impl<S> Composite<S> {
    /// A surface as a shape. If the surface is closed and convex, `solid` is the solid that it bounds, as the
    /// only part of a composite.
    pub fn of_surface(surface: Surface, solid: Option<Self>) -> Self {
        Self { tree: surface.tree(), parts: Parts::Surface(surface), solid: solid.map(Box::new) }
    }

    /// Solids as one shape. `aabb` gives the box of each solid in the composite's frame.
    pub fn of_solids(solids: Vec<(Pose, S)>, aabb: impl Fn(&Pose, &S) -> Aabb) -> Self {
        let boxes: Vec<Aabb> = solids.iter().map(|(pose, solid)| aabb(pose, solid)).collect();
        Self { tree: PartTree::new(&boxes), parts: Parts::Solids(solids), solid: None }
    }

    /// The solid that a closed convex surface bounds, as the only part of a composite.
    pub fn solid(&self) -> Option<&Self> {
        self.solid.as_deref()
    }

    /// The number of parts.
    pub fn len(&self) -> usize {
        match &self.parts {
            Parts::Surface(surface) => surface.len(),
            Parts::Solids(solids) => solids.len(),
        }
    }

    /// Whether there are no parts.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// A part.
    #[inline]
    pub fn part(&self, index: u32) -> Part<'_, S> {
        match &self.parts {
            Parts::Surface(surface) => Part::Facet(Facet::from(surface.corners(index))),
            Parts::Solids(solids) => {
                let (pose, solid) = &solids[index as usize];
                Part::Solid(pose, solid)
            }
        }
    }

    /// The surface, if the composite is a surface.
    pub fn surface(&self) -> Option<&Surface> {
        match &self.parts {
            Parts::Surface(surface) => Some(surface),
            Parts::Solids(_) => None,
        }
    }

    /// The solids with their poses; none if the composite is a surface.
    pub fn solids(&self) -> &[(Pose, S)] {
        match &self.parts {
            Parts::Surface(_) => &[],
            Parts::Solids(solids) => solids,
        }
    }

    /// The tree over the parts' boxes, in the composite's frame.
    pub fn tree(&self) -> &PartTree {
        &self.tree
    }
}
