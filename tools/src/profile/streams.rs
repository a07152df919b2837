//! Columns that are read or written and hardly computed with: what memory allows.

use airlight_tools::workload::Call;
use rayon::prelude::*;
use std::hint::black_box;

/// Rays that a thread takes at a time, as the library does.
const CHUNK: usize = 4096;
/// Columns that a sample reads and writes.
const READ: usize = 9;
const WRITTEN: usize = 2;

/// A way through the columns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Stream {
    /// Reads what a sample reads.
    Read,
    /// Writes what it writes.
    Write,
    /// Does both.
    Both,
}

impl Stream {
    pub(super) const ALL: [Self; 3] = [Self::Read, Self::Write, Self::Both];

    /// Its name as a limit.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Read => "read",
            Self::Write => "write",
            Self::Both => "stream",
        }
    }

    pub(super) fn bytes_per_ray(self) -> usize {
        let columns = match self {
            Self::Read => READ,
            Self::Write => WRITTEN,
            Self::Both => READ + WRITTEN,
        };
        columns * size_of::<f32>()
    }

    /// Goes through all rays once.
    pub(super) fn run(self, call: &mut Call<'_>) {
        let rays = call.rays;
        let ([ox, oy, oz], [dx, dy, dz]) = (rays.origin, rays.direction);
        let read: [&[f32]; READ] = [ox, oy, oz, dx, dy, dz, rays.t_min, rays.t_max, call.u];
        let written = call.samples.t.par_chunks_mut(CHUNK).zip(call.samples.pdf.par_chunks_mut(CHUNK));
        written.enumerate().for_each(|(chunk, (t, pdf))| {
            let (start, length) = (CHUNK * chunk, t.len());
            let read = read.map(|column| &column[start..start + length]);
            match self {
                Self::Read => {
                    black_box(sum(read));
                }
                Self::Write => {
                    let value = black_box(1.0);
                    t.iter_mut().zip(pdf).for_each(|(t, pdf)| (*t, *pdf) = (value, value));
                }
                Self::Both => both(read, t, pdf),
            }
        });
    }
}

/// The sum of all columns but for less than 16 rays, in as many parts: they hide the latency of an addition.
fn sum(columns: [&[f32]; READ]) -> f32 {
    let columns = columns.map(|column| column.as_chunks::<16>().0);
    let mut parts = [0.0; 16];
    for row in 0..columns[0].len() {
        for column in columns {
            parts.iter_mut().zip(&column[row]).for_each(|(part, x)| *part += x);
        }
    }
    parts.iter().sum()
}

fn both([a, b, c, d, e, f, g, h, u]: [&[f32]; READ], t: &mut [f32], pdf: &mut [f32]) {
    let columns = a.iter().zip(b).zip(c).zip(d).zip(e).zip(f).zip(g).zip(h).zip(u);
    for ((((((((((a, b), c), d), e), f), g), h), u), t), pdf) in columns.zip(t).zip(pdf) {
        *t = (a + b) + (c + d);
        *pdf = (e + f) + (g + h) + u;
    }
}
