//! Completions of the command line for shells.

use clap_complete::Shell;
use std::io;

/// Print the completions of this command for a shell
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  airlight completions bash > ~/.local/share/bash-completion/completions/airlight")]
pub(crate) struct Args {
    /// The shell
    shell: Shell,
}

pub(crate) fn run(args: &Args, command: &mut clap::Command) {
    clap_complete::generate(args.shell, command, "airlight", &mut io::stdout());
}
