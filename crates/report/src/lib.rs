//! What is told of a calibration: its facts in words, for a terminal and for paper, and a page of HTML to print or to keep, with
//! verdict, plots, conditions and where it all came from. The page asks for nothing from elsewhere.

mod chart;
mod facts;
mod figures;
mod page;
mod recorder;

pub use facts::{Fact, facts, sentence};
pub use page::{About, Radar, Source, page};
pub use recorder::Recorder;
