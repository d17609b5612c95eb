//! The pin map against the makers' tables of alternate functions, for every chip the board is built for.
//!
//! An emulator does not notice a wrong alternate function: it wires timers and pins as the test tells it.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The chips that the board is built for.
const CHIPS: [&str; 2] = ["stm32f407vg", "stm32f405rg"];

/// What a pin is used for.
struct Use {
    pin: &'static str,
    peripheral: &'static str,
    signal: &'static str,
    /// `None` for a function that needs no choice, as that of an analog input.
    function: Option<u8>,
}

const fn alternate(
    pin: &'static str,
    peripheral: &'static str,
    signal: &'static str,
    function: u8,
) -> Use {
    Use {
        pin,
        peripheral,
        signal,
        function: Some(function),
    }
}

/// Pins that belong to a peripheral.
const USES: &[Use] = &[
    alternate("PA0", "TIM5", "CH1", 2),
    alternate("PA15", "TIM2", "CH1", 1),
    alternate("PA1", "TIM5", "CH2", 2),
    alternate("PB3", "TIM2", "CH2", 1),
    alternate("PB10", "TIM2", "CH3", 1),
    alternate("PA3", "TIM5", "CH4", 2),
    alternate("PA8", "TIM1", "CH1", 1),
    alternate("PA11", "TIM1", "CH4", 1),
    alternate("PB4", "TIM3", "CH1", 2),
    alternate("PB5", "TIM3", "CH2", 2),
    alternate("PB0", "TIM3", "CH3", 2),
    alternate("PB6", "TIM4", "CH1", 2),
    alternate("PA5", "SPI1", "SCK", 5),
    alternate("PA6", "SPI1", "MISO", 5),
    alternate("PA7", "SPI1", "MOSI", 5),
    alternate("PA9", "USART1", "TX", 7),
    alternate("PA10", "USART1", "RX", 7),
    alternate("PC6", "USART6", "TX", 8),
    alternate("PC7", "USART6", "RX", 8),
    Use {
        pin: "PC0",
        peripheral: "ADC1",
        signal: "IN10",
        function: None,
    },
];

/// Pins that are plain inputs and outputs, and the two of the debugger, which are so from reset.
const LINES: &[&str] = &[
    "PA13", "PA14", "PA4", "PC4", "PC5", "PB1", "PB7", "PC8", "PB9", "PB8", "PB12", "PB13", "PB14",
    "PB15", "PC1", "PC2", "PC3", "PC13",
];

/// Streams of the DMA controllers: peripheral, its request, stream, channel.
const STREAMS: &[(&str, &str, &str, u8)] = &[
    ("TIM5", "CH1", "DMA1_CH2", 6),
    ("ADC1", "ADC1", "DMA2_CH0", 0),
];

/// The pins of a chip, and what its peripherals have on them.
#[derive(Default)]
struct Chip {
    /// Pin, peripheral, signal, function.
    functions: BTreeSet<(String, String, String, Option<u8>)>,
    /// Peripheral, request, stream, channel.
    requests: BTreeSet<(String, String, String, u8)>,
    /// Pins that the package has.
    pins: BTreeSet<String>,
}

impl Chip {
    /// Reads a chip's description, which is generated Rust of one field a line.
    fn read(text: &str) -> Self {
        let mut chip = Self::default();
        let [mut peripheral, mut pin, mut signal, mut channel] =
            std::array::from_fn(|_| String::new());
        for line in text.lines() {
            let Some((name, value)) = line.trim().trim_end_matches(',').split_once(": ") else {
                continue;
            };
            let is_of_peripheral = line.starts_with("        name: ");
            match name {
                "Pin { name" => {
                    chip.pins.insert(unquoted(value));
                }
                "name" if is_of_peripheral => peripheral = unquoted(value),
                "pin" => pin = unquoted(value),
                "signal" => signal = unquoted(value),
                "channel" => channel = unquoted(value),
                "af" => {
                    let found = (
                        pin.clone(),
                        peripheral.clone(),
                        signal.clone(),
                        number(value),
                    );
                    chip.functions.insert(found);
                }
                "request" => {
                    if let Some(request) = number(value) {
                        let found = (peripheral.clone(), signal.clone(), channel.clone(), request);
                        chip.requests.insert(found);
                    }
                }
                _ => {}
            }
        }
        chip
    }

    fn has(&self, used: &Use) -> bool {
        let wanted = (
            used.pin.to_owned(),
            used.peripheral.to_owned(),
            used.signal.to_owned(),
            used.function,
        );
        self.functions.contains(&wanted)
    }

    fn has_pin(&self, pin: &str) -> bool {
        self.pins.contains(pin)
    }
}

