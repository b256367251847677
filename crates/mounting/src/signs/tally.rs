//! Evidence for one of two signs, gathered over blocks of time.

/// A block, s: errors of neighbouring scans are alike.
const BLOCK_S: f64 = 1.0;
/// Fewest blocks of which a deviation is believed.
const LEAST_BLOCKS: f64 = 8.0;

/// Sums of what scans say, positive for the usual sign.
#[derive(Debug, Clone, Default)]
pub(super) struct Tally {
    block: Option<i64>,
    sum: f64,
    count: f64,
    blocks: f64,
    total: f64,
    squares: f64,
}

impl Tally {
    /// Adds what a scan says; scans come in order of time.
    pub(super) fn add(&mut self, time_s: f64, value: f64) {
        let block = Some((time_s / BLOCK_S).floor() as i64);
        if block != self.block {
            self.close();
            self.block = block;
        }
        self.sum += value;
        self.count += 1.0;
    }

    fn close(&mut self) {
        if self.count > 0.0 {
            let mean = self.sum / self.count;
            self.blocks += 1.0;
            self.total += mean;
            self.squares += mean * mean;
        }
        (self.sum, self.count) = (0.0, 0.0);
    }

    /// Student's t of the blocks' means about zero: how many deviations speak for the usual sign, or, negative,
    /// for the other; `None` of too few blocks.
    pub(super) fn deviations(mut self) -> Option<f64> {
        self.close();
        if self.blocks < LEAST_BLOCKS {
            return None;
        }
        let mean = self.mean();
        let variance = (self.squares / self.blocks - mean * mean).max(0.0) / (self.blocks - 1.0);
        let deviations = mean / variance.sqrt();
        deviations.is_finite().then_some(deviations)
    }

    /// The same of values from -1 to 1, as far as their mean differs from that of a coin's: blocks that agree have no
    /// scatter of their own.
    pub(super) fn deviations_from_chance(mut self) -> Option<f64> {
        self.close();
        (self.blocks >= LEAST_BLOCKS).then(|| self.mean() * self.blocks.sqrt())
    }

    fn mean(&self) -> f64 {
        self.total / self.blocks
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use boresight_core::Random;

    fn deviations(bias: f64, blocks: usize, seed: u64) -> Option<f64> {
        let mut random = Random::new(seed, 0);
        let mut tally = Tally::default();
        for block in 0..blocks {
            // One error for the whole block: scans of it are no further evidence.
            let error = random.normal();
            for scan in 0..5 {
                tally.add(BLOCK_S * (block as f64 + 0.15 * f64::from(scan)), bias + error);
            }
        }
        tally.deviations()
    }

    #[test]
    fn deviations_are_those_of_blocks() {
        assert_eq!(deviations(1.0, 7, 1), None);
        let mean = |bias: f64| {
            (0..400).filter_map(|seed| deviations(bias, 100, seed)).sum::<f64>() / 400.0
        };
        // 100 blocks of deviation 1: a bias of 0.5 is 5 deviations, to the scatter of 400 trials.
        assert!((mean(0.5) - 5.0).abs() < 0.25, "{}", mean(0.5));
        assert!(mean(0.0).abs() < 0.2);
        // Of no scatter at all nothing is said.
        let mut same = Tally::default();
        (0..20).for_each(|block| same.add(BLOCK_S * f64::from(block), 0.0));
        assert_eq!(same.deviations(), None);
    }
}
