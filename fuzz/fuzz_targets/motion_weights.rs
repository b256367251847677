//! Fuzzes `boresight_fuzz_targets::targets::motion_weights`.

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| boresight_fuzz_targets::targets::motion_weights::check(
    bytes
));
