//! The car's trajectory from its radar's motion and a mounting angle, and how far it strays.

use boresight_core::Pose;

/// The radar's motion at one time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TimedMotion {
    /// Time, s.
    pub time_s: f64,
    /// Velocity in the radar's frame, m/s.
    pub velocity_mps: [f64; 2],
    /// Yaw rate of the car, rad/s, where it is not to follow from the velocity.
    pub yaw_rate_radps: Option<f64>,
}

/// Poses of the rear axle at the motions' times, from the origin, heading along x: a radar at
/// `(x_m, y_m)` turned by `angle_rad` moves with `(v - w y, w x)` in the car's frame, which gives speed
/// `v` and yaw rate `w` (Kellner et al. 2013). Where the yaw rate is given, what is left of the radar's
/// velocity across the car moves it sideways, as a wrong angle does. Between two times all are the mean
/// of the two, on a circle. `None` where a yaw rate has to follow and `x_m` is too near 0 for it (below
/// 1 mm), or a number is not finite.
pub fn integrate(motions: &[TimedMotion], angle_rad: f64, x_m: f64, y_m: f64) -> Option<Vec<Pose>> {
    let follows = motions.iter().any(|motion| motion.yaw_rate_radps.is_none());
    if x_m.is_nan() || (follows && x_m.abs() < 1e-3) {
        return None;
    }
    let (sin, cos) = angle_rad.sin_cos();
    let car = |motion: &TimedMotion| {
        let [vx, vy] = motion.velocity_mps;
        let across = sin * vx + cos * vy;
        let rate = motion.yaw_rate_radps.unwrap_or(across / x_m);
        let sideways = motion.yaw_rate_radps.map_or(0.0, |rate| across - rate * x_m);
        (cos * vx - sin * vy + rate * y_m, sideways, rate)
    };
    let mut pose = Pose { x_m: 0.0, y_m: 0.0, yaw_rad: 0.0 };
    let mut poses = Vec::with_capacity(motions.len());
    for (i, motion) in motions.iter().enumerate() {
        if let Some(previous) = i.checked_sub(1).map(|before| &motions[before]) {
            let (before, after) = (car(previous), car(motion));
            let step_s = motion.time_s - previous.time_s;
            let turn = 0.5 * (before.2 + after.2) * step_s;
            // The chord of an arc: its length over the arc's is sinc of half the turn.
            let half = 0.5 * turn;
            let shorter = if half.abs() < 1e-8 { 1.0 } else { half.sin() / half };
            let chord = 0.5 * (before.0 + after.0) * step_s * shorter;
            let aside = 0.5 * (before.1 + after.1) * step_s * shorter;
            let (s, c) = (pose.yaw_rad + half).sin_cos();
            pose.x_m += chord * c - aside * s;
            pose.y_m += chord * s + aside * c;
            pose.yaw_rad += turn;
        }
        if !(pose.x_m.is_finite() && pose.y_m.is_finite() && pose.yaw_rad.is_finite()) {
            return None;
        }
        poses.push(pose);
    }
    Some(poses)
}

/// Relative trajectory error, m, of estimated poses, each with the true one at its time: both trajectories are cut
/// where the true one has run `segment_m` (50 m in the example of Zhu et al.), aligned at each segment's start, and the
/// distances of the segments' ends are averaged. `None` where the true one is shorter than a segment, or a pose is not
/// finite.
pub fn relative_error(
    poses: impl IntoIterator<Item = (Pose, Pose)>,
    segment_m: f64,
) -> Option<f64> {
    if segment_m.is_nan() || segment_m <= 0.0 {
        return None;
    }
    let mut poses = poses.into_iter();
    let mut start = poses.next()?;
    let (mut last, mut run, mut sum, mut segments) = (start.1, 0.0, 0.0, 0u32);
    for (ours, truth) in poses {
        run += (truth.x_m - last.x_m).hypot(truth.y_m - last.y_m);
        last = truth;
        if run >= segment_m {
            let end = seen_from(start.0, ours);
            let true_end = seen_from(start.1, truth);
            sum += (end[0] - true_end[0]).hypot(end[1] - true_end[1]);
            segments += 1;
            (start, run) = ((ours, truth), 0.0);
        }
    }
    (segments > 0 && sum.is_finite()).then(|| sum / f64::from(segments))
}

