//! Plans: files of jobs, a line each.

use crate::error::FleetError;
use crate::job::Job;
use crate::schema;
use std::collections::BTreeMap;
use std::io::BufRead;
use std::path::Path;

/// Longest line that is read, bytes: a log of a hundred thousand files.
const LONGEST_LINE: u64 = 64 << 20;

/// The jobs of a plan that is read line by line. A line that was edited, or planned by a newer release in a format of its own, is an error.
pub struct Jobs<'a, R> {
    reader: R,
    /// Where the plan is from, for errors.
    path: &'a Path,
    line: u64,
    buffer: Vec<u8>,
}

impl<'a, R: BufRead> Jobs<'a, R> {
    /// From what is read; the path is what errors name.
    pub fn new(reader: R, path: &'a Path) -> Self {
        Self { reader, path, line: 0, buffer: vec![] }
    }

    fn job(&self) -> Result<Job, FleetError> {
        let (path, line) = (self.path.to_owned(), self.line);
        if let Some(found) = schema::newer(&self.buffer) {
            return Err(FleetError::Newer { path, line, found });
        }
        let job: Job = serde_json::from_slice(&self.buffer).map_err(|error| FleetError::Plan {
            path: path.clone(),
            line,
            error,
        })?;
        if !job.is_sound() {
            let expected = Job::key_of(&job.files, &job.settings);
            return Err(FleetError::EditedPlan { path, line, expected, given: job.key });
        }
        Ok(job)
    }
}

impl<R: BufRead> Iterator for Jobs<'_, R> {
    type Item = Result<Job, FleetError>;

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            self.buffer.clear();
            let mut limited = std::io::Read::take(&mut self.reader, LONGEST_LINE);
            match limited.read_until(b'\n', &mut self.buffer) {
                Ok(0) => return None,
                Err(error) => return Some(Err(FleetError::file("read", self.path, error))),
                Ok(_) => self.line += 1,
            }
            if !self.buffer.trim_ascii().is_empty() {
                return Some(self.job());
            }
        }
    }
}

/// Jobs by what they do: copies of a log are one job, that of the first path. Whether copies are said to be of different vehicles
/// is an error.
#[derive(Debug, Default)]
pub struct Distinct {
    jobs: BTreeMap<String, Job>,
    copies: u64,
}

impl Distinct {
    /// Adds a job.
    ///
    /// # Errors
    /// [`FleetError::Conflict`] where one log is to be of two vehicles.
    pub fn add(&mut self, job: Job) -> Result<(), FleetError> {
        let Some(other) = self.jobs.get_mut(&job.key) else {
            self.jobs.insert(job.key.clone(), job);
            return Ok(());
        };
        if other.vehicle != job.vehicle {
            return Err(FleetError::Conflict {
                path: job.path,
                what: "the log is another vehicle's too",
                expected: format!("vehicle {}, as {}", other.vehicle, other.path),
                given: format!("vehicle {}", job.vehicle),
            });
        }
        self.copies += 1;
        if job.path < other.path {
            *other = job;
        }
        Ok(())
    }

    /// Copies that were left out.
    #[must_use]
    pub fn copies(&self) -> u64 {
        self.copies
    }

    /// The jobs, ordered by path.
    #[must_use]
    pub fn into_jobs(self) -> Vec<Job> {
        let mut jobs: Vec<Job> = self.jobs.into_values().collect();
        jobs.sort_by(|a, b| a.path.cmp(&b.path).then_with(|| a.key.cmp(&b.key)));
        jobs
    }
}
