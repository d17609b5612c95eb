//! Settings to and from the store.

use embedded_storage::nor_flash::NorFlash;
use leadscrew::settings::{Key, Number, Settings, Values};

use super::set::{Set, SetWriter};
use super::{Error, Finding, Kind, Permission, Report, Saved, SetEntry, Source, Store, Value};

/// Longest set of parameters, bytes, what other firmware left in it included.
pub const SET_BYTES: usize = 12 * 1024;

/// What the store does with settings.
trait Stored {
    /// Its bytes into `memory`; gives how many there are, or would be.
    fn write(&mut self, memory: &mut [u8]) -> usize;
    fn is_known(&mut self, name: &str) -> bool;
    fn read(&mut self, bytes: &[u8], report: &mut Report, note: &mut dyn FnMut(Finding<'_>));
}

impl Stored for Settings {
    fn write(&mut self, memory: &mut [u8]) -> usize {
        let mut save = Save(SetWriter::new(memory));
        self.visit(&mut save);
        save.0.len()
    }

    fn is_known(&mut self, name: &str) -> bool {
        let mut known = Known { name, found: false };
        self.visit(&mut known);
        known.found
    }

    fn read(&mut self, bytes: &[u8], report: &mut Report, note: &mut dyn FnMut(Finding<'_>)) {
        let mut load = Load {
            set: Set::new(bytes),
            report,
            note,
        };
        let names = self.visit(&mut load);
        if let Err(error) = self.choose(names) {
            report.invalid = Some(error.into());
        }
        for entry in Set::new(bytes) {
            if !self.is_known(entry.name) {
                report.unknown += 1;
                note(Finding::Unknown { name: entry.name });
            }
        }
    }
}

impl<F: NorFlash> Store<F> {
    /// The settings stored, on `defaults`; `note` is told of everything that is not as stored. `work` holds
    /// [`SET_BYTES`] meanwhile. Whatever is wrong with what is stored is in the report, and defaults are taken.
    ///
    /// # Errors
    /// `work` is too small, or the flash failed.
    pub fn load(
        &mut self,
        defaults: &Settings,
        work: &mut [u8],
        note: &mut dyn FnMut(Finding<'_>),
    ) -> Result<(Settings, Report), Error<F::Error>> {
        let (mut settings, mut report) = (*defaults, Report::default());
        match self.read(Kind::Parameters, work) {
            Ok(Some(bytes)) => {
                report.source = Source::Stored;
                settings.read(bytes, &mut report, note);
            }
            Ok(None) => {}
            Err(Error::Damaged { .. }) => report.source = Source::Damaged,
            Err(Error::Newer { version, .. }) => report.source = Source::Newer { version },
            Err(error) => return Err(error),
        }
        if report.invalid.is_none() {
            report.invalid = settings.axis.validate().err();
        }
        Ok((settings, report))
    }

    /// Saves all settings at once, and beside them what of the stored ones is unknown. `work` holds [`SET_BYTES`]
    /// meanwhile.
    ///
    /// # Errors
    /// An estimator that its name does not tell, a newer format, no room, or the flash failed; the settings saved
    /// before are still there.
    pub fn save_params(
        &mut self,
        settings: &Settings,
        work: &mut [u8],
        permission: &Permission<'_>,
    ) -> Result<Saved, Error<F::Error>> {
        let mut settings = *settings;
        let kind = Kind::Parameters;
        let axis = &settings.axis;
        for estimator in [Some(axis.estimator), axis.second_estimator]
            .into_iter()
            .flatten()
        {
            let name = estimator.name();
            if settings.estimator(name) != Ok(Some(estimator)) {
                return Err(Error::Estimator { name });
            }
        }
        let given = work.len();
        let known = settings.write(work);
        let too_small = |needed| Error::Memory {
            kind,
            given,
            needed,
        };
        let Some((_, rest)) = work.split_at_mut_checked(known) else {
            return Err(too_small(known));
        };
        let stored = match self.read(kind, rest) {
            Ok(stored) => stored.map_or(0, <[u8]>::len),
            // There is nothing to keep.
            Err(Error::Damaged { .. }) => 0,
            Err(Error::Memory { needed, .. }) => return Err(too_small(known + needed)),
            Err(error) => return Err(error),
        };
        let kept = keep_unknown(&mut rest[..stored], &mut settings);
        let len = known + kept;
        if len > SET_BYTES {
            return Err(Error::TooLarge {
                kind,
                len,
                most: SET_BYTES,
            });
        }
        self.write_bytes(kind, &work[..len], permission)
    }

    /// Tells `take` every value that is stored, known or not; none are told if none are there.
    ///
    /// # Errors
    /// As of [`Self::read`].
    pub fn stored_values(
        &mut self,
        work: &mut [u8],
        take: &mut dyn FnMut(&SetEntry<'_>),
    ) -> Result<(), Error<F::Error>> {
        let bytes = self.read(Kind::Parameters, work)?.unwrap_or_default();
        Set::new(bytes).for_each(|entry| take(&entry));
        Ok(())
    }
}

/// Moves the entries of unknown name to the front; gives how many bytes they have.
fn keep_unknown(set: &mut [u8], settings: &mut Settings) -> usize {
    let (mut at, mut kept) = (0, 0);
    while let Some(entry) = Set::new(&set[at..]).next() {
        let len = entry.bytes.len();
        if !settings.is_known(entry.name) {
            set.copy_within(at..at + len, kept);
            kept += len;
        }
        at += len;
    }
    kept
}

struct Save<'m>(SetWriter<'m>);

impl Values for Save<'_> {
    fn number(&mut self, key: Key, _: &Number, value: f64) -> f64 {
        self.0.entry(key, Value::Number(value));
        value
    }

    fn word(&mut self, key: Key, _: &[&'static str], value: &'static str) -> &'static str {
        self.0.entry(key, Value::Word(value));
        value
    }
}

struct Load<'l> {
    set: Set<'l>,
    report: &'l mut Report,
    note: &'l mut dyn FnMut(Finding<'_>),
}

impl Load<'_> {
    fn refuse<T>(&mut self, finding: Finding<'_>, default: T) -> T {
        match finding {
            Finding::Missing { .. } => self.report.missing += 1,
            _ => self.report.refused += 1,
        }
        (self.note)(finding);
        default
    }
}

