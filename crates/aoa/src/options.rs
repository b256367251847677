//! Options of the estimators, in SI units and radians.

use boresight_core::CoreError;
use boresight_core::error::check_range;
use std::f64::consts::FRAC_PI_2;

/// Where the number of sources comes from, for methods that need it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SourceCount {
    /// It is known.
    Known(usize),
    /// Akaike's information criterion on the eigenvalues.
    Aic,
    /// Minimum description length on the eigenvalues.
    Mdl,
}

/// How IAA treats weak parts of the spectrum (Rowe, Li and Stoica 2013).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
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
#[derive(Debug, Clone, Copy, PartialEq, Default)]
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
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum IaaPrecision {
    /// On grids of a power of two single, and double from the first iteration on that needs it to tell
    /// angles to 0.001 deg: with strong sources far above the noise. Else double.
    #[default]
    Auto,
    /// Double throughout.
    Double,
}

/// Options of IAA.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct IaaOptions {
    /// Iterations.
    pub iterations: usize,
    /// Treatment of weak powers.
    pub thresholding: Thresholding,
    /// Threshold below the strongest power, dB (positive).
    pub threshold_db: f64,
    /// Noise power added to the diagonal, as a share of the mean element power; 0 for plain IAA.
    pub regularisation: f64,
    /// Fast or dense.
    pub form: IaaForm,
    /// Precision of the fast form.
    pub precision: IaaPrecision,
}

/// Options of NOMP.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NompOptions {
    /// Probability that noise alone adds a source.
    pub false_alarm: f64,
    /// Noise power at one element; estimated from the residual if absent.
    pub noise_power: Option<f64>,
    /// Grid points per element of aperture.
    pub oversampling: usize,
    /// Newton steps on a new source.
    pub single_refinements: usize,
    /// Rounds of Newton steps over all sources after each new one.
    pub cyclic_refinements: usize,
    /// Most sources.
    pub max_sources: usize,
}

/// Options of ESPRIT.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum EspritForm {
    /// Least squares.
    LeastSquares,
    /// Total least squares.
    #[default]
    TotalLeastSquares,
}

/// Options of all estimators. Those a method has no use for are ignored.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// Number of sources, for methods that need it.
    pub sources: SourceCount,
    /// Half width of the field of view in azimuth, rad.
    pub field_of_view_rad: f64,
    /// Half width of the field of view in elevation, rad (arrays that span an area).
    pub elevation_field_of_view_rad: f64,
    /// Points of the azimuth grid, uniform in sin(azimuth) over [-1, 1).
    pub grid_points: usize,
    /// Points of the elevation grid (arrays that span an area).
    pub elevation_points: usize,
    /// Average the covariance with its reversal (uniform arrays).
    pub forward_backward: bool,
    /// Length of the subarrays of spatial smoothing (uniform arrays); `None` for none.
    pub smoothing: Option<usize>,
    /// Diagonal loading as a share of the mean element power.
    pub loading: f64,
    /// Peaks this far below the strongest are not reported, dB (spectral methods).
    pub dynamic_range_db: f64,
    /// Most sources reported by spectral methods.
    pub max_peaks: usize,
    /// ESPRIT.
    pub esprit: EspritForm,
    /// IAA.
    pub iaa: IaaOptions,
    /// NOMP.
    pub nomp: NompOptions,
    /// Refine the sources on the matched model (see [`crate::refinement`]), with the false-alarm
    /// probability and noise power of `nomp`.
    pub refine: bool,
    /// Least confidence, from 0 to 1, of a network's sources; its model's own if absent.
    pub confidence: Option<f64>,
    /// Most iterations of maximum likelihood and sparse Bayesian learning.
    pub max_iterations: usize,
    /// Change of angle (rad) or relative change of power at which iterations stop.
    pub tolerance: f64,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            sources: SourceCount::Mdl,
            field_of_view_rad: FRAC_PI_2,
            elevation_field_of_view_rad: 30.0_f64.to_radians(),
            grid_points: 1024,
            elevation_points: 61,
            forward_backward: false,
            smoothing: None,
            loading: 0.0,
            dynamic_range_db: 20.0,
            max_peaks: 16,
            esprit: EspritForm::default(),
            iaa: IaaOptions {
                iterations: 15,
                thresholding: Thresholding::None,
                threshold_db: 40.0,
                regularisation: 0.0,
                form: IaaForm::Auto,
                precision: IaaPrecision::Auto,
            },
            nomp: NompOptions {
                false_alarm: 1e-2,
                noise_power: None,
                oversampling: 4,
                single_refinements: 3,
                cyclic_refinements: 3,
                max_sources: 16,
            },
            refine: false,
            confidence: None,
            max_iterations: 200,
            tolerance: 1e-8,
        }
    }
}

impl Options {
    /// Checks every option's range.
    ///
    /// # Errors
    /// [`CoreError::OutOfRange`] naming the option.
    pub fn check(&self) -> Result<(), CoreError> {
        if let SourceCount::Known(count) = self.sources {
            check_range("sources", count as f64, 1.0, 1024.0)?;
        }
        check_range("field_of_view_rad", self.field_of_view_rad, 1e-3, FRAC_PI_2)?;
        let elevation = self.elevation_field_of_view_rad;
        check_range("elevation_field_of_view_rad", elevation, 1e-3, FRAC_PI_2)?;
        // Three points inside the field of view at least, so that there can be a peak.
        let fewest = (4.0 / self.field_of_view_rad.sin()).ceil().max(16.0);
        check_range("grid_points", self.grid_points as f64, fewest, 65_536.0)?;
        check_range("elevation_points", self.elevation_points as f64, 3.0, 1_024.0)?;
        if let Some(length) = self.smoothing {
            check_range("smoothing", length as f64, 2.0, 1024.0)?;
        }
        check_range("loading", self.loading, 0.0, 1e6)?;
        check_range("dynamic_range_db", self.dynamic_range_db, 0.1, 300.0)?;
        check_range("max_peaks", self.max_peaks as f64, 1.0, 1024.0)?;
        check_range("iaa.iterations", self.iaa.iterations as f64, 1.0, 1e4)?;
        check_range("iaa.threshold_db", self.iaa.threshold_db, 0.0, 300.0)?;
        check_range("iaa.regularisation", self.iaa.regularisation, 0.0, 1e6)?;
        check_range("nomp.false_alarm", self.nomp.false_alarm, 1e-12, 0.5)?;
        if let Some(power) = self.nomp.noise_power {
            boresight_core::error::check_positive("nomp.noise_power", power)?;
        }
        check_range("nomp.oversampling", self.nomp.oversampling as f64, 1.0, 64.0)?;
        check_range("nomp.single_refinements", self.nomp.single_refinements as f64, 0.0, 100.0)?;
        check_range("nomp.cyclic_refinements", self.nomp.cyclic_refinements as f64, 0.0, 100.0)?;
        check_range("nomp.max_sources", self.nomp.max_sources as f64, 1.0, 1024.0)?;
        if let Some(confidence) = self.confidence {
            check_range("confidence", confidence, 0.0, 1.0)?;
        }
        check_range("max_iterations", self.max_iterations as f64, 1.0, 1e5)?;
        check_range("tolerance", self.tolerance, 1e-15, 1.0)
    }
}
