//! What is known of a model: the JSON file beside each ONNX file.

use crate::error::NeuralError;
use boresight_aoa::Method;
use boresight_options::{Described, Special};
use serde::{Deserialize, Serialize};
use std::fmt;

/// What a network is: what its card says, and without one what the names and shapes of its inputs and outputs tell.
/// AAETR and the learned pursuit have the same; without a card such a network counts as AAETR.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Described, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[option(name = "NetworkKind")]
pub enum Kind {
    /// A set of targets from one snapshot, by a transformer.
    Aaetr,
    /// A set of targets from one snapshot, by a pursuit whose steps are learned.
    LearnedPursuit,
    /// The number of targets, 0 to 2, from a covariance.
    Counting,
    /// Whole degrees from a covariance.
    Dnn,
    /// Whole degrees from a region of the range spectrum.
    Cnn3d,
    /// The spectrum of one snapshot, by iterations of IAA unrolled.
    UnrolledIaa,
    /// Probabilities of sources over a grid, from a covariance.
    CovarianceCnn,
    /// MUSIC's spectrum, from a covariance.
    DeepMusic,
}

impl Kind {
    /// The method of angle estimation; none for the counting network.
    pub fn method(self) -> Option<Method> {
        match self {
            Self::Aaetr => Some(Method::Aaetr),
            Self::LearnedPursuit => Some(Method::LearnedPursuit),
            Self::Counting => None,
            Self::Dnn => Some(Method::Dnn),
            Self::Cnn3d => Some(Method::Cnn3d),
            Self::UnrolledIaa => Some(Method::UnrolledIaa),
            Self::CovarianceCnn => Some(Method::CovarianceCnn),
            Self::DeepMusic => Some(Method::DeepMusic),
        }
    }

    /// Whether it answers one snapshot with a set of targets.
    pub fn answers_target_set(self) -> bool {
        matches!(self, Self::Aaetr | Self::LearnedPursuit)
    }

    /// Its inputs, then its outputs. Where an axis has a name other than `batch`, any length or name will do, the same
    /// everywhere. Of a target the `values` are sine of the azimuth, amplitude and confidence, and there may be the
    /// standard deviations of the sine and of the amplitude in dB ([`TARGET_VALUES`]). The `points` of a spectrum are at
    /// sines of the azimuth `-1 + 2 g / points`; a covariance over its mean diagonal entry has three channels, real part,
    /// imaginary part and phase over pi.
    pub fn ports(self) -> (Vec<Port>, Vec<Port>) {
        let batch = || Axis::Named("batch".into());
        let named = |name: &str| Axis::Named(name.into());
        let port = |name: &str, axes: Vec<Axis>| Port { name: name.into(), axes };
        let fixed = |name: &str, lengths: &[usize]| {
            port(
                name,
                std::iter::once(batch()).chain(lengths.iter().map(|&n| Axis::Length(n))).collect(),
            )
        };
        let snapshots = || {
            vec![
                port("snapshots", vec![batch(), named("elements"), Axis::Length(2)]),
                port("positions", vec![named("elements"), Axis::Length(3)]),
            ]
        };
        let covariance = || {
            let image = vec![batch(), Axis::Length(3), named("elements"), named("elements")];
            vec![port("covariance", image)]
        };
        let grid = |name| vec![port(name, vec![batch(), named("points")])];
        match self {
            Self::Aaetr | Self::LearnedPursuit => (
                snapshots(),
                vec![port("targets", vec![batch(), named("queries"), named("values")])],
            ),
            Self::UnrolledIaa => (snapshots(), grid("spectrum")),
            Self::CovarianceCnn => (covariance(), grid("probability")),
            Self::DeepMusic => (covariance(), grid("spectrum")),
            Self::Counting => (vec![fixed("covariance", &[56])], vec![fixed("probability", &[3])]),
            Self::Dnn => (vec![fixed("covariance", &[56])], vec![fixed("probability", &[21])]),
            Self::Cnn3d => {
                (vec![fixed("region", &[65, 8, 4, 3])], vec![fixed("probability", &[21])])
            }
        }
    }
}

/// Numbers a target of a set has, without and with deviations.
pub const TARGET_VALUES: [usize; 2] = [3, 5];

