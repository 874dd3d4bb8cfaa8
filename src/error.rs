//! Everything that can go wrong, in the words that a user reads.

use std::path::{Path, PathBuf};

/// Why no picture came out. `Display` is the message for the user, without a leading "error:".
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The scene script failed: a Lua error, or a `gr.*` call with a bad argument.
    /// `message` starts with `file:line:` where one is known; `calls` is the chain of Lua calls, innermost first.
    #[error("{message}{}", call_chain(calls))]
    Script { message: String, calls: Vec<String> },

    /// A file could not be read or written. `action` is what was being tried: "read the scene", "write the picture".
    #[error("cannot {action} '{}': {source}", path.display())]
    File { action: &'static str, path: PathBuf, source: std::io::Error },

    /// A file that holds something other than what was expected.
    #[error("{}: {message}", path.display())]
    Format { path: PathBuf, message: String },

    /// A scene that cannot be rendered as described (sizes, counts, degenerate transforms).
    #[error("{0}")]
    Scene(String),

    /// A buffer would pass a limit of the device.
    #[error(
        "the scene's {buffer} need {needed} bytes, more than {limit_name} = {limit} of {device}; \
         use a device with a larger limit, or --device cpu"
    )]
    Limit { buffer: &'static str, needed: u64, limit_name: &'static str, limit: u64, device: String },

    /// No device of the kind that was asked for.
    #[error("{0}")]
    Device(String),

    /// A shader does not compile; the message names the file and line of the part it came from.
    #[error("{0}")]
    Shader(String),

    /// The kernel reported that a bound was reached even with the smallest batch.
    #[error("{0}")]
    Kernel(String),

    /// The user asked to stop.
    #[error("interrupted; nothing was written")]
    Interrupted,
}

impl Error {
    pub fn file(action: &'static str, path: &Path, source: std::io::Error) -> Self {
        Error::File { action, path: path.to_owned(), source }
    }
}

fn call_chain(calls: &[String]) -> String {
    calls.iter().map(|call| format!("\n  {call}")).collect()
}

pub type Result<T, E = Error> = std::result::Result<T, E>;
