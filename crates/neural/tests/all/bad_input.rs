//! Bad files, cards and data give typed errors, and a model goes on working after them.

use crate::size::sized;
use crate::support::{
    Field, Graph, bytes, card, floats, integer_attribute, integers, message, model, names, node,
    port, tensor_attribute, text,
};
use boresight_aoa::{AoaError, Data, EstimatorOptions};
use boresight_core::presets::preset;
use boresight_core::{Array, Complex64, Diagnose, InputError, Random};
use boresight_neural::{Card, Kind, Model, NeuralError};
use ndarray::{Array2, ArrayD};

fn error(bytes: &[u8]) -> NeuralError {
    let error = Model::load(bytes, None).err().unwrap();
    let details = error.details();
    assert!(!error.code().is_empty() && !details.what.is_empty(), "{error:?}");
    assert!(error.to_string().len() < 2000, "{error}");
    error
}

#[test]
fn a_file_made_to_order_loads_without_a_card() {
    let model = Model::load(&Graph::dnn().file(13), None).unwrap();
    assert_eq!((model.kind(), model.card()), (Kind::Dnn, None));
    let mut graph = Graph::dnn();
    // One example at a time.
    graph.inputs = vec![port("covariance", 1, &[1, 56])];
    let single = Model::load(&graph.file(13), None).unwrap();
    let five = ArrayD::from_elem(vec![5, 56], 0.25f32);
    let run = |model: &Model| model.run(&[("covariance", five.view())]).unwrap()[0].1.clone();
    assert_eq!(run(&single).shape(), &[5, 21]);
    assert_eq!(run(&single), run(&model));
}

#[test]
fn what_is_no_onnx_is_told_from_what_is_cut_short() {
    let no_onnx: [&[u8]; 7] =
        [b"", b"{\"json\": 1}", b"\x93NUMPY", b"PK\x03\x04", &[0; 64], &[0xff; 64], b"hello"];
    for bytes in no_onnx {
        assert!(matches!(error(bytes), NeuralError::NotOnnx { .. }), "{bytes:?}");
    }
    let whole = bytes("dnn-small-2");
    let mut truncated = 0;
    for length in (1..whole.len()).step_by(2503).chain(1..64) {
        match error(&whole[..length]) {
            NeuralError::Truncated { expected, given } => {
                assert!(given == length && expected > length);
                truncated += 1;
            }
            // Cut between two fields.
            NeuralError::Malformed { what, .. } => {
                assert!(what == "model" || what == "operator set")
            }
            other => panic!("{length}: {other:?}"),
        }
    }
    assert!(truncated > 200, "{truncated}");
}

#[test]
fn graphs_that_contradict_themselves_are_told() {
    let changed = |change: fn(&mut Graph)| {
        let mut graph = Graph::dnn();
        change(&mut graph);
        error(&graph.file(13))
    };
    let operator = changed(|g| g.nodes[1] = node("NoSuchOperator", &["layer"], "probability", &[]));
    assert_eq!(operator, NeuralError::UnsupportedOperator { name: "NoSuchOperator".into() });
    assert_eq!(operator.code(), "unsupported-operator");
    type Change = fn(&mut Graph);
    let malformed: [(&str, Change); 8] = [
        ("used before it is there", |g| g.nodes.swap(0, 1)),
        ("a cycle", |g| g.nodes[0] = node("MatMul", &["probability", "weights"], "layer", &[])),
        ("a missing input", |g| g.nodes[0] = node("MatMul", &["covariance"], "layer", &[])),
        ("an output nobody makes", |g| g.outputs = vec![port("nothing", 1, &[-1, 21])]),
        ("two of a name", |g| g.nodes[1] = node("Sigmoid", &["layer"], "layer", &[])),
        ("fewer weights than stated", |g| {
            g.constants = vec![floats("weights", &[56, 21], &[0.5; 7])]
        }),
        ("a negative shape", |g| g.constants = vec![floats("weights", &[-56, -21], &[0.5; 1176])]),
        ("too large a shape", |g| {
            g.constants = vec![floats("weights", &[i64::MAX, 21], &[0.5; 7])]
        }),
    ];
    for (what, change) in malformed {
        assert!(matches!(changed(change), NeuralError::Malformed { .. }), "{what}");
    }
    let refused = changed(|g| g.constants = vec![floats("weights", &[55, 21], &[0.5; 55 * 21])]);
    assert!(matches!(refused, NeuralError::Refused { .. }), "{refused:?}");
    let huge = changed(|g| {
        g.constants.push(integers("shape", &[1 << 40, 21]));
        g.nodes.insert(1, node("Expand", &["layer", "shape"], "grown", &[]));
        g.nodes[2] = node("Sigmoid", &["grown"], "probability", &[]);
    });
    assert!(matches!(huge, NeuralError::Malformed { .. }), "{huge:?}");
    for opset in [0, 5, 400, -1] {
        assert!(matches!(error(&Graph::dnn().file(opset)), NeuralError::Malformed { .. }));
    }
}

