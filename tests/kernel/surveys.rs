//! Tables for the documentation, which take minutes: `cargo bench -p avian_kernel3d --bench surveys -- NAME`.

use super::{rest, tunnel, unrest};

const SURVEYS: [(&str, fn()); 3] =
    [("piles", rest::survey_of_piles), ("tops", unrest::unrest_of_tops), ("bullets", tunnel::table_of_modes)];

/// Runs the survey of the name that is given, and lists the names without one.
pub fn main() {
    let named = std::env::args().skip(1).find(|argument| !argument.starts_with('-'));
    match SURVEYS.iter().find(|(name, _)| Some(*name) == named.as_deref()) {
        Some((_, survey)) => survey(),
        None => SURVEYS.iter().for_each(|(name, _)| println!("{name}")),
    }
}
