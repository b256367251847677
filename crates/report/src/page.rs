//! The page.

use crate::escape::escaped;
use crate::facts::{Fact, sentence};
use crate::html::{document, origin, table};
use crate::recorder::Recorder;
use crate::{facts, figures};
use boresight_mounting::{Alignment, AngleEstimate, CalibrationOptions, Outlook};
use std::fmt::Write as _;

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
    let mut body = String::new();
    for radar in radars {
        section(&mut body, radar);
    }
    origin(&mut body, about, usize::MAX);
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

fn section(html: &mut String, radar: &Radar) {
    let Radar { sensor, joint, options, estimate, outlook, recorder } = radar;
    let (word, class) = verdict(estimate.alignment);
    let _ = writeln!(
        html,
        "<section><h2>Radar {sensor} <span class=\"verdict {class}\">{word}</span></h2>"
    );
    if let Some(sentence) = sentence(estimate, options) {
        let _ = writeln!(html, "<p>{}</p>", escaped(&sentence));
    }
    for remark in &estimate.remarks {
        let _ =
            writeln!(html, "<p class=\"undecided\">Note: {}.</p>", escaped(&remark.to_string()));
    }
    let _ = writeln!(
        html,
        "<figure>{}<figcaption>Angle (blue) with its standard deviation; nominal angle (solid, all along) and what is allowed (red, dashed). Estimated by {}{}, {} ({}).</figcaption></figure>",
        figures::angle(recorder, estimate, options, &format!("angle-{sensor}")),
        options.method.title(),
        if *joint { ", with all radars of the car" } else { "" },
        options.motion_method().title(),
        options.method.reference(),
    );
    *html += "</section><section><h3>What came out</h3>\n";
    let capital = |Fact { name, value }: Fact| {
        let mut letters = name.chars();
        let first = letters.next().map(|first| first.to_ascii_uppercase());
        (first.into_iter().chain(letters).collect(), value)
    };
    table(html, facts(estimate).into_iter().map(capital));
    *html += "</section><section><h3>The drive</h3>\n";
    table(html, recorder.conditions().into_iter().map(|(name, value)| (name.into(), value)));
    let _ = writeln!(
        html,
        "<figure>{}</figure></section>",
        figures::drive(recorder, &format!("drive-{sensor}"))
    );
    if let Some(outlook) = outlook {
        let _ = writeln!(
            html,
            "<section><h3>What driving on would bring</h3><p>{}</p>",
            escaped(&outlook.advice)
        );
        let rows = outlook.forecasts.iter().map(|forecast| {
            let minutes = match forecast.minutes {
                Some(minutes) => format!("; enough after {minutes:.0} min"),
                None => "; not enough within 20 min".into(),
            };
            let sigma = forecast.sigma_rad.to_degrees();
            (forecast.instruction.into(), format!("+- {sigma:.3} deg after a minute{minutes}"))
        });
        table(html, rows);
        *html += "</section>\n";
    }
}
