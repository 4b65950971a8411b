//! Checks whether a window can open, before starting anything that would panic if not.
//!
//! The window needs an X11 display that accepts connections, the X libraries, the Vulkan loader, and at least
//! one Vulkan driver. They are checked by files, sockets and environment variables only. [`crate::child`]
//! handles all other failures.

use std::path::{Path, PathBuf};

/// Libraries that the windowing library opens at run time.
const X_LIBRARIES: [&str; 4] = ["libX11.so.6", "libX11-xcb.so.1", "libxcb.so.1", "libxkbcommon-x11.so.0"];
const VULKAN_LOADER: &str = "libvulkan.so.1";

/// `Ok` if a window can open, else the reason in half a sentence.
pub fn window_possible() -> Result<(), String> {
    if !cfg!(target_os = "linux") {
        return Ok(());
    }
    let display = std::env::var("DISPLAY").unwrap_or_default();
    if display.is_empty() {
        let wayland = std::env::var_os("WAYLAND_DISPLAY").is_some_and(|name| !name.is_empty());
        return Err(if wayland {
            "Wayland without X11".into()
        } else {
            "no display (DISPLAY is not set)".into()
        });
    }
    connect(&display)?;
    let folders = library_folders();
    let present = |name: &str| folders.iter().any(|folder| folder.join(name).exists());
    if let Some(missing) = X_LIBRARIES.iter().find(|name| !present(name)) {
        return Err(format!("{missing} is not installed"));
    }
    if !present(VULKAN_LOADER) {
        return Err(format!("no Vulkan loader ({VULKAN_LOADER} is not installed)"));
    }
    if vulkan_drivers().iter().any(|driver| driver_library_present(driver, &folders)) {
        Ok(())
    } else {
        Err("no Vulkan driver".into())
    }
}

/// Host and number of a display named like `:0`, `unix/:0.1`, `host:10.0`; no host for this machine's socket.
fn parse_display(display: &str) -> Option<(Option<&str>, u16)> {
    let (host, rest) = display.rsplit_once(':')?;
    let number = rest.split('.').next()?.parse().ok()?;
    let host = host.strip_prefix("unix").map_or(host, |rest| rest.trim_start_matches('/'));
    Some(((!host.is_empty()).then_some(host), number))
}

/// Connects to the display's socket and disconnects at once.
#[cfg(unix)]
fn connect(display: &str) -> Result<(), String> {
    use std::net::{TcpStream, ToSocketAddrs};
    use std::os::unix::net::UnixStream;
    use std::time::Duration;
    let silent = || format!("the display {display} does not answer");
    let (host, number) = parse_display(display).ok_or_else(silent)?;
    let local = || UnixStream::connect(format!("/tmp/.X11-unix/X{number}")).is_ok();
    let remote = |host: &str| {
        let addresses = (host, 6000u16.saturating_add(number)).to_socket_addrs();
        addresses
            .is_ok_and(|mut all| all.any(|a| TcpStream::connect_timeout(&a, Duration::from_secs(1)).is_ok()))
    };
    if host.map_or_else(local, remote) { Ok(()) } else { Err(silent()) }
}

#[cfg(not(unix))]
fn connect(_display: &str) -> Result<(), String> {
    Ok(())
}

/// The folders of the dynamic linker, as far as they are known without running it.
fn library_folders() -> Vec<PathBuf> {
    let mut folders: Vec<PathBuf> = std::env::var_os("LD_LIBRARY_PATH")
        .map(|paths| std::env::split_paths(&paths).collect())
        .unwrap_or_default();
    let arch = std::env::consts::ARCH;
    for root in ["/usr/lib", "/lib", "/usr/local/lib"] {
        folders.push(Path::new(root).join(format!("{arch}-linux-gnu")));
        folders.push(root.into());
        folders.push(format!("{root}64").into());
    }
    folders.push("/run/opengl-driver/lib".into());
    // What the linker's configuration adds, one folder a line.
    for file in std::fs::read_dir("/etc/ld.so.conf.d").into_iter().flatten().flatten() {
        let text = std::fs::read_to_string(file.path()).unwrap_or_default();
        folders.extend(text.lines().map(str::trim).filter(|line| line.starts_with('/')).map(PathBuf::from));
    }
    folders
}

/// The driver descriptions the Vulkan loader would read.
fn vulkan_drivers() -> Vec<PathBuf> {
    for name in ["VK_DRIVER_FILES", "VK_ICD_FILENAMES"] {
        if let Some(files) = std::env::var_os(name).filter(|files| !files.is_empty()) {
            return std::env::split_paths(&files).collect();
        }
    }
    let home = std::env::var_os("HOME").map(PathBuf::from).unwrap_or_default();
    let system = ["/usr/share", "/etc", "/usr/local/share", "/usr/local/etc", "/run/opengl-driver/share"];
    let roots = system.iter().map(PathBuf::from).chain([home.join(".local/share")]);
    roots
        .flat_map(|root| std::fs::read_dir(root.join("vulkan/icd.d")).into_iter().flatten().flatten())
        .map(|entry| entry.path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "json"))
        .collect()
}

/// Whether the library of a driver description exists. Relative names are searched as the linker does.
fn driver_library_present(description: &Path, folders: &[PathBuf]) -> bool {
    let text = std::fs::read_to_string(description).unwrap_or_default();
    let Some(library) = library_path(&text) else { return false };
    if library.contains('/') {
        // An absolute path replaces the description's folder.
        description.parent().is_some_and(|folder| folder.join(library).exists())
    } else {
        folders.iter().any(|folder| folder.join(library).exists())
    }
}

/// The value of `"library_path"`; enough of a JSON reader for these files.
fn library_path(json: &str) -> Option<&str> {
    let after = json.split_once("\"library_path\"")?.1;
    let after = after.trim_start().strip_prefix(':')?.trim_start().strip_prefix('"')?;
    Some(after.split_once('"')?.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn display_names() {
        assert_eq!(parse_display(":0"), Some((None, 0)));
        assert_eq!(parse_display("unix/:1.0"), Some((None, 1)));
        assert_eq!(parse_display("localhost:10.0"), Some((Some("localhost"), 10)));
        assert_eq!(parse_display("wayland-0"), None);
        assert_eq!(parse_display(":x"), None);
    }

    #[cfg(unix)]
    #[test]
    fn a_display_that_nobody_serves_is_named() {
        assert!(connect(":4711").unwrap_err().contains(":4711"));
    }

    #[test]
    fn driver_descriptions() {
        let json = r#"{ "ICD": { "api_version": "1.3.2", "library_path" : "libvulkan_lvp.so" } }"#;
        assert_eq!(library_path(json), Some("libvulkan_lvp.so"));
        assert_eq!(library_path("{}"), None);
        assert!(!driver_library_present(Path::new("/nowhere/driver.json"), &library_folders()));
    }
}
