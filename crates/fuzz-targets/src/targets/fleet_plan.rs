//! Plans of fleets: each job is sound and has the key of its files and settings, or is refused.

use boresight_fleet::{Job, Jobs};
use std::path::Path;

/// Checks one input.
pub fn check(bytes: &[u8]) {
    for job in Jobs::new(bytes, Path::new("jobs.jsonl")).flatten() {
        assert!(job.is_sound());
        assert_eq!(job.key, Job::key_of(&job.files, &job.settings));
    }
}
