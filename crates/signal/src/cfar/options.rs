//! Options of detection.

use super::bin_noise::BinNoise;
use boresight_options::Described;
use serde::{Deserialize, Serialize};

/// How noise is estimated from the training cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Described, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum CfarKind {
    /// The mean of those that are no targets themselves (Goldman and Bar-David 1988): keeps targets
    /// apart, and the rate beside them.
    #[default]
    Excision,
    /// The mean of all (Finn and Johnson 1968): the least loss in even noise; a strong target hides a
    /// weaker one among whose training cells it is.
    CellAveraging,
    /// The larger of the means of the halves (Hansen and Sawyers 1980): keeps the rate at clutter
    /// edges.
    GreatestOf,
    /// The smaller of the means of the halves (Trunk 1978): keeps targets apart.
    SmallestOf,
    /// The cell of a rank (Rohling 1983): keeps targets apart and most of the rate.
    OrderedStatistic,
}

/// Along which axes training cells lie.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Described, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum CfarAxes {
    /// Range only: in a scene that stands still all power lies at zero Doppler, and a window across
    /// it would see no noise like the cell's own.
    #[default]
    Range,
    /// Doppler only.
    Doppler,
    /// A ring around the cell in both.
    Both,
}

/// How detection works.
#[derive(Debug, Clone, Copy, PartialEq, Described, Serialize, Deserialize)]
#[serde(default)]
pub struct CfarOptions {
    /// The detector of constant false-alarm rate: how it takes the noise from the training cells.
    pub kind: CfarKind,
    /// Axes along which training cells lie.
    pub axes: CfarAxes,
    /// Probability that a cell of noise becomes a detection.
    #[option(default = 1e-6, range = 1e-15..=0.5)]
    pub false_alarm: f64,
    /// Cells left out on each side of the cell under test, along range and Doppler, so that they
    /// cover the main lobe.
    #[option(default = [4, 2])]
    pub guard_cells: [usize; 2],
    /// Cells on each side beyond the guard cells that the noise level is estimated from, along range
    /// and Doppler.
    #[option(default = [8, 4])]
    pub training_cells: [usize; 2],
    /// Which of the ordered training cells stands for the noise, as a share of them.
    #[option(default = 0.75, range = 0..=1)]
    pub rank: f64,
    /// Channels averaged in each cell.
    #[option(default = 1)]
    #[serde(skip)]
    pub looks: usize,
    /// How noise is correlated along range and Doppler, by window and padding: [`crate::RangeDoppler::bin_noise`]. None for
    /// independent cells.
    #[serde(skip)]
    pub noise: [Option<BinNoise>; 2],
}
