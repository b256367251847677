//! How a capture is read in the end: by its configuration, what was asked for, and what the samples tell.

use super::Capture;
use super::evidence::{BeatSides, Evidence};
use super::layout::Layout;
use super::reading::{IqOrder, ReadingOptions};
use crate::error::FormatError;
use crate::mmwave_cfg::RadarConfig;
use boresight_core::Remark;

/// A configuration after which a capture is read, and what is to be said of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Settled {
    /// The configuration, with what overrides it.
    pub config: RadarConfig,
    /// What the samples tell, as they are read in the end.
    pub evidence: Evidence,
    /// What is odd about size, lanes, and the order of I and Q.
    pub remarks: Vec<Remark>,
}

impl Settled {
    /// Decides how the samples in `bytes` are read.
    ///
    /// # Errors
    /// Those of [`Capture::new`] and of [`ReadingOptions::apply`].
    pub fn new(
        bytes: &[u8],
        config: &RadarConfig,
        options: &ReadingOptions,
    ) -> Result<Self, FormatError> {
        let mut config = config.clone();
        options.apply(&mut config)?;
        let capture = Capture::new(bytes, &config)?;
        let mut remarks = capture.remarks().to_vec();
        let mut evidence = Evidence::of(&capture, &config);
        if let Some((layout, gain_db)) = evidence.other_lanes {
            remarks.push(lanes_remark(layout, gain_db));
        } else if let Some(sides) = evidence.sides {
            let swapped = sides.swapped == Some(true);
            let follow = swapped && options.iq_order == IqOrder::Auto;
            remarks.extend(order_remark(&config, &sides, options.iq_order));
            if follow {
                config.adc.q_first = !config.adc.q_first;
                evidence.sides = Some(BeatSides {
                    asymmetry_db: -sides.asymmetry_db,
                    swapped: Some(false),
                    ..sides
                });
            }
        }
        Ok(Self { config, evidence, remarks })
    }
}

/// Names of an order for users.
fn names(q_first: bool) -> (&'static str, &'static str) {
    if q_first { ("Q first", "qi") } else { ("I first", "iq") }
}

fn order_remark(config: &RadarConfig, sides: &BeatSides, asked: IqOrder) -> Option<Remark> {
    let (read, _) = names(config.adc.q_first);
    let (other, option) = names(!config.adc.q_first);
    let power = format!(
        "power at negative beat frequencies, where no echo can be, is {:.1} dB above that at positive ones",
        -sides.asymmetry_db
    );
    Some(match (sides.swapped, asked) {
        (Some(true), IqOrder::Auto) => Remark::new(
            "iq-order-found",
            format!("I and Q are read with {other}, other than configured: with {read}, {power}"),
        ),
        (Some(true), _) => Remark::new(
            "iq-swapped",
            format!(
                "read with {read}, {power}: I and Q seem to be the other way round, which mirrors ranges, rates and \
                 angles; ask for the I/Q order {option}, or for auto"
            ),
        ),
        (None, IqOrder::Auto) => Remark::new(
            "iq-order-not-found",
            format!(
                "the samples do not tell the order of I and Q ({:+.1} dB between the sides of the spectrum, its peak \
                 {:.1} dB over the noise): read with {read}, as configured",
                sides.asymmetry_db, sides.peak_db
            ),
        ),
        _ => return None,
    })
}

fn lanes_remark(layout: Layout, gain_db: f64) -> Remark {
    let (read, other, option) = match layout {
        Layout::FourLane => ("two lanes", "four", "four"),
        _ => ("four lanes", "two", "two"),
    };
    Remark::new(
        "other-lanes",
        format!(
            "the spectrum of echoes has one side, and read as of {other} lanes it has {gain_db:.1} dB more of it than as \
             of {read}: the samples seem to be laid out for {other} lanes; ask for {option} lanes"
        ),
    )
}
