//! A progress bar on standard error, hidden where that is no terminal.

use anyhow::Result;
use indicatif::{ProgressBar, ProgressStyle};

pub(crate) fn bar(rays: usize) -> Result<ProgressBar> {
    let style = ProgressStyle::with_template("{msg:36} {wide_bar} {percent:>3} %  {eta}")?;
    Ok(ProgressBar::new(rays as u64).with_style(style))
}
