//! Images of the boards, and the tools that look into them.

use std::env;
use std::path::PathBuf;

use crate::Result;
use crate::command::{cargo, program, root};
use crate::packages::TARGET;

/// The image of a program that was built in the profile of the firmware.
pub fn path(bin: &str) -> PathBuf {
    let target = env::var_os("CARGO_TARGET_DIR").map_or_else(|| "target".into(), PathBuf::from);
    root().join(target).join(TARGET).join("firmware").join(bin)
}

/// Builds a program of a board in the profile of the firmware.
pub fn build(package: &str, bin: &str, words: &[&str]) -> Result<()> {
    cargo(["build", "--quiet", "--package", package, "--target", TARGET])
        .words(&["--profile", "firmware", "--bin", bin])
        .words(words)
        .run()
}

/// What a tool of the toolchain's `llvm-tools` says of the image.
pub fn look(tool: &str, words: &[&str], bin: &str) -> Result<String> {
    let image = path(bin);
    program(&tool_path(tool)?, [])
        .words(words)
        .words(&[&image.to_string_lossy()])
        .output()
}

/// Where the toolchain has it.
pub fn tool_path(tool: &str) -> Result<String> {
    let libraries = program("rustc", ["--print", "target-libdir"]).output()?;
    let folder = PathBuf::from(libraries.trim()).with_file_name("bin");
    let path = folder.join(tool);
    if path.is_file() {
        Ok(path.to_string_lossy().into_owned())
    } else {
        Err(format!(
            "{} is missing: `rustup component add llvm-tools`",
            path.display()
        ))
    }
}
