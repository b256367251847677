//! Bird's-eye views as PNG files.

use crate::error::CliError;
use boresight_image::{BirdsEyeView, NO_RADAR};
use boresight_simulate::Street;
use boresight_simulate::street::{StreetKind, StreetOutline};
use std::path::Path;

/// Most places marked along a wall.
const MOST_MARKS: f64 = 16_384.0;
/// Power below the strongest that is still told from black, dB.
const RANGE_DB: f32 = 60.0;
/// Colours of what no radar sees, of true targets and of walls.
const UNSEEN: [u8; 3] = [58, 62, 68];
const TARGET: [u8; 3] = [80, 230, 255];
const WALL: [u8; 3] = [120, 200, 80];

/// What is marked in a picture, in the car's frame, m.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Truth {
    /// Places of targets.
    pub targets: Vec<[f64; 2]>,
    /// Both ends of each wall.
    pub walls: Vec<[[f64; 2]; 2]>,
}

impl Truth {
    /// Some targets of a street, and its walls.
    pub fn of(street: &Street, targets: &[[f64; 2]]) -> Self {
        let walls = street.outlines.iter().filter(|outline| outline.kind == StreetKind::Wall);
        let ends = |outline: &StreetOutline| match outline.corners_m[..] {
            [a, b] => Some([a, b]),
            _ => None,
        };
        Self { targets: targets.to_vec(), walls: walls.filter_map(ends).collect() }
    }

    /// Places to mark, half a cell apart along walls, each with its colour.
    fn marks(&self, cell_m: f64) -> impl Iterator<Item = ([f64; 2], [u8; 3])> {
        let along = move |&[a, b]: &[[f64; 2]; 2]| {
            let [dx, dy] = [b[0] - a[0], b[1] - a[1]];
            let steps = (2.0 * (dx * dx + dy * dy).sqrt() / cell_m).ceil().clamp(1.0, MOST_MARKS);
            let at = move |step| [a[0] + dx * step / steps, a[1] + dy * step / steps];
            (0..=steps as u32).map(move |step| (at(f64::from(step)), WALL))
        };
        let walls = self.walls.iter().flat_map(along);
        walls.chain(self.targets.iter().map(|&target| (target, TARGET)))
    }
}

/// A view, forward up and left to the left, a pixel a cell; cells that hold something of the truth
/// are marked.
pub fn png(path: &Path, view: &BirdsEyeView, truth: &Truth) -> Result<Vec<u8>, CliError> {
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
    for ([x, y], colour) in truth.marks(view.grid.cell_m) {
        let place = |at: f64, axis: boresight_image::Axis| {
            let index = ((at - axis.first()) / axis.step()).round();
            (index >= 0.0 && index < axis.len() as f64).then_some(index as usize)
        };
        if let Some((x, y)) = place(x, view.grid.x_m).zip(place(y, view.grid.y_m)) {
            let pixel = 3 * ((height - 1 - x) * width + (width - 1 - y));
            pixels[pixel..pixel + 3].copy_from_slice(&colour);
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
