//! Where and when the report was made.

use std::fs;
use std::time::SystemTime;

/// The processor's name and the number of its threads.
pub(super) fn name() -> String {
    let cpuinfo = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = cpuinfo.lines().find_map(|line| Some(line.strip_prefix("model name")?.split_once(':')?.1.trim()));
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let plural = if threads == 1 { "" } else { "s" };
    format!("{}, {threads} hardware thread{plural}", model.unwrap_or(std::env::consts::ARCH))
}

/// Day and time in UTC.
pub(super) fn date() -> String {
    humantime::format_rfc3339_seconds(SystemTime::now()).to_string()
}
