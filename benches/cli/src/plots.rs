//! Reports as SVG pictures, with the fonts of the viewer.

use std::error::Error;

use plotters::{
    coord::Shift,
    prelude::*,
    style::text_anchor::{HPos, Pos, VPos},
};

use bench_core::scene::Family;

use crate::table::{Cell, ENGINES, best_peer, engine_cell, shown};

const FONT: &str = "sans-serif";
const GREY: RGBColor = RGBColor(110, 110, 110);
/// Colours that people with any colour vision tell apart (M. Okabe and K. Ito, "Color Universal
/// Design", 2008).
const COLOURS: [(&str, RGBColor); 5] = [
    ("ours", RGBColor(0, 114, 178)),
    ("box2d", RGBColor(230, 159, 0)),
    ("box3d", RGBColor(230, 159, 0)),
    ("rapier", RGBColor(0, 158, 115)),
    ("avian", RGBColor(204, 121, 167)),
];

type Picture<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Done = Result<(), Box<dyn Error>>;

/// A picture of that size, as text.
fn picture(size: (u32, u32), draw: impl FnOnce(&Picture) -> Done) -> Result<String, String> {
    let mut svg = String::new();
    {
        let root = SVGBackend::with_string(&mut svg, size).into_drawing_area();
        let drawn = root.fill(&WHITE).map_err(Into::into).and_then(|()| draw(&root));
        drawn.and_then(|()| Ok(root.present()?)).map_err(|e| e.to_string())?;
    }
    svg.push('\n');
    Ok(svg)
}

fn colour(engine: &str) -> RGBColor {
    COLOURS.iter().find(|known| known.0 == engine).map_or(GREY, |known| known.1)
}

/// The engines that ran, in the order of the pictures.
fn engines_of<'a>(cells: &[Cell<'a>]) -> Vec<&'a str> {
    let mut engines: Vec<&str> = Vec::new();
    for engine in ENGINES {
        let cell = cells.iter().find(|cell| cell.first.engine == engine);
        engines.extend(cell.map(|cell| cell.first.engine.as_str()));
    }
    engines
}

fn draw_text(root: &Picture, text: &str, at: (i32, i32), size: i32, anchor: HPos) -> Done {
    let style = (FONT, size).into_font().color(&BLACK).pos(Pos::new(anchor, VPos::Center));
    Ok(root.draw_text(text, &style, at)?)
}

fn draw_legend(root: &Picture, engines: &[&str], (mut x, y): (i32, i32)) -> Done {
    for engine in engines {
        root.draw(&Rectangle::new([(x, y - 6), (x + 12, y + 6)], colour(engine).filled()))?;
        draw_text(root, shown(engine), (x + 17, y), 14, HPos::Left)?;
        x += 110;
    }
    Ok(())
}

