//! A vehicle's equations from those of its drives.

use super::elimination::{Drive, Layout};
use super::part::Part;
use super::vehicle::{Vehicle, unsound};
use super::{CAR, CarVector, DrivePart, MergeOptions};
use crate::angle::wrap;
use crate::error::MountingError;
use crate::recursive::information::Vector;
use boresight_core::InputError;

/// What the vehicle's equations are written about.
pub(super) struct Reference {
    pub(super) angles: Vec<f64>,
    pub(super) car: CarVector,
}

/// All drives about one reference, that of the first to tell of each unknown.
pub(super) fn gather(
    radars: &[u8],
    drives: &[Vec<DrivePart>],
    options: &MergeOptions,
) -> Result<(Vehicle, Reference), MountingError> {
    let angles = radars.len();
    let shared = options.shared();
    let mut numbers = radars.to_vec();
    boresight_math::order::sort_by(&mut numbers, Ord::cmp);
    numbers.dedup();
    let place = |radar: &u8| numbers.binary_search(radar).unwrap_or_default();
    let layout = Layout { radar: radars.iter().map(place).collect(), shared };
    let mut first: Vec<Option<f64>> = vec![None; angles];
    let mut car: Option<CarVector> = None;
    for (index, part) in parts_of(drives) {
        let Some(first) = first.get_mut(part.angle) else {
            let what = format!("angle of a part of drive {index}");
            let (expected, given) = (format!("less than {angles}"), part.angle as f64);
            return Err(InputError::OutOfRange { what, expected, given }.into());
        };
        if !part.equations.is_sound() {
            return Err(unsound(index));
        }
        let reference = &part.equations.reference;
        first.get_or_insert(reference[0]);
        car.get_or_insert(std::array::from_fn(|i| reference[i + 1]));
    }
    let reference = Reference {
        angles: first.iter().map(|first| first.unwrap_or(0.0)).collect(),
        car: car.unwrap_or_default(),
    };
    let size = layout.size();
    let mut prior = vec![Narrowest::default(); size];
    let mut merged = Vec::with_capacity(drives.len());
    for (index, parts) in drives.iter().enumerate() {
        let mut own = [Narrowest::default(); CAR];
        let mut result =
            Drive { parts: Vec::with_capacity(parts.len()), offset: [0.0; CAR], sigma: [0.0; CAR] };
        for DrivePart { angle, equations } in parts {
            let moved = reference.step(*angle, &equations.reference);
            let part = Part::new(*angle, equations, &moved).ok_or_else(|| unsound(index))?;
            result.parts.push(part);
            let mean = reference.step(*angle, &equations.prior);
            let known = &equations.prior_information;
            prior[*angle].take(mean[0], known[0]);
            for i in 0..CAR {
                let prior = if shared[i] { &mut prior[angles + i] } else { &mut own[i] };
                prior.take(mean[i + 1], known[i + 1]);
            }
        }
        for i in (0..CAR).filter(|i| !shared[*i] && own[*i].information > 0.0) {
            result.offset[i] = own[i].mean;
            result.sigma[i] = 1.0 / own[i].information.sqrt();
        }
        merged.push(result);
    }
    // What nothing is said of stands by itself, at the reference.
    let known = |prior: &Narrowest| {
        if prior.information > 0.0 { prior.information } else { 1.0 }
    };
    let vehicle = Vehicle {
        layout,
        drives: merged,
        prior: prior.iter().map(known).collect(),
        prior_right: prior.iter().map(|prior| prior.information * prior.mean).collect(),
        expected_drive: options.drive_sigma_rad * options.drive_sigma_rad,
    };
    Ok((vehicle, reference))
}

fn parts_of(drives: &[Vec<DrivePart>]) -> impl Iterator<Item = (usize, &DrivePart)> {
    let each = |(index, parts)| std::iter::repeat(index).zip(parts);
    drives.iter().enumerate().flat_map(each)
}

/// The narrowest of several priors.
#[derive(Clone, Copy, Default)]
struct Narrowest {
    mean: f64,
    information: f64,
}

impl Narrowest {
    fn take(&mut self, mean: f64, information: f64) {
        if information > self.information {
            *self = Self { mean, information };
        }
    }
}

impl Reference {
    /// From the reference to a state, the shorter way round.
    fn step(&self, angle: usize, state: &Vector) -> Vector {
        std::array::from_fn(|i| match i {
            0 => wrap(state[0] - self.angles[angle]),
            i => state[i] - self.car[i - 1],
        })
    }
}
