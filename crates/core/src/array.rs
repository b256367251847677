//! Antenna arrays: element positions, real or virtual.

use crate::correction::Correction;
use crate::lattice::Lattice;
use boresight_math::error::{InputError, check_finite};
use boresight_options::Described;
use serde::Serialize;
use std::sync::Arc;

/// Position in the sensor frame, half wavelengths: x forward, y left, z up.
pub type Position = [f64; 3];

/// Most elements an array may have; keeps matrices of its size within memory.
pub const MAX_ELEMENTS: usize = 1024;

/// Positions closer than this count as equal, half wavelengths.
const SAME_POSITION: f64 = 1e-9;

/// Transmitter and receiver a virtual element comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Described, Serialize)]
pub struct Channel {
    /// Index of the transmitter, in the order of transmission.
    pub tx: usize,
    /// Index of the receiver.
    pub rx: usize,
}

/// Which angles an array can tell apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Described, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Extent {
    /// All elements at one point: no angle at all.
    Point,
    /// Elements spread along y alone: azimuth.
    Azimuth,
    /// Elements on one line that is not the y axis: the angle to that line only.
    Line,
    /// Elements spread over an area or a volume: azimuth and elevation.
    Area,
}

/// Positions of the elements of a receiving array. For a MIMO radar these are the virtual
/// elements, at the sum of a transmitter's and a receiver's position.
#[derive(Debug, Clone, PartialEq)]
pub struct Array {
    positions: Vec<Position>,
    channels: Vec<Channel>,
    tx: Vec<Position>,
    rx: Vec<Position>,
    inverted_tx: Vec<bool>,
    inverted_rx: Vec<bool>,
    /// What is known of its errors.
    correction: Option<Arc<Correction>>,
}

impl Array {
    /// An array with one transmitter at the origin and receivers at `positions`.
    ///
    /// # Errors
    /// [`InputError::Empty`] without elements, [`InputError::NotFinite`] for a coordinate that is
    /// not finite, [`InputError::OutOfRange`] above [`MAX_ELEMENTS`] or beyond a million half
    /// wavelengths.
    pub fn new(positions: &[Position]) -> Result<Self, InputError> {
        Self::mimo(&[[0.0; 3]], positions)
    }

    /// The virtual array of a MIMO radar: element `t * rx.len() + r` at `tx[t] + rx[r]`.
    ///
    /// # Errors
    /// As [`Array::new`].
    pub fn mimo(tx: &[Position], rx: &[Position]) -> Result<Self, InputError> {
        check_positions("transmitter positions", tx)?;
        check_positions("receiver positions", rx)?;
        let count = tx.len().saturating_mul(rx.len());
        if count > MAX_ELEMENTS {
            return Err(InputError::OutOfRange {
                what: "number of array elements".into(),
                expected: format!("at most {MAX_ELEMENTS}"),
                given: count as f64,
            });
        }
        let mut positions = Vec::with_capacity(count);
        let mut channels = Vec::with_capacity(count);
        for (t, p) in tx.iter().enumerate() {
            for (r, q) in rx.iter().enumerate() {
                positions.push([p[0] + q[0], p[1] + q[1], p[2] + q[2]]);
                channels.push(Channel { tx: t, rx: r });
            }
        }
        Ok(Self {
            positions,
            channels,
            tx: tx.to_vec(),
            rx: rx.to_vec(),
            inverted_tx: vec![false; tx.len()],
            inverted_rx: vec![false; rx.len()],
            correction: None,
        })
    }

    /// The array with antennas that are mounted turned by half a turn, as on boards that feed some from the other
    /// side: their raw samples have the opposite sign. Positions and steering vectors stay as they are, since whoever
    /// reads raw samples takes the sign off ([`Array::is_inverted`]).
    ///
    /// # Errors
    /// [`InputError::Shape`] for another number of transmitters or receivers.
    pub fn with_inverted(mut self, tx: &[bool], rx: &[bool]) -> Result<Self, InputError> {
        for (what, given, antennas) in [("transmitters", tx, &self.tx), ("receivers", rx, &self.rx)]
        {
            if given.len() != antennas.len() {
                return Err(InputError::Shape {
                    what: format!("inverted {what}"),
                    expected: format!("[{}]", antennas.len()),
                    given: vec![given.len()],
                });
            }
        }
        (self.inverted_tx, self.inverted_rx) = (tx.to_vec(), rx.to_vec());
        Ok(self)
    }

    /// Whether raw samples of a transmitter and a receiver have the opposite sign.
    pub fn is_inverted(&self, channel: Channel) -> bool {
        let of = |inverted: &[bool], index| inverted.get(index).copied().unwrap_or_default();
        of(&self.inverted_tx, channel.tx) != of(&self.inverted_rx, channel.rx)
    }

