//! The scenarios of `tests/scenarios`: each must come to what it expects.

mod documents;
mod files;

use std::path::{Path, PathBuf};

use leadscrew_host::parallel;
use leadscrew_host::scenario_file::{self, ScenarioFile};

/// Folder of the repository.
fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .parent()
        .expect("the package lies in the repository")
}

/// All scenario files, sorted.
fn paths() -> Vec<PathBuf> {
    let folder = std::fs::read_dir(root().join("tests/scenarios")).expect("the folder is there");
    let mut paths: Vec<_> = folder
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.extension().is_some_and(|found| found == "toml"))
        .collect();
    paths.sort();
    paths
}

/// Reads a scenario file.
fn read(path: &Path) -> ScenarioFile {
    scenario_file::read(path).unwrap_or_else(|error| panic!("{error}"))
}

/// `check` of every file, on all cores; what it complains of.
fn complaints(check: impl Fn(&Path, &ScenarioFile) -> Vec<String> + Sync) -> Vec<String> {
    let found = parallel::map(&paths(), |path| check(path, &read(path)));
    found.into_iter().flatten().collect()
}
