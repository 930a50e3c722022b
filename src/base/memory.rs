//! Memory that this process may still use.

use std::fs::read_to_string;

/// Bytes that are free, as the system and the process's control group say; `None` where neither does.
pub fn available() -> Option<u64> {
    let system = read_to_string("/proc/meminfo").ok().and_then(|text| free_of(&text));
    [system, group()].into_iter().flatten().min()
}

/// `MemAvailable` of /proc/meminfo, bytes.
fn free_of(meminfo: &str) -> Option<u64> {
    let line = meminfo.lines().find_map(|line| line.strip_prefix("MemAvailable:"))?;
    line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()?.checked_mul(1024)
}

/// What the control group leaves, where it has a limit.
fn group() -> Option<u64> {
    let number = |name: &str| read_to_string(format!("/sys/fs/cgroup/{name}")).ok()?.trim().parse::<u64>().ok();
    Some(number("memory.max")?.saturating_sub(number("memory.current")?))
}

/// Bytes as people read them.
pub fn shown(bytes: u64) -> String {
    match bytes {
        0..1_000_000_000 => format!("{} MB", bytes.div_ceil(1_000_000)),
        _ => format!("{:.1} GB", bytes as f64 / 1e9),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_system_is_understood() {
        assert_eq!(free_of("MemTotal:  100 kB\nMemAvailable:     42 kB\n"), Some(43_008));
        assert_eq!(free_of("MemTotal: 100 kB\n"), None);
        assert_eq!([shown(1), shown(44_200_000_000)], ["1 MB", "44.2 GB"]);
    }
}
