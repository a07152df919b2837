//! A picture: linear radiance, row by row from the top.

use std::fmt;
use std::str::FromStr;

/// Width and height in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Size {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
}

impl Size {
    /// The longest side: its films still fit into the memory of a small machine.
    pub const LONGEST: usize = 4096;

    /// How many pixels there are.
    #[must_use]
    pub fn pixels(self) -> usize {
        self.width * self.height
    }
}

impl FromStr for Size {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        let sides = text.split_once(['x', 'X']).map(|(width, height)| [width, height].map(str::parse));
        match sides {
            Some([Ok(width @ 1..=Self::LONGEST), Ok(height @ 1..=Self::LONGEST)]) => Ok(Self { width, height }),
            _ => Err(format!("expected WIDTHxHEIGHT in pixels, each from 1 to {}", Self::LONGEST)),
        }
    }
}

impl fmt::Display for Size {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}x{}", self.width, self.height)
    }
}

/// Linear red, green and blue of every pixel.
#[derive(Clone, Debug)]
pub struct Picture {
    /// Its size.
    pub size: Size,
    /// Row by row from the top.
    pub rgb: Vec<[f32; 3]>,
}

impl Picture {
    /// A black one.
    #[must_use]
    pub fn black(size: Size) -> Self {
        Self { size, rgb: vec![[0.0; 3]; size.pixels()] }
    }
}
