//! What driving on would bring: the angle's standard deviation after a minute more of each of some manoeuvres, from the covariance that
//! their equations predict.

use super::block::{Block, Row, Scatter};
use super::equation::Equation;
use super::information::Information;
use super::tracked::Prediction;
use super::{ANGLE_PRIOR_RAD, Recursive};
use crate::angle::wrap;
use crate::estimate::{Alignment, CHANCE};
use crate::frame::Polar;
use boresight_options::Described;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// Time of a manoeuvre, s, and how often one is repeated at most.
const MINUTE_S: f64 = 60.0;
const MOST_MINUTES: u32 = 20;
/// Time between frames, s, and variance of a frame's direction, rad^2 (0.3 deg), before a block says so.
const STEP_S: f64 = 0.075;
const VARIANCE: f64 = 2.7e-5;
/// Readings of the yaw rate scatter by this, rad/s; ten seconds of them tell its bias.
/// The variance that a block has shown has both in it.
const SCATTER: Scatter = Scatter { excess: 0.0, correlated: 1.0 };
const READING_RADPS: f64 = 0.005;
const STANDSTILL_S: f64 = 10.0;

/// A way to drive for a minute.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Described, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Manoeuvre {
    /// Straight on at 14 m/s.
    Straight,
    /// Straight on between 5 and 20 m/s.
    Speeds,
    /// Ten seconds of standstill, then straight on at 14 m/s.
    Stop,
    /// Two turns to the left and two to the right, by 90 deg at 7 m/s.
    Turns,
    /// Bends of alternating side at 14 m/s, by 6 deg/s.
    Bends,
}

impl Manoeuvre {
    const ALL: [Self; 5] = [Self::Straight, Self::Speeds, Self::Stop, Self::Turns, Self::Bends];

    /// What a driver is asked to do.
    pub fn instruction(self) -> &'static str {
        match self {
            Self::Straight => "drive straight on at about 50 km/h",
            Self::Speeds => "drive straight on, slowing down to 20 km/h and speeding up to 70 km/h",
            Self::Stop => "stand still for ten seconds, then drive straight on at about 50 km/h",
            Self::Turns => {
                "turn twice to the left and twice to the right at crossings, at about 25 km/h"
            }
            Self::Bends => "follow a road with bends to both sides at about 50 km/h",
        }
    }

    /// Speed, m/s, yaw rate, rad/s, and its change, rad/s^2, at a time; 0 of all where the car stands.
    fn state(self, time_s: f64) -> [f64; 3] {
        let wave = |period_s: f64| (TAU * time_s / period_s).sin();
        match self {
            Self::Straight => [14.0, 0.0, 0.0],
            Self::Speeds => [12.5 + 7.5 * wave(30.0), 0.0, 0.0],
            Self::Stop if time_s < STANDSTILL_S => [0.0; 3],
            Self::Stop => [14.0, 0.0, 0.0],
            Self::Turns => {
                // Seven and a half seconds of turning in every fifteen; it begins and ends smoothly.
                let (place, side) = (time_s % 15.0, [1.0, -1.0][(time_s / 15.0) as usize % 2]);
                let angle = TAU * place / 7.5;
                let peak = side * TAU / 4.0 / 3.75;
                if place < 7.5 {
                    [7.0, 0.5 * peak * (1.0 - angle.cos()), 0.5 * peak * TAU / 7.5 * angle.sin()]
                } else {
                    [7.0, 0.0, 0.0]
                }
            }
            Self::Bends => {
                let rate = TAU / 12.0;
                [14.0, 0.105 * wave(12.0), 0.105 * rate * (rate * time_s).cos()]
            }
        }
    }
}

/// What a minute of a manoeuvre would bring.
#[derive(Debug, Clone, Copy, PartialEq, Described, Serialize)]
pub struct Forecast {
    /// How to drive.
    pub manoeuvre: Manoeuvre,
    /// The same in words.
    pub instruction: &'static str,
    /// Standard deviation of the angle after a minute.
    pub sigma_rad: f64,
    /// Minutes of it until the angle is settled and, where there is a nominal one, the verdict stands; none where twenty are too few.
    pub minutes: Option<f64>,
}

/// What driving on would bring. The angle is taken to stay as it is.
#[derive(Debug, Clone, PartialEq, Described, Serialize)]
#[option(name = "CalibrationOutlook")]
pub struct Outlook {
    /// Standard deviation of the angle now.
    pub sigma_rad: f64,
    /// Standard deviation with which it is settled and the verdict stands.
    pub needed_rad: f64,
    /// Standard deviation below which no drive brings it, at the share of static detections so far.
    pub least_rad: f64,
    /// Manoeuvres, the one first that brings most.
    pub forecasts: Vec<Forecast>,
    /// What to do, in a sentence.
    pub advice: String,
}

