//! `boresight fleet merge`.

use super::{lines_of, threads};
use crate::arguments::FleetMergeArguments;
use crate::error::CliError;
use crate::files::{Files, make_folder};
use crate::output::remark;
use boresight_fleet::plan::Distinct;
use boresight_fleet::{FleetError, Jobs, gather, merge, report, store, tables, text, written};
use boresight_formats::json;
use boresight_report::About;
use jiff::Timestamp;
use std::io::{BufWriter, Write};

/// Puts records together.
pub(super) fn run(arguments: &FleetMergeArguments, files: &Files) -> Result<String, CliError> {
    let sources = store::files(&arguments.records)?;
    for source in &sources {
        files.note_input(source);
    }
    let plan = match &arguments.plan {
        None => None,
        Some(path) => {
            let mut distinct = Distinct::default();
            for job in Jobs::new(lines_of(path, files)?, path) {
                distinct.add(job?)?;
            }
            Some(distinct.into_jobs())
        }
    };
    let out = match &arguments.out {
        None => None,
        Some(folder) => {
            make_folder(folder)?;
            let names = ["fleet.json", "drives.parquet", "radars.parquet", "report.html"];
            let places = names.map(|name| files.destination(&folder.join(name)));
            let [result, drives, radars, page] = places;
            Some((result?, drives?, radars?, page?))
        }
    };
    let gathered = gather::gather(&sources, plan.as_deref(), arguments.partial)?;
    drop(plan);
    if gathered.damaged > 0 {
        let lines = gathered.damaged;
        remark([format!("{lines} records are damaged or unfinished and left out")]);
    }
    if gathered.repeated > 0 {
        remark([format!(
            "{} records of logs that have another are counted once",
            gathered.repeated
        )]);
    }
    let options = &arguments.flags.options;
    let fleet = merge::merge(gathered, options, threads(arguments.threads))?;
    if let Some((result, drives, radars, page)) = out {
        let named = result.named().to_owned();
        files.write_with(result, |file| {
            let mut file = BufWriter::with_capacity(1 << 18, file);
            let failed = |error: std::io::Error| FleetError::file("write", &named, error);
            written::write(&fleet, &mut file).and_then(|()| file.flush()).map_err(failed)?;
            Ok(())
        })?;
        // Parquet's footer comes last and says where all else is: a table is made whole.
        let (mut bytes, mut radar_bytes) = (vec![], vec![]);
        tables::write_drives(&fleet, &mut bytes)?;
        tables::write_radars(&fleet, &mut radar_bytes)?;
        files.write(drives, &bytes)?;
        files.write(radars, &radar_bytes)?;
        let about = About {
            made: Timestamp::now().strftime("%Y-%m-%d %H:%M UTC").to_string(),
            version: env!("CARGO_PKG_VERSION").into(),
            asked: std::env::args().collect::<Vec<_>>().join(" "),
            sources: vec![],
        };
        files.write(page, report::page(&about, &fleet, options).as_bytes())?;
    }
    Ok(if arguments.json {
        format!("{:#}\n", json::result(&fleet))
    } else {
        text::summary(&fleet, options)
    })
}
