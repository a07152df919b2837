//! The number of evaluations of an integral.

use std::fmt;
use std::str::FromStr;

/// The number of nodes of an [`Integral`](crate::Integral): evaluations of the integrand for each ray. Errors are in the table of
/// [`Integral`](crate::Integral#accuracy), times in [speed](crate::guide::speed#other-calls).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Nodes {
    /// To choose between emitters, or to guide.
    Four,
    /// For previews.
    Six,
    /// As exact as f32 in ordinary scenes.
    #[default]
    Eight,
    /// For thin media without an end, forward peaks, and next to emitters.
    Twelve,
}

impl Nodes {
    /// All numbers of nodes, ascending.
    pub const ALL: &'static [Self] = &[Self::Four, Self::Six, Self::Eight, Self::Twelve];

    /// The number as an integer.
    #[must_use]
    pub fn count(self) -> usize {
        match self {
            Self::Four => 4,
            Self::Six => 6,
            Self::Eight => 8,
            Self::Twelve => 12,
        }
    }
}

impl fmt::Display for Nodes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(&self.count(), f)
    }
}

/// The error of parsing [`Nodes`]: the text is none of the numbers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownNodes(String);

impl fmt::Display for UnknownNodes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "no integral has '{}' nodes; there are", self.0)?;
        for (i, nodes) in Nodes::ALL.iter().enumerate() {
            write!(f, "{} {nodes}", if i == 0 { "" } else { "," })?;
        }
        Ok(())
    }
}

impl std::error::Error for UnknownNodes {}

impl FromStr for Nodes {
    type Err = UnknownNodes;
    fn from_str(text: &str) -> Result<Self, UnknownNodes> {
        let count = text.parse().ok();
        let found = Self::ALL.iter().copied().find(|nodes| Some(nodes.count()) == count);
        found.ok_or_else(|| UnknownNodes(text.to_owned()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_read_as_they_are_written() {
        for &nodes in Nodes::ALL {
            assert_eq!(nodes.to_string().parse(), Ok(nodes));
        }
    }
}
