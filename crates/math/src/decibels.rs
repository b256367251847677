//! Conversions between linear and logarithmic scales.

use wide::f64x2;

/// Power ratio to decibels: `10 log10(power)`. Zero gives negative infinity.
pub fn power_to_db(power: f64) -> f64 {
    10.0 * power.log10()
}

/// [`power_to_db`] of many powers, to a few units in the last place.
pub fn powers_to_db(powers: &[f64]) -> Vec<f64> {
    let (pairs, last) = powers.as_chunks();
    let mut db: Vec<f64> = Vec::with_capacity(powers.len());
    for &pair in pairs {
        db.extend((f64x2::new(pair).log10() * 10.0).to_array());
    }
    db.extend(last.iter().copied().map(power_to_db));
    db
}

/// Decibels to a power ratio.
pub fn db_to_power(db: f64) -> f64 {
    libm::pow(10.0, db / 10.0)
}

/// Decibels to an amplitude ratio: `10^(db / 20)`.
pub fn db_to_amplitude(db: f64) -> f64 {
    libm::pow(10.0, db / 20.0)
}

/// Amplitude ratio to decibels: `20 log10(|amplitude|)`.
pub fn amplitude_to_db(amplitude: f64) -> f64 {
    20.0 * amplitude.log10()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn many_powers_are_converted_as_one_is() {
        let powers: Vec<f64> =
            (-307..=307).map(|e| 1.7 * 10.0_f64.powi(e)).chain([f64::MIN_POSITIVE, 1.0]).collect();
        for (db, &power) in powers_to_db(&powers).iter().zip(&powers) {
            let exact = power_to_db(power);
            assert!((db - exact).abs() <= 1e-14 * exact.abs().max(1.0), "{power}: {db} {exact}");
        }
        assert_eq!(powers_to_db(&powers[..3]).len(), 3);
    }
}
