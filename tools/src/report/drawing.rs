//! A finished drawing: in a page, as an SVG file, as a PNG file.

use super::palette;
use anyhow::{Context, Result};
use epaint_default_fonts::UBUNTU_LIGHT;
use resvg::tiny_skia::{Color, Pixmap, Transform};
use resvg::usvg::{Options, Tree};
use std::fmt::Write;
use std::sync::Arc;

/// Pixels of a PNG for one of the drawing.
const PNG_SCALE: f32 = 2.0;

/// The drawing's units for one of a page: coordinates are whole numbers of them.
pub(super) const FINE: i32 = 4;

/// An SVG drawing in the light colours.
#[derive(Clone, Debug)]
pub(super) struct Drawing {
    /// Of its files, without the ending.
    pub(super) name: String,
    /// What it is of, for those who do not see it.
    pub(super) title: String,
    /// Width and height, in units.
    pub(super) size: (i32, i32),
    /// The elements.
    pub(super) content: String,
}

impl Drawing {
    /// Drawings of one width, below each other.
    pub(super) fn stacked(name: &str, title: &str, parts: &[Self]) -> Self {
        let (mut size, mut content) = ((0, 0), String::new());
        for part in parts {
            let _ = writeln!(content, "<g transform=\"translate(0, {})\">{}</g>", size.1, part.content);
            size = (part.size.0, size.1 + part.size.1);
        }
        Self { name: name.to_owned(), title: title.to_owned(), size, content }
    }

    /// In a page, which has the style sheet.
    pub(super) fn svg(&self) -> String {
        self.with("")
    }

    /// By itself: on ground of its own, with the style sheet.
    pub(super) fn file(&self) -> String {
        let ground = format!("<rect width=\"100%\" height=\"100%\" fill=\"{}\"/>", palette::GROUND.hex());
        self.with(&format!("<style>{}</style>\n{ground}\n", palette::dark_style()))
    }

    fn with(&self, before: &str) -> String {
        let Self { title, size: (width, height), content, .. } = self;
        format!(
            "<svg width=\"{}\" height=\"{}\" role=\"img\" aria-label=\"{title}\" viewBox=\"0 0 {width} {height}\" \
             xmlns=\"http://www.w3.org/2000/svg\">\n{before}{content}</svg>\n",
            width / FINE,
            height / FINE
        )
    }

    /// On white, with a font of its own: what the machine has installed does not matter.
    pub(super) fn png(&self) -> Result<Vec<u8>> {
        let mut options = Options { font_family: "Ubuntu".to_owned(), ..Options::default() };
        let fonts = options.fontdb_mut();
        fonts.load_font_source(resvg::usvg::fontdb::Source::Binary(Arc::new(UBUNTU_LIGHT)));
        let family = fonts.faces().next().and_then(|face| face.families.first()).map(|(name, _)| name.clone());
        fonts.set_sans_serif_family(family.unwrap_or_default());
        let tree = Tree::from_str(&self.svg(), &options).context("cannot read a drawing")?;
        let size = tree.size().to_int_size().scale_by(PNG_SCALE).context("a drawing has no size")?;
        let mut pixels = Pixmap::new(size.width(), size.height()).context("a drawing is too large")?;
        pixels.fill(Color::WHITE);
        resvg::render(&tree, Transform::from_scale(PNG_SCALE, PNG_SCALE), &mut pixels.as_mut());
        pixels.encode_png().context("cannot encode a drawing")
    }
}
