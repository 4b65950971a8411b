//! Runs workers one after the other, interleaved over the engines, when the machine is quiet.

use std::{
    collections::HashSet,
    env::current_exe,
    path::PathBuf,
    process::{Command, Stdio},
    time::{Duration, Instant},
};

use bench_core::{
    machine::{Usage, busy_s},
    measure::Report,
    scene::Family,
    worker::{Job, UNSUPPORTED},
};

use crate::{ours::root, results::Results};

/// The name of the App without physics.
pub const BARE: &str = "bevy";

/// Settings of a measurement.
pub struct Plan {
    /// The scenes; all if empty.
    pub scenes: Vec<String>,
    /// The engines; all if empty.
    pub engines: Vec<String>,
    /// The numbers of threads.
    pub threads: Vec<usize>,
    /// Number of runs of each.
    pub repeats: usize,
    /// Number of timed steps, instead of the scene's own.
    pub steps: Option<usize>,
    /// The engine to which the table compares.
    pub baseline: Option<String>,
    /// Whether stages are timed.
    pub stages: bool,
    /// The longest wait for a quiet machine before each run, in seconds.
    pub wait_s: u64,
    /// A run is repeated if other processes used more than this share of a core.
    pub foreign_limit: f64,
    /// Another build of this engine.
    pub ours: Option<PathBuf>,
    /// The file of results.
    pub out: PathBuf,
    /// The folder of page and pictures.
    pub docs: PathBuf,
}

impl Default for Plan {
    fn default() -> Self {
        Self {
            scenes: Vec::new(),
            engines: Vec::new(),
            threads: vec![1],
            repeats: 1,
            steps: None,
            baseline: None,
            stages: false,
            wait_s: 120,
            foreign_limit: 0.05,
            ours: None,
            out: root().join("out/results.json"),
            docs: root().join("../docs"),
        }
    }
}

impl Plan {
    /// Checks that everything runs, without measuring.
    pub fn make_quick(&mut self) {
        self.steps = Some(10);
        self.wait_s = 0;
        self.foreign_limit = f64::INFINITY;
        self.out = root().join("out/quick.json");
    }
}

/// A scene with the engines to run it on.
pub struct Chosen {
    /// 2 or 3.
    pub dim: u32,
    /// The scene.
    pub name: &'static str,
    /// The family.
    pub family: Family,
    /// The engines.
    pub engines: Vec<String>,
}

/// Runs workers.
pub struct Runner<'a> {
    plan: &'a Plan,
    ours: Option<PathBuf>,
    /// All runs so far.
    pub results: Results,
    /// Engines that reported that they cannot run a scene.
    unable: HashSet<(u32, String, String)>,
}

impl<'a> Runner<'a> {
    /// `ours` is the binary for engines whose names begin with it.
    pub fn new(plan: &'a Plan, ours: Option<PathBuf>) -> Self {
        Self { plan, ours, results: Results::here(), unable: HashSet::new() }
    }

    /// Runs scenes, and saves all results after each run.
    pub fn run(&mut self, scenes: &[Chosen], repeats: usize, stages: bool) -> Result<(), String> {
        for scene in scenes {
            for repeat in 0..repeats {
                for &threads in &self.plan.threads {
                    // Queries and chains run on one thread.
                    if threads > 1 && [Family::Queries, Family::Joints].contains(&scene.family) {
                        continue;
                    }
                    for engine in &scene.engines {
                        let job = Job {
                            dim: scene.dim,
                            engine: engine.clone(),
                            scene: scene.name.to_owned(),
                            threads,
                            steps: self.plan.steps,
                            stages,
                        };
                        self.run_job(&job, repeat)?;
                    }
                }
            }
        }
        Ok(())
    }

    /// Repeats a job, up to three times, until other processes were idle. An engine that fails does not
    /// stop the others.
    fn run_job(&mut self, job: &Job, repeat: usize) -> Result<(), String> {
        let Job { dim, scene, engine, threads, .. } = job;
        let name = format!("{dim}d/{scene} {engine}, threads {threads}");
        let key = (*dim, scene.clone(), engine.clone());
        if self.unable.contains(&key) {
            return Ok(());
        }
        for tries in 0..3 {
            wait_until_quiet(Duration::from_secs(self.plan.wait_s));
            match self.run_worker(job) {
                Ok(report) if report.foreign > self.plan.foreign_limit && tries < 2 => {
                    eprintln!("{name}: others used {:.2} of a core; again", report.foreign);
                }
                Ok(report) => {
                    let Report { median, mean, foreign, .. } = &report;
                    eprintln!("{name} #{repeat}: median {median:.3} ms, mean {mean:.3}, others {foreign:.2}");
                    self.results.reports.push(report);
                    return self.results.save(&self.plan.out);
                }
                Err(message) => {
                    eprintln!("{name}: {message}; skipped");
                    if message.starts_with(UNSUPPORTED) {
                        self.unable.insert(key);
                    }
                    return Ok(());
                }
            }
        }
        Ok(())
    }

    fn run_worker(&self, job: &Job) -> Result<Report, String> {
        let binary = match &self.ours {
            Some(ours) if job.engine.starts_with("ours") => ours.clone(),
            _ => current_exe().map_err(|e| e.to_string())?,
        };
        let (busy, used, start) = (busy_s(), Usage::children(), Instant::now());
        let out = Command::new(binary)
            .arg("worker")
            .args(job.to_args())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .output()
            .map_err(|e| e.to_string())?;
        let own = Usage::children().cpu_s - used.cpu_s;
        let others = busy_s() - busy - own;
        let text = String::from_utf8_lossy(&out.stdout);
        let line = text.lines().rev().find(|line| line.starts_with('{'));
        if let Some(mut report) = line.and_then(|line| serde_json::from_str::<Report>(line).ok()) {
            report.foreign = (others / start.elapsed().as_secs_f64()).max(0.0);
            return Ok(report);
        }
        let errors = String::from_utf8_lossy(&out.stderr);
        if let Some(line) = errors.lines().find(|line| line.starts_with(UNSUPPORTED)) {
            return Err(line.to_owned());
        }
        let first: Vec<&str> = errors.lines().take(3).collect();
        Err(format!("{} {}", out.status, first.join(" | ")))
    }
}

/// Waits until the machine has been nearly idle for a moment.
fn wait_until_quiet(limit: Duration) {
    /// Share of a core.
    const QUIET: f64 = 0.08;
    let start = Instant::now();
    while start.elapsed() < limit {
        let (busy, moment) = (busy_s(), Instant::now());
        std::thread::sleep(Duration::from_millis(700));
        if (busy_s() - busy) / moment.elapsed().as_secs_f64() < QUIET {
            return;
        }
    }
}
