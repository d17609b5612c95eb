//! Programs to read: our own, and those that LinuxCNC brings, where it is installed.

use std::fs;
use std::path::{Path, PathBuf};

const LINUXCNC: [&str; 2] = ["/usr/share/linuxcnc", "/usr/share/doc/linuxcnc"];

/// The programs of `tests/data`.
pub fn own() -> Vec<(PathBuf, Vec<u8>)> {
    let mut found = Vec::new();
    collect(
        Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data")),
        &mut found,
    );
    assert!(!found.is_empty(), "no programs in tests/data");
    found
}

/// The programs that LinuxCNC brings; none, said aloud, where it is not installed.
pub fn linuxcnc() -> Vec<(PathBuf, Vec<u8>)> {
    let mut found = Vec::new();
    for folder in LINUXCNC {
        collect(Path::new(folder), &mut found);
    }
    if found.is_empty() {
        eprintln!("SKIPPED: no programs in {LINUXCNC:?}: install linuxcnc-uspace to read them");
    }
    found
}

/// All of them.
pub fn all() -> Vec<(PathBuf, Vec<u8>)> {
    let mut found = own();
    found.extend(linuxcnc());
    found
}

fn collect(folder: &Path, found: &mut Vec<(PathBuf, Vec<u8>)>) {
    let Ok(entries) = fs::read_dir(folder) else {
        return;
    };
    let mut paths: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    paths.sort();
    for path in paths {
        let is = |extension: &str| path.extension().is_some_and(|found| found == extension);
        if path.is_dir() && !path.is_symlink() {
            collect(&path, found);
        } else if is("ngc") || is("nc") {
            let bytes =
                fs::read(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
            found.push((path, bytes));
        }
    }
}
