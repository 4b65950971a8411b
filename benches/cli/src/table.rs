//! Reports as tables in Markdown.

use std::fmt::Write as _;

use bench_core::{
    engine::Share,
    measure::{Report, middle, sum_of},
    scene::Family,
};

use crate::runner::BARE;

/// The engines in the order of columns and pictures.
pub const ENGINES: [&str; 5] = ["ours", "box2d", "box3d", "rapier", "avian"];

/// The display name of an engine.
pub fn shown(engine: &str) -> &str {
    match engine {
        "ours" => "this",
        "box2d" => "Box2D",
        "box3d" => "Box3D",
        "rapier" => "Rapier",
        "avian" => "Avian",
        _ => engine,
    }
}

/// Runs with the same scene, engine and number of threads, in the order of the first of each.
#[derive(Clone)]
pub struct Cell<'a> {
    /// One of the runs.
    pub first: &'a Report,
    /// All runs.
    pub runs: Vec<&'a Report>,
}

impl Cell<'_> {
    /// The median of a number over the runs.
    pub fn middle(&self, number: impl Fn(&Report) -> f64) -> f64 {
        middle(self.runs.iter().map(|run| number(run)).collect())
    }

    /// The median of the runs' mean times, in milliseconds.
    pub fn mean(&self) -> f64 {
        self.middle(|run| run.mean)
    }

    fn is_like(&self, other: &Report) -> bool {
        self.is_beside(other) && self.first.engine == other.engine
    }

    /// Whether it is of a family.
    pub fn is(&self, dim: u32, family: Family, threads: usize) -> bool {
        let Report { dim: own, family: of, threads: with, .. } = self.first;
        (*own, *of, *with) == (dim, family, threads)
    }

    /// Whether two differ only in the engine.
    pub fn is_beside(&self, other: &Report) -> bool {
        let key = |r: &Report| (r.dim, r.scene.clone(), r.threads);
        key(self.first) == key(other)
    }
}

/// The cell of an engine.
pub fn engine_cell<'a, 'b>(
    mut cells: impl Iterator<Item = &'b Cell<'a>>,
    engine: &str,
) -> Option<&'b Cell<'a>>
where
    'a: 'b,
{
    cells.find(|cell| cell.first.engine == engine)
}

/// The time of the fastest peer, in milliseconds.
pub fn best_peer<'a: 'b, 'b>(cells: impl Iterator<Item = &'b Cell<'a>>) -> Option<f64> {
    let peers = cells.filter(|cell| !cell.first.engine.starts_with("ours") && cell.first.engine != BARE);
    peers.map(Cell::mean).min_by(f64::total_cmp)
}

/// Groups repeated runs. Runs with timed stages count only if there are no others.
pub fn cells(reports: &[Report], staged: bool) -> Vec<Cell<'_>> {
    let mut cells: Vec<Cell> = Vec::new();
    for report in reports.iter().filter(|report| report.stages.is_empty() != staged) {
        match cells.iter_mut().find(|cell| cell.is_like(report)) {
            Some(cell) => cell.runs.push(report),
            None => cells.push(Cell { first: report, runs: vec![report] }),
        }
    }
    cells
}

/// One row per scene, number of threads and engine, with all measures of the final state.
pub fn markdown(reports: &[Report], baseline: Option<&str>) -> String {
    let (plain, staged) = (cells(reports, false), cells(reports, true));
    let all: Vec<Cell> = plain.into_iter().chain(staged).collect();
    let base = baseline.unwrap_or("first");
    let mut out = format!(
        "| scene | threads | engine | runs | mean ms | median | p95 | / {base} | drift | overlap max / mean | joint error | awake / dynamic | speed max / mean | escaped | passed | NaN | others |\n\
         |---|--:|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n"
    );
    for cell in &all {
        let beside = all.iter().filter(|other| other.is_beside(cell.first));
        let compared = beside.clone().find(|other| Some(other.first.engine.as_str()) == baseline);
        let compared = if baseline.is_none() { beside.clone().next() } else { compared };
        let ratio = compared.map_or(f64::NAN, |other| cell.mean() / other.mean());
        row(&mut out, cell, ratio);
    }
    out
}

fn row(out: &mut String, cell: &Cell, ratio: f64) {
    let Report { dim, scene, threads, engine, .. } = cell.first;
    let (mean, median, p95) = (cell.mean(), cell.middle(|r| r.median), cell.middle(|r| r.p95));
    let others = cell.runs.iter().map(|r| r.foreign).fold(0.0, f64::max);
    let _ = writeln!(
        out,
        "| {dim}d/{scene} | {threads} | {engine} | {} | {mean:.4} | {median:.4} | {p95:.4} | {ratio:.2} | {} | {others:.2} |",
        cell.runs.len(),
        quality(cell.first, mean)
    );
}

/// The columns of the final state.
fn quality(report: &Report, mean: f64) -> String {
    let q = &report.quality;
    let drift = q.drift.map_or("–".to_owned(), |drift| format!("{drift:.3}"));
    let passed = q.passed.map_or("–".to_owned(), |passed| passed.to_string());
    let (awake, speed) = match (q.hits, q.mean_hit) {
        (Some(hits), Some(far)) => {
            let rate = report.batch as f64 / mean / 1e3;
            (format!("{hits} hits at {far:.4}"), format!("{rate:.2} M queries/s"))
        }
        _ => (format!("{} / {}", q.awake, q.dynamic), format!("{:.2} / {:.3}", q.max_speed, q.mean_speed)),
    };
    format!(
        "{drift} | {:.4} / {:.4} | {:.4} | {awake} | {speed} | {} | {passed} | {}",
        q.max_overlap, q.mean_overlap, q.max_joint_error, q.escaped, q.not_finite
    )
}

/// Where the time of a step goes: the shares of kernel, ECS and Bevy, every stage, and the
/// engine's own timers.
pub fn stage_lines(reports: &[Report]) -> String {
    let mut out = String::new();
    for cell in cells(reports, true) {
        let Report { dim, scene, engine, threads, mean, stages, .. } = cell.first;
        let list = |own: bool| {
            let some = stages.iter().filter(|s| (s.share == Share::Own) == own);
            some.map(|s| format!("{} {:.3}", s.name, s.ms)).collect::<Vec<_>>().join(", ")
        };
        let [kernel, ecs, bevy] = [Share::Kernel, Share::Ecs, Share::Bevy].map(|share| sum_of(stages, share));
        let _ = writeln!(out, "- {dim}d/{scene} {engine}, threads {threads}, {mean:.3} ms");
        if kernel + ecs + bevy > 0.0 {
            let _ = writeln!(out, "  - kernel {kernel:.3}, ECS {ecs:.3}, Bevy {bevy:.3}: {}", list(false));
        }
        let _ = writeln!(out, "  - own timers: {}", list(true));
    }
    out
}
