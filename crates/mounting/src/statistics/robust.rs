//! Numbers that a few wrong values do not move.

/// Median absolute deviation of a normal distribution over its standard deviation.
const NORMAL: f64 = 0.674_489_750_196_081_7;

/// The value below which a share `q` of the values lies, linear between ranks; NaN of none. Sorts
/// the values.
pub(crate) fn quantile(values: &mut [f64], q: f64) -> f64 {
    boresight_math::order::sort_numbers(values);
    let Some(last) = values.len().checked_sub(1) else { return f64::NAN };
    let place = last as f64 * q.clamp(0.0, 1.0);
    let low = place as usize;
    let high = (low + 1).min(last);
    values[low] + (values[high] - values[low]) * (place - low as f64)
}

/// The median; NaN of none.
pub(crate) fn median(values: &[f64]) -> f64 {
    quantile(&mut values.to_vec(), 0.5)
}

/// Standard deviation by the median absolute deviation, about `centre`; NaN of none.
pub(crate) fn deviation(values: &[f64], centre: f64) -> f64 {
    let distances: Vec<f64> = values.iter().map(|value| (value - centre).abs()).collect();
    median(&distances) / NORMAL
}
