//! The frame that `--frame` asks for.

use crate::error::CliError;

/// The index `--frame` asks for, checked against their number.
pub fn frame_within(frame: usize, count: usize) -> Result<usize, CliError> {
    if frame < count {
        return Ok(frame);
    }
    Err(CliError::Option {
        option: "--frame",
        expected: match count {
            0 => "no frame, since there is none".into(),
            _ => format!("0 to {}", count - 1),
        },
        given: frame.to_string(),
    })
}