impl Recursive {
    /// What driving on would bring.
    pub fn outlook(&self) -> Outlook {
        let estimate = self.estimate();
        let options = &self.options;
        let known = self.information();
        let variance_beyond = (estimate.covariance[0][0] - known.covariance()[0][0]).max(0.0);
        let needed = options.nominal_rad.map_or(options.converged_rad, |nominal| {
            let margin = (wrap(estimate.angle_rad - nominal).abs() - options.alarm_rad).abs();
            options.converged_rad.min(margin / CHANCE)
        });
        let mut forecasts: Vec<Forecast> = Manoeuvre::ALL
            .iter()
            .map(|&manoeuvre| self.forecast(&known, manoeuvre, variance_beyond, needed))
            .collect();
        let never = f64::from(MOST_MINUTES) + 1.0;
        boresight_math::order::sort_by(&mut forecasts, |a, b| {
            let key = |f: &Forecast| (f.minutes.unwrap_or(never), f.sigma_rad);
            let ((a, a_sigma), (b, b_sigma)) = (key(a), key(b));
            a.total_cmp(&b).then(a_sigma.total_cmp(&b_sigma))
        });
        let mut outlook = Outlook {
            sigma_rad: estimate.sigma_rad,
            needed_rad: needed,
            least_rad: variance_beyond.sqrt(),
            forecasts,
            advice: String::new(),
        };
        outlook.advice = outlook.advise(estimate.converged, estimate.alignment);
        outlook
    }

    fn forecast(
        &self,
        known: &Information,
        manoeuvre: Manoeuvre,
        variance_beyond: f64,
        needed_rad: f64,
    ) -> Forecast {
        let mut known = *known;
        let sigma = |known: &Information| (known.covariance()[0][0] + variance_beyond).sqrt();
        let mut after_one = None;
        let mut minutes = None;
        for minute in 1..=MOST_MINUTES {
            self.drive_on(&mut known, manoeuvre);
            after_one.get_or_insert(sigma(&known));
            if sigma(&known) <= needed_rad {
                minutes = Some(f64::from(minute));
                break;
            }
        }
        Forecast {
            manoeuvre,
            instruction: manoeuvre.instruction(),
            sigma_rad: after_one.unwrap_or(ANGLE_PRIOR_RAD),
            minutes,
        }
    }

    /// Adds what a minute of a manoeuvre is expected to tell.
    fn drive_on(&self, known: &mut Information, manoeuvre: Manoeuvre) {
        let last = self.state.recent.last().filter(|block| block.frames() > 0);
        let variance = last.map_or(VARIANCE, |b| b.own_variance() * b.frames() as f64);
        if manoeuvre == Manoeuvre::Stop {
            let readings = STANDSTILL_S / STEP_S;
            let (mean, inverse_variance) = known.prior();
            let inverse = inverse_variance[2] + readings / READING_RADPS.powi(2);
            known.set_bias(mean[2], inverse.sqrt().recip());
        }
        let mut rows = Block::default();
        let end = |rows: &mut Block, known: &mut Information| {
            let sum = rows.sum(&super::gather::offset(known), SCATTER);
            if sum.frames() > 0 {
                known.expect(&sum);
            }
            rows.clear();
        };
        for frame in 0..(MINUTE_S / STEP_S) as usize {
            let time_s = frame as f64 * STEP_S;
            let state = manoeuvre.state(time_s);
            let Some(row) = self.expected(known, state, variance) else { continue };
            if rows.ends_before(time_s, state[0]).is_some() {
                end(&mut rows, known);
            }
            rows.add(row);
        }
        end(&mut rows, known);
    }

    /// The equation of a frame at a speed, m/s, a yaw rate, rad/s, and its change; `None` where the car is too slow for one.
    fn expected(
        &self,
        known: &Information,
        [speed_mps, yaw_rate_radps, change]: [f64; 3],
        variance: f64,
    ) -> Option<Row> {
        let x = known.mean();
        if speed_mps < self.options.min_speed_mps {
            return None;
        }
        let reading = (yaw_rate_radps + x[2]) / x[1];
        let prediction = Prediction {
            angle_rad: x[0],
            angle_variance: known.covariance()[0][0],
            reading_radps: reading,
            change,
            yaw_rate_radps,
            slip: x[3],
            x_m: self.options.x_m,
            y_m: self.options.y_m,
            speed: None,
            measured_speed: None,
        };
        let along = speed_mps - yaw_rate_radps * self.options.y_m;
        let lateral = prediction.lateral(speed_mps);
        let motion = Polar {
            speed_mps: along.hypot(lateral),
            direction_rad: lateral.atan2(along) - x[0],
            direction_variance: variance,
            speed_variance: 0.0,
        };
        let equation = Equation::new(&motion, speed_mps, &prediction, &x, known.reference())?;
        // What the yaw rate's noise adds is in the variance that blocks have shown.
        Some(Row { variance, ..equation.row })
    }
}

impl Outlook {
    fn advise(&self, converged: bool, alignment: Option<Alignment>) -> String {
        let undecided = alignment == Some(Alignment::Undecided);
        if converged && !undecided {
            return "The drive is enough: the angle is settled.".into();
        }
        if self.least_rad > self.needed_rad {
            let (least, needed) = (self.least_rad.to_degrees(), self.needed_rad.to_degrees());
            return format!(
                "No drive decides: {needed:.3} deg are needed, and what no drive tells leaves a standard deviation of {least:.3} deg."
            );
        }
        let Some(best) = self.forecasts.first() else { return String::new() };
        let after = best.sigma_rad.to_degrees();
        match best.minutes {
            Some(minutes) => {
                let plural = if minutes > 1.0 { "s" } else { "" };
                format!("For {minutes:.0} minute{plural}: {}.", best.instruction)
            }
            None => format!(
                "For 20 minutes and more: {}. A minute of it brings the standard deviation to {after:.3} deg.",
                best.instruction
            ),
        }
    }
}
