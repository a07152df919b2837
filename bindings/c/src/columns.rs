//! The columns of a call: as they lie in the caller's memory, and block by block as slices.

use crate::abi::{airlight_column, airlight_index_column, airlight_index_output, airlight_output, airlight_status};
use crate::span::{Name, Span};
use crate::status::{Failure, Result};
use airlight::{Counts, Error, Threads};
use core::ops::Range;
use core::slice::{ChunksExactMut, from_raw_parts, from_raw_parts_mut};
use rayon::iter::{IntoParallelIterator, ParallelIterator};

/// The most values of a block: what airlight has one thread do at a time.
const BLOCK: usize = 4096;

/// Parts of a batch for each thread of the pool, as not all take as long.
const PARTS: usize = 4;

/// What columns consist of.
pub(crate) trait Cell: Copy + Default + 'static {
    const ZEROS: &'static [Self];

    /// Room for the values of a block.
    fn room<'s>(rooms: &mut Rooms<'s>) -> Option<&'s mut [Self]>;

    /// Where rooms of this kind are counted.
    fn count(rooms: &mut Needed) -> &mut usize;
}

impl Cell for f32 {
    const ZEROS: &'static [Self] = &[0.0; BLOCK];

    fn room<'s>(rooms: &mut Rooms<'s>) -> Option<&'s mut [Self]> {
        rooms.floats.next()
    }

    fn count(rooms: &mut Needed) -> &mut usize {
        &mut rooms.floats
    }
}

impl Cell for u32 {
    const ZEROS: &'static [Self] = &[0; BLOCK];

    fn room<'s>(rooms: &mut Rooms<'s>) -> Option<&'s mut [Self]> {
        rooms.indices.next()
    }

    fn count(rooms: &mut Needed) -> &mut usize {
        &mut rooms.indices
    }
}

/// How many rooms a block takes.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Needed {
    floats: usize,
    indices: usize,
}

/// Rooms that columns of a block may still take.
#[derive(Debug)]
pub(crate) struct Rooms<'s> {
    floats: ChunksExactMut<'s, f32>,
    indices: ChunksExactMut<'s, u32>,
}

/// Some values of a batch: so many of each of some rays.
#[derive(Clone, Debug)]
pub(crate) struct Block {
    pub(crate) rays: Range<usize>,
    values: Range<usize>,
}

/// A column that is read.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Input<T> {
    /// NULL: zeros.
    data: *const T,
    stride: usize,
    width: usize,
    is_slice: bool,
}

/// A column that is written.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Output<T> {
    /// NULL: nowhere.
    data: *mut T,
    stride: usize,
    width: usize,
    is_slice: bool,
}

// SAFETY: they stand for memory that the caller of the ABI lends to the call. Threads write to different elements of it, as
// their blocks differ and no output overlaps another column, and what they read is not written.
unsafe impl<T> Send for Input<T> {}
// SAFETY: as above.
unsafe impl<T> Sync for Input<T> {}
// SAFETY: as above.
unsafe impl<T> Send for Output<T> {}
// SAFETY: as above.
unsafe impl<T> Sync for Output<T> {}

/// A block of a column that is written.
#[derive(Debug)]
pub(crate) struct Open<'s, T> {
    pub(crate) values: &'s mut [T],
    column: Output<T>,
    block: Block,
}

impl Block {
    /// The numbers of an element of so many that belong to it: those of its values, or the only one.
    fn within(&self, width: usize) -> Range<usize> {
        if width == 1 { 0..1 } else { self.values.clone() }
    }

    /// Where its numbers lie in a column of such elements, if they lie next to each other.
    fn of_slice(&self, width: usize) -> Range<usize> {
        let within = self.within(width);
        let start = self.rays.start * width + within.start;
        start..start + self.rays.len() * within.len()
    }

    /// Visits its numbers, with how many bytes after the first one of a column with such elements each of them lies.
    fn walk<T>(&self, width: usize, stride: usize, numbers: &mut [T], mut visit: impl FnMut(&mut T, usize)) {
        let within = self.within(width);
        let mut offset = self.rays.start * stride + within.start * size_of::<T>();
        // Elements of one number in a loop of its own, which takes half the time.
        if within.len() == 1 {
            for number in numbers {
                visit(number, offset);
                offset = offset.wrapping_add(stride);
            }
            return;
        }
        for element in numbers.chunks_exact_mut(within.len()) {
            for (i, number) in element.iter_mut().enumerate() {
                visit(number, offset + i * size_of::<T>());
            }
            offset = offset.wrapping_add(stride);
        }
    }
}

impl<T: Cell> Input<T> {
    /// The numbers of a block, where they lie or gathered.
    pub(crate) fn read<'s>(&self, block: &Block, rooms: &mut Rooms<'s>) -> &'s [T] {
        let numbers = block.of_slice(self.width);
        if self.data.is_null() {
            return &T::ZEROS[..numbers.len()];
        }
        if self.is_slice {
            // SAFETY: the column is a slice of at least as many elements, which the caller lends to the call and no output
            // overlaps.
            return unsafe { from_raw_parts(self.data.add(numbers.start), numbers.len()) };
        }
        let room: &mut [T] = &mut room(rooms)[..numbers.len()];
        let from = self.data.cast::<u8>();
        block.walk(self.width, self.stride, room, |number, offset| {
            // SAFETY: a number of the column, within memory that the caller lends to the call.
            *number = unsafe { from.wrapping_add(offset).cast::<T>().read_unaligned() };
        });
        room
    }
}

