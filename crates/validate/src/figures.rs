//! Figures 4 to 6, as SVG.

use crate::candidates::CANDIDATES;
use crate::condition::{Condition, Convergence, chosen};
use crate::plot::{Panel, Series, draw};
use crate::statistics::Summary;
use crate::whole::{BIN_COUNT, BINS, FIGURE_RADAR};

/// Figure 5: the angle of radar 3 by drive, for two published methods and ours.
pub fn angles(condition: &Condition) -> String {
    let truth =
        condition.radars.iter().find(|r| r.sensor == FIGURE_RADAR).map_or(f64::NAN, |r| r.true_deg);
    let scenes = condition.scenes as f64;
    let shown: Vec<usize> = chosen(|candidate| candidate.angles).collect();
    let all = || shown.iter().flat_map(|&k| condition.angles_deg[k].iter().flatten().copied());
    let far = all().fold(0.02, |far: f64, angle| far.max(1.1 * (angle - truth).abs()));
    let panels: Vec<Panel> = shown
        .iter()
        .map(|&k| {
            let points: Vec<(f64, f64)> = condition.angles_deg[k]
                .iter()
                .enumerate()
                .filter_map(|(i, angle)| Some((i as f64 + 1.0, (*angle)?)))
                .collect();
            let angles: Vec<f64> = points.iter().map(|(_, angle)| *angle).collect();
            let mean = Summary::of(&angles).mean;
            let line = |name: &str, points, dashed, marked| Series {
                name: name.into(),
                points,
                dashed,
                marked,
            };
            Panel {
                title: format!("{}: mean {mean:.3} deg, true {truth:.3} deg", CANDIDATES[k].name),
                x: "drive".into(),
                y: "angle / deg".into(),
                y_limits: Some([truth - far, truth + far]),
                series: vec![
                    line("each drive", points, false, true),
                    line("mean", vec![(1.0, mean), (scenes, mean)], true, false),
                    line("true angle", vec![(1.0, truth), (scenes, truth)], false, false),
                ],
                ..Panel::default()
            }
        })
        .collect();
    draw(&panels, 1)
}

/// Figure 6: mean absolute error and variance against driving time.
pub fn convergence(conditions: &[Condition]) -> String {
    let panel = |condition: &Condition, what: &str, value: fn(&Summary) -> f64| Panel {
        title: condition.name.into(),
        x: "driving time / s".into(),
        y: what.into(),
        logarithmic: [true; 2],
        series: condition.convergence.iter().map(|c| series(c, value)).collect(),
        ..Panel::default()
    };
    let panels: Vec<Panel> = conditions
        .iter()
        .map(|c| panel(c, "mean absolute error / deg", |error| error.mean_absolute))
        .chain(conditions.iter().map(|c| panel(c, "variance / deg^2", |e| e.variance)))
        .collect();
    draw(&panels, 2)
}

/// Figure 4: how often the car had which speed and acceleration, over all scans.
pub fn states(conditions: &[Condition]) -> String {
    let panel = |which: usize, title: &str, x: &str, y: &str, below: f64| Panel {
        title: title.into(),
        x: x.into(),
        y: y.into(),
        series: conditions
            .iter()
            .map(|condition| {
                let counts = &condition.states[which];
                let all = counts.iter().sum::<u64>().max(1) as f64 * BINS[which];
                let middle = |bin: usize| (bin as f64 + 0.5 - below) * BINS[which];
                let density = |(bin, count): (usize, &u64)| (middle(bin), *count as f64 / all);
                Series {
                    name: condition.name.into(),
                    points: counts.iter().enumerate().map(density).collect(),
                    dashed: false,
                    marked: false,
                }
            })
            .collect(),
        ..Panel::default()
    };
    let half = BIN_COUNT as f64 / 2.0;
    draw(
        &[
            panel(0, "speed of the car", "speed / (m/s)", "density / (s/m)", 0.0),
            panel(
                1,
                "acceleration of the car",
                "acceleration / (m/s^2)",
                "density / (s^2/m)",
                half,
            ),
        ],
        2,
    )
}

fn series(convergence: &Convergence, value: fn(&Summary) -> f64) -> Series {
    let points = convergence.driving_s.iter().zip(&convergence.error_deg);
    Series {
        name: convergence.name.into(),
        points: points.filter(|(_, e)| e.count > 1).map(|(t, e)| (*t, value(e))).collect(),
        dashed: false,
        marked: true,
    }
}
