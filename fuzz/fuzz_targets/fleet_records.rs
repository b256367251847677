//! Fuzzes `boresight_fuzz_targets::targets::fleet_records`.

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| boresight_fuzz_targets::targets::fleet_records::check(
    bytes
));
