//! The angle of one radar over the drives of a vehicle: knocks, drift, and the angle now.
//!
//! `theta_i = level of the drives between two knocks + rate t_i + error_i`. The errors have the drives' stated independent deviations times a
//! common scatter, which is estimated; a share of the drives is off by far more (a mixture of two normal distributions). What all drives share
//! (`floor_rad`) is in the stated deviations, but scatters nothing.
//!
//! Knocks are found by the generalised likelihood ratio over all places, forward, with places refined and doubtful ones dropped again. This
//! is done once with a drift in the model and once without; the likelihoods of all models found, less what each knock and the drift have by
//! chance, decide. Thresholds are for the highest of all places (the lower of the bound of Bonferroni and of the approximation of Vostrikova
//! 1981, Yao and Davis 1986), at the degrees of freedom that the scatter is estimated with.
//!
//! The angle now is the mean over models: with a drift or without, with one more knock, one less, or one at another place, each by how likely
//! it is. Deviations told are half the width of the interval that holds 68.3 % of what is so known, over the scatter too (beforehand within about
//! a factor of three). With few drives twice that width holds less than 95 %, as with Student's distribution.

mod mixture;
mod posterior;
mod scan;
mod select;
mod sums;
mod weights;

use crate::fleet::{Drift, Knock};
use boresight_mounting::wrap;
use mixture::{Term, half_width, mean};
use posterior::Posterior;
use select::{Model, select};
use std::f64::consts::{PI, TAU};
use sums::{Datum, Prefix};

/// Most knocks that are looked for.
const MOST_KNOCKS: usize = 20;
/// How often weights and places are found in turn.
const ROUNDS: usize = 4;
/// Independent deviations are taken to be at least this share of a drive's own deviation, and of the median drive's.
const LEAST_SHARE: f64 = 0.05;
/// Nor less than this, rad.
const LEAST_SIGMA: f64 = 1e-9;
/// Times beyond are none.
const MOST_TIME: f64 = 1e100;

/// The angle of a radar by one drive.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HistoryPoint {
    /// Place in time, in days, drives or any other unit.
    pub time: f64,
    /// The angle; it may be more by full turns.
    pub angle_rad: f64,
    /// Its standard deviation. Where it is not above zero and below a full turn, the drive tells nothing.
    pub sigma_rad: f64,
    /// The part of the deviation that all drives of this radar share.
    pub floor_rad: f64,
}

/// How knocks and drifts are told from chance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HistoryOptions {
    /// Share of histories without a knock in which one is told.
    pub knock_false_alarm: f64,
    /// Share of histories without a drift in which one is told.
    pub drift_false_alarm: f64,
    /// Knocks and drifts that change the angle by less, over all drives, are not told. They are in the fit, and so in the angle now.
    pub least_change_rad: f64,
}

impl Default for HistoryOptions {
    fn default() -> Self {
        Self {
            knock_false_alarm: 1e-3,
            drift_false_alarm: 1e-3,
            least_change_rad: 0.05 * PI / 180.0,
        }
    }
}

/// The angle of a radar over the drives.
///
/// A knock is told from three drives before it and three after it on, and of two knocks where there are four drives between them; until then the
/// drives after it count as outlying. A single drive that is off never makes a knock.
#[derive(Debug, Clone, PartialEq)]
pub struct History {
    /// The angle now: that at the last drive, after the last knock, in `(-pi, pi]`; NaN where no drive tells. It differs from the fit where another
    /// model is about as likely.
    pub angle_rad: f64,
    /// Its standard deviation, with what all drives share; infinite where no drive tells.
    pub sigma_rad: f64,
    /// When the angle changed at once, by time.
    pub knocks: Vec<Knock>,
    /// How the angle drifts, where that is beyond chance.
    pub drift: Option<Drift>,
    /// How it drifts, whether beyond chance or not; none where the drives cannot tell.
    pub rate: Option<Drift>,
    /// Factor on the stated independent deviations that the scatter of the drives speaks for; 1 where there are fewer than two.
    pub scatter: f64,
    /// Whether each drive is further from the fit than chance has it.
    pub outlying: Vec<bool>,
    /// The fit at each drive, in `(-pi, pi]`; NaN where no drive tells or the drive has no time.
    pub fitted_rad: Vec<f64>,
}

impl History {
    /// The history of a radar's drives. Drives are taken by their times; of the same time, in their order.
    #[must_use]
    pub fn of(points: &[HistoryPoint], options: &HistoryOptions) -> Self {
        let Some(series) = Series::of(points) else { return Self::silent(points.len()) };
        let options = checked(*options);
        let (data, model) = fit(&series.data, &options);
        let prefix = Prefix::of(&data);
        series.told(&prefix, &model, &options, points)
    }

    fn silent(points: usize) -> Self {
        Self {
            angle_rad: f64::NAN,
            sigma_rad: f64::INFINITY,
            knocks: Vec::new(),
            drift: None,
            rate: None,
            scatter: 1.0,
            outlying: vec![false; points],
            fitted_rad: vec![f64::NAN; points],
        }
    }
}

