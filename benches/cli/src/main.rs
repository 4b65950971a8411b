//! The engine against its peers: `cargo run --release` in `benches/`, see the README there.

#[cfg(feature = "avian")]
mod backend {
    //! The crates that the Avian adapters are compiled against.
    pub use up_avian2d as d2;
    pub use up_avian3d as d3;
    /// Whether no body passes what is static. Here only bodies with `SweptCcd` are swept.
    pub const SWEEPS_ALL: bool = false;
}
mod args;
mod docs;
mod engines;
mod ours;
mod plots;
mod results;
mod runner;
mod table;

use std::process::ExitCode;

use bench_core::engine::Engines;

/// The peers. Ours has a binary of its own.
const ENGINES: Engines = Engines {
    d2: &[
        #[cfg(feature = "box2d")]
        ("box2d", engines::box2d::make),
        #[cfg(feature = "rapier")]
        ("rapier", engines::rapier2d::make),
        #[cfg(feature = "avian")]
        ("avian", engines::avian2d::make),
        #[cfg(feature = "avian")]
        (runner::BARE, engines::bare::make2),
    ],
    d3: &[
        #[cfg(feature = "box3d")]
        ("box3d", engines::box3d::make),
        #[cfg(feature = "rapier")]
        ("rapier", engines::rapier3d::make),
        #[cfg(feature = "avian")]
        ("avian", engines::avian3d::make),
        #[cfg(feature = "avian")]
        (runner::BARE, engines::bare::make3),
    ],
};

fn main() -> ExitCode {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let done = match args.split_first() {
        Some((first, rest)) if first == "worker" => bench_core::worker::main(&ENGINES, rest),
        _ => args::Command::parse(&args).and_then(|command| command.run(&ENGINES)),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("{message}");
            ExitCode::FAILURE
        }
    }
}
