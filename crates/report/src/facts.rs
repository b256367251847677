//! The facts of an estimate in words.

use boresight_mounting::{Alignment, AngleEstimate, CHANCE, CalibrationOptions};

/// One fact.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fact {
    /// What it is of, in small letters.
    pub name: &'static str,
    /// The value with its unit.
    pub value: String,
}

/// All that was estimated and counted, in the order to be read.
pub fn facts(e: &AngleEstimate) -> Vec<Fact> {
    let degrees = f64::to_degrees;
    let angle = within(degrees(e.angle_rad), degrees(e.sigma_rad), 3, " deg");
    let bias = within(degrees(e.bias_radps), degrees(e.bias_sigma_radps), 3, " deg/s");
    let f = e.frames;
    let mut all =
        vec![("angle", angle), ("scale", within(e.scale, e.scale_sigma, 4, "")), ("bias", bias)];
    // What a method does not estimate has a deviation of 0.
    let mut car = |name, value: f64, sigma: f64, digits: usize, unit: &str| {
        if sigma > 0.0 {
            all.push((name, within(value, sigma, digits, unit)));
        }
    };
    let [slip, slip_sigma] = [e.slip_gradient_rad, e.slip_gradient_sigma_rad].map(degrees);
    car("slip", slip, slip_sigma, 3, " deg/(m/s^2)");
    car("delay", 1e3 * e.delay_s, 1e3 * e.delay_sigma_s, 0, " ms");
    car("speed scale", e.speed_scale, e.speed_scale_sigma, 4, "");
    if let Some(time_s) = e.changed_s {
        all.push(("changed", format!("at {time_s:.1} s")));
    }
    all.push(("inliers", format!("{:.1} %", 100.0 * e.inlier_share)));
    all.push((
        "frames",
        format!(
            "{} of {} used; {} standing, {} slow, {} turning, {} sparse, {} off the measured speed, {} without motion",
            f.used, f.given, f.standing, f.slow, f.turning, f.sparse, f.off_speed, f.without_motion,
        ),
    ));
    for (name, count, what) in [
        ("rejected frames", e.rejected_frames, "their times ran backwards"),
        ("rejected detections", e.rejected_detections, "invalid azimuths or range rates"),
        ("clock resets", e.clock_resets, "a new session each"),
    ] {
        if count > 0 {
            all.push((name, format!("{count}; {what}")));
        }
    }
    all.push(("converged", if e.converged { "yes" } else { "no" }.into()));
    all.into_iter().map(|(name, value)| Fact { name, value }).collect()
}

/// A value with its standard deviation to so many digits and a unit; a deviation that is not finite says that nothing tells the value.
pub fn within(value: f64, sigma: f64, digits: usize, unit: &str) -> String {
    match (value.is_finite(), sigma.is_finite()) {
        (true, true) => format!("{value:.digits$} +- {sigma:.digits$}{unit}"),
        (true, false) => format!("{value:.digits$}{unit}, not determined"),
        (false, _) => "not determined".into(),
    }
}

/// Where the radar is, where it should be, and whether that is so, as a sentence; `None` without a nominal angle.
pub fn sentence(e: &AngleEstimate, options: &CalibrationOptions) -> Option<String> {
    let place = Place {
        off_rad: e.drift_rad(options)?,
        sigma_rad: e.sigma_rad,
        nominal_rad: options.nominal_rad?,
        alarm_rad: options.alarm_rad,
        alignment: e.alignment?,
    };
    Some(place.sentence("the drive does"))
}

/// An angle and where it should be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// The angle less the nominal one, within half a turn.
    pub off_rad: f64,
    /// Its standard deviation; infinite where nothing tells it.
    pub sigma_rad: f64,
    /// The nominal angle.
    pub nominal_rad: f64,
    /// By how much it may differ.
    pub alarm_rad: f64,
    /// Whether it is so.
    pub alignment: Alignment,
}

impl Place {
    /// As a sentence, in which `teller` is what says so with its verb: "the drive does".
    pub fn sentence(&self, teller: &str) -> String {
        let nominal = self.nominal_rad.to_degrees();
        let off = self.off_rad.to_degrees();
        let allowed = self.alarm_rad.to_degrees();
        let chance = CHANCE * self.sigma_rad.to_degrees();
        let verdict = match self.alignment {
            Alignment::Aligned => "so the radar is aligned".into(),
            Alignment::Misaligned => "so the radar is misaligned".into(),
            Alignment::Undecided => format!("so {teller} not decide"),
        };
        if !(chance.is_finite() && off.is_finite()) {
            let mut letters = teller.chars();
            let first = letters.next().map(|first| first.to_ascii_uppercase());
            let teller: String = first.into_iter().chain(letters).collect();
            return format!(
                "{teller} not tell the angle, {verdict}. Nominal are {nominal:+.2} deg."
            );
        }
        format!(
            "The angle is {off:+.3} deg off its nominal {nominal:+.2} deg; {allowed:.2} deg are allowed, and chance is \
             granted {chance:.3} deg ({CHANCE:.0} standard deviations), {verdict}."
        )
    }
}
