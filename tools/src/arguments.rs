//! Arguments that several subcommands share.

use crate::output::Target;
use airlight::{Backend, Medium, Precision, Sampler, Strategy};
use anyhow::Result;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Where the figures go beside the table.
#[derive(Debug, Default, clap::Args)]
pub(crate) struct Json {
    /// Write the figures as JSON, to standard output instead of the table if FILE is '-'
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

impl Json {
    /// The destination, refused at once if it cannot be written.
    pub(crate) fn target(&self) -> Result<Option<Target>> {
        self.json
            .as_deref()
            .map(|path| if path == Path::new("-") { Ok(Target::Stdout) } else { Target::file(path) })
            .transpose()
    }
}

/// Which densities are measured, and how exactly they compute.
#[derive(Debug, clap::Args)]
pub(crate) struct Samplers {
    /// Strategy to measure, may be repeated [default: all]
    #[arg(long, value_name = "NAME")]
    strategy: Vec<Strategy>,
    /// Precision to measure, exact or fast, may be repeated [default: all that the strategy has]
    #[arg(long, value_name = "NAME")]
    precision: Vec<Precision>,
}

impl Samplers {
    /// All of them.
    ///
    /// # Errors
    /// As [`samplers`].
    pub(crate) fn all(&self) -> Result<Vec<Sampler>> {
        samplers(&self.strategy, &self.precision)
    }
}

/// A sampler of every strategy in every precision. Of an empty list it takes all, less what does not go together.
///
/// # Errors
/// Where a strategy that was asked for has not a precision that was asked for.
pub(crate) fn samplers(strategies: &[Strategy], precisions: &[Precision]) -> Result<Vec<Sampler>> {
    let asked = !strategies.is_empty() && !precisions.is_empty();
    let strategies = if strategies.is_empty() { Strategy::ALL } else { strategies };
    let precisions = if precisions.is_empty() { Precision::ALL } else { precisions };
    let mut samplers = Vec::new();
    for &strategy in strategies {
        for &precision in precisions {
            match Sampler::new(strategy).with_precision(precision) {
                Ok(sampler) => samplers.push(sampler),
                Err(error) if asked => return Err(error.into()),
                Err(_) => {}
            }
        }
    }
    Ok(samplers)
}

/// What a subcommand makes of a command line.
pub(crate) fn parse<A: clap::Args>(line: &[String]) -> Result<A> {
    let command = A::augment_args(clap::Command::new("airlight").no_binary_name(true));
    Ok(A::from_arg_matches(&command.try_get_matches_from(line)?)?)
}

/// Reads a medium written as `mu_a,mu_s,g`, with `r:g:b` or four numbers for a coefficient that differs from channel to channel.
pub(crate) fn medium(text: &str) -> Result<Medium, String> {
    let expected =
        || "expected three numbers: mu_a,mu_s,g, with r:g:b for a coefficient of a coloured medium".to_owned();
    let numbers = |text: &str| text.split(':').map(|number| number.trim().parse().ok()).collect::<Option<Vec<f32>>>();
    let numbers: Option<Vec<Vec<f32>>> = text.split(',').map(numbers).collect();
    let Some([mu_a, mu_s, g]) = numbers.as_deref() else { return Err(expected()) };
    let &[g] = &g[..] else { return Err(expected()) };
    let medium = match mu_a.len().max(mu_s.len()) {
        1 => Medium::new(mu_a[0], mu_s[0], g),
        3 => Medium::coloured(channels::<3>(mu_a)?, channels(mu_s)?, g),
        4 => Medium::coloured(channels::<4>(mu_a)?, channels(mu_s)?, g),
        _ => return Err(expected()),
    };
    medium.map_err(|error| error.to_string())
}

/// As many values as the medium has channels, or one for all of them.
fn channels<const C: usize>(values: &[f32]) -> Result<[f32; C], String> {
    match values {
        [one] => Ok([*one; C]),
        values => values.try_into().map_err(|_| format!("a coefficient has {} channels, expected {C}", values.len())),
    }
}

/// Reads a whole number of at least 1.
pub(crate) fn positive(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(number) if number > 0 => Ok(number),
        _ => Err("expected a whole number of at least 1".to_owned()),
    }
}

/// Reads a number of threads that a machine can bear.
pub(crate) fn threads(text: &str) -> Result<usize, String> {
    match positive(text)? {
        number @ 1..=1024 => Ok(number),
        _ => Err("expected at most 1024 threads".to_owned()),
    }
}

/// Reads a number of rays that fit into memory at once.
pub(crate) fn batch(text: &str) -> Result<usize, String> {
    match positive(text)? {
        number if number <= 1 << 28 => Ok(number),
        _ => Err("expected at most 268435456 rays".to_owned()),
    }
}

/// Finds a backend by its name.
pub(crate) fn backend(name: &str) -> Result<Backend, String> {
    let names = || Backend::available().map(Backend::name).collect::<Vec<_>>().join(", ");
    Backend::available()
        .find(|backend| backend.name() == name)
        .ok_or_else(|| format!("this machine has no backend of that name; it has {}", names()))
}

/// Reads a number of seconds.
pub(crate) fn seconds(text: &str) -> Result<Duration, String> {
    time(text, 1.0).ok_or_else(|| "expected a number of seconds greater than 0".to_owned())
}

/// Reads a number of minutes.
pub(crate) fn minutes(text: &str) -> Result<Duration, String> {
    time(text, 60.0).ok_or_else(|| "expected a number of minutes greater than 0".to_owned())
}

/// A time in units of this many seconds.
fn time(text: &str, unit: f64) -> Option<Duration> {
    let number: f64 = text.parse().ok()?;
    Duration::try_from_secs_f64(number * unit).ok().filter(|time| !time.is_zero())
}
