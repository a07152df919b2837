//! Columns that a stage fills, each value by its place alone.

use airlight::Medium;
use glam::Vec3;
use rayon::prelude::*;

/// Places that a thread takes at a time.
pub(super) const STRIDE: usize = 1024;

/// Vectors as one column per axis, the form in which airlight takes them.
#[derive(Clone, Debug, Default)]
pub struct Vectors([Vec<f32>; 3]);

impl Vectors {
    /// The columns x, y, z.
    #[must_use]
    pub fn columns(&self) -> [&[f32]; 3] {
        self.0.each_ref().map(Vec::as_slice)
    }

    /// Vector number `i`.
    #[must_use]
    pub fn at(&self, i: usize) -> Vec3 {
        Vec3::from_array(self.0.each_ref().map(|column| column[i]))
    }

    /// How many there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.0[0].len()
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.0[0].is_empty()
    }

    /// `count` vectors, each what `value` has for its place.
    pub fn fill(&mut self, count: usize, value: impl Fn(usize) -> Vec3 + Sync) {
        self.places(count).enumerate().for_each(|(i, place)| place.put(value(i)));
    }

    /// The places of `count` vectors, to be filled together with those of other columns.
    pub fn places(&mut self, count: usize) -> impl IndexedParallelIterator<Item = Place<'_>> {
        let [x, y, z] = self.0.each_mut();
        (places(x, count), places(y, count), places(z, count)).into_par_iter().map(|(x, y, z)| Place { x, y, z })
    }
}

/// The place of a vector.
#[derive(Debug)]
pub struct Place<'a> {
    x: &'a mut f32,
    y: &'a mut f32,
    z: &'a mut f32,
}

impl Place<'_> {
    /// Writes it.
    pub fn put(self, vector: Vec3) {
        [*self.x, *self.y, *self.z] = vector.to_array();
    }

    /// Reads it.
    #[must_use]
    pub fn get(&self) -> Vec3 {
        Vec3::new(*self.x, *self.y, *self.z)
    }
}

/// Values per channel, as airlight writes them: one column for all channels of a grey medium, else red, green and blue.
#[derive(Clone, Debug, Default)]
pub struct Tones([Vec<f32>; 3]);

/// Columns to write to, as many as a medium has channels.
#[derive(Debug)]
pub enum Channels<'a> {
    /// One for all.
    Grey([&'a mut [f32]; 1]),
    /// Red, green and blue.
    Rgb([&'a mut [f32]; 3]),
}

impl Tones {
    /// The places of `count` values in `medium`.
    pub fn places(&mut self, medium: &Medium, count: usize) -> Channels<'_> {
        let is_grey = medium.channels() == 1;
        for (c, column) in self.0.iter_mut().enumerate() {
            column.resize(if is_grey && c > 0 { 0 } else { count }, 0.0);
        }
        let [red, green, blue] = self.0.each_mut().map(Vec::as_mut_slice);
        if is_grey { Channels::Grey([red]) } else { Channels::Rgb([red, green, blue]) }
    }

    /// Multiplies value number `i` by `factor(i)` in every channel.
    pub fn scale(&mut self, factor: impl Fn(usize) -> f32) {
        for column in &mut self.0 {
            column.iter_mut().enumerate().for_each(|(i, value)| *value *= factor(i));
        }
    }

    /// Value number `i`.
    #[must_use]
    pub fn at(&self, i: usize) -> Vec3 {
        let [red, green, blue] = &self.0;
        if green.is_empty() { Vec3::splat(red[i]) } else { Vec3::new(red[i], green[i], blue[i]) }
    }
}

/// The places of `count` values.
pub fn places<T: Clone + Default + Send>(
    column: &mut Vec<T>,
    count: usize,
) -> impl IndexedParallelIterator<Item = &mut T> {
    column.resize(count, T::default());
    column.par_iter_mut().with_min_len(STRIDE)
}