    /// Which transmitters are mounted turned by half a turn.
    pub fn inverted_tx(&self) -> &[bool] {
        &self.inverted_tx
    }

    /// Which receivers are mounted turned by half a turn.
    pub fn inverted_rx(&self) -> &[bool] {
        &self.inverted_rx
    }

    /// A uniform linear array along y with half-wavelength spacing, from y = 0 upwards.
    ///
    /// # Errors
    /// As [`Array::new`].
    pub fn ula(elements: usize) -> Result<Self, InputError> {
        let positions: Vec<Position> =
            (0..elements.min(MAX_ELEMENTS + 1)).map(|k| [0.0, k as f64, 0.0]).collect();
        Self::new(&positions)
    }

    /// All pairs of its transmitters and receivers, whichever of them it keeps, as planned: without what is known of
    /// their errors.
    ///
    /// # Errors
    /// As [`Array::new`].
    pub fn whole(&self) -> Result<Self, InputError> {
        Self::mimo(&self.tx, &self.rx)?.with_inverted(&self.inverted_tx, &self.inverted_rx)
    }

    /// Keeps the first of the elements that share a position.
    #[must_use]
    pub fn without_duplicates(&self) -> Self {
        let mut kept = Self { positions: vec![], channels: vec![], ..self.clone() };
        for (position, channel) in self.positions.iter().zip(&self.channels) {
            if !kept.positions.iter().any(|p| same_position(p, position)) {
                kept.positions.push(*position);
                kept.channels.push(*channel);
            }
        }
        kept
    }

    /// The elements at `indices`, in that order; for sub-arrays such as one row of a plane.
    ///
    /// # Errors
    /// [`InputError::Empty`] for no indices, [`InputError::OutOfRange`] for one beyond the array.
    pub fn select(&self, indices: &[usize]) -> Result<Self, InputError> {
        if indices.is_empty() {
            return Err(InputError::Empty {
                what: "element indices".into(),
                expected: "at least one".into(),
            });
        }
        let mut kept = Self { positions: vec![], channels: vec![], ..self.clone() };
        for &index in indices {
            if index >= self.len() {
                return Err(InputError::OutOfRange {
                    what: "element index".into(),
                    expected: format!("less than {}", self.len()),
                    given: index as f64,
                });
            }
            kept.positions.push(self.positions[index]);
            kept.channels.push(self.channels[index]);
        }
        Ok(kept)
    }

    /// Number of elements.
    #[allow(clippy::len_without_is_empty)] // an array is never empty
    pub fn len(&self) -> usize {
        self.positions.len()
    }

    /// Element positions, half wavelengths.
    pub fn positions(&self) -> &[Position] {
        &self.positions
    }

    /// Transmitter and receiver of each element.
    pub fn channels(&self) -> &[Channel] {
        &self.channels
    }

    /// Transmitter positions, half wavelengths.
    pub fn tx(&self) -> &[Position] {
        &self.tx
    }

    /// Receiver positions, half wavelengths.
    pub fn rx(&self) -> &[Position] {
        &self.rx
    }

    /// What turns measured snapshots into those of the elements at [`Array::positions`]; nothing
    /// where the array is taken as planned. Estimators take corrected snapshots.
    pub fn correction(&self) -> Option<&Correction> {
        self.correction.as_deref()
    }

    /// The same channels elsewhere, with what corrects them.
    pub(crate) fn with(
        &self,
        positions: Vec<Position>,
        correction: Option<Arc<Correction>>,
    ) -> Self {
        Self { positions, correction, ..self.clone() }
    }

