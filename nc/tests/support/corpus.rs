//! What the fuzzer keeps, and mutations of it that are the same in every run.

use std::path::{Path, PathBuf};

/// The files of a target, in the order of their names.
pub fn files(target: &str) -> Vec<(PathBuf, Vec<u8>)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../fuzz/corpus")
        .join(target);
    let entries =
        std::fs::read_dir(&folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let mut paths: Vec<_> = entries.map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    assert!(
        paths.len() >= 5,
        "{} files in {}",
        paths.len(),
        folder.display()
    );
    paths
        .into_iter()
        .map(|path| {
            let bytes = std::fs::read(&path).unwrap();
            (path, bytes)
        })
        .collect()
}

/// So many mutations of the files of a target, twenty times as many where `LEADSCREW_LONG` is set: bytes changed, lines taken
/// from other files, doubled, cut.
pub fn mutated(target: &str, count: usize) -> impl Iterator<Item = Vec<u8>> {
    let files: Vec<_> = files(target).into_iter().map(|(_, bytes)| bytes).collect();
    let is_long = std::env::var_os("LEADSCREW_LONG").is_some();
    let mut random = Random(0x9e37_79b9_7f4a_7c15);
    let count = if is_long { 20 * count } else { count };
    (0..count).map(move |_| {
        let mut bytes = files[random.below(files.len())].clone();
        for _ in 0..=random.below(4) {
            mutate(&mut bytes, &files[random.below(files.len())], &mut random);
        }
        bytes
    })
}

/// Xorshift, so that the fuzzer's build and the tests need no crate for it.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    fn below(&mut self, count: usize) -> usize {
        (self.next() % count.max(1) as u64) as usize
    }
}

/// Characters that mean something in one of the files.
const CHARACTERS: &[u8] = b"0123456789.+-GXYZIJKRUW/%()[]{}=\"',;# \r\n\xe4\x00eEnN";

fn mutate(bytes: &mut Vec<u8>, other: &[u8], random: &mut Random) {
    let at = random.below(bytes.len() + 1);
    let character = CHARACTERS[random.below(CHARACTERS.len())];
    match random.below(7) {
        0 => bytes.insert(at, character),
        1 if at < bytes.len() => bytes[at] = character,
        2 if at < bytes.len() => bytes[at] ^= 1 << random.below(8),
        3 => {
            let end = (at + random.below(12)).min(bytes.len());
            bytes.drain(at..end);
        }
        4 => {
            let end = (at + random.below(40)).min(bytes.len());
            let piece = bytes[at..end].to_vec();
            bytes.splice(at..at, piece);
        }
        5 => bytes.truncate(at),
        _ => {
            let lines: Vec<_> = other.split_inclusive(|byte| *byte == b'\n').collect();
            if let Some(line) = lines.get(random.below(lines.len())) {
                let start = bytes[..at]
                    .iter()
                    .rposition(|byte| *byte == b'\n')
                    .map_or(0, |end| end + 1);
                bytes.splice(start..start, line.iter().copied());
            }
        }
    }
}
