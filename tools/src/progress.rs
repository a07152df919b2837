//! A progress bar on standard error, hidden where that is no terminal.

use anyhow::Result;
use indicatif::{ProgressBar, ProgressStyle};

pub(crate) fn bar(steps: usize) -> Result<ProgressBar> {
    let style = ProgressStyle::with_template("{msg:36} {wide_bar} {percent:>3} %  {eta}")?;
    Ok(ProgressBar::new(steps as u64).with_style(style))
}

/// The part that one measurement has in a bar.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Part<'a> {
    bar: &'a ProgressBar,
    /// What a step of the measurement is in steps of the bar.
    step: usize,
}

impl<'a> Part<'a> {
    /// All of a bar.
    pub(crate) fn whole(bar: &'a ProgressBar) -> Self {
        Self::weighted(bar, 1)
    }

    /// Of a bar that several measurements share, whose steps take differently long.
    pub(crate) fn weighted(bar: &'a ProgressBar, step: usize) -> Self {
        Self { bar, step }
    }

    /// Tells what is going on.
    pub(crate) fn tell(&self, message: impl Into<String>) {
        self.bar.set_message(message.into());
    }

    /// So many more steps are done.
    pub(crate) fn inc(&self, steps: usize) {
        self.bar.inc(steps.saturating_mul(self.step) as u64);
    }
}
