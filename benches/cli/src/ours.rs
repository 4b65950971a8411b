//! Builds the binary with this engine.

use std::{
    env::{current_exe, var_os},
    ffi::OsString,
    path::{Path, PathBuf},
    process::Command,
};

/// The folder of the benches.
pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the package is in a folder of the workspace")
}

/// Builds it in the profile of this binary, and returns its path. Fast if nothing changed.
pub fn build() -> Result<PathBuf, String> {
    let own = current_exe().map_err(|e| e.to_string())?;
    let folder = own.parent().ok_or("this binary is in a folder")?;
    let target = folder.parent().ok_or("this binary is in a target folder")?;
    let cargo = var_os("CARGO").unwrap_or_else(|| OsString::from("cargo"));
    let status = Command::new(cargo)
        .args(["build", "--release", "--package", "bench_ours", "--target-dir"])
        .arg(target)
        .current_dir(root())
        .status()
        .map_err(|e| format!("cargo: {e}"))?;
    if !status.success() {
        return Err("this engine does not build".to_owned());
    }
    Ok(folder.join("bench_ours").with_extension(std::env::consts::EXE_EXTENSION))
}
