//! Rotation between the velocities of car and radar (Bao et al. 2020; Kabsch 1976), scale taken as 1.

use super::account::{Influence, covariance};
use super::{Sample, Setting, Solution, wrap};
use crate::symmetric::Symmetric;

/// The rotation that turns the radar's velocities into `(v - w y_s, w x_s)`, in the plane:
/// `theta = atan2(sum w V x U, sum w V . U)` with the weights of Zhu et al.'s equation 13. `None` where no frame
/// has a speed or all velocities vanish.
pub(crate) fn solve(samples: &[Sample], setting: &Setting) -> Option<Solution> {
    let place = [setting.options.x_m, setting.options.y_m];
    let pairs = || {
        samples.iter().filter(|sample| sample.speed_mps.is_finite()).map(|sample| {
            let rate = sample.yaw_rate_radps - setting.bias_radps;
            let car = [sample.speed_mps - rate * place[1], rate * place[0]];
            let across = sample.beta_variance * sample.radar_speed_mps.powi(2);
            let weight = 1.0 / (sample.speed_variance + across);
            (sample, car, weight)
        })
    };
    let (mut cross, mut dot, mut used) = (0.0, 0.0, 0usize);
    for (sample, car, weight) in pairs() {
        let (sin, cos) = sample.beta_rad.sin_cos();
        let strength = weight * sample.radar_speed_mps;
        cross += strength * (cos * car[1] - sin * car[0]);
        dot += strength * (cos * car[0] + sin * car[1]);
        used += 1;
    }
    if used == 0 || (cross == 0.0 && dot == 0.0) {
        return None;
    }
    let angle = cross.atan2(dot);
    let (mut total, mut middle, mut squares) = (0.0, 0.0, 0.0);
    let mut influences = Vec::with_capacity(used);
    for (sample, car, weight) in pairs() {
        let speed_squared = car[0] * car[0] + car[1] * car[1];
        if speed_squared == 0.0 {
            continue;
        }
        let lever_s = (car[0] * place[0] + car[1] * place[1]) / speed_squared;
        let variance = sample.beta_variance + (lever_s * setting.yaw_rate_sigma_radps).powi(2);
        let strength = weight * sample.radar_speed_mps * speed_squared.sqrt();
        let residual = wrap(car[1].atan2(car[0]) - sample.beta_rad - angle);
        total += strength;
        middle += strength * strength * variance;
        squares += residual * residual / variance;
        influences.push(Influence { sample: *sample, on: [strength, 0.0], residual, lever_s });
    }
    for influence in &mut influences {
        influence.on[0] /= total;
    }
    let inflation = (squares / used.saturating_sub(1).max(1) as f64).max(1.0);
    let independent = Symmetric { xx: inflation * middle / (total * total), xy: 0.0, yy: 0.0 };
    let covariance = covariance(independent, &influences, &setting.untold(true));
    covariance.xx.is_finite().then_some(Solution {
        angle_rad: wrap(angle),
        inverse_scale: 1.0,
        covariance,
        gated: 0,
    })
}