/// Length of an axis, or a name where any goes.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Axis {
    /// A fixed length.
    Length(usize),
    /// Any length; axes of one name have the same.
    Named(String),
}

impl Axis {
    /// Its length, where that is fixed.
    pub fn length(&self) -> Option<usize> {
        match self {
            Self::Length(length) => Some(*length),
            Self::Named(_) => None,
        }
    }
}

impl Described for Axis {
    const KIND: boresight_options::Kind = boresight_options::Kind::Special(&Special {
        expected: "a length or a name",
        typescript: "number | string",
        schema: r#"{ "type": ["integer", "string"] }"#,
        flag: "",
    });
}

impl fmt::Display for Axis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Length(length) => write!(f, "{length}"),
            Self::Named(name) => f.write_str(name),
        }
    }
}

/// An input or output, of 32-bit floating-point numbers.
#[derive(Debug, Clone, PartialEq, Eq, Described, Serialize, Deserialize)]
#[option(name = "NetworkPort")]
pub struct Port {
    /// Its name.
    pub name: String,
    /// Its shape: lengths, or names where any length goes.
    pub axes: Vec<Axis>,
}

impl Port {
    /// Lengths of the axes that have names, in a tensor of this shape.
    pub(crate) fn lengths(&self, shape: &[usize]) -> Vec<(String, usize)> {
        let named = self.axes.iter().zip(shape).filter_map(|(axis, &length)| match axis {
            Axis::Named(name) => Some((name.clone(), length)),
            Axis::Length(_) => None,
        });
        named.collect()
    }
}

impl fmt::Display for Port {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let axes: Vec<String> = self.axes.iter().map(Axis::to_string).collect();
        write!(f, "{} [{}]", self.name, axes.join(", "))
    }
}

/// What a network was trained on.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub struct TrainingData {
    /// Name of the array.
    pub array: Option<String>,
    /// Name of the waveform of simulated data cubes.
    pub waveform: Option<String>,
    /// Half width of the field of view, deg.
    pub field_of_view_deg: Option<f64>,
    /// Standard deviation of the elements' positions, half wavelengths.
    pub position_error: f64,
    /// Fewest and most elements of the arrays, where it was trained on different ones.
    pub elements: Option<[usize; 2]>,
    /// Fewest and most snapshots of a covariance.
    pub snapshots: Option<[usize; 2]>,
    /// Fewest and most targets.
    pub targets: Option<[usize; 2]>,
}

/// What is known of a model. Only what is needed to run and name it; a card holds more.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Card {
    /// Name, that of the file.
    pub name: String,
    /// Name for people.
    #[serde(default)]
    pub title: String,
    /// Where it was published.
    #[serde(default)]
    pub reference: String,
    /// What it does.
    #[serde(rename = "network")]
    pub kind: Kind,
    /// Its size.
    #[serde(default)]
    pub form: String,
    /// Inputs, in order.
    pub inputs: Vec<Port>,
    /// Outputs, in order.
    pub outputs: Vec<Port>,
    /// Number of parameters.
    #[serde(default)]
    pub parameters: usize,
    /// Least confidence of a source, unless asked otherwise.
    #[serde(default)]
    pub confidence: Option<f64>,
    /// Number of targets a classifier was trained for.
    #[serde(default)]
    pub targets: Option<usize>,
    /// What it was trained on.
    #[serde(default)]
    pub data: TrainingData,
    /// SHA-256 of the ONNX file, hexadecimal.
    #[serde(default)]
    pub sha256: Option<String>,
}

impl Card {
    /// Reads a card.
    ///
    /// # Errors
    /// [`NeuralError::Card`] where it is no JSON, a field is missing or of the wrong type, or the confidence is not
    /// between 0 and 1.
    pub fn from_json(text: &[u8]) -> Result<Self, NeuralError> {
        let card: Self = serde_json::from_slice(text)
            .map_err(|error| NeuralError::Card { reason: error.to_string() })?;
        if let Some(confidence) = card.confidence
            && !(0.0..=1.0).contains(&confidence)
        {
            return Err(NeuralError::Card {
                reason: format!("confidence is {confidence}, not between 0 and 1"),
            });
        }
        Ok(card)
    }
}