/// What made tract panic is an error, or has a meaning.
#[test]
fn attributes_out_of_range_are_no_panic() {
    let lists = |name: &str, value: i64| {
        let mut fields = vec![text(1, name), Field::Number(20, 7)];
        fields.extend([Field::Number(8, value), Field::Number(8, value)]);
        message(&fields)
    };
    let operators = [
        "Conv",
        "ConvTranspose",
        "MaxPool",
        "AveragePool",
        "Softmax",
        "Flatten",
        "Concat",
        "ReduceSum",
        "Gather",
        "Transpose",
        "Split",
        "Squeeze",
        "Unsqueeze",
        "ConstantOfShape",
        "Expand",
        "MatMul",
        "Slice",
        "Trilu",
        "ArgMax",
        "TopK",
    ];
    let inputs: [&[&str]; 10] = [
        &["layer"],
        &["layer", "c"],
        &["layer", "layer"],
        &["layer", "c", "c", "c", "c"],
        &["c"],
        &["scalar"],
        &["scalar", "c"],
        &["layer", "scalar"],
        &["image", "kernel"],
        &["image"],
    ];
    let names = ["axis", "axes", "perm", "split", "kernel_shape", "strides", "pads", "group"];
    for operator in operators {
        // Of 80 a third.
        let all = inputs.iter().flat_map(|i| names.iter().map(move |n| (*i, *n)));
        for (inputs, name) in all.step_by(sized(1, 3)) {
            for value in [-3, 0, 5, i64::MAX, i64::MIN] {
                let mut graph = Graph::dnn();
                graph.constants.push(integers("c", &[value]));
                graph.constants.push(floats("scalar", &[], &[0.5]));
                graph.constants.push(floats("image", &[1, 2, 3, 3], &[0.5; 18]));
                graph.constants.push(floats("kernel", &[2, 2, 3, 3], &[0.5; 36]));
                let attribute = match name {
                    "axis" | "group" => integer_attribute(name, value),
                    _ => lists(name, value),
                };
                graph.nodes[1] = node(operator, inputs, "odd", &[attribute]);
                graph.nodes.push(node("Sigmoid", &["odd"], "probability", &[]));
                let _ = Model::load(&graph.file(13), None);
            }
        }
    }
    let mut graph = Graph::dnn();
    graph.nodes[1] = node("Flatten", &["layer"], "probability", &[integer_attribute("axis", -3)]);
    assert!(matches!(error(&graph.file(13)), NeuralError::Malformed { .. }));
    let mut graph = Graph::dnn();
    let value = tensor_attribute("value", floats("value", &[2, 3], &[1.0]));
    graph.nodes.insert(0, node("Constant", &[], "unused", &[value]));
    assert!(matches!(error(&graph.file(13)), NeuralError::Malformed { .. }));
}

