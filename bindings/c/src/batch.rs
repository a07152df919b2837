//! The rays of a call, with what lights them and what they are in.

use crate::abi::*;
use crate::arguments::read;
use crate::columns::{Block, Columns, Input, Rooms, check_channels};
use crate::span::Name;
use crate::status::{Failure, Result};
use airlight::{Emitter, Emitters, Media, Medium, Rays};
use core::array;

/// The columns of rays.
struct RayColumns {
    origin: [Input<f32>; 3],
    direction: [Input<f32>; 3],
    t_min: Input<f32>,
    t_max: Input<f32>,
}

/// Where the emitter or the medium of each ray comes from.
enum Source<T, E> {
    One(T),
    Table(Vec<T>, Input<u32>),
    Each(E),
}

/// The columns of emitters.
struct EmitterColumns {
    position: [Input<f32>; 3],
    direction: [Input<f32>; 3],
    /// `cos_outer` and `cos_inner`, where there are spots.
    cosines: Option<[Input<f32>; 2]>,
}

/// The columns of media; those of a channel each.
struct MediumColumns {
    mu_a: Vec<Input<f32>>,
    mu_s: Vec<Input<f32>>,
    g: Input<f32>,
}

/// Rays, and the media that they are in.
pub(crate) struct RaysInMedia {
    rays: RayColumns,
    media: Source<Medium, MediumColumns>,
    channels: usize,
}

/// The emitter of each ray.
pub(crate) struct Lights(Source<Emitter, EmitterColumns>);

impl RaysInMedia {
    /// Those of a batch.
    ///
    /// # Safety
    /// All pointers of the batch are NULL or what they are said to be.
    pub(crate) unsafe fn new(batch: &airlight_batch, columns: &mut Columns) -> Result<Self> {
        let rays = RayColumns {
            origin: each("batch.origin", batch.origin, columns)?,
            direction: each("batch.direction", batch.direction, columns)?,
            t_min: columns.floats_or_zeros("batch.t_min".into(), batch.t_min)?,
            t_max: columns.floats("batch.t_max".into(), batch.t_max, 1)?,
        };
        // SAFETY: as promised.
        let (media, channels) = unsafe { media(&read("batch.media", batch.media)?, columns)? };
        Ok(Self { rays, media, channels })
    }

    /// How many channels the media have.
    pub(crate) fn channels(&self) -> usize {
        self.channels
    }

    /// Those of a block.
    pub(crate) fn read<'a, 's: 'a>(&'a self, block: &Block, rooms: &mut Rooms<'s>) -> (Rays<'a>, Media<'a>) {
        let mut read = |column: &Input<f32>| column.read(block, rooms);
        let RayColumns { origin, direction, t_min, t_max } = &self.rays;
        let origin = origin.each_ref().map(&mut read);
        let rays = Rays::new(origin, direction.each_ref().map(&mut read), read(t_min), read(t_max));
        let media = match &self.media {
            Source::One(medium) => Media::one(*medium),
            Source::Table(table, index) => Media::table(table, index.read(block, rooms)),
            Source::Each(columns) => match self.channels {
                3 => columns.read::<3>(block, rooms),
                4 => columns.read::<4>(block, rooms),
                _ => columns.read::<1>(block, rooms),
            },
        };
        (rays, media)
    }
}

impl MediumColumns {
    /// Those of a block, which have `C` channels.
    fn read<'a, 's: 'a, const C: usize>(&'a self, block: &Block, rooms: &mut Rooms<'s>) -> Media<'a> {
        let mut read = |column: &Input<f32>| column.read(block, rooms);
        let mu_a = array::from_fn(|c| read(&self.mu_a[c]));
        Media::each_coloured::<C>(mu_a, array::from_fn(|c| read(&self.mu_s[c])), read(&self.g))
    }
}

