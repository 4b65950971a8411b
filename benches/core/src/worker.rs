//! One run of one scene on one engine, in a process of its own: task pools are global in some engines, and a
//! crash or leak in one run must not affect the next.

use std::time::Instant;

use crate::{
    chains,
    engine::{DT, Engine, Engines, Make, Settings},
    machine::{Usage, pin},
    measure::{Clock, Quality, Report, StageSums, time_of},
    passed::Passed,
    ruler::judge,
    scene::{Need, Plan, Scene, Scenes, Work, find},
    world::{Dimension, State},
};

/// Prefix of the error that makes the parent skip the scene for this engine.
pub const UNSUPPORTED: &str = "not supported by this build";

/// A job.
#[derive(Clone, Debug)]
pub struct Job {
    /// 2 or 3.
    pub dim: u32,
    /// The engine.
    pub engine: String,
    /// The scene.
    pub scene: String,
    /// How many threads, and cores.
    pub threads: usize,
    /// How many steps are timed, if not as many as the scene says.
    pub steps: Option<usize>,
    /// Whether stages are timed.
    pub stages: bool,
}

impl Job {
    /// The arguments from which a worker reads the job.
    pub fn to_args(&self) -> Vec<String> {
        let steps = self.steps.map_or("-".to_owned(), |steps| steps.to_string());
        let stages = if self.stages { "stages" } else { "plain" };
        let (dim, threads) = (self.dim.to_string(), self.threads.to_string());
        vec![dim, self.engine.clone(), self.scene.clone(), threads, steps, stages.to_owned()]
    }

    fn from_args(args: &[String]) -> Option<Self> {
        let [dim, engine, scene, threads, steps, stages] = args else {
            return None;
        };
        Some(Self {
            dim: dim.parse().ok()?,
            engine: engine.clone(),
            scene: scene.clone(),
            threads: threads.parse().ok()?,
            steps: steps.parse().ok(),
            stages: stages == "stages",
        })
    }
}

/// Runs the job in the arguments, and prints its result as one line of JSON.
pub fn main(engines: &Engines, args: &[String]) -> Result<(), String> {
    let job = Job::from_args(args).ok_or("worker DIM ENGINE SCENE THREADS STEPS|- stages|plain")?;
    pin(job.threads);
    let report = match job.dim {
        2 => run(engines.d2, &job)?,
        3 => run(engines.d3, &job)?,
        _ => return Err("there are two and three dimensions".to_owned()),
    };
    println!("{}", serde_json::to_string(&report).map_err(|e| e.to_string())?);
    Ok(())
}

fn run<D: Scenes>(engines: &[(&str, Make<D>)], job: &Job) -> Result<Report, String> {
    let entry = find::<D>(&job.scene).ok_or_else(|| format!("no scene {}", job.scene))?;
    let make = engines.iter().find(|engine| engine.0 == job.engine);
    let make = make.ok_or_else(|| format!("no engine {} in {}D here", job.engine, D::NUMBER))?.1;
    let scene = (entry.build)();
    let start = Instant::now();
    let settings = Settings { threads: job.threads, sleeping: scene.sleeping, stages: job.stages };
    let mut engine = make(scene.gravity, &settings);
    refuse(engine.lacks(), |need| entry.needs(&scene, need))?;
    let Plan { work, timed, .. } = scene.plan;
    // A batch is worth many steps.
    let timed = job.steps.map_or(timed, |n| if work == Work::Steps { n } else { timed.min(n.div_ceil(10)) });
    let in_batches = matches!(work, Work::Spawn | Work::Despawn);
    if !in_batches {
        fill(&mut *engine, &scene);
    }
    engine.ready();
    let setup_ms = start.elapsed().as_secs_f64() * 1e3;
    let mut bench =
        Bench { engine, scene, job, clock: Clock::default(), stages: StageSums::default(), out: Vec::new() };
    if in_batches {
        bench.time_batches(timed);
    } else {
        bench.time_steps(timed);
    }
    let peak_mb = Usage::own().peak_mb;
    let mut quality = bench.quality();
    let Bench { engine, scene, clock, stages, .. } = bench;
    drop(engine);
    if scene.bodies.iter().any(|body| body.bullet) {
        quality.passed = Some(count_passed(make(scene.gravity, &settings), &scene, timed));
    }
    quality.strain = chains::Watch::new(&scene).map(|mut watch| {
        run_again(make(scene.gravity, &settings), &scene, timed, |states| watch.look(states));
        watch.strain()
    });
    let times = clock.times();
    Ok(Report {
        engine: job.engine.clone(),
        dim: D::NUMBER,
        scene: job.scene.clone(),
        family: entry.family,
        threads: job.threads,
        bodies: scene.bodies.len(),
        timed,
        batch: scene.rays.len(),
        setup_ms,
        mean: times.mean,
        median: times.median,
        p95: times.p95,
        max: times.max,
        stages: stages.means(),
        quality,
        foreign: 0.0,
        peak_mb,
    })
}

