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
