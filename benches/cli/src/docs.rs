//! Writes the page of benchmarks and its pictures, from the results.

use std::{fmt::Write as _, path::Path};

use bench_core::{
    chains::Strain,
    engine::{SHARED, Share, Stage},
    measure::{Report, sum_of},
    scene::Family,
};

use crate::{
    plots,
    results::{Results, write},
    runner::BARE,
    table::{Cell, ENGINES, best_peer, cells, engine_cell, shown},
};

/// Writes `benchmarks.md` and `benchmarks/*.svg` into a folder.
pub fn write_all(results: &Results, folder: &Path) -> Result<(), String> {
    let plain = cells(&results.reports, false);
    let threads = threads(&plain);
    let mut page = head(results);
    for dim in [2, 3] {
        if !plain.iter().any(|cell| cell.first.dim == dim) {
            continue;
        }
        let _ = writeln!(page, "## {dim}D\n");
        speed(&mut page, &plain, dim, &threads, folder)?;
        quality(&mut page, &plain, dim);
        growth(&mut page, &plain, dim, &threads, folder)?;
        still(&mut page, &plain, dim);
        bulk(&mut page, &plain, dim);
        chains(&mut page, &plain, dim);
        queries(&mut page, &plain, dim);
        stages(&mut page, &cells(&results.reports, true), dim);
        serial(&mut page, &cells(&results.reports, true), dim);
    }
    write(&folder.join("benchmarks.md"), &page)?;
    println!("{}", folder.join("benchmarks.md").display());
    Ok(())
}

fn threads(cells: &[Cell]) -> Vec<usize> {
    let mut threads: Vec<usize> = cells.iter().map(|cell| cell.first.threads).collect();
    threads.sort_unstable();
    threads.dedup();
    threads
}

fn head(results: &Results) -> String {
    let others = results.reports.iter().map(|r| r.foreign).fold(0.0, f64::max);
    let runs = results.reports.len();
    let mut page = format!(
        "<!-- Made by `cargo run --release -- docs` in benches/. -->\n\n\
         # Benchmarks\n\n\
         The same scenes from the same code on every engine, each run in a process of its own, pinned to as many cores as the \
         engine had threads, engines interleaved, on one machine. Times are the middle of the runs' mean times of a step, in \
         milliseconds; of Avian and of this engine they are those of the whole `App::update`. How, and how to run it: \
         [benches/README.md](../benches/README.md). Medians, later runs and costs of parts: \
         [notes](benchmarks/notes.md).\n\n\
         {runs} runs; other processes used at most {others:.2} of a core during any of them.\n\n| | |\n|---|---|\n"
    );
    for (name, value) in &results.facts {
        let _ = writeln!(page, "| {name} | {value} |");
    }
    page.push('\n');
    page
}

/// Engines that ran in some cells, in the order of the columns.
fn columns(cells: &[&Cell]) -> Vec<&'static str> {
    ENGINES.into_iter().filter(|engine| cells.iter().any(|cell| cell.first.engine == *engine)).collect()
}

