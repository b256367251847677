//! Fuzzes `boresight_fuzz_targets::targets::pcd`.

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| boresight_fuzz_targets::targets::pcd::check(bytes));
