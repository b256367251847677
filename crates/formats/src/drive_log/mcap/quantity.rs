//! Which numbers of a detection are what, by their names, and the detection they make.

use super::super::motion;
use boresight_core::drive::Detection;

/// What a number of a detection is, in the radar's frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Quantity {
    X,
    Y,
    Z,
    Range,
    Azimuth,
    Elevation,
    Rate,
    Vx,
    Vy,
    Vz,
    Rcs,
}

const COUNT: usize = Quantity::Rcs as usize + 1;

/// Names in lower case without what is neither letter nor digit, the best first.
const NAMES: [(Quantity, &[&str]); COUNT] = [
    (
        Quantity::X,
        &["x", "positionx", "posx", "distlong", "distancelongx", "distancelong", "longdist"],
    ),
    (Quantity::Y, &["y", "positiony", "posy", "distlat", "distancelaty", "distancelat", "latdist"]),
    (Quantity::Z, &["z", "positionz", "posz"]),
    (Quantity::Range, &["range", "distance", "radialdistance", "dist", "r", "rangesc"]),
    (Quantity::Azimuth, &["azimuth", "azimuthangle", "bearing", "az", "angle", "azimuthsc"]),
    (Quantity::Elevation, &["elevation", "elevationangle", "el", "elev"]),
    (
        Quantity::Rate,
        &[
            "rangerate",
            "dopplervelocity",
            "radialvelocity",
            "velocityradial",
            "dopplerspeed",
            "radialspeed",
            "doppler",
            "vr",
            "vrad",
            "vradial",
            "vdoppler",
            "velocity",
            "vel",
            "v",
        ],
    ),
    (Quantity::Vx, &["vx", "velocityx", "velx", "vrellong", "speedlongx", "relativevelocityx"]),
    (Quantity::Vy, &["vy", "velocityy", "vely", "vrellat", "speedlaty", "relativevelocityy"]),
    (Quantity::Vz, &["vz", "velocityz", "velz", "relativevelocityz"]),
    (Quantity::Rcs, &["rcs", "radarcrosssection"]),
];

/// What vendors put before each name.
const PREFIXES: [&str; 7] = ["obj", "object", "det", "detection", "cluster", "target", "f"];

/// Units at the end of a name, and what brings them to metres and radians.
const UNITS: [(&str, f64); 9] = [
    ("m", 1.0),
    ("mps", 1.0),
    ("ms", 1.0),
    ("rad", 1.0),
    ("deg", std::f64::consts::PI / 180.0),
    ("degree", std::f64::consts::PI / 180.0),
    ("degrees", std::f64::consts::PI / 180.0),
    ("dbsm", 1.0),
    ("db", 1.0),
];

/// The quantity of a name, how good the name is (less is better), and what brings it to SI units.
fn quantity(name: &str) -> Option<(Quantity, usize, f64)> {
    let name = name.to_ascii_lowercase();
    let find = |name: &str| {
        let plain: String = name.chars().filter(char::is_ascii_alphanumeric).collect();
        NAMES.iter().find_map(|(quantity, names)| {
            let rank = names.iter().position(|known| *known == plain)?;
            Some((*quantity, rank))
        })
    };
    let stems = |name: &str| {
        find(name).or_else(|| {
            let (prefix, rest) = name.split_once('_')?;
            PREFIXES.contains(&prefix).then(|| find(rest)).flatten()
        })
    };
    if let Some((quantity, rank)) = stems(&name) {
        return Some((quantity, rank, 1.0));
    }
    let (stem, unit) = name.rsplit_once('_')?;
    let (_, factor) = UNITS.iter().find(|(known, _)| *known == unit)?;
    stems(stem).map(|(quantity, rank)| (quantity, rank, *factor))
}

/// Where the quantities of a detection stand among numbers with names.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Layout([Option<(usize, f64)>; COUNT]);

