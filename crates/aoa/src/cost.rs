//! What an estimate costs, before it is made: the operation counts that [`crate::Requirements::cost`] puts in words.

use crate::method::Method;
use crate::options::{EstimatorOptions, IaaForm, SourceCount};
use crate::spectra::quadratic::steps_in_plane;
use boresight_core::array::MAX_ELEMENTS;
use boresight_core::{Array, Extent};

/// Operations of the eigendecomposition of a matrix, and of the inverse of one by tiles, in cubes of its size; of the roots
/// of a polynomial, in squares of its degree.
const EIGEN: f64 = 2.0;
const TILED: f64 = 0.5;
const ROOTS: f64 = 60.0;
/// Operations of a step of a source, in elements.
const STEP: f64 = 12.0;
/// Rounds of alternating projection, and of the steps after it: both settle in fewer than they may take.
const PROJECTIONS: f64 = 3.0;
const SETTLED: f64 = 50.0;
/// Steps of a wave until the atomic norm's certificate holds.
const WAVE_STEPS: f64 = 200.0;

/// Operations of the estimates of one cell, by the leading terms of its algorithm.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Cost {
    fixed: f64,
    a_snapshot: f64,
}

impl Cost {
    /// Of a method, and of the refinement where it is asked for; nothing of a network.
    pub fn new(method: Method, array: &Array, options: &EstimatorOptions) -> Self {
        let size = Size::new(array, options);
        let Size { elements: k, sources: d, .. } = size;
        let (grid, plane) = (size.form(size.points), k * k);
        let covariance = |fixed: f64| Self { fixed, a_snapshot: plane };
        let iterations = options.max_iterations as f64;
        let of_method = match method {
            Method::Bartlett => covariance(grid + d * plane),
            Method::Capon => covariance(k.powi(3) + grid + d * plane),
            Method::Music | Method::MinNorm => covariance(EIGEN * k.powi(3) + grid + d * plane),
            Method::CoarrayMusic => {
                let lags = size.span.min(MAX_ELEMENTS as f64);
                covariance(EIGEN * (lags.powi(3) + k.powi(3)) + grid)
            }
            Method::SingleSnapshotMusic => covariance(EIGEN * (0.5 * k).powi(3) + grid + d * plane),
            Method::RootMusic => covariance(EIGEN * k.powi(3) + ROOTS * size.span.powi(2)),
            Method::Esprit => covariance(EIGEN * (k.powi(3) + d.powi(3))),
            Method::Iaa => {
                let fast = size.way == Way::Transforms && options.iaa.form != IaaForm::Dense;
                let once =
                    if fast { TILED * k.powi(3) + 2.0 * grid } else { k.powi(3) + size.each() };
                let all = options.iaa.iterations as f64 * once + d * d * k;
                Self {
                    fixed: all,
                    a_snapshot: options.iaa.iterations as f64 * size.beams(size.points),
                }
            }
            Method::Nomp => size.pursuit(options),
            Method::AtomicNorm => {
                let pursuit = size.pursuit(options);
                let waves = WAVE_STEPS * d * STEP * k;
                Self { fixed: pursuit.fixed, a_snapshot: pursuit.a_snapshot + waves }
            }
            Method::MaximumLikelihood => {
                let search = (1.0 + PROJECTIONS) * d * 2.0 * grid;
                covariance(EIGEN * k.powi(3) + search + iterations.min(SETTLED) * d * plane)
            }
            Method::SparseBayesian => {
                let sums = if size.way == Way::Transforms { 2.0 * grid } else { size.each() };
                Self {
                    fixed: iterations * (2.0 * k.powi(3) + sums),
                    a_snapshot: iterations * (plane + size.beams(size.points)),
                }
            }
            _ => Self::default(),
        };
        let refinement = if options.refine { size.pursuit(options) } else { Self::default() };
        Self {
            fixed: of_method.fixed + refinement.fixed,
            a_snapshot: of_method.a_snapshot + refinement.a_snapshot,
        }
    }

    /// Of a cell of so many snapshots.
    pub fn operations(&self, snapshots: usize) -> f64 {
        self.fixed + self.a_snapshot * snapshots as f64
    }
}

/// Operations of the eigenvalues of a covariance of so many elements and snapshots.
pub(crate) fn eigenvalues(elements: usize, snapshots: usize) -> f64 {
    let k = elements as f64;
    EIGEN * k.powi(3) + k * k * snapshots as f64
}

/// How large a problem is.
struct Size {
    elements: f64,
    /// Places on the lattice between the first and the last element, all of them used or not.
    span: f64,
    sources: f64,
    /// Points of the grid, and how many elevations they have.
    points: f64,
    elevations: f64,
    way: Way,
}

/// How forms and beams are had on a grid.
#[derive(Clone, Copy, PartialEq)]
enum Way {
    Transforms,
    Lags,
    Each,
}

impl Size {
    fn new(array: &Array, options: &EstimatorOptions) -> Self {
        let elements = options.smoothing.unwrap_or(array.len()).min(array.len());
        let sources = match options.sources {
            SourceCount::Known(count) => count,
            _ => options.max_peaks,
        };
        let elevations = if array.extent() == Extent::Area { options.elevation_points } else { 1 };
        let (way, lattice) = match array.lattice() {
            Some(lattice) => (Way::Transforms, Some(lattice)),
            None => {
                steps_in_plane(array).map_or((Way::Each, None), |steps| (Way::Lags, Some(steps)))
            }
        };
        Self {
            elements: elements as f64,
            span: lattice.map_or(0.0, |lattice| lattice.span() as f64),
            sources: sources.min(elements) as f64,
            points: (options.grid_points * elevations) as f64,
            elevations: elevations as f64,
            way,
        }
    }

    /// A Hermitian form at so many points of a grid.
    fn form(&self, points: f64) -> f64 {
        let plane = self.elements * self.elements;
        match self.way {
            Way::Transforms => plane + self.beams(points),
            Way::Lags => 0.5 * plane * (1.0 + self.elevations) + points * self.span,
            Way::Each => points * plane,
        }
    }

    /// Products with the steering vector of each point of the grid.
    fn each(&self) -> f64 {
        self.points * self.elements * self.elements
    }

    /// A snapshot's beams at so many points.
    fn beams(&self, points: f64) -> f64 {
        points * if self.way == Way::Transforms { points.log2() } else { self.elements }
    }

    /// NOMP, and what searches as it does.
    fn pursuit(&self, options: &EstimatorOptions) -> Cost {
        let nomp = &options.nomp;
        let d = self.elements.min(nomp.max_sources as f64);
        let steps =
            nomp.single_refinements as f64 + 0.5 * d * (1.0 + nomp.cyclic_refinements as f64);
        // A grid of its own, as fine as the array is wide.
        let points = self.elements * nomp.oversampling as f64;
        let [once, a_snapshot] = match self.way {
            Way::Transforms => [0.0, self.beams(points)],
            _ => [self.form(points), self.elements * self.elements],
        };
        Cost {
            fixed: d * once + d.powi(3) * self.elements,
            a_snapshot: d * (a_snapshot + steps * STEP * self.elements),
        }
    }
}
