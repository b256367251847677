//! Fuzzes `boresight_fuzz_targets::targets::drive_h5`.

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| boresight_fuzz_targets::targets::drive_h5::check(bytes));