#[test]
fn inputs_and_outputs_are_told_by_name_shape_and_type() {
    let changed = |change: fn(&mut Graph)| {
        let mut graph = Graph::dnn();
        change(&mut graph);
        error(&graph.file(13))
    };
    let mismatches: [fn(&mut Graph); 6] = [
        |g| {
            g.inputs = vec![port("input", 1, &[-1, 56])];
            g.nodes[0] = node("MatMul", &["input", "weights"], "layer", &[]);
        },
        |g| {
            g.inputs = vec![port("covariance", 1, &[-1, 55])];
            g.constants = vec![floats("weights", &[55, 21], &[0.5; 55 * 21])];
        },
        |g| g.inputs = vec![port("covariance", 11, &[-1, 56])],
        |g| g.inputs.push(port("more", 1, &[3])),
        |g| g.constants = vec![floats("weights", &[56, 20], &[0.5; 56 * 20])],
        |g| {
            g.outputs = vec![port("angle", 1, &[-1, 21])];
            g.nodes[1] = node("Sigmoid", &["layer"], "angle", &[]);
        },
    ];
    for (k, change) in mismatches.into_iter().enumerate() {
        let error = changed(change);
        assert!(matches!(error, NeuralError::Mismatch { .. }), "{k}: {error:?}");
    }
}

#[test]
fn nan_in_weights_and_in_outputs() {
    let mut graph = Graph::dnn();
    let mut weights = vec![0.5; 56 * 21];
    weights[1000] = f32::NAN;
    graph.constants = vec![floats("weights", &[56, 21], &weights)];
    let error = error(&graph.file(13));
    assert!(matches!(error, NeuralError::NotFinite { .. }), "{error:?}");
    assert_eq!(error.code(), "network-not-finite");

    let mut graph = Graph::dnn();
    graph.nodes[1] = node("Log", &["layer"], "probability", &[]);
    graph.constants = vec![floats("weights", &[56, 21], &[1.0; 56 * 21])];
    let model = Model::load(&graph.file(13), None).unwrap();
    let run = |x: f32| {
        let input = ArrayD::from_elem(vec![2, 56], x);
        model.run(&[("covariance", input.view())])
    };
    assert!(matches!(run(-1.0), Err(NeuralError::NotFinite { .. })));
    assert!(matches!(run(f32::NAN), Err(NeuralError::Argument(InputError::NotFinite { .. }))));
    let good = run(1.0).unwrap();
    assert!((good[0].1[[1, 20]] - 56f32.ln()).abs() < 1e-5);
    // The estimator's error names the method, and the next estimate is right again.
    let array = Array::ula(8).unwrap();
    let mut estimator = model.estimator(&array, &EstimatorOptions::default()).unwrap();
    let minus = Array2::from_shape_fn((8, 1), |(k, _)| Complex64::new((-1f64).powi(k as i32), 0.0));
    let bad = estimator.estimate(Data::Snapshots(minus.view()));
    assert!(matches!(bad, Err(AoaError::Network { method: "dnn", .. })), "{bad:?}");
    let plus = Array2::from_elem((8, 1), Complex64::new(1.0, 0.0));
    assert!(estimator.estimate(Data::Snapshots(plus.view())).is_ok());
}

#[test]
fn a_card_has_to_fit_its_file() {
    let (file, good) = (bytes("dnn-small-2"), card("dnn-small-2"));
    let with = |change: fn(&mut Card)| {
        let mut card = good.clone();
        change(&mut card);
        Model::load(&file, Some(&card)).err().unwrap()
    };
    assert!(matches!(with(|c| c.sha256 = Some("00".into())), NeuralError::Digest { .. }));
    assert!(matches!(with(|c| c.kind = Kind::Aaetr), NeuralError::Mismatch { .. }));
    assert!(matches!(with(|c| c.inputs[0].name = "x".into()), NeuralError::Mismatch { .. }));
    assert!(matches!(
        with(|c| {
            c.outputs[0].axes.pop();
        }),
        NeuralError::Mismatch { .. }
    ));
    for text in ["", "{}", "[1]", "{\"name\": 3}", "nonsense"] {
        assert!(
            matches!(Card::from_json(text.as_bytes()), Err(NeuralError::Card { .. })),
            "{text}"
        );
    }
    let (aaetr, other) = (bytes("learned-pursuit"), card("dnn-small-2"));
    assert!(matches!(Model::load(&aaetr, Some(&other)), Err(NeuralError::Mismatch { .. })));
}

