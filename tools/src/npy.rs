//! NumPy's .npy format, as far as a column needs it: one dimension of floating-point numbers, read and written as
//! float32.

use anyhow::{Context, Result, bail, ensure};
use half::f16;

const MAGIC: &[u8] = b"\x93NUMPY";
const FLOAT32: &str = "<f4";

/// What a file holds.
#[derive(Debug, PartialEq)]
pub(crate) struct Column {
    pub(crate) values: Vec<f32>,
    /// The dtype that the values were converted from, in words; none for little-endian float32.
    pub(crate) converted_from: Option<String>,
}

/// The column that is held in `file`.
pub(crate) fn decode(file: &[u8]) -> Result<Column> {
    let (header, data) = split(file)?;
    let header = std::str::from_utf8(header).context("the .npy header is not text")?;

    let dtype = entry(header, "descr").context("the .npy header has no 'descr'")?;
    let float = Float::named(dtype)
        .with_context(|| format!("dtype is {}, expected float16, float32 or float64", spoken(dtype)))?;

    let shape = entry(header, "shape").context("the .npy header has no 'shape'")?;
    let lengths: Vec<&str> = shape.split(',').map(str::trim).filter(|length| !length.is_empty()).collect();
    let [length] = lengths[..] else { bail!("has shape ({shape}), expected one dimension: ravel it") };
    // Python 2 wrote its long integers with an L.
    let length: usize = length
        .strip_suffix('L')
        .unwrap_or(length)
        .parse()
        .with_context(|| format!("the .npy header has the shape ({shape})"))?;

    let values = float
        .values(data)
        .filter(|values| values.len() == length)
        .with_context(|| format!("holds {} bytes of data, expected {length} values of {}", data.len(), float.bytes))?;
    let converted_from = (float != Float { bytes: 4, big_endian: false }).then(|| spoken(dtype));
    Ok(Column { values, converted_from })
}

/// The .npy file of a column.
pub(crate) fn encode(column: &[f32]) -> Vec<u8> {
    const ALIGNMENT: usize = 64;
    let mut header = format!("{{'descr': '{FLOAT32}', 'fortran_order': False, 'shape': ({},), }}", column.len());
    let start = MAGIC.len() + 4;
    // Spaces and a line feed, so that the data are aligned.
    let padded = (start + header.len() + 1).next_multiple_of(ALIGNMENT) - start;
    header.push_str(&" ".repeat(padded - 1 - header.len()));
    header.push('\n');
    let length = u16::try_from(header.len()).expect("a short header");

    let mut file = [MAGIC, &[1, 0], &length.to_le_bytes(), header.as_bytes()].concat();
    file.extend(column.iter().flat_map(|value| value.to_le_bytes()));
    file
}

/// Header and data. Version 1 counts the header's bytes in 16 bits, later ones in 32.
fn split(file: &[u8]) -> Result<(&[u8], &[u8])> {
    const INCOMPLETE: &str = "not a complete .npy file";
    let (&[major, minor], rest) = file.strip_prefix(MAGIC).and_then(<[u8]>::split_first_chunk).context(INCOMPLETE)?;
    ensure!(
        matches!((major, minor), (1..=3, 0)),
        "the .npy format version is {major}.{minor}, expected 1.0, 2.0 or 3.0"
    );
    let sized = if major == 1 {
        rest.split_first_chunk().map(|(length, rest)| (usize::from(u16::from_le_bytes(*length)), rest))
    } else {
        rest.split_first_chunk().map(|(length, rest)| (u32::from_le_bytes(*length) as usize, rest))
    };
    sized.and_then(|(length, rest)| rest.split_at_checked(length)).context(INCOMPLETE)
}

/// What the header, a Python dictionary, holds under `key`: a string or a tuple without its delimiters, or the text of
/// anything else.
fn entry<'a>(header: &'a str, key: &str) -> Option<&'a str> {
    let at = ['\'', '"'].iter().find_map(|quote| {
        let quoted = format!("{quote}{key}{quote}");
        header.find(&quoted).map(|at| at + quoted.len())
    })?;
    let value = header[at..].trim_start().strip_prefix(':')?.trim_start();
    let (end, inner) = match value.chars().next()? {
        quote @ ('\'' | '"') => (quote, &value[1..]),
        '(' => (')', &value[1..]),
        '[' => return Some(value.split_inclusive(']').next().unwrap_or(value)),
        _ => (',', value),
    };
    inner.split(end).next()
}

