//! What to say of words that are nearly right: names close to a known one, commas for points, what TOML does not take.

use toml::de::DeTable;

/// How alike a name must be to a known one to be taken for a slip, of 1.
const ALIKE: f64 = 0.8;
/// A longer word is no slip of a name, bytes; to compare it would take long.
const LONGEST_NAME: usize = 100;
/// What is shown of what TOML does not take, characters.
const LONGEST_FOUND: usize = 20;

/// The known name that is closest to a word, where one is close.
pub fn nearest<'k>(word: &str, known: impl IntoIterator<Item = &'k str>) -> Option<&'k str> {
    if word.len() > LONGEST_NAME {
        return None;
    }
    let alike = known
        .into_iter()
        .map(|name| (strsim::jaro(word, name), name));
    let close = alike.filter(|(likeness, _)| *likeness > ALIKE);
    close
        .max_by(|(one, _), (other, _)| one.total_cmp(other))
        .map(|(_, name)| name)
}

/// The number that a word is.
///
/// # Errors
/// What is expected: it is no number, or one with a decimal comma.
pub fn number_of(word: &str) -> Result<f64, String> {
    word.parse().map_err(|_| match decimal_comma(word) {
        Some(number) => format!("expected a number with a decimal point, {number}"),
        None => "expected a number".to_owned(),
    })
}

/// The number with a point that a word with a comma stands for, if it is one.
#[must_use]
pub fn decimal_comma(word: &str) -> Option<String> {
    let pointed = word.replacen(',', ".", 1);
    let is_number = pointed != word && pointed.parse::<f64>().is_ok();
    is_number.then_some(pointed)
}

/// What TOML's error says, in words of who writes such files, with what was found and what was probably meant.
#[must_use]
pub fn toml_message(text: &str, error: &toml::de::Error) -> String {
    let message = error.message().trim_end();
    let span = error.span().unwrap_or(0..0);
    if DeTable::parse(text).is_ok() {
        return of_content(message);
    }
    if message == "duplicate key" {
        let key = text.get(span).unwrap_or_default();
        return format!("the key `{key}` is there twice: leave one");
    }
    let found = found(text.get(span.start..).unwrap_or_default());
    let meant = comma_before(text, span.start).map_or_else(String::new, |number| {
        format!("; a number has a decimal point: {number}")
    });
    format!("{message}: found {found}{meant}")
}

/// What serde says of a text that is TOML.
fn of_content(message: &str) -> String {
    if let Some(near) = unknown_field(message) {
        return format!("{message}; did you mean `{near}`?");
    }
    if message.starts_with("missing field `") {
        return format!("{message}: add it");
    }
    match message.rsplit_once(", expected ") {
        Some((found, expected)) if message.starts_with("invalid ") => {
            let expected = match expected.trim_start_matches("a ").split(' ').next() {
                Some("f32" | "f64") => "a number",
                Some("u8" | "u16" | "u32" | "u64" | "usize" | "i32" | "i64") => "a whole number",
                Some("struct" | "map") => "a table",
                Some("sequence") => "a list",
                _ => expected,
            };
            format!("{found}, expected {expected}")
        }
        _ => message.to_owned(),
    }
}

/// What a text begins with, in backticks, as far as its line goes.
fn found(rest: &str) -> String {
    let line = rest.lines().next().unwrap_or_default();
    let shown: String = line.chars().take(LONGEST_FOUND).collect();
    match shown.trim_end() {
        "" => "the end of the line".to_owned(),
        shown => format!("`{shown}`"),
    }
}

/// The expected name that is closest to the one that serde does not know.
fn unknown_field(message: &str) -> Option<&str> {
    let rest = message.strip_prefix("unknown field `")?;
    let (found, rest) = rest.split_once("`, expected ")?;
    // Names stand between backticks.
    nearest(found, rest.split('`').skip(1).step_by(2))
}

/// The last number with a decimal comma on the line of `at`, up to there and outside a list, as it should be.
fn comma_before(text: &str, at: usize) -> Option<String> {
    let line_start = text.get(..at)?.rfind('\n').map_or(0, |newline| newline + 1);
    let line = text[line_start..].lines().next()?;
    let is_of_number = |c: char| c.is_ascii_digit() || c == ',';
    let comma = line
        .match_indices(',')
        .filter(|(comma, _)| line_start + comma <= at)
        .filter(|(comma, _)| {
            let before = &line[..*comma];
            before.matches('[').count() <= before.matches(']').count()
        });
    comma
        .filter_map(|(comma, _)| {
            let before = &line[..comma];
            let start = before.trim_end_matches(is_of_number).len();
            let after = &line[comma + 1..];
            let end = comma + 1 + after.len() - after.trim_start_matches(is_of_number).len();
            decimal_comma(&line[start..end]).filter(|_| start < comma && comma + 1 < end)
        })
        .next_back()
}

#[cfg(test)]
mod tests {
    use serde::Deserialize;

    use super::super::read_toml;
    use super::*;

    #[test]
    fn a_slip_is_told_from_another_word() {
        let known = ["position_mm", "forward_um"];
        assert_eq!(nearest("forwards", known), Some("forward_um"));
        assert_eq!(nearest("run", known), None);
        assert_eq!(number_of("-1.5e3"), Ok(-1500.0));
        assert_eq!(
            number_of("12,5"),
            Err("expected a number with a decimal point, 12.5".to_owned())
        );
        assert_eq!(number_of("1,2,3"), Err("expected a number".to_owned()));
    }

    #[test]
    fn toml_says_what_was_probably_meant() {
        #[derive(Debug, Deserialize)]
        #[serde(deny_unknown_fields)]
        struct File {
            _length_mm: f64,
            _place: Option<toml::Table>,
            _list: Option<Vec<f64>>,
        }
        let said = |text| read_toml::<File>(text).unwrap_err().to_string();
        assert!(said("_lenght_mm = 1").ends_with("; did you mean `_length_mm`?"));
        assert!(!said("height = 1").contains("did you mean"));
        for (text, place) in [
            ("_length_mm = 12,5\n", "1:16: "),
            ("_place = { X = 12,5 }", "1:21: "),
        ] {
            let said = said(text);
            assert!(said.starts_with(place), "{said}");
            assert!(
                said.ends_with("; a number has a decimal point: 12.5"),
                "{said}"
            );
        }
        for (text, expected) in [
            (
                "_length_mm = \"much\"",
                "1:14: invalid type: string \"much\", expected a number",
            ),
            (
                "_length_mm = 1\n_list = 3",
                "2:9: invalid type: integer `3`, expected a list",
            ),
            (
                "_list = [1];\n",
                "1:12: unexpected key or value, expected newline, `#`: found `;`",
            ),
            ("_place = {}", "1:1: missing field `_length_mm`: add it"),
            (
                "_length_mm = 1\n_length_mm = 2",
                "2:1: the key `_length_mm` is there twice: leave one",
            ),
            (
                "_length_mm = 1 ;\n",
                "1:14: string values must be quoted, expected literal string: found `1 ;`",
            ),
            (
                "_length_mm;1\n",
                "1:13: key with no value, expected `=`: found the end of the line",
            ),
        ] {
            assert_eq!(said(text), expected);
        }
        assert!(!said("_list = [1,2 3]").contains("point"));
        assert!(!said("_list = [1,2]\n_length_mm = x").contains("point"));
    }
}
