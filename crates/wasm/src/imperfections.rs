//! What is wrong with an array.

use crate::error::Fallible;
use crate::read::Fields;
use boresight_core::imperfections::ImperfectionSpread;
use boresight_core::{Array, Imperfections};

/// Draws the imperfections asked for in the field `imperfections`, from `seed` if they name none.
pub fn read_imperfections(
    fields: &mut Fields,
    array: &Array,
    seed: u64,
) -> Fallible<Option<Imperfections>> {
    let Some(mut fields) = fields.object("imperfections")? else { return Ok(None) };
    let spread = ImperfectionSpread {
        gain_db: fields.optional("gainDb")?.unwrap_or(0.0),
        phase_rad: fields.optional::<f64>("phaseDeg")?.unwrap_or(0.0).to_radians(),
        position: fields.optional("position")?.unwrap_or(0.0),
        coupling_db: fields.optional("couplingDb")?,
    };
    let seed = fields.optional("seed")?.unwrap_or(seed);
    fields.finish()?;
    Ok(Some(Imperfections::random(array, spread, seed)?))
}
