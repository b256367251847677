//! What a step at each place of a stretch would explain.

use super::sums::{Centred, Prefix, Sums};
use std::ops::Range;

/// Drives needed on either side of a knock.
pub(super) const LEAST_DRIVES: usize = 3;
/// So many of them, by their probabilities of not being off.
const LEAST_INLYING: f64 = LEAST_DRIVES as f64 - 0.5;
/// As many equal drives have to be as sure of the level on either side: one good drive among poor ones makes no knock.
const LEAST_EFFECTIVE: f64 = 2.0;
/// A step of which less than this share is not a drift as well is not told from it.
const LEAST_OWN: f64 = 1e-6;

/// A step at a place.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
    /// The first drive after it.
    pub start: usize,
    /// By how much it lowers the weighted squares.
    pub gain: f64,
    /// Information on the step, given levels and rate.
    pub information: f64,
    /// Share of the information of the stretch that lies before it.
    pub share: f64,
}

/// Whether drives suffice to tell a level.
fn suffices(sums: &Sums) -> bool {
    sums.n >= LEAST_INLYING && sums.effective() >= LEAST_EFFECTIVE
}

/// All places for a step within a stretch; `centred` are the squares of the model that has none there.
pub(super) fn places(
    prefix: &Prefix,
    range: Range<usize>,
    centred: Centred,
    rate: bool,
) -> impl Iterator<Item = Place> {
    let (from, end) = (range.start, range.end);
    let whole = prefix.over(range);
    let first = from + LEAST_DRIVES;
    let last = (end + 1).saturating_sub(LEAST_DRIVES);
    (first..last).filter_map(move |start| {
        let before = prefix.over(from..start);
        let after = prefix.over(start..end);
        if !(suffices(&before) && suffices(&after)) {
            return None;
        }
        let uu = before.w * after.w / whole.w;
        let uy = uu * (after.mean_y() - before.mean_y());
        let (mut information, mut product) = (uu, uy);
        if rate && centred.has_rate() {
            let ut = uu * (after.mean_t() - before.mean_t());
            information -= ut * ut / centred.tt;
            product -= ut * centred.ty / centred.tt;
        }
        (information > LEAST_OWN * uu).then(|| Place {
            start,
            gain: product * product / information,
            information,
            share: before.w / whole.w,
        })
    })
}

/// The place of the highest gain, how many there are, and the logarithm of the odds that they span.
pub(super) struct Best {
    pub place: Option<Place>,
    pub count: f64,
    pub odds: f64,
}

impl Best {
    pub fn of(places: impl Iterator<Item = Place>) -> Self {
        let mut best = Self { place: None, count: 0.0, odds: 0.0 };
        let (mut first, mut last) = (0.5, 0.5);
        for place in places {
            if best.place.is_none() {
                first = place.share;
            }
            last = place.share;
            best.count += 1.0;
            if best.place.is_none_or(|b| place.gain > b.gain) {
                best.place = Some(place);
            }
        }
        let odds = |share: f64| (share / (1.0 - share)).ln();
        best.odds = (odds(last) - odds(first)).max(0.0);
        best
    }
}

#[cfg(test)]
mod tests {
    use super::super::sums::Datum;
    use super::*;
    use boresight_core::Random;

    /// What a place explains is what the squares are less by once the stretch is cut there, with a rate and without.
    #[test]
    fn gains_are_differences_of_squares() {
        let mut random = Random::new(3, 0);
        let draw = |i: usize| Datum {
            time: i as f64 / 20.0 - 0.5 + 0.02 * random.unit(),
            angle: 0.01 * random.normal() + 0.02 * i as f64,
            sigma: 0.01 * random.uniform(1.0, 2.0),
            floor: 0.0,
            inlying: 1.0,
        };
        let data: Vec<Datum> = (0..20).map(draw).collect();
        let prefix = Prefix::of(&data);
        let centred = prefix.centred(&[8]);
        for rate in [false, true] {
            let mut count = 0;
            for place in places(&prefix, 8..20, centred, rate) {
                let cut = prefix.centred(&[8, place.start]).left(rate);
                let gain = centred.left(rate) - cut;
                // Sums of squares to 1e4 in double precision.
                assert!((place.gain - gain).abs() < 1e-9, "{} {gain}", place.gain);
                count += 1;
            }
            assert_eq!(count, 7);
        }
    }
}