impl Lights {
    /// Those of a batch.
    ///
    /// # Safety
    /// As [`RaysInMedia::new`].
    pub(crate) unsafe fn new(batch: &airlight_batch, columns: &mut Columns) -> Result<Self> {
        // SAFETY: as promised.
        let emitters = unsafe { read("batch.emitters", batch.emitters)? };
        if !emitters.table.is_null() {
            // SAFETY: as promised.
            let table = unsafe { emitter_table(&emitters)? };
            return Ok(Self(of_table(table, "emitters", emitters.index, columns)?));
        }
        check_no_index("emitters", emitters.index)?;
        let position = each("emitters.position", emitters.position, columns)?;
        let direction = if emitters.direction.iter().all(|column| column.data.is_null()) {
            let zeros = |column| columns.floats_or_zeros("emitters.direction".into(), column);
            let [x, y, z] = emitters.direction.map(zeros);
            [x?, y?, z?]
        } else {
            each("emitters.direction", emitters.direction, columns)?
        };
        let (cos_outer, cos_inner) = (emitters.cos_outer, emitters.cos_inner);
        let cosines = if cos_outer.data.is_null() && cos_inner.data.is_null() {
            None
        } else {
            let cos_outer = columns.floats("emitters.cos_outer".into(), cos_outer, 1)?;
            Some([cos_outer, columns.floats("emitters.cos_inner".into(), cos_inner, 1)?])
        };
        Ok(Self(Source::Each(EmitterColumns { position, direction, cosines })))
    }

    /// Those of a block.
    pub(crate) fn read<'a, 's: 'a>(&'a self, block: &Block, rooms: &mut Rooms<'s>) -> Emitters<'a> {
        match &self.0 {
            Source::One(emitter) => Emitters::one(*emitter),
            Source::Table(table, index) => Emitters::table(table, index.read(block, rooms)),
            Source::Each(EmitterColumns { position, direction, cosines }) => {
                let mut read = |column: &Input<f32>| column.read(block, rooms);
                let (position, direction) = (position.each_ref().map(&mut read), direction.each_ref().map(&mut read));
                match cosines {
                    None => Emitters::each(position, direction),
                    Some([outer, inner]) => Emitters::each_spot(position, direction, read(outer), read(inner)),
                }
            }
        }
    }
}

/// The table of emitters of a batch, of which each may light every ray.
///
/// # Safety
/// As [`RaysInMedia::new`].
pub(crate) unsafe fn table_of_lights(batch: &airlight_batch, _: &mut Columns) -> Result<Vec<Emitter>> {
    // SAFETY: as promised.
    let emitters = unsafe { read("batch.emitters", batch.emitters)? };
    if emitters.table.is_null() {
        return Err(Failure::null("emitters.table"));
    }
    if !emitters.index.data.is_null() {
        return Err(Failure::value("emitters.index", "given", "NULL: it is what is chosen"));
    }
    // SAFETY: as promised.
    unsafe { emitter_table(&emitters) }
}

/// The emitters of a table.
///
/// # Safety
/// It is one.
unsafe fn emitter_table(emitters: &airlight_emitters) -> Result<Vec<Emitter>> {
    // SAFETY: as promised.
    unsafe { table("emitters.table", emitters.table, emitters.table_count, emitter) }
}

/// The media, and how many channels they have.
///
/// # Safety
/// As [`RaysInMedia::new`].
unsafe fn media(media: &airlight_media, columns: &mut Columns) -> Result<(Source<Medium, MediumColumns>, usize)> {
    if !media.table.is_null() {
        // SAFETY: as promised.
        let table = unsafe { table("media.table", media.table, media.table_count, medium)? };
        // Where they differ, the call says so.
        let channels = table.iter().map(Medium::channels).max().unwrap_or(1);
        return Ok((of_table(table, "media", media.index, columns)?, channels));
    }
    check_no_index("media", media.index)?;
    let channels = channels("media.channels", media.channels)?;
    let mu_a = each_channel("media.mu_a", media.mu_a, channels, columns)?;
    let mu_s = each_channel("media.mu_s", media.mu_s, channels, columns)?;
    let g = columns.floats_or_zeros("media.g".into(), media.g)?;
    Ok((Source::Each(MediumColumns { mu_a, mu_s, g }), channels))
}

