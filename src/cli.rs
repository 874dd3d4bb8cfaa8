//! The command line: arguments in, exit code out.

mod args;
mod compare;
mod console;
mod delivery;
mod doctor;
mod interrupt;
mod plan;
mod progress;
mod reference;
mod render;
mod report;

use args::{Arguments, Command};
use clap::Parser;
use clap::error::ErrorKind;
use console::Console;
use gpu_trace::Error;
use plan::Plan;
use std::io::Write;
use std::process::ExitCode;

/// Wrong arguments, as clap and most programs have it.
const EXIT_USAGE: u8 = 2;
/// 128 + SIGINT, as a shell reports a program that an interrupt ended.
const EXIT_INTERRUPTED: u8 = 130;

/// Runs the program with the process's arguments. The exit code is 0 only for success, which for a scene is that
/// every picture was written.
pub fn run() -> ExitCode {
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(error) => return usage(&error),
    };
    let plan = match arguments.render.as_ref().map(Plan::new).transpose() {
        Ok(plan) => plan,
        Err(error) => return usage(&error),
    };
    let console = Console::new(arguments.quiet, arguments.verbose);
    let result = match (&arguments.command, arguments.render.as_ref().zip(plan)) {
        (Some(Command::Doctor), _) => doctor::run(),
        (Some(Command::Compare(arguments)), _) => compare::run(arguments),
        (None, Some((arguments, plan))) => render::run(arguments, &plan, &console),
        // clap asks for a scene where there is no subcommand.
        (None, None) => Err(Error::Scene("no scene was given; see --help".to_owned())),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        // Whoever was interrupted has said what there is to show for it.
        Err(Error::Interrupted) => ExitCode::from(EXIT_INTERRUPTED),
        Err(error) => {
            console.error(&error.to_string());
            ExitCode::FAILURE
        }
    }
}

/// Help and version go to stdout and succeed; anything else is an error.
fn usage(error: &clap::Error) -> ExitCode {
    if error.use_stderr() && error.kind() != ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand {
        let _ = write!(std::io::stderr(), "gpu-trace: ");
    }
    // Whoever closed the pipe has seen what they wanted.
    let _ = error.print();
    if error.use_stderr() { ExitCode::from(EXIT_USAGE) } else { ExitCode::SUCCESS }
}
