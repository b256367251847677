//! From records to the tables.

use super::scene::{EstimateRecord, FIGURE_RADAR, PartRecord, RadarRecord, SEGMENT_M, SceneRecord};
use super::{CANDIDATES, CalibrationExperiment, DRIVING_TIMES_S, figures};
use crate::EvaluateError;
use crate::statistics::Summary;
use crate::table::table;
use boresight_simulate::drive::DriveProfile;
use serde::Serialize;

/// Kinds of drives: errors, whether traffic is dense, name.
const CONDITIONS: [(DriveProfile, bool, &str); 4] = [
    (DriveProfile::Clean, false, "clean, up to 30 % moving"),
    (DriveProfile::Clean, true, "clean, dense traffic, 40 to 80 % moving"),
    (DriveProfile::Radarscenes, false, "as RadarScenes, up to 30 % moving"),
    (DriveProfile::Radarscenes, true, "as RadarScenes, dense traffic, 40 to 80 % moving"),
];

/// The experiment's result.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct CalibrationReport {
    /// Seed.
    pub seed: u64,
    /// Length of each drive, s.
    pub duration_s: f64,
    /// Drives with up to 30 % moving detections, then dense traffic, of the clean profile, then of that as RadarScenes.
    pub conditions: Vec<Condition>,
}

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
    /// Share of detections from moving road users: mean and largest.
    pub moving_share: [f64; 2],
    /// Radars: number, true angle (deg) and relative trajectory error with it (m).
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
    /// Mean relative trajectory error with it, m.
    pub rte_m: f64,
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
    /// Mean relative trajectory error, m.
    pub rte_m: f64,
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
}

impl CalibrationReport {
    /// From the records, in order.
    pub fn new(
        options: &CalibrationExperiment,
        records: impl Iterator<Item = SceneRecord>,
    ) -> Self {
        let records: Vec<SceneRecord> = records.collect();
        let condition = |(profile, dense, name): (DriveProfile, bool, &'static str)| {
            let of: Vec<&SceneRecord> =
                records.iter().filter(|r| r.profile == profile && r.dense == dense).collect();
            Condition::new(name, &of)
        };
        Self {
            seed: options.seed,
            duration_s: options.duration_s,
            conditions: CONDITIONS.map(condition).into(),
        }
    }
}

impl crate::experiment::Report for CalibrationReport {
    fn tables(&self) -> String {
        self.conditions.iter().map(Condition::tables).collect::<Vec<_>>().join("\n")
    }

    fn csv(&self) -> String {
        let mut text = "condition,method,radar,drives,without,error_mean_deg,error_variance_deg2,\
                        error_mean_absolute_deg,error_largest_deg,converged,rte_m\n"
            .to_owned();
        for condition in &self.conditions {
            for method in &condition.methods {
                for r in &method.radars {
                    let (name, e) = (method.name, &r.error_deg);
                    text += &format!(
                        "\"{}\",\"{name}\",{},{},{},{},{},{},{},{},{}\n",
                        condition.name,
                        r.sensor,
                        e.count + r.without,
                        r.without,
                        e.mean,
                        e.variance,
                        e.mean_absolute,
                        e.largest,
                        r.converged,
                        r.rte_m,
                    );
                }
            }
        }
        text
    }

    const FIGURES: &'static [&'static str] = &[
        "convergence.svg",
        "angles.svg",
        "angles-dense.svg",
        "angles-radarscenes.svg",
        "angles-radarscenes-dense.svg",
    ];

    fn figures(&self) -> Result<Vec<String>, EvaluateError> {
        let mut drawn = vec![figures::convergence(self)?];
        for condition in &self.conditions {
            drawn.push(figures::angles(condition)?);
        }
        Ok(drawn)
    }
}

