//! Fuzzes `boresight_fuzz_targets::targets::mcap`.

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| boresight_fuzz_targets::targets::mcap::check(bytes));
