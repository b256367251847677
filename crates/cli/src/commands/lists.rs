//! `boresight methods` and `boresight arrays`.

use crate::error::CliError;
use boresight_aoa::Method;
use boresight_core::array::Extent;
use boresight_core::presets::{PRESETS, preset};
use serde_json::{Value, json};

/// The methods and what each needs.
pub fn methods(as_json: bool) -> Result<String, CliError> {
    if as_json {
        let list: Vec<Value> = Method::ALL
            .into_iter()
            .chain(Method::NETWORKS)
            .map(|method| {
                let mut entry = json!(method.requirements());
                entry["name"] = method.name().into();
                entry
            })
            .collect();
        return Ok(format!("{:#}\n", Value::Array(list)));
    }
    let mut text = format!(
        "{:<22} {:<10} {:<12} {:<10} {:<8} {}\n",
        "method", "snapshots", "array", "elevation", "sources", "reference"
    );
    for method in Method::ALL.into_iter().chain(Method::NETWORKS) {
        let needs = method.requirements();
        let snapshots = match needs.max_snapshots {
            Some(most) if most == needs.min_snapshots => most.to_string(),
            Some(most) => format!("{} to {most}", needs.min_snapshots),
            None => format!("{} or more", needs.min_snapshots),
        };
        let array = match (needs.uniform_array, needs.lattice) {
            (true, _) => "even spacing",
            (_, true) => "on a grid",
            _ => "any",
        };
        text += &format!(
            "{:<22} {snapshots:<10} {array:<12} {:<10} {:<8} {}\n",
            method.name(),
            if needs.elevation { "yes" } else { "no" },
            if needs.source_count { "number" } else { "found" },
            needs.reference,
        );
    }
    text += "\nsnapshots: of one cell; averaging and smoothing make more of one.\n\
             sources: whether their number must be given or counted (--sources) beforehand.\n\
             aaetr, learned-pursuit, dnn and cnn3d are networks and need a trained model (--model).\n";
    Ok(text)
}

/// The arrays known by name.
pub fn arrays(as_json: bool) -> Result<String, CliError> {
    let mut list = vec![];
    let mut text = format!(
        "{:<10} {:>3} {:>3} {:>9} {:>9}  {:<22} {}\n",
        "array", "tx", "rx", "elements", "aperture", "sees", "unambiguous"
    );
    for name in PRESETS.into_iter().chain(["ula8"]) {
        let array = preset(name)?;
        let (tx, rx, elements) = (array.tx().len(), array.rx().len(), array.len());
        let sees = match array.extent() {
            Extent::Area => "azimuth and elevation",
            Extent::Azimuth => "azimuth",
            Extent::Line => "the angle to its line",
            Extent::Point => "no angle",
        };
        let sector_deg = array.lattice().map_or(90.0, |l| l.unambiguous_sine().asin().to_degrees());
        list.push(json!({
            "name": name,
            "transmitters": tx,
            "receivers": rx,
            "elements": elements,
            "aperture": array.aperture(),
            "sees": sees,
            "unambiguousDeg": sector_deg,
            "positions": array.positions(),
        }));
        text += &format!(
            "{name:<10} {tx:>3} {rx:>3} {elements:>9} {:>9}  {sees:<22} {sector_deg:.0} deg\n",
            array.aperture()
        );
    }
    if as_json {
        return Ok(format!("{:#}\n", Value::Array(list)));
    }
    text += "\naperture: along y, half wavelengths. ulaN is N elements half a wavelength apart.\n";
    Ok(text)
}
