//! Fuzzes `boresight_fuzz_targets::targets::clouds`.

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| boresight_fuzz_targets::targets::clouds::check(bytes));