/// `Ok` if no index is given, where there is no table.
fn check_no_index(owner: &str, index: airlight_index_column) -> Result<()> {
    if index.data.is_null() { Ok(()) } else { Err(Failure::null(format_args!("{owner}.table of {owner}.index"))) }
}

/// Columns of three coordinates.
fn each(name: &'static str, given: [airlight_column; 3], columns: &mut Columns) -> Result<[Input<f32>; 3]> {
    let mut k = 0..;
    let [x, y, z] = given.map(|column| columns.floats(Name(name, k.next()), column, 1));
    Ok([x?, y?, z?])
}

/// Columns of so many channels.
fn each_channel(
    name: &'static str,
    given: [airlight_column; 4],
    channels: usize,
    columns: &mut Columns,
) -> Result<Vec<Input<f32>>> {
    check_channels(name, given.map(|column| !column.data.is_null()), channels)?;
    (0..channels).map(|c| columns.floats(Name(name, Some(c)), given[c], 1)).collect()
}

/// What a table has for each ray.
fn of_table<T: Copy, E>(
    table: Vec<T>,
    owner: &'static str,
    index: airlight_index_column,
    columns: &mut Columns,
) -> Result<Source<T, E>> {
    match (&*table, index.data.is_null()) {
        (&[one], true) => Ok(Source::One(one)),
        (_, true) => Err(Failure::null(format_args!("{owner}.index.data"))),
        (_, false) => {
            let name = if owner == "emitters" { "emitters.index" } else { "media.index" };
            let index = columns.indices(name.into(), index)?;
            Ok(Source::Table(table, index))
        }
    }
}

/// The entries of a table, which has some.
///
/// # Safety
/// `entries` are so many.
unsafe fn table<A: Copy, T>(
    field: &str,
    entries: *const A,
    count: usize,
    convert: impl Fn(&A) -> Result<T>,
) -> Result<Vec<T>> {
    if count == 0 {
        return Err(Failure::new(airlight_status::Empty, format!("{field} is empty")));
    }
    if count.checked_mul(size_of::<A>()).is_none_or(|bytes| bytes > isize::MAX as usize) {
        let message = format!("{field} has too many entries for memory: {count}");
        return Err(Failure::new(airlight_status::Length, message));
    }
    let entry = |i: usize| {
        // SAFETY: entry `i` of the table.
        let entry = unsafe { entries.wrapping_add(i).read_unaligned() };
        convert(&entry).map_err(|failure| failure.of(format_args!("{field}[{i}]")))
    };
    (0..count).map(entry).collect()
}

/// An emitter.
pub(crate) fn emitter(emitter: &airlight_emitter) -> Result<Emitter> {
    let airlight_emitter { kind, position, direction, cos_outer, cos_inner } = *emitter;
    match kind {
        0 => Ok(Emitter::point(position)?),
        1 => Ok(Emitter::point_normal(position, direction)?),
        2 => Ok(Emitter::spot(position, direction, cos_outer, cos_inner)?),
        other => Err(Failure::value("kind", other, "an airlight_emitter_kind")),
    }
}

/// A medium.
pub(crate) fn medium(medium: &airlight_medium) -> Result<Medium> {
    let airlight_medium { channels: count, mu_a, mu_s, g } = *medium;
    let ([a0, a1, a2, a3], [s0, s1, s2, s3]) = (mu_a, mu_s);
    Ok(match channels("channels", count)? {
        1 => Medium::new(a0, s0, g)?,
        3 => Medium::coloured([a0, a1, a2], [s0, s1, s2], g)?,
        _ => Medium::coloured([a0, a1, a2, a3], [s0, s1, s2, s3], g)?,
    })
}

/// How many channels a number of them stands for.
fn channels(field: &str, count: u32) -> Result<usize> {
    match count {
        0 | 1 => Ok(1),
        3 | 4 => Ok(count as usize),
        other => Err(Failure::value(field, other, "1, 3 or 4")),
    }
}
