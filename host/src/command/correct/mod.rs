//! `leadscrew correct`: corrects an NC program, a file as a whole or a stream block by block.

mod report;

use std::fs::File;
use std::io::{self, BufRead, BufReader, BufWriter, Write};
use std::path::Path;
use std::time::Instant;

use leadscrew_nc::corrector::{self, CorrectError, Corrector};
use leadscrew_nc::dialect::Dialect;
use leadscrew_nc::setup::Setup;
use leadscrew_nc::source::{UTF_8_MARK, wide_mark};
use leadscrew_nc::terms::Terms;
use leadscrew_nc::terms::watch::Largest;

use self::report::{Memory, Report};
use super::{check_replaceable, print, print_json};
use crate::cli::CorrectArgs;
use crate::error::CommandError;
use crate::text_file::{self, TextFileError};
use crate::whole_file;

/// How much is read and written at a time: large enough for the disk's speed, small beside any program.
const BUFFER: usize = 1 << 16;

/// Runs the command.
///
/// # Errors
/// A setup that cannot be used, a block that is refused, files that cannot be read or written.
pub fn run(args: &CorrectArgs) -> Result<(), CommandError> {
    check_arguments(args)?;
    let (mut corrector, largest) = corrector(args)?;
    let begun = Instant::now();
    let memory = Memory::now();
    let done = match Output::of(args) {
        Output::Nothing => correct(args, &mut corrector, io::sink())?,
        Output::Stream => correct(args, &mut corrector, Flushing(io::stdout().lock()))?,
        Output::File => to_file(args, &mut corrector)?,
    };
    let seconds = begun.elapsed().as_secs_f64();
    let report = Report::new(&done, &largest, seconds, memory.growth());
    if args.json {
        return print_json(&report);
    }
    if !args.report {
        return Ok(());
    }
    match Output::of(args) {
        // Standard output is the program's.
        Output::Stream => {
            let _ = write!(io::stderr(), "{}", report.to_text());
            Ok(())
        }
        Output::Nothing | Output::File => print(&report.to_text()),
    }
}

/// Where the corrected program goes.
enum Output {
    Nothing,
    Stream,
    File,
}

impl Output {
    fn of(args: &CorrectArgs) -> Self {
        if args.check {
            Self::Nothing
        } else if is_standard(&args.out) {
            Self::Stream
        } else {
            Self::File
        }
    }
}

fn is_standard(path: &Path) -> bool {
    path.as_os_str() == "-"
}

fn check_arguments(args: &CorrectArgs) -> Result<(), CommandError> {
    match Output::of(args) {
        Output::File => check_replaceable("--out", &args.out, Some(&args.program))?,
        Output::Stream if args.json => {
            let message = "--json prints the report on standard output, where the program goes: give --out FILE, or --check";
            return Err(CommandError::Usage(message.to_owned()));
        }
        Output::Nothing | Output::Stream => {}
    }
    Ok(())
}

/// What corrects, and what its terms come to.
fn corrector(args: &CorrectArgs) -> Result<(Corrector, Vec<Largest>), CommandError> {
    let text = text_file::read(&args.setup)?;
    let folder = args.setup.parent().unwrap_or(Path::new(""));
    let files = |name: &str| {
        text_file::read(&folder.join(name)).map_err(|error| match error {
            TextFileError::Read { reason, .. } => {
                format!("{name}: cannot be read ({reason}): it is looked for beside the setup")
            }
            TextFileError::Encoding { complaint, .. } => format!("{name}:{complaint}"),
        })
    };
    let setup = Setup::read(&text, &files).map_err(CommandError::content(&args.setup))?;
    let dialect = dialect(args, &setup)?;
    setup
        .check_axes(&dialect)
        .map_err(CommandError::content(&args.setup))?;
    let terms = if args.identity {
        Terms::none()
    } else {
        setup.terms
    };
    let (terms, largest) = if args.report || args.json {
        terms.watched()
    } else {
        (terms, Vec::new())
    };
    let corrector = Corrector::new(dialect, &setup.control, terms, setup.tolerance)
        .map_err(|error| CommandError::content(&args.setup)(error.in_setup(&text)))?;
    Ok((corrector, largest))
}

