//! The programs that LinuxCNC brings, and our own, corrected by nothing.

use std::collections::BTreeMap;
use std::io::BufReader;

use leadscrew_nc::coordinates::Axis;
use leadscrew_nc::corrector::{CorrectError, Corrector, correct};
use leadscrew_nc::dialect::Dialect;
use leadscrew_nc::path::Tolerance;
use leadscrew_nc::terms::Terms;

use crate::polynomial::Polynomial;
use crate::{reader_files, shop};

fn run(dialect: &str, terms: Terms, program: &[u8]) -> (Vec<u8>, Option<CorrectError>) {
    let dialect = Dialect::named(dialect).unwrap();
    let tolerance = Tolerance {
        mm: 0.003,
        degrees: 0.003,
    };
    let state = shop::state(&dialect);
    let mut corrector = Corrector::new(dialect, &state, terms, tolerance).unwrap();
    let mut out = Vec::new();
    let error = correct(BufReader::new(program), &mut out, &mut corrector).err();
    (out, error)
}

#[test]
fn identity_gives_identical_bytes() {
    for (path, program) in reader_files::all() {
        let (out, error) = run("linuxcnc-mill", Terms::none(), &program);
        assert!(error.is_none() && out == program, "{}", path.display());
    }
}

/// With K = 0 everything is read, followed and written back; what cannot be followed is refused, and all before it is the same.
#[test]
fn a_correction_by_nothing_gives_identical_bytes_as_far_as_it_goes() {
    let (mut whole, mut bytes, mut refused) = (0, 0, BTreeMap::<String, u32>::new());
    let files = reader_files::all();
    for (path, program) in &files {
        for dialect in ["linuxcnc-mill", "linuxcnc-lathe"] {
            let zero = shop::terms(&[Polynomial {
                corrects: Axis::X,
                over: Axis::X,
                k0: 0.0,
                k1: 0.0,
                k2: 0.0,
            }]);
            let (out, error) = run(dialect, zero, program);
            match error {
                None => {
                    whole += 1;
                    assert_eq!(out, *program, "{}", path.display());
                }
                Some(CorrectError::Refused(refusal)) => {
                    assert_eq!(out, program[..out.len()], "{}", path.display());
                    *refused.entry(refusal.reason.to_string()).or_default() += 1;
                }
                Some(error) => panic!("{}: {error}", path.display()),
            }
            bytes += out.len();
        }
    }
    println!(
        "{} programs, {whole} of {} runs whole, {bytes} bytes; refused: {refused:#?}",
        files.len(),
        2 * files.len()
    );
    assert!(10 * whole >= 2 * files.len(), "{whole}");
}
