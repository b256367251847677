//! The conditions.

use crate::aoa::Condition;
use crate::aoa::score::WITHIN_RAD;
use boresight_core::imperfections::ImperfectionSpread;
use serde::Serialize;

/// The array of most conditions, that of the other experiments.
const LRR48: &str = "lrr48";
/// Half a degree in halves of the main beam of [`LRR48`], 2/92 in sine: how near a prediction has to be on any array.
const WITHIN_BEAMS: f64 = WITHIN_RAD * 92.0 / 2.0;
/// How near a prediction has to be in a pair, relative to its separation, where that is less.
const WITHIN_PAIR: f64 = 0.45;
/// Signal-to-noise ratio where noise does not limit, dB.
const USUAL_DB: f64 = 25.0;

/// What a condition has of what is hard.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Group {
    /// More noise than in the paper.
    Noise,
    /// More targets than in the paper.
    Targets,
    /// Two close targets.
    Pairs,
    /// Other arrays, most of them short.
    Arrays,
    /// Errors of the array that no method knows of.
    Imperfections,
}

impl Group {
    /// All of them.
    pub const ALL: [Self; 5] =
        [Self::Noise, Self::Targets, Self::Pairs, Self::Arrays, Self::Imperfections];

    /// Title of its table.
    pub fn title(self) -> &'static str {
        match self {
            Self::Noise => "Low signal-to-noise ratio",
            Self::Targets => "Many targets",
            Self::Pairs => "Two close targets",
            Self::Arrays => "Other arrays",
            Self::Imperfections => "Array errors",
        }
    }
}

/// A condition.
#[derive(Debug, Clone, PartialEq)]
pub struct HardCondition {
    /// Which of all.
    pub group: Group,
    /// Name of the array.
    pub array: &'static str,
    /// How scenes are drawn.
    pub drawn: Condition,
    /// Errors of the array.
    pub imperfections: ImperfectionSpread,
    /// Name in tables.
    pub name: String,
}

impl HardCondition {
    fn new(group: Group, array: &'static str, drawn: Condition, name: String) -> Self {
        let imperfections = ImperfectionSpread::default();
        Self { group, array, drawn, imperfections, name }
    }

    /// Largest error of a right prediction, rad, on an array of that beam: half of its main beam, in sine.
    pub fn within_rad(&self, beam: f64) -> f64 {
        let least = self.drawn.pair_beams.map_or(f64::INFINITY, |apart| WITHIN_PAIR * apart);
        WITHIN_BEAMS.min(least) * beam
    }
}

/// All conditions.
pub fn all() -> Vec<HardCondition> {
    let mut all = vec![];
    for targets in [2, 6, 10] {
        for snr_db in [0.0, 5.0, 10.0] {
            let name = format!("{targets} targets, {snr_db} dB");
            let drawn = Condition::new(targets, snr_db);
            all.push(HardCondition::new(Group::Noise, LRR48, drawn, name));
        }
    }
    for targets in [12, 16] {
        for snr_db in [15.0, 25.0, 35.0] {
            let name = format!("{targets} targets, {snr_db} dB");
            let drawn = Condition::new(targets, snr_db);
            all.push(HardCondition::new(Group::Targets, LRR48, drawn, name));
        }
    }
    for beams in [0.5, 0.75, 1.0, 1.5, 2.0] {
        for snr_db in [15.0, 25.0, 35.0] {
            let name = format!("{beams} beamwidths, {snr_db} dB");
            let drawn = Condition { pair_beams: Some(beams), ..Condition::new(2, snr_db) };
            all.push(HardCondition::new(Group::Pairs, LRR48, drawn, name));
        }
    }
    let arrays: [(&str, &[usize]); 6] = [
        ("ula8", &[1, 2, 3]),
        ("awr1642", &[2]),
        ("ula12", &[2, 4]),
        ("awr1843", &[2]),
        ("ula16", &[2, 4]),
        ("cascade86", &[10, 16]),
    ];
    for (array, numbers) in arrays {
        for &targets in numbers {
            for snr_db in [15.0, USUAL_DB] {
                let s = if targets == 1 { "" } else { "s" };
                let name = format!("{array}, {targets} target{s}, {snr_db} dB");
                let drawn = Condition::new(targets, snr_db);
                all.push(HardCondition::new(Group::Arrays, array, drawn, name));
            }
        }
    }
    let none = ImperfectionSpread::default();
    let errors = [
        ("phases off by 5 deg", ImperfectionSpread { phase_rad: 5f64.to_radians(), ..none }),
        ("phases off by 15 deg", ImperfectionSpread { phase_rad: 15f64.to_radians(), ..none }),
        ("gains off by 1 dB", ImperfectionSpread { gain_db: 1.0, ..none }),
        ("positions off by 0.05 half wavelengths", ImperfectionSpread { position: 0.05, ..none }),
        ("coupling of -20 dB", ImperfectionSpread { coupling_db: Some(-20.0), ..none }),
    ];
    for (name, imperfections) in errors {
        let drawn = Condition::new(6, USUAL_DB);
        let name = format!("6 targets, {name}");
        let plain = HardCondition::new(Group::Imperfections, LRR48, drawn, name);
        all.push(HardCondition { imperfections, ..plain });
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_a_degree_is_right_on_the_long_array_and_less_in_close_pairs() {
        let within = |wanted: &str| {
            let all = all();
            let found = all.iter().find(|condition| condition.name == wanted);
            found.map(|condition| condition.within_rad(2.0 / 92.0).to_degrees())
        };
        let close = |given: Option<f64>, wanted: f64| {
            assert!(given.is_some_and(|given| (given - wanted).abs() < 0.005), "{given:?}");
        };
        close(within("6 targets, 0 dB"), 0.5);
        close(within("2 beamwidths, 15 dB"), 0.5);
        // 0.45 of 0.62 deg.
        close(within("0.5 beamwidths, 35 dB"), 0.28);
    }

    #[test]
    fn names_differ() {
        let mut names: Vec<String> = all().into_iter().map(|condition| condition.name).collect();
        let count = names.len();
        names.sort();
        names.dedup();
        assert_eq!(names.len(), count);
    }
}
