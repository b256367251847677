//! Text for a terminal. Names and texts from files may hold control characters, which a terminal obeys; all text for
//! people is written here, with these characters escaped.

use std::fmt::Write as _;
use std::io::{Result, Write};
use std::path::Path;

/// Writes text to the standard output.
pub fn print(text: &str) -> Result<()> {
    let mut out = std::io::stdout().lock();
    out.write_all(escaped(text).as_bytes())?;
    out.flush()
}

/// Writes text to the standard error. Nothing can be reported where that is closed.
pub fn report(text: &str) {
    let _ = std::io::stderr().write_all(escaped(text).as_bytes());
}

/// Text with control characters and direction overrides as `\u001b`. JSON stays the same JSON, since it has these
/// characters in strings alone. Line feeds are kept.
fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for one in text.chars() {
        if one != '\n' && (one.is_control() || is_direction(one)) {
            // All of them are below U+10000. Writing to a string cannot fail.
            let _ = write!(out, "\\u{:04x}", u32::from(one));
        } else {
            out.push(one);
        }
    }
    out
}

/// Text within a line: a line feed of a name would otherwise forge lines of output.
pub fn one_line(text: &str) -> String {
    escaped(text).replace('\n', "\\n")
}

/// The name of a file within a line.
pub fn name(path: &Path) -> String {
    one_line(&path.display().to_string())
}

/// Whether a character changes the direction of text, or begins a new line or paragraph.
fn is_direction(one: char) -> bool {
    matches!(one, '\u{061c}' | '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn control_characters_and_overrides_are_escaped() {
        for one in (0..=0x9f).chain(0x2028..=0x202e).chain(0x2066..=0x2069).chain([0x61c, 0x200f]) {
            let one = char::from_u32(one).unwrap();
            let text = escaped(&one.to_string());
            let kept = one == '\n' || (' '..='~').contains(&one);
            assert_eq!(text.chars().eq([one]), kept, "{one:?}");
            assert!(text.chars().all(|c| c == '\n' || !c.is_control()) && text.is_ascii());
        }
        assert_eq!(escaped("a\u{1b}[31m µ\u{9b}2J\n"), "a\\u001b[31m µ\\u009b2J\n");
        assert_eq!(one_line("a\r\nb"), "a\\u000d\\nb");
    }

    #[test]
    fn json_stays_the_same() {
        let value =
            serde_json::json!({ "a\\\u{202e}\u{7f}": "\u{1b}\n\t\u{85}\\", "b": [1.5, null] });
        let text = escaped(&format!("{value:#}"));
        assert_eq!(serde_json::from_str::<serde_json::Value>(&text).unwrap(), value);
        assert!(text.is_ascii());
    }
}
