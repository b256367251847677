//! Which part of a plan this process runs, by a scheduler's variables.

use crate::error::CliError;
use boresight_fleet::Part;

/// What tells a part: number, smallest number, step between numbers, how many there are.
struct Source {
    name: &'static str,
    number: &'static str,
    first: Option<&'static str>,
    step: Option<&'static str>,
    count: &'static str,
}

/// In the order in which they are asked.
const SOURCES: [Source; 3] = [
    Source {
        name: "Slurm",
        number: "SLURM_ARRAY_TASK_ID",
        first: Some("SLURM_ARRAY_TASK_MIN"),
        step: Some("SLURM_ARRAY_TASK_STEP"),
        count: "SLURM_ARRAY_TASK_COUNT",
    },
    // Kubernetes gives the index alone; a manifest states the count again.
    Source {
        name: "Kubernetes",
        number: "JOB_COMPLETION_INDEX",
        first: None,
        step: None,
        count: "JOB_COMPLETIONS",
    },
    // A submit file may hand both over; otherwise they are in the job's own description.
    Source {
        name: "HTCondor",
        number: "CONDOR_PROCESS",
        first: None,
        step: None,
        count: "CONDOR_PROCESSES",
    },
];
/// Names the file that describes a job of HTCondor.
const JOB_AD: &str = "_CONDOR_JOB_AD";

/// The part that variables tell.
pub(super) fn of_variables(variable: impl Fn(&str) -> Option<String>) -> Result<Part, CliError> {
    for source in SOURCES {
        if let Some(number) = variable(source.number) {
            let number = whole(source.number, &number)?;
            let count = variable(source.count).ok_or_else(|| missing(source.name, source.count))?;
            let read = |name: Option<&'static str>, default: u64| -> Result<u64, CliError> {
                let Some(name) = name else { return Ok(default) };
                variable(name).map_or(Ok(default), |text| whole(name, &text))
            };
            let (first, step) = (read(source.first, 0)?, read(source.step, 1)?);
            let place = number.checked_sub(first).filter(|past| step > 0 && past % step == 0);
            let place = place.ok_or_else(|| CliError::Option {
                option: "--part auto",
                expected: format!("{} to count up from {first} by {step}", source.number),
                given: number.to_string(),
            })?;
            return part(place / step, whole(source.count, &count)?);
        }
    }
    if let Some(path) = variable(JOB_AD) {
        let text = std::fs::read_to_string(&path).map_err(|error| CliError::File {
            action: "read",
            path: path.into(),
            error,
        })?;
        let find = |name: &'static str| {
            let value = text.lines().find_map(|line| {
                let (key, value) = line.split_once('=')?;
                key.trim().eq_ignore_ascii_case(name).then(|| value.trim().to_owned())
            });
            value.ok_or_else(|| missing("HTCondor", name)).and_then(|value| whole(name, &value))
        };
        return part(find("ProcId")?, find("TotalSubmitProcs")?);
    }
    let numbers = SOURCES.map(|source| source.number).join(", ");
    Err(CliError::Option {
        option: "--part auto",
        expected: format!("one of the variables {numbers}, {JOB_AD}"),
        given: "none of them".into(),
    })
}

/// From a place counted from 0.
fn part(place: u64, count: u64) -> Result<Part, CliError> {
    Ok(Part::new(place.saturating_add(1), count)?)
}

fn whole(name: &'static str, text: &str) -> Result<u64, CliError> {
    text.trim().parse().map_err(|_| CliError::Option {
        option: "--part auto",
        expected: format!("{name} to be a whole number"),
        given: format!("{text:?}"),
    })
}

fn missing(scheduler: &str, name: &str) -> CliError {
    CliError::Option {
        option: "--part auto",
        expected: format!("{name} beside the number of {scheduler}'s part"),
        given: "not set".into(),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn of(pairs: &[(&str, &str)]) -> Option<String> {
        let find = |name: &str| {
            pairs.iter().find(|(key, _)| *key == name).map(|(_, value)| (*value).to_owned())
        };
        of_variables(find).ok().map(|part| part.to_string())
    }

    #[test]
    fn schedulers_tell_the_part() {
        let id = ("SLURM_ARRAY_TASK_ID", "7");
        let (min, count) = (("SLURM_ARRAY_TASK_MIN", "1"), ("SLURM_ARRAY_TASK_COUNT", "8"));
        assert_eq!(of(&[id, min, count]).unwrap(), "7/8");
        assert_eq!(of(&[id, ("SLURM_ARRAY_TASK_MIN", "0"), count]).unwrap(), "8/8");
        let step = ("SLURM_ARRAY_TASK_STEP", "2");
        assert_eq!(of(&[id, min, step, ("SLURM_ARRAY_TASK_COUNT", "4")]).unwrap(), "4/4");
        assert_eq!(of(&[("SLURM_ARRAY_TASK_ID", "6"), min, step, count]), None);
        assert_eq!(of(&[id, min]), None, "without the count");
        assert_eq!(of(&[("SLURM_ARRAY_TASK_ID", "9"), min, count]), None, "beyond the count");
        let index = ("JOB_COMPLETION_INDEX", "0");
        assert_eq!(of(&[index, ("JOB_COMPLETIONS", "3")]).unwrap(), "1/3");
        assert_eq!(of(&[index, ("JOB_COMPLETIONS", "x")]), None);
        let process = [("CONDOR_PROCESS", "2"), ("CONDOR_PROCESSES", "5")];
        assert_eq!(of(&process).unwrap(), "3/5");
        assert_eq!(of(&[]), None);
    }

    #[test]
    fn a_job_of_htcondor_describes_itself() {
        let path = std::env::temp_dir().join(format!("boresight-ad-{}", std::process::id()));
        let name = path.to_str().unwrap().to_owned();
        std::fs::write(&path, "ClusterId = 9\nProcId = 4\nTotalSubmitProcs = 10\n").unwrap();
        assert_eq!(of(&[(JOB_AD, &name)]).unwrap(), "5/10");
        std::fs::write(&path, "ProcId = 4\n").unwrap();
        assert_eq!(of(&[(JOB_AD, &name)]), None);
        std::fs::remove_file(&path).unwrap();
        assert_eq!(of(&[(JOB_AD, &name)]), None);
    }
}
