//! Where the antennas are: of a known board, or from the lines `antGeometry0`, `antGeometry1` and `antPhaseRot` of
//! Texas Instruments' 3D People Tracking and its kin.

use super::line::{Line, clipped};
use crate::error::FormatError;
use boresight_core::array::Position;
use boresight_core::{Array, Remark};

/// Virtual elements a line tells of: as many as 4 transmitters and 4 receivers make.
const MOST: usize = 16;

/// Receivers of one chip.
const RECEIVERS: usize = 4;

/// What the three lines say, a number for each transmitter with each receiver, in the order of their numbers on the chip.
#[derive(Default)]
pub(super) struct AntennaLines {
    /// Along y and along z, half wavelengths.
    places: [Option<Vec<f64>>; 2],
    /// 1 or -1.
    signs: Option<Vec<f64>>,
    last: usize,
}

impl AntennaLines {
    /// Takes one of the lines.
    pub fn take(&mut self, line: &Line<'_>) -> Result<(), FormatError> {
        line.count(RECEIVERS, MOST)?;
        if !line.arguments.len().is_multiple_of(RECEIVERS) {
            let given = line.arguments.len().to_string();
            return Err(line.error("the number of arguments", "4 for each transmitter", given));
        }
        let signs = line.command == "antPhaseRot";
        let numbers = (0..line.arguments.len())
            .map(|k| match line.number(k, "value", -1e3, 1e3)? {
                sign if signs && sign.abs() != 1.0 => {
                    Err(line.error("value", "1 or -1 (turned by half a turn)", sign.to_string()))
                }
                number => Ok(number),
            })
            .collect::<Result<Vec<f64>, _>>()?;
        self.last = line.number;
        match line.command {
            "antGeometry0" => self.places[0] = Some(numbers),
            "antGeometry1" => self.places[1] = Some(numbers),
            _ => self.signs = Some(numbers),
        }
        Ok(())
    }

    /// The board's array, transmitters and receivers in the order of their numbers on the chip; nothing without the lines.
    ///
    /// # Errors
    /// [`FormatError::Config`] where one of the lines is missing, they differ in length, or the elements are not those of
    /// transmitters and receivers.
    pub fn board(self) -> Result<Option<Array>, FormatError> {
        let line = Line { number: self.last, command: "antGeometry0", arguments: vec![] };
        let (y, z) = match self.places {
            [Some(y), Some(z)] => (y, z),
            [None, None] => return Ok(None),
            _ => return Err(line.error("lines", "antGeometry0 and antGeometry1", "one of them")),
        };
        let signs = self.signs.unwrap_or_else(|| vec![1.0; y.len()]);
        if y.len() != z.len() || y.len() != signs.len() {
            let given = format!("{}, {} and {}", y.len(), z.len(), signs.len());
            let lines = "as many values in antGeometry0, antGeometry1 and antPhaseRot";
            return Err(line.error("lines", lines, given));
        }
        let apart = |k: usize| -> Position { [0.0, y[k] - y[0], z[k] - z[0]] };
        let tx: Vec<Position> = (0..y.len()).step_by(RECEIVERS).map(apart).collect();
        let rx: Vec<Position> = (0..RECEIVERS).map(apart).collect();
        let turned = |k: usize| signs[k] != signs[0];
        let turned_tx: Vec<bool> = (0..y.len()).step_by(RECEIVERS).map(turned).collect();
        let turned_rx: Vec<bool> = (0..RECEIVERS).map(turned).collect();
        let array = Array::mimo(&tx, &rx)?.with_inverted(&turned_tx, &turned_rx)?;
        for (k, (position, channel)) in array.positions().iter().zip(array.channels()).enumerate() {
            if *position != apart(k) || array.is_inverted(*channel) != turned(k) {
                return Err(line.error(
                    format!("element {}", k + 1),
                    "where its transmitter and its receiver put it, with their signs",
                    format!("{:?}, sign {}", apart(k), signs[k]),
                ));
            }
        }
        Ok(Some(array))
    }
}

/// The preset of a platform's evaluation board, with what is assumed of it.
pub(super) fn preset_of(platform: &str) -> Option<(&'static str, Option<Remark>)> {
    let name = match platform.to_ascii_lowercase().as_str() {
        "xwr16xx" | "awr1642" | "iwr1642" => "awr1642",
        "xwr18xx" | "awr1843" | "iwr1843" => "awr1843",
        "iwr6843isk" | "awr6843isk" => "iwr6843isk",
        "xwr68xx_aop" | "iwr6843aop" | "awr6843aop" => "iwr6843aop",
        "xwr68xx_ods" | "iwr6843ods" | "iwr6843isk-ods" | "awr6843ods" => "iwr6843ods",
        "xwr68xx" | "iwr6843" | "awr6843" => {
            let message = format!(
                "platform {} has boards of several antennas: those of the ISK are assumed; of an AOP or ODS, choose the array",
                clipped(platform)
            );
            return Some(("iwr6843isk", Some(Remark::new("board-assumed", message))));
        }
        _ => return None,
    };
    Some((name, None))
}
