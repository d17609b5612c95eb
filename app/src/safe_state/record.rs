//! The record of a reset in RAM that start-up code leaves alone.
//!
//! ```text
//! word  0      1                2           3 ─ 14                              15
//!       magic  kind, 0 for none  resets     of the kind, unused words 0         CRC-32 of words 0 to 14
//! ```
//!
//! RAM that was never written, or lost its power, is garbage: magic and checksum both have to be right, and every word that a
//! kind does not use zero. Whoever dies writes [`Record::words`] as a whole; a write that was cut fails the checksum. The
//! number of resets since the power came goes on from record to record.

use crc::{CRC_32_ISO_HDLC, Crc, NoTable};

use super::reason::{FILE_BYTES, HardFault, Place, Reason};

/// Words of the record.
pub const WORDS: usize = 16;
const MAGIC: u32 = 0x5afe_1ead;
const BODY: usize = 12;
const FILE_WORDS: usize = FILE_BYTES / 4;

/// What is kept: why the next reset comes, if it is known, and how many came before.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Record {
    /// The reason.
    pub reason: Option<Reason>,
    /// Resets that nobody asked for since the power came.
    pub resets: u32,
}

/// What the reset's flags of the chip say.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ResetFlags {
    /// The watchdog did it.
    pub watchdog: bool,
    /// The power came: what was counted before is over.
    pub power: bool,
}

impl Record {
    /// The record after a reset: what was kept, or what the flags tell where nothing was. `kept` may be garbage. The reset is
    /// counted if there was a reason for it.
    ///
    /// With `flags.power` nothing is believed, as an older record may have outlived a short failure of the power.
    #[must_use]
    pub fn after_reset(kept: &[u32; WORDS], flags: ResetFlags) -> Self {
        let kept = if flags.power {
            Self::default()
        } else {
            Self::from_words(kept).unwrap_or_default()
        };
        let watchdog = flags.watchdog.then_some(Reason::Watchdog);
        // Late ticks that recovered were no reason, unless the watchdog says so.
        let reason = match kept.reason {
            Some(Reason::LateTicks { .. }) if !flags.watchdog => None,
            reason => reason.or(watchdog),
        };
        Self {
            reason,
            resets: kept.resets.saturating_add(reason.is_some().into()),
        }
    }

    /// The record to be kept from now on: no reason yet, the same count.
    #[must_use]
    pub const fn at_start(self) -> Self {
        Self {
            reason: None,
            ..self
        }
    }

    /// The record with a reason, for whoever knows one; the count is that of [`Self::after_reset`].
    #[must_use]
    pub const fn with(self, reason: Reason) -> Self {
        Self {
            reason: Some(reason),
            ..self
        }
    }

    /// As words.
    #[must_use]
    pub fn words(&self) -> [u32; WORDS] {
        let (kind, body) = self.reason.map_or((0, [0; BODY]), |reason| {
            (reason.number().into(), body_of(&reason))
        });
        let mut words = [0; WORDS];
        let content = [MAGIC, kind, self.resets].into_iter().chain(body);
        words
            .iter_mut()
            .zip(content)
            .for_each(|(word, value)| *word = value);
        let [content @ .., checksum] = &mut words;
        *checksum = checksum_of(content);
        words
    }

    /// From words; `None` if they are none that [`Self::words`] made.
    #[must_use]
    pub fn from_words(words: &[u32; WORDS]) -> Option<Self> {
        let [magic, kind, resets, body @ .., checksum] = words;
        let [content @ .., _] = words;
        if *magic != MAGIC || *checksum != checksum_of(content) {
            return None;
        }
        let record = Self {
            reason: if *kind == 0 {
                None
            } else {
                Some(reason_of(*kind, body)?)
            },
            resets: *resets,
        };
        (record.words() == *words).then_some(record)
    }
}

fn checksum_of(words: &[u32]) -> u32 {
    let crc = Crc::<u32, NoTable>::new(&CRC_32_ISO_HDLC);
    let mut digest = crc.digest();
    words
        .iter()
        .for_each(|word| digest.update(&word.to_le_bytes()));
    digest.finalize()
}

fn body_of(reason: &Reason) -> [u32; BODY] {
    match reason {
        Reason::Panic(Place { hash, line, file }) => {
            let (file, _) = file.as_chunks::<4>();
            let file = file.iter().map(|bytes| u32::from_le_bytes(*bytes));
            body_with([*hash, *line].into_iter().chain(file))
        }
        Reason::HardFault(fault) => {
            let HardFault {
                pc,
                lr,
                cfsr,
                hfsr,
                address,
            } = *fault;
            body_with([pc, lr, cfsr, hfsr, address].into_iter())
        }
        Reason::Watchdog | Reason::StackOverflow => [0; BODY],
        Reason::LateTicks { tick } => body_with([*tick].into_iter()),
    }
}

/// Values, and zeros behind them.
fn body_with(values: impl Iterator<Item = u32>) -> [u32; BODY] {
    let mut body = [0; BODY];
    body.iter_mut()
        .zip(values)
        .for_each(|(word, value)| *word = value);
    body
}

fn reason_of(kind: u32, body: &[u32; BODY]) -> Option<Reason> {
    Some(match (kind, *body) {
        (1, [hash, line, rest @ ..]) => {
            let mut file = [0; FILE_BYTES];
            let (chunks, _) = file.as_chunks_mut::<4>();
            chunks
                .iter_mut()
                .zip(rest.iter().take(FILE_WORDS))
                .for_each(|(bytes, word)| *bytes = word.to_le_bytes());
            Reason::Panic(Place { hash, line, file })
        }
        (2, [pc, lr, cfsr, hfsr, address, ..]) => Reason::HardFault(HardFault {
            pc,
            lr,
            cfsr,
            hfsr,
            address,
        }),
        (3, _) => Reason::Watchdog,
        (4, [tick, ..]) => Reason::LateTicks { tick },
        (5, _) => Reason::StackOverflow,
        _ => return None,
    })
}
