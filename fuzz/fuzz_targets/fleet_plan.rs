//! Plans of fleets: each job is sound and has the key of its files and settings, or is refused.

#![no_main]

use boresight_fleet::{Job, Jobs};
use libfuzzer_sys::fuzz_target;
use std::path::Path;

fuzz_target!(|bytes: &[u8]| {
    for job in Jobs::new(bytes, Path::new("jobs.jsonl")).flatten() {
        assert!(job.is_sound());
        assert_eq!(job.key, Job::key_of(&job.files, &job.settings));
    }
});
