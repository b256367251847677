//! Training cells around a cell under test.

/// Training cells around a cell under test: in the half before it and in the half after it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TrainingCells {
    /// Cells of smaller range, or of the same range and smaller rate.
    pub before: usize,
    /// Cells of greater range, or of the same range and greater rate.
    pub after: usize,
}

impl TrainingCells {
    /// Both halves.
    pub fn total(self) -> usize {
        self.before + self.after
    }
}
