//! How long shapes take to make: `cargo bench -p avian_kernel3d --bench making`.

#[cfg_attr(feature = "2d", path = "making2.rs")]
#[cfg_attr(feature = "3d", path = "making3.rs")]
mod dim;
#[allow(unused, reason = "only random numbers are used")]
#[path = "mod.rs"]
mod measure;

use crate::kernel;
use kernel::math::{Pose, Rot, Vector};
use kernel::shape::{Cuboid, Shape, Surface};
use measure::pairs::Dice;
use std::time::Instant;

/// Prints the fastest of some rounds, in milliseconds.
fn time<T>(what: &str, mut make: impl FnMut() -> T) {
    let best = (0..40).fold(f64::INFINITY, |best, _| {
        let start = Instant::now();
        let made = make();
        let seconds = start.elapsed().as_secs_f64();
        drop(core::hint::black_box(made));
        best.min(seconds)
    });
    println!("{what:<40} {:9.4} ms", best * 1e3);
}

pub fn main() {
    let wanted = std::env::args().nth(1).filter(|name| !name.starts_with('-'));
    let time = |what: &str, make: &mut dyn FnMut() -> Shape| {
        if wanted.as_ref().is_none_or(|wanted| what.contains(wanted.as_str())) {
            time(what, make);
        }
    };
    let mut dice = Dice::new(5);
    let field = dim::field(&mut dice);
    time("height field", &mut || Shape::surface(dim::surface_of_field(field.clone())));
    let facets: Vec<_> = {
        let surface = dim::surface_of_field(field.clone());
        (0..dim::FACETS).map(|facet| surface.corners(facet)).collect()
    };
    // As files have them: each facet with its own corners.
    time("the same as a mesh", &mut || {
        let vertices: Vec<Vector> = facets.iter().copied().flatten().collect();
        let mut index = 0..vertices.len() as u32;
        let facets = facets.iter().map(|facet| facet.map(|_| index.next().unwrap_or(0))).collect();
        Shape::surface(Surface::new(vertices, facets).expect("a surface"))
    });
    let boxes: Vec<_> = (0..1000)
        .map(|_| {
            let solid = Shape::Cuboid(Cuboid { half: Vector::ONE * 0.5 });
            (Pose { position: dice.vector(10.0), rotation: Rot::IDENTITY }, solid)
        })
        .collect();
    time("1000 boxes", &mut || Shape::compound(boxes.clone()).expect("a compound"));
    let points: Vec<Vector> = (0..32).map(|_| dice.direction()).collect();
    time("hull of 32 points", &mut || Shape::Hull(dim::hull(&points).into()));
    let hull = dim::hull(&points);
    time("the same from its faces", &mut || Shape::Hull(dim::again(&hull).into()));
}
