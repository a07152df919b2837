//! The `airlight` command: samples wavefronts and measures what the library promises.
//!
//! This file is the command line alone; each subcommand is a file with an `Args` and a `run`.

mod accuracy;
mod arguments;
mod check;
mod completions;
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
use clap::{ColorChoice, CommandFactory, FromArgMatches, Parser, Subcommand};
use std::env;
use std::process::ExitCode;

/// Exit code of every failure, as clap's own for a malformed command line.
const FAILURE: u8 = 2;

/// Samples scattering distances for single scattering in homogeneous media, and measures the samplers.
///
/// Without a subcommand it runs `airlight sample` on a built-in wavefront.
#[derive(Debug, Parser)]
#[command(version, after_help = EXIT_CODES)]
struct Cli {
    /// Colours in help and in error messages
    #[arg(long, global = true, value_enum, default_value = "auto", value_name = "WHEN")]
    color: ColorChoice,

    #[command(subcommand)]
    command: Option<Command>,
}

const EXIT_CODES: &str = "\
Exit codes:
  0  done
  1  a promise is broken (accuracy, soak)
  2  any other failure; one line on standard error says which";

/// Subcommands by what they are for, as help lists them.
const GROUPS: [(&str, &[&str]); 2] = [
    ("Use", &["sample", "render", "completions"]),
    ("Measure", &["accuracy", "variance", "integral", "profile", "report", "soak"]),
];

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
    Completions(completions::Args),
}

fn main() -> ExitCode {
    let command = match command() {
        Ok(command) => command,
        Err(error) if error.kind() == ErrorKind::ValueValidation => {
            // A refused value is reported in one line, like any other bad input.
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
        Command::Completions(args) => {
            completions::run(&args, &mut cli());
            Ok(ExitCode::SUCCESS)
        }
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
    let matches = cli().try_get_matches()?;
    match Cli::from_arg_matches(&matches)?.command {
        Some(command) => Ok(command),
        None => Cli::try_parse_from(["airlight", "sample"]).map(|cli| cli.command.expect("a subcommand was given")),
    }
}

/// The command line, with its subcommands in groups and in the colours that are asked for.
fn cli() -> clap::Command {
    let command = Cli::command().color(color(env::args()));
    let line = |name: &&str| {
        let about = command.find_subcommand(name).and_then(clap::Command::get_about).expect("a subcommand");
        format!("  {name:11}  {about}\n")
    };
    let group =
        |(title, names): &(&str, &[&str])| format!("{title}:\n{}\n", names.iter().map(line).collect::<String>());
    let groups: String = GROUPS.iter().map(group).collect();
    command.help_template(format!(
        "{{about-with-newline}}\n{{usage-heading}} {{usage}}\n\n{groups}Options:\n{{options}}{{after-help}}"
    ))
}

/// What `--color` says, before anything is parsed: errors have colours too.
fn color(args: impl Iterator<Item = String>) -> ColorChoice {
    let mut args = args.skip_while(|arg| !arg.starts_with("--color"));
    let given = args.next().and_then(|arg| match arg.split_once('=') {
        Some((_, when)) => Some(when.to_owned()),
        None => args.next(),
    });
    given.and_then(|when| when.parse().ok()).unwrap_or(ColorChoice::Auto)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_subcommand_is_in_one_group() {
        let mut grouped: Vec<&str> = GROUPS.iter().flat_map(|(_, names)| *names).copied().collect();
        grouped.sort_unstable();
        let command = Cli::command();
        let mut all: Vec<&str> = command.get_subcommands().map(clap::Command::get_name).collect();
        all.sort_unstable();
        assert_eq!(grouped, all);
        cli().debug_assert();
    }

    #[test]
    fn colours_are_what_was_asked_for() {
        let choice = |args: &[&str]| color(args.iter().map(|arg| (*arg).to_owned()));
        assert_eq!(choice(&["airlight", "sample"]), ColorChoice::Auto);
        assert_eq!(choice(&["airlight", "--color", "never", "sample"]), ColorChoice::Never);
        assert_eq!(choice(&["airlight", "sample", "--color=always"]), ColorChoice::Always);
    }
}
