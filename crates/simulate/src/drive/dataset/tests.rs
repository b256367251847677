use super::*;
use boresight_core::drive::Detection;

fn windows(options: &DatasetOptions, drives: usize) -> Vec<Window> {
    let mut data = Dataset::new(options).unwrap();
    (0..drives).flat_map(|_| data.next_drive().unwrap()).collect()
}

fn residual_of_standing(window: &Window) -> f64 {
    let residual = |frame: &Frame, detection: &Detection| {
        let (sin, cos) = f64::from(detection.azimuth_rad).sin_cos();
        let [x, y] = frame.velocity_mps;
        (f64::from(detection.range_rate_mps) + x * cos + y * sin).abs()
    };
    let mut all: Vec<f64> = vec![];
    for frame in &window.frames {
        all.extend(frame.detections.iter().filter(|d| !d.1).map(|(d, _)| residual(frame, d)));
    }
    all.sort_by(f64::total_cmp);
    // Ghosts count as standing; in dense traffic they are half of what does.
    all.get(all.len() / 4).copied().unwrap_or(0.0)
}

#[test]
fn standing_things_show_the_motion_of_the_frame() {
    for dataset_noise in [DatasetNoise::Radarscenes, DatasetNoise::Laplace] {
        let options = DatasetOptions { seed: 3, dataset_noise, ..DatasetOptions::default() };
        for window in windows(&options, 6) {
            assert_eq!(window.frames.len(), WINDOW);
            let quartile = residual_of_standing(&window);
            assert!(quartile < 0.2, "{dataset_noise:?} {:?} {quartile}", window.scenario);
        }
    }
}

#[test]
fn much_moves_and_one_frame_in_twenty_has_nothing_static() {
    let options = DatasetOptions { seed: 5, ..DatasetOptions::default() };
    let all = windows(&options, 18);
    let share = |window: &Window| {
        let of = |f: &Frame| (f.detections.iter().filter(|d| d.1).count(), f.detections.len());
        let (moving, count) =
            window.frames.iter().map(of).fold((0, 0), |a, b| (a.0 + b.0, a.1 + b.1));
        moving as f64 / count.max(1) as f64
    };
    let nothing: Vec<&Window> =
        all.iter().filter(|w| w.condition == Condition::NothingStatic).collect();
    let of_all = nothing.len() as f64 / all.len() as f64;
    assert!((0.03..=0.06).contains(&of_all), "{of_all}");
    assert!(nothing.iter().all(|w| share(w) == 1.0));
    let high = all.iter().filter(|w| (0.55..0.9).contains(&share(w))).count();
    assert!(high * 10 > all.len(), "{high} of {}", all.len());
    // The full circle.
    for quarter in 0..4 {
        let from = -PI + PI / 2.0 * f64::from(quarter);
        assert!(all.iter().any(|w| w.yaw_rad >= from && w.yaw_rad < from + PI / 2.0));
    }
}

#[test]
fn movers_of_a_queue_have_one_velocity() {
    let options = DatasetOptions { seed: 5, ..DatasetOptions::default() };
    let all = windows(&options, 12);
    let mut checked = 0;
    for window in all.iter().filter(|w| w.condition == Condition::Queue) {
        for frame in &window.frames {
            let moving: Vec<&Detection> =
                frame.detections.iter().filter(|d| d.1).map(|(d, _)| d).collect();
            if moving.len() < 6 {
                continue;
            }
            // Least squares on movers alone leaves the noise they were given.
            let (mut a, mut b) = ([0.0_f64; 3], [0.0_f64; 2]);
            for d in &moving {
                let (sin, cos) = f64::from(d.azimuth_rad).sin_cos();
                let rate = f64::from(d.range_rate_mps);
                a = [a[0] + cos * cos, a[1] + cos * sin, a[2] + sin * sin];
                b = [b[0] + cos * rate, b[1] + sin * rate];
            }
            let det = a[0] * a[2] - a[1] * a[1];
            if det < 1e-2 {
                continue;
            }
            let v = [(a[2] * b[0] - a[1] * b[1]) / det, (a[0] * b[1] - a[1] * b[0]) / det];
            let worst = moving.iter().fold(0.0_f64, |worst, d| {
                let (sin, cos) = f64::from(d.azimuth_rad).sin_cos();
                worst.max((f64::from(d.range_rate_mps) - v[0] * cos - v[1] * sin).abs())
            });
            assert!(worst < 0.3, "{worst}");
            checked += 1;
        }
    }
    assert!(checked > 20, "{checked}");
}

#[test]
fn the_same_seed_gives_the_same_windows_and_another_others() {
    let options = DatasetOptions { seed: 8, ..DatasetOptions::default() };
    assert_eq!(windows(&options, 2), windows(&options, 2));
    let other = DatasetOptions { seed: 9, ..options.clone() };
    assert_ne!(windows(&options, 1), windows(&other, 1));
}

#[test]
fn a_kind_of_roads_is_left_out() {
    let left_out = Some(Scenario::Motorway);
    let options = DatasetOptions { scenario_left_out: left_out, ..DatasetOptions::default() };
    let mut kinds: Vec<Scenario> = windows(&options, 10).iter().map(|w| w.scenario).collect();
    kinds.dedup();
    assert!(kinds.len() >= 5 && !kinds.contains(&Scenario::Motorway));
    assert!(Dataset::new(&DatasetOptions { scenario: left_out, ..options }).is_err());
}

#[test]
fn bytes_are_those_of_the_format() {
    let detection =
        Detection { azimuth_rad: -0.5, range_rate_mps: -7.005, range_m: 12.34, rcs_dbsm: 500.0 };
    let frame = Frame {
        dt_s: 0.074,
        velocity_mps: [7.0, -1.5],
        yaw_rate_radps: 0.1,
        detections: vec![(detection, true)],
    };
    let window = Window {
        drive: 7,
        scenario: Scenario::CarPark,
        condition: Condition::Queue,
        yaw_rad: -1.0,
        frames: vec![frame],
    };
    let (mut frames, mut detections) = (vec![], vec![]);
    file::append(&window, &mut frames, &mut detections);
    assert_eq!((frames.len(), detections.len()), (file::FRAME_BYTES, file::DETECTION_BYTES));
    assert_eq!(frames[..4], [7, 0, 0, 0]);
    assert_eq!(frames[4..8], 7.0_f32.to_le_bytes());
    assert_eq!(frames[20..], [1, 0, 1, 0, 0xf0, 0xd8, 3, 1]);
    assert_eq!(detections, [0xf0, 0xd8, 0x87, 0xfa, 0xd2, 4, 127, 1]);
}
