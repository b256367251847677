//! Displacements of the elements, by Gauss-Newton steps.

use crate::fit::{Fit, Fitted};
use crate::identifiable::{Information, half_wavelengths, never_determined};
use boresight_core::InputError;
use boresight_math::phasor::cis;

/// Most steps.
const STEPS: usize = 50;

/// Steps below this end the fit, rad.
const SETTLED_RAD: f64 = 1e-10;

/// Displacements whose standard deviation would be above this are as good as not determined, half wavelengths.
const VAGUE: f64 = 0.25;

/// Fits phases and displacements together, from a fit of the phases; `None` where the cells do not determine the
/// displacements.
///
/// # Errors
/// Those of the eigenvalues.
pub(crate) fn with_positions(
    fit: &Fit,
    start: &Fitted,
    weights: &[f64],
) -> Result<Option<Fitted>, InputError> {
    let channels = start.factors.len();
    let axes = &fit.waves.axes;
    let never = never_determined(axes.len(), fit.any_known(), true);
    let mut found = start.clone();
    for _ in 0..STEPS {
        let information = Information::of_phases(fit, &found, weights, true);
        let inverse = information.inverse()?;
        let vague = inverse.variances()[channels..]
            .iter()
            .any(|variance| half_wavelengths(variance.sqrt()) > VAGUE);
        if inverse.undetermined > never || vague {
            return Ok(None);
        }
        let step = inverse.step(&information.gradient);
        for k in 0..channels {
            found.factors[k] *= cis(step[k].clamp(-1.0, 1.0));
            for (block, &axis) in axes.iter().enumerate() {
                let radians = step[(block + 1) * channels + k].clamp(-1.0, 1.0);
                found.moved[k][axis] += half_wavelengths(radians);
            }
        }
        fit.fit_cells(&mut found);
        if step.iter().all(|radians| radians.abs() < SETTLED_RAD) {
            break;
        }
    }
    Ok(Some(found))
}
