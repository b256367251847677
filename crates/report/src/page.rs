//! The page.

use crate::{Fact, Recorder, facts, figures, sentence};
use boresight_calibrate::{Alignment, AngleEstimate, CalibrationOptions, Outlook};
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

const STYLE: &str = "\
:root{color-scheme:light;font:15px/1.5 system-ui,sans-serif;color:#1c1f24;background:#fff}\
body{max-width:52rem;margin:2rem auto;padding:0 1rem}\
h1{font-size:1.5rem;margin:0 0 .25rem}h2{font-size:1.2rem;margin:2rem 0 .5rem}h3{font-size:1rem;margin:1.25rem 0 .25rem}\
.verdict{display:inline-block;padding:.1rem .6rem;border:2px solid;border-radius:.3rem;font-weight:700;margin-left:.5rem}\
.aligned{color:#176336}.misaligned{color:#a11d1d}.undecided{color:#7a5200}\
table{border-collapse:collapse;width:100%}th,td{text-align:left;padding:.2rem .6rem .2rem 0;border-bottom:1px solid #d8dce2;vertical-align:top}\
th{font-weight:600;width:11rem}td{overflow-wrap:anywhere}\
svg{display:block;width:100%;height:auto;font-size:13px}.axis{stroke:#8a929d;fill:none}.grid{stroke:#e3e6ea}\
.line{fill:none;stroke:#0b5fa5;stroke-width:2}.band{fill:#0b5fa5;fill-opacity:.18}.level{stroke:#1c1f24;stroke-width:1.5}.limit{stroke:#a11d1d;stroke-width:1.5;stroke-dasharray:6 4}figure{margin:1rem 0}figcaption,.small{color:#4d545e;font-size:.87rem}\
code{font-size:.85rem;overflow-wrap:anywhere}section{break-inside:avoid}\
@media print{body{margin:0;max-width:none}h2{break-before:auto}}@page{margin:18mm}";

/// The report of all radars of a drive, as HTML that needs nothing else.
pub fn page(about: &About, radars: &[Radar]) -> String {
    let numbers: Vec<String> = radars.iter().map(|radar| radar.sensor.to_string()).collect();
    let title = format!(
        "Mounting angle of radar{} {}",
        if radars.len() == 1 { "" } else { "s" },
        numbers.join(", ")
    );
    let mut html = format!(
        "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" content=\"width=device-width\">\n\
         <title>{title}</title>\n<style>{STYLE}</style>\n<body>\n<h1>{title}</h1>\n<p class=\"small\">Made {} by Boresight {}. \
         Angles are those of boresight in the car's frame, counter-clockwise from straight ahead.</p>\n",
        escaped(&about.made),
        escaped(&about.version),
    );
    for radar in radars {
        section(&mut html, radar);
    }
    html += "<section><h2>Where it comes from</h2>\n";
    let rows = about.sources.iter().map(|source| {
        (source.name.clone(), format!("{} bytes, SHA-256 {}", source.bytes, source.sha256))
    });
    table(&mut html, rows);
    let _ = write!(
        html,
        "<p class=\"small\">Asked for by <code>{}</code></p></section>\n</body>\n</html>\n",
        escaped(&about.asked)
    );
    html
}

fn section(html: &mut String, radar: &Radar) {
    let Radar { sensor, joint, options, estimate, outlook, recorder } = radar;
    let (word, class) = match estimate.alignment {
        Some(Alignment::Aligned) => ("Pass: aligned", "aligned"),
        Some(Alignment::Misaligned) => ("Fail: misaligned", "misaligned"),
        Some(Alignment::Undecided) => ("Undecided", "undecided"),
        None => ("No nominal angle", "undecided"),
    };
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
        "<figure>{}<figcaption>Angle (blue) with its standard deviation; nominal angle (black) and what is allowed (red, dashed). Estimated by {}{}, {} ({}).</figcaption></figure>",
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

fn table(html: &mut String, rows: impl Iterator<Item = (String, String)>) {
    *html += "<table>\n";
    for (name, value) in rows {
        let _ = writeln!(
            html,
            "<tr><th>{}</th><td>{}</td></tr>",
            escaped(&name),
            escaped(&value).replace("+- ", "\u{b1} ")
        );
    }
    *html += "</table>\n";
}

/// Text as HTML shows it.
fn escaped(text: &str) -> String {
    let mut result = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => result += "&amp;",
            '<' => result += "&lt;",
            '>' => result += "&gt;",
            '"' => result += "&quot;",
            '\'' => result += "&#39;",
            letter => result.push(letter),
        }
    }
    result
}
