//! Options of the estimators, in SI units and radians.

use boresight_core::InputError;
use boresight_math::error::check_range;
use boresight_options::{At, Described, Kind, Naming, Range, Special, check};
use serde::de::{Error, Unexpected, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::f64::consts::FRAC_PI_2;

/// Where the number of sources comes from, for methods that need it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SourceCount {
    /// It is known.
    Known(usize),
    /// By a test at the false-alarm probability of [`EstimatorOptions::nomp`]: by the largest-root test on the eigenvalues,
    /// or by what each further source explains of a single vector (maximum likelihood).
    Auto,
    /// Akaike's information criterion on the eigenvalues.
    Aic,
    /// Minimum description length on the eigenvalues.
    Mdl,
    /// A trained counting network, given beside the options.
    Network,
}

/// How IAA treats weak parts of the spectrum (after Rowe, Li and Stoica 2013). What is taken off the powers counts as
/// white noise in the next iteration.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Described, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Thresholding {
    /// Plain IAA.
    #[default]
    None,
    /// Powers below the threshold become zero after each iteration.
    Hard,
    /// The threshold is taken off every power after each iteration.
    Soft,
}

/// How IAA is computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Described, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum IaaForm {
    /// Fast where the elements stand on a lattice, else dense.
    #[default]
    Auto,
    /// By FFTs; needs a lattice.
    Fast,
    /// By matrix products; any array.
    Dense,
}

/// Precision of IAA's fast form.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Described, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum IaaPrecision {
    /// On grids of a power of two single, and double from the first iteration on that needs it to tell
    /// angles to 0.001 deg: with strong sources far above the noise. Else double.
    #[default]
    Auto,
    /// Double throughout.
    Double,
}

/// How ESPRIT solves for the rotation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Described, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum EspritForm {
    /// Least squares.
    LeastSquares,
    /// Total least squares.
    #[default]
    TotalLeastSquares,
}

/// Options of IAA.
#[derive(Debug, Clone, Copy, PartialEq, Described, Serialize, Deserialize)]
#[serde(default)]
pub struct IaaOptions {
    /// Iterations.
    #[option(default = 15, range = 1..=10_000)]
    pub iterations: usize,
    /// Treatment of weak powers.
    pub thresholding: Thresholding,
    /// Threshold below the strongest power (positive).
    #[option(default = 40.0, range = 0..=300)]
    pub threshold_db: f64,
    /// Noise power added to the diagonal, as a share of the mean element power; 0 for plain IAA.
    #[option(range = 0..=1e6)]
    pub regularisation: f64,
    /// Fast or dense.
    pub form: IaaForm,
    /// Precision of the fast form.
    pub precision: IaaPrecision,
}

/// Options of NOMP.
#[derive(Debug, Clone, Copy, PartialEq, Described, Serialize, Deserialize)]
#[serde(default)]
pub struct NompOptions {
    /// Probability that noise alone adds a source.
    #[option(default = 1e-2, range = 1e-12..=0.5)]
    pub false_alarm: f64,
    /// Noise power at one element; estimated from the residual if absent.
    #[option(positive)]
    pub noise_power: Option<f64>,
    /// Grid points per element of aperture.
    #[option(default = 4, range = 1..=64)]
    pub oversampling: usize,
    /// Newton steps on a new source.
    #[option(default = 3, range = 0..=100)]
    pub single_refinements: usize,
    /// Rounds of Newton steps over all sources after each new one.
    #[option(default = 3, range = 0..=100)]
    pub cyclic_refinements: usize,
    /// Most sources.
    #[option(default = 16, range = 1..=1024)]
    pub max_sources: usize,
}

