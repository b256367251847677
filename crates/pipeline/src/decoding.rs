//! From the channels of a cell as measured to the array's snapshot: folds of the rate told, transmitters told apart, what is
//! known of the array's errors taken off.

use crate::chain::{Cell, Chain, Found};
use crate::error::PipelineError;
use boresight_core::{Array, Complex64, Multiplexing, Waveform};
use boresight_signal::{binary_phase, tdm};
use ndarray::{Array1, Array2, Array3, ArrayView2, Axis};

impl Chain {
    /// The channels of a cell of the frame transformed last, as measured.
    pub(crate) fn raw_snapshot(&self, cell: &Cell) -> Result<Array1<Complex64>, PipelineError> {
        let detection = cell.peak.detection;
        Ok(self.map.snapshot(detection.range_bin, detection.doppler_bin)?)
    }

    /// Tells the folds of the cells found, and makes the array's snapshots, cells x elements x
    /// snapshots, of the channels as measured. Cells whose rate so is outside the region are
    /// dropped and counted.
    pub(crate) fn decoded(
        &self,
        found: &mut Found,
        raw: &Array3<Complex64>,
    ) -> Result<Array3<Complex64>, PipelineError> {
        let (_, _, count) = raw.dim();
        let rate_of_a_fold = 2.0 * self.waveform().max_rate_mps();
        let all = std::mem::take(&mut found.cells);
        let mut snapshots = Array3::zeros((all.len(), self.array().len(), count));
        for (mut cell, channels) in all.into_iter().zip(raw.outer_iter()) {
            let bin = cell.peak.doppler_bin;
            if let Some(folds) = &self.folds {
                let noise_power = cell.peak.detection.noise_power;
                let dopplers = self.map.power.ncols();
                let (fold, probability) = folds.decide(channels, bin, dopplers, noise_power)?;
                found.counts.undecided_folds += usize::from(!folds.is_certain(probability));
                cell.fold = fold;
                cell.fold_probability = Some(probability);
                cell.rate_mps += f64::from(fold) * rate_of_a_fold;
                cell.range_m = self.cell_range_m(&cell.peak, cell.rate_mps);
            }
            if !self.region.contains(cell.range_m, cell.rate_mps) {
                found.counts.outside_region += 1;
                continue;
            }
            let own = self.decode(channels, bin, cell.fold)?;
            snapshots.index_axis_mut(Axis(0), found.cells.len()).assign(&own);
            found.cells.push(cell);
        }
        snapshots.slice_collapse(ndarray::s![..found.cells.len(), .., ..]);
        Ok(snapshots)
    }

    /// As [`Chain::cell_snapshot`] of the channels of one cell in several frames, as measured.
    pub(crate) fn cell_snapshots_of(
        &self,
        raw: ArrayView2<'_, Complex64>,
        doppler_bin: usize,
    ) -> Result<Array2<Complex64>, PipelineError> {
        let bin = doppler_bin as f64;
        let fold = match &self.folds {
            Some(folds) => folds.decide(raw, bin, self.map.power.ncols(), 0.0)?.0,
            None => 0,
        };
        self.decode(raw, bin, fold)
    }

    /// The array's snapshots, elements x snapshots, of the channels of one cell as measured.
    fn decode(
        &self,
        raw: ArrayView2<'_, Complex64>,
        doppler_bin: f64,
        fold: i32,
    ) -> Result<Array2<Complex64>, PipelineError> {
        let Waveform { transmitters, multiplexing, .. } = *self.waveform();
        let step = tdm::phase_step_rad(doppler_bin, self.map.power.ncols(), transmitters, fold);
        let mut snapshots = Array2::zeros((self.array().len(), raw.ncols()));
        for (measured, mut snapshot) in raw.columns().into_iter().zip(snapshots.columns_mut()) {
            let mut values = measured.to_vec();
            match multiplexing {
                Multiplexing::TimeDivision => tdm::compensate(&mut values, transmitters, step)?,
                Multiplexing::BinaryPhase => binary_phase::decode(&mut values, transmitters, step)?,
                Multiplexing::DopplerDivision => {}
            }
            if let Some(correction) = self.array().correction() {
                correction.apply(&mut values);
            }
            for ((own, &channel), sign) in snapshot.iter_mut().zip(&self.channels).zip(&self.signs)
            {
                *own = values[channel] * sign;
            }
        }
        Ok(snapshots)
    }
}

/// What takes the sign of turned antennas off the samples of each element.
pub(crate) fn signs_of(array: &Array) -> impl Iterator<Item = f64> {
    array.channels().iter().map(|&channel| if array.is_inverted(channel) { -1.0 } else { 1.0 })
}
