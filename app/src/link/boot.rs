//! From what is stored to an axis and its link.

use core::ops::Range;

use embedded_storage::nor_flash::NorFlash;
use leadscrew::axis::{Axis, Outputs};
use leadscrew::calibration::Work;
use leadscrew::capture::Unwrapper;
use leadscrew::compensation::table::{POINTS, ScrewPoint, ScrewTable, Stretch};
use leadscrew::encoder_map::EncoderMap;
use leadscrew::estimator::observer::Gains;
use leadscrew::params::{AxisConfig, ParamError};
use leadscrew::protocol::service::{Identity, Seen, Service};
use leadscrew::settings::Settings;
use leadscrew::units::AxisScale;

use super::Link;
use super::bench::Bench;
use super::memory::{Lent, MapPlaces};
use crate::axis_control::AxisControl;
use crate::captures::{CaptureReceiver, EDGES, WORDS};
use crate::queues::{LinkEnds, Queues};
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
        let (mut control, mut link) = (None, None);
        let (_, _, loaded) =
            self.start_in(|made| control.insert(made), |made| link.insert(made))?;
        // Both were made.
        match (control, link) {
            (Some(control), Some(link)) => Ok((control, link, loaded)),
            _ => unreachable!(),
        }
    }

    /// The same in place, for a board whose stack has no room for an axis and a link: each is put, once made, where
    /// `control` and `link` have it.
    ///
    /// # Errors
    /// [`ParamError`] if not even the factory's parameters make an axis.
    #[inline(never)]
    pub fn start_in<'c, 'l, B>(
        self,
        control: impl FnOnce(AxisControl<B>) -> &'c mut AxisControl<B>,
        link: impl FnOnce(Link<F>) -> &'l mut Link<F>,
    ) -> Result<(&'c mut AxisControl<B>, &'l mut Link<F>, Loaded), ParamError> {
        let Self {
            flash,
            range,
            mut factory,
            identity,
            queues,
            work,
            maps: mut map_places,
            screw,
            interlock,
            counters,
        } = self;
        let mut store = interlock
            .permit(&Outputs::default())
            .ok()
            .and_then(|permission| Store::mount(flash, range, &permission).ok());
        let mut found = Found {
            settings: factory,
            report: Report::default(),
            map: None,
            screw: None,
        };
        if let Some(store) = &mut store {
            let bytes = bytemuck::cast_slice_mut(work.mean);
            found.load(store, bytes, &mut map_places, screw);
        }
        let is_valid = check(&mut found.settings).is_ok();
        if !is_valid {
            // As it is once it is whole.
            check(&mut factory)?;
            found.settings = factory;
        }
        let (tick, captures_out, ends, captures) = queues.split();
        let control = make(&mut found.settings, |config, gains| {
            control(AxisControl::new(
                Axis::with_gains(*config, gains),
                tick,
                captures_out,
                interlock,
            ))
        })?;
        let loaded = Loaded {
            report: found.report,
            has_map: found.map.is_some(),
            has_screw: found.give(control.axis_mut(), is_valid),
            is_storeless: store.is_none(),
        };
        let parts = Parts {
            identity,
            ends,
            captures,
            counters,
            interlock,
            store,
            work,
            map_places,
            map: found.map,
        };
        let link = parts.link(&found.settings, control.axis_mut().config(), link)?;
        Ok((control, link, loaded))
    }
}

/// Validates, on a frame of its own: what comes of it is large.
#[inline(never)]
fn check(settings: &mut Settings) -> Result<(), ParamError> {
    settings.validate().map(|_| ())
}

/// Makes an axis of settings. Apart from both: what comes of validation is large, and so is an axis, and each is to have
/// the stack for itself.
#[inline(never)]
fn make<'c, B>(
    settings: &mut Settings,
    make: impl FnOnce(&AxisConfig, &Gains) -> &'c mut AxisControl<B>,
) -> Result<&'c mut AxisControl<B>, ParamError> {
    let config = settings.validate()?;
    let gains = config.estimators.gains();
    Ok(on_a_frame_of_its_own(&config, &gains, make))
}

#[inline(never)]
fn on_a_frame_of_its_own<'c, B>(
    config: &AxisConfig,
    gains: &Gains,
    make: impl FnOnce(&AxisConfig, &Gains) -> &'c mut AxisControl<B>,
) -> &'c mut AxisControl<B> {
    make(config, gains)
}

/// What a link is made of.
struct Parts<F: NorFlash> {
    identity: Identity,
    ends: LinkEnds,
    captures: CaptureReceiver,
    counters: &'static Counters,
    interlock: &'static Interlock,
    store: Option<Store<F>>,
    work: Work<'static>,
    map_places: MapPlaces,
    map: Option<&'static [u8]>,
}

impl<F: NorFlash> Parts<F> {
    /// Makes the link in its place. On a frame of its own, too.
    #[inline(never)]
    fn link<'l>(
        self,
        settings: &Settings,
        config: &AxisConfig,
        place: impl FnOnce(Link<F>) -> &'l mut Link<F>,
    ) -> Result<&'l mut Link<F>, ParamError> {
        let motion = &settings.axis.motion;
        let scale = AxisScale::new(motion.counts_per_mm, settings.axis.tick_hz)?;
        let bench = Bench {
            ends: self.ends,
            captures: self.captures,
            counters: self.counters,
            interlock: self.interlock,
            store: self.store,
            lent: Lent::Free(self.work),
            map_places: self.map_places,
            learning: Default::default(),
            unwrapper: Unwrapper::new(),
            map: self.map,
            timer_hz: settings.axis.timer_hz,
            tick_hz: settings.axis.tick_hz,
            scale,
            capabilities: self.identity.capabilities,
            seen: Seen::default(),
            report: TickReport::default(),
            first_fault: None,
            probe: leadscrew::probe::Report::default(),
            latch: None,
            is_torn: false,
            is_recording: false,
            batch: None,
            session: 0,
            stream_ticket: None,
            next_ticket: 0,
            wants_restart: false,
            reset: Default::default(),
            inputs: None,
        };
        Ok(place(Link {
            service: Service::new(self.identity, settings, config),
            bench,
            asked: None,
        }))
    }
}

/// What a store gave.
struct Found {
    settings: Settings,
    report: Report,
    map: Option<&'static [u8]>,
    screw: Option<ScrewTable<'static>>,
}

impl Found {
    /// Gives the axis what else was stored; true if it has a screw table.
    #[inline(never)]
    fn give(&self, axis: &mut Axis<'static>, is_valid: bool) -> bool {
        let map = self.map;
        axis.set_map(map.and_then(|image| EncoderMap::from_bytes(image).ok()));
        let has_screw = self.screw.is_some() && axis.set_screw_table(self.screw).is_ok();
        let is_whole = self.report.is_clean() || self.report.source == Source::Defaults;
        axis.supervisor_mut()
            .set_store_corrupt(!(is_whole && is_valid));
        has_screw
    }

    /// On a frame of its own, as are all that follow: the board's stack is small.
    #[inline(never)]
    fn load<F: NorFlash>(
        &mut self,
        store: &mut Store<F>,
        bytes: &mut [u8],
        places: &mut MapPlaces,
        screw: &'static mut [Stretch; POINTS.1],
    ) {
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
