//! Many cells at once.

pub mod columns;
pub mod threads;

use crate::data::check_all_finite;
use crate::error::AoaError;
use crate::estimate::{Estimate, Source, SpectrumKind, Warning};
use crate::estimator::Estimator;
use crate::method::Method;
use boresight_core::limits::{check_bytes, check_operations};
use boresight_core::{Complex64, InputError, Remark};
use boresight_options::{Described, Flat, remark};
use ndarray::{ArrayView3, Axis};
use serde::Serialize;

/// Memory of a point of a spectrum: itself, and a copy for whoever asked.
const SPECTRUM_BYTES: usize = 8;

/// Results of many cells, flat.
#[derive(Debug, Clone, PartialEq)]
pub struct BatchEstimate {
    /// The method that made them.
    pub method: Method,
    /// Number of cells.
    pub cells: usize,
    /// For each source the index of its cell, ascending.
    pub cell: Vec<u32>,
    /// The sources of all cells; those of a cell strongest first.
    pub sources: Vec<Source>,
    /// The spectra of all cells, where they were asked for and the method has them.
    pub spectra: Option<Spectra>,
    /// Cells in which not all sources asked for or counted were found.
    pub unresolved: usize,
    /// Each kind of warning once.
    pub warnings: Vec<WarningCount>,
}

/// Spectra over the same angles.
#[derive(Debug, Clone, PartialEq)]
pub struct Spectra {
    /// Azimuths, rad, ascending.
    pub azimuth_rad: Vec<f64>,
    /// Elevations, rad, ascending; one zero where the array sees azimuth only.
    pub elevation_rad: Vec<f64>,
    /// Linear values, cells x elevations x azimuths; beyond the largest `f32` that.
    pub values: Vec<f32>,
    /// What they mean.
    pub kind: SpectrumKind,
}

/// A kind of warning, told by the first cell that has one.
#[derive(Debug, Clone, PartialEq, Described, Serialize)]
#[option(name = "BatchWarning")]
pub struct WarningCount {
    /// That of the first cell it holds for.
    #[option(described_as = Flat<Remark>)]
    #[serde(serialize_with = "remark::serialize_flat")]
    pub first: Warning,
    /// Number of cells it holds for.
    pub cells: usize,
}

impl std::fmt::Display for WarningCount {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.cells {
            1 => write!(f, "{}", self.first),
            cells => write!(f, "{} ({cells} cells; this is the first)", self.first),
        }
    }
}

impl BatchEstimate {
    /// Nothing yet.
    pub fn new(method: Method) -> Self {
        Self {
            method,
            cells: 0,
            cell: Vec::new(),
            sources: Vec::new(),
            spectra: None,
            unresolved: 0,
            warnings: Vec::new(),
        }
    }

    /// Sources of one cell, strongest first.
    pub fn sources_of(&self, cell: usize) -> &[Source] {
        let from = self.cell.partition_point(|&c| (c as usize) < cell);
        let count = self.cell[from..].partition_point(|&c| c as usize == cell);
        &self.sources[from..from + count]
    }

    fn clear(&mut self, method: Method, spectra: bool) {
        self.method = method;
        self.cells = 0;
        self.cell.clear();
        self.sources.clear();
        self.unresolved = 0;
        self.warnings.clear();
        match &mut self.spectra {
            Some(kept) if spectra => kept.values.clear(),
            kept => *kept = None,
        }
    }

    fn warn(&mut self, warning: &Warning, cells: usize) {
        let kind = std::mem::discriminant(warning);
        match self.warnings.iter_mut().find(|w| std::mem::discriminant(&w.first) == kind) {
            Some(known) => known.cells += cells,
            None => self.warnings.push(WarningCount { first: warning.clone(), cells }),
        }
    }

    /// Adds the cells that follow, of the same method and grid.
    pub(crate) fn append(&mut self, next: &Self) {
        let before = self.cells as u32;
        self.cell.extend(next.cell.iter().map(|cell| cell + before));
        self.sources.extend_from_slice(&next.sources);
        if let (Some(spectra), Some(next)) = (&mut self.spectra, &next.spectra) {
            spectra.values.extend_from_slice(&next.values);
        }
        self.unresolved += next.unresolved;
        for WarningCount { first, cells } in &next.warnings {
            self.warn(first, *cells);
        }
        self.cells += next.cells;
    }

    fn add(&mut self, estimate: &Estimate, spectra: bool) {
        self.cell.extend(estimate.sources.iter().map(|_| self.cells as u32));
        self.sources.extend_from_slice(&estimate.sources);
        if let Some(spectrum) = estimate.spectrum.as_ref().filter(|_| spectra) {
            let all = self.spectra.get_or_insert_with(|| Spectra {
                azimuth_rad: spectrum.azimuth_rad.clone(),
                elevation_rad: spectrum.elevation_rad.clone(),
                values: Vec::new(),
                kind: spectrum.kind,
            });
            all.values.extend(spectrum.values.iter().map(|&v| v.min(f64::from(f32::MAX)) as f32));
        }
        self.unresolved += usize::from(!estimate.resolved);
        for warning in &estimate.warnings {
            self.warn(warning, 1);
        }
        self.cells += 1;
    }
}

impl Estimator {
    /// Estimates the angles in many cells: cells x elements x snapshots. Each gives what
    /// [`Estimator::estimate`] gives for it alone.
    ///
    /// # Errors
    /// [`AoaError`] when the data is malformed or does not suit the method; then there is no result
    /// for any cell. [`InputError::TooLarge`] above the limits of the thread ([`boresight_core::limits`]).
    pub fn estimate_batch(
        &mut self,
        snapshots: ArrayView3<'_, Complex64>,
        spectra: bool,
    ) -> Result<BatchEstimate, AoaError> {
        let mut out = BatchEstimate::new(self.method());
        self.estimate_batch_into(snapshots, spectra, &mut out)?;
        Ok(out)
    }

    /// Like [`Estimator::estimate_batch`], into a result whose memory is used again.
    ///
    /// # Errors
    /// As [`Estimator::estimate_batch`].
    pub fn estimate_batch_into(
        &mut self,
        snapshots: ArrayView3<'_, Complex64>,
        spectra: bool,
        out: &mut BatchEstimate,
    ) -> Result<(), AoaError> {
        out.clear(self.method(), spectra);
        let (cells, elements, count) = snapshots.dim();
        if elements != self.array().len() || count == 0 || u32::try_from(cells).is_err() {
            return Err(InputError::Shape {
                what: "snapshots".into(),
                expected: format!("[cells, {}, snapshots]", self.array().len()),
                given: vec![cells, elements, count],
            }
            .into());
        }
        let operations = self.operations(count, cells)?;
        check_operations("the estimates", cells as f64 * operations)?;
        check_all_finite("snapshots", snapshots)?;
        let at_once = self.cells_at_once();
        let mut scratch = std::mem::take(&mut self.scratch);
        scratch.resize_with(at_once.min(cells), || Estimate::new(self.method()));
        for portion in snapshots.axis_chunks_iter(Axis(0), at_once) {
            let estimates = &mut scratch[..portion.dim().0];
            self.estimate_cells(portion, estimates)?;
            if let Some(spectrum) = estimates.first().and_then(|first| first.spectrum.as_ref()) {
                let kept = if spectra { cells } else { 0 };
                check_bytes("the spectra", &[kept, spectrum.values.len()], SPECTRUM_BYTES)?;
            }
            for estimate in estimates {
                out.add(estimate, spectra);
            }
        }
        self.scratch = scratch;
        Ok(())
    }
}
