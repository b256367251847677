//! Parts of every page: one document with its style for screens (light and dark) and paper. It loads nothing and runs no scripts:
//! its content security policy allows its own style only.

use crate::page::About;
use maud::{DOCTYPE, Markup, PreEscaped, Render, html};

const STYLE: &str = "\
:root{color-scheme:light;--ink:#1c1f24;--soft:#4d545e;--paper:#fff;--rule:#d8dce2;--grid:#e3e6ea;--axis:#8a929d;--line:#0b5fa5;\
--now:#0d7a5f;--good:#176336;--bad:#a11d1d;--open:#7a5200;font:15px/1.5 system-ui,sans-serif;color:var(--ink);background:var(--paper)}\
@media screen and (prefers-color-scheme:dark){:root{color-scheme:dark;--ink:#e4e7eb;--soft:#a9b1bc;--paper:#15181c;--rule:#3a414a;\
--grid:#2a2f36;--axis:#7d8691;--line:#6db3f2;--now:#4fd1a8;--good:#6fcf97;--bad:#ff8a80;--open:#e6b450}}\
body{max-width:52rem;margin:2rem auto;padding:0 1rem}\
h1{font-size:1.5rem;margin:0 0 .25rem}h2{font-size:1.2rem;margin:2rem 0 .5rem}h3{font-size:1rem;margin:1.25rem 0 .25rem}\
h1,h2,h3,p,li{overflow-wrap:anywhere}h2,h3{break-after:avoid}a{color:var(--line)}\
.verdict{display:inline-block;padding:.1rem .6rem;border:2px solid;border-radius:.3rem;font-weight:700;margin-left:.5rem}\
.aligned{color:var(--good)}.misaligned{color:var(--bad)}.undecided{color:var(--open)}\
table{border-collapse:collapse;width:100%}th,td{text-align:left;padding:.2rem .6rem .2rem 0;border-bottom:1px solid var(--rule);vertical-align:top}\
th{font-weight:600;width:11rem}td{overflow-wrap:anywhere}.wide{overflow-x:auto}.wide th{width:auto}.wide td{overflow-wrap:normal;min-width:3.5rem}\
.wide td.long{overflow-wrap:anywhere;min-width:9rem}tr{break-inside:avoid}\
svg{display:block;width:100%;height:auto;font-size:13px}svg text{fill:var(--ink)}.axis{stroke:var(--axis);fill:none}.grid{stroke:var(--grid)}\
.line{fill:none;stroke:var(--line);stroke-width:2}.band{fill:var(--line);fill-opacity:.18}.level{stroke:var(--ink);stroke-width:1.5}\
.limit{stroke:var(--bad);stroke-width:1.5;stroke-dasharray:6 4}.now{fill:var(--now);fill-opacity:.3;stroke:var(--now);stroke-width:6;stroke-opacity:.35}\
.event{stroke:var(--open);stroke-width:1.5;stroke-dasharray:2 3}.bars{fill:none;stroke:var(--axis);stroke-width:1}\
.dots{fill:none;stroke-linecap:round;stroke:var(--ink);stroke-width:4}.far{stroke:var(--bad);stroke-width:6}\
figure{margin:1rem 0;break-inside:avoid}figcaption,.small{color:var(--soft);font-size:.87rem}\
code{font-size:.85rem;overflow-wrap:anywhere}section{break-inside:avoid}\
@media screen and (max-width:30rem){svg{font-size:20px}th{width:7rem}.wide td.long{min-width:6rem}}\
@media print{body{margin:0;max-width:none}h2{break-before:auto}}@page{margin:18mm}";

/// Digest of [`STYLE`], by which the policy of a page allows it.
const STYLE_SHA256: &str = "mSD6KTlYunIA3zayYulUuJ0xIPQFkj2OlKGnIT2UdrA=";

/// A page with a title. `lead` is the paragraph, after when and by what the page was made, that explains how to read it.
pub fn document(about: &About, title: &str, lead: &str, body: &Markup) -> String {
    let policy = format!(
        "default-src 'none'; style-src 'sha256-{STYLE_SHA256}'; base-uri 'none'; form-action 'none'"
    );
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta http-equiv="Content-Security-Policy" content=(policy);
                meta name="viewport" content="width=device-width";
                title { (title) }
                style { (PreEscaped(STYLE)) }
            }
            body {
                h1 { (title) }
                p.small { "Made " (about.made) " by Boresight " (about.version) ". " (lead) }
                (body)
            }
        }
    };
    page.into_string()
}

/// The section on the sources of a report: its files, at most `most` of them, and the request.
pub fn origin(about: &About, most: usize) -> Markup {
    let rows = about.sources.iter().take(most).map(|source| {
        (source.name.clone(), format!("{} bytes, SHA-256 {}", source.bytes, source.sha256))
    });
    let left = about.sources.len().saturating_sub(most);
    html! {
        section {
            h2 { "Where it comes from" }
            (table(rows))
            @if left > 0 {
                p.small { "And " (left) " more files." }
            }
            p.small { "Asked for by " code { (about.asked) } }
        }
    }
}

/// A table of names and values.
pub fn table(rows: impl Iterator<Item = (String, String)>) -> Markup {
    html! {
        table {
            @for (name, value) in rows {
                tr { th { (name) } td { (Phrase(&value)) } }
            }
        }
    }
}

/// A phrase, shown with the sign for standard deviations.
#[derive(Debug, Clone, Copy)]
pub struct Phrase<'a>(pub &'a str);

impl Render for Phrase<'_> {
    fn render_to(&self, buffer: &mut String) {
        self.0.replace("+- ", "\u{b1} ").render_to(buffer);
    }
}
