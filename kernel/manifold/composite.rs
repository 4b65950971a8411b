//! Contact manifolds of composite shapes: part by part, merged into few. Closed convex surfaces are the solids that they bound.

use super::dim::{Convex, face_normal, with_convex};
use super::merge::{Merging, merge};
use super::parts::{PartBuffers, Pass, Skin};
use super::{FeatureCache, LocalManifold, Look};
use crate::math::{Pose, min};
use crate::shape::{Aabb, Composite, Part, Shape};
use crate::tuning::sweeps::CORE_SHARE;
use core::cell::Cell;

/// Buffers for the manifolds of composite shapes, kept between calls.
#[derive(Clone, Debug, Default)]
pub struct CompositeBuffers {
    /// That of the pair, where a surface counts as one solid; see [`collide`](super::collide).
    pub cache: FeatureCache,
    parts: PartBuffers,
    merging: Merging,
}

impl CompositeBuffers {
    /// A lower bound of the distance to the parts that the motion of the last call leads past.
    pub fn passed(&self) -> f32 {
        self.parts.passed
    }
}

/// Adds the manifolds of two shapes of which at least one is composite, in A's frame; see [`collide`](super::collide). Returns a
/// lower bound of the distance between the shapes: infinite if no part is near, 0 if there are points.
pub fn collide_composite(
    a: &Shape,
    b: &Shape,
    pose_b_in_a: &Pose,
    look: Look<'_>,
    buffers: &mut CompositeBuffers,
    out: &mut Vec<LocalManifold>,
) -> f32 {
    let cache = Cell::new(buffers.cache);
    let gap = collide_parts([a, b], pose_b_in_a, look, false, &cache, &mut buffers.parts);
    buffers.cache = cache.get();
    let start = out.len();
    merge(&mut buffers.parts.found, &mut buffers.merging, out);
    out[start..].iter_mut().for_each(|m| m.place_on_mover(look.ground));
    if buffers.parts.found.is_empty() { gap } else { 0.0 }
}

/// Adds the manifolds of all parts, each as if it were alone, in A's frame: of those within the prediction, and of those that the
/// motion may meet. Their normals and separations are slabs between convex shapes.
pub fn collide_each_part(
    a: &Shape,
    b: &Shape,
    pose_b_in_a: &Pose,
    look: Look<'_>,
    buffers: &mut CompositeBuffers,
    out: &mut Vec<LocalManifold>,
) {
    let cache = Cell::new(FeatureCache::NONE);
    collide_parts([a, b], pose_b_in_a, look, true, &cache, &mut buffers.parts);
    out.extend_from_slice(&buffers.parts.found);
}

/// Fills `buffers.found` with the manifolds of parts. Returns a lower bound of the distance to parts without.
fn collide_parts(
    [a, b]: [&Shape; 2],
    pose_b_in_a: &Pose,
    look: Look<'_>,
    alone: bool,
    cache: &Cell<FeatureCache>,
    buffers: &mut PartBuffers,
) -> f32 {
    buffers.clear();
    let is_usable = pose_b_in_a.position.is_finite() && pose_b_in_a.rotation.is_finite();
    if !(is_usable && look.prediction.is_finite() && look.motion.is_finite()) {
        return 0.0;
    }
    let pose_a_in_b = pose_b_in_a.inverse();
    let solids = if alone {
        [None; 2]
    } else {
        [solid(a, b, pose_b_in_a, look, 0), solid(b, a, &pose_a_in_b, look, 1)]
    };
    let cache_of = |composite: &Composite<Shape>| {
        let is_solid = |solid: &Composite<Shape>| core::ptr::eq(solid, composite);
        solids.into_iter().flatten().any(is_solid).then_some(cache)
    };
    let over = |composite: &Composite<Shape>, other: &Shape, buffers: &mut PartBuffers| {
        with_other(composite, other, |other| {
            let pass = Pass::new(composite, other, pose_b_in_a, look, alone);
            Pass { cache: cache_of(composite), ..pass }.collide(buffers)
        })
    };
    // The other way round, with points on B if both are composite.
    let swapped = look.swapped(pose_b_in_a.rotation.inverse_rotate(-look.motion));
    let under = |other: &Shape, composite: &Composite<Shape>, buffers: &mut PartBuffers| {
        let on_composite = matches!(a, Shape::Composite(_));
        let gap = with_other(composite, other, |other| {
            let pass = Pass::new(composite, other, &pose_a_in_b, swapped, alone);
            Pass { on_composite, is_b: true, cache: cache_of(composite), ..pass }.collide(buffers)
        });
        buffers.found.iter_mut().for_each(|m| *m = m.flipped(&pose_a_in_b));
        gap
    };
    match (a, b, solids) {
        (Shape::Composite(a), _, [None, Some(solid)]) => over(a, only_part(solid, b), buffers),
        (_, Shape::Composite(b), [Some(solid), None]) => under(only_part(solid, a), b, buffers),
        (_, _, [Some(solid), None]) => over(solid, b, buffers),
        (_, _, [None, Some(solid)]) => under(a, solid, buffers),
        (_, _, [Some(solid), Some(other)]) => over(solid, only_part(other, b), buffers),
        (Shape::Composite(large), Shape::Composite(small), _) if a.ball_around().1 >= b.ball_around().1 => {
            collide_both([large, small], pose_b_in_a, look, alone, false, buffers)
        }
        (Shape::Composite(small), Shape::Composite(large), _) => {
            let gap = collide_both([large, small], &pose_a_in_b, swapped, alone, true, buffers);
            buffers.found.iter_mut().for_each(|m| *m = m.flipped(&pose_a_in_b));
            gap
        }
        (Shape::Composite(a), b, _) => over(a, b, buffers),
        (a, Shape::Composite(b), _) => under(a, b, buffers),
        _ => {
            debug_assert!(false, "one of the shapes is composite");
            0.0
        }
    }
}