/// The dialect of the command line, else of the setup.
fn dialect(args: &CorrectArgs, setup: &Setup) -> Result<Dialect, CommandError> {
    let Some(name) = &args.dialect else {
        return setup.dialect.clone().ok_or_else(|| {
            CommandError::Usage(format!(
                "{} names no dialect: add dialect = \"…\" to it or give --dialect, one of {}, or a file",
                args.setup.display(),
                known()
            ))
        });
    };
    if let Some(dialect) = Dialect::named(name) {
        return Ok(dialect);
    }
    let path = Path::new(name);
    if path
        .extension()
        .is_some_and(|extension| extension == "toml")
    {
        return Dialect::from_toml(&text_file::read(path)?).map_err(CommandError::content(path));
    }
    Err(CommandError::Usage(format!(
        "--dialect {name}: expected one of {}, or a file FILE.toml",
        known()
    )))
}

fn known() -> String {
    Dialect::names().collect::<Vec<_>>().join(", ")
}

/// Corrects from the program into a writer.
fn correct(
    args: &CorrectArgs,
    corrector: &mut Corrector,
    writer: impl Write,
) -> Result<corrector::Report, CommandError> {
    if is_standard(&args.program) {
        return from(args, io::stdin().lock(), corrector, writer);
    }
    let file = File::open(&args.program).map_err(TextFileError::read(&args.program))?;
    from(
        args,
        BufReader::with_capacity(BUFFER, file),
        corrector,
        writer,
    )
}

fn from(
    args: &CorrectArgs,
    mut reader: impl BufRead,
    corrector: &mut Corrector,
    mut writer: impl Write,
) -> Result<corrector::Report, CommandError> {
    let name = if is_standard(&args.program) {
        Path::new("standard input")
    } else {
        &args.program
    };
    let failed = |error| match error {
        CorrectError::Refused(refusal) => {
            CommandError::Data(format!("{}:{refusal}", name.display()))
        }
        CorrectError::Read(reason) => TextFileError::read(name)(reason).into(),
        CorrectError::Write(reason) if is_standard(&args.out) => CommandError::Print(reason),
        CorrectError::Write(reason) => CommandError::write(&args.out)(reason),
    };
    let start = reader
        .fill_buf()
        .map_err(|reason| failed(CorrectError::Read(reason)))?;
    wide_mark(start).map_err(CommandError::content(name))?;
    // The mark of UTF-8 is no part of the first block; the control gets it as it was.
    let mark = if start.starts_with(UTF_8_MARK) {
        UTF_8_MARK
    } else {
        &[]
    };
    reader.consume(mark.len());
    writer
        .write_all(mark)
        .map_err(|reason| failed(CorrectError::Write(reason)))?;
    let mut report = corrector::correct(reader, writer, corrector).map_err(failed)?;
    report.bytes_read += mark.len() as u64;
    report.bytes_written += mark.len() as u64;
    Ok(report)
}

/// The file appears when the last block is corrected, or not at all.
fn to_file(
    args: &CorrectArgs,
    corrector: &mut Corrector,
) -> Result<corrector::Report, CommandError> {
    let mut done = None;
    let written = whole_file::write(&args.out, |file| {
        let mut writer = BufWriter::with_capacity(BUFFER, file);
        let result = correct(args, corrector, &mut writer);
        let failed = result.is_err();
        done = Some(result);
        if failed {
            Err(io::Error::other("refused"))
        } else {
            writer.flush()
        }
    });
    match (done, written) {
        (Some(Err(error)), _) => Err(error),
        (Some(Ok(report)), Ok(())) => Ok(report),
        (_, Err(reason)) => Err(CommandError::write(&args.out)(reason)),
        (None, Ok(())) => Err(CommandError::Data("nothing was corrected".to_owned())),
    }
}

/// Hands every block on at once: a control at the other end of a line waits for it.
struct Flushing<W>(W);

impl<W: Write> Write for Flushing<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.write_all(bytes)?;
        Ok(bytes.len())
    }

    fn write_all(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.0.write_all(bytes)?;
        self.0.flush()
    }

    fn flush(&mut self) -> io::Result<()> {
        self.0.flush()
    }
}
