//! From what is stored to an axis and its link.

use core::ops::Range;

use embedded_storage::nor_flash::NorFlash;
use leadscrew::axis::{Axis, Outputs};
use leadscrew::calibration::Work;
use leadscrew::capture::Unwrapper;
use leadscrew::compensation::table::{POINTS, ScrewPoint, ScrewTable, Stretch};
use leadscrew::encoder_map::EncoderMap;
use leadscrew::params::{AxisConfig, ParamError};
use leadscrew::protocol::service::{Identity, Seen, Service};
use leadscrew::settings::Settings;

use super::Link;
use super::bench::Bench;
use super::memory::{Lent, MapPlaces};
use crate::axis_control::AxisControl;
use crate::captures::{EDGES, WORDS};
use crate::queues::Queues;
use crate::report::Report as TickReport;
use crate::store::{Interlock, Kind, Report, SET_BYTES, Source, Store};
use crate::tick::Counters;

/// What a board gives for its axis and link.
pub struct Boot<F, const CAPTURED: usize = WORDS, const LOOKED_AT: usize = EDGES> {
    /// The flash of the store.
    pub flash: F,
    /// Where in it.
    pub range: Range<u32>,
    /// What the axis is without anything stored.
    pub factory: Settings,
    /// What it says of itself.
    pub identity: Identity,
    /// Memory of the queues.
    pub queues: &'static mut Queues<CAPTURED, LOOKED_AT>,
    /// Memory to work with; [`super::WorkMemory`] is one.
    pub work: Work<'static>,
    /// Memory of encoder maps.
    pub maps: MapPlaces,
    /// Memory of the screw table in use.
    pub screw: &'static mut [Stretch; POINTS.1],
    /// Keeps the axis off while the store is written.
    pub interlock: &'static Interlock,
    /// What the tick counts.
    pub counters: &'static Counters,
}

/// What was found in the store.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Loaded {
    /// The parameters.
    pub report: Report,
    /// An encoder map is in use.
    pub has_map: bool,
    /// A screw table is in use.
    pub has_screw: bool,
    /// The store cannot be used: its flash failed, or holds no store. Nothing can be saved.
    pub is_storeless: bool,
}

impl<F: NorFlash, const CAPTURED: usize, const LOOKED_AT: usize> Boot<F, CAPTURED, LOOKED_AT> {
    /// Loads what is stored, and makes the axis of it. An axis whose parameters are not whole is not enabled before they
    /// were saved anew.
    ///
    /// # Errors
    /// [`ParamError`] if not even the factory's parameters make an axis.
    pub fn start<B>(self) -> Result<(AxisControl<B>, Link<F>, Loaded), ParamError> {
        let mut control = None;
        let (link, loaded) = self.start_with(|made, _| control = Some(made))?;
        // It was given before the link was made.
        let control = control.unwrap_or_else(|| unreachable!());
        Ok((control, link, loaded))
    }

    /// The same, where the stack has no room for the axis and the link at once: `take` puts the axis where it belongs before
    /// the link is made. It is told the settings, too.
    ///
    /// # Errors
    /// [`ParamError`] if not even the factory's parameters make an axis; then nothing was given.
    #[inline(never)]
    pub fn start_with<B>(
        self,
        take: impl FnOnce(AxisControl<B>, &Settings),
    ) -> Result<(Link<F>, Loaded), ParamError> {
        let Self {
            flash,
            range,
            factory,
            identity,
            queues,
            work,
            maps,
            screw,
            interlock,
            counters,
        } = self;
        let mut map_places = maps;
        let store = interlock
            .permit(&Outputs::default())
            .ok()
            .and_then(|permission| Store::mount(flash, range, &permission).ok());
        let mut lent = Lent::Free(work);
        let mut found = Found {
            settings: factory,
            report: Report::default(),
            map: None,
            screw: None,
        };
        let mut store = store;
        if let Some(store) = &mut store {
            found.load(store, &mut lent, &mut map_places, screw);
        }
        let is_whole = found.report.is_clean() || found.report.source == Source::Defaults;
        let mut settings = found.settings;
        let (config, is_valid) = match settings.validate() {
            Ok(config) => (config, true),
            Err(_) => {
                settings = factory;
                (settings.validate()?, false)
            }
        };
        let (tick, captures_out, ends, captures) = queues.split();
        let loaded = Loaded {
            report: found.report,
            has_map: found.map.is_some(),
            has_screw: found.screw.is_some(),
            is_storeless: store.is_none(),
        };
        let has_screw = give(
            &config,
            &found,
            !(is_whole && is_valid),
            |axis| AxisControl::new(axis, tick, captures_out, interlock),
            |control| take(control, &settings),
        );
        let service = Service::new(identity, &settings)?;
        let bench = Bench {
            ends,
            captures,
            counters,
            interlock,
            store,
            lent,
            map_places,
            learning: Default::default(),
            unwrapper: Unwrapper::new(),
            map: found.map,
            timer_hz: settings.axis.timer_hz,
            tick_hz: settings.axis.tick_hz,
            scale: config.scale,
            capabilities: identity.capabilities,
            seen: Seen::default(),
            report: TickReport::default(),
            first_fault: None,
            is_torn: false,
            is_recording: false,
            batch: None,
            session: 0,
            stream_ticket: None,
            next_ticket: 0,
            wants_restart: false,
            reset: Default::default(),
        };
        let link = Link {
            service,
            bench,
            asked: None,
        };
        let loaded = Loaded {
            has_screw,
            ..loaded
        };
        Ok((link, loaded))
    }
}

/// Makes the axis and gives it away; true if it has a screw table. On a frame of its own: an axis is large.
#[inline(never)]
fn give<B>(
    config: &AxisConfig,
    found: &Found,
    is_corrupt: bool,
    control: impl FnOnce(Axis<'static>) -> AxisControl<B>,
    take: impl FnOnce(AxisControl<B>),
) -> bool {
    let mut axis = Axis::new(*config);
    let map = found.map;
    axis.set_map(map.and_then(|image| EncoderMap::from_bytes(image).ok()));
    let has_screw = found.screw.is_some() && axis.set_screw_table(found.screw).is_ok();
    axis.supervisor_mut().set_store_corrupt(is_corrupt);
    take(control(axis));
    has_screw
}

/// What a store gave.
struct Found {
    settings: Settings,
    report: Report,
    map: Option<&'static [u8]>,
    screw: Option<ScrewTable<'static>>,
}

impl Found {
    fn load<F: NorFlash>(
        &mut self,
        store: &mut Store<F>,
        lent: &mut Lent,
        places: &mut MapPlaces,
        screw: &'static mut [Stretch; POINTS.1],
    ) {
        let Some(bytes) = lent.bytes() else {
            return;
        };
        let set = bytes.get_mut(..SET_BYTES).unwrap_or_default();
        match store.load(&self.settings, set, &mut |_| {}) {
            Ok((settings, report)) => {
                self.settings = settings;
                self.report = report;
            }
            Err(_) => self.report.source = Source::Damaged,
        }
        if let Ok(Some(entry)) = store.entry(Kind::EncoderMap)
            && let Some(place) = places.pop()
        {
            match store.load_map(place) {
                Ok(Some(_)) => {
                    let image: &'static [u8; _] = place;
                    self.map = image.get(..entry.len);
                }
                _ => drop(places.push(place)),
            }
        }
        let mut points = [ScrewPoint::default(); POINTS.1];
        if let Ok(Some(points)) = store.load_screw(&mut points, bytes) {
            self.screw = ScrewTable::build(points, screw).ok();
        }
    }
}