/// What takes the place of a closed convex surface: the solid that it bounds. Not if the other shape is inside, nor if its facets have
/// materials of their own.
fn solid<'a>(
    shape: &'a Shape,
    other: &Shape,
    pose: &Pose,
    look: Look<'_>,
    side: usize,
) -> Option<&'a Composite<Shape>> {
    let Shape::Composite(composite) = shape else { return None };
    let solid = composite.solid().filter(|_| look.groups[side].is_empty())?;
    if look.ground[1 - side] && !look.ground[side] {
        return Some(solid);
    }
    let Shape::Hull(hull) = only_part(solid, shape) else { return None };
    let size = other.ball_around().1;
    let is_inside = || {
        let around = other.local_box(pose);
        let (center, half) = (around.center(), around.half());
        // What does not move may be a room. The centre of what is in it stays there.
        let deep = if look.ground[side] { 0.0 } else { CORE_SHARE };
        hull.contains(center, |normal| deep * normal.abs().dot(half))
    };
    let can_be_inside = size < shape.ball_around().1;
    (!can_be_inside || !is_inside()).then_some(solid)
}

/// The shape of the only part of a solid at the origin.
fn only_part<'a>(solid: &'a Composite<Shape>, without: &'a Shape) -> &'a Shape {
    solid.solids().first().map_or(without, |(_, shape)| shape)
}

/// Calls `f` with a shape that is to be collided with the parts of a composite.
fn with_other<R>(composite: &Composite<Shape>, other: &Shape, f: impl FnOnce(&Convex) -> R) -> R {
    match composite.surface() {
        Some(_) => with_convex(other, f),
        None => f(&Convex::of(other)),
    }
}

/// Two composites: each part of the second that is near the first against all of the first. The first is the larger one: the other
/// cannot enclose it, and so what it bounds, if it is closed, is solid to it.
fn collide_both(
    [large, small]: [&Composite<Shape>; 2],
    pose: &Pose,
    look: Look<'_>,
    alone: bool,
    on_composite: bool,
    buffers: &mut PartBuffers,
) -> f32 {
    let (bounds, inverse) = (large.tree().bounds(), pose.inverse());
    let around = bounds.rotated(inverse.rotation);
    let near = Aabb { min: around.min + inverse.position, max: around.max + inverse.position };
    let mut parts = Vec::new();
    small.tree().query(&near.grown(look.prediction + look.motion.length()), |part| parts.push(part));
    // Parts that are not near are beyond what was looked at.
    let beyond =
        if parts.len() < small.len() { look.prediction + look.motion.length() } else { f32::INFINITY };
    let skin = |part: u32| {
        let surface = small.surface().filter(|surface| surface.outward() != 0.0)?;
        let outward = pose.rotation.rotate(face_normal(surface.corners(part))?) * surface.outward();
        Some(Skin { surface, around: small.tree().bounds(), outward })
    };
    parts.iter().fold(beyond, |gap, part| {
        let pass = |other: &Shape, pose: &Pose, skin, buffers: &mut PartBuffers| {
            let (name, other_group) = (part + 1, look.group(1, *part));
            with_other(large, other, |other| {
                let pass = Pass::new(large, other, pose, look, alone);
                Pass { name, other_group, on_composite, skin, ..pass }.collide(buffers)
            })
        };
        let here = match small.part(*part) {
            Part::Facet(facet) => pass(&Shape::from(facet), pose, skin(*part), buffers),
            Part::Solid(at, solid) => pass(solid, &pose.then(at), None, buffers),
        };
        min(gap, here)
    })
}
