//! What became of the encoder map on a capture.

use std::fmt;

use leadscrew::encoder_map::Form;
use leadscrew::encoder_map::tie::{MapHealth, MapState};
use serde::Serialize;

use crate::listening::Listening;
use crate::map_file::{MapFile, MapFileError};

/// When the map was tied to the index, and what the indexes showed.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct TieLog {
    first_tied: Option<usize>,
    state: MapState,
    health: MapHealth,
}

impl TieLog {
    /// Takes note of the state after a tick.
    pub(super) fn note(&mut self, tick: usize, listening: &Listening<'_>) {
        let Some(state) = listening.map_state() else {
            return;
        };
        if state == MapState::Tied && self.first_tied.is_none() {
            self.first_tied = Some(tick);
        }
        self.state = state;
        self.health = listening.map_health();
    }
}

/// Figures of the map.
#[derive(Clone, Debug, Serialize)]
pub(super) struct MapFigures {
    file: String,
    /// `full`, `coarse` or `phases`.
    form: &'static str,
    edges_per_revolution: u32,
    /// At the end: `phases only`, `unfound`, `tied`, `rejected` or `off phase`.
    state: &'static str,
    /// First tick whose estimates used the whole map; null if there is none.
    tied_at_tick: Option<usize>,
    /// Count slips that the index showed.
    slips: u32,
    #[serde(skip)]
    has_index: bool,
}

impl MapFigures {
    /// Of a map with the tie it came to; `has_index` where a channel was chosen for the index.
    pub(super) fn new(file: &MapFile, tie: TieLog, has_index: bool) -> Result<Self, MapFileError> {
        let map = file.map()?;
        let form = match map.form() {
            Form::Full => "full",
            Form::Coarse => "coarse",
            Form::Phases => "phases",
        };
        let state = match tie.state {
            _ if map.form() == Form::Phases => "phases only",
            MapState::Unfound => "unfound",
            MapState::Tied => "tied",
            MapState::Rejected => "rejected",
            MapState::OffPhase => "off phase",
        };
        Ok(Self {
            file: file.path().display().to_string(),
            form,
            edges_per_revolution: map.edges(),
            state,
            tied_at_tick: tie.first_tied,
            slips: tie.health.slips,
            has_index,
        })
    }

    /// What keeps the map from being of use, with what to do.
    fn warning(&self) -> Option<&'static str> {
        match self.state {
            "unfound" if !self.has_index => Some(
                "without the index only the map's phases are used: capture Z and choose it with --z",
            ),
            "unfound" => Some(
                "the index was never found, so only the map's phases were used: check --z and capture a whole \
                 revolution or more",
            ),
            "rejected" => Some(
                "the index disagrees with the count: it is another encoder's map, or counts were lost; only the \
                 map's phases were used since then",
            ),
            "off phase" => Some(
                "an index came half a line off its place, so nothing of the map was used since then: A and B may \
                 be swapped or inverted, or counts were lost",
            ),
            _ => None,
        }
    }
}

impl fmt::Display for MapFigures {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            file,
            form,
            edges_per_revolution,
            slips,
            ..
        } = self;
        write!(
            f,
            "map {file}: {form}, {edges_per_revolution} edges a revolution, "
        )?;
        match self.tied_at_tick {
            Some(tick) => writeln!(f, "tied to the index at tick {tick}, {slips} slips")?,
            None if self.form == "phases" => writeln!(f, "needs no index")?,
            None => writeln!(f, "never tied to the index")?,
        }
        match self.warning() {
            Some(warning) => writeln!(f, "warning: {warning}"),
            None => Ok(()),
        }
    }
}
