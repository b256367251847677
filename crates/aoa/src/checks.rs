//! Checks and remarks all methods share.

use crate::error::AoaError;
use crate::estimate::{Estimate, Source, Spectrum, Warning};
use crate::method::Method;
use crate::options::{EstimatorOptions, SourceCount};
use crate::suits::unsuited_array;
use boresight_core::limits::check_bytes;
use boresight_core::{Array, Complex64, Direction, Extent, Lattice};
use boresight_math::order::sort_in_place;

/// Memory of a grid point: its direction, its value, and what transforms make on the way.
const POINT_BYTES: usize = 128;

/// Checks that the array tells angles apart and has the shape `method` asks for, and that the grid
/// is of a size that can be held.
pub(crate) fn check_array(
    method: Method,
    array: &Array,
    options: &EstimatorOptions,
) -> Result<(), AoaError> {
    if let Some(reason) = unsuited_array(method, array) {
        let (expected, given) = reason.words();
        return Err(AoaError::Array {
            method: method.name(),
            expected: expected.into(),
            given: given.into(),
        });
    }
    let elevations = if array.extent() == Extent::Area { options.elevation_points } else { 1 };
    check_bytes(
        "grid_points times elevation_points",
        &[options.grid_points, elevations],
        POINT_BYTES,
    )?;
    Ok(())
}

/// Checks a known number of sources against the most the method can find.
pub(crate) fn check_sources(
    method: Method,
    wanted: SourceCount,
    most: usize,
) -> Result<(), AoaError> {
    match wanted {
        SourceCount::Known(given) if given > most => {
            Err(AoaError::TooManySources { method: method.name(), most, given })
        }
        _ => Ok(()),
    }
}

/// A warning where the field of view is wider than the sector without grating lobes.
pub(crate) fn ambiguity(array: &Array, options: &EstimatorOptions) -> Option<Warning> {
    if let Some(sine) = array.unambiguous_elevation_sine() {
        return (sine < options.elevation_field_of_view_rad.sin() - 1e-9)
            .then(|| Warning::AmbiguousElevation { unambiguous_rad: sine.asin() });
    }
    let sine = array.lattice()?.unambiguous_sine();
    (sine < options.field_of_view_rad.sin() - 1e-9)
        .then(|| Warning::Ambiguous { unambiguous_rad: sine.asin() })
}

/// Extent below which no array tells angles apart, half wavelengths.
const LEAST_EXTENT: f64 = 0.4;

/// A warning where the elements are so near each other that their positions seem to be in another unit.
pub(crate) fn scale_of(array: &Array) -> Option<Warning> {
    let origin = array.positions()[0];
    let away =
        |p: &[f64; 3]| p.iter().zip(origin).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt();
    let extent = array.positions().iter().map(away).fold(0.0, f64::max);
    (extent < LEAST_EXTENT).then_some(Warning::TinyArray { extent })
}

/// From phase turns between neighbouring points of a lattice to directions.
#[derive(Debug, Clone)]
pub(crate) struct LatticeAngles {
    spacing: f64,
    limit: f64,
}

impl LatticeAngles {
    pub fn new(lattice: &Lattice, options: &EstimatorOptions) -> Self {
        Self { spacing: lattice.spacing, limit: options.field_of_view_rad.sin() + 1e-12 }
    }

    /// The direction for which `turn` has the phase `pi d u`, if it is in the field of view.
    pub fn direction(&self, turn: Complex64) -> Option<Direction> {
        let sine = turn.arg() / (std::f64::consts::PI * self.spacing);
        (sine.abs() <= self.limit).then(|| Direction::azimuth(sine.clamp(-1.0, 1.0).asin()))
    }
}

/// Puts an estimate together: sources in order of power, `resolved`, and the warnings that follow
/// from the number found. `expected` is the number asked for or counted; nothing for methods that
/// report what stands out.
pub(crate) fn conclude(
    method: Method,
    sources: Vec<Source>,
    expected: Option<usize>,
    spectrum: Option<Spectrum>,
    iterations: usize,
    warnings: Vec<Warning>,
) -> Estimate {
    let mut estimate =
        Estimate { sources, spectrum, iterations, warnings, ..Estimate::new(method) };
    settle(&mut estimate, expected);
    estimate
}

/// Puts the sources of an estimate in order, and sets `resolved` and the warnings that follow from
/// their number.
pub fn settle(estimate: &mut Estimate, expected: Option<usize>) {
    let Estimate { sources, warnings, .. } = estimate;
    // Equal powers go by angle.
    sort_in_place(sources, |a, b| {
        let angles = a.direction.azimuth_rad.total_cmp(&b.direction.azimuth_rad);
        b.power.total_cmp(&a.power).then(angles).is_lt()
    });
    let found = sources.len();
    match expected {
        Some(expected) if found < expected => {
            warnings.push(Warning::Unresolved { expected, found });
        }
        _ if found == 0 => warnings.push(Warning::NoSources),
        _ => {}
    }
    estimate.expected = expected;
    estimate.resolved = found > 0 && expected.is_none_or(|expected| found >= expected);
}
