//! Every seed and every input that once broke a target, given to the target on stable Rust.

use boresight_fuzz_targets::TARGETS;
use std::collections::BTreeSet;
use std::path::Path;

#[test]
fn seeds_and_former_crashes_pass() {
    let fuzz = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz");
    let mut known = BTreeSet::new();
    let mut inputs = 0;
    for (name, check) in TARGETS {
        known.insert(*name);
        check(&[]);
        for kind in ["seeds", "regressions"] {
            let Ok(folder) = std::fs::read_dir(fuzz.join(kind).join(name)) else { continue };
            for entry in folder {
                let path = entry.unwrap().path();
                println!("{}", path.display());
                check(&std::fs::read(&path).unwrap());
                inputs += 1;
            }
        }
    }
    println!("{inputs} inputs of {} targets", known.len());
    assert!(inputs >= 30, "{inputs} inputs");
    // A folder by another name than a target's would never be read.
    for kind in ["seeds", "regressions"] {
        for entry in std::fs::read_dir(fuzz.join(kind)).unwrap() {
            let name = entry.unwrap().file_name();
            assert!(known.contains(name.to_str().unwrap()), "no target for {kind}/{name:?}");
        }
    }
}