/// Place of a pose in the frame of another.
fn seen_from(origin: Pose, pose: Pose) -> [f64; 2] {
    let (sin, cos) = origin.yaw_rad.sin_cos();
    let (x, y) = (pose.x_m - origin.x_m, pose.y_m - origin.y_m);
    [cos * x + sin * y, cos * y - sin * x]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A circle of 40 m at 10 m/s with a radar at (3.8, 0.7) turned by 0.4 rad.
    fn circle(frames: usize) -> (Vec<TimedMotion>, Vec<Pose>) {
        let (v, w): (f64, f64) = (10.0, 0.25);
        let (sin, cos) = 0.4_f64.sin_cos();
        let [ux, uy] = [v - w * 0.7, w * 3.8];
        let velocity_mps = [cos * ux + sin * uy, cos * uy - sin * ux];
        (0..frames)
            .map(|i| {
                let time_s = i as f64 * 0.1;
                let yaw_rad = w * time_s;
                let (s, c) = yaw_rad.sin_cos();
                let pose = Pose { x_m: 40.0 * s, y_m: 40.0 * (1.0 - c), yaw_rad };
                (TimedMotion { time_s, velocity_mps, yaw_rate_radps: None }, pose)
            })
            .unzip()
    }

    fn error(estimated: &[Pose], truth: &[Pose], segment_m: f64) -> Option<f64> {
        relative_error(estimated.iter().copied().zip(truth.iter().copied()), segment_m)
    }

    #[test]
    fn a_circle_is_followed_exactly_and_a_wrong_angle_is_not() {
        let (motions, truth) = circle(600);
        let poses = integrate(&motions, 0.4, 3.8, 0.7).unwrap();
        assert!(error(&poses, &truth, 50.0).unwrap() < 1e-9);
        // An angle off by e turns the car at v e / x_s more: after 50 m about 50^2 e / (2 x_s).
        let off = integrate(&motions, 0.401, 3.8, 0.7).unwrap();
        let error = error(&off, &truth, 50.0).unwrap();
        let expected = 50.0 * 50.0 * 0.001 / (2.0 * 3.8);
        assert!((error - expected).abs() < 0.2 * expected, "{error} {expected}");
    }

    #[test]
    fn with_the_yaw_rate_known_a_wrong_angle_moves_the_car_sideways_and_needs_no_lever() {
        let (mut motions, truth) = circle(600);
        motions.iter_mut().for_each(|motion| motion.yaw_rate_radps = Some(0.25));
        let poses = integrate(&motions, 0.4, 3.8, 0.7).unwrap();
        assert!(error(&poses, &truth, 50.0).unwrap() < 1e-9);
        // The velocity is turned by the error, so the way is: 1e-3 of the chord of 50 m on 40 m (46.8 m).
        let off = integrate(&motions, 0.401, 3.8, 0.7).unwrap();
        let error = error(&off, &truth, 50.0).unwrap();
        assert!((error - 0.0468).abs() < 0.005, "{error}");
        assert!(integrate(&motions, 0.4, 0.0, 0.7).is_some());
        motions[3].yaw_rate_radps = None;
        assert!(integrate(&motions, 0.4, 0.0, 0.7).is_none());
    }

    #[test]
    fn what_cannot_be_followed_is_none() {
        let (motions, truth) = circle(20);
        assert!(integrate(&motions, 0.4, 0.0, 0.7).is_none());
        assert!(integrate(&motions, f64::NAN, 3.8, 0.7).is_none());
        assert_eq!(error(&truth, &truth, 50.0), None);
        assert_eq!(error(&truth, &truth, 0.0), None);
        assert_eq!(relative_error([], 5.0), None);
        assert_eq!(integrate(&[], 0.0, 1.0, 0.0), Some(vec![]));
    }
}
