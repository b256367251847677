//! Writes what follows from the descriptions of options and results: TypeScript types, JSON Schemas
//! and tables of docs. `--check` compares them with the files instead.

mod catalogue;
mod docs;
mod schema;
mod typescript;
mod values;

#[cfg(test)]
use boresight_options::Kind;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use thiserror::Error;

#[derive(Debug, Error)]
enum GenerateError {
    #[error("{} cannot be read or written: {error}", path.display())]
    File { path: PathBuf, error: std::io::Error },
    #[error("expected nothing or --check, given {0:?}")]
    Argument(String),
    #[error("{0} differ from the descriptions in Rust; `npm run generate` writes them")]
    Stale(String),
    #[error("a value cannot be written as JSON: {0}")]
    Json(#[from] serde_json::Error),
}

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

fn run() -> Result<(), GenerateError> {
    let is_check = match std::env::args().nth(1).as_deref() {
        None => false,
        Some("--check") => true,
        Some(other) => return Err(GenerateError::Argument(other.into())),
    };
    let root = root();
    let mut stale = vec![];
    for (name, text) in files()? {
        let path = root.join(name);
        let failed = |error| GenerateError::File { path: path.clone(), error };
        if std::fs::read_to_string(&path).is_ok_and(|there| there == text) {
            continue;
        }
        if is_check {
            stale.push(name);
            continue;
        }
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder).map_err(failed)?;
        }
        std::fs::write(&path, text).map_err(failed)?;
    }
    if stale.is_empty() { Ok(()) } else { Err(GenerateError::Stale(stale.join(", "))) }
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// The files by their place in the checkout, and what they should hold.
fn files() -> Result<[(&'static str, String); 6], GenerateError> {
    let entries = catalogue::entries()?;
    let results = catalogue::results();
    let [options, all_results] = typescript::modules(&entries, &results);
    Ok([
        ("web/lib/generated/options.ts", options),
        ("web/lib/generated/results.ts", all_results),
        ("web/lib/generated/schema.json", schema::document(&entries)?),
        ("web/lib/generated/results-schema.json", schema::results_document(&results)?),
        ("docs/options.md", docs::options(&entries)),
        ("docs/results.md", docs::results(&results)),
    ])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn generated_files_are_those_of_the_descriptions() {
        for (name, text) in files().unwrap() {
            let there = std::fs::read_to_string(root().join(name)).unwrap();
            assert!(there == text, "{name} is stale: `npm run generate` writes it");
        }
    }

    #[test]
    fn one_name_means_one_type() {
        let module =
            files().unwrap()[..2].iter().map(|(_, text)| text.as_str()).collect::<String>();
        let mut names: Vec<&str> = module
            .lines()
            .filter_map(|line| line.strip_prefix("export ")?.split_whitespace().nth(1))
            .collect();
        let count = names.len();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), count);
        let mut kinds = vec![];
        for entry in catalogue::entries().unwrap() {
            collect(&Kind::Record(entry.record), &mut kinds);
        }
        for kind in catalogue::results().iter().flat_map(|(_, kinds)| kinds) {
            collect(kind, &mut kinds);
        }
        for (name, kind) in &kinds {
            let same = kinds.iter().filter(|(other, _)| other == name);
            assert!(
                same.into_iter().all(|(_, other)| other == kind),
                "two types are called {name}"
            );
        }
    }

    fn collect(kind: &Kind, kinds: &mut Vec<(&'static str, Kind)>) {
        match *kind {
            Kind::Choice(choice) => kinds.push((choice.name, *kind)),
            Kind::Record(record) => {
                kinds.push((record.name, *kind));
                record.fields.iter().for_each(|field| collect(&field.kind, kinds));
            }
            Kind::Optional(inner) | Kind::List(inner) | Kind::Tuple(inner, _) => {
                collect(inner, kinds);
            }
            _ => {}
        }
    }
}