/// A floating-point number of a file.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Float {
    bytes: usize,
    big_endian: bool,
}

impl Float {
    /// The one that a dtype names.
    fn named(dtype: &str) -> Option<Self> {
        let (big_endian, kind) = ordered(dtype);
        let bytes = match kind {
            "f2" => 2,
            "f4" => 4,
            "f8" => 8,
            _ => return None,
        };
        Some(Self { bytes, big_endian })
    }

    /// All values of `data`, rounded to the nearest f32; none unless they fill it.
    fn values(self, data: &[u8]) -> Option<Vec<f32>> {
        match self.bytes {
            2 => self.read(data, |value| f16::from_le_bytes(value).to_f32()),
            4 => self.read(data, f32::from_le_bytes),
            _ => self.read(data, |value| f64::from_le_bytes(value) as f32),
        }
    }

    fn read<const BYTES: usize>(self, data: &[u8], little_endian: impl Fn([u8; BYTES]) -> f32) -> Option<Vec<f32>> {
        let (values, rest) = data.as_chunks();
        let read = |&(mut value): &[u8; BYTES]| {
            if self.big_endian {
                value.reverse();
            }
            little_endian(value)
        };
        rest.is_empty().then(|| values.iter().map(read).collect())
    }
}

/// Whether a dtype is big-endian, and the rest of its name; without a byte order it is the machine's.
fn ordered(dtype: &str) -> (bool, &str) {
    let native = cfg!(target_endian = "big");
    match dtype.split_at_checked(1) {
        Some((">", kind)) => (true, kind),
        Some(("<", kind)) => (false, kind),
        Some(("=" | "|", kind)) => (native, kind),
        _ => (native, dtype),
    }
}