/// Time of a step in every scene of family speed, as a multiple of the best peer's.
pub fn bars(cells: &[Cell], dim: u32, threads: usize) -> Result<String, String> {
    /// Maximum length of a bar. A number on top gives the value of longer ones.
    const TOP: f64 = 5.0;
    let cells: Vec<Cell> = cells.iter().filter(|c| c.is(dim, Family::Speed, threads)).cloned().collect();
    let mut scenes: Vec<&str> = cells.iter().map(|cell| cell.first.scene.as_str()).collect();
    scenes.dedup();
    let engines = engines_of(&cells);
    picture((140 + 110 * scenes.len().max(4) as u32, 360), |root| {
        let title = format!("{dim}D, {}: time of a step / the best peer's", count(threads));
        draw_text(root, &title, (10, 16), 16, HPos::Left)?;
        draw_legend(root, &engines, (10, 40))?;
        let mut chart = ChartBuilder::on(root)
            .margin_top(64)
            .margin_right(10)
            .margin_bottom(34)
            .set_label_area_size(LabelAreaPosition::Left, 34)
            .build_cartesian_2d(0.0..scenes.len() as f64, 0.0..TOP)?;
        let style = (FONT, 12).into_font().color(&GREY);
        chart
            .configure_mesh()
            .disable_x_mesh()
            .x_labels(0)
            .y_labels(6)
            .light_line_style(WHITE)
            .y_label_style(style)
            .y_label_formatter(&|y| format!("{y:.0}"))
            .draw()?;
        let width = 0.84 / engines.len().max(1) as f64;
        let mut ratios = Vec::new();
        for (index, scene) in scenes.iter().enumerate() {
            let beside: Vec<&Cell> = cells.iter().filter(|c| c.first.scene == *scene).collect();
            let best = best_peer(beside.iter().copied()).unwrap_or(f64::NAN);
            for (place, engine) in engines.iter().enumerate() {
                let Some(cell) = engine_cell(beside.iter().copied(), engine) else {
                    continue;
                };
                let (left, ratio) = (index as f64 + 0.08 + width * place as f64, cell.mean() / best);
                if !ratio.is_finite() {
                    continue;
                }
                let (right, top) = (left + 0.9 * width, ratio.min(TOP));
                let bar = Rectangle::new([(left, 0.0), (right, top)], colour(engine).filled());
                chart.draw_series([bar])?;
                ratios.push((format!("{ratio:.1}"), chart.backend_coord(&(0.5 * (left + right), top))));
            }
            let (x, y) = chart.backend_coord(&(index as f64 + 0.5, 0.0));
            draw_text(root, scene, (x, y + 16), 13, HPos::Center)?;
        }
        chart.draw_series(LineSeries::new([(0.0, 1.0), (scenes.len() as f64, 1.0)], BLACK))?;
        for (ratio, (x, y)) in ratios {
            // The line at 1 would cross the text above bars of 0.9.
            root.draw(&Rectangle::new([(x - 8, y - 12), (x + 8, y - 2)], WHITE.filled()))?;
            draw_text(root, &ratio, (x, y - 7), 11, HPos::Center)?;
        }
        Ok(())
    })
}

/// Time of a step over the number of bodies, both axes logarithmic.
pub fn growth(cells: &[Cell], dim: u32, threads: usize) -> Result<String, String> {
    let cells: Vec<Cell> = cells.iter().filter(|c| c.is(dim, Family::Growth, threads)).cloned().collect();
    let engines = engines_of(&cells);
    let times = || cells.iter().map(|cell| cell.mean());
    let (low, high) = (times().fold(f64::MAX, f64::min), times().fold(0.0, f64::max));
    picture((720, 460), |root| {
        let title = format!(
            "{dim}D, {}: milliseconds per step over the number of bodies, pyramids of 55 boxes",
            count(threads)
        );
        draw_text(root, &title, (10, 16), 15, HPos::Left)?;
        draw_legend(root, &engines, (10, 40))?;
        if cells.is_empty() {
            return Ok(());
        }
        let mut chart = ChartBuilder::on(root)
            .margin_top(64)
            .margin_right(24)
            .set_label_area_size(LabelAreaPosition::Left, 56)
            .set_label_area_size(LabelAreaPosition::Bottom, 30)
            .build_cartesian_2d((80.0..70_000.0).log_scale(), (0.8 * low..1.3 * high).log_scale())?;
        let style = (FONT, 12).into_font().color(&GREY);
        chart
            .configure_mesh()
            .light_line_style(RGBColor(240, 240, 240))
            .label_style(style)
            .x_label_formatter(&|x| format!("{x:.0}"))
            .y_label_formatter(&|y| if *y < 1.0 { format!("{y:.2}") } else { format!("{y:.0}") })
            .draw()?;
        for engine in &engines {
            let own = cells.iter().filter(|cell| cell.first.engine == *engine);
            let points: Vec<(f64, f64)> = own.map(|cell| (cell.first.bodies as f64, cell.mean())).collect();
            chart.draw_series(LineSeries::new(points.iter().copied(), colour(engine).stroke_width(2)))?;
            chart.draw_series(points.iter().map(|at| Circle::new(*at, 3, colour(engine).filled())))?;
        }
        Ok(())
    })
}

fn count(threads: usize) -> String {
    if threads == 1 { "1 thread".to_owned() } else { format!("{threads} threads") }
}
