//! Which drives are off by far more than they state.

use super::select::{Model, PRIOR_FREEDOM};
use super::sums::{Datum, Prefix};

/// Share of drives that are off, beforehand.
const SHARE: f64 = 0.03;
/// Their deviations, over those of the others.
const WIDTH: f64 = 10.0;
/// Least probability of not being off: where all drives are, they still make an angle.
const LEAST: f64 = 1e-9;
/// Drives on either side that a drive is first compared with: three that are off by chance are never most of them.
const NEIGHBOURS: usize = 3;
/// Drives that those at the ends are compared with: three after a knock are most of them.
const AT_ENDS: usize = 5;
/// Variance of a median over that of a mean.
const MEDIAN_VARIANCE: f64 = std::f64::consts::FRAC_PI_2;
/// Median of the size of a normal distribution's values, over its deviation.
const NORMAL_MEDIAN: f64 = 0.674_489_750_196_081_7;
/// Information of a median on a deviation, over that of squares.
const MEDIAN_INFORMATION: f64 = 0.37;
/// Turns of weights and fit.
const TURNS: usize = 12;

/// Probability that a drive so many deviations from the fit is not off.
fn inlying(deviations: f64) -> f64 {
    let square = deviations * deviations;
    let off = SHARE / WIDTH * (-0.5 * square / (WIDTH * WIDTH)).exp();
    let not = (1.0 - SHARE) * (-0.5 * square).exp();
    if off > 0.0 { (not / (not + off)).max(LEAST) } else { LEAST }
}

/// The median, the lower of two; 0 of none. Changes the order.
pub(super) fn median(values: &mut [f64]) -> f64 {
    if values.is_empty() {
        return 0.0;
    }
    let middle = (values.len() - 1) / 2;
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}

/// Scatter by the differences of successive drives, which neither knocks nor a drift have a part in.
fn first_scatter(data: &[Datum]) -> f64 {
    let difference =
        |pair: &[Datum]| (pair[1].angle - pair[0].angle).abs() / pair[0].sigma.hypot(pair[1].sigma);
    let mut differences: Vec<f64> = data.windows(2).map(difference).collect();
    let freedom = MEDIAN_INFORMATION * differences.len() as f64;
    let scatter = median(&mut differences) / NORMAL_MEDIAN;
    ((PRIOR_FREEDOM + freedom * scatter * scatter) / (PRIOR_FREEDOM + freedom)).sqrt()
}

/// Weights by what each drive is off the median of itself and its neighbours, which keeps steps, or off their line, whichever is less.
pub(super) fn locally(data: &[Datum]) -> Vec<Datum> {
    let scatter = first_scatter(data);
    let n = data.len();
    let weigh = |(i, datum): (usize, &Datum)| {
        let window = if i < NEIGHBOURS {
            &data[..AT_ENDS.min(n)]
        } else if i + NEIGHBOURS >= n {
            &data[n.saturating_sub(AT_ENDS)..]
        } else {
            &data[i - NEIGHBOURS..=i + NEIGHBOURS]
        };
        let (centre, information) = centre_of(window);
        let sigma = scatter * datum.sigma.hypot((MEDIAN_VARIANCE / information).sqrt());
        let off = datum.angle - centre;
        let off_line = datum.angle - repeated_median(window, datum.time);
        Datum { inlying: inlying(off.abs().min(off_line.abs()) / sigma), ..*datum }
    };
    data.iter().enumerate().map(weigh).collect()
}

/// Value at a time of the line by repeated medians (Siegel 1982).
fn repeated_median(window: &[Datum], time: f64) -> f64 {
    let slope_at = |a: &Datum| {
        let others = window.iter().filter(|b| b.time != a.time);
        median(&mut others.map(|b| (b.angle - a.angle) / (b.time - a.time)).collect::<Vec<_>>())
    };
    let slope = median(&mut window.iter().map(slope_at).collect::<Vec<_>>());
    median(&mut window.iter().map(|d| d.angle + slope * (time - d.time)).collect::<Vec<_>>())
}

/// The median, to which each drive has one voice, so that a few precise ones that are off do not lead it, and the inverse variance of a mean as
/// sure as all of them are.
fn centre_of(window: &[Datum]) -> (f64, f64) {
    let mut angles: Vec<f64> = window.iter().map(|d| d.angle).collect();
    let density: f64 = window.iter().map(|d| 1.0 / d.sigma).sum();
    (median(&mut angles), density * density / window.len() as f64)
}

/// Weights about a model's fit, in turn with it (expectation and maximisation).
pub(super) fn about(data: &mut [Datum], model: &Model) {
    let parameters = 1.0 + model.starts.len() as f64 + f64::from(u8::from(model.rate));
    for _ in 0..TURNS {
        let prefix = Prefix::of(data);
        let line = prefix.line(&model.starts, model.rate);
        let left = prefix.centred(&model.starts).left(model.rate);
        let freedom = (prefix.all().n - parameters).max(0.0);
        let scatter = ((PRIOR_FREEDOM + left) / (PRIOR_FREEDOM + freedom)).sqrt();
        let mut change = 0.0_f64;
        for (k, datum) in data.iter_mut().enumerate() {
            let residual = datum.angle - line.at(k, datum.time);
            let next = inlying(residual / (scatter * datum.sigma));
            change = change.max((next - datum.inlying).abs());
            datum.inlying = next;
        }
        if change < 1e-3 {
            break;
        }
    }
}
