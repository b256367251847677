//! Tables of results with standard errors, as Markdown.

use std::fmt;

/// Differences below so many of their standard errors do not rank two rows.
const DISTINCT: f64 = 2.0;

/// Relative error of a mean of equal numbers.
const ROUNDING: f64 = 1e-12;

/// A number with the text that shows it, or text alone.
#[derive(Debug, Clone, PartialEq)]
pub struct Cell {
    text: String,
    /// Not a number where the cell is text, which has no error and is not compared.
    value: f64,
    digits: usize,
}

impl Cell {
    /// Text alone.
    pub fn text(text: impl Into<String>) -> Self {
        Self { text: text.into(), value: f64::NAN, digits: 0 }
    }

    /// A number with so many digits after the point; a dash where it is not finite.
    pub fn fixed(value: f64, digits: usize) -> Self {
        if !value.is_finite() {
            return Self::text("-");
        }
        Self { text: format!("{value:.digits$}"), value, digits }
    }

    /// A share in per cent.
    pub fn percent(share: f64) -> Self {
        Self::fixed(100.0 * share, 1)
    }

    /// A number in about three digits.
    pub fn short(value: f64) -> Self {
        Self::shown(value, short(value))
    }

    /// A number with the text that shows it.
    pub fn shown(value: f64, text: String) -> Self {
        Self { text, value, digits: 4 }
    }

    /// The same text without the number, for rows that are no result, such as a bound.
    #[must_use]
    pub fn reference(self) -> Self {
        Self { value: f64::NAN, ..self }
    }
}

/// Which value of a column is best.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Best {
    /// The largest.
    Largest,
    /// The smallest.
    Smallest,
    /// None is: columns are not ranked.
    None,
}

/// A table under its title.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// Paragraphs before it; the last one is its title.
    pub title: String,
    /// What the rows are.
    pub corner: &'static str,
    /// Heads of the columns.
    pub heads: Vec<String>,
    /// Rows, each with its name.
    pub rows: Vec<(String, Vec<Cell>)>,
    /// How columns are ranked.
    pub best: Best,
    /// Whether each cell shows its standard error; otherwise one line has their range.
    pub errors_in_cells: bool,
}

impl Table {
    /// A table whose cells do not show their errors.
    pub fn new<H: ToString, N: ToString>(
        title: impl Into<String>,
        best: Best,
        corner: &'static str,
        heads: impl IntoIterator<Item = H>,
        rows: impl IntoIterator<Item = (N, Vec<Cell>)>,
    ) -> Self {
        let heads = heads.into_iter().map(|head| head.to_string()).collect();
        let rows = rows.into_iter().map(|(name, cells)| (name.to_string(), cells)).collect();
        Self { title: title.into(), corner, heads, rows, best, errors_in_cells: false }
    }

    fn value(&self, row: usize, column: usize) -> f64 {
        self.rows.get(row).and_then(|(_, cells)| cells.get(column)).map_or(f64::NAN, |c| c.value)
    }

    /// The row with the best value of a column.
    fn best_row(&self, column: usize) -> Option<usize> {
        let sign = match self.best {
            Best::Largest => 1.0,
            Best::Smallest => -1.0,
            Best::None => return None,
        };
        (0..self.rows.len()).filter(|&row| self.value(row, column).is_finite()).max_by(|&a, &b| {
            (sign * self.value(a, column)).total_cmp(&(sign * self.value(b, column)))
        })
    }

    /// As Markdown, with standard errors from the same table without each group of trials, if there are any.
    fn render(&self, without: &[&Self]) -> String {
        let error = |value: &dyn Fn(&Self) -> f64| {
            jackknife(&without.iter().map(|table| value(table)).collect::<Vec<_>>())
        };
        let mut errors = vec![];
        let mut ranked = false;
        let best: Vec<Option<usize>> = (0..self.heads.len()).map(|c| self.best_row(c)).collect();
        let rows: Vec<(&str, Vec<String>)> = self
            .rows
            .iter()
            .enumerate()
            .map(|(row, (name, cells))| {
                let cells = cells.iter().enumerate().map(|(column, cell)| {
                    let own = error(&|table| table.value(row, column));
                    let mut text = cell.text.clone();
                    if let Some(own) = own.filter(|_| cell.value.is_finite()) {
                        errors.push(own);
                        if self.errors_in_cells {
                            text += &format!(" ± {own:.*}", cell.digits);
                        }
                    }
                    let to_best = best.get(column).copied().flatten().and_then(|best| {
                        let behind = (self.value(best, column) - cell.value).abs();
                        let own =
                            error(&|table| table.value(best, column) - table.value(row, column))?;
                        Some(behind <= DISTINCT * own)
                    });
                    ranked |= to_best.is_some();
                    if to_best == Some(true) { format!("**{text}**") } else { text }
                });
                (name.as_str(), cells.collect())
            })
            .collect();
        let heads: Vec<&str> = self.heads.iter().map(String::as_str).collect();
        let mut text = format!("{}\n\n{}", self.title, markdown(self.corner, &heads, &rows));
        let range =
            (errors.iter().copied().reduce(f64::min), errors.iter().copied().reduce(f64::max));
        if let (Some(least), Some(most)) = range {
            text += &format!("\nStandard errors: {} to {}.", short(least), short(most));
            if ranked {
                text += " Bold: not distinguishable from the best of the column (paired difference within two standard errors).";
            }
            text.push('\n');
        }
        text
    }
}

