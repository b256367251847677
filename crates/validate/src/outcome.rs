//! What an experiment writes and prints.

use crate::experiment::{Experiment, Report};
use crate::table::Tables;

/// Endings of the files of tables, numbers, those that figures show, and numbers in a table.
const ENDINGS: [&str; 4] = ["md", "json", "brief.json", "csv"];

/// What an experiment came to, as files.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// Name of the experiment.
    pub name: &'static str,
    /// Tables, as Markdown.
    pub tables: String,
    /// All numbers, as JSON.
    pub json: String,
    /// The numbers that figures show, as JSON in few bytes.
    pub brief: String,
    /// All numbers, as comma-separated values.
    pub csv: String,
    /// Figures, as SVG, each with the name of its file.
    pub figures: Vec<(&'static str, String)>,
}

impl Outcome {
    /// Of a report, with standard errors from its tables without each of some groups of scenes.
    pub fn new<E: Experiment>(report: &E::Report, without: &[Tables]) -> Self {
        Self {
            name: E::NAME,
            tables: report.tables().render(without),
            json: report.json(),
            brief: report.brief(),
            csv: report.csv(),
            figures: E::Report::FIGURES.iter().copied().zip(report.figures()).collect(),
        }
    }

    /// Names of the files that an experiment comes to.
    pub fn names<E: Experiment>() -> Vec<String> {
        let tables = ENDINGS.iter().map(|ending| format!("{}.{ending}", E::NAME));
        tables.chain(E::Report::FIGURES.iter().map(|name| (*name).to_owned())).collect()
    }

    /// The files, each with its name.
    pub fn files(&self) -> Vec<(String, &str)> {
        let tables = [&self.tables, &self.json, &self.brief, &self.csv];
        let tables = ENDINGS.iter().zip(tables);
        let tables = tables.map(|(ending, text)| (format!("{}.{ending}", self.name), &**text));
        let figures = self.figures.iter().map(|(name, svg)| ((*name).to_owned(), &**svg));
        tables.chain(figures).collect()
    }
}
