//! `gpu-trace compare`.

use super::args::CompareArguments;
use gpu_trace::film::{Mask, compare_masked, read_picture};
use gpu_trace::{Error, Result};
use std::io::Write;
use std::path::Path;

/// Prints the line of the comparison.
///
/// # Errors
/// [`Error::Scene`] where the pictures cannot be compared, or differ more than `--fail-above` allows.
pub fn run(arguments: &CompareArguments) -> Result<()> {
    let reference = read_picture(&arguments.reference)?;
    let test = read_picture(&arguments.test)?;
    let comparison = compare_masked(&reference, &test, arguments.mask.map_or(Mask::None, Mask::from))?;
    print_line(&comparison.to_string())?;
    match arguments.fail_above {
        Some(threshold) if comparison.flip_mean > threshold => {
            Err(Error::Scene(format!("the FLIP mean {:.6} is above {threshold}", comparison.flip_mean)))
        }
        _ => Ok(()),
    }
}

/// One line on standard output. A reader that has gone away is no error: the exit code still tells the outcome.
pub fn print_line(line: &str) -> Result<()> {
    match writeln!(std::io::stdout(), "{line}") {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            Err(Error::file("write to", Path::new("standard output"), error))
        }
        _ => Ok(()),
    }
}
