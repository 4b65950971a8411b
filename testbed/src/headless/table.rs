//! The table of results.

use crate::sim::{Counts, Measures};

/// One scene's results.
#[derive(Clone, Debug)]
pub struct Row {
    /// 2 or 3.
    pub dimension: u32,
    /// The scene's name.
    pub name: &'static str,
    /// The meaning of its drift.
    pub drift: &'static str,
    /// Milliseconds of each step.
    pub times: Vec<f64>,
    /// Counts at the end.
    pub counts: Counts,
    /// Measures of quality.
    pub measures: Measures,
}

/// Names and widths of the columns.
const COLUMNS: [(&str, usize); 10] = [
    ("scene", 19),
    ("bodies", 8),
    ("contacts", 9),
    ("ms median", 10),
    ("ms p95", 9),
    ("energy J", 12),
    ("drift m", 9),
    ("", 8),
    ("overlap m", 10),
    ("asleep", 8),
];

/// The table's head and a rule below it.
pub fn head() -> String {
    let names = line(COLUMNS.map(|(name, _)| name.to_owned()));
    let rule = "-".repeat(names.len());
    format!("{names}\n{rule}")
}

/// One line of the table.
pub fn row(row: &Row) -> String {
    let mut sorted = row.times.clone();
    sorted.sort_by(f64::total_cmp);
    let time = |share: f64| quantile(&sorted, share).map_or("-".into(), |ms| format!("{ms:.3}"));
    let mut text = line([
        format!("{}d/{}", row.dimension, row.name),
        row.counts.bodies.to_string(),
        row.counts.contacts.map_or("-".into(), |n| n.to_string()),
        time(0.5),
        time(0.95),
        scientific(row.measures.energy),
        format!("{:.4}", row.measures.drift),
        row.drift.to_owned(),
        format!("{:.5}", row.measures.overlap),
        row.counts.asleep.to_string(),
    ]);
    if row.measures.broken > 0 {
        text += &format!("  {} bodies are not at a finite place!", row.measures.broken);
    }
    text
}

/// The value at a share of the sorted values; `None` for an empty list.
fn quantile(sorted: &[f64], share: f64) -> Option<f64> {
    let last = sorted.len().checked_sub(1)?;
    sorted.get((share * last as f64).round() as usize).copied()
}

fn scientific(value: f64) -> String {
    if value.abs() < 1e6 { format!("{value:.1}") } else { format!("{value:.4e}") }
}

/// The first column to the left and the words in the eighth too; numbers to the right.
fn line(cells: [String; COLUMNS.len()]) -> String {
    let mut text = String::new();
    for (i, (cell, (_, width))) in cells.iter().zip(COLUMNS).enumerate() {
        match i {
            0 => text += &format!("{cell:<width$}"),
            7 => text += &format!(" {cell:<w$}", w = width - 1),
            _ => text += &format!("{cell:>width$}"),
        }
    }
    text.trim_end().to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_of_a_hundred_numbers() {
        let numbers: Vec<f64> = (0..=100).map(f64::from).collect();
        assert_eq!(quantile(&numbers, 0.5), Some(50.0));
        assert_eq!(quantile(&numbers, 0.95), Some(95.0));
        assert_eq!(quantile(&[7.0], 0.95), Some(7.0));
        assert_eq!(quantile(&[], 0.5), None);
    }

    #[test]
    fn columns_stand_below_their_names() {
        let row = super::row(&Row {
            dimension: 2,
            name: "many_pyramids",
            drift: "moved",
            times: vec![1.0, 2.0, 3.0],
            counts: Counts { bodies: 22_000, contacts: Some(58_000), asleep: 0 },
            measures: Measures { energy: 1.25e7, ..Default::default() },
        });
        let head = head();
        let names = head.lines().next().unwrap();
        assert_eq!(names.len(), row.len());
        assert_eq!(names.find("bodies").unwrap() + 6, row.find("22000").unwrap() + 5);
    }
}
