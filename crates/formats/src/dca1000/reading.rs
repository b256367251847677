//! What overrides a configuration in how samples are read.

use super::layout::Layout;
use crate::error::FormatError;
use crate::mmwave_cfg::RadarConfig;
use boresight_options::Described;
use serde::{Deserialize, Serialize};

/// Order of I and Q in a capture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Described, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum IqOrder {
    /// As the configuration says; a remark tells where the data contradict.
    #[default]
    Configured,
    /// As the data tell; as the configuration says where they do not.
    Auto,
    /// I first.
    Iq,
    /// Q first.
    Qi,
}

/// Lanes over which a board of one chip hands its samples to the capture card.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Described, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Lanes {
    /// As the configuration says.
    #[default]
    Configured,
    /// Two: receivers one after another.
    Two,
    /// Four: receivers sample by sample.
    Four,
}

/// How the samples of a capture are read, where its configuration does not say so or says it wrong.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Described, Serialize, Deserialize)]
#[serde(default)]
pub struct ReadingOptions {
    /// Order of I and Q.
    pub iq_order: IqOrder,
    /// Lanes of the board.
    pub lanes: Lanes,
}

impl ReadingOptions {
    /// Puts what was asked for into a configuration. `auto` leaves the order as it is; see [`super::Settled`].
    ///
    /// # Errors
    /// [`FormatError::Layout`] for lanes of a cascade.
    pub fn apply(&self, config: &mut RadarConfig) -> Result<(), FormatError> {
        match self.iq_order {
            IqOrder::Configured | IqOrder::Auto => {}
            IqOrder::Iq => config.adc.q_first = false,
            IqOrder::Qi => config.adc.q_first = true,
        }
        let layout = match self.lanes {
            Lanes::Configured => return Ok(()),
            Lanes::Two => Layout::TwoLane,
            Lanes::Four => Layout::FourLane,
        };
        if config.adc.layout == Layout::Cascade {
            return Err(FormatError::Layout {
                what: "lanes",
                expected: "none, since the board is a cascade of chips".into(),
                given: if layout == Layout::TwoLane { "two" } else { "four" }.into(),
            });
        }
        config.adc.layout = layout;
        Ok(())
    }
}
