//! A finished drawing: in a page, as an SVG file, as a PNG file.

use super::palette;
use anyhow::{Context, Result};
use epaint_default_fonts::UBUNTU_LIGHT;
use resvg::tiny_skia::{Color, Pixmap, Transform};
use resvg::usvg::{Options, Tree};
use std::sync::Arc;

/// Pixels of a PNG for one of the drawing.
const PNG_SCALE: f32 = 2.0;

/// An SVG drawing in the light colours.
#[derive(Clone, Debug)]
pub(super) struct Drawing {
    /// Of its files, without the ending.
    pub(super) name: String,
    /// What it is of, for those who do not see it.
    pub(super) title: String,
    pub(super) svg: String,
}

impl Drawing {
    /// By itself: with the style sheet that a page of several has once.
    pub(super) fn file(&self) -> String {
        let end = self.svg.find('>').map_or(0, |end| end + 1);
        let (head, rest) = self.svg.split_at(end);
        format!("{head}\n<style>{}</style>{rest}", palette::dark_style())
    }

    /// On white, with a font of its own: what the machine has installed does not matter.
    pub(super) fn png(&self) -> Result<Vec<u8>> {
        let mut options = Options { font_family: "Ubuntu".to_owned(), ..Options::default() };
        let fonts = options.fontdb_mut();
        fonts.load_font_source(resvg::usvg::fontdb::Source::Binary(Arc::new(UBUNTU_LIGHT)));
        let family = fonts.faces().next().and_then(|face| face.families.first()).map(|(name, _)| name.clone());
        fonts.set_sans_serif_family(family.unwrap_or_default());
        let tree = Tree::from_str(&self.svg, &options).context("cannot read a drawing")?;
        let size = tree.size().to_int_size().scale_by(PNG_SCALE).context("a drawing has no size")?;
        let mut pixels = Pixmap::new(size.width(), size.height()).context("a drawing is too large")?;
        pixels.fill(Color::WHITE);
        resvg::render(&tree, Transform::from_scale(PNG_SCALE, PNG_SCALE), &mut pixels.as_mut());
        pixels.encode_png().context("cannot encode a drawing")
    }
}
