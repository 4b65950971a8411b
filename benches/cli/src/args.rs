//! The command line.

use std::path::PathBuf;

use bench_core::{
    dim2::D2,
    dim3::D3,
    engine::Engines,
    scene::{Entry, Family, Scenes},
    world::Dimension,
};

use crate::{
    docs, ours,
    results::Results,
    runner::{BARE, Chosen, Plan, Runner},
    table,
};

const USAGE: &str = "cargo run --release -- COMMAND [OPTIONS], in the folder benches/

quick     every scene on every engine for ten steps each, in some minutes: does everything run? (the default)
all       everything, then docs/benchmarks.md and its pictures; hours, with --threads 1,2 --repeats 3
run       the scenes that the options choose; prints a table
docs      the page and the pictures again, from the results in a file
scenes    what there is

--scenes A,B      a dimension (2d), a family (idle), a name (tumbler), or both (2d/idle, 3d/washer)
--engines A,B     of box2d, box3d, rapier, avian, ours, bevy (the App without physics)
--threads 1,2     how many threads, and cores, each engine gets
--repeats N       how often each is run
--steps N         how many steps are timed, if not as many as the scene says
--baseline NAME   the engine that the table compares with, the first if not given
--stages          where the time of a step goes; costs a little
--wait SECONDS    the longest wait for a quiet machine before a run
--foreign SHARE   runs during which others took more of a core than this are repeated, twice at most
--ours FILE       another build of ../ours than the present one
--out FILE        where the results are, out/results.json if not given
--docs FOLDER     where the page and the pictures go, ../docs if not given";

/// A command.
pub enum Command {
    Help,
    Scenes,
    Run(Plan),
    All(Plan),
    Docs(Plan),
}

impl Command {
    /// Reads the command line.
    pub fn parse(args: &[String]) -> Result<Self, String> {
        let (name, rest) = match args.split_first() {
            Some((first, rest)) if !first.starts_with("--") => (first.as_str(), rest),
            _ => ("quick", args),
        };
        let mut plan = Plan::default();
        match name {
            _ if args.iter().any(|arg| arg == "--help") => return Ok(Self::Help),
            "help" => return Ok(Self::Help),
            "scenes" => return Ok(Self::Scenes),
            "quick" => plan.make_quick(),
            "run" | "all" | "docs" => {}
            _ => return Err(format!("no command {name}\n\n{USAGE}")),
        }
        let mut rest = rest.iter();
        while let Some(option) = rest.next() {
            if option == "--stages" {
                plan.stages = true;
                continue;
            }
            let value = rest.next().ok_or_else(|| format!("{option} wants a value\n\n{USAGE}"))?;
            set(&mut plan, option, value).ok_or_else(|| format!("{option} {value}?\n\n{USAGE}"))?;
        }
        Ok(match name {
            "all" => Self::All(plan),
            "docs" => Self::Docs(plan),
            _ => Self::Run(plan),
        })
    }

    /// Runs the command.
    pub fn run(self, engines: &Engines) -> Result<(), String> {
        match self {
            Self::Help => println!("{USAGE}"),
            Self::Scenes => {
                list::<D2>();
                list::<D3>();
            }
            Self::Run(plan) => {
                let reports = measure(engines, &plan, false)?.reports;
                println!("{}", table::markdown(&reports, plan.baseline.as_deref()));
                println!("{}", table::stage_lines(&reports));
                println!("all runs: {}", plan.out.display());
            }
            Self::All(plan) => docs::write_all(&measure(engines, &plan, true)?, &plan.docs)?,
            Self::Docs(plan) => docs::write_all(&Results::load(&plan.out)?, &plan.docs)?,
        }
        Ok(())
    }
}