/// A dtype by its name and as it stands in the file: `>f4` is "big-endian float32 ('>f4')".
fn spoken(dtype: &str) -> String {
    if dtype.starts_with('[') {
        return format!("structured ({dtype})");
    }
    let order = if dtype.starts_with('>') { "big-endian " } else { "" };
    let mut letters = ordered(dtype).1.chars();
    let kind = match letters.next() {
        Some('f') => "float",
        Some('i') => "int",
        Some('u') => "uint",
        Some('c') => "complex",
        Some('b') => "bool",
        _ => return format!("'{dtype}'"),
    };
    match letters.as_str().parse::<u8>() {
        Ok(_) if kind == "bool" => format!("bool ('{dtype}')"),
        Ok(bytes) => format!("{order}{kind}{} ('{dtype}')", 8 * u32::from(bytes)),
        Err(_) => format!("'{dtype}'"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A file of any version, dtype, shape and data.
    fn file(version: [u8; 2], dtype: &str, shape: &str, data: &[u8]) -> Vec<u8> {
        let header = format!("{{\"shape\":{shape},\"fortran_order\":False,\"descr\":\"{dtype}\"}}\n");
        let length = u32::try_from(header.len()).unwrap().to_le_bytes();
        let length = if version[0] == 1 { &length[..2] } else { &length };
        [MAGIC, &version, length, header.as_bytes(), data].concat()
    }

    fn values(file: &[u8]) -> Vec<f32> {
        decode(file).unwrap().values
    }

    fn refusal(file: &[u8]) -> String {
        format!("{:#}", decode(file).unwrap_err())
    }

    #[test]
    fn a_column_survives_the_round_trip_and_is_aligned() {
        for length in [0, 1, 9, 10, 99_999, 100_000] {
            let values: Vec<f32> = (0..length).map(|i| i as f32 * 0.1).collect();
            let file = encode(&values);
            assert_eq!((file.len() - 4 * values.len()) % 64, 0);
            assert_eq!(decode(&file).unwrap(), Column { values, converted_from: None });
        }
    }

    #[test]
    fn headers_of_other_writers_are_read() {
        let data: Vec<u8> = [1f32, 2.0].iter().flat_map(|value| value.to_le_bytes()).collect();
        for version in [[1, 0], [2, 0], [3, 0]] {
            assert_eq!(values(&file(version, "<f4", "(2,)", &data)), [1.0, 2.0]);
        }
        assert_eq!(values(&file([1, 0], "<f4", "(2L,)", &data)), [1.0, 2.0]);
    }

    #[test]
    fn a_version_that_does_not_exist_is_refused() {
        for version in [[0, 1], [1, 1], [4, 0], [255, 255]] {
            let told = refusal(&file(version, "<f4", "(0,)", &[]));
            let [major, minor] = version;
            assert_eq!(told, format!("the .npy format version is {major}.{minor}, expected 1.0, 2.0 or 3.0"));
        }
    }

    #[test]
    fn floats_of_any_width_and_order_are_rounded_to_f32() {
        // A third and 2^128 - 2^103, which rounds to infinity, as NumPy writes them.
        let third = 1.0 / 3.0;
        let column = |dtype, data: &[u8]| {
            let Column { values, converted_from } = decode(&file([1, 0], dtype, "(2,)", data)).unwrap();
            let [a, b] = values[..] else { panic!("{values:?}") };
            (a, b, converted_from)
        };
        let large = 2f64.powi(128) - 2f64.powi(103);
        for (order, dtype, told) in [(false, "<f8", "float64 ('<f8')"), (true, ">f8", "big-endian float64 ('>f8')")] {
            let data = [third, large].map(|value: f64| if order { value.to_be_bytes() } else { value.to_le_bytes() });
            assert_eq!(column(dtype, data.as_flattened()), (third as f32, f32::INFINITY, Some(told.to_owned())));
        }
        let data = [1.5f32, -2.0].map(f32::to_be_bytes);
        let told = Some("big-endian float32 ('>f4')".to_owned());
        assert_eq!(column(">f4", data.as_flattened()), (1.5, -2.0, told));
        // Half precision: -2 and the smallest number above 0, 2^-24.
        let told = |text: &str| Some(text.to_owned());
        assert_eq!(column("<f2", &[0, 0xc0, 1, 0]), (-2.0, 2f32.powi(-24), told("float16 ('<f2')")));
        assert_eq!(column(">f2", &[0xc0, 0, 0, 1]), (-2.0, 2f32.powi(-24), told("big-endian float16 ('>f2')")));
    }

    #[test]
    fn without_a_byte_order_it_is_the_machines() {
        let data = [1.5f32, -2.0].map(f32::to_ne_bytes);
        for dtype in ["f4", "=f4", "|f4"] {
            assert_eq!(values(&file([1, 0], dtype, "(2,)", data.as_flattened())), [1.5, -2.0], "{dtype}");
        }
        let data = [1.5f64, -2.0].map(f64::to_ne_bytes);
        assert_eq!(values(&file([1, 0], "f8", "(2,)", data.as_flattened())), [1.5, -2.0]);
    }

    #[test]
    fn other_shapes_than_one_dimension_are_named() {
        for shape in ["(2, 1)", "(1, 2)", "(1, 2, 1)", "()"] {
            let told = refusal(&file([1, 0], "<f4", shape, &[0; 8]));
            assert_eq!(told, format!("has shape {shape}, expected one dimension: ravel it"));
        }
    }

    #[test]
    fn dtypes_are_spoken() {
        assert_eq!(spoken(">f4"), "big-endian float32 ('>f4')");
        assert_eq!(spoken("<i8"), "int64 ('<i8')");
        assert_eq!(spoken("i8"), "int64 ('i8')");
        assert_eq!(spoken("<f16"), "float128 ('<f16')");
        assert_eq!(spoken("|b1"), "bool ('|b1')");
        assert_eq!(spoken("|O"), "'|O'");
        assert_eq!(spoken("float"), "'float'");
        assert_eq!(spoken("[('x', '<f4')]"), "structured ([('x', '<f4')])");
    }

    #[test]
    fn no_prefix_of_a_file_is_a_column() {
        let file = encode(&[1.0, 2.0, 3.0]);
        for length in 0..file.len() {
            assert!(decode(&file[..length]).is_err(), "{length} of {} bytes", file.len());
        }
    }
}
