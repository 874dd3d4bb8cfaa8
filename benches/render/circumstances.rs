//! When, where and on what code the figures were found.

use serde::Serialize;
use std::process::Command;
use std::time::{SystemTime, UNIX_EPOCH};

#[derive(Debug, Serialize)]
pub struct Circumstances {
    /// Seconds since 1970.
    pub unix_time: u64,
    /// Abbreviated, with a `+` where files differ from it; empty outside a repository.
    pub commit: String,
    /// As Linux names it; empty on other systems.
    pub processor: String,
    pub cores: usize,
}

impl Circumstances {
    pub fn now() -> Self {
        let git = |arguments: &[&str]| {
            let output = Command::new("git").args(arguments).output().ok()?;
            output.status.success().then(|| String::from_utf8_lossy(&output.stdout).trim().to_owned())
        };
        let commit = git(&["rev-parse", "--short", "HEAD"]).unwrap_or_default();
        let changed = git(&["status", "--porcelain"]).is_some_and(|files| !files.is_empty());
        let model = |text: String| {
            let line = text.lines().find(|line| line.starts_with("model name"))?.to_owned();
            line.split_once(':').map(|(_, name)| name.trim().to_owned())
        };
        Circumstances {
            unix_time: SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |time| time.as_secs()),
            commit: if changed { commit + "+" } else { commit },
            processor: std::fs::read_to_string("/proc/cpuinfo").ok().and_then(model).unwrap_or_default(),
            cores: std::thread::available_parallelism().map_or(0, usize::from),
        }
    }
}
