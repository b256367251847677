//! `boresight fleet run`.

use super::{lines_of, memory, part, threads, worker};
use crate::arguments::{FleetRunArguments, WhichPart};
use crate::error::CliError;
use crate::files::{Files, make_folder};
use crate::run::Run;
use crate::terminal;
use boresight_core::Progress;
use boresight_fleet::Part;
use boresight_fleet::run::{RunCounts, run as run_jobs};
use boresight_fleet::store::{self, Store, keys_of, line};
use boresight_fleet::{FleetError, Job, Jobs, Record};
use std::collections::HashSet;
use std::io::Write;
use std::ops::ControlFlow;
use std::path::Path;
use std::time::Duration;

/// Runs a plan or a part of it.
pub(super) fn run(arguments: &FleetRunArguments, files: &Files) -> Result<String, CliError> {
    let part = match arguments.part {
        None => Part::WHOLE,
        Some(WhichPart::Given(part)) => part,
        Some(WhichPart::Auto) => part::of_variables(|name| std::env::var(name).ok())?,
    };
    let memory_limit = arguments.memory_limit.map(|megabytes| megabytes * 1_000_000);
    let workers = worker::workers(
        Duration::from_secs_f64(arguments.time_limit),
        memory_limit.or_else(memory::default_limit),
    )?;
    let run = Run::start("logs")?;
    let threads = threads(arguments.threads);
    let Some(folder) = &arguments.out else {
        let jobs = Jobs::new(lines_of(&arguments.plan, files)?, &arguments.plan);
        let jobs = of_part(jobs, part);
        let stdout = std::io::stdout();
        let printed = Path::new("the standard output");
        let keep = |record: &Record| {
            let line = line(record)?;
            let mut out = stdout.lock();
            out.write_all(line.as_bytes())
                .and_then(|()| out.flush())
                .map_err(|error| FleetError::file("write", printed, error))
        };
        let look = |counts: RunCounts| look(&run, counts.all() as usize, 0);
        run_jobs(jobs, threads, &workers, keep, look)?;
        run.finish();
        return Ok(String::new());
    };
    // A plan that cannot be read leaves no folder behind.
    let plan = Jobs::new(lines_of(&arguments.plan, files)?, &arguments.plan);
    make_folder(folder)?;
    let path = folder.join(part.file_name(store::NAME));
    let mut store = Store::open(&path, files.force())?;
    // Records of other parts count too: who runs with another number of parts goes on with what is there.
    let there: HashSet<String> = keys_of(folder, arguments.retry)?;
    let mut jobs = vec![];
    let (mut found, mut planned) = (0_u64, HashSet::new());
    for job in of_part(plan, part) {
        let job = job?;
        if there.contains(&job.key) {
            found += 1;
        } else if planned.insert(job.key.clone()) {
            jobs.push(job);
        }
    }
    let total = jobs.len();
    let keep = |record: &Record| store.append(record);
    let look = |counts: RunCounts| look(&run, counts.all() as usize, total);
    let ended = run_jobs(jobs.into_iter().map(Ok), threads, &workers, keep, look);
    store.sync()?;
    run.finish();
    let counts = ended?;
    Ok(format!(
        "Part {part}: {} logs calibrated, {} failed, {found} had a record; {}\n",
        counts.done,
        counts.failed,
        terminal::name(&path),
    ))
}

/// The jobs of a part, by their place in the plan.
fn of_part<I: Iterator<Item = Result<Job, FleetError>>>(
    jobs: I,
    part: Part,
) -> impl Iterator<Item = Result<Job, FleetError>> {
    jobs.enumerate()
        .filter(move |(at, job)| job.is_err() || part.contains(*at as u64))
        .map(|(_, job)| job)
}

fn look(run: &Run, done: usize, total: usize) -> ControlFlow<()> {
    run.report(Progress { done, total: total.max(done) })
}
