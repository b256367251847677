//! Every field of every options struct, one at a time: a legal value that is not its default goes
//! through JavaScript, and in Rust this field, and no other, has changed.

use boresight_options::{Described, Field, Kind, Record, differing_fields, lies_in, naming};
use boresight_wasm::carry;
use js_sys::{Array, Object, Reflect};
use serde::de::DeserializeOwned;
use std::fmt::Debug;
use wasm_bindgen::{JsCast, JsValue};
use wasm_bindgen_test::wasm_bindgen_test;

#[wasm_bindgen_test]
fn options_of_estimators() {
    every_field::<boresight_aoa::EstimatorOptions>(28);
}

#[wasm_bindgen_test]
fn options_of_the_chain() {
    every_field::<boresight_pipeline::ChainOptions>(45);
}

#[wasm_bindgen_test]
fn options_of_calibration() {
    every_field::<boresight_mounting::CalibrationOptions>(19);
}

#[wasm_bindgen_test]
fn options_of_drives() {
    every_field::<boresight_simulate::DriveOptions>(22);
}

#[wasm_bindgen_test]
fn options_of_streets() {
    every_field::<boresight_simulate::StreetOptions>(2);
}

#[wasm_bindgen_test]
fn options_of_scenes_counts_and_readers() {
    every_field::<boresight_simulate::SceneSampling>(4);
    every_field::<boresight_aoa::order::counting::CountOptions>(2);
    every_field::<boresight_wasm::drive::ReadDriveOptions>(4);
}

#[wasm_bindgen_test]
fn requests_of_simulations_and_their_targets() {
    every_field::<boresight_simulate::SnapshotRequest>(11);
    every_field::<boresight_simulate::Target>(4);
    every_field::<boresight_simulate::CubeRequest>(9);
    every_field::<boresight_simulate::CubeTarget>(6);
}

#[wasm_bindgen_test]
fn options_of_bounds_and_images() {
    every_field::<boresight_aoa::bounds::BoundRequest>(2);
    every_field::<boresight_aoa::bounds::BoundTarget>(4);
    every_field::<boresight_image::GridOptions>(4);
    every_field::<boresight_image::ViewGridOptions>(3);
    every_field::<boresight_wasm::region::RegionOptions>(2);
    every_field::<boresight_pipeline::regions::RegionChainOptions>(19);
}

/// A field to set: the names in JavaScript that lead to it, and its description.
struct Leaf {
    path: Vec<String>,
    /// As `Debug` of the struct names it.
    rust: Vec<String>,
    field: &'static Field,
}

/// `fewest` tells that the description was walked through; fields may be added.
fn every_field<T: Described + DeserializeOwned + Debug>(fewest: usize) {
    let Kind::Record(record) = T::KIND else { panic!("a record") };
    let mut leaves = vec![];
    collect(record, &[], &[], &mut leaves);
    assert!(leaves.len() >= fewest, "{} fields of {}", leaves.len(), record.name);
    let plain: T = carry::read(&with_required(record)).unwrap();
    for leaf in leaves {
        let mut has_changed = false;
        for value in other_values(leaf.field, &leaf.field.kind) {
            let options = with_required(record);
            set(&options, &leaf.path, &value);
            let changed: T = carry::read(&options)
                .unwrap_or_else(|error| panic!("{}: {error}", leaf.path.join(".")));
            let differing = differing_fields(&plain, &changed);
            // One of the names of a choice is the default.
            if !differing.is_empty() {
                let own = leaf.rust.join(".");
                let is_own = differing.iter().all(|field| lies_in(field, &own));
                assert!(is_own, "{}: {differing:?}", leaf.path.join("."));
                has_changed = true;
            }
        }
        assert!(has_changed, "{} changes nothing", leaf.path.join("."));
    }
}