/// Runs the scene once more, and counts what went through a wall.
fn count_passed<D: Dimension>(engine: Box<dyn Engine<D>>, scene: &Scene<D>, timed: usize) -> usize {
    let mut passed = Passed::new(scene);
    run_again(engine, scene, timed, |states| passed.look(states));
    passed.count()
}

/// Runs the scene without a clock, and gives the state after each step to a function.
fn run_again<D: Dimension>(
    mut engine: Box<dyn Engine<D>>,
    scene: &Scene<D>,
    timed: usize,
    mut look: impl FnMut(&[State<D>]),
) {
    let mut states = Vec::new();
    fill(&mut *engine, scene);
    engine.ready();
    for steps in 0..scene.plan.settle + timed {
        step(&mut *engine, scene, steps);
        states.clear();
        engine.states(&mut states);
        look(&states);
    }
}

/// Refuses a scene that needs a feature that the engine's build lacks.
fn refuse(lacks: &[Need], needs: impl Fn(Need) -> bool) -> Result<(), String> {
    let missing: Vec<String> =
        lacks.iter().filter(|need| needs(**need)).map(|need| format!("{need:?}").to_lowercase()).collect();
    if missing.is_empty() { Ok(()) } else { Err(format!("{UNSUPPORTED}: {}", missing.join(", "))) }
}

fn fill<D: Dimension>(engine: &mut dyn Engine<D>, scene: &Scene<D>) {
    scene.bodies.iter().for_each(|body| engine.add_body(body));
    scene.joints.iter().for_each(|joint| engine.add_joint(joint));
}

/// A run.
struct Bench<'a, D: Dimension> {
    engine: Box<dyn Engine<D>>,
    scene: Scene<D>,
    job: &'a Job,
    clock: Clock,
    stages: StageSums,
    /// What queries found.
    out: Vec<f32>,
}

impl<D: Dimension> Bench<'_, D> {
    /// The parts of a run: steps, each with the scene's actions, or batches of queries.
    fn time_steps(&mut self, timed: usize) {
        let Self { engine, scene, clock, stages, out, .. } = self;
        let settle = scene.plan.settle;
        for steps in 0..settle {
            step(&mut **engine, scene, steps);
        }
        for steps in settle..settle + timed {
            match scene.plan.work {
                Work::Raycasts => clock.time(|| engine.raycast(&scene.rays, out)),
                Work::RaycastBatches => clock.time(|| engine.raycast_batch(&scene.rays, out)),
                Work::Ballcasts => clock.time(|| engine.ballcast(scene.cast_radius, &scene.rays, out)),
                _ => clock.time(|| step(&mut **engine, scene, steps)),
            }
            if self.job.stages && scene.plan.work == Work::Steps {
                stages.add(engine.stages());
            }
        }
    }

    /// Empties and fills the world repeatedly, and times one of the two. The world is left full.
    fn time_batches(&mut self, timed: usize) {
        let Self { engine, scene, clock, .. } = self;
        let Plan { work, settle, .. } = scene.plan;
        fill(&mut **engine, scene);
        engine.step();
        for batch in 0..settle + timed {
            let despawn = time_of(|| {
                engine.clear();
                engine.step();
            });
            let spawn = time_of(|| {
                fill(&mut **engine, scene);
                engine.step();
            });
            if batch >= settle {
                clock.note(if work == Work::Spawn { spawn } else { despawn });
            }
        }
    }

    fn quality(&mut self) -> Quality {
        if self.engine.lacks().contains(&Need::Physics) {
            return Quality::default();
        }
        let mut states = Vec::new();
        self.engine.states(&mut states);
        let mut quality = judge(&self.scene, &states, self.engine.awake());
        if matches!(self.scene.plan.work, Work::Raycasts | Work::RaycastBatches | Work::Ballcasts) {
            let hits: Vec<f64> = self.out.iter().filter(|t| t.is_finite()).map(|t| *t as f64).collect();
            quality.hits = Some(hits.len());
            quality.mean_hit = Some(hits.iter().sum::<f64>() / hits.len().max(1) as f64);
        }
        quality
    }
}

/// Takes a step, after setting the velocity of the driven body.
fn step<D: Dimension>(engine: &mut dyn Engine<D>, scene: &Scene<D>, steps: usize) {
    if let Some(drive) = &scene.drive {
        engine.push(drive.body, drive.velocity(steps, DT));
    }
    engine.step();
}
