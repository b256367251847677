//! From records to tables.

use super::limit::{resolution_limit, separation_sigma};
use super::trial::{Plan, ResolutionRecord};
use super::{ResolutionExperiment, SEPARATIONS, SNRS_DB, figures};
use boresight_validate::table::{Best, Cell, Table, Tables};
use serde::Serialize;

/// The experiment's result.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct ResolutionReport {
    /// Array.
    pub array: String,
    /// Trials a condition.
    pub trials: u64,
    /// Seed.
    pub seed: u64,
    /// Width of the beam at half power, on boresight, deg.
    pub beam_deg: f64,
    /// Separations, beam widths.
    pub separations: Vec<f64>,
    /// The same on boresight, deg.
    pub separations_deg: Vec<f64>,
    /// Results by number of snapshots and signal-to-noise ratio.
    pub conditions: Vec<ConditionResult>,
}

/// Results with one number of snapshots at one signal-to-noise ratio.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct ConditionResult {
    /// Snapshots.
    pub snapshots: usize,
    /// Signal-to-noise ratio, dB.
    pub snr_db: f64,
    /// Statistical resolution limit, beam widths, where there is one.
    pub limit: Option<f64>,
    /// Probability with which an estimator at the bound with normal errors would resolve, by separation.
    pub efficient: Vec<f64>,
    /// Methods.
    pub methods: Vec<MethodResult>,
}

/// A method in one condition.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct MethodResult {
    /// Name.
    pub name: String,
    /// Share of trials resolved, by separation.
    pub resolved: Vec<f64>,
    /// Separation from which on half of the trials and more are resolved, beam widths, interpolated; none where that
    /// is not reached.
    pub half: Option<f64>,
}

impl ResolutionReport {
    pub(super) fn new(
        options: &ResolutionExperiment,
        plan: &Plan,
        records: impl Iterator<Item = ResolutionRecord>,
    ) -> Self {
        let mut sums: Vec<(u32, Vec<u32>)> = options.conditions().map(|_| (0, vec![])).collect();
        for record in records {
            let Some((trials, resolved)) = sums.get_mut(record.condition) else { continue };
            *trials += record.trials;
            resolved.resize(record.resolved.len(), 0);
            resolved.iter_mut().zip(&record.resolved).for_each(|(to, from)| *to += from);
        }
        let mut sums = sums.chunks_exact(SEPARATIONS.len());
        let mut conditions = vec![];
        for (&snapshots, candidates) in options.snapshots.iter().zip(&plan.candidates) {
            for snr_db in SNRS_DB {
                let Some(sums) = sums.next() else { continue };
                let methods = candidates.iter().enumerate().map(|(k, candidate)| {
                    let share = |(trials, resolved): &(u32, Vec<u32>)| {
                        resolved.get(k).map_or(f64::NAN, |&n| f64::from(n) / f64::from(*trials))
                    };
                    let resolved: Vec<f64> = sums.iter().map(share).collect();
                    let half = crossing(&resolved);
                    MethodResult { name: candidate.name.clone(), resolved, half }
                });
                conditions.push(ConditionResult {
                    snapshots,
                    snr_db,
                    methods: methods.collect(),
                    ..theory(plan, snr_db, snapshots)
                });
            }
        }
        let degrees = |beams: f64| 2.0 * (0.5 * beams * plan.beam).min(1.0).asin().to_degrees();
        Self {
            array: options.array.clone(),
            trials: options.trials,
            seed: options.seed,
            beam_deg: degrees(1.0),
            separations: SEPARATIONS.to_vec(),
            separations_deg: SEPARATIONS.map(degrees).to_vec(),
            conditions,
        }
    }
}

