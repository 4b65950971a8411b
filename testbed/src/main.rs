//! Scenes: in a window with a scene browser, or headless with a table and pictures.
#![allow(clippy::duplicate_mod, reason = "some files are compiled once for each dimension, on purpose")]

mod args;
#[cfg(any(feature = "window", test))]
mod child;
mod dim2;
mod dim3;
mod draw;
mod headless;
#[cfg(any(feature = "window", test))]
#[cfg_attr(not(feature = "window"), expect(dead_code, reason = "tested even where no window is built"))]
mod probe;
mod sim;
#[cfg(feature = "window")]
mod window;

use std::process::ExitCode;

use args::Args;
use sim::Entry;

fn main() -> ExitCode {
    let args = match Args::parse(std::env::args().skip(1)) {
        Ok(args) => args,
        Err(mistake) => {
            eprintln!("{mistake}\n\n{}", args::HELP);
            return ExitCode::from(2);
        }
    };
    if args.help {
        print!("{}", args::HELP);
        return ExitCode::SUCCESS;
    }
    if args.idle {
        println!("2D");
        dim2::idle::report();
        println!("3D");
        dim3::idle::report();
        return ExitCode::SUCCESS;
    }
    let entries: Vec<Entry> =
        sim::catalogue().into_iter().filter(|entry| args.selects(entry.dimension, entry.name)).collect();
    if entries.is_empty() {
        eprintln!("no such scene; --list prints them");
        return ExitCode::from(2);
    }
    if args.list {
        for entry in &entries {
            println!("{}d/{:<16} {:>5} steps  {}", entry.dimension, entry.name, entry.steps, entry.about);
        }
        return ExitCode::SUCCESS;
    }
    let reason = match show(&args, &entries) {
        Ok(code) => return code,
        Err(reason) => reason,
    };
    eprintln!("{reason}: running headless");
    match headless::tour(&args, &entries) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{}: {error}", args.out.display());
            ExitCode::FAILURE
        }
    }
}

/// Shows the scenes in a window until that is closed. `Err` says why there is no window.
#[cfg(feature = "window")]
fn show(args: &Args, entries: &[Entry]) -> Result<ExitCode, String> {
    if args.headless {
        return Err("--headless".into());
    }
    if args.window {
        return Ok(window::run(entries.to_vec()));
    }
    probe::window_possible()?;
    child::open_window()
}

#[cfg(not(feature = "window"))]
fn show(_args: &Args, _entries: &[Entry]) -> Result<ExitCode, String> {
    Err("built without the window".into())
}