impl Layout {
    /// By the names.
    pub fn of_names<'a>(names: impl Iterator<Item = &'a str>) -> Self {
        let mut best = [usize::MAX; COUNT];
        let mut layout = Self::default();
        for (place, name) in names.enumerate() {
            if let Some((quantity, rank, factor)) = quantity(name)
                && rank < best[quantity as usize]
            {
                best[quantity as usize] = rank;
                layout.0[quantity as usize] = Some((place, factor));
            }
        }
        layout
    }

    fn has(&self, quantities: &[Quantity]) -> bool {
        quantities.iter().all(|quantity| self.0[*quantity as usize].is_some())
    }

    /// The place of a quantity.
    pub fn place(&self, quantity: Quantity) -> Option<usize> {
        self.0[quantity as usize].map(|(place, _)| place)
    }

    /// What keeps these numbers from being a detection.
    pub fn lacks(&self) -> Option<&'static str> {
        let is_place = self.has(&[Quantity::X, Quantity::Y]);
        if !is_place && !self.has(&[Quantity::Azimuth]) {
            return Some("no fields x and y, nor azimuth");
        }
        let is_rate =
            self.has(&[Quantity::Rate]) || (self.has(&[Quantity::Vx, Quantity::Vy]) && is_place);
        (!is_rate).then_some("no field of a velocity that is not compensated for the car's motion")
    }

    /// The detection of numbers, given by their places, if azimuth and range rate are finite. Velocities
    /// of which only the parts are there are taken along the ray. `mirrored` is for azimuths that are
    /// positive to the right.
    pub fn detection(
        &self,
        number: impl Fn(usize) -> Option<f64>,
        mirrored: bool,
    ) -> Option<Detection> {
        let get = |quantity: Quantity| {
            let (place, factor) = self.0[quantity as usize]?;
            Some(number(place)? * factor)
        };
        let (azimuth, range) = match (get(Quantity::X), get(Quantity::Y)) {
            (Some(x), Some(y)) => {
                let z = get(Quantity::Z).filter(|z| z.is_finite()).unwrap_or(0.0);
                (y.atan2(x), x.hypot(y).hypot(z))
            }
            _ => {
                let sign = if mirrored { -1.0 } else { 1.0 };
                (sign * get(Quantity::Azimuth)?, get(Quantity::Range).unwrap_or(f64::NAN))
            }
        };
        let rate = get(Quantity::Rate).or_else(|| {
            let along = |speed: Quantity, place: Quantity| {
                Some(get(speed)? * get(place)?).filter(|part| part.is_finite())
            };
            let height = along(Quantity::Vz, Quantity::Z).unwrap_or(0.0);
            let flat = along(Quantity::Vx, Quantity::X)? + along(Quantity::Vy, Quantity::Y)?;
            Some((flat + height) / range)
        });
        let rcs = get(Quantity::Rcs).unwrap_or(f64::NAN);
        motion::detection(azimuth, rate?, range, rcs)
    }

    /// Whether a detection lacks a number that its fields have.
    pub fn is_incomplete(&self, detection: &Detection) -> bool {
        let has_range = self.has(&[Quantity::Range]) || self.has(&[Quantity::X, Quantity::Y]);
        let has_rcs = self.has(&[Quantity::Rcs]);
        (has_range && detection.range_m.is_nan()) || (has_rcs && detection.rcs_dbsm.is_nan())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn layout(names: &[&str]) -> Layout {
        Layout::of_names(names.iter().copied())
    }

    #[test]
    fn names_are_known_in_any_case_with_units_and_prefixes() {
        for (name, expected, factor) in [
            ("V_R", Quantity::Rate, 1.0),
            ("radial_velocity_mps", Quantity::Rate, 1.0),
            ("Azimuth_Deg", Quantity::Azimuth, 1.0_f64.to_radians()),
            ("Obj_DistLong", Quantity::X, 1.0),
            ("position.y", Quantity::Y, 1.0),
            ("rcs_dbsm", Quantity::Rcs, 1.0),
        ] {
            let found = quantity(name).map(|(quantity, _, factor)| (quantity, factor));
            assert_eq!(found, Some((expected, factor)), "{name}");
        }
        for name in ["vx_comp", "v_r_compensated", "vr_comp", "intensity", "amplitude", ""] {
            assert_eq!(quantity(name), None, "{name}");
        }
        // The better name wins, wherever it stands.
        let both = layout(&["velocity", "x", "doppler_velocity", "y"]);
        assert_eq!(both.place(Quantity::Rate), Some(2));
    }

    #[test]
    fn parts_of_a_velocity_are_taken_along_the_ray() {
        let parts = layout(&["x", "y", "z", "vx", "vy", "vz"]);
        assert_eq!(parts.lacks(), None);
        let numbers = [2.0, -6.0, 3.0, 4.0, 5.0, 1.0];
        let found = parts.detection(|place| numbers.get(place).copied(), false).unwrap();
        assert_eq!(f64::from(found.range_m), 7.0);
        assert_eq!(found.azimuth_rad, (-6.0_f32).atan2(2.0));
        assert_eq!(found.range_rate_mps, ((8.0 - 30.0 + 3.0) / 7.0) as f32);
        // At the radar itself there is no ray.
        assert!(parts.detection(|_| Some(0.0), false).is_none());
    }

    #[test]
    fn what_is_no_detection_says_what_it_lacks() {
        assert!(layout(&["x", "y", "z", "intensity"]).lacks().unwrap().contains("velocity"));
        assert!(layout(&["range", "velocity"]).lacks().unwrap().contains("azimuth"));
        assert!(layout(&["azimuth", "vx", "vy"]).lacks().is_some());
        assert!(layout(&["azimuth", "doppler"]).lacks().is_none());
    }

    #[test]
    fn azimuths_can_be_mirrored_and_places_cannot() {
        let angles = layout(&["range", "azimuth", "doppler_velocity"]);
        let get = |place: usize| [9.0, 0.25, -3.0].get(place).copied();
        assert_eq!(angles.detection(get, false).unwrap().azimuth_rad, 0.25);
        assert_eq!(angles.detection(get, true).unwrap().azimuth_rad, -0.25);
        let places = layout(&["x", "y", "velocity"]);
        assert!(places.detection(|_| Some(1.0), true).unwrap().azimuth_rad > 0.0);
    }
}
