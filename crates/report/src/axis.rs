//! Limits and labels of a chart's axis.

/// Approximate number of labels per axis.
const TICKS: f64 = 6.0;

/// Limits of an axis that shows all finite numbers: whole decades, given the logarithms, or a margin of 3 %.
pub(crate) fn extent(numbers: impl Iterator<Item = f64>, logarithmic: bool) -> [f64; 2] {
    let [low, high] = numbers
        .filter(|number| number.is_finite())
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| [a.min(x), b.max(x)]);
    if low > high {
        return [0.0, 1.0];
    }
    if logarithmic {
        return [low.floor(), high.ceil().max(low.floor() + 1.0)];
    }
    let margin = if high > low { 0.03 * (high - low) } else { 0.5 };
    [low - margin, high + margin]
}

/// Returns values and labels, given the limits or, of a logarithmic axis, their logarithms.
pub(crate) fn labels(limits: [f64; 2], logarithmic: bool) -> Vec<(f64, String)> {
    if logarithmic {
        return decades(limits);
    }
    let (values, digits) = ticks(limits);
    values.into_iter().map(|value| (value, format!("{value:.digits$}"))).collect()
}

/// Labels of a logarithmic axis: 1, 2 and 5 of each decade on axes of up to two decades, else at most eleven powers of ten.
fn decades([low, high]: [f64; 2]) -> Vec<(f64, String)> {
    let digits: &[i32] = if high - low > 2.0 { &[1] } else { &[1, 2, 5] };
    let step = ((high - low) / 10.0).ceil().max(1.0) as usize;
    let powers = (low.floor() as i32..=high.floor() as i32).step_by(step);
    let ticks = powers.flat_map(|power| digits.iter().map(move |digit| (*digit, power)));
    let logarithm = |digit: i32, power: i32| f64::from(power) + f64::from(digit).log10();
    let within = ticks.filter(|tick| (low..=high).contains(&logarithm(tick.0, tick.1)));
    let labelled = within.map(|(digit, power)| {
        let value = f64::from(digit) * 10_f64.powi(power);
        let label = match power {
            -5..=5 => format!("{value:.*}", power.min(0).unsigned_abs() as usize),
            _ => format!("{digit}e{power}"),
        };
        (value, label)
    });
    labelled.collect()
}

/// Round numbers between two limits, and the number of decimals that distinguishes them.
fn ticks([low, high]: [f64; 2]) -> (Vec<f64>, usize) {
    let rough = (high - low) / TICKS;
    let power = rough.log10().floor();
    let unit = 10_f64.powf(power);
    let step = [1.0, 2.0, 5.0, 10.0].map(|digit| digit * unit).into_iter().find(|s| *s >= rough);
    let step = step.unwrap_or(rough);
    let digits = (-step.log10().floor()).clamp(0.0, 9.0) as usize;
    let first = (low / step).ceil() as i64;
    let values = (first..).map(|at| at as f64 * step).take_while(|value| *value <= high);
    // Zero has no sign.
    (values.take(20).map(|value| value + 0.0).collect(), digits)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_are_round_and_within_the_limits() {
        assert_eq!(ticks([0.0, 60.0]), (vec![0.0, 10.0, 20.0, 30.0, 40.0, 50.0, 60.0], 0));
        let (values, digits) = ticks([-0.31, 0.29]);
        assert_eq!((values.len(), digits), (6, 1));
        assert!(values.iter().all(|value| (10.0 * value).fract().abs() < 1e-9), "{values:?}");
    }

    #[test]
    fn logarithmic_axes_label_1_2_and_5_or_powers_of_ten() {
        let labels = |low, high| {
            let ticks = decades([low, high]);
            for (value, label) in &ticks {
                let shown: f64 = label.parse().unwrap();
                assert!((value / shown - 1.0).abs() < 1e-12, "{value} {label}");
            }
            ticks.into_iter().map(|(_, label)| label).collect::<Vec<_>>().join(" ")
        };
        assert_eq!(labels(-1.0, 1.0), "0.1 0.2 0.5 1 2 5 10");
        assert_eq!(labels(-5.0, -2.0), "0.00001 0.0001 0.001 0.01");
        assert_eq!(labels(4.0, 7.0), "10000 100000 1e6 1e7");
        assert_eq!(labels(0.3, 0.8), "2 5");
        assert_eq!(labels(-300.0, 300.0).split(' ').count(), 11);
        assert_eq!(extent([0.1, 2.0].into_iter(), true), [0.0, 2.0]);
        assert_eq!(extent([1.0].into_iter(), true), [1.0, 2.0]);
    }
}
