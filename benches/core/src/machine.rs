//! Operating system parts of a measurement: cores, and their load.
//!
//! On systems other than Linux, processes are not pinned, and disturbed runs are not detected.

/// Pins the process to as many cores as the run may use, from the end of the list, before any engine starts a
/// thread. So "1 thread" means one core for every engine.
#[cfg(target_os = "linux")]
#[expect(unsafe_code, reason = "the C library's calls")]
pub fn pin(threads: usize) {
    let size = std::mem::size_of::<libc::cpu_set_t>();
    // SAFETY: a `cpu_set_t` is plain bits, for which all zeroes are an empty set, and both calls are
    // given its size.
    unsafe {
        let mut all: libc::cpu_set_t = std::mem::zeroed();
        if libc::sched_getaffinity(0, size, &mut all) != 0 {
            return;
        }
        let cores: Vec<usize> =
            (0..libc::CPU_SETSIZE as usize).filter(|core| libc::CPU_ISSET(*core, &all)).collect();
        let mut mine: libc::cpu_set_t = std::mem::zeroed();
        cores.iter().rev().take(threads).for_each(|core| libc::CPU_SET(*core, &mut mine));
        libc::sched_setaffinity(0, size, &mine);
    }
}

/// Does nothing here.
#[cfg(not(target_os = "linux"))]
pub fn pin(_threads: usize) {}

/// Resources used by processes.
#[derive(Clone, Copy, Debug, Default)]
pub struct Usage {
    /// CPU time in seconds.
    pub cpu_s: f64,
    /// Peak memory in MiB.
    pub peak_mb: f64,
}

impl Usage {
    /// Of this process.
    pub fn own() -> Self {
        Self::of(libc::RUSAGE_SELF)
    }

    /// Of all children that were waited for.
    pub fn children() -> Self {
        Self::of(libc::RUSAGE_CHILDREN)
    }

    #[expect(unsafe_code, reason = "the C library's calls")]
    fn of(whose: libc::c_int) -> Self {
        // SAFETY: a `rusage` is plain numbers, which the call fills in.
        let usage = unsafe {
            let mut usage: libc::rusage = std::mem::zeroed();
            libc::getrusage(whose, &mut usage);
            usage
        };
        let seconds = |t: libc::timeval| t.tv_sec as f64 + t.tv_usec as f64 * 1e-6;
        Self {
            cpu_s: seconds(usage.ru_utime) + seconds(usage.ru_stime),
            peak_mb: usage.ru_maxrss as f64 / 1024.0,
        }
    }
}

/// CPU time that all processes have used so far, and that the host of a virtual machine gave to
/// others, in seconds.
pub fn busy_s() -> f64 {
    /// The kernel counts in hundredths of a second.
    const HZ: f64 = 100.0;
    let stat = std::fs::read_to_string("/proc/stat").unwrap_or_default();
    let line = stat.lines().next().unwrap_or("");
    let ticks: Vec<f64> = line.split_whitespace().skip(1).filter_map(|x| x.parse().ok()).collect();
    // user, nice, system, idle, waiting, interrupts (hard, soft), stolen: all but the idle ones.
    match ticks[..] {
        [user, nice, system, _, _, hard, soft, stolen, ..] => {
            (user + nice + system + hard + soft + stolen) / HZ
        }
        _ => 0.0,
    }
}
