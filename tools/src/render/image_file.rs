//! Pictures as files: linear EXR, or PNG through the tone curve.

use crate::output::Target;
use airlight_tools::renderer::picture::Picture;
use airlight_tools::renderer::tone;
use airlight_tools::variates;
use anyhow::{Context, Result, bail};
use exr::prelude::{Image, SpecificChannels, Vec2, WritableImage};
use std::io::Cursor;
use std::path::Path;

/// An image file to be written.
#[derive(Debug)]
pub(super) struct ImageFile {
    format: Format,
    target: Target,
}

#[derive(Clone, Copy, Debug)]
enum Format {
    Exr,
    Png,
}

impl ImageFile {
    /// The file at `path`, refused at once if it cannot be written or its name does not tell what it is.
    pub(super) fn new(path: &Path) -> Result<Self> {
        let extension = path.extension().and_then(|extension| extension.to_str()).map(str::to_ascii_lowercase);
        let format = match extension.as_deref() {
            Some("exr") => Format::Exr,
            Some("png") => Format::Png,
            _ => bail!("cannot write {}: expected a name that ends in .png or .exr", path.display()),
        };
        Ok(Self { format, target: Target::file(path)? })
    }

    /// Writes the picture.
    pub(super) fn write(&self, picture: &Picture, exposure: f32) -> Result<()> {
        self.target.write(&match self.format {
            Format::Exr => exr(picture).context("cannot encode the picture")?,
            Format::Png => png(picture, exposure).context("cannot encode the picture")?,
        })
    }
}

fn exr(picture: &Picture) -> Result<Vec<u8>> {
    let width = picture.size.width;
    let pixel = |Vec2(x, y): Vec2<usize>| {
        let [red, green, blue] = picture.rgb[y * width + x];
        (red, green, blue)
    };
    let image = Image::from_channels((width, picture.size.height), SpecificChannels::rgb(pixel));
    let mut bytes = Cursor::new(Vec::new());
    // In parallel the blocks would come in any order.
    image.write().non_parallel().to_buffered(&mut bytes)?;
    Ok(bytes.into_inner())
}

fn png(picture: &Picture, exposure: f32) -> Result<Vec<u8>> {
    let linear = picture.rgb.as_flattened();
    // Random rounding: in the dark, steps of 8 bits would show as bands.
    let mut u = vec![0.0; linear.len()];
    variates::fill(0, 0, &mut u);
    let shown = |(linear, u): (&f32, &f32)| (255.0 * tone::display(*linear, exposure) + u) as u8;
    let levels: Vec<u8> = linear.iter().zip(&u).map(shown).collect();

    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, picture.size.width as u32, picture.size.height as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    encoder.set_compression(png::Compression::High);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&levels)?;
    writer.finish()?;
    Ok(bytes)
}
