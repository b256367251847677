//! A world as dense and as high as radars of today see it.

use super::model;
use super::patches::square;
use crate::drive::motion::Path;
use crate::drive::scenario::{Scenario, sign};
use crate::drive::world::{Kind, Reflector, World};
use boresight_core::Random;

/// Makes several reflectors of each, scattered around it, and gives all a height. Stretches differ
/// in how many they hold.
pub(crate) fn enrich(world: World, path: &Path, scenario: Scenario, random: &mut Random) -> World {
    let mut rich = World::default();
    let key = random.bits();
    for reflector in world.into_reflectors() {
        let mut copies = model::COPIES * crowding(key, &reflector);
        let mut first = true;
        while first || random.unit() < copies {
            let mut copy = Reflector { height_m: height_m(reflector.kind, random), ..reflector };
            if !first {
                let [x, y] = reflector.outward;
                let along = random.uniform(-1.0, 1.0) * model::COPY_ALONG_M;
                let away = -model::COPY_AWAY_M * libm::log(1.0 - random.unit());
                copy.x_m += away * x - along * y;
                copy.y_m += away * y + along * x;
                copy.rcs_dbsm += model::COPY_DB + model::COPY_SPREAD_DB * random.normal();
                copy.shadow_db = 0.0;
                copies -= 1.0;
            }
            first = false;
            rich.push(copy);
        }
    }
    if scenario == Scenario::Motorway {
        gantries(&mut rich, path, random);
    }
    rich
}

/// How much more or less than elsewhere stands in a square of ground.
fn crowding(key: u64, reflector: &Reflector) -> f64 {
    let sigma = model::CROWD_SIGMA;
    let mut random = square(key, reflector.x_m, reflector.y_m, model::CROWD_M);
    libm::exp(sigma * random.normal() - 0.5 * sigma * sigma)
}

/// Height above the ground of a reflection, m.
pub(crate) fn height_m(kind: Kind, random: &mut Random) -> f64 {
    let [from, to] = match kind {
        Kind::Ground => [0.0, 0.8],
        Kind::ParkedCar => [0.5, 1.5],
        Kind::Rail => [0.5, 1.0],
        Kind::Tree | Kind::Pole => [0.5, 6.5],
        Kind::Wall => [0.5, 8.5],
    };
    random.uniform(from, to)
}

/// Signs across the road.
fn gantries(world: &mut World, path: &Path, random: &mut Random) {
    let mut along_m = random.uniform(0.0, model::GANTRY_EVERY_M);
    while along_m < path.length_m() + 100.0 {
        for _ in 0..model::GANTRY_REFLECTORS {
            let left_m = 6.0 * random.unit() * sign(random);
            let at = path.at(along_m + 0.3 * random.normal(), left_m);
            world.push(Reflector {
                kind: Kind::Pole,
                x_m: at.x_m,
                y_m: at.y_m,
                height_m: model::GANTRY_HEIGHT_M,
                outward: [0.0; 2],
                half_m: [0.0; 2],
                rcs_dbsm: 4.0 + 4.0 * random.normal(),
                flat: false,
                shadow_db: 0.0,
            });
        }
        along_m += model::GANTRY_EVERY_M * random.uniform(0.7, 1.3);
    }
}
