//! From records to tables.

use super::{ImageRecord, ImagesExperiment, ImagesRecord};
use boresight_image::PointMeasure;
use boresight_math::decibels::power_to_db;
use boresight_options::Named;
use boresight_pipeline::image::Content;
use boresight_validate::table::{Best, Cell, Table, Tables};
use serde::Serialize;

/// The experiment's result.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct ImagesReport {
    /// Streets.
    pub streets: u64,
    /// Seed of the first.
    pub seed: u64,
    /// Detected cells of all radars, by street.
    pub cells: Vec<usize>,
    /// Images of spectra.
    pub spectra: Vec<ImagesResult>,
    /// Images of targets.
    pub targets: Vec<ImagesResult>,
}

/// The images of one method.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct ImagesResult {
    /// What they were made by.
    pub name: String,
    /// Their records, by street.
    pub images: Vec<ImageRecord>,
}

impl ImagesReport {
    pub(super) fn new(
        options: &ImagesExperiment,
        records: impl Iterator<Item = ImagesRecord>,
    ) -> Self {
        let (mut spectra, mut targets, mut cells) = (vec![], vec![], vec![]);
        for record in records {
            cells.push(record.cells);
            for image in record.images {
                put(
                    match image.from {
                        Content::Spectra => &mut spectra,
                        Content::Targets => &mut targets,
                    },
                    image,
                );
            }
        }
        Self { streets: options.streets, seed: options.seed, cells, spectra, targets }
    }
}

/// A field of a table; nothing for what there is no number for.
fn field(number: f64) -> String {
    if number.is_nan() { String::new() } else { number.to_string() }
}

fn put(results: &mut Vec<ImagesResult>, image: ImageRecord) {
    match results.iter_mut().find(|result| result.name == image.name) {
        Some(result) => result.images.push(image),
        None => results.push(ImagesResult { name: image.name.clone(), images: vec![image] }),
    }
}

/// How numbers of streets are shown.
#[derive(Debug, Clone, Copy)]
enum Shown {
    Decibels,
    Percent,
    Number,
}

impl Shown {
    fn one(self, number: f64) -> String {
        match self {
            Self::Decibels if number <= 0.0 => "none".into(),
            Self::Decibels => format!("{:.1}", power_to_db(number)),
            Self::Percent => short(100.0 * number),
            Self::Number => short(number),
        }
    }

    /// The mean, and of several the least and the most.
    fn all(self, numbers: &[f64]) -> String {
        let mean = numbers.iter().sum::<f64>() / numbers.len().max(1) as f64;
        let least = numbers.iter().copied().fold(f64::INFINITY, f64::min);
        let most = numbers.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        if mean.is_finite() && least < most {
            return format!("{} ({} to {})", self.one(mean), self.one(least), self.one(most));
        }
        self.one(mean)
    }
}

/// To three digits or so; "none" for what there is no number for.
fn short(number: f64) -> String {
    let digits = match number.abs() {
        _ if number.is_nan() => return "none".into(),
        size if size >= 100.0 || size.fract() == 0.0 => 0,
        size if size >= 10.0 => 1,
        _ => 2,
    };
    format!("{number:.digits$}")
}

/// A column of a table: its head, how it is shown, and its number of a record.
type Column<Record> = (&'static str, Shown, fn(&Record) -> f64);

const OF_VIEWS: [Column<ImageRecord>; 6] = [
    ("outside, dB", Shown::Decibels, |image| image.outside_share),
    ("strongest outside, dB", Shown::Decibels, |image| image.peak_outside),
    ("lit outside, %", Shown::Percent, |image| image.lit_outside),
    ("targets lit, %", Shown::Percent, |image| image.lit_targets),
    ("behind walls, dB", Shown::Decibels, |image| image.behind_walls.share),
    ("lit behind walls, m^2", Shown::Number, |image| image.behind_walls.lit_m2),
];

const OF_POINTS: [Column<PointMeasure>; 8] = [
    ("points", Shown::Number, |points| points.points as f64),
    ("false", Shown::Number, |points| points.false_points as f64),
    ("false, dB", Shown::Decibels, |points| points.false_share),
    ("behind walls", Shown::Number, |points| points.hidden_points as f64),
    ("behind walls, dB", Shown::Decibels, |points| points.hidden_share),
    ("targets found, %", Shown::Percent, |points| points.found_targets),
    ("false at half", Shown::Number, |points| {
        points.at_half.map_or(f64::NAN, |half| half.false_points as f64)
    }),
    ("behind walls at half", Shown::Number, |points| {
        points.at_half.map_or(f64::NAN, |half| half.hidden_points as f64)
    }),
];

/// A table of some records of each result.
fn table_of<Record>(
    title: &str,
    columns: &[Column<Record>],
    results: &[ImagesResult],
    record: fn(&ImageRecord) -> Option<&Record>,
) -> Table {
    let row = |result: &ImagesResult| {
        let records: Vec<&Record> = result.images.iter().filter_map(record).collect();
        let cells = columns.iter().map(|(_, shown, number)| {
            let numbers: Vec<f64> = records.iter().map(|record| number(record)).collect();
            Cell::text(shown.all(&numbers))
        });
        (result.name.clone(), cells.collect())
    };
    let heads = columns.iter().map(|(head, ..)| head);
    Table::new(title, Best::None, "method", heads, results.iter().map(row))
}

/// What tables of images show of a record.
fn whole(image: &ImageRecord) -> Option<&ImageRecord> {
    Some(image)
}

impl boresight_validate::experiment::Report for ImagesReport {
    fn tables(&self) -> Tables {
        let last = self.seed.wrapping_add(self.streets - 1);
        let (least, most) = (self.cells.iter().min(), self.cells.iter().max());
        let cells = [least, most].map(|count| count.copied().unwrap_or_default());
        let remark = format!(
            "Streets of seeds {} to {last}, one frame of all radars each, {} to {} detected cells a frame: mean (least \
             to most).\n",
            self.seed, cells[0], cells[1],
        );
        let points = "Points of the images of targets, a frame; at half: of the strongest points that find half of the \
                      targets.";
        let tables = vec![
            table_of("Images of spectra.", &OF_VIEWS, &self.spectra, whole),
            table_of("Images of targets.", &OF_VIEWS, &self.targets, whole),
            table_of(points, &OF_POINTS, &self.targets, |image| image.points.as_ref()),
        ];
        Tables { remark, tables }
    }

    fn csv(&self) -> String {
        let mut text = "from,method,street,outside_share,peak_outside_share,lit_outside_share,lit_targets_share,\
                        behind_walls_share,behind_walls_lit_m2,behind_walls_m2,points,false_points,\
                        false_points_power_share,behind_walls_points,behind_walls_points_power_share,found_targets_share,\
                        false_points_at_half,behind_walls_points_at_half\n"
            .to_owned();
        for result in self.spectra.iter().chain(&self.targets) {
            for (street, image) in result.images.iter().enumerate() {
                let mut fields: Vec<String> =
                    OF_VIEWS.iter().map(|(.., number)| number(image).to_string()).collect();
                fields.push(image.behind_walls.hidden_m2.to_string());
                fields.extend(OF_POINTS.iter().map(|(.., number)| {
                    image.points.as_ref().map_or(String::new(), |points| field(number(points)))
                }));
                let (from, name) = (image.from.name(), &result.name);
                text += &format!("{from},{name},{street},{}\n", fields.join(","));
            }
        }
        text
    }

    const FIGURES: &'static [&'static str] = &[];

    fn figures(&self) -> Vec<String> {
        vec![]
    }
}
