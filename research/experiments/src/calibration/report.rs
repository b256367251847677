//! From records of simulated drives to tables.

use super::CalibrationExperiment;
use super::scene::SceneRecord;
use boresight_simulate::drive::DriveProfile;
use boresight_validate::condition::Condition;
use boresight_validate::figures;
use boresight_validate::table::Tables;
use boresight_validate::tables::csv_heads;
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

impl CalibrationReport {
    /// From the records, in order.
    pub fn new(
        options: &CalibrationExperiment,
        records: impl Iterator<Item = SceneRecord>,
    ) -> Self {
        let records: Vec<SceneRecord> = records.collect();
        let condition = |(profile, dense, name): (DriveProfile, bool, &'static str)| {
            let of = records.iter().filter(|r| r.profile == profile && r.dense == dense);
            Condition::new(name, &of.map(|record| &record.whole).collect::<Vec<_>>())
        };
        Self {
            seed: options.seed,
            duration_s: options.duration_s,
            conditions: CONDITIONS.map(condition).into(),
        }
    }
}

impl boresight_validate::experiment::Report for CalibrationReport {
    fn tables(&self) -> Tables {
        Tables {
            remark: String::new(),
            tables: self.conditions.iter().flat_map(Condition::tables).collect(),
        }
    }

    fn csv(&self) -> String {
        csv_heads() + &self.conditions.iter().map(Condition::csv).collect::<String>()
    }

    const FIGURES: &'static [&'static str] = &[
        "convergence.svg",
        "states.svg",
        "angles.svg",
        "angles-dense.svg",
        "angles-radarscenes.svg",
        "angles-radarscenes-dense.svg",
    ];

    fn figures(&self) -> Vec<String> {
        let mut drawn =
            vec![figures::convergence(&self.conditions), figures::states(&self.conditions)];
        drawn.extend(self.conditions.iter().map(figures::angles));
        drawn
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use boresight_validate::accepted::Accepted;
    use boresight_validate::candidates::{CANDIDATES, DRIVING_TIMES_S, SEGMENTS_M};
    use boresight_validate::experiment::Report as _;
    use boresight_validate::whole::{
        Answer, BIN_COUNT, EstimateRecord, PartRecord, RadarRecord, WholeRecord, error_steps_deg,
    };

    fn estimate(error_deg: Option<f64>, sigma_deg: f64) -> EstimateRecord {
        EstimateRecord {
            error_deg,
            sigma_deg: error_deg.map(|_| sigma_deg),
            scale: Some((0.02, 0.015)),
            used: 100,
            converged: error_deg.is_some(),
            rte_m: [error_deg.map(f64::abs); SEGMENTS_M.len()],
        }
    }

    fn scene(number: u64, error_deg: Option<f64>) -> SceneRecord {
        let part = |n: usize| PartRecord {
            answers: vec![Answer { error_deg: 0.5, sigma_deg: 0.3, converged: true }; n],
            without: 1,
        };
        // As far off as the angle is, 3 m more.
        let off: Vec<f32> = error_steps_deg().map(|error| error.abs() as f32 + 3.0).collect();
        SceneRecord {
            scene: number,
            scenario: "city".into(),
            profile: DriveProfile::Clean,
            dense: number % 2 == 1,
            whole: WholeRecord {
                moving_share: Some(0.1 * number as f64),
                driven_m: 500.0,
                driven_s: 90.0,
                states: [vec![2; BIN_COUNT], vec![1; BIN_COUNT]],
                radars: vec![RadarRecord {
                    sensor: 3,
                    true_deg: 25.0,
                    rte_true_m: [Some(0.1); SEGMENTS_M.len()],
                    rte_off_m: [const { vec![] }; SEGMENTS_M.len()].map(|_: Vec<f32>| off.clone()),
                    estimates: vec![estimate(error_deg, 0.17); CANDIDATES.len()],
                    parts: vec![vec![part(2); DRIVING_TIMES_S.len()]; CANDIDATES.len()],
                }],
            },
        }
    }

    #[test]
    fn tables_are_those_of_the_records() {
        let options =
            CalibrationExperiment { scenes: 4, seed: 0, duration_s: 120.0, standing: false };
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
        assert!((radar.rte_m[1].unwrap() - 0.3).abs() < 1e-12);
        // The mean error is 0.1 deg.
        assert!(
            (radar.rte_mean_angle_m[1].unwrap() - 3.1).abs() < 1e-6,
            "{:?}",
            radar.rte_mean_angle_m
        );
        // Of 0.1, 0.3 and 0.5 at 0.17 one lies within one deviation and two within two.
        assert!((method.within[0] - 1.0 / 3.0).abs() < 1e-12);
        assert!((method.within[1] - 2.0 / 3.0).abs() < 1e-12);
        assert_eq!(method.scale_within, Some([0.0, 1.0]));
        assert_eq!(mixed.angles_deg[0], [Some(25.1), Some(24.7), Some(25.5), None]);
        let curve = &mixed.convergence[0];
        assert_eq!((curve.error_deg[0].count, curve.without[0]), (8, 4));
        assert_eq!(curve.within[0], [0.0, 1.0]);
        assert_eq!(curve.accepted[0], Accepted { precision: Some(0.0), recall: Some(2.0 / 3.0) });
        assert_eq!(mixed.states[0][7], 8);
        assert_eq!(dense.methods[0].radars[0].without, 4);
        assert!(
            report.tables().to_string().contains("| +0.1000, 0.1600 (1) | 33 %, 67 % | 3, 0 |")
        );
    }
}
