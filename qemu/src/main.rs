//! Builds a board image, runs it in QEMU, prints its log. Exits with the guest's exit code, or with
//! 2 for bad usage and 3 if it could not be built or run.
//!
//! With `--link` or `--modbus` the guest runs until it is told to end, or interrupted, and no faster than the
//! wall.

mod live;

use std::process::ExitCode;

use leadscrew_qemu::{Carrier, Error, LARGEST_SHIFT, Output, Run, Sections, build};

const USAGE: &str = "\
usage: leadscrew-qemu BIN [--shift N] [--messages] [GUEST-WORD...]
       leadscrew-qemu BIN --link LINE [--modbus LINE] [--shift N] [GUEST-WORD...]
       leadscrew-qemu BIN --sections
  BIN            binary of the board crate: axis, bench, linked, product
  --shift N      one instruction takes 2^N ns, 0 to 10 (default 3; 4 with --link or --modbus)
  --messages     only the messages, without time and level
  --link LINE    put UART 0 on a line and run until interrupted: tcp, tcp:PORT of 127.0.0.1, or pty
  --modbus LINE  the same for UART 1
  --sections     do not run it: print the bytes of text, data and bss
  GUEST-WORD     word of the guest's command line, for instance tick-hz=2500";

#[derive(Debug, PartialEq, Eq)]
struct Arguments {
    bin: String,
    shift: Option<u32>,
    link: Option<Carrier>,
    modbus: Option<Carrier>,
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
    } else if arguments.link.is_some() || arguments.modbus.is_some() {
        live::run(&arguments)
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
        shift: None,
        link: None,
        modbus: None,
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
                let number = words.next().and_then(|number| number.parse().ok());
                let shift = number.filter(|shift| *shift <= LARGEST_SHIFT);
                arguments.shift = Some(shift.ok_or("--shift needs a number from 0 to 10")?);
            }
            "--link" => arguments.link = Some(line("--link", words.next())?),
            "--modbus" => arguments.modbus = Some(line("--modbus", words.next())?),
            option if option.starts_with('-') => return Err(format!("unknown option {option}")),
            _ => arguments.words.push(word),
        }
    }
    Ok(arguments)
}

fn line(option: &str, word: Option<String>) -> Result<Carrier, String> {
    let word = word.unwrap_or_default();
    let port = match word.split_once(':') {
        Some(("tcp", port)) => port.parse().ok(),
        None if word == "tcp" => Some(0),
        None if word == "pty" => return Ok(Carrier::Pty),
        _ => None,
    };
    let port = port.ok_or(format!("{option} needs tcp, tcp:PORT or pty"))?;
    Ok(Carrier::Tcp { port })
}

fn run(arguments: &Arguments) -> Result<ExitCode, Error> {
    let mut run = Run::new(build(&arguments.bin, "firmware")?).shift(arguments.shift.unwrap_or(3));
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
        assert_eq!((arguments.shift, arguments.messages), (Some(5), true));
        assert_eq!(arguments.words, ["a=1", "b=2"]);
    }

    #[test]
    fn lines_are_ports_or_terminals() {
        let arguments = parsed(&["linked", "--link", "tcp:4000", "--modbus", "pty"]).unwrap();
        assert_eq!(arguments.link, Some(Carrier::Tcp { port: 4000 }));
        assert_eq!(arguments.modbus, Some(Carrier::Pty));
        for wrong in ["udp", "tcp:port", "tcp:70000", "pty:1", ""] {
            let refused = parsed(&["linked", "--link", wrong]).unwrap_err();
            assert!(refused.contains("tcp:PORT"), "{refused}");
        }
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
