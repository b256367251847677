//! Inputs and outputs: what kind of network has them, and whether they are what a card says.

use crate::card::{Axis, Card, Kind, Port, TARGET_VALUES};
use crate::engine::Engine;
use crate::error::NeuralError;

pub(crate) fn list<'a>(names: impl Iterator<Item = &'a str>) -> String {
    let all = names.collect::<Vec<_>>().join(", ");
    if all.is_empty() { "none".into() } else { all }
}

fn shapes(ports: &[Port]) -> String {
    ports.iter().map(Port::to_string).collect::<Vec<_>>().join("; ")
}

/// The kinds, one at least, with these inputs and names of outputs: counting network and DNN differ in the shape of their
/// output alone.
pub(crate) fn kinds_of(
    inputs: &[Port],
    outputs: &[Port],
    kinds: &[Kind],
) -> Result<Vec<Kind>, NeuralError> {
    let fits = |kind: &Kind| {
        let (wanted, given) = kind.ports();
        outputs.iter().map(|p| &p.name).eq(given.iter().map(|p| &p.name))
            && axes_fit(inputs, &wanted)
    };
    let found: Vec<Kind> = kinds.iter().copied().filter(fits).collect();
    if !found.is_empty() {
        return Ok(found);
    }
    let one = |kind: &Kind| {
        let (inputs, outputs) = kind.ports();
        format!("{} -> {}", shapes(&inputs), shapes(&outputs))
    };
    Err(NeuralError::Mismatch {
        what: "inputs and outputs, of 32-bit floating-point numbers".into(),
        expected: kinds.iter().map(one).collect::<Vec<_>>().join(", or "),
        given: format!("{} -> {}", shapes(inputs), shapes(outputs)),
    })
}

/// Whether ports have these names and shapes; an axis wanted by another name than `batch` has some length or name, the
/// same everywhere.
fn axes_fit(ports: &[Port], wanted: &[Port]) -> bool {
    let mut named: Vec<(String, Axis)> = Vec::new();
    let mut fits = |axis: &Axis, wanted: &Axis| match (axis, wanted) {
        (Axis::Length(length), Axis::Length(wanted)) => length == wanted,
        (Axis::Named(_) | Axis::Length(1), Axis::Named(name)) if name == "batch" => true,
        (Axis::Length(0), _) | (_, Axis::Length(_)) => false,
        (axis, Axis::Named(name)) => {
            name != "batch"
                && match named.iter().find(|(known, _)| known == name) {
                    Some((_, known)) => known == axis,
                    None => {
                        named.push((name.clone(), axis.clone()));
                        true
                    }
                }
        }
    };
    ports.len() == wanted.len()
        && ports.iter().zip(wanted).all(|(port, wanted)| {
            port.name == wanted.name
                && port.axes.len() == wanted.axes.len()
                && port.axes.iter().zip(&wanted.axes).all(|(axis, wanted)| fits(axis, wanted))
        })
}

/// The kind whose outputs come out, and these with their shapes.
pub(crate) fn checked_outputs(
    engine: &Engine,
    kinds: &[Kind],
    stated: &[Port],
    single: bool,
) -> Result<(Kind, Vec<Port>), NeuralError> {
    let shapes_found = engine.output_shapes()?;
    let found: Vec<Port> = stated
        .iter()
        .zip(&shapes_found)
        .map(|(port, shape)| {
            let axes = shape.iter().enumerate().map(|(at, &length)| match at {
                0 if !single => Axis::Named("batch".into()),
                _ => Axis::Length(length),
            });
            Port { name: port.name.clone(), axes: axes.collect() }
        })
        .collect();
    let examples = shapes_found.iter().all(|shape| shape.first() == Some(&1));
    let values = |kind: Kind| {
        let last = shapes_found.first().and_then(|shape| shape.last());
        !kind.answers_target_set() || last.is_some_and(|last| TARGET_VALUES.contains(last))
    };
    let fits = |kind: &&Kind| examples && axes_fit(&found, &kind.ports().1) && values(**kind);
    if let Some(kind) = kinds.iter().find(fits) {
        return Ok((*kind, found));
    }
    let one = |kind: &Kind| {
        let values = if kind.answers_target_set() { ", 3 or 5 values" } else { "" };
        format!("{}{values}", shapes(&kind.ports().1))
    };
    let wanted: Vec<String> = kinds.iter().map(one).collect();
    Err(NeuralError::Mismatch {
        what: "outputs, of 32-bit floating-point numbers".into(),
        expected: wanted.join(", or "),
        given: shapes(&found),
    })
}

/// Checks names and shapes against a card, on which an axis may have any name.
pub(crate) fn check_ports(what: &str, card: &[Port], found: &[Port]) -> Result<(), NeuralError> {
    let same = |(axis, found): (&Axis, &Axis)| match (axis, found) {
        (Axis::Named(_), Axis::Named(_)) => true,
        (axis, found) => axis == found,
    };
    let fits = card.len() == found.len()
        && card.iter().zip(found).all(|(card, found)| {
            card.name == found.name
                && card.axes.len() == found.axes.len()
                && card.axes.iter().zip(&found.axes).all(same)
        });
    if fits {
        return Ok(());
    }
    Err(NeuralError::Mismatch {
        what: format!("{what} on the card"),
        expected: shapes(card),
        given: shapes(found),
    })
}

pub(crate) fn check_digest(card: &Card, given: &str) -> Result<(), NeuralError> {
    match &card.sha256 {
        Some(expected) if !given.eq_ignore_ascii_case(expected) => {
            Err(NeuralError::Digest { expected: expected.clone(), given: given.into() })
        }
        _ => Ok(()),
    }
}
