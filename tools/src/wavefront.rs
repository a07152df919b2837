//! A wavefront: one ray, emitter point and variate per pixel, as a renderer hands it over in an .npz file.

use crate::npy;
use airlight::{Emitter, Emitters, Ray, Rays};
use airlight_tools::families::{NO_CONE, emitter};
use anyhow::{Context, Result, bail, ensure};
use glam::Vec3;
use std::io::{Cursor, Read};
use std::path::Path;
use zip::result::ZipError;
use zip::{SUPPORTED_COMPRESSION_METHODS, ZipArchive};

/// The wavefront that is built in, described in `data/README.md`.
const CORNELL: &[u8] = include_bytes!("../data/cornell.npz");

/// The columns of a wavefront, all of the same length, which is not 0.
#[derive(Debug)]
pub(crate) struct Wavefront {
    /// What it is called in reports.
    pub(crate) name: String,
    origin: [Vec<f32>; 3],
    direction: [Vec<f32>; 3],
    t_min: Vec<f32>,
    t_max: Vec<f32>,
    position: [Vec<f32>; 3],
    /// Normals, and axes of spots.
    normal: [Vec<f32>; 3],
    /// `cos_outer` and `cos_inner`, if there are spots.
    cones: Option<[Vec<f32>; 2]>,
    /// The variates of the first repetition.
    pub(crate) u: Vec<f32>,
    /// Which columns were converted from which dtype, if any.
    conversions: Option<String>,
}

impl Wavefront {
    /// Reads the wavefront at `path`.
    pub(crate) fn read(path: &Path) -> Result<Self> {
        let name = path.display().to_string();
        let file = std::fs::read(path).with_context(|| format!("cannot read {name}"))?;
        let wavefront = Self::decode(name.clone(), &file).context(name)?;
        if let Some(conversions) = &wavefront.conversions {
            eprintln!("{}: converted to float32: {conversions}", wavefront.name);
        }
        Ok(wavefront)
    }

    /// The Cornell box in fog.
    pub(crate) fn cornell() -> Result<Self> {
        let name = "cornell".to_owned();
        Self::decode(name.clone(), CORNELL).context(name)
    }

    /// The wavefront that is held in `file`.
    pub(crate) fn decode(name: String, file: &[u8]) -> Result<Self> {
        let mut archive = Archive::open(file)?;
        let wavefront = Self {
            name,
            origin: archive.columns(["ox", "oy", "oz"])?,
            direction: archive.columns(["dx", "dy", "dz"])?,
            t_min: archive.column("t_min")?,
            t_max: archive.column("t_max")?,
            position: archive.columns(["ex", "ey", "ez"])?,
            normal: archive.columns(["nx", "ny", "nz"])?,
            cones: archive.cones()?,
            u: archive.column("u")?,
            conversions: archive.conversions(),
        };
        ensure!(wavefront.len() > 0, "the wavefront is empty: its columns have no values");
        Ok(wavefront)
    }

    /// The number of its rays.
    pub(crate) fn len(&self) -> usize {
        self.u.len()
    }

    /// The first `count` rays.
    pub(crate) fn rays(&self, count: usize) -> Rays<'_> {
        Rays::new(first(&self.origin, count), first(&self.direction, count), &self.t_min[..count], &self.t_max[..count])
    }

    /// The emitters of the first `count` rays.
    pub(crate) fn emitters(&self, count: usize) -> Emitters<'_> {
        let (position, normal) = (first(&self.position, count), first(&self.normal, count));
        match &self.cones {
            Some([outer, inner]) => Emitters::each_spot(position, normal, &outer[..count], &inner[..count]),
            None => Emitters::each(position, normal),
        }
    }

    /// Ray number `i` and its emitter.
    pub(crate) fn ray(&self, i: usize) -> Result<(Ray, Emitter)> {
        let ray = Ray::new(vector(&self.origin, i), vector(&self.direction, i), self.t_min[i], self.t_max[i])?;
        let cosines = self.cones.as_ref().map_or([NO_CONE; 2], |cones| cones.each_ref().map(|column| column[i]));
        Ok((ray, emitter(vector(&self.position, i), vector(&self.normal, i), cosines)?))
    }

    /// The variate of ray number `i` in the first repetition.
    pub(crate) fn variate(&self, i: usize) -> Result<f32> {
        let u = self.u[i];
        ensure!((0.0..=1.0).contains(&u), "u is {u}, expected 0 <= u <= 1");
        Ok(u)
    }
}

fn first(columns: &[Vec<f32>; 3], count: usize) -> [&[f32]; 3] {
    columns.each_ref().map(|column| &column[..count])
}

