//! Runs the window in a process of its own, so that this one survives if the window cannot open.
//!
//! Problems that [`crate::probe`] cannot detect, such as a display that refuses this user or a driver without
//! a device, make libraries below the window panic, exit or crash. The process with the window reports on its
//! standard output that it has drawn. If it fails without this report, there is no window.

use std::io::{self, BufRead, BufReader, Write};
use std::process::{Command, ExitCode, Stdio};

/// The report of the process with the window.
const DRAWN: &str = "testbed: the window has drawn";

/// Starts this program again with `--window`, and waits for it. `Err` says why there was no window.
#[cfg(feature = "window")]
pub fn open_window() -> Result<ExitCode, String> {
    let program =
        std::env::current_exe().map_err(|error| format!("this program is not to be found ({error})"))?;
    let mut command = Command::new(program);
    command.args(std::env::args_os().skip(1)).arg("--window");
    run(command)
}

/// Reports to the waiting process that this one has drawn.
#[cfg(feature = "window")]
pub fn say_drawn() {
    // Without a reader, the report is not needed.
    let _ = writeln!(io::stdout(), "{DRAWN}");
}

/// Runs a command, and forwards its output and exit code. `Err` if it fails before it has drawn.
fn run(mut command: Command) -> Result<ExitCode, String> {
    let no_window = |why: String| format!("the window did not come up ({why})");
    let mut child = command.stdout(Stdio::piped()).spawn().map_err(|error| no_window(error.to_string()))?;
    let drawn = child.stdout.take().is_some_and(|output| pass_on(BufReader::new(output), io::stdout()));
    let status = child.wait().map_err(|error| no_window(error.to_string()))?;
    if !drawn && !status.success() {
        return Err(no_window(status.to_string()));
    }
    Ok(status.code().and_then(|code| u8::try_from(code).ok()).map_or(ExitCode::FAILURE, ExitCode::from))
}

/// Copies all lines but the report. Returns whether there was a report.
fn pass_on(mut from: impl BufRead, mut to: impl Write) -> bool {
    let mut drawn = false;
    let mut line = Vec::new();
    // Line by line, for a user who watches.
    while from.read_until(b'\n', &mut line).is_ok_and(|read| read > 0) {
        if line.trim_ascii_end() == DRAWN.as_bytes() {
            drawn = true;
        } else {
            let _ = to.write_all(&line);
        }
        line.clear();
    }
    drawn
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_but_the_message_is_passed_on() {
        let mut out = Vec::new();
        assert!(pass_on(format!("one\n{DRAWN}\r\ntwo").as_bytes(), &mut out));
        assert_eq!(out, b"one\ntwo");
        assert!(!pass_on(&b"\xff\n"[..], &mut out));
    }

    #[cfg(unix)]
    #[test]
    fn only_who_ends_badly_before_drawing_has_no_window() {
        let sh = |script: String| {
            let mut command = Command::new("sh");
            command.args(["-c", &script]).stderr(Stdio::null());
            run(command)
        };
        assert!(sh("exit 101".into()).unwrap_err().contains("101"));
        assert!(sh("kill -SEGV $$".into()).unwrap_err().contains("signal"));
        assert_eq!(sh("exit 0".into()), Ok(ExitCode::SUCCESS));
        assert_eq!(sh(format!("echo '{DRAWN}'; exit 3")), Ok(ExitCode::from(3)));
        assert_eq!(sh(format!("echo '{DRAWN}'; kill -SEGV $$")), Ok(ExitCode::FAILURE));
    }

    #[test]
    fn a_program_that_is_not_there_has_no_window() {
        assert!(run(Command::new("/nowhere/testbed")).is_err());
    }
}