impl Condition {
    fn new(name: &'static str, records: &[&SceneRecord]) -> Self {
        let shares: Vec<f64> = records.iter().map(|record| record.moving_share).collect();
        let shares = Summary::of(&shares);
        let sensors: Vec<u8> =
            records.first().map_or(vec![], |r| r.radars.iter().map(|radar| radar.sensor).collect());
        let of = |index: usize| records.iter().filter_map(move |record| record.radars.get(index));
        let radars = sensors
            .iter()
            .enumerate()
            .map(|(index, &sensor)| Baseline {
                sensor,
                true_deg: of(index).next().map_or(f64::NAN, |radar| radar.true_deg),
                rte_m: mean(of(index).filter_map(|radar| radar.rte_true_m)),
            })
            .collect();
        let methods = (0..CANDIDATES.len()).map(|k| MethodResult::new(k, &sensors, &of)).collect();
        let convergence = CANDIDATES
            .iter()
            .filter(|candidate| candidate.convergence)
            .enumerate()
            .map(|(k, candidate)| {
                let all: Vec<&[PartRecord]> = records
                    .iter()
                    .flat_map(|r| r.radars.iter().filter_map(move |radar| radar.parts.get(k)))
                    .map(Vec::as_slice)
                    .collect();
                Convergence::new(candidate.name, &all)
            })
            .collect();
        let angles_deg = (0..CANDIDATES.len())
            .map(|k| {
                let third = records
                    .iter()
                    .map(|r| r.radars.iter().find(|radar| radar.sensor == FIGURE_RADAR));
                let angle =
                    |radar: &RadarRecord| Some(radar.true_deg + radar.estimates[k].error_deg?);
                third.map(|radar| radar.and_then(angle)).collect()
            })
            .collect();
        Self {
            name,
            scenes: records.len(),
            driven_km: records.iter().map(|record| record.driven_m).sum::<f64>() / 1e3,
            driven_h: records.iter().map(|record| record.driven_s).sum::<f64>() / 3600.0,
            moving_share: [shares.mean, shares.largest],
            radars,
            methods,
            convergence,
            angles_deg,
        }
    }

    fn tables(&self) -> String {
        let mut text = format!(
            "## {}: {} drives, {:.0} km, {:.1} h of driving, {:.0} % of detections moving (at most {:.0} %)\n\n",
            self.name,
            self.scenes,
            self.driven_km,
            self.driven_h,
            100.0 * self.moving_share[0],
            100.0 * self.moving_share[1],
        );
        let radars: Vec<String> = self
            .radars
            .iter()
            .map(|r| format!("radar {} ({:.2} deg)", r.sensor, r.true_deg))
            .collect();
        text += "Errors of the angle: mean in deg and variance in deg^2 (drives without an angle), the share of errors \
                 within one and two stated standard deviations (Tables II and IV), and how many answers are called converged and \
                 how many of these are more than three deviations off.\n\n";
        let cells = |method: &MethodResult| {
            let mut cells: Vec<String> = method
                .radars
                .iter()
                .map(|radar| {
                    let without = if radar.without > 0 {
                        format!(" ({})", radar.without)
                    } else {
                        String::new()
                    };
                    format!(
                        "{:+.4}, {:.4}{without}",
                        radar.error_deg.mean, radar.error_deg.variance
                    )
                })
                .collect();
            cells.push(percent(method.within));
            let sum = |of: fn(&RadarResult) -> usize| method.radars.iter().map(of).sum::<usize>();
            cells.push(format!("{}, {}", sum(|r| r.converged), sum(|r| r.confidently_wrong)));
            cells
        };
        let mut heads: Vec<&str> = radars.iter().map(String::as_str).collect();
        heads.extend(["within 1, 2 sigma", "converged, 3 sigma off"]);
        let rows: Vec<_> = self.methods.iter().map(|m| (m.name, cells(m))).collect();
        text += &table("method", &heads, &rows);
        text += &format!(
            "\nRelative trajectory error over {SEGMENT_M} m, m; the radar's motion is the tracked one throughout \
             (Table III).\n\n"
        );
        let mut rows: Vec<(&str, Vec<String>)> = self
            .methods
            .iter()
            .map(|m| (m.name, m.radars.iter().map(|r| format!("{:.3}", r.rte_m)).collect()))
            .collect();
        rows.push(("true angle", self.radars.iter().map(|r| format!("{:.3}", r.rte_m)).collect()));
        heads.truncate(heads.len() - 2);
        text += &table("angle from", &heads, &rows);
        text += "\nMean absolute error in deg and variance in deg^2 against driving time, radar 3 (Figure 6).\n\n";
        let times: Vec<String> = DRIVING_TIMES_S.iter().map(|time| format!("{time} s")).collect();
        let heads: Vec<&str> = times.iter().map(String::as_str).collect();
        let rows: Vec<_> = self
            .convergence
            .iter()
            .map(|c| {
                let cells = c.error_deg.iter().zip(&c.without).map(|(error, without)| {
                    let without =
                        if *without > 0 { format!(" ({without})") } else { String::new() };
                    format!("{:.3}, {:.4}{without}", error.mean_absolute, error.variance)
                });
                (c.name, cells.collect::<Vec<_>>())
            })
            .collect();
        text += &table("method", &heads, &rows);
        text += "\nScale of the yaw rate: mean error and standard deviation, and the share within one and two stated standard \
                 deviations.\n\n";
        let rows: Vec<_> = self
            .methods
            .iter()
            .filter_map(|m| {
                let [mean, sigma] = m.scale?;
                Some((m.name, vec![format!("{mean:+.4} +- {sigma:.4}"), percent(m.scale_within?)]))
            })
            .collect();
        text + &table("method", &["error", "within 1, 2 sigma"], &rows)
    }
}

