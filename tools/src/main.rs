//! The `airlight` command: samples wavefronts and measures what the library promises.
//!
//! This file is the command line alone; each subcommand is a file with an `Args` and a `run`.

mod accuracy;
mod arguments;
mod check;
mod integral;
mod npy;
mod output;
mod profile;
mod progress;
mod render;
mod report;
mod sample;
mod soak;
mod strata;
mod table;
mod validity;
mod variance;
mod wavefront;

use clap::error::ErrorKind;
use clap::{Parser, Subcommand};
use std::process::ExitCode;

/// Exit code of every failure, as clap's own for a malformed command line.
const FAILURE: u8 = 2;

/// Samples scattering distances for single scattering in homogeneous media, and measures the samplers.
///
/// Without a subcommand it runs `airlight sample` on a built-in wavefront.
#[derive(Debug, Parser)]
#[command(version)]
struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
}

#[derive(Debug, Subcommand)]
enum Command {
    Sample(sample::Args),
    Render(render::Args),
    Accuracy(accuracy::Args),
    Variance(variance::Args),
    Integral(integral::Args),
    Profile(profile::Args),
    Report(report::Args),
    Soak(soak::Args),
}

fn main() -> ExitCode {
    let command = match command() {
        Ok(command) => command,
        Err(error) if error.kind() == ErrorKind::ValueValidation => {
            // A refused value is told in one line, like any other bad input.
            let told = error.to_string();
            eprintln!("{}", told.lines().next().unwrap_or_default());
            return ExitCode::from(FAILURE);
        }
        Err(error) => error.exit(),
    };
    let done = match command {
        Command::Sample(args) => sample::run(&args).map(|()| ExitCode::SUCCESS),
        Command::Render(args) => render::run(&args).map(|()| ExitCode::SUCCESS),
        Command::Accuracy(args) => accuracy::run(&args),
        Command::Variance(args) => variance::run(&args).map(|()| ExitCode::SUCCESS),
        Command::Integral(args) => integral::run(&args).map(|()| ExitCode::SUCCESS),
        Command::Profile(args) => profile::run(&args).map(|()| ExitCode::SUCCESS),
        Command::Report(args) => report::run(&args).map(|()| ExitCode::SUCCESS),
        Command::Soak(args) => soak::run(&args),
    };
    match done {
        Ok(code) => code,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::from(FAILURE)
        }
    }
}

fn command() -> Result<Command, clap::Error> {
    match Cli::try_parse()?.command {
        Some(command) => Ok(command),
        None => Cli::try_parse_from(["airlight", "sample"]).map(|cli| cli.command.expect("a subcommand was given")),
    }
}
