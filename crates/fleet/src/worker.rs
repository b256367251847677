//! Worker processes, which calibrate one log at a time.
//!
//! A log may crash, hang or exhaust the memory of the process that reads it. Each thread of a run therefore hands its jobs to a process of
//! its own, one line at a time, and reads the records from it. A log whose process dies or takes too long gets a record that
//! says so, and the next log gets a new process.

use crate::error::FleetError;
use crate::job::Job;
use crate::record::Failure;
use crate::record::Record;
use std::io::{BufRead, BufReader, Read, Write};
use std::process::{Child, ChildStdin, ChildStdout, Command, ExitStatus, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError};
use std::time::{Duration, Instant};

/// The line that a worker prints before it waits for a job.
pub const READY: &str = "ready\n";
/// The line that a worker prints once it has read a job, before it reads the log.
pub const ACCEPTED: &str = "accepted\n";
/// Interval at which a waiting thread checks whether the run was stopped.
const POLL: Duration = Duration::from_millis(100);
/// Time between the end of a worker and the record that blames its log. Ctrl-C and schedulers end both processes of a run, in any order: a run
/// that is ended itself within this time blames no log.
const GRACE: Duration = Duration::from_millis(500);
/// Time that a worker may take to start.
const START_LIMIT: Duration = Duration::from_mins(2);
/// Longest line that is read, bytes; see [`crate::store`].
const LONGEST_LINE: u64 = 64 << 20;

/// How workers are started and limited.
#[derive(Debug, Clone, Copy)]
pub struct Workers<C> {
    /// Returns the command of a worker. It prints [`READY`] once; for each job on its standard input [`ACCEPTED`] and then the record; and it
    /// ends with that input.
    pub command: C,
    /// Longest time for one log.
    pub time_limit: Duration,
}

/// A process that is running.
#[derive(Debug)]
struct Worker {
    child: Child,
    input: ChildStdin,
    lines: Receiver<String>,
}

/// End of the wait for a line.
enum Answer {
    Line(String),
    Ended,
    Late,
    Stopped,
}

impl Worker {
    fn start(mut command: Command) -> Result<Self, FleetError> {
        let name = command.get_program().to_owned();
        let failed = |error| FleetError::file("start", name.as_ref(), error);
        command.stdin(Stdio::piped()).stdout(Stdio::piped());
        let mut child = command.spawn().map_err(failed)?;
        let (Some(input), Some(output)) = (child.stdin.take(), child.stdout.take()) else {
            return Err(FleetError::Worker { given: "no pipe to its standard input".into() });
        };
        let (sender, lines) = mpsc::sync_channel(1);
        std::thread::spawn(move || {
            let mut output = BufReader::new(output);
            while let Some(line) = next_line(&mut output) {
                if sender.send(line).is_err() {
                    break;
                }
            }
        });
        let mut worker = Self { child, input, lines };
        match worker.answer(START_LIMIT, &AtomicBool::new(false)) {
            Answer::Line(line) if line == READY => Ok(worker),
            Answer::Line(line) => Err(FleetError::Worker { given: format!("{line:?}") }),
            Answer::Ended => Err(FleetError::Worker { given: worker.how_it_ended() }),
            Answer::Late | Answer::Stopped => {
                Err(FleetError::Worker { given: format!("nothing in {} s", START_LIMIT.as_secs()) })
            }
        }
    }

    /// Hands a job over and waits for [`ACCEPTED`].
    fn given(&mut self, line: &str, limit: Duration, stop: &AtomicBool) -> Answer {
        match self.input.write_all(line.as_bytes()) {
            Ok(()) => self.answer(limit, stop),
            Err(_) => Answer::Ended,
        }
    }

    fn answer(&self, limit: Duration, stop: &AtomicBool) -> Answer {
        let started = Instant::now();
        loop {
            let remaining = limit.saturating_sub(started.elapsed());
            match self.lines.recv_timeout(remaining.min(POLL)) {
                Ok(line) => return Answer::Line(line),
                Err(RecvTimeoutError::Disconnected) => return Answer::Ended,
                Err(RecvTimeoutError::Timeout) if stop.load(Ordering::Relaxed) => {
                    return Answer::Stopped;
                }
                Err(RecvTimeoutError::Timeout) if remaining.is_zero() => return Answer::Late,
                Err(RecvTimeoutError::Timeout) => {}
            }
        }
    }