/// What an experiment prints: a remark, then tables.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Tables {
    /// Paragraphs before the first table; may be empty.
    pub remark: String,
    /// The tables.
    pub tables: Vec<Table>,
}

impl Tables {
    /// As Markdown, with standard errors by the jackknife: `without` holds what the experiment prints without each of
    /// some groups of trials, which are of one size and independent.
    pub fn render(&self, without: &[Self]) -> String {
        let tables = self.tables.iter().enumerate().map(|(k, table)| {
            let without: Vec<&Table> = without.iter().filter_map(|all| all.tables.get(k)).collect();
            table.render(&without)
        });
        let parts: Vec<String> =
            Some(self.remark.clone()).into_iter().filter(|r| !r.is_empty()).chain(tables).collect();
        parts.join("\n")
    }
}

impl fmt::Display for Tables {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.render(&[]))
    }
}

/// Standard error of a value, from its values without each of some groups of trials (delete-a-group jackknife); `None`
/// for fewer than two groups and for values that are not finite.
fn jackknife(without: &[f64]) -> Option<f64> {
    let n = without.len() as f64;
    let mean = without.iter().sum::<f64>() / n;
    let squares: f64 = without.iter().map(|value| (value - mean).powi(2)).sum();
    let error = ((n - 1.0) / n * squares).sqrt();
    // Equal values differ from their mean by rounding.
    let error = if error <= ROUNDING * mean.abs() { 0.0 } else { error };
    (without.len() > 1 && error.is_finite()).then_some(error)
}

/// Rows of cells under heads, each row with a name, as Markdown.
pub fn markdown(corner: &str, heads: &[&str], rows: &[(&str, Vec<String>)]) -> String {
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

#[cfg(test)]
mod tests {
    use super::*;
    use boresight_core::Random;

    const GROUPS: usize = 16;

    #[test]
    fn the_error_of_a_mean_is_that_of_theory() {
        // Means of 16 groups of 40 numbers of standard deviation 1: 1 / sqrt(640).
        let random = &mut Random::new(3, 0);
        let mut squares = 0.0;
        let runs = 300;
        for _ in 0..runs {
            let groups: Vec<f64> =
                (0..GROUPS).map(|_| (0..40).map(|_| random.normal()).sum::<f64>() / 40.0).collect();
            let sum: f64 = groups.iter().sum();
            let without: Vec<f64> =
                groups.iter().map(|group| (sum - group) / (GROUPS - 1) as f64).collect();
            squares += jackknife(&without).unwrap_or(f64::NAN).powi(2);
        }
        // A variance of 15 degrees of freedom errs by sqrt(2 / 15), the mean of 300 by 2.1 %.
        let ratio = squares / f64::from(runs) * 640.0;
        assert!((ratio - 1.0).abs() < 0.085, "{ratio}");
        assert_eq!((jackknife(&[1.0]), jackknife(&[1.0, f64::NAN])), (None, None));
    }

    #[test]
    fn rows_are_ranked_by_paired_differences() {
        let table = |a: f64, b: f64, c: f64| Tables {
            remark: "Few.\n".into(),
            tables: vec![Table::new(
                "Share",
                Best::Largest,
                "method",
                ["15 dB"],
                [
                    ("a", vec![Cell::fixed(a, 3)]),
                    ("b", vec![Cell::fixed(b, 3)]),
                    ("c", vec![Cell::fixed(c, 3)]),
                    ("bound", vec![Cell::fixed(2.0, 3).reference()]),
                ],
            )],
        };
        // All vary together by 0.02; b is 0.01 behind a in every group, c by 0.001 and as much more or less.
        let without: Vec<Tables> = (0..GROUPS)
            .map(|k| {
                let (shared, own) = ([0.02, -0.02][k % 2], [0.001, -0.001][k / 2 % 2]);
                table(0.9 + shared, 0.89 + shared, 0.899 + shared + own)
            })
            .collect();
        let text = table(0.9, 0.89, 0.899).render(&without);
        assert!(text.starts_with("Few.\n\nShare\n\n| method | 15 dB |"), "{text}");
        assert!(
            text.contains("| a | **0.900** |\n| b | 0.890 |\n| c | **0.899** |\n| bound | 2.000 |"),
            "{text}"
        );
        // sqrt(15 / 16 * 16 * 0.02^2)
        assert!(text.contains("\nStandard errors: 0.077 to 0.078."), "{text}");
        let plain = table(0.9, 0.89, 0.899).to_string();
        assert!(!plain.contains("**") && !plain.contains("Standard errors"), "{plain}");
    }
}
