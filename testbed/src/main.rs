//! The scenes to look at: in a window with a scene browser, or headless with a table and pictures.
#![allow(clippy::duplicate_mod, reason = "some files are compiled once for each dimension, on purpose")]

mod args;
mod dim2;
mod dim3;
mod draw;
mod headless;
#[cfg(feature = "window")]
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
    match reason_for_no_window(&args) {
        Some(reason) => {
            eprintln!("{reason}: running headless");
            match headless::tour(&args, &entries) {
                Ok(()) => ExitCode::SUCCESS,
                Err(error) => {
                    eprintln!("{}: {error}", args.out.display());
                    ExitCode::FAILURE
                }
            }
        }
        None => open_window(entries),
    }
}

#[cfg(feature = "window")]
fn reason_for_no_window(args: &Args) -> Option<String> {
    if args.headless { Some("--headless".into()) } else { probe::window_possible().err() }
}

#[cfg(not(feature = "window"))]
fn reason_for_no_window(_args: &Args) -> Option<String> {
    Some("built without the window".into())
}

#[cfg(feature = "window")]
fn open_window(entries: Vec<Entry>) -> ExitCode {
    window::run(entries)
}

#[cfg(not(feature = "window"))]
fn open_window(_entries: Vec<Entry>) -> ExitCode {
    ExitCode::FAILURE
}