#[test]
fn inputs_of_a_run_and_arrays_are_checked() {
    let network = model("learned-pursuit");
    let (snapshots, positions) = (ArrayD::zeros(vec![2, 48, 2]), ArrayD::zeros(vec![48, 3]));
    let bad = ArrayD::<f32>::zeros(vec![2, 47, 2]);
    let none = ArrayD::<f32>::zeros(vec![0, 48, 2]);
    let run = |inputs: &[(&str, &ArrayD<f32>)]| {
        let views: Vec<_> = inputs.iter().map(|(name, x)| (*name, x.view())).collect();
        network.run(&views)
    };
    let refused = |inputs: &[(&str, &ArrayD<f32>)]| run(inputs).err().unwrap();
    let shape = refused(&[("snapshots", &bad), ("positions", &positions)]);
    assert!(matches!(shape, NeuralError::Argument(InputError::Shape { .. })));
    assert!(matches!(refused(&[("snapshots", &snapshots)]), NeuralError::Mismatch { .. }));
    let names = refused(&[("snapshots", &snapshots), ("place", &positions)]);
    let NeuralError::Mismatch { expected, given, .. } = names else { panic!("{names:?}") };
    assert_eq!([&*expected, &*given], ["snapshots, positions", "snapshots, place"]);
    assert_eq!(refused(&[("snapshots", &none), ("positions", &positions)]).code(), "out-of-range");

    let lrr48 = preset("lrr48").unwrap();
    let options = EstimatorOptions::default();
    let array = network.estimator(&Array::ula(8).unwrap(), &options).err().unwrap();
    assert_eq!(array.code(), "unsuitable-array");
    let range = EstimatorOptions { confidence: Some(2.0), ..options };
    assert_eq!(network.estimator(&lrr48, &range).err().unwrap().code(), "out-of-range");
    assert_eq!(
        network.count(Data::Snapshots(Array2::zeros((8, 1)).view())).err().unwrap().code(),
        "wrong-network"
    );
    let counting = model("counting-small");
    assert_eq!(counting.estimator(&lrr48, &options).err().unwrap().code(), "wrong-network");
    assert_eq!(
        counting.count(Data::Snapshots(Array2::zeros((7, 1)).view())).err().unwrap().code(),
        "shape"
    );
    let mut estimator = network.estimator(&lrr48, &options).unwrap();
    let two = Array2::<Complex64>::zeros((48, 2));
    assert_eq!(
        estimator.estimate(Data::Snapshots(two.view())).err().unwrap().code(),
        "snapshot-count"
    );
    let silence =
        estimator.estimate(Data::Snapshots(two.column(0).insert_axis(ndarray::Axis(1)))).unwrap();
    assert!(silence.sources.is_empty());
}

/// Bits flipped where a file says what the graph is, not in its weights: an error or a model, and never a panic.
#[test]
fn flipped_bits_are_no_panic() {
    let mut random = Random::new(17, 0);
    let small = Graph::dnn().file(13);
    let weights = small.windows(4).position(|w| w == b"weig").unwrap();
    for _ in 0..sized(1500, 300) {
        let mut file = small.clone();
        for _ in 0..1 + (random.uniform(0.0, 3.0) as usize) {
            let spread = if random.uniform(0.0, 1.0) < 0.5 { weights } else { file.len() };
            let at = random.uniform(0.0, spread as f64) as usize;
            file[at] ^= 1 << (random.uniform(0.0, 8.0) as u32);
        }
        if let Ok(model) = Model::load(&file, None) {
            let input = ArrayD::from_elem(vec![2, 56], 0.5f32);
            let _ = model.run(&[("covariance", input.view())]);
        }
    }
    for name in names() {
        // The first kilobytes are nodes.
        let whole = bytes(&name);
        for _ in 0..sized(4, 1) {
            let mut file = whole.clone();
            let at = random.uniform(0.0, 4096.0) as usize;
            file[at] ^= 1 << (random.uniform(0.0, 8.0) as u32);
            let _ = Model::load(&file, None);
        }
    }
}
