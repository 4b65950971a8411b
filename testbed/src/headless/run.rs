//! Runs scenes one after the other.

use std::io;
use std::path::Path;
use std::time::Instant;

use super::progress::Progress;
use super::table::{self, Row};
use crate::args::Args;
use crate::draw;
use crate::sim::{Entry, Simulation};

/// Pixels of a picture.
const PIXELS: f32 = 1.6e6;

/// Runs the chosen scenes, prints a line for each and writes its picture. `Err` if pictures
/// cannot be written.
pub fn tour(args: &Args, entries: &[Entry]) -> io::Result<()> {
    std::fs::create_dir_all(&args.out)?;
    let mut progress = Progress::new(entries.len());
    println!("{}", table::head());
    for entry in entries {
        let Some(mut simulation) = (entry.start)(entry.name) else { continue };
        let steps = args.steps.unwrap_or(entry.steps);
        let row = run(entry, simulation.as_mut(), steps, &mut progress);
        let path = args.out.join(format!("{}d_{}.png", entry.dimension, entry.name));
        picture(entry, simulation.as_mut(), &path)?;
        println!("{}", table::row(&row));
    }
    println!();
    println!(
        "drift: \"moved\" is the longest way of a body that ought to rest, \"outside\" how far the outermost body"
    );
    println!("is outside the scene. Pictures are in {}.", args.out.display());
    Ok(())
}

fn run(entry: &Entry, simulation: &mut dyn Simulation, steps: u32, progress: &mut Progress) -> Row {
    let label = format!("{}d/{}", entry.dimension, entry.name);
    let mut times = Vec::with_capacity(steps as usize);
    for step in 0..steps {
        progress.step(&label, step, steps);
        let start = Instant::now();
        simulation.step();
        times.push(start.elapsed().as_secs_f64() * 1e3);
    }
    // The first step is left out, as in published benchmarks: all its contacts are new.
    if times.len() > 1 {
        times.remove(0);
    }
    let (counts, measures) = (simulation.counts(), simulation.measures());
    progress.finish(&label, steps);
    Row { dimension: entry.dimension, name: entry.name, drift: entry.drift, times, counts, measures }
}

fn picture(entry: &Entry, simulation: &mut dyn Simulation, path: &Path) -> io::Result<()> {
    let (width, height) = picture_size(entry);
    draw::draw(&simulation.drawables(), entry.view, entry.dimension == 2, width, height).save(path)
}

/// 3D pictures are 16 by 10; 2D pictures have the aspect ratio of the scene, within limits.
fn picture_size(entry: &Entry) -> (usize, usize) {
    let span = entry.view.max - entry.view.min;
    let aspect = if entry.dimension == 2 { (span.x / span.y).clamp(0.6, 4.0) } else { 1.6 };
    let height = (PIXELS / aspect).sqrt();
    ((height * aspect) as usize, height as usize)
}
