//! `boresight image`.

use crate::common::{boresight, folder, stdout};
use serde_json::Value;

#[test]
fn the_street_has_a_picture_and_a_measure_by_method() {
    let folder = folder("image");
    let out = folder.join("street.png");
    let arguments = ["image", "street", "--radars", "left", "--method", "bartlett,iaa", "--json"];
    let path = out.to_str().unwrap();
    let printed = stdout(&[&arguments[..], &["--cell", "0.5", "--out", path]].concat());
    let rows: Value = serde_json::from_str(&printed).unwrap();
    let outside = |row: usize| rows[row]["outsideDb"].as_f64().unwrap();
    assert!(outside(1) < outside(0) - 10.0, "{rows}");
    assert_eq!((&rows[0]["from"], &rows[1]["points"]), (&"spectra".into(), &Value::Null));
    for method in ["bartlett", "iaa"] {
        let picture = std::fs::read(folder.join(format!("street-{method}.png"))).unwrap();
        assert_eq!(picture[..8], *b"\x89PNG\r\n\x1a\n");
        // Width and height in the header: 50 m to each axis' edges in cells of half a metre.
        assert_eq!(picture[16..24], [0, 0, 0, 100, 0, 0, 0, 200]);
    }
}

#[test]
fn like_stands_beside_like_the_detections_of_the_chain_too() {
    let base = ["image", "street", "--radars", "rear", "--cell", "1", "--x=-45,0", "--json"];
    for more in [&["--method", "bartlett,nomp"][..], &["--method", "bartlett", "--chain"]] {
        let rows: Value = serde_json::from_str(&stdout(&[&base[..], more].concat())).unwrap();
        for row in rows.as_array().unwrap() {
            assert_eq!(row["from"], "targets", "{rows}");
            let count = |name: &str| row["points"][name].as_u64().unwrap();
            assert!(count("points") > count("falsePoints"), "{rows}");
            assert!(row["behindWalls"]["hiddenM2"].as_f64().unwrap() > 100.0, "{rows}");
        }
    }
}

#[test]
fn spectra_of_a_method_without_are_refused() {
    let arguments = ["image", "street", "--radars", "left", "--method", "nomp"];
    let run = boresight(&[&arguments[..], &["--from", "spectra"]].concat());
    assert_eq!(run.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&run.stderr).contains("targets for this method"));
}

#[test]
fn a_capture_has_an_image() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../recordings/awr1642/");
    let [bin, cfg] = ["xwr16xx_crw_dca_module_2018_1015v2.bin", "profile.cfg"]
        .map(|name| format!("{folder}{name}"));
    let printed = stdout(&["image", "capture", &bin, "--config", &cfg, "--frame", "0", "--json"]);
    let rows: Value = serde_json::from_str(&printed).unwrap();
    assert!(rows[0]["cells"].as_u64().unwrap() > 5, "{rows}");
}
