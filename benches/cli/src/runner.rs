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

/// What is to be measured, and how carefully.
pub struct Plan {
    /// Which scenes; all if none are named.
    pub scenes: Vec<String>,
    /// Which engines; all if none are named.
    pub engines: Vec<String>,
    /// How many threads each engine gets.
    pub threads: Vec<usize>,
    /// How often each is run.
    pub repeats: usize,
    /// How many steps are timed, if not as many as the scene says.
    pub steps: Option<usize>,
    /// The engine that the table compares with.
    pub baseline: Option<String>,
    /// Whether stages are timed.
    pub stages: bool,
    /// The longest wait for a quiet machine before each run, in seconds.
    pub wait_s: u64,
    /// Runs during which others used more than this share of a core are repeated.
    pub foreign_limit: f64,
    /// Which build of this engine, if not the present one.
    pub ours: Option<PathBuf>,
    /// Where the results go.
    pub out: PathBuf,
    /// Where the page and the pictures go.
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
    /// To see that everything runs, not to measure.
    pub fn make_quick(&mut self) {
        self.steps = Some(10);
        self.wait_s = 0;
        self.foreign_limit = f64::INFINITY;
        self.out = root().join("out/quick.json");
    }
}

/// A scene to be run, and on what.
pub struct Chosen {
    /// 2 or 3.
    pub dim: u32,
    /// The scene.
    pub name: &'static str,
    /// What it is to show.
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
    /// Engines that said that they cannot run a scene.
    unable: HashSet<(u32, String, String)>,
}

impl<'a> Runner<'a> {
    /// `ours` is the binary that runs engines whose names begin so.
    pub fn new(plan: &'a Plan, ours: Option<PathBuf>) -> Self {
        Self { plan, ours, results: Results::here(), unable: HashSet::new() }
    }

    /// Runs scenes, and saves all that is known after each run.
    pub fn run(&mut self, scenes: &[Chosen], repeats: usize, stages: bool) -> Result<(), String> {
        for scene in scenes {
            for repeat in 0..repeats {
                for &threads in &self.plan.threads {
                    // Queries are asked by one thread.
                    if threads > 1 && scene.family == Family::Queries {
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

    /// Runs a job until nobody disturbs it, three times at most. An engine that fails does not stop the others.
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
