//! Puts the board's linker scripts where the linker finds them.

use std::path::PathBuf;
use std::{env, fs};

fn main() {
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets OUT_DIR for build scripts"));
    for script in ["board.x", "tick_only.x"] {
        fs::copy(script, out.join(script))
            .unwrap_or_else(|e| panic!("cannot copy {script} to {}: {e}", out.display()));
        println!("cargo:rerun-if-changed={script}");
    }
    println!("cargo:rustc-link-search={}", out.display());
    // Read from the linker's working directory, the workspace root; it includes board.x.
    println!("cargo:rerun-if-changed=../../memory.x");
    // No page alignment: the image is flashed, not loaded by an operating system.
    println!("cargo:rustc-link-arg-bins=--nmagic");
    println!("cargo:rustc-link-arg-bin=firmware=-Tlink.x");
    println!("cargo:rustc-link-arg-bin=firmware=-Tdefmt.x");
    // Tests on the board, by embedded-test.
    println!("cargo:rustc-link-arg-tests=--nmagic");
    println!("cargo:rustc-link-arg-tests=-Tlink.x");
    println!("cargo:rustc-link-arg-tests=-Tdefmt.x");
    println!("cargo:rustc-link-arg-tests=-Tembedded-test.x");
    // Its macro asks for it.
    println!("cargo:rustc-check-cfg=cfg(rust_analyzer)");
    println!("cargo:rustc-link-arg-bin=tick_only=-Ttick_only.x");
}
