//! Tables, as Markdown.

/// Rows of cells under heads, each row with a name.
pub fn table(corner: &str, heads: &[&str], rows: &[(&str, Vec<String>)]) -> String {
    let mut text =
        format!("| {corner} | {} |\n|---|{}\n", heads.join(" | "), "---|".repeat(heads.len()));
    for (name, cells) in rows {
        text += &format!("| {name} | {} |\n", cells.join(" | "));
    }
    text
}

/// A number in about three digits.
pub fn short(x: f64) -> String {
    match x.abs() {
        0.0 => "0".into(),
        size if !size.is_finite() => "-".into(),
        10.0.. => format!("{x:.1}"),
        1.0.. => format!("{x:.2}"),
        0.001.. => format!("{x:.3}"),
        _ => format!("{x:.0e}"),
    }
}
