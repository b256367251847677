use super::patches::square;
use super::*;
use crate::drive::motion::TrueMotion;
use crate::drive::{DriveOptions, DriveProfile, RANGE_M, Scenario, SimulatedDrive, simulate_drive};
use boresight_core::drive::RADARSCENES_SENSORS;
use std::f64::consts::PI;

fn options(scenario: Scenario, seed: u64, duration_s: f64) -> DriveOptions {
    let profile = DriveProfile::Radarscenes;
    DriveOptions { profile, scenario, seed, duration_s, ..DriveOptions::default() }
}

fn drive(scenario: Scenario, seed: u64) -> SimulatedDrive {
    let options = DriveOptions { moving_share: Some(0.03), ..options(scenario, seed, 60.0) };
    simulate_drive(&options).unwrap()
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

fn deviation(values: &[f64]) -> f64 {
    let centre = mean(values);
    mean(&values.iter().map(|x| (x - centre) * (x - centre)).collect::<Vec<_>>()).sqrt()
}

/// Residuals of the detections labelled static of each scan of a radar at more than 5 m/s, about the
/// curve of the true motion the delay before, with their azimuths.
fn residuals(drive: &SimulatedDrive, sensor: u8) -> Vec<Vec<(f64, f64)>> {
    let truth = &drive.truth;
    let (_, at) = truth.sensors.iter().find(|(id, _)| *id == sensor).unwrap();
    let scans = drive.log.scans.iter().zip(&drive.moving).filter(|(s, _)| s.sensor == sensor);
    scans
        .map(|(scan, moving)| {
            (scan, moving, motion_at(&truth.motion, scan.time_s - truth.car.delay_s))
        })
        .filter(|(_, _, motion)| motion.speed_mps > 5.0)
        .map(|(scan, moving, motion)| {
            let [vx, vy] = motion.radar_velocity(at);
            let standing = scan.detections.iter().zip(moving).filter(|(_, moving)| !**moving);
            standing
                .map(|(d, _)| {
                    let azimuth = f64::from(d.azimuth_rad);
                    let curve = vx * azimuth.cos() + vy * azimuth.sin();
                    (azimuth, f64::from(d.range_rate_mps) + curve)
                })
                .collect()
        })
        .collect()
}

#[test]
fn heights_shorten_range_rates_by_the_cosine_of_elevation() {
    // 2.1 m above the radar, 21 m away: an angle whose sine is 0.1.
    let cos = elevation_cos(model::RADAR_HEIGHT_M + 2.1, 21.0).unwrap();
    assert!((cos - 0.99_f64.sqrt()).abs() < 1e-15);
    let highest = 21.0 * model::ELEVATION_RAD.sin();
    assert!(elevation_cos(model::RADAR_HEIGHT_M + 0.999 * highest, 21.0).is_some());
    assert!(elevation_cos(model::RADAR_HEIGHT_M + 1.001 * highest, 21.0).is_none());

    let motion = drive(Scenario::CountryRoad, 1).truth.motion;
    let options = DriveOptions::default();
    let radar = Radar {
        mounting: RADARSCENES_SENSORS[1].1,
        options: &options,
        motion: &motion,
        random: Random::new(0, 0),
        delay_s: 0.0,
        realism: None,
    };
    let fastest = motion.iter().max_by(|a, b| a.speed_mps.total_cmp(&b.speed_mps)).unwrap();
    let view = radar.view(fastest.time_s);
    let flat = Echo::new(21.0, 0.3, [0.0; 2], STATIC_CLASS);
    let high = Echo { elevation_cos: cos, ..Echo::new(21.0, 0.3, [0.0; 2], STATIC_CLASS) };
    let [flat, high] = [flat, high].map(|echo| radar.range_rate(&echo, &view, fastest));
    assert!(flat < -10.0 && (high / flat - cos).abs() < 1e-12, "{high} {flat}");
}

#[test]
fn static_detections_are_shortened_more_often_than_lengthened() {
    // Poles, trees and walls are seen up to 12 deg, where the cosine takes 2.2 % away: 0.3 m/s at
    // 15 m/s. Nothing lengthens a range rate; soft outliers go both ways.
    let (mut shorter, mut longer) = (0, 0);
    let drive = drive(Scenario::City, 3);
    for sensor in [2, 3] {
        let rates = residuals(&drive, sensor);
        for (azimuth, residual) in rates.into_iter().flatten() {
            if azimuth.abs() < 0.5 && (0.15..0.28).contains(&residual.abs()) {
                *(if residual > 0.0 { &mut shorter } else { &mut longer }) += 1;
            }
        }
    }
    assert!(shorter > longer + longer / 4, "{shorter} {longer}");
}

#[test]
fn azimuth_bias_is_smooth_over_15_deg_without_mean_and_belongs_to_the_car() {
    let curves: Vec<AzimuthBias> =
        (0..1000).map(|car| AzimuthBias::new(&mut Random::new(car, 0))).collect();
    for apart_deg in [5.0_f64, 15.0, 40.0] {
        let step = apart_deg.to_radians();
        let squares: Vec<f64> =
            curves.iter().map(|c| (c.at(0.5 * step) - c.at(-0.5 * step)).powi(2)).collect();
        // Whatever the mean that was taken away.
        let apart = step / model::BIAS_CORRELATION_RAD;
        let sigma = model::BIAS_SIGMA_RAD;
        let expected = 2.0 * sigma * sigma * (1.0 - (-0.5 * apart * apart).exp());
        // A variance of 1000 values is good to 4.5 %.
        assert!((mean(&squares) / expected - 1.0).abs() < 0.2, "{apart_deg} {}", mean(&squares));
    }
    let degrees = |deg: f64| deg.to_radians();
    for curve in &curves[..20] {
        let within: Vec<f64> =
            (-110..=110).map(|i| curve.at(degrees(0.5 * f64::from(i)))).collect();
        assert!(mean(&within).abs() < 1e-9);
    }
    let size = |deg: f64| {
        mean(&curves.iter().map(|c| c.at(degrees(deg)).powi(2)).collect::<Vec<_>>()).sqrt()
    };
    let growth = size(66.0) / size(50.0);
    assert!((growth / model::BIAS_EDGE_FACTOR - 1.0).abs() < 0.35, "{growth}");

    let biases = |seed: u64, car: u64| {
        let options = DriveOptions { car, ..options(Scenario::City, seed, 1.0) };
        simulate_drive(&options).unwrap().truth.azimuth_bias_rms_rad
    };
    assert_eq!(biases(1, 5), biases(2, 5));
    assert_ne!(biases(1, 5), biases(1, 6));
}

#[test]
fn offsets_last_over_patches_and_are_larger_ahead() {
    let mut random = Random::new(3, 0);
    let patches = |yaw_rad: f64| Patches::new(yaw_rad, &mut Random::new(4, 0));
    let (side, front) = (patches(1.484), patches(0.436));
    let places: Vec<[f64; 2]> =
        (0..20_000).map(|_| [random.uniform(-4e4, 4e4), random.uniform(-4e4, 4e4)]).collect();
    let at = |patches: &Patches, along_m: f64| -> Vec<f64> {
        places.iter().map(|[x, y]| patches.offset(x + along_m, *y)).collect()
    };
    let (here, ahead) = (at(&side, 0.0), at(&front, 0.0));
    let [small, large] = model::PATCH_SIGMAS_RAD;
    let sigma = (small * small + large * large).sqrt();
    // A standard deviation by 20000 values is good to 0.5 %.
    assert!((deviation(&here) / sigma - 1.0).abs() < 0.025);
    assert!((deviation(&ahead) / deviation(&here) - model::PATCH_FACTOR[1][1]).abs() < 1e-9);
    for along_m in [2.0, 20.0, 100.0] {
        let there = at(&side, along_m);
        let product: Vec<f64> = here.iter().zip(&there).map(|(a, b)| a * b).collect();
        let shared = |sigma: f64, side_m: f64| sigma * sigma * (1.0 - along_m / side_m).max(0.0);
        let [fine_m, coarse_m] = model::PATCHES_M;
        let expected = (shared(small, fine_m) + shared(large, coarse_m)) / (sigma * sigma);
        let found = mean(&product) / (sigma * sigma);
        // A correlation by 20000 pairs is good to 0.7 %.
        assert!((found - expected).abs() < 0.036, "{along_m} {found} {expected}");
    }
    assert_eq!(square(1, -0.5, 3.0, 8.0).bits(), square(1, -7.5, 5.0, 8.0).bits());
    assert_ne!(square(1, -0.5, 3.0, 8.0).bits(), square(1, 0.5, 3.0, 8.0).bits());
}

#[test]
fn ghosts_have_their_share_and_come_in_clusters_that_last() {
    let drives: Vec<SimulatedDrive> =
        (0..4).map(|seed| drive(Scenario::CountryRoad, seed)).collect();
    for (sensor, within) in [(1, 0), (2, 1), (3, 2), (4, 3)] {
        let (mut odd, mut all, mut counts) = (0.0, 0.0, vec![]);
        for drive in &drives {
            let scans = residuals(drive, sensor);
            for scan in scans {
                let found = scan.iter().filter(|(_, residual)| residual.abs() > 1.2).count() as f64;
                odd += found;
                all += scan.len() as f64;
                counts.push(found);
            }
        }
        let expected = model::GHOST_SHARE[within][1];
        // Four scenes with factors of 0.6 to 1.4 (0.12 in the mean), and some ghosts move with the rest.
        let found = odd / all;
        assert!((0.6..1.4).contains(&(found / expected)), "{sensor} {found} {expected}");
        // Independent detections would have a variance equal to the mean, and no memory.
        let spread = deviation(&counts).powi(2) / mean(&counts);
        assert!(spread > 2.5, "{sensor} {spread}");
        let second = 13;
        let centre = mean(&counts);
        let lagged: Vec<f64> =
            counts.windows(second + 1).map(|w| (w[0] - centre) * (w[second] - centre)).collect();
        let correlation = mean(&lagged) / deviation(&counts).powi(2);
        assert!(correlation > 0.25, "{sensor} {correlation}");
    }
}

#[test]
fn soft_outliers_have_their_share_on_both_sides() {
    let (mut below, mut above, mut all) = (0.0, 0.0, 0.0);
    for (azimuth, residual) in residuals(&drive(Scenario::City, 7), 3).into_iter().flatten() {
        if azimuth.abs() < 0.35 {
            all += 1.0;
            below += f64::from(u8::from((-0.95..-0.55).contains(&residual)));
            above += f64::from(u8::from((0.55..0.95).contains(&residual)));
        }
    }
    let [from, to] = model::SOFT_MPS;
    let expected = 0.5 * model::SOFT_SHARE[2][1] * 0.4 / (to - from);
    // About 300 on either side (6 %), and a few ghosts among them.
    for found in [below / all, above / all] {
        assert!((0.75..1.5).contains(&(found / expected)), "{found} {expected}");
    }
}

#[test]
fn clocks_jitter_by_a_millisecond_and_lose_three_scans_in_a_thousand() {
    let (mut cycles, mut lost) = (vec![], 0.0);
    for id in 0..20 {
        let times = clock::scan_times(600.0, &mut Random::new(id, 1));
        let own: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
        lost += own.iter().filter(|cycle| **cycle > 0.1).count() as f64;
        let whole: Vec<f64> = own.into_iter().filter(|cycle| *cycle < 0.1).collect();
        let centre = mean(&whole);
        cycles.extend(whole.iter().map(|cycle| cycle - centre));
    }
    // The cycle is cut at 71 ms, 2.6 to 3.4 standard deviations below its mean: less than 2 %.
    let jitter = deviation(&cycles);
    assert!((jitter / model::CYCLE_SIGMA_S - 1.0).abs() < 0.03, "{jitter}");
    // About 486 lost ones: 4.5 % is one standard deviation.
    let share = lost / (cycles.len() as f64 + lost);
    assert!((share / model::LOST_SHARE - 1.0).abs() < 0.2, "{share}");
}

#[test]
fn gain_gives_the_mean_count() {
    // 400 echoes of 3 dB: 400 exp(-1 / (2 g)) = 100 for g = 1 / (2 ln 4).
    let found = gain::gain_db(&vec![10.0 * 2_f64.log10(); 400], 1, 100.0);
    let expected = -10.0 * (2.0 * 4_f64.ln()).log10();
    assert!((found - expected).abs() < 1e-4, "{found} {expected}");
    assert!(gain::gain_db(&[], 1, 100.0) > 24.0);
}

#[test]
fn scans_are_as_dense_as_the_radars_and_as_wide() {
    let drives: Vec<SimulatedDrive> =
        [Scenario::City, Scenario::CountryRoad, Scenario::Motorway, Scenario::StopAndGo]
            .into_iter()
            .zip(20..)
            .map(|(scenario, seed)| drive(scenario, seed))
            .collect();
    for (sensor, [_, wanted]) in (1..).zip(model::MEAN_COUNT) {
        let counts: Vec<f64> = drives
            .iter()
            .flat_map(|drive| &drive.log.scans)
            .filter(|scan| scan.sensor == sensor)
            .map(|scan| scan.detections.len() as f64)
            .collect();
        // Scenes differ by 22 %, four of them by 11 %, and what moves throws shadows.
        let found = mean(&counts);
        assert!((found / wanted - 1.0).abs() < 0.33, "{sensor} {found}");
        assert!(counts.iter().all(|count| *count <= MAX_DETECTIONS as f64));
    }
    let azimuths = || drives.iter().flat_map(|d| &d.log.scans).flat_map(|s| &s.detections);
    let widest = azimuths().map(|d| f64::from(d.azimuth_rad.abs())).fold(0.0, f64::max);
    assert!(widest <= FIELD_OF_VIEW_RAD && widest > 69.9 * PI / 180.0, "{widest}");
    assert!(azimuths().all(|d| RANGE_M[0] as f32 <= d.range_m && d.range_m <= RANGE_M[1] as f32));
}

#[test]
fn moving_shares_follow_scenes_and_directions() {
    let mut random = Random::new(1, 0);
    let shares: Vec<f64> = (0..20_000).map(|_| moving::draw_share(&mut random)).collect();
    let below = |limit: f64| {
        mean(&shares.iter().map(|s| f64::from(u8::from(*s < limit))).collect::<Vec<_>>())
    };
    // A share of 20000 is good to 0.3 %.
    assert!((below(0.1) - 0.75).abs() < 0.015 && (below(0.05) - 0.375).abs() < 0.017);
    assert!((below(0.3) - 0.95).abs() < 0.01 && below(0.8) == 1.0);

    let options = DriveOptions { moving_share: Some(0.2), ..options(Scenario::City, 4, 60.0) };
    let drive = simulate_drive(&options).unwrap();
    for (sensor, [_, factor]) in (1..).zip(model::MOVING_FACTOR) {
        let (mut moving, mut all) = (0.0, 0.0);
        for (scan, flags) in drive.log.scans.iter().zip(&drive.moving) {
            let fast = motion_at(&drive.truth.motion, scan.time_s).speed_mps.abs() > 1.0;
            if scan.sensor == sensor && fast {
                moving += flags.iter().filter(|flag| **flag).count() as f64;
                all += flags.len() as f64;
            }
        }
        let (found, wanted) = (moving / all, 0.2 * factor);
        // Only the trimmed detections are random: a binomial of thousands.
        assert!((found - wanted).abs() < 0.012, "{sensor} {found} {wanted}");
    }
}

#[test]
fn cars_slip_outwards_as_drawn_and_drives_of_one_car_alike() {
    let drawn = |car: u64, seed: u64| {
        let options = DriveOptions::default();
        CarErrors::drawn(&options, &mut Random::new(car, 1), &mut Random::new(seed, 2))
    };
    let of = |value: fn(&CarErrors) -> f64, cars: &[CarErrors]| -> Vec<f64> {
        cars.iter().map(value).collect()
    };
    let cars: Vec<CarErrors> = (0..2000).map(|i| drawn(i, 10_000 + i)).collect();
    let one: Vec<CarErrors> = (0..2000).map(|i| drawn(7, i)).collect();
    let slips = of(|c| c.slip_gradient_rad, &cars);
    let [centre, sigma] = model::SLIP_GRADIENT_RAD;
    // Standard errors of 2000: 2.2 % of a deviation for the mean, 1.6 % for the deviation; five.
    let all = (sigma * sigma + (model::SLIP_SPREAD * centre).powi(2)).sqrt();
    assert!((mean(&slips) - centre).abs() < 0.11 * all);
    assert!((deviation(&slips) / all - 1.0).abs() < 0.1);
    let slips = of(|c| c.slip_gradient_rad, &one);
    assert!((deviation(&slips) / mean(&slips) / model::SLIP_SPREAD - 1.0).abs() < 0.08);
    assert!((deviation(&of(|c| c.speed_scale, &cars)) / 0.003 - 1.0).abs() < 0.08);
    assert!((deviation(&of(|c| c.crab_rad, &cars)).to_degrees() / 0.03 - 1.0).abs() < 0.08);
    let delays = of(|c| c.delay_s, &cars);
    assert!(delays.iter().all(|delay| (0.02..0.10).contains(delay)));
    assert!((mean(&delays) - 0.06).abs() < 0.0026);

    let options =
        DriveOptions { slip_gradient_rad: Some(0.006), ..options(Scenario::City, 2, 60.0) };
    let truth = simulate_drive(&options).unwrap().truth;
    let turning = |m: &&TrueMotion| (m.speed_mps * m.yaw_rate_radps).abs() > 1.0;
    let turns: Vec<&TrueMotion> = truth.motion.iter().filter(turning).collect();
    assert!(turns.len() > 100);
    for m in turns {
        // Left of the car's x where it turns to the right.
        let slip = truth.car.crab_rad - 0.006 * m.speed_mps * m.yaw_rate_radps;
        assert!((m.slip_rad - slip).abs() < 1e-12);
    }
}
