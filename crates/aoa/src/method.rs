//! The estimators by name, and what each asks for.

use boresight_core::InputError;
use boresight_options::{Described, Named};
use serde::{Deserialize, Serialize};

/// An angle-of-arrival estimator.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Described, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Method {
    /// Delay and sum (an FFT on a lattice).
    Bartlett,
    /// Minimum-variance beamformer (Capon 1969).
    Capon,
    /// Multiple signal classification (Schmidt 1986).
    Music,
    /// MUSIC on a Hankel matrix of one snapshot (Liao and Fannjiang 2016).
    SingleSnapshotMusic,
    /// Root-MUSIC (Barabell 1983).
    RootMusic,
    /// Rotational invariance (Roy and Kailath 1989), least squares or total least squares.
    Esprit,
    /// Minimum norm (Kumaresan and Tufts 1983).
    MinNorm,
    /// MUSIC on the difference co-array (Pal and Vaidyanathan 2010): more sources than elements on sparse arrays.
    CoarrayMusic,
    /// Iterative adaptive approach (Yardibi et al. 2010).
    Iaa,
    /// Newtonized orthogonal matching pursuit (Mamandipoor et al. 2016).
    Nomp,
    /// Atomic norm minimisation without a grid (Bhaskar et al. 2013).
    AtomicNorm,
    /// Deterministic maximum likelihood by alternating projection (Ziskind and Wax 1988).
    MaximumLikelihood,
    /// Off-grid sparse Bayesian learning (Yang, Xie and Zhang 2013).
    SparseBayesian,
    /// A transformer that answers with a set of targets (AAETR).
    Aaetr,
    /// A network without attention that answers with a set of targets: a pursuit whose steps are learned.
    LearnedPursuit,
    /// A fully connected network on the covariance, of whole degrees (after Chen, Gong and Mao 2020).
    Dnn,
    /// A convolutional network on a region of the range spectrum, of whole degrees (Sang et al. 2021).
    Cnn3d,
    /// UAA: iterations of IAA unrolled into the layers of a network, without matrix inverses (Zheng et al. 2023).
    UnrolledIaa,
    /// A convolutional network on the covariance, of sources on a grid (Papageorgiou et al. 2021).
    CovarianceCnn,
    /// Convolutional networks on the covariance that answer with MUSIC's spectrum (Elbir 2020).
    DeepMusic,
}

/// What a method needs and gives; the check and the documentation both read it.
#[derive(Debug, Clone, Copy, PartialEq, Described, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct Requirements {
    /// Name for people.
    pub title: &'static str,
    /// Where it was published.
    pub reference: &'static str,
    /// Fewest snapshots it is of use with (after smoothing where that applies).
    pub min_snapshots: usize,
    /// Most snapshots it takes, if there is a limit.
    pub max_snapshots: Option<usize>,
    /// Whether a covariance will do.
    pub takes_covariance: bool,
    /// Whether the elements must be evenly spaced on a line along y.
    pub uniform_array: bool,
    /// Whether the elements must stand on a grid along y (gaps allowed).
    pub lattice: bool,
    /// Whether it also estimates elevation on arrays that span an area.
    pub elevation: bool,
    /// Whether the number of sources must be given or counted beforehand.
    pub source_count: bool,
    /// Whether it returns a spectrum over angle.
    pub spectrum: bool,
    /// Whether it is a trained network, which needs a model's file.
    pub network: bool,
    /// Operation count of one estimate, in words.
    pub cost: &'static str,
}

impl Method {
    /// All methods that need no trained model, in the order they are listed to users.
    pub const ALL: [Self; 13] = [
        Self::Bartlett,
        Self::Capon,
        Self::Music,
        Self::SingleSnapshotMusic,
        Self::RootMusic,
        Self::Esprit,
        Self::MinNorm,
        Self::CoarrayMusic,
        Self::Iaa,
        Self::Nomp,
        Self::AtomicNorm,
        Self::MaximumLikelihood,
        Self::SparseBayesian,
    ];

    /// The networks, which need one.
    pub const NETWORKS: [Self; 7] = [
        Self::Aaetr,
        Self::LearnedPursuit,
        Self::Dnn,
        Self::Cnn3d,
        Self::UnrolledIaa,
        Self::CovarianceCnn,
        Self::DeepMusic,
    ];

