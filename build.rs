//! Says whether this build is optimised: `cfg(optimized)`.
//!
//! Kernels are inlined whole where it is. At opt-level 0 a function that holds its callees keeps each of their temporaries
//! in a place of its own, and one frame of a kernel would be larger than a stack.

fn main() {
    println!("cargo::rustc-check-cfg=cfg(optimized)");
    println!("cargo::rerun-if-changed=build.rs");
    if std::env::var("OPT_LEVEL").is_ok_and(|level| level != "0") {
        println!("cargo::rustc-cfg=optimized");
    }
}