/// The text between quotes, or the whole.
fn unquoted(value: &str) -> String {
    value.split('"').nth(1).unwrap_or(value).to_owned()
}

/// `Some(2)` as a number.
fn number(value: &str) -> Option<u8> {
    value
        .strip_prefix("Some(")?
        .trim_end_matches(')')
        .parse()
        .ok()
}

/// Where the chips' descriptions are: in the sources of the crate that embassy is built on.
fn descriptions() -> PathBuf {
    let cargo = Command::new(env!("CARGO"))
        .args(["metadata", "--format-version", "1", "--offline"])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .expect("cargo runs");
    let metadata: serde_json::Value = serde_json::from_slice(&cargo.stdout).expect("cargo's JSON");
    let packages = metadata["packages"].as_array().expect("packages");
    let found = packages
        .iter()
        .find(|package| package["name"] == "stm32-metapac");
    let manifest = found.and_then(|package| package["manifest_path"].as_str());
    let folder = Path::new(manifest.expect("stm32-metapac is a dependency")).parent();
    folder.expect("a folder").join("src/chips")
}

fn chip(name: &str) -> Chip {
    let read = |path: &Path| {
        std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
    };
    let folder = descriptions().join(name);
    let text = read(&folder.join("metadata.rs"));
    let included = text
        .split_once("include!(\"")
        .and_then(|(_, rest)| rest.split_once('"'));
    let (shared, _) = included.expect("the description includes that of its die");
    Chip::read(&read(&folder.join(shared)))
}

#[test]
fn every_pin_has_its_function_on_every_chip() {
    for name in CHIPS {
        let chip = chip(name);
        for used in USES {
            let Use {
                pin,
                peripheral,
                signal,
                function,
            } = used;
            assert!(
                chip.has(used),
                "{name}: {pin} is not {peripheral}_{signal} by {function:?}"
            );
        }
        for pin in LINES.iter().chain(USES.iter().map(|used| &used.pin)) {
            assert!(chip.has_pin(pin), "{name} has no {pin}");
        }
    }
}

#[test]
fn every_stream_serves_its_request_on_every_chip() {
    for name in CHIPS {
        let chip = chip(name);
        for &(peripheral, signal, stream, channel) in STREAMS {
            let wanted = (
                peripheral.to_owned(),
                signal.to_owned(),
                stream.to_owned(),
                channel,
            );
            assert!(chip.requests.contains(&wanted), "{name}: {wanted:?}");
        }
    }
}

#[test]
fn no_pin_and_no_stream_is_used_twice() {
    let pins: Vec<&str> = USES
        .iter()
        .map(|used| used.pin)
        .chain(LINES.iter().copied())
        .collect();
    let different: BTreeSet<_> = pins.iter().collect();
    assert_eq!(different.len(), pins.len());
    let streams: BTreeSet<_> = STREAMS.iter().map(|(_, _, stream, _)| stream).collect();
    assert_eq!(streams.len(), STREAMS.len());
}

#[test]
fn a_wrong_function_is_found() {
    let chip = chip("stm32f407vg");
    assert!(!chip.has(&alternate("PA0", "TIM5", "CH1", 1)));
    assert!(!chip.has(&alternate("PA0", "TIM1", "CH1", 1)));
    // PE9 is a pin of the larger package alone.
    assert!(!self::chip("stm32f405rg").has_pin("PE9"));
}

#[allow(dead_code, reason = "the pins are looked up by number here")]
#[path = "../../boards/stm32f4/src/pins.rs"]
mod pins;

#[test]
fn the_firmware_sets_the_pins_up_as_the_map_says() {
    let mut set_up = BTreeSet::new();
    for pin in pins::ALL {
        let name = format!("P{}{}", char::from(pin.port), pin.number);
        if let pins::Mode::Alternate(function, signal) = pin.mode {
            set_up.insert((name, signal.to_owned(), Some(function)));
        }
    }
    let mapped: BTreeSet<_> = USES
        .iter()
        .filter(|used| used.function.is_some())
        .map(|used| {
            let signal = format!("{}_{}", used.peripheral, used.signal);
            (used.pin.to_owned(), signal, used.function)
        })
        .collect();
    assert_eq!(set_up, mapped);
    let named: BTreeSet<_> = pins::ALL
        .iter()
        .map(|pin| format!("P{}{}", char::from(pin.port), pin.number))
        .collect();
    assert_eq!(named.len(), pins::ALL.len());
    for name in &named {
        let is_known = USES.iter().any(|used| used.pin == name) || LINES.contains(&name.as_str());
        assert!(is_known, "{name} is not on the map");
    }
}
