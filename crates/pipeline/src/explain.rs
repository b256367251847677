//! Why a cell of the range-Doppler map is a detection, or is none.

use crate::capture::Report;
use crate::chain::{Cell, Chain, Found};
use crate::error::PipelineError;
use crate::result::Counts;
use crate::source::FrameSource;
use boresight_core::Complex64;
use boresight_math::decibels::power_to_db;
use boresight_options::{Described, decibels};
use boresight_signal::peaks::{interpolate, peak_of};
use boresight_signal::{CellThreshold, Detection};
use ndarray::ArrayView3;
use serde::Serialize;
use std::ops::Range;

/// What became of a cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Described, Serialize)]
#[option(name = "CellVerdict")]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// Its power is not above its threshold.
    BelowThreshold,
    /// It is over its threshold beside a stronger one, whose peak it belongs to.
    Grouped,
    /// It is the echo of a stronger target in another Doppler band, in Doppler division.
    OtherBand,
    /// Its range is outside the limits.
    OutsideRange,
    /// Its range rate is outside the limits.
    OutsideRate,
    /// More cells than are kept are stronger.
    BeyondLimit,
    /// The method found no angle in it.
    WithoutAngle,
    /// No direction found in it is within the limits.
    OutsideDirection,
    /// It is a detection.
    Kept,
}

/// What a cell was held against, and what became of it.
#[derive(Debug, Clone, PartialEq, Described, Serialize)]
pub struct CellExplanation {
    /// Range bin.
    pub range_bin: usize,
    /// Doppler bin.
    pub doppler_bin: usize,
    /// What became of it.
    pub verdict: Verdict,
    /// The same in a sentence, with figures.
    pub message: String,
    /// Its power: mean over channels, as in the map.
    #[serde(rename = "power_db", serialize_with = "decibels::serialize")]
    pub power: f64,
    /// Noise power estimated from its training cells.
    #[serde(rename = "noise_db", serialize_with = "decibels::serialize")]
    pub noise_power: f64,
    /// Its threshold.
    #[serde(rename = "threshold_db", serialize_with = "decibels::serialize")]
    pub threshold: f64,
    /// Training cells around it.
    pub training_cells: usize,
    /// Of these, cells left out of the noise as targets of their own.
    pub excised_cells: usize,
    /// Range bin of the peak that it belongs to: its own, or a stronger neighbour's.
    pub peak_range_bin: usize,
    /// Doppler bin of that peak.
    pub peak_doppler_bin: usize,
    /// Thresholds along range at its Doppler bin.
    #[serde(rename = "profile_threshold_db", serialize_with = "decibels::serialize_each")]
    pub profile_threshold: Vec<f64>,
}

impl Chain {
    /// Why a cell of the frames in `frames` is a detection or none: of one frame as in [`Chain::process`], of several
    /// together as in [`Chain::combine`]. The limit on detections is that on cells; several angles of a cell may exceed
    /// it later.
    ///
    /// # Errors
    /// As [`Chain::combine`]; a bin outside the map.
    pub fn explain<S: FrameSource>(
        &mut self,
        source: &S,
        frames: Range<usize>,
        [range_bin, doppler_bin]: [usize; 2],
        report: Report<'_>,
    ) -> Result<CellExplanation, S::Error> {
        let (ranges, dopplers) = self.map.power.dim();
        for (what, bin, bins) in
            [("range bin", range_bin, ranges), ("Doppler bin", doppler_bin, dopplers)]
        {
            boresight_math::error::check_range(what, bin as f64, 0.0, bins as f64 - 1.0)
                .map_err(PipelineError::from)?;
        }
        // The mean of one frame is its map.
        self.average(source, frames.clone(), report)?;
        let mut told = self.explain_in_map([range_bin, doppler_bin])?;
        if told.verdict == Verdict::Kept {
            let cells: Vec<Cell> = self.kept_at([range_bin, doppler_bin])?.into_iter().collect();
            let mut found = Found { cells, counts: Counts::default() };
            let snapshots = self.snapshots_of(&mut found, source, frames, report)?;
            told.verdict = match found.cells.first() {
                Some(cell) => self.verdict_of_directions(cell.range_m, snapshots.view())?,
                // The rate of its fold is.
                None => Verdict::OutsideRate,
            };
            told.message = self.sentence(&told);
        }
        Ok(told)
    }

    /// The cell of a bin among those that are kept.
    fn kept_at(
        &mut self,
        [range_bin, doppler_bin]: [usize; 2],
    ) -> Result<Option<Cell>, PipelineError> {
        let found = self.detect()?.cells;
        let is_there = |cell: &Cell| {
            let at = cell.peak.detection;
            [at.range_bin, at.doppler_bin] == [range_bin, doppler_bin]
        };
        Ok(found.into_iter().find(is_there))
    }

