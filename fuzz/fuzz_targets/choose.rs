#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| airlight_fuzz::choose(data));
