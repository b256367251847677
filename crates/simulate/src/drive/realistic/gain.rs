//! How sensitive a radar is: as much as gives the number of detections it is built for.

/// Most and least gain, dB.
const LIMIT_DB: f64 = 25.0;

/// The gain, dB, with which echoes of these mean strengths, dB over the threshold, give `mean_count`
/// detections a scan on average over `scans`. An echo of exponentially fluctuating power is detected
/// with the probability `exp(-1 / strength)`.
pub(crate) fn gain_db(strengths_db: &[f64], scans: usize, mean_count: f64) -> f64 {
    let expected = |gain_db: f64| {
        let sum: f64 = strengths_db
            .iter()
            .map(|strength| libm::exp(-libm::pow(10.0, -0.1 * (strength + gain_db))))
            .sum();
        sum / scans as f64
    };
    let (mut low, mut high) = (-LIMIT_DB, LIMIT_DB);
    for _ in 0..24 {
        let middle = 0.5 * (low + high);
        if expected(middle) < mean_count {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}
