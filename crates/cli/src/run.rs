//! Progress on the standard error, and Ctrl-C.

use crate::error::CliError;
use boresight_core::Progress;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Shows progress where the standard error is a terminal, and stops at Ctrl-C.
pub struct Run {
    bar: ProgressBar,
    stop: Arc<AtomicBool>,
}

/// Becomes true at Ctrl-C; once in a process.
pub fn interrupted() -> Result<Arc<AtomicBool>, CliError> {
    let stop = Arc::new(AtomicBool::new(false));
    let asked = stop.clone();
    ctrlc::set_handler(move || asked.store(true, Ordering::Relaxed))?;
    Ok(stop)
}

impl Run {
    /// Starts watching; once in a process. `steps` is what progress counts.
    pub fn start(steps: &str) -> Result<Self, CliError> {
        let stop = interrupted()?;
        let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr());
        if let Ok(style) = ProgressStyle::with_template(&format!(
            "{{bar:40}} {{pos}}/{{len}} {steps}, {{eta}} left"
        )) {
            bar.set_style(style);
        }
        Ok(Self { bar, stop })
    }

    /// Shows where the run is; breaks if Ctrl-C was pressed.
    pub fn report(&self, progress: Progress) -> ControlFlow<()> {
        self.bar.set_length(progress.total as u64);
        self.bar.set_position(progress.done as u64);
        if self.stop.load(Ordering::Relaxed) {
            self.bar.finish_and_clear();
            return ControlFlow::Break(());
        }
        ControlFlow::Continue(())
    }

    /// Takes the bar off the terminal.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }
}