impl<T: Cell> Output<T> {
    /// Room for the numbers of a block, where they are to lie or elsewhere.
    pub(crate) fn open<'s>(&self, block: &Block, rooms: &mut Rooms<'s>) -> Open<'s, T> {
        let numbers = block.of_slice(self.width);
        let values = if self.is_slice {
            // SAFETY: the column is a slice of at least as many elements, which the caller lends to the call. Blocks differ,
            // and no other column overlaps it.
            unsafe { from_raw_parts_mut(self.data.add(numbers.start), numbers.len()) }
        } else {
            &mut room(rooms)[..numbers.len()]
        };
        Open { values, column: *self, block: block.clone() }
    }
}

impl<T: Cell> Open<'_, T> {
    /// Takes the numbers to where they are to lie.
    pub(crate) fn close(self) {
        let Self { values, column: Output { data, stride, width, is_slice }, block } = self;
        if is_slice || data.is_null() {
            return;
        }
        let to = data.cast::<u8>();
        block.walk(width, stride, values, |number, offset| {
            // SAFETY: a number of the column, within memory that the caller lends to the call.
            unsafe { to.wrapping_add(offset).cast::<T>().write_unaligned(*number) };
        });
    }
}

/// `Ok` if columns are given for the channels and for no others, or none at all.
pub(crate) fn check_channels(name: &'static str, are_given: [bool; 4], channels: usize) -> Result<()> {
    let wrong = (0..4).find(|&c| are_given[c] != (c < channels));
    let Some(c) = wrong.filter(|_| are_given.contains(&true)) else { return Ok(()) };
    let found = if are_given[c] { "given" } else { "NULL" };
    let expected = match channels {
        1 => "one column".to_owned(),
        _ => format!("{channels} columns, one for each channel"),
    };
    let message = format!("{} is {found}, expected {expected}", Name(name, Some(c)));
    Err(Failure::new(airlight_status::Channels, message))
}

/// Room for a column of a block.
fn room<'s, T: Cell>(rooms: &mut Rooms<'s>) -> &'s mut [T] {
    T::room(rooms).expect("every column that needs room has been counted")
}

/// All columns of a call.
#[derive(Debug)]
pub(crate) struct Columns {
    rays: usize,
    inputs: Vec<Span>,
    outputs: Vec<Span>,
    needed: Needed,
    /// Whether all are slices.
    are_slices: bool,
}

impl Columns {
    /// None yet, of so many rays.
    pub(crate) fn new(rays: usize) -> Self {
        Self {
            rays,
            inputs: Vec::with_capacity(32),
            outputs: Vec::with_capacity(8),
            needed: Needed::default(),
            are_slices: true,
        }
    }

    /// A column with so many floats for each ray, which must be given.
    pub(crate) fn floats(&mut self, name: Name, column: airlight_column, width: usize) -> Result<Input<f32>> {
        self.input(name, column.data, column.stride, width)
    }

    /// A column with a float for each ray, zeros unless it is given.
    pub(crate) fn floats_or_zeros(&mut self, name: Name, column: airlight_column) -> Result<Input<f32>> {
        if column.data.is_null() {
            self.are_slices = false;
            return Ok(Input { data: column.data, stride: 0, width: 1, is_slice: false });
        }
        self.floats(name, column, 1)
    }

    /// A column with an index for each ray, which must be given.
    pub(crate) fn indices(&mut self, name: Name, column: airlight_index_column) -> Result<Input<u32>> {
        self.input(name, column.data, column.stride, 1)
    }

    /// Where so many floats for each ray are written, or nothing.
    pub(crate) fn output(&mut self, name: Name, column: airlight_output, width: usize) -> Result<Output<f32>> {
        self.written(name, column.data, column.stride, width)
    }

    /// The same, if anything is to be written.
    pub(crate) fn if_wanted(
        &mut self,
        name: Name,
        column: airlight_output,
        width: usize,
    ) -> Result<Option<Output<f32>>> {
        (!column.data.is_null()).then(|| self.output(name, column, width)).transpose()
    }

    /// Where so many floats for each ray are written in each of so many channels; nowhere if no column is given.
    pub(crate) fn channels(
        &mut self,
        name: &'static str,
        given: [airlight_output; 4],
        channels: usize,
        width: usize,
    ) -> Result<Vec<Output<f32>>> {
        check_channels(name, given.map(|column| !column.data.is_null()), channels)?;
        (0..channels).map(|c| self.output(Name(name, Some(c)), given[c], width)).collect()
    }

    /// Where an index for each ray is written, or nothing.
    pub(crate) fn index_output(&mut self, name: Name, column: airlight_index_output) -> Result<Output<u32>> {
        self.written(name, column.data, column.stride, 1)
    }