    /// Of a bin within the map; kept, as far as angles are not known.
    fn explain_in_map(
        &mut self,
        [range_bin, doppler_bin]: [usize; 2],
    ) -> Result<CellExplanation, PipelineError> {
        let power = self.map.power.view();
        let profile = self.cfar.thresholds(power, doppler_bin)?;
        let own = profile[range_bin];
        let peak = peak_of(power, [range_bin, doppler_bin]).unwrap_or([range_bin, doppler_bin]);
        let CellThreshold { power, noise_power, threshold, .. } = own;
        let detection = Detection { range_bin, doppler_bin, power, noise_power, threshold };
        let cell = self.cell(interpolate(self.map.power.view(), detection));
        let is_peak = peak == [range_bin, doppler_bin];
        let verdict = if power <= threshold {
            Verdict::BelowThreshold
        } else if self.options().peak_grouping && !is_peak {
            Verdict::Grouped
        } else if self.is_ghost([range_bin, doppler_bin]) {
            Verdict::OtherBand
        } else if !self.region.contains_range(cell.range_m) {
            Verdict::OutsideRange
        } else if self.folds.is_none() && !self.region.contains(cell.range_m, cell.rate_mps) {
            Verdict::OutsideRate
        } else if self.kept_at([range_bin, doppler_bin])?.is_some() {
            Verdict::Kept
        } else {
            Verdict::BeyondLimit
        };
        let mut explanation = CellExplanation {
            range_bin,
            doppler_bin,
            verdict,
            message: String::new(),
            power,
            noise_power,
            threshold,
            training_cells: own.training_cells,
            excised_cells: own.excised_cells,
            peak_range_bin: peak[0],
            peak_doppler_bin: peak[1],
            profile_threshold: profile.iter().map(|cell| cell.threshold).collect(),
        };
        explanation.message = self.sentence(&explanation);
        Ok(explanation)
    }

    fn sentence(&self, told: &CellExplanation) -> String {
        let over_db = power_to_db(told.power / told.threshold.max(f64::MIN_POSITIVE));
        let used = told.training_cells - told.excised_cells;
        let noise = format!(
            "noise {:.1} dBFS by {used} training cells{}",
            decibels::finite_db(told.noise_power),
            match told.excised_cells {
                0 => String::new(),
                gone if used == 0 => format!(", all {gone} targets themselves"),
                gone => format!(", {gone} more left out as targets themselves"),
            }
        );
        let over = format!("{over_db:.1} dB over its threshold");
        match told.verdict {
            Verdict::BelowThreshold => {
                format!("No detection: {:.1} dB below its threshold; {noise}.", -over_db)
            }
            Verdict::Grouped => {
                let ranges = told.range_bin.abs_diff(told.peak_range_bin);
                let dopplers = self.map.power.ncols();
                let apart = told.doppler_bin.abs_diff(told.peak_doppler_bin);
                let apart = apart.min(dopplers - apart);
                let [ranges, apart] = [(ranges, "range"), (apart, "Doppler")]
                    .map(|(n, axis)| format!("{n} {axis} bin{}", if n == 1 { "" } else { "s" }));
                format!("Part of a stronger peak {ranges} and {apart} away; {over}.")
            }
            Verdict::OtherBand => {
                format!("The echo of a stronger target in another Doppler band; {over}.")
            }
            Verdict::OutsideRange => format!("Dropped for its range; {over}."),
            Verdict::OutsideRate => format!("Dropped for its range rate; {over}."),
            Verdict::BeyondLimit => format!(
                "Dropped since {} cells are stronger, the most that are kept; {over}.",
                self.options().max_detections
            ),
            Verdict::WithoutAngle => format!("The method found no angle in it; {over}."),
            Verdict::OutsideDirection => format!("Dropped for its direction; {over}."),
            Verdict::Kept => format!("A detection: {over}; {noise}."),
        }
    }

    /// Of the one cell that is kept, by its snapshots.
    fn verdict_of_directions(
        &mut self,
        range_m: f64,
        snapshots: ArrayView3<'_, Complex64>,
    ) -> Result<Verdict, PipelineError> {
        let estimates = self.estimators.estimate_batch(snapshots, false)?;
        let sources = estimates.sources_of(0);
        Ok(if sources.is_empty() {
            Verdict::WithoutAngle
        } else if sources.iter().any(|s| self.region.contains_direction(range_m, *s.direction)) {
            Verdict::Kept
        } else {
            Verdict::OutsideDirection
        })
    }
}