impl Values for Load<'_> {
    fn number(&mut self, key: Key, number: &Number, default: f64) -> f64 {
        let finding = match self.set.value(key) {
            Some(Value::Number(value)) if number.allows(value) => {
                self.report.taken += 1;
                return value;
            }
            Some(Value::Number(value)) => Finding::OutOfRange {
                key,
                value,
                range: (number.min, number.max),
                default,
            },
            Some(_) => Finding::WrongType { key },
            None => Finding::Missing { key },
        };
        self.refuse(finding, default)
    }

    fn word(&mut self, key: Key, words: &[&'static str], default: &'static str) -> &'static str {
        let finding = match self.set.value(key) {
            Some(Value::Word(word)) => {
                if let Some(known) = words.iter().find(|known| **known == word) {
                    self.report.taken += 1;
                    return known;
                }
                Finding::UnknownWord { key, word, default }
            }
            Some(_) => Finding::WrongType { key },
            None => Finding::Missing { key },
        };
        self.refuse(finding, default)
    }
}

/// Looks whether a name is known.
struct Known<'n> {
    name: &'n str,
    found: bool,
}

impl Values for Known<'_> {
    fn number(&mut self, key: Key, _: &Number, value: f64) -> f64 {
        self.found |= key.is(self.name);
        value
    }

    fn word(&mut self, key: Key, _: &[&'static str], value: &'static str) -> &'static str {
        self.found |= key.is(self.name);
        value
    }
}
