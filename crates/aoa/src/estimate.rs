//! What an estimator returns.

use crate::method::Method;
use boresight_core::{Complex64, Direction, Remark};
use boresight_options::remark::Coded;
use boresight_options::{Described, Flat, columns, decibels, remark};
use serde::{Deserialize, Serialize};

/// One source found.
#[derive(Debug, Clone, Copy, PartialEq, Described, Serialize)]
pub struct Source {
    /// Where it is.
    pub direction: Flat<Direction>,
    /// Its power at one element.
    #[serde(rename = "power_db", serialize_with = "decibels::serialize")]
    pub power: f64,
    /// Its complex amplitude at the array's origin, where a single snapshot determines it.
    #[option(
        typescript = "readonly [re: number, im: number]",
        schema = r#"{ "type": "array", "items": { "type": "number" } }"#
    )]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub amplitude: Option<Complex64>,
    /// How sure a network is of it, from 0 to 1; absent from other methods.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub confidence: Option<f64>,
    /// Standard deviations that a network states of its answer; absent where the method states none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub deviation: Option<Deviation>,
}

impl Source {
    /// A source of which no more is known.
    pub fn new(direction: Direction, power: f64) -> Self {
        Self {
            direction: direction.into(),
            power,
            amplitude: None,
            confidence: None,
            deviation: None,
        }
    }
}

/// Standard deviations of what is told of a source.
#[derive(Debug, Clone, Copy, PartialEq, Described, Serialize)]
#[option(name = "SourceDeviation")]
pub struct Deviation {
    /// Of the azimuth.
    pub azimuth_rad: f64,
    /// Of the power.
    pub power_db: f64,
}

/// What the values of a spectrum mean.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Described, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum SpectrumKind {
    /// Power at one element.
    #[default]
    Power,
    /// A pseudo-spectrum: its peaks tell angles, its height no power.
    Pseudo,
}

/// Values over a grid of angles.
#[derive(Debug, Clone, PartialEq, Default, Described, Serialize)]
pub struct Spectrum {
    /// Azimuths, ascending.
    #[serde(serialize_with = "columns::serialize")]
    pub azimuth_rad: Vec<f64>,
    /// Elevations, ascending; one zero where the array sees azimuth only.
    #[serde(serialize_with = "columns::serialize")]
    pub elevation_rad: Vec<f64>,
    /// Values, elevation-major: all azimuths of the first elevation, then those of the next.
    #[serde(rename = "values_db", serialize_with = "decibels::serialize_column")]
    pub values: Vec<f64>,
    /// What they mean.
    pub kind: SpectrumKind,
}

/// Something a reader of the result should know; not an error.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Warning {
    /// Fewer sources were found than asked for.
    Unresolved {
        /// Number asked for or counted.
        expected: usize,
        /// Number found.
        found: usize,
    },
    /// The iteration ended at its limit.
    NotConverged {
        /// Iterations done.
        iterations: usize,
    },
    /// The covariance has too low a rank for the method and was loaded.
    Loaded {
        /// Loading added to the diagonal, as a share of the mean element power.
        share: f64,
    },
    /// Counting found no source.
    NoSources,
    /// Sources that noise explains.
    Insignificant {
        /// How many: those of a known or counted number that do not stand out, or all that were listed.
        explained: usize,
        /// Number found.
        found: usize,
    },
    /// Directions beyond the unambiguous sector of the array cannot be told from ones within.
    Ambiguous {
        /// Half width of the unambiguous sector, rad.
        unambiguous_rad: f64,
    },
    /// Elevations beyond that the rows of the array tell apart cannot be told from ones within.
    AmbiguousElevation {
        /// Half width of the unambiguous sector, rad.
        unambiguous_rad: f64,
    },
    /// The elements are nearer each other than any that tell angles apart.
    TinyArray {
        /// Largest distance from the first element, half wavelengths.
        extent: f64,
    },
    /// The array was cut down to the part the method can use.
    ElementsUnused {
        /// Elements left out.
        unused: usize,
    },
    /// The network was trained on something else.
    OutsideTraining {
        /// What it was trained on, and what it is used on.
        difference: String,
    },
}

impl Coded for Warning {
    fn code(&self) -> &'static str {
        match self {
            Self::Unresolved { .. } => "unresolved",
            Self::NotConverged { .. } => "not-converged",
            Self::Loaded { .. } => "loaded",
            Self::NoSources => "no-sources",
            Self::Insignificant { .. } => "insignificant",
            Self::Ambiguous { .. } => "ambiguous",
            Self::AmbiguousElevation { .. } => "ambiguous-elevation",
            Self::TinyArray { .. } => "tiny-array",
            Self::ElementsUnused { .. } => "elements-unused",
            Self::OutsideTraining { .. } => "outside-training",
        }
    }
}

impl std::fmt::Display for Warning {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Unresolved { expected, found } => {
                write!(f, "{found} of {expected} sources were resolved")
            }
            Self::NotConverged { iterations } => {
                write!(f, "not converged after {iterations} iterations")
            }
            Self::Loaded { share } => {
                write!(f, "the covariance is singular; its diagonal was loaded by {share:.1e}")
            }
            Self::NoSources => write!(f, "no source stands out of the noise"),
            Self::Insignificant { explained, found } => {
                write!(f, "{explained} of {found} sources do not stand out of the noise")
            }
            Self::Ambiguous { unambiguous_rad } => write!(
                f,
                "the array is unambiguous only within {:.1} deg of boresight",
                unambiguous_rad.to_degrees()
            ),
            Self::AmbiguousElevation { unambiguous_rad } => write!(
                f,
                "the rows of the array tell elevations apart only within {:.1} deg of the horizon",
                unambiguous_rad.to_degrees()
            ),
            Self::TinyArray { extent } => write!(
                f,
                "the array extends over {extent:.3} half wavelengths; positions are in half wavelengths, not in metres"
            ),
            Self::ElementsUnused { unused } => write!(f, "{unused} elements were not used"),
            Self::OutsideTraining { difference } => f.write_str(difference),
        }
    }
}

/// Result of an estimator.
#[derive(Debug, Clone, PartialEq, Described, Serialize)]
pub struct Estimate {
    /// The method that made it.
    pub method: Method,
    /// Sources, strongest first.
    pub sources: Vec<Source>,
    /// The spectrum, from methods that have one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub spectrum: Option<Spectrum>,
    /// Whether all sources asked for or counted were found and each stands out of the noise: what it explains beside the
    /// others is more than the strongest peak of noise would, with the false-alarm probability of `nomp`. Methods that
    /// list what they find are resolved where one source stands out. False where the data cannot tell.
    pub resolved: bool,
    /// Number of sources asked for or counted, of methods that have one.
    #[serde(skip)]
    pub expected: Option<usize>,
    /// Iterations done, 0 for closed forms.
    pub iterations: usize,
    /// What a reader should know.
    #[option(described_as = Vec<Remark>)]
    #[serde(serialize_with = "remark::serialize")]
    pub warnings: Vec<Warning>,
}

impl Estimate {
    /// Nothing found.
    pub fn new(method: Method) -> Self {
        Self {
            method,
            sources: Vec::new(),
            spectrum: None,
            resolved: false,
            expected: None,
            iterations: 0,
            warnings: Vec::new(),
        }
    }
}