/// A condition with what theory says of it.
fn theory(plan: &Plan, snr_db: f64, snapshots: usize) -> ConditionResult {
    let array = plan.array();
    let largest = SEPARATIONS[SEPARATIONS.len() - 1] * plan.beam;
    let limit = resolution_limit(array, snr_db, snapshots, largest).ok().flatten();
    let efficient = SEPARATIONS.map(|beams| {
        let separation = beams * plan.beam;
        let sigma = separation_sigma(array, separation, snr_db, snapshots);
        // Both errors are below half the separation where the error of the separation is below the separation, the
        // middle of near targets being known far better.
        sigma.map_or(f64::NAN, |sigma| libm::erf(separation / (sigma * 2.0_f64.sqrt())))
    });
    ConditionResult {
        snapshots,
        snr_db,
        limit: limit.map(|sine| sine / plan.beam),
        efficient: efficient.to_vec(),
        methods: vec![],
    }
}

/// A number of snapshots in words.
pub(super) fn counted(snapshots: usize) -> String {
    format!("{snapshots} snapshot{}", if snapshots == 1 { "" } else { "s" })
}

/// Separation above which all shares are at least a half.
fn crossing(shares: &[f64]) -> Option<f64> {
    let below = shares.iter().rposition(|share| share.is_nan() || *share < 0.5);
    let Some(below) = below else { return Some(SEPARATIONS[0]) };
    let (&low, &high) = (shares.get(below)?, shares.get(below + 1)?);
    let (from, to) = (SEPARATIONS[below], SEPARATIONS[below + 1]);
    Some(from + (to - from) * (0.5 - low) / (high - low))
}

impl boresight_validate::experiment::Report for ResolutionReport {
    fn tables(&self) -> Tables {
        let remark = format!(
            "Array {}, beam of {:.2} deg at half power on boresight, {} trials a condition.\n",
            self.array, self.beam_deg, self.trials
        );
        let beams = |beams: Option<f64>| {
            beams.map_or(Cell::text("-"), |b| {
                Cell::shown(b, format!("{b:.2} ({:.2})", b * self.beam_deg))
            })
        };
        let of_group = |group: &[ConditionResult]| {
            let first = group.first()?;
            let mut table = Table::new(
                format!(
                    "Separation from which on half of the trials are resolved, beam widths (deg), {}.",
                    counted(first.snapshots)
                ),
                Best::Smallest,
                "method",
                group.iter().map(|c| format!("{} dB", c.snr_db)),
                first.methods.iter().enumerate().map(|(k, m)| {
                    (&m.name, group.iter().map(|c| beams(c.methods[k].half)).collect())
                }),
            );
            let limits = group.iter().map(|c| beams(c.limit).reference()).collect();
            table.rows.push(("limit (Smith 2005)".into(), limits));
            Some(table)
        };
        let groups = self.conditions.chunk_by(|a, b| a.snapshots == b.snapshots);
        Tables { remark, tables: groups.filter_map(of_group).collect() }
    }

    fn csv(&self) -> String {
        let mut text =
            "snapshots,snr_db,separation_beams,separation_deg,method,resolved\n".to_owned();
        for c in &self.conditions {
            let rows = c.methods.iter().map(|m| (m.name.as_str(), &m.resolved));
            for (name, resolved) in rows.chain([("efficient", &c.efficient)]) {
                let separations = self.separations.iter().zip(&self.separations_deg);
                for ((beams, degrees), share) in separations.zip(resolved) {
                    let (snapshots, snr_db) = (c.snapshots, c.snr_db);
                    text += &format!("{snapshots},{snr_db},{beams},{degrees},\"{name}\",{share}\n");
                }
            }
        }
        text
    }

    const FIGURES: &'static [&'static str] = &["resolution.svg"];

    fn figures(&self) -> Vec<String> {
        vec![figures::probabilities(self)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_crossing_is_the_last_one() {
        let mut shares = [1.0; SEPARATIONS.len()];
        assert_eq!(crossing(&shares), Some(SEPARATIONS[0]));
        shares[..4].copy_from_slice(&[0.6, 0.1, 0.6, 0.25]);
        // A third of the way from a share of 0.25 to one of 1.
        assert!((crossing(&shares).unwrap_or_default() - (0.3 + 0.1 / 3.0)).abs() < 1e-12);
        assert_eq!(crossing(&[0.0; SEPARATIONS.len()]), None);
        assert_eq!(crossing(&[f64::NAN; SEPARATIONS.len()]), None);
    }
}
