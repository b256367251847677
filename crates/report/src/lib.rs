//! Calibration reports: facts as text, and a printable HTML page with the verdict, plots, conditions and sources. The page loads
//! nothing; reports of fleets use the same parts.

mod axis;
pub mod chart;
mod facts;
mod figures;
pub mod html;
mod page;
mod recorder;

pub use facts::{Fact, Place, facts, sentence, within};
pub use page::{About, Radar, Source, page, verdict};
pub use recorder::Recorder;