/// Options with levels that are probabilities.
fn checked(options: HistoryOptions) -> HistoryOptions {
    let level = |p: f64| if p.is_nan() { 1e-3 } else { p.clamp(1e-12, 0.5) };
    HistoryOptions {
        knock_false_alarm: level(options.knock_false_alarm),
        drift_false_alarm: level(options.drift_false_alarm),
        least_change_rad: options.least_change_rad.max(0.0),
    }
}

/// Weights and model, found in turn until the model stays.
fn fit(data: &[Datum], options: &HistoryOptions) -> (Vec<Datum>, Model) {
    let mut data = weights::locally(data);
    let mut model = select(&Prefix::of(&data), options);
    for _ in 0..ROUNDS {
        weights::about(&mut data, &model);
        let next = select(&Prefix::of(&data), options);
        if next == model {
            break;
        }
        model = next;
    }
    (data, model)
}

/// The drives that tell something.
struct Series {
    data: Vec<Datum>,
    /// Which point each is.
    index: Vec<usize>,
    reference_rad: f64,
    middle: f64,
    /// Length in time; 1 where all are at one time.
    span: f64,
}

impl Series {
    fn of(points: &[HistoryPoint]) -> Option<Self> {
        let tells = |p: &HistoryPoint| {
            p.time.abs() <= MOST_TIME
                && p.angle_rad.is_finite()
                && p.sigma_rad > 0.0
                && p.sigma_rad < TAU
        };
        let mut index: Vec<usize> = (0..points.len()).filter(|&i| tells(&points[i])).collect();
        index.sort_by(|&a, &b| points[a].time.total_cmp(&points[b].time));
        let (first, last) = (points[*index.first()?].time, points[*index.last()?].time);
        let middle = 0.5 * first + 0.5 * last;
        let span = last - first;
        let span = if span > 0.0 { span } else { 1.0 };
        let floor = |p: &HistoryPoint| if p.floor_rad > 0.0 { p.floor_rad } else { 0.0 };
        let own = |p: &HistoryPoint| {
            let share = floor(p) / p.sigma_rad;
            p.sigma_rad * (1.0 - share * share).max(LEAST_SHARE * LEAST_SHARE).sqrt()
        };
        let mut sigmas: Vec<f64> = index.iter().map(|&i| own(&points[i])).collect();
        let least = (LEAST_SHARE * weights::median(&mut sigmas)).max(LEAST_SIGMA);
        let reference_rad =
            reference(index.iter().map(|&i| (points[i].angle_rad, own(&points[i]))));
        let data = index.iter().map(|&i| {
            let p = &points[i];
            Datum {
                time: (p.time - middle) / span,
                angle: wrap(p.angle_rad - reference_rad),
                sigma: own(p).max(least),
                floor: floor(p).min(p.sigma_rad),
                inlying: 1.0,
            }
        });
        Some(Self { data: data.collect(), index, reference_rad, middle, span })
    }

    fn told(
        &self,
        prefix: &Prefix,
        model: &Model,
        options: &HistoryOptions,
        points: &[HistoryPoint],
    ) -> History {
        let n = self.data.len();
        let posterior = Posterior::of(prefix, model, self.data[n - 1].time);
        let line = prefix.line(&model.starts, model.rate);
        let mut history = History::silent(points.len());
        let now = mean(&posterior.now);
        let last = model.starts.last().copied().unwrap_or(0);
        history.angle_rad = wrap(now + self.reference_rad);
        history.sigma_rad = half_width(&posterior.now, now).hypot(prefix.floor(last..n));
        history.scatter = posterior.scatter;
        let rate = |rate: f64, terms: &[Term]| Drift {
            rate_rad: rate / self.span,
            sigma_rad: half_width(terms, rate) / self.span,
        };
        let with_rate = prefix.line(&model.starts, true);
        history.rate = with_rate.rate.map(|value| rate(value, &posterior.rate));
        if model.rate && line.rate.is_some_and(|r| r.abs() >= options.least_change_rad) {
            history.drift = history.rate;
        }
        for (j, &start) in model.starts.iter().enumerate() {
            let step_rad = line.levels[j + 1] - line.levels[j];
            if step_rad.abs() < options.least_change_rad {
                continue;
            }
            let (before, drive) = (self.index[start - 1], self.index[start]);
            history.knocks.push(Knock {
                drive,
                after: points[before].time,
                before: points[drive].time,
                step_rad,
                sigma_rad: half_width(&posterior.steps[j], step_rad),
            });
        }
        for (k, &i) in self.index.iter().enumerate() {
            history.outlying[i] = prefix.inlying(k) < 0.5;
        }
        for (i, point) in points.iter().enumerate() {
            // Drives that tell nothing are after a knock where they are after its first drive.
            let k = self.index.partition_point(|&j| {
                points[j].time < point.time || (points[j].time == point.time && j <= i)
            });
            let time = (point.time - self.middle) / self.span;
            history.fitted_rad[i] = wrap(line.at(k.max(1) - 1, time) + self.reference_rad);
        }
        history
    }
}

/// Direction of the weighted mean of unit vectors.
fn reference(angles: impl Iterator<Item = (f64, f64)>) -> f64 {
    let (mut x, mut y) = (0.0, 0.0);
    for (angle, sigma) in angles {
        let weight = 1.0 / sigma;
        x += weight * libm::cos(angle);
        y += weight * libm::sin(angle);
    }
    libm::atan2(y, x)
}