fn set(plan: &mut Plan, option: &str, value: &str) -> Option<()> {
    let list = || value.split(',').map(str::to_owned).collect::<Vec<String>>();
    match option {
        "--scenes" => plan.scenes = list(),
        "--engines" => plan.engines = list(),
        "--threads" => plan.threads = list().iter().map(|n| n.parse().ok()).collect::<Option<_>>()?,
        "--repeats" => plan.repeats = value.parse().ok()?,
        "--steps" => plan.steps = Some(value.parse().ok()?),
        "--baseline" => plan.baseline = Some(value.to_owned()),
        "--wait" => plan.wait_s = value.parse().ok()?,
        "--foreign" => plan.foreign_limit = value.parse().ok()?,
        "--ours" => plan.ours = Some(PathBuf::from(value)),
        "--out" => plan.out = PathBuf::from(value),
        "--docs" => plan.docs = PathBuf::from(value),
        _ => return None,
    }
    Some(())
}

fn list<D: Scenes>() {
    for entry in D::ALL {
        let scene = (entry.build)();
        let (number, name, bodies, about) = (D::NUMBER, entry.name, scene.bodies.len(), scene.about);
        println!("{number}d/{name} ({}), {bodies} bodies: {about}", family_name(entry.family));
    }
}

/// Builds missing binaries and runs the plan; with `split` a second time with timed stages, for scenes of
/// families speed and idle.
fn measure(engines: &Engines, plan: &Plan, split: bool) -> Result<Results, String> {
    if cfg!(debug_assertions) {
        return Err("only what is built with --release is worth measuring".to_owned());
    }
    // Cargo passes the C compiler's flags to rustc.
    if cfg!(feature = "box2d") && !option_env!("CFLAGS").unwrap_or("").contains("NDEBUG") {
        eprintln!("Box2D has its assertions on: build in the folder benches/");
    }
    let mut chosen = choose::<D2>(plan, engines.d2.iter().map(|e| e.0));
    chosen.extend(choose::<D3>(plan, engines.d3.iter().map(|e| e.0)));
    if chosen.is_empty() {
        return Err("the options choose no scene; `scenes` lists them".to_owned());
    }
    let wants_ours = chosen.iter().any(|scene| scene.engines.iter().any(|e| e.starts_with("ours")));
    let ours = match &plan.ours {
        Some(path) => Some(path.clone()),
        None if wants_ours => Some(ours::build()?),
        None => None,
    };
    let mut runner = Runner::new(plan, ours);
    runner.run(&chosen, plan.repeats, plan.stages)?;
    if split {
        chosen.retain(|scene| [Family::Speed, Family::Idle].contains(&scene.family));
        let in_bevy = |engine: &String| ["avian", "ours"].contains(&engine.as_str());
        chosen.iter_mut().for_each(|scene| scene.engines.retain(in_bevy));
        runner.run(&chosen, 1, true)?;
    }
    Ok(runner.results)
}

/// The selected scenes of a dimension, and the engines for each.
fn choose<D: Scenes>(plan: &Plan, known: impl Iterator<Item = &'static str>) -> Vec<Chosen> {
    let known: Vec<String> = known.chain(["ours"]).map(str::to_owned).collect();
    let engines = if plan.engines.is_empty() {
        known
    } else {
        plan.engines.iter().filter(|name| known.contains(name)).cloned().collect()
    };
    let scenes = D::ALL.iter().filter(|entry| is_chosen(plan, entry));
    let choose = |entry: &Entry<D>| {
        let may = |name: &&String| *name != BARE || entry.family.is_mostly_still();
        let engines = engines.iter().filter(may).cloned().collect();
        Chosen { dim: D::NUMBER, name: entry.name, family: entry.family, engines }
    };
    scenes.map(choose).collect()
}

fn is_chosen<D: Dimension>(plan: &Plan, entry: &Entry<D>) -> bool {
    let number = format!("{}d", D::NUMBER);
    let is = |word: &str| word == number || word == entry.name || word == family_name(entry.family);
    plan.scenes.is_empty() || plan.scenes.iter().any(|selector| selector.split('/').all(is))
}

/// The name on the command line.
pub fn family_name(family: Family) -> String {
    format!("{family:?}").to_lowercase()
}