    /// The name used in options, in JavaScript and on the command line.
    pub fn name(self) -> &'static str {
        Named::name(self)
    }

    /// Finds a method by its [`Method::name`].
    ///
    /// # Errors
    /// [`InputError::Unknown`], listing the known names.
    pub fn from_name(name: &str) -> Result<Self, InputError> {
        Named::from_name("method", name)
    }

    /// What the method needs and gives.
    pub fn requirements(self) -> Requirements {
        let base = Requirements {
            title: "",
            reference: "",
            min_snapshots: 1,
            max_snapshots: None,
            takes_covariance: true,
            uniform_array: false,
            lattice: false,
            elevation: false,
            source_count: false,
            spectrum: true,
            network: false,
            cost: "",
        };
        let network =
            Requirements { spectrum: false, network: true, cost: "that of its model", ..base };
        match self {
            Self::Bartlett => Requirements {
                title: "Bartlett (FFT)",
                reference: "Bartlett 1948; Krim and Viberg 1996",
                elevation: true,
                cost: "G log G a snapshot",
                ..base
            },
            Self::Capon => Requirements {
                title: "Capon (MVDR)",
                reference: "Capon 1969",
                elevation: true,
                cost: "K^3 + G log G",
                ..base
            },
            Self::Music => Requirements {
                title: "MUSIC",
                reference: "Schmidt 1986",
                min_snapshots: 2,
                elevation: true,
                source_count: true,
                cost: "K^3 + G log G",
                ..base
            },
            Self::SingleSnapshotMusic => Requirements {
                title: "Single-snapshot MUSIC",
                reference: "Liao and Fannjiang 2016",
                max_snapshots: Some(1),
                takes_covariance: false,
                uniform_array: true,
                source_count: true,
                cost: "K^3 / 8 + G log G",
                ..base
            },
            Self::RootMusic => Requirements {
                title: "Root-MUSIC",
                reference: "Barabell 1983",
                min_snapshots: 2,
                lattice: true,
                source_count: true,
                spectrum: false,
                cost: "K^3 + roots of degree 2 (span - 1)",
                ..base
            },
            Self::Esprit => Requirements {
                title: "ESPRIT",
                reference: "Roy and Kailath 1989",
                min_snapshots: 2,
                uniform_array: true,
                source_count: true,
                spectrum: false,
                cost: "K^3 + D^3",
                ..base
            },
            Self::MinNorm => Requirements {
                title: "Min-norm",
                reference: "Kumaresan and Tufts 1983",
                min_snapshots: 2,
                source_count: true,
                cost: "K^3 + G log G",
                ..base
            },
            Self::CoarrayMusic => Requirements {
                title: "Co-array MUSIC",
                reference: "Pal and Vaidyanathan 2010; Liu and Vaidyanathan 2015",
                min_snapshots: 2,
                lattice: true,
                source_count: true,
                cost: "K^2 + M^3 + G log G for M lags",
                ..base
            },
            Self::Iaa => Requirements {
                title: "IAA",
                reference: "Yardibi et al. 2010",
                takes_covariance: false,
                elevation: true,
                cost: "(K^3 + G log G) an iteration, K^3 + D^2 K for powers",
                ..base
            },
            Self::Nomp => Requirements {
                title: "NOMP",
                reference: "Mamandipoor, Ramasamy and Madhow 2016",
                takes_covariance: false,
                elevation: true,
                spectrum: false,
                cost: "D (G log G + D K)",
                ..base
            },
            Self::AtomicNorm => Requirements {
                title: "Atomic norm",
                reference: "Bhaskar, Tang and Recht 2013; Yang and Xie 2016",
                takes_covariance: false,
                elevation: true,
                spectrum: false,
                cost: "D (G log G + D K), D K a round",
                ..base
            },
            Self::MaximumLikelihood => Requirements {
                title: "Deterministic maximum likelihood",
                reference: "Ziskind and Wax 1988",
                elevation: true,
                source_count: true,
                spectrum: false,
                cost: "D G K^2 to start, D K^2 an iteration",
                ..base
            },
            Self::SparseBayesian => Requirements {
                title: "Off-grid sparse Bayesian learning",
                reference: "Yang, Xie and Zhang 2013",
                takes_covariance: false,
                cost: "(K^3 + G log G) an iteration",
                ..base
            },
            Self::Aaetr => Requirements {
                title: "AAETR (transformer)",
                reference: "Zhu, Chen and Yang 2024",
                max_snapshots: Some(1),
                takes_covariance: false,
                ..network
            },
            Self::LearnedPursuit => Requirements {
                title: "Learned pursuit (network)",
                reference: "Boresight",
                max_snapshots: Some(1),
                takes_covariance: false,
                ..network
            },
            Self::Dnn => Requirements {
                title: "DNN (network)",
                reference: "Chen, Gong and Mao 2020",
                uniform_array: true,
                ..network
            },
            Self::Cnn3d => Requirements {
                title: "3D-CNN (network)",
                reference: "Sang et al. 2021",
                // 65 range bins x 4 chirps.
                min_snapshots: 260,
                max_snapshots: Some(260),
                takes_covariance: false,
                uniform_array: true,
                ..network
            },
            Self::UnrolledIaa => Requirements {
                title: "UAA (unrolled IAA)",
                reference: "Zheng et al. 2023",
                max_snapshots: Some(1),
                takes_covariance: false,
                spectrum: true,
                ..network
            },
            Self::CovarianceCnn => Requirements {
                title: "Covariance CNN",
                reference: "Papageorgiou et al. 2021",
                uniform_array: true,
                spectrum: true,
                ..network
            },
            Self::DeepMusic => Requirements {
                title: "DeepMUSIC",
                reference: "Elbir 2020",
                uniform_array: true,
                spectrum: true,
                ..network
            },
        }
    }
}
