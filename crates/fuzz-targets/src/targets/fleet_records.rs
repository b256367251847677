//! Records of fleets: what is read comes to vehicles whose deviations are possible, or is refused.

use boresight_fleet::gather::gather;
use boresight_fleet::{FleetOptions, merge};

/// Checks one input.
pub fn check(bytes: &[u8]) {
    let path = std::env::temp_dir().join(format!("boresight-fuzz-{}.jsonl", std::process::id()));
    std::fs::write(&path, bytes).expect("there is room");
    let Ok(gathered) = gather(std::slice::from_ref(&path), None, false) else { return };
    let Ok(fleet) = merge::merge(gathered, &FleetOptions::default(), 1) else { return };
    for radar in fleet.vehicles.iter().flat_map(|vehicle| &vehicle.radars) {
        assert!(radar.sigma_rad >= 0.0, "{radar:?}");
        assert!(radar.angle_rad.is_finite() || radar.sigma_rad.is_infinite());
    }
}
