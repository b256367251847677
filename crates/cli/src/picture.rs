//! Bird's-eye views as PNG files.

use crate::error::CliError;
use boresight_image::{BirdsEyeView, NO_RADAR};
use std::path::Path;

/// Power below the strongest that is still told from black, dB.
const RANGE_DB: f32 = 60.0;
/// Colours of what no radar sees and of true targets.
const UNSEEN: [u8; 3] = [58, 62, 68];
const TRUTH: [u8; 3] = [80, 230, 255];

/// A view, forward up and left to the left, a pixel a cell; cells that hold one of `truth` (places
/// in the car's frame, m) are marked.
pub fn png(path: &Path, view: &BirdsEyeView, truth: &[[f64; 2]]) -> Result<Vec<u8>, CliError> {
    let (height, width) = view.power.dim();
    let strongest = view.power.iter().copied().fold(0.0_f32, f32::max);
    let mut pixels = Vec::with_capacity(3 * width * height);
    for x in (0..height).rev() {
        for y in (0..width).rev() {
            let below_db = 10.0 * (view.power[[x, y]] / strongest).log10();
            let level = f64::from((1.0 + below_db / RANGE_DB).clamp(0.0, 1.0));
            pixels.extend(match view.radar[[x, y]] {
                NO_RADAR => UNSEEN,
                _ if strongest <= 0.0 => colorous::INFERNO.eval_continuous(0.0).as_array(),
                _ => colorous::INFERNO.eval_continuous(level).as_array(),
            });
        }
    }
    for [x, y] in truth {
        let place = |at: f64, axis: boresight_image::Axis| {
            let index = ((at - axis.first()) / axis.step()).round();
            (index >= 0.0 && index < axis.len() as f64).then_some(index as usize)
        };
        if let Some((x, y)) = place(*x, view.grid.x_m).zip(place(*y, view.grid.y_m)) {
            let pixel = 3 * ((height - 1 - x) * width + (width - 1 - y));
            pixels[pixel..pixel + 3].copy_from_slice(&TRUTH);
        }
    }
    encode(width, height, &pixels).map_err(|error| CliError::File {
        action: "write",
        path: path.into(),
        error: error.into(),
    })
}

fn encode(width: usize, height: usize, pixels: &[u8]) -> Result<Vec<u8>, png::EncodingError> {
    let mut file = vec![];
    let mut encoder = png::Encoder::new(&mut file, width as u32, height as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_compression(png::Compression::High);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(pixels)?;
    writer.finish()?;
    Ok(file)
}