/// Options of all estimators. Those a method has no use for are ignored.
#[derive(Debug, Clone, Copy, PartialEq, Described, Serialize, Deserialize)]
#[serde(default)]
pub struct EstimatorOptions {
    /// Number of sources, or how they are counted, for methods that need it.
    #[option(default = SourceCount::Auto, range = 1..=1024)]
    pub sources: SourceCount,
    /// Half width of the field of view in azimuth.
    #[option(default = FRAC_PI_2, range = 0.1..=90)]
    pub field_of_view_rad: f64,
    /// Half width of the field of view in elevation (arrays that span an area).
    #[option(default = 30.0_f64.to_radians(), range = 0.1..=90)]
    pub elevation_field_of_view_rad: f64,
    /// Points of the azimuth grid, uniform in sin(azimuth) over [-1, 1).
    #[option(default = 1024, range = 16..=65_536)]
    pub grid_points: usize,
    /// Points of the elevation grid (arrays that span an area).
    #[option(default = 61, range = 3..=1024)]
    pub elevation_points: usize,
    /// Average the covariance with its reversal, which decorrelates coherent sources (evenly spaced
    /// arrays).
    pub forward_backward: bool,
    /// Length of the subarrays of spatial smoothing (evenly spaced arrays); none if absent.
    #[option(range = 2..=1024)]
    pub smoothing: Option<usize>,
    /// Diagonal loading as a share of the mean element power.
    #[option(range = 0..=1e6)]
    pub loading: f64,
    /// Peaks this far below the strongest are not reported (spectral methods).
    #[option(default = 20.0, range = 0.1..=300)]
    pub dynamic_range_db: f64,
    /// Most sources reported by spectral methods.
    #[option(default = 16, range = 1..=1024)]
    pub max_peaks: usize,
    /// How ESPRIT solves for the rotation.
    pub esprit: EspritForm,
    /// The iterative adaptive approach.
    pub iaa: IaaOptions,
    /// Newtonized orthogonal matching pursuit, and the search for sources in the atomic norm and in refinement.
    pub nomp: NompOptions,
    /// Refine the sources on the matched model: those that noise explains are dropped, what stands
    /// out of the rest is added, and all are taken to the best fit by Gauss-Newton steps, with the
    /// false-alarm probability and noise power of `nomp`.
    pub refine: bool,
    /// Power of the array's unknown error over that of each source, for methods that would take it for further sources:
    /// NOMP, refinement, and counting. Gains and phases off by 1 dB and 10 deg are -13.6. If absent, what the array's
    /// calibration leaves (in the chain), or none.
    #[option(range = -100..=0)]
    pub mismatch_db: Option<f64>,
    /// A network that has been loaded under this name: the one that a method needs, or a counting network for
    /// `sources`.
    #[serde(skip_serializing)]
    pub network: Option<NetworkName>,
    /// Least confidence of a network's sources; that of its card if absent.
    #[option(range = 0..=1)]
    pub confidence: Option<f64>,
    /// Most iterations of maximum likelihood and sparse Bayesian learning.
    #[option(default = 200, range = 1..=100_000)]
    pub max_iterations: usize,
    /// Change of angle (rad) or relative change of power at which iterations stop.
    #[option(default = 1e-8, range = 1e-15..=1)]
    pub tolerance: f64,
}

impl EstimatorOptions {
    /// The power of the array's unknown error over that of each source.
    pub(crate) fn mismatch(&self) -> f64 {
        mismatch_of(self.mismatch_db)
    }

    /// Checks every option's range.
    ///
    /// # Errors
    /// [`InputError::OutOfRange`] naming the option.
    pub fn check(&self) -> Result<(), InputError> {
        check(self, Naming::Rust)?;
        // Three points inside the field of view at least, so that there can be a peak.
        let fewest = (4.0 / self.field_of_view_rad.sin()).ceil().max(16.0);
        check_range("grid_points", self.grid_points as f64, fewest, 65_536.0)
    }
}

/// A level in dB as a share of a power; none if absent.
pub(crate) fn mismatch_of(level_db: Option<f64>) -> f64 {
    level_db.map_or(0.0, |level| 10f64.powf(level / 10.0))
}

/// That a network was named. Whoever holds networks has found it by its name; nothing of it is kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NetworkName;

impl Described for NetworkName {
    const KIND: Kind = Kind::Text;
}

impl<'de> Deserialize<'de> for NetworkName {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        String::deserialize(deserializer).map(|_| Self)
    }
}

impl Serialize for NetworkName {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_unit()
    }
}

/// The ways of counting, by name.
const COUNTED: [(&str, SourceCount); 4] = [
    ("auto", SourceCount::Auto),
    ("aic", SourceCount::Aic),
    ("mdl", SourceCount::Mdl),
    ("network", SourceCount::Network),
];

/// What can be given, in words.
const EXPECTED: &str = "a number, 'auto', 'aic', 'mdl' or 'network'";

impl Described for SourceCount {
    const KIND: Kind = Kind::Special(&Special {
        expected: EXPECTED,
        typescript: "number | 'auto' | 'aic' | 'mdl' | 'network'",
        schema: r#"{ "anyOf": [{ "type": "integer", "minimum": 1, "maximum": 1024 }, { "enum": ["auto", "aic", "mdl", "network"] }] }"#,
        flag: "N|auto|aic|mdl|network",
    });

    fn check(&self, range: Option<Range>, at: &At<'_>) -> Result<(), InputError> {
        match self {
            Self::Known(count) => count.check(range, at),
            Self::Auto | Self::Aic | Self::Mdl | Self::Network => Ok(()),
        }
    }
}

impl Serialize for SourceCount {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Known(count) => serializer.serialize_u64(*count as u64),
            counted => {
                let name =
                    COUNTED.iter().find(|(_, way)| way == counted).map_or("", |(name, _)| name);
                serializer.serialize_str(name)
            }
        }
    }
}

impl<'de> Deserialize<'de> for SourceCount {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(CountVisitor)
    }
}

struct CountVisitor;

impl Visitor<'_> for CountVisitor {
    type Value = SourceCount;

    fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(EXPECTED)
    }

    fn visit_u64<E: Error>(self, count: u64) -> Result<SourceCount, E> {
        let count = usize::try_from(count);
        count.map(SourceCount::Known).map_err(|_| E::custom(EXPECTED))
    }

    fn visit_f64<E: Error>(self, given: f64) -> Result<SourceCount, E> {
        Err(E::invalid_value(Unexpected::Float(given), &"a whole number"))
    }

    fn visit_str<E: Error>(self, given: &str) -> Result<SourceCount, E> {
        let known = COUNTED.iter().find(|(name, _)| *name == given);
        known
            .map(|(_, way)| *way)
            .ok_or_else(|| E::unknown_variant(given, &["auto", "aic", "mdl", "network"]))
    }
}
