//! Results as tables, JSON and comma-separated values.

use crate::arguments::OutputFormat;
use crate::error::CliError;
use crate::terminal::{one_line, report};
use serde_json::{Map, Value};

/// A column: its name in JSON, its name in CSV and tables, and the digits shown in tables.
pub struct Column {
    /// Name in JSON, with the unit.
    pub json: &'static str,
    /// Name in CSV, with the unit.
    pub csv: &'static str,
    /// Digits after the point in tables.
    pub digits: usize,
}

/// A result as rows of numbers; NaN and infinities stand for what there is no number for.
pub struct Table {
    /// Columns.
    pub columns: Vec<Column>,
    /// Rows, one number a column.
    pub rows: Vec<Vec<f64>>,
    /// What to say when there are no rows.
    pub empty: &'static str,
}

impl Table {
    /// The text in the format asked for.
    pub fn render(&self, format: &OutputFormat) -> Result<String, CliError> {
        if format.json {
            return Ok(self.json());
        }
        Ok(if format.csv { self.csv() } else { self.plain() })
    }

    fn json(&self) -> String {
        let objects: Vec<Value> = self
            .rows
            .iter()
            .map(|row| {
                let fields = self.columns.iter().zip(row).map(|(column, &number)| {
                    let value = if column.digits == 0 && number.is_finite() {
                        Value::from(number as i64)
                    } else {
                        // What is not finite becomes null.
                        Value::from(number)
                    };
                    (column.json.to_owned(), value)
                });
                Value::Object(fields.collect::<Map<_, _>>())
            })
            .collect();
        format!("{:#}\n", Value::Array(objects))
    }

    fn csv(&self) -> String {
        let names: Vec<&str> = self.columns.iter().map(|column| column.csv).collect();
        let mut text = names.join(",") + "\n";
        for row in &self.rows {
            let fields: Vec<String> = row
                .iter()
                .map(|number| if number.is_finite() { number.to_string() } else { String::new() })
                .collect();
            text += &(fields.join(",") + "\n");
        }
        text
    }

    fn plain(&self) -> String {
        if self.rows.is_empty() {
            return format!("{}\n", self.empty);
        }
        let cells: Vec<Vec<String>> = self
            .rows
            .iter()
            .map(|row| row.iter().zip(&self.columns).map(|(&x, c)| shown(x, c.digits)).collect())
            .collect();
        let widths: Vec<usize> = (0..self.columns.len())
            .map(|k| {
                let longest = cells.iter().map(|row| row[k].len()).max().unwrap_or_default();
                longest.max(self.columns[k].csv.len())
            })
            .collect();
        let line = |fields: Vec<&str>| {
            let padded: Vec<String> = fields
                .iter()
                .zip(&widths)
                .map(|(field, width)| format!("{field:>width$}"))
                .collect();
            padded.join("  ") + "\n"
        };
        let mut text = line(self.columns.iter().map(|column| column.csv).collect());
        for row in &cells {
            text += &line(row.iter().map(String::as_str).collect());
        }
        text
    }
}

fn shown(number: f64, digits: usize) -> String {
    if !number.is_finite() {
        return "-".into();
    }
    let text = format!("{number:.digits$}");
    // No minus before a rounded zero.
    match text.strip_prefix('-') {
        Some(rest) if rest.chars().all(|c| c == '0' || c == '.') => rest.into(),
        _ => text,
    }
}

/// Writes remarks to the standard error.
pub fn remark(lines: impl IntoIterator<Item = String>) {
    let lines = lines.into_iter().map(|line| format!("note: {}\n", one_line(&line)));
    report(&lines.collect::<String>());
}
