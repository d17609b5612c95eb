//! Which parameters there are, in a number.

use leadscrew::settings::{Key, Number, Settings, Values};

use crc::{CRC_32_ISO_HDLC, Crc, Digest, NoTable};

const CRC: Crc<u32, NoTable> = Crc::<u32, NoTable>::new(&CRC_32_ISO_HDLC);

/// The list of parameters, as far as their places go. Firmware with another list has parameters at other registers; a
/// master compares the checksum before it writes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ParameterList {
    /// How many there are.
    pub count: u16,
    /// CRC-32 (that of zip) of the name of each, section and all, with a line feed behind, in order.
    pub checksum: u32,
}

struct Names<'c> {
    count: u16,
    digest: Digest<'c, u32, NoTable>,
}

impl Names<'_> {
    fn note(&mut self, key: Key) {
        for part in key.parts().into_iter().chain(["\n"]) {
            self.digest.update(part.as_bytes());
        }
        self.count = self.count.saturating_add(1);
    }
}

impl Values for Names<'_> {
    fn number(&mut self, key: Key, _: &Number, value: f64) -> f64 {
        self.note(key);
        value
    }

    fn word(&mut self, key: Key, _: &[&'static str], value: &'static str) -> &'static str {
        self.note(key);
        value
    }
}

impl ParameterList {
    /// The list of all settings.
    #[must_use]
    pub fn of(settings: &Settings) -> Self {
        let mut names = Names {
            count: 0,
            digest: CRC.digest(),
        };
        let mut settings = *settings;
        settings.visit(&mut names);
        Self {
            count: names.count,
            checksum: names.digest.finalize(),
        }
    }
}