    fn how_it_ended(&mut self) -> String {
        // A process that closed its output and runs on is of no use either.
        let _ = self.child.kill();
        match self.child.wait() {
            Ok(status) => ended(status),
            Err(error) => error.to_string(),
        }
    }
}

impl Drop for Worker {
    fn drop(&mut self) {
        // Neither fails but for a process that has ended.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn next_line(output: &mut BufReader<ChildStdout>) -> Option<String> {
    let mut line = vec![];
    output.take(LONGEST_LINE).read_until(b'\n', &mut line).ok()?;
    if line.last() == Some(&b'\n') { String::from_utf8(line).ok() } else { None }
}

fn ended(status: ExitStatus) -> String {
    #[cfg(unix)]
    {
        use std::os::unix::process::ExitStatusExt;
        if let Some(signal) = status.signal() {
            return format!("signal {signal}");
        }
    }
    status.code().map_or_else(|| status.to_string(), |code| format!("exit code {code}"))
}

/// The place of one thread, with its worker while it has one.
pub(crate) struct Place<'a, C> {
    workers: &'a Workers<C>,
    worker: Option<Worker>,
}

impl<'a, C: Fn() -> Command> Place<'a, C> {
    pub(crate) fn new(workers: &'a Workers<C>) -> Self {
        Self { workers, worker: None }
    }

    /// Returns the record of a job, or `None` if the run was stopped.
    ///
    /// # Errors
    /// [`FleetError::Worker`] and [`FleetError::File`] where no worker can be started, which is no fault of the log.
    pub(crate) fn run(
        &mut self,
        job: &Job,
        stop: &AtomicBool,
    ) -> Result<Option<Record>, FleetError> {
        let line = serde_json::to_string(job).map_err(|error| FleetError::Worker {
            given: format!("a job that cannot be written: {error}"),
        })? + "\n";
        let limit = self.workers.time_limit;
        // A worker that dies between two logs is the fault of neither.
        let mut worker = match self.worker.take() {
            Some(worker) => worker,
            None => Worker::start((self.workers.command)())?,
        };
        let mut answer = worker.given(&line, limit, stop);
        if matches!(answer, Answer::Ended) {
            worker = Worker::start((self.workers.command)())?;
            answer = worker.given(&line, limit, stop);
            if matches!(answer, Answer::Ended) {
                return Err(FleetError::Worker { given: worker.how_it_ended() });
            }
        }
        if matches!(&answer, Answer::Line(line) if line == ACCEPTED) {
            answer = worker.answer(limit, stop);
        }
        let failed = match answer {
            Answer::Line(line) => match serde_json::from_str::<Record>(&line) {
                Ok(record) if record.key == job.key => {
                    self.worker = Some(worker);
                    return Ok(Some(record));
                }
                _ => crashed(job, "an answer that is no record of the log"),
            },
            Answer::Ended => {
                let given = worker.how_it_ended();
                let died = Instant::now();
                while died.elapsed() < GRACE {
                    if stop.load(Ordering::Relaxed) {
                        return Ok(None);
                    }
                    std::thread::sleep(POLL);
                }
                crashed(job, &given)
            }
            Answer::Late => timed_out(job, limit),
            Answer::Stopped => return Ok(None),
        };
        Ok(Some(Record::failure(job, failed)))
    }
}

fn crashed(job: &Job, given: &str) -> Failure {
    Failure {
        code: "crashed".into(),
        message: format!("the process that calibrated {} ended: {given}", job.path),
        what: job.path.clone(),
        expected: "a log that can be calibrated within the memory limit".into(),
        given: given.into(),
    }
}

fn timed_out(job: &Job, limit: Duration) -> Failure {
    let limit = limit.as_secs_f64();
    Failure {
        code: "timed-out".into(),
        message: format!("{} was not calibrated within {limit} s", job.path),
        what: job.path.clone(),
        expected: format!("a log that can be calibrated within {limit} s"),
        given: "a longer calculation".into(),
    }
}
