//! All drives of one kind: what their records come to.

use crate::accepted::{Accepted, within};
use crate::candidates::{CANDIDATES, Candidate, DRIVING_TIMES_S, SEGMENTS_M};
use crate::statistics::Summary;
use crate::whole::{
    EstimateRecord, FIGURE_RADAR, PartRecord, RadarRecord, WholeRecord, error_steps_deg,
};
use serde::Serialize;

/// Mean errors by segment, m; `None` where no drive has such a segment.
pub type BySegment = [Option<f64>; SEGMENTS_M.len()];

/// Drives of one kind.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct Condition {
    /// What they are.
    pub name: &'static str,
    /// How many.
    pub scenes: usize,
    /// Way driven in all, km.
    pub driven_km: f64,
    /// Time driven in all, h.
    pub driven_h: f64,
    /// Share of detections from moving road users: mean and largest, over the drives that tell it.
    pub moving_share: [f64; 2],
    /// Figure 4: scans by speed, then by acceleration, in bins.
    pub states: [Vec<u64>; 2],
    /// Radars with their true angles.
    pub radars: Vec<Baseline>,
    /// Methods in the order of [`CANDIDATES`].
    pub methods: Vec<MethodResult>,
    /// Figure 6, for the methods it shows.
    pub convergence: Vec<Convergence>,
    /// Figure 5: each method's angles of radar 3, deg, by scene.
    pub angles_deg: Vec<Vec<Option<f64>>>,
}

/// A radar with its true angle.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct Baseline {
    /// Number.
    pub sensor: u8,
    /// True angle, deg.
    pub true_deg: f64,
    /// Mean relative trajectory errors with it, m.
    pub rte_m: BySegment,
}

/// A method over all drives of a condition.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct MethodResult {
    /// Name.
    pub name: &'static str,
    /// By radar.
    pub radars: Vec<RadarResult>,
    /// Share of errors within one and two of the stated standard deviations, all radars.
    pub within: [f64; 2],
    /// The same for the scale, where it was estimated.
    pub scale_within: Option<[f64; 2]>,
    /// Mean error and standard deviation of the scale.
    pub scale: Option<[f64; 2]>,
}

/// A method on one radar.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct RadarResult {
    /// Number.
    pub sensor: u8,
    /// Errors, deg.
    pub error_deg: Summary,
    /// Standard deviation of the mean error, deg.
    pub mean_sigma_deg: f64,
    /// Drives that gave no angle.
    pub without: usize,
    /// Drives in which the method called itself converged.
    pub converged: usize,
    /// Drives in which it did and is more than three of its standard deviations off.
    pub confidently_wrong: usize,
    /// Mean relative trajectory errors with each drive's own angle, m.
    pub rte_m: BySegment,
    /// The same with the mean of all drives' angles; `None` too where that is over 10 deg off.
    pub rte_mean_angle_m: BySegment,
}

/// Errors of radar 3 against driving time.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct Convergence {
    /// Name of the method.
    pub name: &'static str,
    /// Driving time, s.
    pub driving_s: Vec<f64>,
    /// Errors, deg.
    pub error_deg: Vec<Summary>,
    /// Parts that gave no angle.
    pub without: Vec<usize>,
    /// Share of errors within one and two of the stated standard deviations.
    pub within: Vec<[f64; 2]>,
    /// Parts called converged.
    pub accepted: Vec<Accepted>,
}

impl Condition {
    /// From the records of its drives.
    pub fn new(name: &'static str, records: &[&WholeRecord]) -> Self {
        let shares: Vec<f64> = records.iter().filter_map(|record| record.moving_share).collect();
        let shares = Summary::of(&shares);
        let mut sensors: Vec<u8> =
            records.iter().flat_map(|r| r.radars.iter().map(|radar| radar.sensor)).collect();
        sensors.sort_unstable();
        sensors.dedup();
        let of = |sensor: u8| records.iter().filter_map(move |r| radar_of(r, sensor));
        let radars = sensors
            .iter()
            .map(|&sensor| Baseline {
                sensor,
                true_deg: of(sensor).next().map_or(f64::NAN, |radar| radar.true_deg),
                rte_m: by_segment(|at| of(sensor).filter_map(move |radar| radar.rte_true_m[at])),
            })
            .collect();
        let methods = (0..CANDIDATES.len()).map(|k| MethodResult::new(k, &sensors, &of)).collect();
        let convergence = CANDIDATES
            .iter()
            .filter(|candidate| candidate.convergence)
            .enumerate()
            .map(|(k, candidate)| {
                let all: Vec<&[PartRecord]> = of(FIGURE_RADAR)
                    .filter_map(|radar| radar.parts.get(k))
                    .map(Vec::as_slice)
                    .collect();
                Convergence::new(candidate.name, &all)
            })
            .collect();
        let angles_deg = (0..CANDIDATES.len())
            .map(|k| {
                let angle =
                    |radar: &RadarRecord| Some(radar.true_deg + radar.estimates[k].error_deg?);
                records.iter().map(|r| radar_of(r, FIGURE_RADAR).and_then(angle)).collect()
            })
            .collect();
        Self {
            name,
            scenes: records.len(),
            driven_km: records.iter().map(|record| record.driven_m).sum::<f64>() / 1e3,
            driven_h: records.iter().map(|record| record.driven_s).sum::<f64>() / 3600.0,
            moving_share: [shares.mean, shares.largest],
            states: [0, 1].map(|which| {
                let bins = records.first().map_or(0, |record| record.states[which].len());
                let of = |bin| records.iter().filter_map(move |r| r.states[which].get(bin)).sum();
                (0..bins).map(of).collect()
            }),
            radars,
            methods,
            convergence,
            angles_deg,
        }
    }
}

