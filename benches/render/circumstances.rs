//! When, where and on what code the figures were found.

use serde::Serialize;
use std::process::Command;

#[derive(Debug, Serialize)]
pub struct Circumstances {
    /// Coordinated universal time, as in 2026-11-25T09:00:00Z.
    pub date: String,
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
            date: format!("{:.0}", jiff::Timestamp::now()),
            commit: if changed { commit + "+" } else { commit },
            processor: std::fs::read_to_string("/proc/cpuinfo").ok().and_then(model).unwrap_or_default(),
            cores: std::thread::available_parallelism().map_or(0, usize::from),
        }
    }
}
