//! Fuzzes `boresight_fuzz_targets::targets::dca1000`.

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| boresight_fuzz_targets::targets::dca1000::check(bytes));
