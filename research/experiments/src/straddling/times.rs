//! What a snapshot takes by method and grid.

use super::trial::{Plan, angle_options};
use super::{CONDITIONS, GRIDS, StraddlingExperiment};
use crate::aoa::finder::Finder;
use crate::aoa::times::time_of;
use crate::error::EvaluateError;
use boresight_aoa::options::{IaaForm, IaaOptions, Thresholding};
use boresight_aoa::refinement::Refinement;
use boresight_aoa::{EstimatorOptions, Method};
use boresight_core::Complex64;
use boresight_validate::table::markdown;
use ndarray::{ArrayView3, Axis};

/// Snapshots that are timed together.
const SNAPSHOTS: u64 = 32;

/// Times of a snapshot, as a table: the median over some rounds on one thread, of snapshots of a strong and a weak
/// target. Methods and networks are prepared before. Beside the times stands what multiple each is of that of the
/// first method that knows no grid. IAA stands there in its dense form, too, which takes any array.
///
/// # Errors
/// Those of the methods.
pub fn times(options: &StraddlingExperiment) -> Result<String, EvaluateError> {
    let plan = Plan::new(options)?;
    let (scenes, _) = plan.scenes(CONDITIONS.len() - 1, 0, SNAPSHOTS)?;
    let mut rows: Vec<(String, Vec<f64>)> = vec![];
    for line in plan.lines().iter().filter(|line| !line.is_on_grid()) {
        let of = |options: EstimatorOptions| {
            time(line.finder(), line.is_refined(), &plan, options, scenes.view())
        };
        let grids = || line.grids().into_iter().map(|grid| angle_options(2, grid));
        rows.push((line.name(), grids().map(of).collect::<Result<_, _>>()?));
        if *line.finder() == Finder::Method(Method::Iaa, Thresholding::None) && !line.is_refined() {
            let iaa = IaaOptions { form: IaaForm::Dense, ..IaaOptions::default() };
            let dense = grids().map(|options| of(EstimatorOptions { iaa, ..options }));
            rows.push(("iaa, dense form".into(), dense.collect::<Result<_, _>>()?));
        }
    }
    let gridless = rows.iter().find_map(|(name, times)| match times[..] {
        [time] => Some((name.clone(), time)),
        _ => None,
    });
    let mut text = shown("Time of a snapshot, us, by points of the grid.", &rows, 1e6, 0);
    if let Some((name, time)) = gridless {
        let title = format!("The same as multiples of that of {name}.");
        text += &format!("\n{}", shown(&title, &rows, 1.0 / time, 2));
    }
    Ok(text)
}

fn time(
    finder: &Finder,
    refined: bool,
    plan: &Plan,
    options: EstimatorOptions,
    scenes: ArrayView3<Complex64>,
) -> Result<f64, EvaluateError> {
    let mut estimator = finder.with_options(&plan.array, options)?;
    let mut refinement = Refinement::new(&plan.array, &options)?;
    let task = || {
        let batch = estimator.estimate_batch(scenes, false)?;
        for (trial, y) in scenes.axis_iter(Axis(0)).enumerate().filter(|_| refined) {
            let directions = finder.sure(batch.sources_of(trial));
            refinement.refine(&directions, boresight_aoa::Data::Snapshots(y))?;
        }
        Ok(())
    };
    Ok(time_of(task)? / SNAPSHOTS as f64)
}

/// A table of numbers times `scale`; what knows no grid has one number.
fn shown(title: &str, rows: &[(String, Vec<f64>)], scale: f64, digits: usize) -> String {
    let heads: Vec<String> =
        ["any".to_owned()].into_iter().chain(GRIDS.map(|grid| grid.to_string())).collect();
    let heads: Vec<&str> = heads.iter().map(String::as_str).collect();
    let cell = |time: &f64| format!("{:.digits$}", scale * time);
    let cells = |times: &[f64]| -> Vec<String> {
        match times {
            [one] => [cell(one)].into_iter().chain(GRIDS.map(|_| String::new())).collect(),
            all => [String::new()].into_iter().chain(all.iter().map(cell)).collect(),
        }
    };
    let rows: Vec<(&str, Vec<String>)> =
        rows.iter().map(|(name, times)| (name.as_str(), cells(times))).collect();
    format!("{title}\n\n{}", markdown("method", &heads, &rows))
}