/// A table with a row per scene and number of threads and a column per engine. `extra` are names of columns
/// at the end, which `row` fills.
fn table<'a>(
    page: &mut String,
    cells: &[&'a Cell<'a>],
    extra: &[&str],
    mut row: impl FnMut(&[&'a Cell<'a>], &[&'static str]) -> Vec<String>,
) {
    let columns = columns(cells);
    let names: Vec<&str> = columns.iter().map(|engine| shown(engine)).chain(extra.iter().copied()).collect();
    let _ = writeln!(page, "| scene | bodies | threads | {} |", names.join(" | "));
    let _ = writeln!(page, "|---|--:|--:|{}", "--:|".repeat(names.len()));
    let mut done = Vec::new();
    for cell in cells {
        let Report { scene, threads, bodies, .. } = cell.first;
        if done.contains(&(scene, threads)) {
            continue;
        }
        done.push((scene, threads));
        let beside: Vec<&Cell> = cells.iter().copied().filter(|c| c.is_beside(cell.first)).collect();
        let _ = writeln!(page, "| {scene} | {bodies} | {threads} | {} |", row(&beside, &columns).join(" | "));
    }
    page.push('\n');
}

/// Three digits, more or less.
fn ms(number: f64) -> String {
    match number {
        n if !n.is_finite() => "–".to_owned(),
        n if n >= 100.0 => format!("{n:.0}"),
        n if n >= 10.0 => format!("{n:.1}"),
        n if n >= 0.1 => format!("{n:.2}"),
        n => format!("{n:.4}"),
    }
}

fn mean_of(beside: &[&Cell], engine: &str) -> f64 {
    engine_cell(beside.iter().copied(), engine).map_or(f64::NAN, Cell::mean)
}

fn of<'a>(cells: &'a [Cell<'a>], dim: u32, family: Family) -> Vec<&'a Cell<'a>> {
    cells.iter().filter(|cell| cell.first.dim == dim && cell.first.family == family).collect()
}

fn speed(
    page: &mut String,
    cells: &[Cell],
    dim: u32,
    threads: &[usize],
    folder: &Path,
) -> Result<(), String> {
    let chosen = of(cells, dim, Family::Speed);
    if chosen.is_empty() {
        return Ok(());
    }
    let _ = writeln!(page, "### Where much moves\n");
    for &count in threads {
        let name = format!("{dim}d_threads_{count}.svg");
        write(&folder.join("benchmarks").join(&name), &plots::bars(cells, dim, count)?)?;
        let _ =
            writeln!(page, "![Times of steps against the best peer, threads: {count}](benchmarks/{name})\n");
    }
    table(page, &chosen, &["this / best peer", "Avian / this"], |beside, columns| {
        let ours = mean_of(beside, "ours");
        let times = columns.iter().map(|engine| ms(mean_of(beside, engine)));
        let peer = best_peer(beside.iter().copied()).unwrap_or(f64::NAN);
        let ratios = [ours / peer, mean_of(beside, "avian") / ours];
        times
            .chain(ratios.map(|ratio| if ratio.is_finite() { format!("{ratio:.2}") } else { "–".to_owned() }))
            .collect()
    });
    Ok(())
}

fn quality(page: &mut String, cells: &[Cell], dim: u32) {
    let all = of(cells, dim, Family::Speed);
    let fewest = all.iter().map(|cell| cell.first.threads).min();
    let chosen: Vec<&Cell> = all.into_iter().filter(|cell| Some(cell.first.threads) == fewest).collect();
    if chosen.is_empty() {
        return;
    }
    let _ = writeln!(
        page,
        "How the worlds stood at the end, judged by one ruler: deepest and mean overlap in millimetres, and, where it \
         applies, how far the top of the last pyramid had moved, the widest gap of a joint, and how many bodies had escaped, \
         had passed through something static, or were not finite. The last column: deepest overlap and way of the top against \
         the least of any peer's; up to 1 this engine's worlds stand no worse than the best of the others'.\n"
    );
    table(page, &chosen, &["this / best peer"], |beside, columns| {
        let said = |engine: &&str| engine_cell(beside.iter().copied(), engine).map_or("–".to_owned(), judged);
        columns.iter().map(said).chain([against_peers(beside)]).collect()
    });
}

/// This engine's deepest overlap, and the displacement of a pyramid's top, relative to the least
/// of any peer's.
fn against_peers(beside: &[&Cell]) -> String {
    let Some(ours) = engine_cell(beside.iter().copied(), "ours") else { return "–".to_owned() };
    let ratio = |measure: fn(&Cell) -> Option<f32>| {
        let peers = beside.iter().filter(|cell| cell.first.engine != "ours");
        let least = peers.filter_map(|cell| measure(cell)).reduce(f32::min)?;
        (least > 0.0).then_some(format!("{:.2}", measure(ours)? / least))
    };
    let overlap = ratio(|cell| Some(cell.first.quality.max_overlap));
    let ratios: Vec<_> = [overlap, ratio(|cell| cell.first.quality.drift)].into_iter().flatten().collect();
    if ratios.is_empty() { "–".to_owned() } else { ratios.join(", ") }
}

fn judged(cell: &Cell) -> String {
    let q = &cell.first.quality;
    let mut text = format!("{:.1} / {:.2}", 1e3 * q.max_overlap, 1e3 * q.mean_overlap);
    if let Some(drift) = q.drift {
        let _ = write!(text, ", moved {drift:.2} m");
    }
    if q.max_joint_error > 0.0 {
        let _ = write!(text, ", gap {:.0} mm", 1e3 * q.max_joint_error);
    }
    if q.escaped > 0 {
        let _ = write!(text, ", **{} escaped**", q.escaped);
    }
    if let Some(passed) = q.passed.filter(|passed| *passed > 0) {
        let _ = write!(text, ", **{passed} passed**");
    }
    if q.not_finite > 0 {
        let _ = write!(text, ", **{} not finite**", q.not_finite);
    }
    text
}

fn growth(
    page: &mut String,
    cells: &[Cell],
    dim: u32,
    threads: &[usize],
    folder: &Path,
) -> Result<(), String> {
    if of(cells, dim, Family::Growth).is_empty() {
        return Ok(());
    }
    let _ = writeln!(page, "### More and more bodies\n");
    for &count in threads {
        let name = format!("{dim}d_growth_threads_{count}.svg");
        write(&folder.join("benchmarks").join(&name), &plots::growth(cells, dim, count)?)?;
        let _ = writeln!(page, "![Time over the number of bodies, threads: {count}](benchmarks/{name})\n");
    }
    Ok(())
}

/// For engines in Bevy, their time minus that of the App without physics.
fn still(page: &mut String, cells: &[Cell], dim: u32) {
    let chosen: Vec<&Cell> =
        of(cells, dim, Family::Idle).into_iter().chain(of(cells, dim, Family::Small)).collect();
    if chosen.is_empty() {
        return;
    }
    let _ = writeln!(
        page,
        "### Where little moves\n\nOf Avian and this engine: what a step takes more than an update of the same App without \
         physics, which is the last column.\n"
    );
    table(page, &chosen, &["App alone"], |beside, columns| {
        let bare = mean_of(beside, BARE);
        let more = |engine: &&str| {
            let in_bevy = ["avian", "ours"].contains(engine) && bare.is_finite();
            ms(mean_of(beside, engine) - if in_bevy { bare } else { 0.0 })
        };
        columns.iter().map(more).chain([ms(bare)]).collect()
    });
}

fn bulk(page: &mut String, cells: &[Cell], dim: u32) {
    let chosen = of(cells, dim, Family::Bulk);
    if chosen.is_empty() {
        return;
    }
    let _ = writeln!(
        page,
        "### A level comes and goes\n\nMilliseconds for all of it, with the step that follows.\n"
    );
    table(page, &chosen, &["App alone"], |beside, columns| {
        let all = columns.iter().copied().chain([BARE]);
        all.map(|engine| ms(mean_of(beside, engine))).collect()
    });
}

/// How well chains with a weight hold.
fn chains(page: &mut String, cells: &[Cell], dim: u32) {
    let chosen = of(cells, dim, Family::Joints);
    if chosen.is_empty() {
        return;
    }
    let _ = writeln!(
        page,
        "### Chains\n\n30 links of 1 kg and 1 m with a weight of so many kg at the end, for ten seconds: *chain* hangs, *swing* is let go level. \
         Milliseconds a step; the widest gap of a joint in any step; of what hangs, by how much it is longer at the end; the most energy above that \
         of the start, without that of rotation, for each kg of the weight.\n"
    );
    table(page, &chosen, &[], |beside, columns| {
        let said =
            |engine: &&str| engine_cell(beside.iter().copied(), engine).map_or("–".to_owned(), strained);
        columns.iter().map(said).collect()
    });
}

fn strained(cell: &Cell) -> String {
    let q = &cell.first.quality;
    let Some(Strain { widest, stretch, gained }) = q.strain else { return "–".to_owned() };
    if q.not_finite > 0 {
        return "**not finite**".to_owned();
    }
    let longer = match cell.first.scene.starts_with("chain") {
        true => format!(", {:.3} % longer", 100.0 * stretch),
        false => String::new(),
    };
    format!("{} ms, gap {:.1} mm{longer}, {gained:.2} J", ms(cell.mean()), 1e3 * widest)
}

fn queries(page: &mut String, cells: &[Cell], dim: u32) {
    let chosen = of(cells, dim, Family::Queries);
    if chosen.is_empty() {
        return;
    }
    let _ = writeln!(page, "### Queries\n\nMillions a second.\n");
    table(page, &chosen, &[], |beside, columns| {
        let rate = |engine: &&str| beside[0].first.batch as f64 / mean_of(beside, engine) / 1e3;
        columns.iter().map(|engine| ms(rate(engine))).collect()
    });
}

fn stages(page: &mut String, staged: &[Cell], dim: u32) {
    let in_bevy = |cell: &&Cell| sum_of(&cell.first.stages, Share::Ecs) > 0.0 && cell.first.dim == dim;
    let chosen: Vec<&Cell> = staged.iter().filter(in_bevy).collect();
    let Some(first) = chosen.first() else {
        return;
    };
    let _ = writeln!(
        page,
        "### Where a step goes\n\nThe shares of the simulation (*kernel*), of reading and writing components and looking for \
         changes (*ECS*) and of Bevy around it, by clocks between the public system sets. These runs are not those of the \
         tables above. Italic: ECS and Bevy.\n"
    );
    let parts = || first.first.stages.iter().filter(|stage| stage.share != Share::Own);
    let title = |s: &Stage| if s.share == Share::Kernel { s.name.clone() } else { format!("*{}*", s.name) };
    let names: Vec<String> = parts().map(title).collect();
    let _ = writeln!(
        page,
        "| scene | threads | engine | all | kernel | *ECS* | *Bevy* | {} |",
        names.join(" | ")
    );
    let _ = writeln!(page, "|---|--:|---|{}", "--:|".repeat(4 + names.len()));
    for cell in chosen {
        let Report { scene, threads, engine, mean, stages, .. } = cell.first;
        let shares = [Share::Kernel, Share::Ecs, Share::Bevy].map(|share| ms(sum_of(stages, share)));
        let own: Vec<String> = stages.iter().filter(|s| s.share != Share::Own).map(|s| ms(s.ms)).collect();
        let (engine, mean, shares) = (shown(engine), ms(*mean), shares.join(" | "));
        let _ =
            writeln!(page, "| {scene} | {threads} | {engine} | {mean} | {shares} | {} |", own.join(" | "));
    }
    page.push('\n');
}

/// Single-threaded time per step, from runs with several threads whose shared time the engine counted.
fn serial(page: &mut String, staged: &[Cell], dim: u32) {
    let ours = || staged.iter().filter(|cell| cell.first.dim == dim && cell.first.engine == "ours");
    let rows: Vec<_> = ours()
        .filter(|cell| cell.first.threads > 1)
        .filter_map(|cell| {
            let of = |name| cell.first.stages.iter().find(|stage| stage.name == name).map(|stage| stage.ms);
            let alone = ours().find(|one| one.first.threads == 1 && one.first.scene == cell.first.scene)?;
            Some((cell.first, alone.first.mean, of(SHARED)?))
        })
        .collect();
    if rows.is_empty() {
        return;
    }
    let _ = writeln!(
        page,
        "### What one thread does alone\n\nMilliseconds of a step for which only one thread works, in a run with several, and \
         their share of the step on one thread. It bounds what more cores can give: with a share s, no more than 1/s. \
         *Bevy* is its part around physics.\n\n\
         | scene | threads | step on one thread | alone | *Bevy* | share | with *Bevy* |\n|---|--:|--:|--:|--:|--:|--:|"
    );
    for (Report { scene, threads, stages, .. }, one, shared) in rows {
        let [kernel, ecs, bevy] = [Share::Kernel, Share::Ecs, Share::Bevy].map(|share| sum_of(stages, share));
        let alone = kernel + ecs - shared;
        let percent = |time: f64| format!("{:.0} %", 100.0 * time / one);
        let times = [one, alone, bevy].map(ms).join(" | ");
        let _ = writeln!(
            page,
            "| {scene} | {threads} | {times} | {} | {} |",
            percent(alone),
            percent(alone + bevy)
        );
    }
    page.push('\n');
}
