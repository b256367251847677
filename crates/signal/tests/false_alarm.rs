//! Measured false-alarm rates of every kind of CFAR, inside the map and at its edges.

#![allow(clippy::unwrap_used)]

use boresight_core::{Complex32, Multiplexing, Random, Sampling, Waveform};
use boresight_signal::{
    Cfar, CfarAxes, CfarKind, CfarOptions, RangeDoppler, RangeDopplerOptions, Window,
};
use ndarray::{Array2, Array4};

const RANGES: usize = 36;
const DOPPLERS: usize = 24;
const FALSE_ALARM: f64 = 0.01;

const KINDS: [CfarKind; 5] = [
    CfarKind::Excision,
    CfarKind::CellAveraging,
    CfarKind::GreatestOf,
    CfarKind::SmallestOf,
    CfarKind::OrderedStatistic,
];

/// Maps whose cells are means of `looks` exponential powers.
fn noise_maps(count: u64, looks: usize) -> Vec<Array2<f32>> {
    (0..count)
        .map(|stream| {
            let mut random = Random::new(42, stream);
            Array2::from_shape_fn((RANGES, DOPPLERS), |_| {
                let product: f64 = (0..looks).map(|_| 1.0 - random.unit()).product();
                (-product.ln() / looks as f64) as f32
            })
        })
        .collect()
}

/// Mean and its standard error, over maps: cells of one map share training cells, maps nothing.
fn mean_and_error(rates: &[f64]) -> (f64, f64) {
    let n = rates.len() as f64;
    let mean = rates.iter().sum::<f64>() / n;
    let variance = rates.iter().map(|r| (r - mean).powi(2)).sum::<f64>() / (n - 1.0);
    (mean, (variance / n).sqrt())
}

/// Rates of each map, over the rows where the window is whole and over the others.
fn measure(maps: &[Array2<f32>], options: &CfarOptions) -> [Vec<f64>; 2] {
    let mut cfar = Cfar::new(RANGES, DOPPLERS, options).unwrap();
    let fullest = cfar.rows().iter().map(|(cells, _)| cells.total()).max().unwrap();
    let whole: Vec<bool> = cfar.rows().iter().map(|(cells, _)| cells.total() == fullest).collect();
    let mut rates = [vec![], vec![]];
    for map in maps {
        let detections = cfar.detect(map.view()).unwrap();
        for (inside, rates) in [true, false].into_iter().zip(&mut rates) {
            let rows = whole.iter().filter(|&&w| w == inside).count();
            let found = detections.iter().filter(|d| whole[d.range_bin] == inside).count();
            if rows > 0 {
                rates.push(found as f64 / (rows * DOPPLERS) as f64);
            }
        }
    }
    rates
}

/// 300 maps of 864 cells: the standard error of each rate is 2 to 5 % of it, taken from the maps
/// themselves; five of them, so that one check in two million fails by chance.
#[test]
fn rates_are_as_asked_inside_and_at_edges() {
    for looks in [1, 8] {
        let maps = noise_maps(300, looks);
        for kind in KINDS {
            for axes in [CfarAxes::Range, CfarAxes::Doppler, CfarAxes::Both] {
                let options = CfarOptions {
                    kind,
                    axes,
                    false_alarm: FALSE_ALARM,
                    guard_cells: [1, 1],
                    training_cells: [5, 3],
                    looks,
                    ..CfarOptions::default()
                };
                for (place, rates) in ["inside", "edges"].iter().zip(measure(&maps, &options)) {
                    if rates.is_empty() {
                        continue;
                    }
                    let (mean, error) = mean_and_error(&rates);
                    assert!(error < 0.08 * FALSE_ALARM, "{error}");
                    assert!(
                        (mean - FALSE_ALARM).abs() < 5.0 * error,
                        "{kind:?} {axes:?} looks {looks} {place}: {mean:.5} +- {error:.5}"
                    );
                }
            }
        }
    }
}

/// A low rate, where the tails of the distributions count: 1e-4 over 3 million cells, 300 alarms
/// give a standard error near 6 %.
#[test]
fn low_rates_are_as_asked() {
    let maps = noise_maps(3500, 2);
    for kind in KINDS {
        let options = CfarOptions {
            kind,
            axes: CfarAxes::Range,
            false_alarm: 1e-4,
            guard_cells: [1, 0],
            training_cells: [6, 0],
            looks: 2,
            ..CfarOptions::default()
        };
        let mut cfar = Cfar::new(RANGES, DOPPLERS, &options).unwrap();
        let cells = (RANGES * DOPPLERS) as f64;
        let rates: Vec<f64> =
            maps.iter().map(|m| cfar.detect(m.view()).unwrap().len() as f64 / cells).collect();
        let (mean, error) = mean_and_error(&rates);
        assert!((mean - 1e-4).abs() < 5.0 * error && error < 1e-5, "{kind:?}: {mean} +- {error}");
    }
}