fn vector(columns: &[Vec<f32>; 3], i: usize) -> Vec3 {
    Vec3::from_array(columns.each_ref().map(|column| column[i]))
}

/// An .npz file, whose columns must be of one length.
struct Archive<'a> {
    zip: ZipArchive<Cursor<&'a [u8]>>,
    /// Names that are there more than once.
    repeated: Vec<&'a [u8]>,
    /// The first column and its length.
    reference: Option<(&'static str, usize)>,
    /// Dtypes other than that of a wavefront, and the columns that have them.
    converted: Vec<(String, Vec<&'static str>)>,
}

impl<'a> Archive<'a> {
    fn open(file: &'a [u8]) -> Result<Self> {
        let zip = ZipArchive::new(Cursor::new(file)).context("not a complete .npz file")?;
        let repeated = if zip.has_duplicate_names() { repeated(file, &zip) } else { Vec::new() };
        Ok(Self { zip, repeated, reference: None, converted: Vec::new() })
    }

    fn columns(&mut self, names: [&'static str; 3]) -> Result<[Vec<f32>; 3]> {
        let [x, y, z] = names;
        Ok([self.column(x)?, self.column(y)?, self.column(z)?])
    }

    /// The cosines of spots: both columns or none.
    fn cones(&mut self) -> Result<Option<[Vec<f32>; 2]>> {
        const NAMES: [&str; 2] = ["cos_outer", "cos_inner"];
        if NAMES.iter().all(|name| self.zip.index_for_name(&entry_name(name)).is_none()) {
            return Ok(None);
        }
        let [outer, inner] = NAMES;
        Ok(Some([self.column(outer)?, self.column(inner)?]))
    }

    fn column(&mut self, name: &'static str) -> Result<Vec<f32>> {
        let column = match self.file(name) {
            Ok(file) => npy::decode(&file),
            Err(error) => Err(error),
        };
        let npy::Column { values, converted_from } = column.with_context(|| format!("column '{name}'"))?;
        let (first, length) = *self.reference.get_or_insert((name, values.len()));
        if values.len() != length {
            bail!("column '{name}' has {} values, column '{first}' has {length}", values.len());
        }
        if let Some(dtype) = converted_from {
            match self.converted.iter_mut().find(|(known, _)| *known == dtype) {
                Some((_, names)) => names.push(name),
                None => self.converted.push((dtype, vec![name])),
            }
        }
        Ok(values)
    }

    /// Which columns were converted from what, if any.
    fn conversions(&self) -> Option<String> {
        let told = |(dtype, names): &(String, Vec<&str>)| format!("{} from {dtype}", names.join(", "));
        let told: Vec<String> = self.converted.iter().map(told).collect();
        (!told.is_empty()).then(|| told.join("; "))
    }

    fn file(&mut self, name: &str) -> Result<Vec<u8>> {
        let name = entry_name(name);
        ensure!(!self.repeated.contains(&name.as_bytes()), "is there more than once");
        let mut entry = match self.zip.by_name(&name) {
            Err(ZipError::FileNotFound) => bail!("is missing"),
            entry => entry?,
        };
        let compression = entry.compression();
        ensure!(
            SUPPORTED_COMPRESSION_METHODS.contains(&compression),
            "the compression {compression} is not supported, expected Stored or Deflated"
        );
        let mut file = Vec::new();
        entry.read_to_end(&mut file).context("the data are corrupt")?;
        Ok(file)
    }
}

/// What a column is called in an archive.
fn entry_name(column: &str) -> String {
    format!("{column}.npy")
}

/// The names that the directory of an archive has more than once.
fn repeated<'a>(file: &'a [u8], zip: &ZipArchive<Cursor<&'a [u8]>>) -> Vec<&'a [u8]> {
    const ENTRY: &[u8] = b"PK\x01\x02";
    /// Bytes of an entry before its name; the lengths of the name, an extra field and a comment are at 28.
    const NAME: usize = 46;
    let entry = |at: usize| {
        let entry = file.get(at..)?;
        let length = |at: usize| Some(usize::from(u16::from_le_bytes(entry.get(at..at + 2)?.try_into().ok()?)));
        let [name, extra, comment] = [length(28)?, length(30)?, length(32)?];
        let next = at + NAME + name + extra + comment;
        Some((entry.starts_with(ENTRY).then(|| entry.get(NAME..NAME + name))??, next))
    };
    let (mut once, mut repeated) = (Vec::new(), Vec::new());
    let mut at = usize::try_from(zip.central_directory_start()).unwrap_or(usize::MAX);
    while let Some((name, next)) = entry(at) {
        if once.contains(&name) {
            repeated.push(name);
        } else {
            once.push(name);
        }
        at = next;
    }
    repeated
}
