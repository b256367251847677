//! Which radars of a fleet somebody should look at, and why.

use super::words::{degrees, sane, shown, trimmed};
use crate::fleet::{Fleet, Vehicle, VehicleRadar};
use boresight_mounting::{Alignment, wrap};
use boresight_report::within;

/// Why a radar needs attention, the most urgent first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Need {
    /// Its angle differs from nominal beyond the limit and chance.
    Misaligned,
    /// Its angle changed at once.
    Knocked,
    /// Its angle drifts.
    Drifting,
    /// It lies unlike those of the other vehicles.
    Unlike,
    /// The drives do not decide whether it is aligned, or do not tell its angle.
    Undecided,
}

impl Need {
    /// All, in their order.
    pub const ALL: [Self; 5] =
        [Self::Misaligned, Self::Knocked, Self::Drifting, Self::Unlike, Self::Undecided];

    /// In a word or two.
    #[must_use]
    pub fn title(self) -> &'static str {
        match self {
            Self::Misaligned => "misaligned",
            Self::Knocked => "knocked",
            Self::Drifting => "drifting",
            Self::Unlike => "unlike the others",
            Self::Undecided => "undecided",
        }
    }
}

/// A radar that needs attention.
#[derive(Debug, Clone, PartialEq)]
pub struct Attention {
    /// Which vehicle of the fleet, from 0.
    pub vehicle: usize,
    /// Which radar of the vehicle, from 0.
    pub radar: usize,
    /// Why, with a phrase that says by how much; at least one, the most urgent first.
    pub needs: Vec<(Need, String)>,
}

/// The radars that need attention: by their most urgent need, then in the order of the fleet.
#[must_use]
pub fn attention(fleet: &Fleet) -> Vec<Attention> {
    let mut all = vec![];
    for (vehicle, of) in fleet.vehicles.iter().enumerate() {
        for (radar, told) in of.radars.iter().enumerate() {
            let needs = needs(of, told);
            if !needs.is_empty() {
                all.push(Attention { vehicle, radar, needs });
            }
        }
    }
    // The sort is stable.
    all.sort_by_key(|attention| attention.needs.first().map(|(need, _)| *need));
    all
}

/// How many radars have each need, in words; none where there is none.
#[must_use]
pub fn counts(all: &[Attention]) -> Option<String> {
    let count = |need: Need| {
        let has = |a: &&Attention| a.needs.iter().any(|(other, _)| *other == need);
        all.iter().filter(has).count()
    };
    let told: Vec<String> = Need::ALL
        .into_iter()
        .filter(|need| count(*need) > 0)
        .map(|need| format!("{} {}", count(need), need.title()))
        .collect();
    (!told.is_empty()).then(|| told.join(", "))
}

/// What a drive's number or a day is called.
pub(super) fn unit(vehicle: &Vehicle) -> &'static str {
    if vehicle.timed { "day" } else { "drive" }
}

fn needs(vehicle: &Vehicle, radar: &VehicleRadar) -> Vec<(Need, String)> {
    let mut needs = vec![];
    let off = |rad: f64| within(degrees(rad), degrees(radar.sigma_rad), 3, " deg off nominal");
    let place = radar.nominal_rad.map(|nominal| off(wrap(radar.angle_rad - nominal)));
    if radar.alignment == Some(Alignment::Misaligned) {
        needs.push((Need::Misaligned, place.clone().unwrap_or_default()));
    }
    if let Some(largest) =
        radar.knocks.iter().max_by(|a, b| a.step_rad.abs().total_cmp(&b.step_rad.abs()))
    {
        let name = vehicle.drives.get(largest.drive).map_or("", |drive| &drive.name);
        let step = within(degrees(largest.step_rad), degrees(largest.sigma_rad), 3, " deg");
        let count = match radar.knocks.len() {
            1 => String::new(),
            more => format!("{more} times, most "),
        };
        needs.push((Need::Knocked, format!("{count}by {step} before \"{}\"", shown(name))));
    }
    if let Some(drift) = radar.drift {
        let unit = format!(" deg a {}", unit(vehicle));
        let rate = trimmed(degrees(drift.rate_rad), degrees(drift.sigma_rad), &unit);
        needs.push((Need::Drifting, format!("by {rate}")));
    }
    if let Some(deviations) = radar.outlying {
        let far = match sane(deviations).is_finite() {
            true => format!("{:.1} deviations from them", deviations.abs()),
            false => "far from them".into(),
        };
        needs.push((Need::Unlike, far));
    }
    if radar.alignment == Some(Alignment::Undecided) {
        needs.push((Need::Undecided, place.unwrap_or_default()));
    } else if !(radar.sigma_rad.is_finite() && radar.angle_rad.is_finite()) {
        needs.push((Need::Undecided, "no drive tells the angle".into()));
    }
    needs
}
