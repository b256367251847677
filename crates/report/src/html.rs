//! What every page is made of: one document with its style, for light and dark screens and for paper, that asks for nothing from
//! elsewhere and runs no scripts: its policy (CSP) allows its own style alone.

use crate::escape::escaped;
use crate::page::About;
use std::fmt::Write as _;

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

/// A page with a title, whose body is made of HTML; `lead` says in words, after when and by what the page was made, how to read it.
pub fn document(about: &About, title: &str, lead: &str, body: &str) -> String {
    let [title, lead] = [title, lead].map(escaped);
    format!(
        "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n\
         <meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'sha256-{STYLE_SHA256}'; \
         base-uri 'none'; form-action 'none'\">\n<meta name=\"viewport\" content=\"width=device-width\">\n\
         <title>{title}</title>\n<style>{STYLE}</style>\n<body>\n<h1>{title}</h1>\n<p class=\"small\">Made {} by Boresight {}. \
         {lead}</p>\n{body}</body>\n</html>\n",
        escaped(&about.made),
        escaped(&about.version),
    )
}

/// The section on what a report rests on: its files, at most so many of them, and how it was asked for.
pub fn origin(html: &mut String, about: &About, most: usize) {
    *html += "<section><h2>Where it comes from</h2>\n";
    let rows = about.sources.iter().take(most).map(|source| {
        (source.name.clone(), format!("{} bytes, SHA-256 {}", source.bytes, source.sha256))
    });
    table(html, rows);
    let left = about.sources.len().saturating_sub(most);
    if left > 0 {
        let _ = writeln!(html, "<p class=\"small\">And {left} more files.</p>");
    }
    let _ = writeln!(
        html,
        "<p class=\"small\">Asked for by <code>{}</code></p></section>",
        escaped(&about.asked)
    );
}

/// Names with their values.
pub fn table(html: &mut String, rows: impl Iterator<Item = (String, String)>) {
    *html += "<table>\n";
    for (name, value) in rows {
        let _ = writeln!(html, "<tr><th>{}</th><td>{}</td></tr>", escaped(&name), phrase(&value));
    }
    *html += "</table>\n";
}

/// A phrase as HTML shows it, with the sign for its deviations.
pub fn phrase(text: &str) -> String {
    escaped(text).replace("+- ", "\u{b1} ")
}
