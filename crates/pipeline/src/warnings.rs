//! Remarks of many estimates, each kind once.

use crate::result::Remark;
use boresight_aoa::Warning;

/// Collects warnings by kind.
#[derive(Debug, Default)]
pub(crate) struct Warnings {
    kinds: Vec<(&'static str, String, usize)>,
}

impl Warnings {
    /// Adds the warnings of one cell.
    pub fn add(&mut self, warnings: &[Warning]) {
        for warning in warnings {
            match self.kinds.iter_mut().find(|(code, ..)| *code == warning.code()) {
                Some((_, _, cells)) => *cells += 1,
                None => self.kinds.push((warning.code(), warning.to_string(), 1)),
            }
        }
    }

    /// One remark a kind, with the number of cells it concerns.
    pub fn into_remarks(self) -> Vec<Remark> {
        self.kinds
            .into_iter()
            .map(|(code, first, cells)| match cells {
                1 => Remark { code, message: first },
                _ => {
                    Remark { code, message: format!("{first} ({cells} cells; this is the first)") }
                }
            })
            .collect()
    }
}
