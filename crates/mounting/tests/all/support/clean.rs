//! What the drives of the tests are like.

use boresight_mounting::CalibrationOptions;

/// Options that expect what the drives of the tests have: no errors that last, no slip, no delay.
pub fn without_real_errors(options: CalibrationOptions) -> CalibrationOptions {
    CalibrationOptions {
        azimuth_bias_sigma_rad: 0.0,
        traffic_sigma_rad: 0.0,
        lasting_sigma_rad: 1e-6,
        slip_gradient_rad: 0.0,
        slip_gradient_sigma_rad: 1e-7,
        delay_s: 0.0,
        delay_sigma_s: 1e-7,
        ..options
    }
}
