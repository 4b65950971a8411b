//! A worker with only this engine. The adapters are the same files as for Avian 0.7; only the crates behind
//! `backend` differ.

mod backend {
    pub use avian2d as d2;
    pub use avian3d as d3;
    /// Whether no body passes what is static.
    pub const SWEEPS_ALL: bool = true;
}
mod engines;

use std::process::ExitCode;

use bench_core::{engine::Engines, worker};

const ENGINES: Engines =
    Engines { d2: &[("ours", engines::avian2d::make)], d3: &[("ours", engines::avian3d::make)] };

fn main() -> ExitCode {
    let args: Vec<String> = std::env::args().skip(2).collect();
    match worker::main(&ENGINES, &args) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("{message}");
            ExitCode::FAILURE
        }
    }
}
