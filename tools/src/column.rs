//! A column that shares its set of the cache with no other one.

/// Floats of a page: addresses that are equal but for whole pages compete for one set of the first cache.
const PAGE: usize = 1024;
/// Floats between the offsets of a column and the next one, 256 bytes.
const STAGGER: usize = 64;

/// Equal columns that are allocated one by one share their address modulo 4096, and go through the cache up to 1.7 times
/// as slowly. Each of these starts 256 bytes after where the one before does, modulo 4096.
#[derive(Debug)]
pub struct Column {
    padded: Vec<f32>,
    start: usize,
}

impl Column {
    /// `n` zeros, as column number `index` of those that are used together.
    #[must_use]
    pub fn new(index: usize, n: usize) -> Self {
        let padded = vec![0.0; n + PAGE];
        let (at, wanted) = (padded.as_ptr().addr() / 4 % PAGE, STAGGER * index % PAGE);
        let start = (wanted + PAGE - at) % PAGE;
        Self { padded, start }
    }

    /// The first `n` values.
    #[must_use]
    pub fn of(&self, n: usize) -> &[f32] {
        &self.padded[self.start..self.start + n]
    }

    /// The same, to be written.
    pub fn of_mut(&mut self, n: usize) -> &mut [f32] {
        &mut self.padded[self.start..self.start + n]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_start_256_bytes_after_each_other_modulo_4096() {
        let columns: Vec<Column> = (0..16).map(|index| Column::new(index, 1 << 18)).collect();
        let offset = |column: &Column| column.of(1).as_ptr().addr() % 4096;
        for (index, column) in columns.iter().enumerate() {
            assert_eq!(offset(column), 256 * index);
        }
    }
}
