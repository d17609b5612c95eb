//! The written file: format, bytes, and nothing left behind.

use std::fs;
use std::path::Path;

use leadscrew_host::plot::{Colour, Figure, PlotError, Series};

use crate::examples::{motion, noise, one_panel, sampled};

fn files_in(directory: &Path) -> Vec<String> {
    let entries = fs::read_dir(directory).unwrap();
    entries
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect()
}

#[test]
fn extension_chooses_the_format_in_any_case() {
    let directory = tempfile::tempdir().unwrap();
    let figure = motion(1000);
    for (name, start) in [
        ("a.svg", b"<svg".as_slice()),
        ("b.SVG", b"<svg"),
        ("c.Png", b"\x89PNG"),
    ] {
        let path = directory.path().join(name);
        figure.save(&path).unwrap();
        assert!(fs::read(&path).unwrap().starts_with(start), "{name}");
    }
    assert_eq!(
        files_in(directory.path()).len(),
        3,
        "temporary files stay behind"
    );
}

#[test]
fn other_extensions_are_refused_and_nothing_written() {
    let directory = tempfile::tempdir().unwrap();
    for name in ["plot.pdf", "plot", ".svg", "plot.png.txt"] {
        let error = motion(10).save(&directory.path().join(name)).unwrap_err();
        assert!(matches!(error, PlotError::Extension { .. }), "{name}");
        assert!(error.to_string().contains(name));
        assert!(error.to_string().contains(".svg or .png"));
    }
    assert!(files_in(directory.path()).is_empty());
}

#[test]
fn a_failed_write_leaves_nothing_behind() {
    let directory = tempfile::tempdir().unwrap();
    let occupied = directory.path().join("taken.svg");
    fs::create_dir(&occupied).unwrap();
    let missing = directory.path().join("absent").join("plot.png");
    for path in [&occupied, &missing] {
        let error = motion(10).save(path).unwrap_err();
        assert!(matches!(error, PlotError::Write { .. }));
        assert!(error.to_string().contains(path.to_str().unwrap()));
    }
    assert_eq!(files_in(directory.path()), ["taken.svg"]);
}

#[test]
fn saving_replaces_the_whole_file() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("plot.svg");
    fs::write(&path, "x".repeat(2_000_000)).unwrap();
    let figure = motion(100);
    figure.save(&path).unwrap();
    assert_eq!(fs::read_to_string(&path).unwrap(), figure.to_svg().unwrap());
}

#[cfg(unix)]
#[test]
fn a_plot_is_no_more_private_than_other_files() {
    use std::os::unix::fs::PermissionsExt;
    let directory = tempfile::tempdir().unwrap();
    let (plot, other) = (
        directory.path().join("plot.svg"),
        directory.path().join("other"),
    );
    motion(10).save(&plot).unwrap();
    fs::write(&other, "").unwrap();
    let mode = |path| fs::metadata(path).unwrap().permissions().mode();
    assert_eq!(mode(plot), mode(other));
}

#[test]
fn the_same_figure_gives_the_same_bytes() {
    let figure = || Figure {
        width: 600,
        height: 500,
        ..motion(5000)
    };
    assert_eq!(figure().to_svg().unwrap(), figure().to_svg().unwrap());
    assert_eq!(figure().to_png().unwrap(), figure().to_png().unwrap());
}

#[test]
fn long_records_stay_small() {
    for count in [5000, 100_000] {
        let bytes = motion(count).to_svg().unwrap().len();
        assert!(
            bytes < 1_000_000,
            "{bytes} bytes from {count} points a series"
        );
    }
    let dots = |_| Series::dots("", sampled(5000, noise), Colour::Grey);
    let bytes = one_panel((0..5).map(dots).collect())
        .to_svg()
        .unwrap()
        .len();
    assert!(bytes < 1_000_000, "{bytes} bytes of dots");
}