    /// Something else that is read, of which no number is a ray's: a table of so many floats.
    pub(crate) fn table(&mut self, name: Name, column: airlight_column, count: usize) -> Result<Vec<f32>> {
        if column.data.is_null() && count > 0 {
            return Err(Failure::null(format_args!("{name}.data")));
        }
        let span = Span::new(name, column.data.addr(), column.stride, [count, 1, size_of::<f32>()])?;
        self.inputs.push(span);
        let at = |i| column.data.wrapping_byte_add(i * span.stride);
        // SAFETY: an element of the column, within memory that the caller lends to the call.
        Ok((0..count).map(|i| unsafe { at(i).read_unaligned() }).collect())
    }

    fn input<T: Cell>(&mut self, name: Name, data: *const T, stride: usize, width: usize) -> Result<Input<T>> {
        if data.is_null() && self.rays > 0 {
            return Err(Failure::null(format_args!("{name}.data")));
        }
        let span = Span::new(name, data.addr(), stride, [self.rays, width, size_of::<T>()])?;
        let is_slice = self.is_slice::<T>(&span, data);
        self.inputs.push(span);
        Ok(Input { data, stride: span.stride, width, is_slice })
    }

    fn written<T: Cell>(&mut self, name: Name, data: *mut T, stride: usize, width: usize) -> Result<Output<T>> {
        let span = Span::new(name, data.addr(), stride, [self.rays, width, size_of::<T>()])?;
        let is_slice = self.is_slice::<T>(&span, data);
        if !data.is_null() {
            self.outputs.push(span);
        }
        Ok(Output { data, stride: span.stride, width, is_slice })
    }

    /// Whether a column is a slice; if not, it takes a room of every block.
    fn is_slice<T: Cell>(&mut self, span: &Span, data: *const T) -> bool {
        let is_slice = !data.is_null() && span.is_slice(align_of::<T>());
        if !is_slice {
            *T::count(&mut self.needed) += 1;
            self.are_slices = false;
        }
        is_slice
    }

    /// `Ok` if no output overlaps another column.
    fn check_overlap(&self) -> Result<()> {
        for (i, output) in self.outputs.iter().enumerate() {
            let mut others = self.inputs.iter().chain(&self.outputs[i + 1..]);
            if let Some(other) = others.find(|other| output.may_overlap(other)) {
                let message = format!("{} overlaps {}", output.name, other.name);
                return Err(Failure::new(airlight_status::Overlap, message));
            }
        }
        Ok(())
    }

    /// Takes so many values of each ray the whole way. Slices go to `call` as they are, all at once; otherwise it has blocks,
    /// of which every column is a slice or has a room.
    pub(crate) fn travel(
        &self,
        per_ray: usize,
        threads: Threads,
        call: impl Fn(&Block, &mut Rooms<'_>, Threads) -> core::result::Result<Counts, Error> + Sync,
    ) -> Result<Counts> {
        self.check_overlap()?;
        if self.are_slices || self.rays == 0 {
            let whole = Block { rays: 0..self.rays, values: 0..per_ray };
            return Ok(call(&whole, &mut Scratch::new(self.needed).rooms(), threads)?);
        }
        // Of some rays all values, or of one ray some.
        let (rays, values) = ((BLOCK / per_ray).max(1), per_ray.min(BLOCK));
        let turns = per_ray.div_ceil(values);
        let blocks = self.rays.div_ceil(rays) * turns;
        let block = |i: usize| {
            let (ray, value) = (i / turns * rays, i % turns * values);
            Block { rays: ray..self.rays.min(ray + rays), values: value..per_ray.min(value + values) }
        };
        let part = |blocks: Range<usize>| {
            let mut scratch = Scratch::new(self.needed);
            blocks.map(block).try_fold(Counts::default(), |sum, block| {
                Ok::<_, Error>(sum + call(&block, &mut scratch.rooms(), Threads::Caller)?)
            })
        };
        let parts = match threads {
            _ if blocks == 1 => 1,
            Threads::Pool => blocks.min(PARTS * rayon::current_num_threads()),
            Threads::AtMost(threads) => blocks.min(threads.get()),
            _ => 1,
        };
        let counts = if parts == 1 {
            part(0..blocks)
        } else {
            let bound = |i: usize| (i as u128 * blocks as u128 / parts as u128) as usize;
            let parts = (0..parts).into_par_iter().map(|i| part(bound(i)..bound(i + 1)));
            parts.try_reduce(Counts::default, |a, b| Ok(a + b))
        };
        Ok(counts?)
    }
}

/// The memory of rooms.
struct Scratch {
    floats: Vec<f32>,
    indices: Vec<u32>,
}

impl Scratch {
    fn new(needed: Needed) -> Self {
        Self { floats: vec![0.0; needed.floats * BLOCK], indices: vec![0; needed.indices * BLOCK] }
    }

    fn rooms(&mut self) -> Rooms<'_> {
        Rooms { floats: self.floats.chunks_exact_mut(BLOCK), indices: self.indices.chunks_exact_mut(BLOCK) }
    }
}
