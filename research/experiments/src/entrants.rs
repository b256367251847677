//! What is compared: methods, and trained networks.
//!
//! Each network's records are a file of their own, beside that of all methods: a network that was trained again is
//! run again, the methods are not.

use crate::error::EvaluateError;
use boresight_core::InputError;
use boresight_neural::{Kind, Model};
use serde::{Deserialize, Serialize};

/// What follows the name of a method or network whose sources are refined.
pub const REFINED: &str = "+refined";

/// Methods by name and networks, in the order of tables and figures.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Entrants {
    /// Names of methods; what they mean is for the experiment to say.
    pub methods: Vec<String>,
    /// Networks.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub networks: Vec<Network>,
}

/// A trained network.
#[derive(Clone, Serialize, Deserialize)]
pub struct Network {
    /// Name in tables and figures: that on its card.
    pub name: String,
    /// What it is.
    pub kind: Kind,
    /// Digest of its file: records of another model under the same name are refused.
    pub sha256: String,
    /// The network itself; where records are put together it is not needed.
    #[serde(skip)]
    pub model: Option<Model>,
}

impl Network {
    /// Under the name on its card, or another one where it has none.
    pub fn new(model: Model, otherwise: &str) -> Self {
        let name = model.card().map_or(otherwise, |card| &card.name).to_owned();
        Self { name, kind: model.kind(), sha256: model.sha256().into(), model: Some(model) }
    }

    /// The network.
    ///
    /// # Errors
    /// [`EvaluateError::NoModel`] where it is a name only.
    pub fn model(&self) -> Result<&Model, EvaluateError> {
        let none = || EvaluateError::NoModel { name: self.name.clone() };
        self.model.as_ref().ok_or_else(none)
    }

    /// The confidence from which an answer counts: that on its card.
    pub(crate) fn confidence(&self) -> f64 {
        let card = self.model.as_ref().and_then(Model::card);
        card.and_then(|card| card.confidence).unwrap_or(0.5)
    }
}

impl std::fmt::Debug for Network {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        let Self { name, kind, sha256, .. } = self;
        write!(f, "{name} ({kind:?}, {sha256})")
    }
}

impl PartialEq for Network {
    fn eq(&self, other: &Self) -> bool {
        (&self.name, &self.sha256) == (&other.name, &other.sha256)
    }
}

impl Entrants {
    /// Networks are put in order of their names.
    pub fn new(methods: Vec<String>, mut networks: Vec<Network>) -> Self {
        networks.sort_by(|a, b| a.name.cmp(&b.name));
        Self { methods, networks }
    }

    /// Whether there is anything to compare, and no name of a network twice.
    pub(crate) fn check(&self) -> Result<(), InputError> {
        if self.methods.is_empty() && self.networks.is_empty() {
            let expected = "at least one method or network".into();
            return Err(InputError::Empty { what: "methods".into(), expected });
        }
        for (k, Network { name, .. }) in self.networks.iter().enumerate() {
            if self.networks[..k].iter().any(|known| known.name == *name) {
                return Err(InputError::Incompatible {
                    what: "networks".into(),
                    expected: "each of a name of its own".into(),
                    given: format!("two of the name {name}"),
                });
            }
        }
        Ok(())
    }

    /// The methods together, then each network.
    pub(crate) fn apart(&self) -> Vec<Self> {
        let methods = Self { methods: self.methods.clone(), networks: vec![] };
        let networks = self
            .networks
            .iter()
            .map(|network| Self { methods: vec![], networks: vec![network.clone()] });
        (!methods.methods.is_empty()).then_some(methods).into_iter().chain(networks).collect()
    }

    /// Puts what [`Entrants::apart`] gave together, in whatever order it comes; `None` where methods come twice, or a
    /// name of a network.
    pub(crate) fn together(all: impl IntoIterator<Item = Self>) -> Option<Self> {
        let mut whole = Self::default();
        for Self { methods, networks } in all {
            if !methods.is_empty() && !whole.methods.is_empty() {
                return None;
            }
            whole.methods.extend(methods);
            whole.networks.extend(networks);
        }
        let whole = Self::new(whole.methods, whole.networks);
        let distinct = whole.networks.windows(2).all(|pair| pair[0].name != pair[1].name);
        distinct.then_some(whole)
    }

    /// What the names of files of records get: that of the network, in letters every file system takes.
    pub(crate) fn suffix(&self) -> String {
        let name = self.networks.iter().map(|network| format!("-{}", network.name));
        let safe = |c: char| if c.is_ascii_alphanumeric() || "-._".contains(c) { c } else { '-' };
        name.collect::<String>().chars().map(safe).collect()
    }
}

/// The run split by what is compared: all methods together, and each network.
pub(crate) fn legs<E: Clone>(options: &E, entrants: fn(&mut E) -> &mut Entrants) -> Vec<E> {
    let mut options = options.clone();
    let apart = entrants(&mut options).apart();
    let leg = |of_leg: Entrants| {
        let mut leg = options.clone();
        *entrants(&mut leg) = of_leg;
        leg
    };
    apart.into_iter().map(leg).collect()
}

/// The run that [`legs`] are of; `None` where they differ in more than what they compare.
pub(crate) fn whole<E: Clone + PartialEq>(
    legs: &[E],
    entrants: fn(&mut E) -> &mut Entrants,
) -> Option<E> {
    let mut legs = legs.to_vec();
    let compared: Vec<Entrants> =
        legs.iter_mut().map(|leg| std::mem::take(entrants(leg))).collect();
    let (first, rest) = legs.split_first()?;
    if rest.iter().any(|leg| leg != first) {
        return None;
    }
    let mut whole = first.clone();
    *entrants(&mut whole) = Entrants::together(compared)?;
    Some(whole)
}

/// Runs and records methods and each network of an experiment apart.
macro_rules! by_entrants {
    () => {
        fn legs(&self) -> Vec<Self> {
            $crate::entrants::legs(self, |options| &mut options.entrants)
        }

        fn suffix(&self) -> String {
            self.entrants.suffix()
        }

        fn whole(legs: &[Self]) -> Option<Self> {
            $crate::entrants::whole(legs, |options| &mut options.entrants)
        }
    };
}
pub(crate) use by_entrants;
