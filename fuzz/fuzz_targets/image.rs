#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| gelbench_fuzz::count("image", bytes));
