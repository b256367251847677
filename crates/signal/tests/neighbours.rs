//! Two targets beside each other by every kind of CFAR, and what each costs: the table of docs/detection.md, which
//! `cargo test -p boresight-signal --test neighbours -- --nocapture` prints.

#![allow(clippy::unwrap_used)]

use boresight_core::{Complex32, Complex64, Multiplexing, Random, Sampling, Waveform};
use boresight_signal::peaks::group_peaks;
use boresight_signal::{
    Cfar, CfarKind, CfarOptions, RangeDoppler, RangeDopplerMap, RangeDopplerOptions, Window,
};
use ndarray::Array4;
use std::f64::consts::TAU;

const SAMPLES: usize = 64;
const LOOPS: usize = 16;
const WEAKER_DB: f64 = -3.4;

/// Kinds with the rank of the ordered statistic.
const KINDS: [(&str, CfarKind, f64); 6] = [
    ("excision", CfarKind::Excision, 0.75),
    ("cell averaging", CfarKind::CellAveraging, 0.75),
    ("greatest of", CfarKind::GreatestOf, 0.75),
    ("smallest of", CfarKind::SmallestOf, 0.75),
    ("ordered statistic, rank 0.75", CfarKind::OrderedStatistic, 0.75),
    ("ordered statistic, rank 0.5", CfarKind::OrderedStatistic, 0.5),
];

/// A tone: range bin, Doppler bin, and power of a sample.
type Tone = [f64; 3];

struct Scene {
    plan: RangeDoppler,
    map: RangeDopplerMap,
    receivers: usize,
    padding: usize,
}

impl Scene {
    fn new(receivers: usize, window: Window, padding: usize) -> Self {
        let waveform = Waveform {
            start_frequency_hz: 77e9,
            slope_hz_per_s: 60e12,
            sample_rate_hz: 5e6,
            sampling: Sampling::Complex,
            samples: SAMPLES,
            adc_start_s: 0.0,
            chirp_interval_s: 20e-6,
            transmitters: 1,
            loops: LOOPS,
            frame_interval_s: 1e-3,
            multiplexing: Multiplexing::TimeDivision,
            doppler_bands: None,
        };
        let options = RangeDopplerOptions {
            range_window: window,
            doppler_window: window,
            range_padding: padding,
            doppler_padding: padding,
            ..RangeDopplerOptions::default()
        };
        let plan = RangeDoppler::new(&waveform, receivers, &options).unwrap();
        let map = plan.output();
        Self { plan, map, receivers, padding }
    }

    /// As the chain plans it.
    fn cfar(&self, kind: CfarKind, rank: f64, false_alarm: f64) -> Cfar {
        let base = CfarOptions::default();
        let options = CfarOptions {
            kind,
            rank,
            false_alarm,
            looks: self.receivers,
            noise: self.plan.bin_noise(),
            guard_cells: base.guard_cells.map(|cells| cells * self.padding),
            training_cells: base.training_cells.map(|cells| cells * self.padding),
            ..base
        };
        let (ranges, dopplers) = self.map.power.dim();
        Cfar::new(ranges, dopplers, &options).unwrap()
    }

    /// Transforms tones of random phases in noise of power 1 a sample.
    fn transform(&mut self, tones: &[Tone], random: &mut Random) {
        let mut frame = Array4::from_shape_fn((LOOPS, 1, self.receivers, SAMPLES), |_| {
            random.complex_normal(1.0)
        });
        for &[range, doppler, power] in tones {
            for receiver in 0..self.receivers {
                let phase = TAU * random.unit();
                for l in 0..LOOPS {
                    for n in 0..SAMPLES {
                        let turn =
                            range * n as f64 / SAMPLES as f64 + doppler * l as f64 / LOOPS as f64;
                        frame[[l, 0, receiver, n]] +=
                            Complex64::from_polar(power.sqrt(), phase + TAU * turn);
                    }
                }
            }
        }
        let frame = frame.mapv(|z| Complex32::new(z.re as f32, z.im as f32));
        self.plan.process(frame.view(), &mut self.map).unwrap();
    }

    /// Mean noise power of a cell.
    fn noise(&mut self) -> f64 {
        let mut random = Random::new(5, 0);
        let mut sum = 0.0;
        for _ in 0..100 {
            self.transform(&[], &mut random);
            sum += f64::from(self.map.power.mean().unwrap());
        }
        sum / 100.0
    }
}

