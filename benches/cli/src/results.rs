//! Results of a measurement: every run and the machine, in one file.

use std::{fs, path::Path, process::Command};

use bench_core::measure::Report;
use serde::{Deserialize, Serialize};

use crate::ours::root;

/// The packages whose versions are recorded, with labels.
const PACKAGES: [(&str, &str); 5] = [
    ("boxdd-sys", "Box2D, through boxdd-sys"),
    ("box3d-sys", "Box3D, through box3d-sys"),
    ("rapier2d", "Rapier"),
    ("avian2d", "Avian"),
    ("bevy", "Bevy"),
];

/// A measurement.
#[derive(Debug, Default, Serialize, Deserialize)]
pub struct Results {
    /// Machine and versions: name and value.
    pub facts: Vec<(String, String)>,
    /// Every run.
    pub reports: Vec<Report>,
}

impl Results {
    /// No runs yet, on this machine.
    pub fn here() -> Self {
        Self { facts: facts(), reports: Vec::new() }
    }

    /// Reads a file.
    pub fn load(path: &Path) -> Result<Self, String> {
        let text = fs::read_to_string(path).map_err(|e| format!("{}: {e}", path.display()))?;
        serde_json::from_str(&text).map_err(|e| format!("{}: {e}", path.display()))
    }

    /// Writes a file, and the folder it is in.
    pub fn save(&self, path: &Path) -> Result<(), String> {
        let text = serde_json::to_string(self).map_err(|e| e.to_string())?;
        write(path, &text)
    }
}

/// Writes a file, and the folder it is in.
pub fn write(path: &Path, text: &str) -> Result<(), String> {
    let folder = path.parent().ok_or_else(|| format!("{}: no folder", path.display()))?;
    fs::create_dir_all(folder)
        .and_then(|()| fs::write(path, text))
        .map_err(|e| format!("{}: {e}", path.display()))
}

fn facts() -> Vec<(String, String)> {
    let mut facts = vec![
        ("date", said(&["date", "-u", "+%-d %B %Y"])),
        ("processor", processor()),
        ("system", said(&["uname", "-sm"])),
        ("compiler", said(&["rustc", "--version"])),
        ("this engine", said(&["git", "describe", "--always", "--dirty"])),
    ];
    let lock = fs::read_to_string(root().join("Cargo.lock")).unwrap_or_default();
    facts.extend(PACKAGES.map(|(package, name)| (name, version(&lock, package))));
    facts.into_iter().map(|(name, value)| (name.to_owned(), value)).collect()
}

/// The first line that a program prints.
fn said(command: &[&str]) -> String {
    let out = Command::new(command[0]).args(&command[1..]).current_dir(root()).output();
    let text = out.map(|out| String::from_utf8_lossy(&out.stdout).into_owned()).unwrap_or_default();
    text.lines().next().unwrap_or("unknown").to_owned()
}

fn processor() -> String {
    let info = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = info.lines().find_map(|line| line.strip_prefix("model name")?.split_once(": "));
    let cores = std::thread::available_parallelism().map_or(0, |n| n.get());
    format!("{}, {cores} cores", model.map_or("unknown", |(_, name)| name.trim()))
}

/// The version of a package from the registry in a lock file.
fn version(lock: &str, package: &str) -> String {
    let name = format!("name = \"{package}\"\n");
    let found = lock.split("[[package]]").find(|p| p.contains(&name) && p.contains("\nsource = "));
    let line = found.and_then(|p| p.lines().find_map(|line| line.strip_prefix("version = ")));
    line.unwrap_or("unknown").trim_matches('"').to_owned()
}
