//! An axis for the line to tell of, and a line to ask it over.

use leadscrew::estimator::EstimatorConfig;
use leadscrew::protocol::refusal::Refusal;
use leadscrew::protocol::service::{Passed, Seen, Ticket};
use leadscrew::settings::Settings;
use leadscrew::units::AxisScale;
pub use leadscrew_app::modbus::Panel;
use leadscrew_app::modbus::{Config, Modbus, View};

pub const UNIT: u8 = 7;

pub fn settings() -> Settings {
    Settings::new(EstimatorConfig::by_name("simple").unwrap().unwrap())
}

/// An axis that stands, off.
pub fn view() -> View {
    View {
        seen: Seen::default(),
        scale: AxisScale::new(1000.0, 1000.0).unwrap(),
        percent: 100,
        is_held: false,
        is_leased: false,
        counts: Default::default(),
        first_fault: None,
        probe: None,
        capabilities: 0,
    }
}

/// What it says it is; parameters as the link has them.
pub struct Fake {
    pub view: View,
    pub settings: Settings,
    pub passed: Passed,
    pub outcome: Option<Result<(), Refusal>>,
    pub saved: u32,
    pub store: Result<(), Refusal>,
}

impl Default for Fake {
    fn default() -> Self {
        Self {
            view: view(),
            settings: settings(),
            passed: Passed::Taken,
            outcome: None,
            saved: 0,
            store: Ok(()),
        }
    }
}

impl Panel for Fake {
    fn view(&self) -> View {
        self.view
    }

    fn settings(&self) -> Settings {
        self.settings
    }

    fn set(&mut self, mut settings: Settings) -> Result<Passed, Refusal> {
        settings.validate().map_err(|_| Refusal::Inconsistent)?;
        if self.passed == Passed::Taken {
            self.settings = settings;
        }
        Ok(self.passed)
    }

    fn outcome(&mut self, ticket: Ticket) -> Option<Result<(), Refusal>> {
        let outcome = self.outcome;
        outcome.filter(|_| self.passed == Passed::OnItsWay(ticket))
    }

    fn save(&mut self) -> Result<(), Refusal> {
        self.store.inspect(|()| self.saved += 1)
    }
}

/// A unit on a line of 19 200 baud, with a clock.
pub struct Unit {
    pub modbus: Modbus,
    pub panel: Fake,
    pub now_us: u32,
}

impl Default for Unit {
    fn default() -> Self {
        Self::of(Fake::default())
    }
}

impl Unit {
    pub fn of(panel: Fake) -> Self {
        Self {
            modbus: Modbus::new(Config::serial(UNIT, 19_200).unwrap(), panel.settings),
            panel,
            // Wraps soon.
            now_us: u32::MAX - 5_000,
        }
    }

    /// Bytes that come together; what is answered.
    pub fn hear(&mut self, bytes: &[u8]) -> Vec<Vec<u8>> {
        let mut sent = Vec::new();
        let send = &mut |frame: &[u8]| sent.push(frame.to_vec());
        self.modbus
            .receive(bytes, self.now_us, &mut self.panel, send);
        sent
    }

    /// A silence; what is answered.
    pub fn wait_us(&mut self, us: u32) -> Vec<Vec<u8>> {
        let mut sent = Vec::new();
        self.now_us = self.now_us.wrapping_add(us);
        let send = &mut |frame: &[u8]| sent.push(frame.to_vec());
        self.modbus.poll(self.now_us, &mut self.panel, send);
        sent
    }

    /// A request after a silence; function and data of its one answer.
    #[track_caller]
    pub fn ask(&mut self, request: &[u8]) -> Vec<u8> {
        assert!(self.wait_us(10_000).is_empty());
        let sent = self.hear(&framed(UNIT, request));
        let [reply] = sent.as_slice() else {
            panic!("{} answers to {request:02x?}", sent.len());
        };
        assert!(reply.len() <= 256);
        let (content, check) = reply.split_last_chunk().unwrap();
        assert_eq!(crc(content), u16::from_le_bytes(*check));
        assert_eq!(content[0], UNIT);
        content[1..].to_vec()
    }

    /// Registers read by a function.
    #[track_caller]
    pub fn read(&mut self, function: u8, address: u16, count: u16) -> Vec<u16> {
        let reply = self.ask(&asking(function, address, count));
        assert_eq!(reply[..2], [function, count as u8 * 2]);
        let (pairs, rest) = reply[2..].as_chunks();
        assert!(rest.is_empty() && pairs.len() == usize::from(count));
        pairs.iter().map(|pair| u16::from_be_bytes(*pair)).collect()
    }

    /// Discrete inputs.
    #[track_caller]
    pub fn bits(&mut self, address: u16, count: u16) -> Vec<bool> {
        let reply = self.ask(&asking(2, address, count));
        assert_eq!(reply[..2], [2, count.div_ceil(8) as u8]);
        let bit = |at: usize| reply[2 + at / 8] & 1 << (at % 8) != 0;
        (0..usize::from(count)).map(bit).collect()
    }

    /// Registers written by function 16.
    #[track_caller]
    pub fn write(&mut self, address: u16, words: &[u16]) -> Vec<u8> {
        self.ask(&writing(address, words))
    }
}

/// A request of a function with an address and a count or value.
pub fn asking(function: u8, address: u16, count: u16) -> Vec<u8> {
    let [address, count] = [address, count].map(u16::to_be_bytes);
    [&[function][..], &address, &count].concat()
}

pub fn writing(address: u16, words: &[u16]) -> Vec<u8> {
    let mut request = asking(16, address, words.len() as u16);
    request.push(words.len() as u8 * 2);
    request.extend(words.iter().flat_map(|word| word.to_be_bytes()));
    request
}

/// An f64 as its registers.
pub fn words(value: f64) -> [u16; 4] {
    [48, 32, 16, 0].map(|shift| (value.to_bits() >> shift) as u16)
}

pub fn number(words: &[u16]) -> f64 {
    let bits = words
        .iter()
        .fold(0, |sum, word| sum << 16 | u64::from(*word));
    f64::from_bits(bits)
}

/// A frame of a unit.
pub fn framed(unit: u8, content: &[u8]) -> Vec<u8> {
    let mut frame = [&[unit][..], content].concat();
    frame.extend(crc(&frame).to_le_bytes());
    frame
}

/// As the specification states it (Modbus over serial line 1.02, 6.2.2), bit by bit.
pub fn crc(bytes: &[u8]) -> u16 {
    let mut crc = 0xffff_u16;
    for byte in bytes {
        crc ^= u16::from(*byte);
        for _ in 0..8 {
            let carry = crc & 1;
            crc >>= 1;
            if carry != 0 {
                crc ^= 0xA001;
            }
        }
    }
    crc
}
