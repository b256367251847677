//! The memory that one log may take.

use std::io::Result;

/// Half of the memory of the machine, or of the container if that is less. `None` where limits are not enforced.
#[cfg(target_os = "linux")]
pub(super) fn default_limit() -> Option<u64> {
    use std::fs::read_to_string;
    use std::path::Path;

    let machine = read_to_string("/proc/meminfo").ok().and_then(|text| {
        let line = text.lines().find_map(|line| line.strip_prefix("MemTotal:"))?;
        line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()
    });
    let groups = read_to_string("/proc/self/cgroup").unwrap_or_default();
    let limits = groups.lines().flat_map(|line| {
        // hierarchy:controllers:path; version 2 has no controllers.
        let mut fields = line.splitn(3, ':').skip(1);
        let (top, file) = match fields.next() {
            Some("") => ("/sys/fs/cgroup", "memory.max"),
            Some(controllers) if controllers.split(',').any(|name| name == "memory") => {
                ("/sys/fs/cgroup/memory", "memory.limit_in_bytes")
            }
            _ => return vec![],
        };
        // A container's own group is at the top of what it sees, whatever its path.
        let path = fields.next().unwrap_or_default().trim_start_matches('/');
        let groups = Path::new(path).ancestors().map(|group| Path::new(top).join(group).join(file));
        groups.filter_map(|file| read_to_string(file).ok()?.trim().parse::<u64>().ok()).collect()
    });
    limits.chain(machine.map(|kilobytes| kilobytes * 1024)).min().map(|bytes| bytes / 2)
}

/// The same elsewhere, where limits are not enforced.
#[cfg(not(target_os = "linux"))]
pub(super) fn default_limit() -> Option<u64> {
    None
}

/// Limits the address space of this process, and names it to the kernel as the first to end where memory runs out all the same.
#[cfg(target_os = "linux")]
pub(super) fn limit(bytes: u64) -> Result<()> {
    use rustix::process::{Resource, getrlimit, setrlimit};

    // A kernel without this file chooses by itself.
    let _ = std::fs::write("/proc/self/oom_score_adj", "1000");
    let mut limit = getrlimit(Resource::As);
    limit.current = Some(limit.maximum.map_or(bytes, |most| most.min(bytes)));
    Ok(setrlimit(Resource::As, limit)?)
}

/// The same elsewhere, where limits are not enforced.
#[cfg(not(target_os = "linux"))]
pub(super) fn limit(_bytes: u64) -> Result<()> {
    Ok(())
}
