//! Texts out of the bytes of files: UTF-8, with or without its mark.

use super::{Complaint, Place};

/// What some editors put in front of UTF-8.
pub const UTF_8_MARK: &[u8] = b"\xEF\xBB\xBF";

/// The text of a file, without the mark of UTF-8.
///
/// # Errors
/// The first byte that is no UTF-8 (ISO 8859-1 and its like have such), a NUL, the mark of UTF-16.
pub fn text_of(mut bytes: Vec<u8>) -> Result<String, Complaint> {
    wide_mark(&bytes)?;
    if bytes.starts_with(UTF_8_MARK) {
        bytes.drain(..UTF_8_MARK.len());
    }
    let text = String::from_utf8(bytes).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        let bytes = error.as_bytes();
        let before = String::from_utf8_lossy(&bytes[..at]);
        let found = bytes[at];
        let message = format!(
            "the byte 0x{found:02X} is no UTF-8: save the file as UTF-8, or mend what stands here"
        );
        Complaint::at(&before, &(at..at), message)
    })?;
    match text.find('\0') {
        None => Ok(text),
        Some(at) => Err(Complaint::at(
            &text,
            &(at..at),
            "a NUL, which no text has: is the file UTF-16, or no text at all? Save it as UTF-8",
        )),
    }
}

/// Refuses the mark of UTF-16 in front of a file.
///
/// # Errors
/// The mark, at the first place.
pub fn wide_mark(bytes: &[u8]) -> Result<(), Complaint> {
    if bytes.starts_with(b"\xFF\xFE") || bytes.starts_with(b"\xFE\xFF") {
        return Err(Complaint {
            place: Place { line: 1, column: 1 },
            message: "the file is UTF-16: expected UTF-8, save it as that".to_owned(),
        });
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mark_is_dropped_and_what_is_no_utf_8_has_its_place() {
        assert_eq!(text_of(b"\xEF\xBB\xBFa".to_vec()).unwrap(), "a");
        assert_eq!(text_of(Vec::new()).unwrap(), "");
        let refused = |bytes: &[u8]| text_of(bytes.to_vec()).unwrap_err().to_string();
        let latin = refused(b"\xEF\xBB\xBFa\n\xC3\xA4 gr\xF6sse\n");
        assert!(
            latin.starts_with("2:5: the byte 0xF6 is no UTF-8"),
            "{latin}"
        );
        assert!(refused(b"\xFF\xFEa\0").starts_with("1:1: the file is UTF-16"));
        assert!(refused(b"\xFE\xFF\0a").starts_with("1:1: the file is UTF-16"));
        assert!(refused(b"a\n\0b").starts_with("2:1: a NUL"));
    }
}