    /// Length of the array along y, half wavelengths.
    pub fn aperture(&self) -> f64 {
        let (low, high) = self
            .positions
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), p| (l.min(p[1]), h.max(p[1])));
        high - low
    }

    /// Which angles the positions can tell apart.
    pub fn extent(&self) -> Extent {
        let origin = self.positions[0];
        let offset = |p: &Position| [p[0] - origin[0], p[1] - origin[1], p[2] - origin[2]];
        let norm = |v: &Position| (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
        let axis = self
            .positions
            .iter()
            .map(offset)
            .fold([0.0; 3], |best, v| if norm(&v) > norm(&best) { v } else { best });
        let length = norm(&axis);
        if length < SAME_POSITION {
            return Extent::Point;
        }
        let off_axis = |v: Position| {
            let cross = [
                v[1] * axis[2] - v[2] * axis[1],
                v[2] * axis[0] - v[0] * axis[2],
                v[0] * axis[1] - v[1] * axis[0],
            ];
            norm(&cross) / length
        };
        if self.positions.iter().any(|p| off_axis(offset(p)) > 1e-6) {
            Extent::Area
        } else if axis[0].abs() < 1e-6 && axis[2].abs() < 1e-6 {
            Extent::Azimuth
        } else {
            Extent::Line
        }
    }

    /// Largest `|sin(elevation)|` an array that spans an area sees without ambiguity, where its rows are evenly spaced:
    /// rows a wavelength apart cannot tell a wave from 30 deg above from one 30 deg below. Nothing for other arrays.
    pub fn unambiguous_elevation_sine(&self) -> Option<f64> {
        if self.extent() != Extent::Area {
            return None;
        }
        let heights: Vec<Position> = self.positions.iter().map(|p| [0.0, p[2], 0.0]).collect();
        Some(Lattice::of(&heights)?.unambiguous_sine())
    }

    /// The integer grid the elements stand on, if they all lie on one line along y.
    pub fn lattice(&self) -> Option<Lattice> {
        Lattice::of(&self.positions)
    }

    /// Whether the elements are evenly spaced along y, in order (rising or falling), without
    /// gaps: what ESPRIT, root-MUSIC in its plain form and spatial smoothing ask for.
    pub fn is_uniform(&self) -> bool {
        self.lattice().is_some_and(|lattice| lattice.is_uniform())
    }
}

fn same_position(p: &Position, q: &Position) -> bool {
    p.iter().zip(q).all(|(a, b)| (a - b).abs() < SAME_POSITION)
}

fn check_positions(what: &str, positions: &[Position]) -> Result<(), InputError> {
    if positions.is_empty() {
        return Err(InputError::Empty { what: what.into(), expected: "at least one".into() });
    }
    check_finite(what, positions.iter().flatten().copied())?;
    if let Some(&given) = positions.iter().flatten().find(|x| x.abs() > 1e6) {
        return Err(InputError::OutOfRange {
            what: what.into(),
            expected: "coordinates within 1e6 half wavelengths of the origin".into(),
            given,
        });
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn virtual_elements_are_transmitter_major_sums() {
        let array =
            Array::mimo(&[[0.0; 3], [0.0, 4.0, 0.0]], &[[0.0; 3], [0.0, 1.0, 0.5]]).unwrap();
        assert_eq!(array.positions()[1], [0.0, 1.0, 0.5]);
        assert_eq!(array.positions()[2], [0.0, 4.0, 0.0]);
        assert_eq!(array.channels()[3], Channel { tx: 1, rx: 1 });
        assert_eq!(array.extent(), Extent::Area);
    }

    #[test]
    fn extent_tells_lines_from_areas() {
        assert_eq!(Array::new(&[[1.0, 2.0, 3.0]]).unwrap().extent(), Extent::Point);
        assert_eq!(Array::ula(4).unwrap().extent(), Extent::Azimuth);
        let vertical = [[0.0; 3], [0.0, 0.0, 1.0]];
        assert_eq!(Array::new(&vertical).unwrap().extent(), Extent::Line);
    }

    #[test]
    fn bad_positions_are_refused_by_name() {
        assert!(matches!(Array::new(&[]), Err(InputError::Empty { .. })));
        let nan = Array::new(&[[0.0; 3], [0.0, f64::NAN, 0.0]]);
        assert!(matches!(nan, Err(InputError::NotFinite { index: 4, .. })));
        assert!(matches!(Array::ula(0), Err(InputError::Empty { .. })));
        assert!(matches!(Array::ula(5000), Err(InputError::OutOfRange { .. })));
    }

    #[test]
    fn two_turned_antennas_cancel() {
        let two = [[0.0; 3], [0.0, 1.0, 0.0]];
        let array = Array::mimo(&two, &two).unwrap();
        let turned = array.clone().with_inverted(&[false, true], &[true, false]).unwrap();
        let signs: Vec<bool> = turned.channels().iter().map(|c| turned.is_inverted(*c)).collect();
        assert_eq!(signs, [true, false, false, true]);
        let distinct = turned.without_duplicates();
        assert!(!distinct.is_inverted(distinct.channels()[1]));
        assert_eq!(turned.positions(), array.positions());
        assert!(turned != array);
        let refused = array.with_inverted(&[false], &[false, false]).unwrap_err();
        assert!(matches!(refused, InputError::Shape { .. }), "{refused}");
    }

    #[test]
    fn selection_keeps_the_channels() {
        let array =
            Array::mimo(&[[0.0; 3], [0.0, 1.0, 0.0]], &[[0.0; 3], [0.0, 1.0, 0.0]]).unwrap();
        let distinct = array.without_duplicates();
        assert_eq!(distinct.len(), 3);
        assert_eq!(distinct.channels()[2], Channel { tx: 1, rx: 1 });
        assert!(matches!(array.select(&[9]), Err(InputError::OutOfRange { .. })));
    }
}
