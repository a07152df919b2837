//! A contact sheet: pictures side by side, each under its name.

use airlight_tools::renderer::picture::{Picture, Size};
use font8x8::{BASIC_FONTS, UnicodeFonts};

/// Side of a letter in pixels.
const LETTER: usize = 8;
/// Height of the strip that a name stands in.
const STRIP: usize = LETTER + 4;

/// Lays out pictures of one size, row by row, as nearly as many rows as columns. Names are written in `ink`.
pub(super) fn lay_out(pictures: &[(String, Picture)], ink: f32) -> Picture {
    let columns = (pictures.len() as f64).sqrt().ceil() as usize;
    let cell = pictures.first().map_or(Size { width: 0, height: 0 }, |(_, picture)| picture.size);
    let rows = pictures.len().div_ceil(columns.max(1));
    let mut sheet = Picture::black(Size { width: columns * cell.width, height: rows * (cell.height + STRIP) });
    for (i, (name, picture)) in pictures.iter().enumerate() {
        let (left, top) = (i % columns * cell.width, i / columns * (cell.height + STRIP));
        write(&mut sheet, name, (left, top + (STRIP - LETTER) / 2), cell.width, ink);
        for (row, pixels) in picture.rgb.chunks(cell.width).enumerate() {
            let start = (top + STRIP + row) * sheet.size.width + left;
            sheet.rgb[start..start + cell.width].copy_from_slice(pixels);
        }
    }
    sheet
}

/// Writes as many letters as fit into `width`.
fn write(sheet: &mut Picture, name: &str, (left, top): (usize, usize), width: usize, ink: f32) {
    for (place, letter) in name.chars().take(width / LETTER).enumerate() {
        let glyph = BASIC_FONTS.get(letter).unwrap_or_default();
        for (y, x) in (0..LETTER * LETTER).map(|bit| (bit / LETTER, bit % LETTER)) {
            if glyph[y] >> x & 1 == 1 {
                sheet.rgb[(top + y) * sheet.size.width + left + place * LETTER + x] = [ink; 3];
            }
        }
    }
}
