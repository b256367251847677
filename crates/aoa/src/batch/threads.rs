//! A batch over threads.

use crate::batch::BatchEstimate;
use crate::error::AoaError;
use crate::estimator::Estimator;
use crate::method::Method;
use crate::options::EstimatorOptions;
use crate::order::counted::CountSources;
use boresight_core::{Array, Complex64};
use boresight_math::error::check_range;
use ndarray::{ArrayView3, s};
use std::sync::Arc;

/// Fewest cells a thread is started for.
const FEWEST_CELLS: usize = 8;

/// Estimators of one kind, one a thread, and their results.
pub struct Estimators {
    workers: Vec<Worker>,
}

struct Worker {
    estimator: Estimator,
    part: BatchEstimate,
}

impl Estimators {
    /// As [`Estimator::new`], for up to `threads` threads: 1 where there are none, as in WebAssembly.
    ///
    /// # Errors
    /// As [`Estimator::new`]; [`boresight_core::InputError::OutOfRange`] for no threads, or more than 1024.
    pub fn new(
        method: Method,
        array: &Array,
        options: &EstimatorOptions,
        threads: usize,
    ) -> Result<Self, AoaError> {
        check_range("threads", threads as f64, 1.0, 1024.0)?;
        let estimator = |_| Estimator::new(method, array, options);
        Self::of((0..threads).map(estimator).collect::<Result<_, AoaError>>()?)
    }

    /// As [`Estimator::counted`], for up to `threads` threads.
    ///
    /// # Errors
    /// As [`Estimator::counted`]; [`boresight_core::InputError::OutOfRange`] for no threads, or more than 1024.
    pub fn counted(
        method: Method,
        array: &Array,
        options: &EstimatorOptions,
        threads: usize,
        counter: &Arc<dyn CountSources>,
    ) -> Result<Self, AoaError> {
        check_range("threads", threads as f64, 1.0, 1024.0)?;
        let estimator = |_| Estimator::counted(method, array, options, counter);
        Self::of((0..threads).map(estimator).collect::<Result<_, AoaError>>()?)
    }

    /// A thread for each estimator, all of one kind.
    ///
    /// # Errors
    /// [`boresight_core::InputError::OutOfRange`] for none, or more than 1024.
    pub fn of(estimators: Vec<Estimator>) -> Result<Self, AoaError> {
        check_range("threads", estimators.len() as f64, 1.0, 1024.0)?;
        let worker = |estimator: Estimator| {
            let part = BatchEstimate::new(estimator.method());
            Worker { estimator, part }
        };
        Ok(Self { workers: estimators.into_iter().map(worker).collect() })
    }

    /// As [`Estimator::estimate_batch`], and the same for any number of threads.
    ///
    /// # Errors
    /// As [`Estimator::estimate_batch`]; of several errors that of the first cells.
    pub fn estimate_batch(
        &mut self,
        snapshots: ArrayView3<'_, Complex64>,
        spectra: bool,
    ) -> Result<BatchEstimate, AoaError> {
        let most = if cfg!(target_family = "wasm") { 1 } else { self.workers.len() };
        let threads = (snapshots.dim().0 / FEWEST_CELLS).clamp(1, most);
        if threads == 1 {
            return self.workers[0].estimator.estimate_batch(snapshots, spectra);
        }
        self.spread(snapshots, spectra, threads)
    }

    fn spread(
        &mut self,
        snapshots: ArrayView3<'_, Complex64>,
        spectra: bool,
        threads: usize,
    ) -> Result<BatchEstimate, AoaError> {
        let cells = snapshots.dim().0;
        let start = |thread: usize| thread * cells / threads;
        let run = |worker: &mut Worker, thread: usize| {
            let stretch = snapshots.slice(s![start(thread)..start(thread + 1), .., ..]);
            worker.estimator.estimate_batch_into(stretch, spectra, &mut worker.part)
        };
        let mut outcomes = vec![Ok(()); threads];
        let mut tasks = self.workers.iter_mut().zip(&mut outcomes).enumerate();
        std::thread::scope(|scope| {
            let first = tasks.next();
            for (thread, (worker, outcome)) in tasks {
                let run = &run;
                scope.spawn(move || *outcome = run(worker, thread));
            }
            if let Some((thread, (worker, outcome))) = first {
                *outcome = run(worker, thread);
            }
        });
        outcomes.into_iter().collect::<Result<(), _>>()?;
        let (first, rest) = self.workers[..threads].split_at_mut(1);
        let mut all = first[0].part.clone();
        for worker in rest {
            all.append(&worker.part);
        }
        Ok(all)
    }
}
