//! The page.

use crate::facts::{Fact, sentence};
use crate::html::{document, origin, table};
use crate::recorder::Recorder;
use crate::{facts, figures};
use boresight_mounting::{Alignment, AngleEstimate, CalibrationOptions, Forecast, Outlook};
use maud::{Markup, html};

/// Where a report comes from.
#[derive(Debug, Clone, Default)]
pub struct About {
    /// When it was made, in words.
    pub made: String,
    /// Version of Boresight.
    pub version: String,
    /// How it was asked for: a command line or options.
    pub asked: String,
    /// The files that the drive was read from.
    pub sources: Vec<Source>,
}

/// A file.
#[derive(Debug, Clone, Default)]
pub struct Source {
    /// Its name.
    pub name: String,
    /// Its size, bytes.
    pub bytes: u64,
    /// Digest of its bytes by SHA-256, in hexadecimal digits.
    pub sha256: String,
}

/// A radar that was calibrated.
#[derive(Debug)]
pub struct Radar<'a> {
    /// Its number.
    pub sensor: u8,
    /// Whether it was with the other radars of the car.
    pub joint: bool,
    /// What was asked for.
    pub options: &'a CalibrationOptions,
    /// What came out.
    pub estimate: &'a AngleEstimate,
    /// What driving on would bring, where the method says.
    pub outlook: Option<&'a Outlook>,
    /// The drive.
    pub recorder: &'a Recorder,
}

/// The report of all radars of a drive, as HTML that needs nothing else.
pub fn page(about: &About, radars: &[Radar]) -> String {
    let numbers: Vec<String> = radars.iter().map(|radar| radar.sensor.to_string()).collect();
    let title = format!(
        "Mounting angle of radar{} {}",
        if radars.len() == 1 { "" } else { "s" },
        numbers.join(", ")
    );
    let body = html! {
        @for radar in radars { (section(radar)) }
        (origin(about, usize::MAX))
    };
    let lead =
        "Angles are those of boresight in the car's frame, counter-clockwise from straight ahead.";
    document(about, &title, lead, &body)
}

/// What is said of an alignment, and the style that it is said in.
pub fn verdict(alignment: Option<Alignment>) -> (&'static str, &'static str) {
    match alignment {
        Some(Alignment::Aligned) => ("Pass: aligned", "aligned"),
        Some(Alignment::Misaligned) => ("Fail: misaligned", "misaligned"),
        Some(Alignment::Undecided) => ("Undecided", "undecided"),
        None => ("No nominal angle", "undecided"),
    }
}

fn section(radar: &Radar) -> Markup {
    let Radar { sensor, joint, options, estimate, outlook, recorder } = radar;
    let (word, class) = verdict(estimate.alignment);
    let capital = |Fact { name, value }: Fact| {
        let mut letters = name.chars();
        let first = letters.next().map(|first| first.to_ascii_uppercase());
        (first.into_iter().chain(letters).collect(), value)
    };
    html! {
        section {
            h2 { "Radar " (sensor) " " span class={ "verdict " (class) } { (word) } }
            @if let Some(sentence) = sentence(estimate, options) {
                p { (sentence) }
            }
            @for remark in &estimate.remarks {
                p.undecided { "Note: " (remark.to_string()) "." }
            }
            figure {
                (figures::angle(recorder, estimate, options, &format!("angle-{sensor}")))
                figcaption {
                    "Angle (blue) with its standard deviation; nominal angle (solid, all along) and what is allowed (red, \
                     dashed). Estimated by " (options.method.title())
                    @if *joint { ", with all radars of the car" }
                    ", " (options.motion_method().title()) " (" (options.method.reference()) ")."
                }
            }
        }
        section {
            h3 { "What came out" }
            (table(facts(estimate).into_iter().map(capital)))
        }
        section {
            h3 { "The drive" }
            (table(recorder.conditions().into_iter().map(|(name, value)| (name.into(), value))))
            figure { (figures::drive(recorder, &format!("drive-{sensor}"))) }
        }
        @if let Some(outlook) = outlook {
            section {
                h3 { "What driving on would bring" }
                p { (outlook.advice) }
                (table(outlook.forecasts.iter().map(forecast)))
            }
        }
    }
}

fn forecast(forecast: &Forecast) -> (String, String) {
    let minutes = match forecast.minutes {
        Some(minutes) => format!("; enough after {minutes:.0} min"),
        None => "; not enough within 20 min".into(),
    };
    let sigma = forecast.sigma_rad.to_degrees();
    (forecast.instruction.into(), format!("+- {sigma:.3} deg after a minute{minutes}"))
}
