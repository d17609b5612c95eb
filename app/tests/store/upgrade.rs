//! Sets that other firmware wrote.

use embassy_futures::block_on;
use leadscrew_app::store::{Error, Kind, SET_BYTES, Saved, SetEntry, Source, Value};
use sequential_storage::cache::Cache;
use sequential_storage::map::{MapConfig, MapStorage};

use super::contents::{bytes, defaults, load, mounted, permission, settings};
use super::flash::SimFlash;

type Flash = SimFlash<4096, 8>;

fn entry(name: &str, value: &Value<'_>) -> Vec<u8> {
    let (kind, value) = match value {
        Value::Number(value) => (0, value.to_le_bytes().to_vec()),
        Value::Word(word) => (1, word.as_bytes().to_vec()),
        Value::Other => (9, vec![1, 2, 3]),
    };
    let head = [name.len() as u8, kind, value.len() as u8];
    [&head, name.as_bytes(), &value].concat()
}

/// The set of `settings(1)` as other firmware would have written it.
fn other_set(change: impl Fn(&SetEntry<'_>) -> Vec<u8>, more: &[(&str, Value<'_>)]) -> Vec<u8> {
    let mut flash = Flash::new(8);
    let mut store = mounted(&mut flash);
    let work = &mut [0; SET_BYTES];
    store
        .save_params(&settings(1), work, &permission())
        .unwrap();
    let mut set = Vec::new();
    let mut take = |entry: &SetEntry<'_>| set.extend(change(entry));
    store.stored_values(work, &mut take).unwrap();
    let more = more.iter().flat_map(|(name, value)| entry(name, value));
    set.extend(more);
    set
}

#[test]
fn a_set_of_other_firmware_is_taken_by_name() {
    let set = other_set(
        |stored| match stored.name {
            // Not known to the firmware that wrote it.
            "homing.back_off_mm" => vec![],
            // Known by another name.
            "motion.max_jerk_m_s3" => entry("motion.jerk", &stored.value),
            // It allowed more.
            "output.limit" => entry(stored.name, &Value::Number(7.0)),
            "output.slew_per_s" => entry(stored.name, &Value::Number(f64::NAN)),
            "estimator" => entry(stored.name, &Value::Word("wavelet")),
            "tick_hz" => entry(stored.name, &Value::Word("fast")),
            name => entry(name, &stored.value),
        },
        &[
            ("future.colour", Value::Word("blue")),
            ("future.shape", Value::Other),
        ],
    );
    let mut flash = Flash::new(8);
    let mut store = mounted(&mut flash);
    store
        .restore(Kind::Parameters, &set, &permission())
        .unwrap();
    let (found, report, findings) = load(&mut store);
    let mut expected = settings(1);
    expected.axis.homing.back_off_mm = defaults().axis.homing.back_off_mm;
    expected.axis.estimator = defaults().axis.estimator;
    assert_eq!(found, expected);
    assert_eq!(report.source, Source::Stored);
    assert_eq!((report.missing, report.refused, report.unknown), (2, 4, 3));
    assert!(!report.is_clean() && report.invalid.is_none(), "{report}");
    let told = findings.join("\n");
    for part in [
        "homing.back_off_mm is not stored",
        "motion.max_jerk_m_s3 is not stored",
        "motion.jerk is not a parameter of this firmware",
        "output.limit = 7 is out of range: allowed 0.0001 to 1; the default 1 is taken",
        "output.slew_per_s = NaN is out of range",
        "estimator = wavelet is not known; the default exponential is taken",
        "tick_hz is stored with another type",
        "future.colour is not a parameter of this firmware: it is kept and not used",
        "future.shape is not",
    ] {
        assert!(told.contains(part), "{part}: {told}");
    }
    assert_eq!(findings.len(), 9);

    // What it does not know it keeps, and the firmware that knows it finds it again.
    let saved = store.save_params(&settings(2), &mut [0; SET_BYTES], &permission());
    assert_eq!(saved, Ok(Saved::Written));
    let (found, report, _) = load(&mut store);
    assert_eq!(found, settings(2));
    assert_eq!((report.missing, report.refused, report.unknown), (0, 0, 3));
    let mut words = Vec::new();
    let mut take = |stored: &SetEntry<'_>| {
        if stored.name == "future.colour" {
            words.push(format!("{:?}", stored.value));
        }
    };
    store.stored_values(&mut [0; SET_BYTES], &mut take).unwrap();
    assert_eq!(words, ["Word(\"blue\")"]);
    let whole = bytes(&mut store, Kind::Parameters).unwrap();
    println!("{} bytes, of which unknown values are kept", whole.len());
    let shape = entry("future.shape", &Value::Other);
    assert!(whole.windows(shape.len()).any(|part| part == shape));
}