/// Share of 1000 frames in which each kind finds both targets; the cell of the stronger one has `cell_db` over noise.
fn found(receivers: usize, cell_db: f64) -> Vec<f64> {
    let mut scene = Scene::new(receivers, Window::Hann, 1);
    let noise = scene.noise();
    let power = noise * 10f64.powf(cell_db / 10.0);
    let weaker = power * 10f64.powf(WEAKER_DB / 10.0);
    let mut cfars = KINDS.map(|(_, kind, rank)| scene.cfar(kind, rank, 1e-6));
    let mut counts = [0; KINDS.len()];
    let mut random = Random::new(11, 0);
    for frame in 0..1000 {
        let apart = 4.0 + 8.0 * random.unit();
        let first = 20.0 + 10.0 * random.unit();
        let doppler = LOOPS as f64 * random.unit();
        let other = if frame % 2 == 0 { first + apart } else { first - apart };
        scene.transform(&[[first, doppler, power], [other, doppler, weaker]], &mut random);
        for (cfar, count) in cfars.iter_mut().zip(&mut counts) {
            let power = scene.map.power.view();
            let over = cfar.detect(power).unwrap();
            let peaks = group_peaks(power, &over).peaks;
            let is_there = |range: f64| {
                let zero = LOOPS as f64 / 2.0;
                peaks.iter().any(|peak| {
                    let turn = (peak.doppler_bin - zero - doppler).rem_euclid(LOOPS as f64);
                    (peak.range_bin - range).abs() < 1.0 && turn.min(LOOPS as f64 - turn) < 1.0
                })
            };
            *count += i32::from(is_there(first) && is_there(other));
        }
    }
    counts.map(|count| f64::from(count) / 1000.0).to_vec()
}

/// Where false alarms are counted.
#[derive(Clone, Copy, PartialEq)]
enum Place {
    Everywhere,
    Edges,
    /// Noise among whose training cells is a target of 40 dB.
    BesideTarget,
}

/// Rates over asked ones, with their standard errors.
fn rates(scene: &mut Scene, place: Place, asked: f64, frames: usize) -> Vec<[f64; 2]> {
    let noise = scene.noise();
    let middle = 32.0;
    let tones = [[middle, 0.0, noise * 1e4]];
    let tones = if place == Place::BesideTarget { &tones[..] } else { &[] };
    let mut cfars = KINDS.map(|(_, kind, rank)| scene.cfar(kind, rank, asked));
    let (ranges, dopplers) = scene.map.power.dim();
    let reach = 12 * scene.padding;
    let counted = move |r: usize, d: usize| match place {
        Place::Everywhere => true,
        Place::Edges => r < reach || r + reach >= ranges,
        Place::BesideTarget => {
            d == dopplers / 2 && (5.0..=12.0).contains(&(r as f64 - middle).abs())
        }
    };
    let cells = (0..ranges * dopplers).filter(|k| counted(k / dopplers, k % dopplers)).count();
    let mut random = Random::new(23, 0);
    let mut all = vec![vec![]; KINDS.len()];
    let trials: Vec<Vec<f64>> = (0..frames)
        .map(|_| {
            scene.transform(tones, &mut random);
            let power = scene.map.power.view();
            cfars
                .iter_mut()
                .map(|cfar| {
                    let over = cfar.detect(power).unwrap();
                    let there = over.iter().filter(|d| counted(d.range_bin, d.doppler_bin));
                    there.count() as f64 / cells as f64 / asked
                })
                .collect()
        })
        .collect();
    for trial in trials {
        trial.into_iter().zip(&mut all).for_each(|(rate, all)| all.push(rate));
    }
    let n = frames as f64;
    all.iter()
        .map(|rates: &Vec<f64>| {
            let mean = rates.iter().sum::<f64>() / n;
            let variance = rates.iter().map(|r| (r - mean).powi(2)).sum::<f64>() / (n - 1.0);
            [mean, (variance / n).sqrt()]
        })
        .collect()
}