impl MethodResult {
    fn new<'a, I: Iterator<Item = &'a RadarRecord>>(
        k: usize,
        sensors: &[u8],
        of: &impl Fn(usize) -> I,
    ) -> Self {
        let estimates = |index| of(index).filter_map(|radar| radar.estimates.get(k));
        let all = || (0..sensors.len()).flat_map(estimates);
        let scales: Vec<(f64, f64)> = all().filter_map(|e| e.scale).collect();
        let errors: Vec<f64> = scales.iter().map(|(error, _)| *error).collect();
        let summary = Summary::of(&errors);
        Self {
            name: CANDIDATES[k].name,
            radars: sensors
                .iter()
                .enumerate()
                .map(|(index, &sensor)| RadarResult::new(sensor, &|| estimates(index)))
                .collect(),
            within: within(all().filter_map(|e| Some((e.error_deg?, e.sigma_deg?)))),
            scale: (summary.count > 1).then(|| [summary.mean, summary.variance.sqrt()]),
            scale_within: (summary.count > 1).then(|| within(scales.into_iter())),
        }
    }
}

impl RadarResult {
    fn new<'a, I: Iterator<Item = &'a EstimateRecord>>(sensor: u8, of: &impl Fn() -> I) -> Self {
        let errors: Vec<f64> = of().filter_map(|e| e.error_deg).collect();
        let error_deg = Summary::of(&errors);
        Self {
            sensor,
            error_deg,
            mean_sigma_deg: error_deg.mean_sigma(),
            without: of().count() - errors.len(),
            converged: of().filter(|e| e.converged).count(),
            confidently_wrong: of().filter(|e| confidently_wrong(e)).count(),
            rte_m: mean(of().filter_map(|e| e.rte_m)),
        }
    }
}

impl Convergence {
    fn new(name: &'static str, parts: &[&[PartRecord]]) -> Self {
        let of = |i: usize| parts.iter().filter_map(move |part| part.get(i));
        let lengths = 0..DRIVING_TIMES_S.len();
        Self {
            name,
            driving_s: DRIVING_TIMES_S.to_vec(),
            error_deg: lengths
                .clone()
                .map(|i| {
                    let errors: Vec<f64> =
                        of(i).flat_map(|p| p.errors_deg.iter().copied()).collect();
                    Summary::of(&errors)
                })
                .collect(),
            without: lengths.map(|i| of(i).map(|part| part.without).sum()).collect(),
        }
    }
}

/// Whether an answer is called converged and lies more than three of its standard deviations off.
fn confidently_wrong(e: &EstimateRecord) -> bool {
    let off = e.error_deg.zip(e.sigma_deg).is_some_and(|(error, sigma)| error.abs() > 3.0 * sigma);
    e.converged && off
}