fn radar_of(record: &WholeRecord, sensor: u8) -> Option<&RadarRecord> {
    record.radars.iter().find(|radar| radar.sensor == sensor)
}

impl MethodResult {
    fn new<'a, I: Iterator<Item = &'a RadarRecord>>(
        k: usize,
        sensors: &[u8],
        of: &impl Fn(u8) -> I,
    ) -> Self {
        let estimate = |radar: &'a RadarRecord| radar.estimates.get(k);
        let all = || sensors.iter().flat_map(|sensor| of(*sensor).filter_map(estimate));
        let scales: Vec<(f64, f64)> = all().filter_map(|e| e.scale).collect();
        let errors: Vec<f64> = scales.iter().map(|(error, _)| *error).collect();
        let summary = Summary::of(&errors);
        Self {
            name: CANDIDATES[k].name,
            radars: sensors
                .iter()
                .map(|&sensor| RadarResult::new(k, sensor, &|| of(sensor)))
                .collect(),
            within: within(all().filter_map(|e| Some((e.error_deg?, e.sigma_deg?)))),
            scale: (summary.count > 1).then(|| [summary.mean, summary.variance.sqrt()]),
            scale_within: (summary.count > 1).then(|| within(scales.into_iter())),
        }
    }
}

impl RadarResult {
    fn new<'a, I: Iterator<Item = &'a RadarRecord>>(
        k: usize,
        sensor: u8,
        of: &impl Fn() -> I,
    ) -> Self {
        let estimates = || of().filter_map(|radar| radar.estimates.get(k));
        let errors: Vec<f64> = estimates().filter_map(|e| e.error_deg).collect();
        let error_deg = Summary::of(&errors);
        let wrong = |e: &&EstimateRecord| e.answer().is_some_and(|a| a.confidently_wrong());
        Self {
            sensor,
            error_deg,
            mean_sigma_deg: error_deg.mean_sigma(),
            without: estimates().count() - errors.len(),
            converged: estimates().filter(|e| e.converged).count(),
            confidently_wrong: estimates().filter(wrong).count(),
            rte_m: by_segment(|at| estimates().filter_map(move |e| e.rte_m[at])),
            rte_mean_angle_m: by_segment(|at| {
                of().filter_map(move |radar| radar.rte_off(at, error_deg.mean))
            }),
        }
    }
}

impl RadarRecord {
    /// Relative trajectory error over a length of segments with an angle that is so far off, m, between those that were kept.
    fn rte_off(&self, segment: usize, error_deg: f64) -> Option<f64> {
        let kept = &self.rte_off_m[segment];
        let steps: Vec<f64> = error_steps_deg().collect();
        if kept.len() < steps.len() {
            return None;
        }
        let after = steps.partition_point(|step| *step < error_deg);
        let (before, next) = (after.checked_sub(1)?, steps.get(after)?);
        let share = (error_deg - steps[before]) / (next - steps[before]);
        let [a, b] = [before, after].map(|at| f64::from(kept[at]));
        Some(a + share * (b - a))
    }
}

impl Convergence {
    fn new(name: &'static str, parts: &[&[PartRecord]]) -> Self {
        let lengths = || 0..DRIVING_TIMES_S.len();
        let of = |i: usize| parts.iter().filter_map(move |part| part.get(i));
        let answers = |i: usize| of(i).flat_map(|part| part.answers.iter().copied());
        let without = |i: usize| of(i).map(|part| part.without).sum::<usize>();
        Self {
            name,
            driving_s: DRIVING_TIMES_S.to_vec(),
            error_deg: lengths()
                .map(|i| Summary::of(&answers(i).map(|a| a.error_deg).collect::<Vec<_>>()))
                .collect(),
            without: lengths().map(without).collect(),
            within: lengths()
                .map(|i| within(answers(i).map(|a| (a.error_deg, a.sigma_deg))))
                .collect(),
            accepted: lengths().map(|i| Accepted::of(answers(i), without(i))).collect(),
        }
    }
}

fn by_segment<I: Iterator<Item = f64>>(of: impl Fn(usize) -> I) -> BySegment {
    std::array::from_fn(|at| {
        let summary = Summary::of(&of(at).collect::<Vec<_>>());
        (summary.count > 0).then_some(summary.mean)
    })
}

/// Which methods a figure or a table shows, with their place in [`CANDIDATES`].
pub(super) fn chosen(which: fn(&Candidate) -> bool) -> impl Iterator<Item = usize> {
    (0..CANDIDATES.len()).filter(move |k| which(&CANDIDATES[*k]))
}
