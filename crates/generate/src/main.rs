//! Writes what follows from the descriptions of options and results: TypeScript types, JSON Schemas
//! and tables of docs. `--check` compares them with the files instead.

mod catalogue;
mod docs;
mod schema;
mod typescript;
mod values;

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
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let entries = catalogue::entries()?;
    let files = [
        ("web/lib/generated/options.ts", typescript::module(&entries)),
        ("web/lib/generated/schema.json", schema::document(&entries)?),
        ("docs/options.md", docs::page(&entries)),
    ];
    let mut stale = vec![];
    for (name, text) in files {
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