/// Share of errors within one and two standard deviations.
pub(super) fn within(errors: impl Iterator<Item = (f64, f64)>) -> [f64; 2] {
    let (mut one, mut two, mut all) = (0_usize, 0_usize, 0_usize);
    for (error, sigma) in errors {
        one += usize::from(error.abs() <= sigma);
        two += usize::from(error.abs() <= 2.0 * sigma);
        all += 1;
    }
    [one, two].map(|count| count as f64 / (all as f64).max(1.0))
}

fn mean(numbers: impl Iterator<Item = f64>) -> f64 {
    Summary::of(&numbers.collect::<Vec<_>>()).mean
}

pub(super) fn percent([one, two]: [f64; 2]) -> String {
    format!("{:.0} %, {:.0} %", 100.0 * one, 100.0 * two)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::experiment::Report as _;

    fn estimate(error_deg: Option<f64>, sigma_deg: f64) -> EstimateRecord {
        EstimateRecord {
            error_deg,
            sigma_deg: error_deg.map(|_| sigma_deg),
            scale: Some((0.02, 0.015)),
            used: 100,
            converged: error_deg.is_some(),
            rte_m: error_deg.map(f64::abs),
        }
    }

    fn scene(number: u64, error_deg: Option<f64>) -> SceneRecord {
        let part = |n: usize| PartRecord { errors_deg: vec![0.5; n], without: 1 };
        SceneRecord {
            scene: number,
            scenario: "city".into(),
            profile: DriveProfile::Clean,
            dense: number % 2 == 1,
            moving_share: 0.1 * number as f64,
            driven_m: 500.0,
            driven_s: 90.0,
            radars: vec![RadarRecord {
                sensor: 3,
                true_deg: 25.0,
                rte_true_m: Some(0.1),
                estimates: vec![estimate(error_deg, 0.17); CANDIDATES.len()],
                parts: vec![vec![part(2); DRIVING_TIMES_S.len()]; CANDIDATES.len()],
            }],
        }
    }

    #[test]
    fn tables_are_those_of_the_records() {
        let options = CalibrationExperiment { scenes: 4, seed: 0, duration_s: 120.0 };
        let errors = [Some(0.1), None, Some(-0.3), None, Some(0.5), None, None, None];
        let records = errors.iter().zip(0..).map(|(error, number)| scene(number, *error));
        let report = CalibrationReport::new(&options, records);
        let [mixed, dense, _, _] = &report.conditions[..] else { panic!("four conditions") };
        assert_eq!((mixed.scenes, dense.scenes), (4, 4));
        assert!((mixed.driven_km - 2.0).abs() < 1e-12 && (mixed.driven_h - 0.1).abs() < 1e-12);
        assert!((mixed.moving_share[0] - 0.3).abs() < 1e-12);
        let method = &mixed.methods[0];
        let radar = &method.radars[0];
        assert_eq!((radar.error_deg.count, radar.without, radar.converged), (3, 1, 3));
        assert!((radar.error_deg.mean - 0.1).abs() < 1e-12);
        assert!((radar.error_deg.variance - 0.16).abs() < 1e-12);
        assert!((radar.rte_m - 0.3).abs() < 1e-12);
        // Of 0.1, 0.3 and 0.5 at 0.17 one lies within one deviation and two within two.
        assert!((method.within[0] - 1.0 / 3.0).abs() < 1e-12);
        assert!((method.within[1] - 2.0 / 3.0).abs() < 1e-12);
        assert_eq!(method.scale_within, Some([0.0, 1.0]));
        assert_eq!(mixed.angles_deg[0], [Some(25.1), Some(24.7), Some(25.5), None]);
        let curve = &mixed.convergence[0];
        assert_eq!((curve.error_deg[0].count, curve.without[0]), (8, 4));
        assert_eq!(dense.methods[0].radars[0].without, 4);
        assert!(report.tables().contains("| +0.1000, 0.1600 (1) | 33 %, 67 % | 3, 0 |"));
    }
}
