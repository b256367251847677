//! Range and Doppler transform and CFAR of a frame of 256 samples, 128 loops and 8 channels.

#![allow(missing_docs, clippy::unwrap_used)]

use boresight_core::{Complex32, Multiplexing, Random, Sampling, Waveform};
use boresight_signal::{Cfar, CfarKind, CfarOptions, RangeDoppler, RangeDopplerOptions};
use criterion::{Criterion, criterion_group, criterion_main};
use ndarray::Array4;
use std::hint::black_box;

fn chain(criterion: &mut Criterion) {
    let waveform = Waveform {
        start_frequency_hz: 77e9,
        slope_hz_per_s: 60e12,
        sample_rate_hz: 5.209e6,
        sampling: Sampling::Complex,
        samples: 256,
        adc_start_s: 7e-6,
        chirp_interval_s: 97.14e-6,
        transmitters: 2,
        loops: 128,
        frame_interval_s: 40e-3,
        multiplexing: Multiplexing::TimeDivision,
        doppler_bands: None,
    };
    let mut random = Random::new(1, 0);
    let frame = Array4::from_shape_fn((128, 2, 4, 256), |_| {
        let z = random.complex_normal(1.0);
        Complex32::new(z.re as f32, z.im as f32)
    });
    let mut plan = RangeDoppler::new(&waveform, 4, &RangeDopplerOptions::default()).unwrap();
    let mut map = plan.output();
    plan.process(frame.view(), &mut map).unwrap();
    let base = CfarOptions { looks: 8, noise: plan.bin_noise(), ..CfarOptions::default() };
    let mut group = criterion.benchmark_group("256x128x8");
    group.bench_function("range-doppler", |b| {
        b.iter(|| plan.process(black_box(frame.view()), &mut map).unwrap());
    });
    for (name, kind) in [
        ("cfar excision", CfarKind::Excision),
        ("cfar cell-averaging", CfarKind::CellAveraging),
        ("cfar greatest-of", CfarKind::GreatestOf),
        ("cfar ordered-statistic", CfarKind::OrderedStatistic),
    ] {
        let mut cfar = Cfar::new(256, 128, &CfarOptions { kind, ..base }).unwrap();
        group.bench_function(name, |b| {
            b.iter(|| cfar.detect(black_box(map.power.view())).unwrap());
        });
        group.bench_function(format!("{name} plan"), |b| {
            b.iter(|| Cfar::new(256, 128, black_box(&CfarOptions { kind, ..base })).unwrap());
        });
    }
    group.finish();
}

criterion_group!(benches, chain);
criterion_main!(benches);
