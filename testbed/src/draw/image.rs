//! Pictures in memory and in PNG files.

use std::fs::File;
use std::io::{self, BufWriter};
use std::path::Path;

/// An opaque picture, three bytes a pixel, rows from the top.
#[derive(Clone, Debug)]
pub struct Image {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Red, green and blue of each pixel, sRGB.
    pub pixels: Vec<[u8; 3]>,
}

impl Image {
    /// A picture of one colour.
    pub fn filled(width: usize, height: usize, color: [u8; 3]) -> Self {
        Self { width, height, pixels: vec![color; width * height] }
    }

    /// The picture with each block of `factor` × `factor` pixels averaged to one.
    pub fn reduced(&self, factor: usize) -> Self {
        let (width, height) = (self.width / factor, self.height / factor);
        let mut pixels = Vec::with_capacity(width * height);
        let count = (factor * factor) as u32;
        for y in 0..height {
            for x in 0..width {
                let mut sum = [count / 2; 3];
                for row in 0..factor {
                    let start = (y * factor + row) * self.width + x * factor;
                    for pixel in &self.pixels[start..start + factor] {
                        for (sum, &channel) in sum.iter_mut().zip(pixel) {
                            *sum += u32::from(channel);
                        }
                    }
                }
                pixels.push(sum.map(|channel| (channel / count) as u8));
            }
        }
        Self { width, height, pixels }
    }

    /// Writes the picture as a PNG file.
    pub fn save(&self, path: &Path) -> io::Result<()> {
        let size = |n: usize| u32::try_from(n).map_err(io::Error::other);
        let mut encoder =
            png::Encoder::new(BufWriter::new(File::create(path)?), size(self.width)?, size(self.height)?);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
        let mut writer = encoder.write_header()?;
        writer.write_image_data(self.pixels.as_flattened())?;
        Ok(writer.finish()?)
    }
}
