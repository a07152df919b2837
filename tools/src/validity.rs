//! Which rays of a wavefront are valid, and what is said of those that are not.

use anyhow::{Result, bail};
use serde::Serialize;
use std::fmt;

/// The rays of a wavefront, told apart.
#[derive(Debug)]
pub(crate) struct Validity {
    /// The valid ones, in ascending order.
    pub(crate) valid: Vec<usize>,
    /// The others, if there are any.
    pub(crate) invalid: Option<Invalid>,
}

/// The names of the fields are keys of the JSON, which others read.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Invalid {
    count: usize,
    /// The index of the first one, from 0, and what is wrong with it.
    first: usize,
    reason: String,
    #[serde(skip)]
    of: usize,
}

impl Validity {
    /// Checks the rays below `rays`.
    pub(crate) fn of(rays: usize, check: impl Fn(usize) -> Result<()>) -> Self {
        let mut validity = Self { valid: Vec::new(), invalid: None };
        for ray in 0..rays {
            match (check(ray), &mut validity.invalid) {
                (Ok(()), _) => validity.valid.push(ray),
                (Err(_), Some(invalid)) => invalid.count += 1,
                (Err(error), first @ None) => {
                    *first = Some(Invalid { count: 1, first: ray, reason: error.to_string(), of: rays });
                }
            }
        }
        validity
    }

    /// The valid ones of the first `count` rays.
    ///
    /// # Errors
    /// If there is none.
    pub(crate) fn first(&self, count: usize) -> Result<&[usize]> {
        let valid = &self.valid[..self.valid.partition_point(|&ray| ray < count)];
        match &self.invalid {
            Some(Invalid { first, reason, .. }) if valid.is_empty() => {
                bail!("none of {count} rays is valid, the first is ray {first}: {reason}")
            }
            _ => Ok(valid),
        }
    }
}

impl fmt::Display for Invalid {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { count, first, reason, of } = self;
        let are = if *count == 1 { "is" } else { "are" };
        write!(f, "{count} of {of} rays {are} invalid, the first is ray {first}: {reason}")
    }
}
