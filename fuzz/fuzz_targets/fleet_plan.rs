//! Fuzzes `boresight_fuzz_targets::targets::fleet_plan`.

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| boresight_fuzz_targets::targets::fleet_plan::check(
    bytes
));