#[test]
fn noise_power_is_without_bias() {
    let maps = noise_maps(60, 4);
    for kind in KINDS {
        let options = CfarOptions {
            kind,
            axes: CfarAxes::Both,
            false_alarm: 0.5,
            guard_cells: [1, 1],
            training_cells: [4, 3],
            looks: 4,
            ..CfarOptions::default()
        };
        let mut cfar = Cfar::new(RANGES, DOPPLERS, &options).unwrap();
        let means: Vec<f64> = maps
            .iter()
            .map(|map| {
                let found = cfar.detect(map.view()).unwrap();
                found.iter().map(|d| d.noise_power).sum::<f64>() / found.len() as f64
            })
            .collect();
        // Cells over half the median noise choose training cells below it a little.
        let (mean, _) = mean_and_error(&means);
        assert!((mean - 1.0).abs() < 0.03, "{kind:?}: {mean}");
    }
}

/// Noise through a transform of 64 samples and 32 chirps.
fn windowed_maps(
    window: Window,
    padding: usize,
    looks: usize,
    count: u64,
) -> (RangeDoppler, Vec<Array2<f32>>) {
    let waveform = Waveform {
        start_frequency_hz: 77e9,
        slope_hz_per_s: 60e12,
        sample_rate_hz: 5e6,
        sampling: Sampling::Complex,
        samples: 64,
        adc_start_s: 0.0,
        chirp_interval_s: 20e-6,
        transmitters: 1,
        loops: 32,
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
    let mut plan = RangeDoppler::new(&waveform, looks, &options).unwrap();
    let mut map = plan.output();
    let mut random = Random::new(9, looks as u64);
    let maps = (0..count)
        .map(|_| {
            let frame = Array4::from_shape_fn((32, 1, looks, 64), |_| {
                let z = random.complex_normal(1.0);
                Complex32::new(z.re as f32, z.im as f32)
            });
            plan.process(frame.view(), &mut map).unwrap();
            map.power.clone()
        })
        .collect();
    (plan, maps)
}

/// A window makes neighbouring cells alike, so that fewer of them count: the rate is between 0.8 and 1.1 of the one asked
/// for, with the guard cells of the defaults. `BORESIGHT_MAPS` sets the number of maps, of 2048 cells each; five standard
/// errors, taken from the maps themselves, are allowed for chance.
#[test]
fn windowed_noise_keeps_the_rate() {
    let count = std::env::var("BORESIGHT_MAPS").ok().and_then(|text| text.parse().ok());
    let count = count.unwrap_or(60);
    let chebyshev = Window::Chebyshev { sidelobe_db: 80.0 };
    let taylor = Window::Taylor { nbar: 4, sidelobe_db: 40.0 };
    let cases = [
        (Window::Rectangular, 1, 1),
        (Window::Hann, 1, 1),
        (Window::Hann, 1, 4),
        (Window::Hann, 2, 1),
        (Window::Hamming, 1, 1),
        (Window::Blackman, 1, 1),
        (Window::BlackmanHarris, 1, 1),
        (chebyshev, 1, 1),
        (chebyshev, 1, 4),
        (taylor, 1, 1),
    ];
    let mut misses = vec![];
    for (window, padding, looks) in cases {
        let (plan, maps) = windowed_maps(window, padding, looks, count);
        let (ranges, dopplers) = maps[0].dim();
        for false_alarm in [1e-2, 1e-3] {
            for axes in [CfarAxes::Range, CfarAxes::Doppler, CfarAxes::Both] {
                for kind in KINDS {
                    let options = CfarOptions {
                        kind,
                        axes,
                        false_alarm,
                        guard_cells: [4 * padding, 2 * padding],
                        training_cells: [8 * padding, 4 * padding],
                        looks,
                        noise: plan.bin_noise(),
                        ..CfarOptions::default()
                    };
                    let mut cfar = Cfar::new(ranges, dopplers, &options).unwrap();
                    let wanted = false_alarm * (ranges * dopplers) as f64;
                    let share =
                        |map: &Array2<f32>| cfar.detect(map.view()).unwrap().len() as f64 / wanted;
                    let (rate, error) = mean_and_error(&maps.iter().map(share).collect::<Vec<_>>());
                    let text = format!(
                        "{window:?} x{padding} {looks} looks {false_alarm} {axes:?} {kind:?}: {rate:.3} +- {error:.3}"
                    );
                    println!("{text}");
                    if rate < 0.8 - 5.0 * error || rate > 1.1 + 5.0 * error {
                        misses.push(text);
                    }
                }
            }
        }
    }
    assert!(misses.is_empty(), "{misses:#?}");
}
