//! Running the jobs of a plan over worker processes.

use crate::error::FleetError;
use crate::job::Job;
use crate::record::Record;
use crate::worker::{Place, Workers};
use boresight_math::error::check_range;
use std::ops::ControlFlow;
use std::process::Command;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError, mpsc};
use std::time::Duration;

/// Time between two looks at whether to stop.
const LOOK: Duration = Duration::from_millis(100);

/// What became of the jobs of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct RunCounts {
    /// Calibrated.
    pub done: u64,
    /// Failed: their records say why.
    pub failed: u64,
}

impl RunCounts {
    fn add(&mut self, record: &Record) {
        *if record.failed.is_some() { &mut self.failed } else { &mut self.done } += 1;
    }

    /// Jobs with a record.
    #[must_use]
    pub fn all(&self) -> u64 {
        self.done + self.failed
    }
}

/// Runs jobs as they are given over `threads` worker processes, and hands each record to `keep` once it is there. What is kept is whole
/// whenever the run ends.
///
/// # Errors
/// The first of `jobs` or of `keep`; [`FleetError::Worker`] if no worker can be started; [`FleetError::Cancelled`] where `look`, which is asked
/// every tenth of a second and after each record, breaks the run; [`boresight_core::InputError::OutOfRange`] without threads.
pub fn run(
    jobs: impl Iterator<Item = Result<Job, FleetError>> + Send,
    threads: usize,
    workers: &Workers<impl Fn() -> Command + Sync>,
    mut keep: impl FnMut(&Record) -> Result<(), FleetError>,
    mut look: impl FnMut(RunCounts) -> ControlFlow<()>,
) -> Result<RunCounts, FleetError> {
    check_range("threads", threads as f64, 1.0, 4096.0)?;
    let jobs = Mutex::new(jobs);
    let stop = AtomicBool::new(false);
    std::thread::scope(|scope| {
        let (sender, records) = mpsc::sync_channel(threads);
        for _ in 0..threads {
            let (sender, jobs, stop) = (sender.clone(), &jobs, &stop);
            scope.spawn(move || {
                let mut place = Place::new(workers);
                while !stop.load(Ordering::Relaxed) {
                    let next = jobs.lock().unwrap_or_else(PoisonError::into_inner).next();
                    let made = match next {
                        None => break,
                        Some(Ok(job)) => place.run(&job, stop).transpose(),
                        Some(Err(error)) => Some(Err(error)),
                    };
                    let Some(made) = made else { break };
                    let failed = made.is_err();
                    if sender.send(made).is_err() || failed {
                        break;
                    }
                }
            });
        }
        drop(sender);
        let mut counts = RunCounts::default();
        let ended = loop {
            match records.recv_timeout(LOOK) {
                Ok(made) => {
                    let kept = made.and_then(|record: Record| {
                        keep(&record)?;
                        counts.add(&record);
                        Ok(())
                    });
                    if let Err(error) = kept {
                        break Err(error);
                    }
                }
                Err(mpsc::RecvTimeoutError::Timeout) => {}
                Err(mpsc::RecvTimeoutError::Disconnected) => break Ok(counts),
            }
            if look(counts).is_break() {
                break Err(FleetError::Cancelled { done: counts.all() });
            }
        };
        stop.store(true, Ordering::Relaxed);
        // Threads that wait to hand over a record go on.
        drop(records);
        ended
    })
}
