//! Bird's-eye images of simulated streets by several methods, like beside like: spectra beside
//! spectra, targets beside targets, and the detections of the ordinary chain among these. Figures 1,
//! 6 and 7 of the AAETR paper, with a truth.

pub mod report;

pub use report::{ImagesReport, ImagesResult};

use crate::entrants::{Entrants, by_entrants};
use crate::error::EvaluateError;
use boresight_aoa::Method;
use boresight_cli::street::{CHAIN, ImageFigures, Maker, StreetFrames};
use boresight_core::InputError;
use boresight_image::{HiddenMeasure, PointMeasure, ViewGrid};
use boresight_math::error::check_range;
use boresight_neural::Model;
use boresight_options::Named;
use boresight_pipeline::image::{Angles, Content};
use boresight_simulate::street::STREET_RADARS;
use boresight_simulate::{Street, StreetOptions};
use boresight_validate::experiment::Experiment;
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

/// Methods that are compared if none are named: those quick enough for thousands of cells.
pub const DEFAULT_METHODS: [&str; 5] = ["bartlett", "capon", "iaa", "nomp", CHAIN];

/// What is shown of each street: all of it, in x and y, m.
const SHOWN_M: [[f64; 2]; 2] = [[-45.0, 80.0], [-25.0, 25.0]];
/// Width of a cell, m.
const CELL_M: f64 = 0.2;

/// What to run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct ImagesExperiment {
    /// Streets, one frame of all radars each.
    pub streets: u64,
    /// Seed of the first street; each has that after the one before.
    pub seed: u64,
    /// Methods by name, [`CHAIN`] among them, and networks.
    #[serde(flatten)]
    pub entrants: Entrants,
}

/// Images to make of each street.
#[derive(Clone)]
pub struct Plan {
    grid: ViewGrid,
    images: Vec<Image>,
}

/// An image of each street.
#[derive(Clone)]
struct Image {
    name: String,
    by: By,
}

#[derive(Clone)]
enum By {
    Cells(Box<Angles>, Option<Model>),
    Chain,
}

impl Image {
    fn maker(&self) -> Maker<'_> {
        match &self.by {
            By::Cells(angles, model) => Maker::Cells { angles, model: model.as_ref() },
            By::Chain => Maker::Chain,
        }
    }
}

/// What is kept of a street.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct ImagesRecord {
    /// Seed of the street.
    pub seed: u64,
    /// Detected cells of all radars.
    pub cells: usize,
    /// Its images.
    pub images: Vec<ImageRecord>,
}

/// How much of an image is not target. Shares are linear.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct ImageRecord {
    /// What it was made by.
    pub name: String,
    /// What it is made of.
    pub from: Content,
    /// Energy outside the gates over all energy.
    pub outside_share: f64,
    /// Strongest cell outside the gates over the strongest of all.
    pub peak_outside: f64,
    /// Share of the cells outside the gates that are lit.
    pub lit_outside: f64,
    /// Share of the targets in view with a lit cell in their gate.
    pub lit_targets: f64,
    /// What is behind walls.
    pub behind_walls: HiddenMeasure,
    /// The points it is made of; hidden ones are behind walls.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub points: Option<PointMeasure>,
}

impl ImageRecord {
    fn new(name: &str, from: Content, figures: &ImageFigures) -> Self {
        let ImageFigures { sidelobes, behind_walls, points } = *figures;
        Self {
            name: name.into(),
            from,
            outside_share: sidelobes.outside_share,
            peak_outside: sidelobes.peak_outside,
            lit_outside: sidelobes.lit_outside,
            lit_targets: sidelobes.lit_targets,
            behind_walls,
            points,
        }
    }
}

impl Experiment for ImagesExperiment {
    const NAME: &'static str = "images";
    type Plan = Plan;
    type Error = EvaluateError;
    type Record = ImagesRecord;
    type Report = ImagesReport;

    fn plan(&self) -> Result<Plan, EvaluateError> {
        check_range("streets", self.streets as f64, 1.0, 1e6)?;
        self.entrants.check()?;
        let mut names = self.entrants.methods.clone();
        let mut known = BTreeSet::new();
        names.retain(|name| known.insert(name.clone()));
        let methods = names.iter().map(|name| images_by(name));
        let networks = self.entrants.networks.iter().map(|network| {
            let other = || InputError::Incompatible {
                what: format!("network {}", network.name),
                expected: "one that finds angles in a snapshot".into(),
                given: network.kind.name().into(),
            };
            let angles = Angles::of(network.kind.method().ok_or_else(other)?);
            Ok(vec![Image {
                name: network.name.clone(),
                by: By::Cells(Box::new(angles), network.model.clone()),
            }])
        });
        let images: Result<Vec<_>, EvaluateError> = methods.chain(networks).collect();
        let [x_m, y_m] = SHOWN_M;
        Ok(Plan { grid: ViewGrid::new(x_m, y_m, CELL_M)?, images: images?.concat() })
    }

    fn methods(plan: &Plan) -> Vec<String> {
        let mut names: Vec<String> = plan.images.iter().map(|image| image.name.clone()).collect();
        names.dedup();
        names
    }

    by_entrants!();

    fn join(record: &mut ImagesRecord, other: ImagesRecord) {
        record.images.extend(other.images);
    }

    fn scenes(&self) -> u64 {
        self.streets
    }

    fn scene(&self, plan: &Plan, number: u64) -> Result<ImagesRecord, EvaluateError> {
        let seed = self.seed.wrapping_add(number);
        let street = Street::new(StreetOptions { seed, ..StreetOptions::default() })?;
        let radars: Vec<usize> = (0..STREET_RADARS.len()).collect();
        let frames = StreetFrames::new(street, &radars)?;
        let cells = frames.frames.iter().map(|frame| frame.cells.cells.len()).sum();
        let record = |image: &Image| {
            let maker = image.maker();
            let figures = frames.figures(&frames.image(&maker, plan.grid)?)?;
            Ok(ImageRecord::new(&image.name, maker.content(), &figures))
        };
        let images = plan.images.iter().map(record).collect::<Result<_, EvaluateError>>()?;
        Ok(ImagesRecord { seed, cells, images })
    }

    fn report(&self, _: &Plan, records: impl Iterator<Item = ImagesRecord>) -> ImagesReport {
        ImagesReport::new(self, records)
    }
}

/// The images by a method: of its targets, and of its spectra where it has them.
fn images_by(name: &str) -> Result<Vec<Image>, EvaluateError> {
    let image = |by| Image { name: name.into(), by };
    if name == CHAIN {
        return Ok(vec![image(By::Chain)]);
    }
    let method = Method::from_name(name)?;
    let mut contents = vec![Content::Targets];
    contents.extend(method.requirements().spectrum.then_some(Content::Spectra));
    let angles = |content| Angles { content, ..Angles::of(method) };
    Ok(contents
        .into_iter()
        .map(|content| image(By::Cells(Box::new(angles(content)), None)))
        .collect())
}
