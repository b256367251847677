//! The facts of an estimate in words.

use boresight_calibrate::{Alignment, AngleEstimate, CHANCE, CalibrationOptions};

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
    // An infinite deviation says that the drive does not tell.
    let within = |value: String, sigma: f64, digits: usize| match sigma == f64::INFINITY {
        true => format!("{value}, not determined"),
        false => format!("{value} +- {sigma:.digits$}"),
    };
    let angle = within(format!("{:.3}", degrees(e.angle_rad)), degrees(e.sigma_rad), 3);
    let bias = within(format!("{:.3}", degrees(e.bias_radps)), degrees(e.bias_sigma_radps), 3);
    let f = e.frames;
    let mut all = vec![
        ("angle", format!("{angle} deg")),
        ("scale", within(format!("{:.4}", e.scale), e.scale_sigma, 4)),
        ("bias", format!("{bias} deg/s")),
    ];
    // What a method does not estimate has a deviation of 0.
    let mut car = |name, value: f64, sigma: f64, digits: usize, unit: &str| {
        if sigma > 0.0 {
            all.push((name, format!("{value:.digits$} +- {sigma:.digits$}{unit}")));
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
    all.push(("converged", if e.converged { "yes" } else { "no" }.into()));
    all.into_iter().map(|(name, value)| Fact { name, value }).collect()
}

/// Where the radar is, where it should be, and whether that is so, as a sentence; `None` without a nominal angle.
pub fn sentence(e: &AngleEstimate, options: &CalibrationOptions) -> Option<String> {
    let nominal = options.nominal_rad?.to_degrees();
    let off = e.drift_rad(options)?.to_degrees();
    let allowed = options.alarm_rad.to_degrees();
    let chance = CHANCE * e.sigma_rad.to_degrees();
    let verdict = match e.alignment? {
        Alignment::Aligned => "so the radar is aligned",
        Alignment::Misaligned => "so the radar is misaligned",
        Alignment::Undecided => "so the drive does not decide",
    };
    if !chance.is_finite() {
        return Some(format!(
            "The drive does not tell the angle, {verdict}. Nominal are {nominal:+.2} deg."
        ));
    }
    Some(format!(
        "The angle is {off:+.3} deg off its nominal {nominal:+.2} deg; {allowed:.2} deg are allowed, and chance is \
         granted {chance:.3} deg ({CHANCE:.0} standard deviations), {verdict}."
    ))
}
