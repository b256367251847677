//! Fuzzes `boresight_fuzz_targets::targets::drive_csv`.

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| boresight_fuzz_targets::targets::drive_csv::check(
    bytes
));
