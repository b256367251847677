//! What is answered in each trial, for scores to be counted again by other means.

use super::Condition;
use super::plan::Plan;
use boresight_validate::experiment::Tell;
use serde_json::{Map, Value, json};

/// What was answered in one trial.
#[derive(Debug, Clone, Default)]
pub(super) struct Answers {
    /// By counter.
    pub counted: Vec<usize>,
    /// By method and network: ascending, nothing where there were fewer than targets.
    pub azimuths_rad: Vec<Option<Vec<f64>>>,
}

impl Plan {
    /// Tells number, truth and answers of a trial.
    pub(super) fn tell(
        &self,
        index: usize,
        trial: u64,
        truth_deg: &[f64],
        answers: &Answers,
        tell: Tell,
    ) {
        let Condition { targets, snr_db, second_db } = self.conditions[index];
        let counted = answers.counted.iter().map(|&n| n.into());
        let counted: Map<_, _> = self.counters().into_iter().zip(counted).collect();
        let degrees = |found: &Option<Vec<f64>>| {
            let degrees = |found: &Vec<f64>| found.iter().map(|a| a.to_degrees()).collect();
            found.as_ref().map_or(Value::Null, degrees)
        };
        let angles_deg = answers.azimuths_rad.iter().map(degrees);
        let angles_deg: Map<_, _> = self.names().into_iter().zip(angles_deg).collect();
        tell(json!({
            "targets": targets,
            "snrDb": snr_db,
            "secondDb": second_db,
            "trial": trial,
            "truthDeg": truth_deg,
            "counted": counted,
            "anglesDeg": angles_deg,
        }));
    }
}