/// Mean threshold in noise over the one of known noise, dB: the average detection threshold of Rohling (1983).
fn loss_db(receivers: usize) -> Vec<f64> {
    let mut scene = Scene::new(receivers, Window::Rectangular, 1);
    let known = CfarOptions {
        looks: receivers,
        training_cells: [2048, 0],
        guard_cells: [0, 0],
        ..CfarOptions::default()
    };
    let known = CfarOptions { kind: CfarKind::CellAveraging, ..known };
    let known = Cfar::new(8192, 1, &known).unwrap().rows()[4096].1.threshold * scene.noise();
    let mut cfars = KINDS.map(|(_, kind, rank)| scene.cfar(kind, rank, 1e-6));
    let mut sums = [0.0; KINDS.len()];
    let mut random = Random::new(31, 0);
    for _ in 0..200 {
        scene.transform(&[], &mut random);
        for (cfar, sum) in cfars.iter_mut().zip(&mut sums) {
            let column = cfar.thresholds(scene.map.power.view(), 3).unwrap();
            *sum += column[12..52].iter().map(|cell| cell.threshold).sum::<f64>() / 40.0 / 200.0;
        }
    }
    sums.map(|threshold| 10.0 * (threshold / known).log10()).to_vec()
}

/// Columns: loss with 1 and 8 looks; both targets found with 8 looks; false alarms beside a target.
#[test]
fn excision_finds_both_and_keeps_the_rate() {
    let losses = [1, 8].map(loss_db);
    // 15 dB a sample are 15 + 10 lg(64 16) - 2 * 1.76 in the cell under two Hann windows.
    let sample = 15.0 + 10.0 * ((SAMPLES * LOOPS) as f64).log10() - 3.52;
    let cases = [
        ("15 dB a sample", 8, sample),
        ("stronger's cell", 8, 15.0),
        ("weaker's cell", 8, 15.0 - WEAKER_DB),
        ("stronger's cell, 1 look", 1, 15.0),
    ];
    let shares: Vec<Vec<f64>> = cases.iter().map(|&(_, looks, db)| found(looks, db)).collect();
    let beside: Vec<_> = [1, 8]
        .map(|looks| {
            rates(&mut Scene::new(looks, Window::Hann, 1), Place::BesideTarget, 1e-2, 2500)
        })
        .into();
    println!(
        "| Kind | loss, 1 look (dB) | loss, 8 looks (dB) | {} | rate beside, 1 look | 8 looks |",
        cases.map(|c| c.0).join(" | ")
    );
    for (k, (name, ..)) in KINDS.iter().enumerate() {
        let found: Vec<_> = shares.iter().map(|s| format!("{:.1} %", 100.0 * s[k])).collect();
        println!(
            "| {name} | {:.2} | {:.2} | {} | {:.2} | {:.2} |",
            losses[0][k],
            losses[1][k],
            found.join(" | "),
            beside[0][k][0],
            beside[1][k][0]
        );
    }
    for (share, (name, ..)) in shares[..3].iter().zip(&cases) {
        assert!(share[0] >= 0.99, "{name}: {}", share[0]);
    }
    assert_eq!(CfarOptions::default().kind, KINDS[0].1);
    // What cell averaging loses.
    assert!(shares[1][1] < 0.5, "{}", shares[1][1]);
    for rate in &beside {
        keeps(rate[0], "beside a target");
    }
}

/// Between 0.3 and 1 of the asked rate, as far as trials tell.
fn keeps([mean, error]: [f64; 2], what: &str) {
    assert!(error < 0.12 * mean, "{what}: {mean:.3} +- {error:.3}");
    assert!(mean > 0.3 && mean - 3.0 * error < 1.0, "{what}: {mean:.3} +- {error:.3}");
}

#[test]
fn the_rate_of_excision_holds_behind_windows_padding_and_at_edges() {
    let cases = [
        (1, Window::Rectangular, 1, 300),
        (8, Window::Rectangular, 1, 300),
        (1, Window::Hann, 1, 600),
        (8, Window::Hann, 1, 400),
        (1, Window::Hann, 2, 300),
        (8, Window::Hann, 2, 200),
        (4, Window::Chebyshev { sidelobe_db: 80.0 }, 1, 400),
        (64, Window::Hann, 1, 100),
    ];
    for (looks, window, padding, frames) in cases {
        for place in [Place::Everywhere, Place::Edges] {
            let asked = if place == Place::Edges { 3e-3 } else { 1e-3 };
            let rate = rates(&mut Scene::new(looks, window, padding), place, asked, frames)[0];
            let what = format!(
                "{looks} looks, {window:?}, padding {padding}, edges {}",
                place == Place::Edges
            );
            println!("{what}: {:.2} +- {:.2}", rate[0], rate[1]);
            keeps(rate, &what);
        }
    }
}
