//! Dialects: those shipped are whole, and a file that contradicts itself is told where.

use leadscrew_nc::block::Number;
use leadscrew_nc::dialect::{Code, Dialect, Letter, Meaning};

fn code(dialect: &Dialect, text: &str) -> Option<Code> {
    let (number, _) = Number::read(&text.as_bytes()[1..], false).unwrap();
    dialect.code(text.as_bytes()[0], number)
}

#[test]
fn those_shipped_can_be_read() {
    let mut count = 0;
    for name in Dialect::names() {
        let text = Dialect::text_of(name).unwrap();
        let dialect =
            Dialect::from_toml(text).unwrap_or_else(|error| panic!("{name}.toml:{error}"));
        assert_eq!(dialect.name(), name);
        count += 1;
    }
    assert_eq!(count, 5);
    assert!(Dialect::named("heidenhain").is_none());
}

#[test]
fn the_same_code_has_another_meaning_on_a_lathe() {
    let mill = Dialect::named("iso-mill").unwrap();
    let lathe = Dialect::named("iso-lathe").unwrap();
    assert_eq!(code(&mill, "G92"), Some(Code::Of(Meaning::Shift)));
    assert!(matches!(code(&lathe, "G92"), Some(Code::Cycle(_))));
    assert_eq!(code(&lathe, "G50"), Some(Code::Of(Meaning::Shift)));
    assert_eq!(code(&mill, "G01"), Some(Code::Of(Meaning::Line)));
    assert_eq!(code(&mill, "G54"), Some(Code::WorkOffset(540)));
    assert_eq!(code(&mill, "G38.2"), None);
    assert!(matches!(lathe.letter(b'U'), Letter::Way(_)));
    assert_eq!(mill.letter(b'U'), Letter::Unknown);
}

#[test]
fn a_dialect_that_contradicts_itself_is_told_where() {
    let text = Dialect::text_of("micrometre").unwrap();
    for (from, to, message) in [
        ("\"G63\"", "\"G67\"", "G67 is there twice"),
        (
            "\"G63\"",
            "\"G6x\"",
            "a code is expected, like \"G38.2\" or \"M6\"",
        ),
        ("known = \"XYZB\"", "known = \"XYZQ\"", "`Q` is no axis"),
        (
            "known = \"XYZB\"",
            "known = \"XYZX\"",
            "the letter `X` is there twice",
        ),
        (
            "letters = \"FRST\"",
            "letters = \"FRSTX\"",
            "the letter `X` is there twice",
        ),
        (
            "increment_mm = 0.001",
            "increment_mm = 0.0",
            "numbers.increment_mm is 0: 1e-9 to 1 is allowed",
        ),
        (
            "point = false",
            "point = true",
            "where numbers have a point it is a power of ten",
        ),
        (
            "start = []",
            "start = [\"G99\"]",
            "G99 has no meaning in this dialect",
        ),
        (
            "digits = 3",
            "digits = 30",
            "30 digits: 1 to 15 are allowed",
        ),
        ("line = ", "lines = ", "unknown variant `lines`"),
    ] {
        assert!(text.contains(from), "{from}");
        let error = Dialect::from_toml(&text.replace(from, to)).unwrap_err();
        assert!(error.message.contains(message), "{error}");
        assert!(error.place.line > 1, "{error}");
    }
}
