//! Builds a board image, runs it in QEMU, prints its log. Exits with the guest's exit code, or with
//! 2 for bad usage and 3 if it could not be built or run.

use std::process::ExitCode;

use leadscrew_qemu::{Error, LARGEST_SHIFT, Output, Run, Sections, build};

const USAGE: &str = "\
usage: leadscrew-qemu BIN [--shift N] [--messages] [GUEST-WORD...]
       leadscrew-qemu BIN --sections
  BIN         binary of the board crate: axis, bench, product
  --shift N   one instruction takes 2^N ns, 0 to 10 (default 3)
  --messages  only the messages, without time and level
  --sections  do not run it: print the bytes of text, data and bss
  GUEST-WORD  word of the guest's command line, for instance tick-hz=2500";

#[derive(Debug, PartialEq, Eq)]
struct Arguments {
    bin: String,
    shift: u32,
    messages: bool,
    sections: bool,
    words: Vec<String>,
}

fn main() -> ExitCode {
    let arguments = match parse(std::env::args().skip(1)) {
        Ok(arguments) => arguments,
        Err(error) => {
            eprintln!("{error}\n{USAGE}");
            return ExitCode::from(2);
        }
    };
    let code = if arguments.sections {
        sections(&arguments.bin)
    } else {
        run(&arguments)
    };
    code.unwrap_or_else(|error| {
        eprintln!("error: {error}");
        ExitCode::from(3)
    })
}

fn sections(bin: &str) -> Result<ExitCode, Error> {
    let Sections { text, data, bss } = Sections::of(&build(bin, "firmware")?)?;
    println!("text {text}\ndata {data}\nbss {bss}");
    Ok(ExitCode::SUCCESS)
}

fn parse(words: impl Iterator<Item = String>) -> Result<Arguments, String> {
    let mut arguments = Arguments {
        bin: String::new(),
        shift: 3,
        messages: false,
        sections: false,
        words: Vec::new(),
    };
    let mut words = words;
    arguments.bin = words.next().ok_or("BIN is missing")?;
    while let Some(word) = words.next() {
        match word.as_str() {
            "--messages" => arguments.messages = true,
            "--sections" => arguments.sections = true,
            "--shift" => {
                arguments.shift = words
                    .next()
                    .and_then(|number| number.parse().ok())
                    .filter(|shift| *shift <= LARGEST_SHIFT)
                    .ok_or("--shift needs a number from 0 to 10")?;
            }
            option if option.starts_with('-') => return Err(format!("unknown option {option}")),
            _ => arguments.words.push(word),
        }
    }
    Ok(arguments)
}

fn run(arguments: &Arguments) -> Result<ExitCode, Error> {
    let mut run = Run::new(build(&arguments.bin, "firmware")?).shift(arguments.shift);
    run.args.clone_from(&arguments.words);
    let output = run.run()?;
    print(&output, arguments.messages);
    Ok(u8::try_from(output.exit_code).map_or(ExitCode::FAILURE, ExitCode::from))
}

fn print(output: &Output, messages: bool) {
    for line in &output.log_lines {
        if messages && line.level != "error" {
            println!("{}", line.message);
        } else {
            println!("{line}");
        }
    }
    print!("{}", output.uart);
    eprint!("{}", output.stderr);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(words: &[&str]) -> Result<Arguments, String> {
        parse(words.iter().map(ToString::to_string))
    }

    #[test]
    fn options_and_words_may_be_mixed() {
        let arguments = parsed(&["axis", "a=1", "--shift", "5", "b=2", "--messages"]).unwrap();
        assert_eq!((arguments.shift, arguments.messages), (5, true));
        assert_eq!(arguments.words, ["a=1", "b=2"]);
    }

    #[test]
    fn bad_usage_is_told() {
        assert!(parsed(&[]).unwrap_err().contains("BIN"));
        assert!(
            parsed(&["axis", "--shift"])
                .unwrap_err()
                .contains("0 to 10")
        );
        assert!(
            parsed(&["axis", "--shift", "11"])
                .unwrap_err()
                .contains("0 to 10")
        );
        assert!(parsed(&["axis", "--fast"]).unwrap_err().contains("--fast"));
    }
}