#[test]
fn values_that_do_not_go_together_are_told() {
    let set = other_set(
        |stored| match stored.name {
            "motion.max_feed_mm_per_min" => entry(stored.name, &Value::Number(1e5)),
            name => entry(name, &stored.value),
        },
        &[],
    );
    let mut flash = Flash::new(8);
    let mut store = mounted(&mut flash);
    store
        .restore(Kind::Parameters, &set, &permission())
        .unwrap();
    let report = load(&mut store).1;
    assert!(!report.is_clean());
    let told = report.to_string();
    assert!(
        told.contains("max_feed_mm_per_min = 100000 is out of range"),
        "{told}"
    );
}

#[test]
fn a_set_that_ends_early_gives_what_it_has() {
    let set = other_set(|stored| entry(stored.name, &stored.value), &[]);
    for len in [1, 2, 3, 10, 100, set.len() / 2, set.len() - 1] {
        let mut flash = Flash::new(8);
        let mut store = mounted(&mut flash);
        store
            .restore(Kind::Parameters, &set[..len], &permission())
            .unwrap();
        let report = load(&mut store).1;
        assert_eq!((report.refused, report.unknown), (0, 0), "{len}");
        assert!(report.missing > 0, "{len}");
    }
}

#[test]
fn a_newer_format_is_neither_taken_nor_overwritten() {
    let mut flash = Flash::new(8);
    let mut store = mounted(&mut flash);
    let work = &mut [0; SET_BYTES];
    store
        .save_params(&settings(1), work, &permission())
        .unwrap();
    let entry = store.entry(Kind::Parameters).unwrap().unwrap();
    // The record as docs/store.md has it, with version 2.
    let mut record = [0; 18];
    record[0] = 2;
    record[4] = 2;
    record[8..12].copy_from_slice(&(entry.len as u32).to_le_bytes());
    record[12..16].copy_from_slice(&entry.crc.to_le_bytes());
    record[16] = 10;
    let range = 2 * 4096..8 * 4096;
    let mut map = MapStorage::<u16, _, _>::new(
        Asynchronous(&mut flash),
        MapConfig::new(range),
        Cache::new_uncached(),
    );
    block_on(map.store_item(&mut [0; 64], &0x1000, &record)).unwrap();

    let mut store = mounted(&mut flash);
    let (found, report, _) = load(&mut store);
    assert_eq!(found, defaults());
    assert_eq!(report.source, Source::Newer { version: 2 });
    let (kind, version) = (Kind::Parameters, 2);
    let saved = store.save_params(&settings(2), work, &permission());
    assert_eq!(saved, Err(Error::Newer { kind, version }));
    store.erase(kind, &permission()).unwrap();
    let saved = store.save_params(&settings(2), work, &permission());
    assert_eq!(saved, Ok(Saved::Written));
    assert_eq!(load(&mut store).0, settings(2));
}

use embedded_storage::nor_flash::{ErrorType, NorFlash as _, ReadNorFlash as _};
use embedded_storage_async::nor_flash::{NorFlash, ReadNorFlash};

use super::flash::PowerCut;

/// The flash as the storage crate takes it.
struct Asynchronous<'f>(&'f mut Flash);

impl ErrorType for Asynchronous<'_> {
    type Error = PowerCut;
}

impl ReadNorFlash for Asynchronous<'_> {
    const READ_SIZE: usize = 1;

    async fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), PowerCut> {
        self.0.read(offset, bytes)
    }

    fn capacity(&self) -> usize {
        self.0.capacity()
    }
}

impl NorFlash for Asynchronous<'_> {
    const WRITE_SIZE: usize = 8;
    const ERASE_SIZE: usize = 4096;

    async fn erase(&mut self, from: u32, to: u32) -> Result<(), PowerCut> {
        self.0.erase(from, to)
    }

    async fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), PowerCut> {
        self.0.write(offset, bytes)
    }
}
