//! Whether a method suits an array and a number of snapshots.

use crate::method::Method;
use crate::options::EstimatorOptions;
use boresight_core::array::MAX_ELEMENTS;
use boresight_core::lattice::Lattice;
use boresight_core::{Array, Extent};
use boresight_options::Described;
use serde::Serialize;

/// Why a method cannot work on an array, or on so many snapshots of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Described, Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Unsuited {
    /// All elements are at one place along y, so no azimuth can be told.
    OnePlace,
    /// It needs elements evenly spaced along y, in order.
    UniformArray,
    /// It needs elements on a grid along y.
    Grid,
    /// It needs elements on neighbouring places of the grid.
    NoNeighbours,
    /// It tells no elevation, and the array spans an area.
    Elevation,
    /// It needs more snapshots, averaging or smoothing.
    FewSnapshots,
    /// It takes fewer snapshots.
    ManySnapshots,
}

impl Unsuited {
    /// What the method needs, and what the array does instead.
    pub(crate) fn words(self) -> (&'static str, &'static str) {
        match self {
            Self::OnePlace => {
                ("elements at different places along y", "has them all at one place along y")
            }
            Self::UniformArray => {
                ("elements evenly spaced along y, in order", "is not evenly spaced")
            }
            Self::Grid => ("elements on a grid along y", "stands on no such grid"),
            Self::NoNeighbours => {
                ("elements on neighbouring places of a grid along y", "has no such neighbours")
            }
            Self::Elevation => ("elements along y only", "spans an area"),
            Self::FewSnapshots => ("more snapshots, averaging or smoothing", "gave too few"),
            Self::ManySnapshots => ("fewer snapshots", "gave more"),
        }
    }
}

/// Why `method` with these options cannot work on `snapshots` snapshots of an array; nothing where it can.
///
/// ```
/// use boresight_aoa::suits::{Unsuited, unsuited};
/// use boresight_aoa::{Method, EstimatorOptions};
/// use boresight_core::Array;
///
/// let array = Array::new(&[[0.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 5.0, 0.0]])?;
/// assert_eq!(unsuited(Method::Esprit, &array, &EstimatorOptions::default(), 10), Some(Unsuited::UniformArray));
/// assert_eq!(unsuited(Method::Capon, &array, &EstimatorOptions::default(), 10), None);
/// # Ok::<(), boresight_core::InputError>(())
/// ```
pub fn unsuited(
    method: Method,
    array: &Array,
    options: &EstimatorOptions,
    snapshots: usize,
) -> Option<Unsuited> {
    let most = method.requirements().max_snapshots;
    let subarrays = (array.len() + 1).saturating_sub(options.smoothing.unwrap_or(array.len()));
    if let Some(reason) = unsuited_array(method, array) {
        Some(reason)
    } else if too_few(method, snapshots, subarrays, options.forward_backward) {
        Some(Unsuited::FewSnapshots)
    } else if most.is_some_and(|most| snapshots > most) {
        Some(Unsuited::ManySnapshots)
    } else {
        None
    }
}

pub(crate) fn unsuited_array(method: Method, array: &Array) -> Option<Unsuited> {
    let extent = array.extent();
    let needs = method.requirements();
    if extent == Extent::Point || array.aperture() < 1e-6 {
        Some(Unsuited::OnePlace)
    } else if needs.uniform_array && !array.is_uniform() {
        Some(Unsuited::UniformArray)
    } else if needs.lattice && array.lattice().is_none() {
        Some(Unsuited::Grid)
    } else if method == Method::CoarrayMusic
        && array.lattice().is_some_and(|lattice| longest_lag(&lattice) == 0)
    {
        Some(Unsuited::NoNeighbours)
    } else if extent == Extent::Area && !needs.elevation {
        Some(Unsuited::Elevation)
    } else {
        None
    }
}

/// Whether a covariance of so many snapshots is of too low a rank: each subarray of smoothing counts as one more, and
/// averaging forward and backward doubles them.
pub(crate) fn too_few(
    method: Method,
    snapshots: usize,
    subarrays: usize,
    forward_backward: bool,
) -> bool {
    let least = method.requirements().min_snapshots;
    if method == Method::CoarrayMusic {
        // Neither adds to what it averages over equal distances.
        return snapshots < least;
    }
    let copies = if forward_backward { 2 } else { 1 };
    snapshots.saturating_mul(subarrays).saturating_mul(copies) < least
}

/// The longest lag up to which all occur between elements, at most what an array may hold.
pub(crate) fn longest_lag(lattice: &Lattice) -> usize {
    let mut occurs = vec![false; lattice.span()];
    for (place, &i) in lattice.indices.iter().enumerate() {
        for &k in &lattice.indices[..place] {
            occurs[i.abs_diff(k)] = true;
        }
    }
    let gap = (1..occurs.len()).find(|&lag| !occurs[lag]).unwrap_or(occurs.len());
    (gap - 1).min(MAX_ELEMENTS - 1)
}
