//! What is told of a calibration: its facts in words, for a terminal and for paper, and a page of HTML to print or to keep, with
//! verdict, plots, conditions and where it all came from. The page asks for nothing from elsewhere; other reports are made of the same parts.

pub mod chart;
pub mod escape;
mod facts;
mod figures;
pub mod html;
mod page;
mod recorder;

pub use facts::{Fact, Place, facts, sentence, within};
pub use page::{About, Radar, Source, page, verdict};
pub use recorder::Recorder;