fn collect(record: &Record, above: &[String], rust: &[String], leaves: &mut Vec<Leaf>) {
    for field in record.fields {
        let rust = [rust, &[field.name.to_owned()]].concat();
        let own = (!field.flat).then(|| naming::javascript(field.name));
        let path = above.iter().cloned().chain(own).collect::<Vec<_>>();
        match field.kind {
            Kind::Record(inner) => collect(inner, &path, &rust, leaves),
            _ => leaves.push(Leaf { path, rust, field }),
        }
    }
}

/// An object with the fields that options have to name.
fn with_required(record: &Record) -> JsValue {
    let object = Object::new();
    add_required(&object, record);
    object.into()
}

fn add_required(object: &Object, record: &Record) {
    for field in record.fields {
        match field.kind {
            Kind::Record(inner) if field.flat => add_required(object, inner),
            kind if field.required => {
                let value = first_value(&kind);
                Reflect::set(object, &naming::javascript(field.name).into(), &value).unwrap();
            }
            _ => {}
        }
    }
}

fn first_value(kind: &Kind) -> JsValue {
    match kind {
        Kind::Choice(choice) => choice.variants[0].0.into(),
        Kind::Tuple(of, length) => {
            std::iter::repeat_n(first_value(of), *length).collect::<Array>().into()
        }
        _ => 2.0.into(),
    }
}

/// Legal values, of which one at least is not the default.
fn other_values(field: &Field, kind: &Kind) -> Vec<JsValue> {
    let (low, high) = field.range.map_or((0.0, 10.0), |range| (range.low, range.high));
    let high = if high.is_finite() { high } else { low + 10.0 };
    // One of them may be the default.
    let numbers = |whole: bool| {
        let all = [0.37, 0.73].map(|share| low + share * (high - low)).into_iter();
        all.map(|x| JsValue::from(if whole { x.max(low + 1.0).floor() } else { x })).collect()
    };
    match kind {
        Kind::Number => numbers(false),
        Kind::Whole | Kind::Seed => numbers(true),
        Kind::Truth => vec![true.into(), false.into()],
        Kind::Choice(choice) => choice.variants.iter().map(|(name, _)| (*name).into()).collect(),
        Kind::Optional(inner) => other_values(field, inner),
        Kind::Tuple(inner, length) => other_values(field, inner)
            .into_iter()
            .map(|value| std::iter::repeat_n(value, *length).collect::<Array>().into())
            .collect(),
        Kind::Special(special) if special.flag == "N=DEG" => {
            let angles = Object::new();
            Reflect::set(&angles, &"1".into(), &2.0.into()).unwrap();
            vec![angles.into()]
        }
        Kind::Special(_) => vec![3.0.into(), "aic".into()],
        Kind::List(Kind::Record(record)) if record.name == "PlacedRadar" => {
            let object = Object::new();
            for (i, name) in ["id", "xM", "yM", "yawDeg"].into_iter().enumerate() {
                Reflect::set(&object, &name.into(), &(i as f64 + 5.0).into()).unwrap();
            }
            vec![Array::of1(&object).into()]
        }
        Kind::Text => vec!["a name".into()],
        Kind::List(Kind::Text) => vec![Array::of1(&"a name".into()).into()],
        // All their fields have defaults, or are set.
        Kind::Record(record) => vec![with_required(record)],
        Kind::List(inner @ Kind::Record(_)) => {
            other_values(field, inner).iter().map(|one| Array::of1(one).into()).collect()
        }
        Kind::List(_) | Kind::Numbers(_) => vec![],
    }
}

fn set(object: &JsValue, path: &[String], value: &JsValue) {
    let (name, rest) = path.split_first().unwrap();
    if rest.is_empty() {
        Reflect::set(object, &name.into(), value).unwrap();
        return;
    }
    let mut inner = Reflect::get(object, &name.into()).unwrap();
    if !inner.is_object() {
        inner = Object::new().unchecked_into();
        Reflect::set(object, &name.into(), &inner).unwrap();
    }
    set(&inner, rest, value);
}
