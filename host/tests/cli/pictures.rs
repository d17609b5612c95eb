//! Whether a plot is one.

use std::path::Path;

/// Asserts a picture in the format of its extension, of more than a blank page.
#[track_caller]
pub fn assert_picture(path: &Path) {
    match path.extension().and_then(|extension| extension.to_str()) {
        Some("png") => assert_png(path),
        Some("svg") => assert_svg(path),
        other => panic!("{other:?} is no format of plots"),
    }
}

#[track_caller]
fn assert_png(path: &Path) {
    let bytes = std::fs::read(path).expect("the plot is there");
    assert!(bytes.starts_with(b"\x89PNG\r\n\x1a\n"), "the signature");
    let mut reader = png::Decoder::new(std::io::Cursor::new(bytes))
        .read_info()
        .expect("a PNG");
    let mut pixels = vec![0; reader.output_buffer_size().expect("a size")];
    reader.next_frame(&mut pixels).expect("whole");
    let first = pixels[0];
    assert!(pixels.iter().any(|value| *value != first), "a blank page");
}

#[track_caller]
fn assert_svg(path: &Path) {
    let document = std::fs::read_to_string(path).expect("the plot is there");
    assert_balanced(&document);
    for needed in ["<svg ", "<path ", "time, s", ", d"] {
        assert!(document.contains(needed), "{needed}");
    }
}

/// Asserts that every element that begins also ends, in order.
#[track_caller]
fn assert_balanced(document: &str) {
    let mut open = Vec::new();
    for tag in document.split('<').skip(1) {
        let (tag, _) = tag.split_once('>').expect("a tag ends");
        let name = tag.trim_start_matches('/').split_whitespace().next();
        let name = name.expect("a tag has a name").trim_end_matches('/');
        if tag.starts_with('/') {
            assert_eq!(open.pop(), Some(name));
        } else if !tag.ends_with('/') && !tag.starts_with(['?', '!']) {
            open.push(name);
        }
    }
    assert!(open.is_empty(), "never closed: {open:?}");
}
