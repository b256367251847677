//! Estimates of many cells as columns of numbers, which cost a program in another language little.

use crate::batch::{BatchEstimate, Spectra, WarningCount};
use crate::estimate::{Source, SpectrumKind};
use crate::method::Method;
use boresight_options::{Described, columns, decibels};
use serde::Serialize;

/// The estimates of many cells, flat: numbers of each source, those of a cell together, strongest first.
#[derive(Debug, Clone, PartialEq, Described, Serialize)]
#[option(name = "BatchEstimate")]
pub struct BatchColumns<'a> {
    /// The method that made them.
    pub method: Method,
    /// Number of cells.
    pub cells: usize,
    /// The index of each source's cell, ascending.
    #[serde(serialize_with = "columns::serialize")]
    pub cell: &'a [u32],
    /// Azimuth of each source.
    #[serde(serialize_with = "columns::serialize")]
    pub azimuth_rad: Vec<f64>,
    /// Elevation of each source.
    #[serde(serialize_with = "columns::serialize")]
    pub elevation_rad: Vec<f64>,
    /// Power of each source at one element.
    #[serde(rename = "power_db", serialize_with = "decibels::serialize_each")]
    pub power: Vec<f64>,
    /// How sure a network is of each source, from 0 to 1; absent from other methods.
    #[serde(skip_serializing_if = "Option::is_none", serialize_with = "columns::serialize_some")]
    pub confidence: Option<Vec<f64>>,
    /// Standard deviation that a network states of each azimuth; absent where the method states none.
    #[serde(skip_serializing_if = "Option::is_none", serialize_with = "columns::serialize_some")]
    pub azimuth_deviation_rad: Option<Vec<f64>>,
    /// The same of each power.
    #[serde(skip_serializing_if = "Option::is_none", serialize_with = "columns::serialize_some")]
    pub power_deviation_db: Option<Vec<f64>>,
    /// The spectra, where they were asked for and the method has them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub spectra: Option<SpectraColumns<'a>>,
    /// Cells in which not all sources asked for or counted were found.
    pub unresolved: usize,
    /// Each kind once.
    pub warnings: &'a [WarningCount],
}

/// Spectra of many cells over the same angles.
#[derive(Debug, Clone, PartialEq, Described, Serialize)]
#[option(name = "BatchSpectra")]
pub struct SpectraColumns<'a> {
    /// Azimuths, ascending.
    #[serde(serialize_with = "columns::serialize")]
    pub azimuth_rad: &'a [f64],
    /// Elevations, ascending; one zero where the array sees azimuth only.
    #[serde(serialize_with = "columns::serialize")]
    pub elevation_rad: &'a [f64],
    /// Linear, the last axis of the shape fastest.
    #[serde(serialize_with = "columns::serialize")]
    pub power: &'a [f32],
    /// Cells, then elevations where there are several, then azimuths.
    #[option(
        typescript = "[cells: number, azimuths: number] | [cells: number, elevations: number, azimuths: number]"
    )]
    pub shape: Vec<usize>,
    /// What the values mean.
    pub kind: SpectrumKind,
}

impl BatchEstimate {
    /// The same as columns.
    #[must_use]
    pub fn columns(&self) -> BatchColumns<'_> {
        let each = |number: fn(&Source) -> f64| self.sources.iter().map(number).collect();
        let stated = |number: fn(&Source) -> Option<f64>| {
            let all: Option<Vec<_>> = self.sources.iter().map(number).collect();
            all.filter(|all| !all.is_empty())
        };
        BatchColumns {
            method: self.method,
            cells: self.cells,
            cell: &self.cell,
            azimuth_rad: each(|source| source.direction.azimuth_rad),
            elevation_rad: each(|source| source.direction.elevation_rad),
            power: each(|source| source.power),
            confidence: stated(|source| source.confidence),
            azimuth_deviation_rad: stated(|source| source.deviation.map(|d| d.azimuth_rad)),
            power_deviation_db: stated(|source| source.deviation.map(|d| d.power_db)),
            spectra: self.spectra.as_ref().map(|spectra| spectra.columns(self.cells)),
            unresolved: self.unresolved,
            warnings: &self.warnings,
        }
    }
}

impl Spectra {
    fn columns(&self, cells: usize) -> SpectraColumns<'_> {
        let (azimuths, elevations) = (self.azimuth_rad.len(), self.elevation_rad.len());
        SpectraColumns {
            azimuth_rad: &self.azimuth_rad,
            elevation_rad: &self.elevation_rad,
            power: &self.values,
            shape: match elevations {
                1 => vec![cells, azimuths],
                _ => vec![cells, elevations, azimuths],
            },
            kind: self.kind,
        }
    }
}
