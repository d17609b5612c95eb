//! The report of a scenario, for people and programs.

use std::fmt::Write as _;
use std::path::Path;

use leadscrew::supervisor::Context;
use serde::Serialize;

use crate::fault_names::{fault_name, state_name};
use crate::report::figure_or_dash;
use crate::scenario_file::ScenarioFile;
use crate::scenario_run::{Event, Figures, Record, Stop, Verdict, What, short};

/// The report of a run.
#[derive(Serialize)]
pub(super) struct Report {
    schema: &'static str,
    scenario: String,
    description: String,
    tick_hz: f64,
    seed: u64,
    estimator: &'static str,
    ticks: usize,
    digest: String,
    events: Vec<EventFigures>,
    following_error: FollowingError,
    /// Largest following error from 0.1 s after each motion, d; null if there was no such time.
    standing_error_d: Option<f64>,
    final_position_mm: f64,
    /// Farthest places of the shaft from the start, low and high, mm.
    travel_mm: [f64; 2],
    /// Largest output, of full command.
    output_peak: f64,
    stops: Vec<StopFigures>,
    /// Why homing failed, how far the index is from the switch, what was wrong with the spindle.
    notes: Vec<String>,
    final_state: &'static str,
    expectations: Vec<Verdict>,
    passed: bool,
}

#[derive(Serialize)]
struct EventFigures {
    tick: usize,
    time_s: f64,
    /// `action`, `state`, `warning`, `fault` or `cleared`.
    event: &'static str,
    /// The action as the file writes it, or the name of the state or the fault.
    name: String,
    /// Of a fault.
    #[serde(skip_serializing_if = "Option::is_none")]
    number: Option<u8>,
    /// Why an action was refused.
    #[serde(skip_serializing_if = "Option::is_none")]
    refused: Option<String>,
}

/// While under control and without a fault, d; null if it never was.
#[derive(Serialize)]
struct FollowingError {
    peak_d: Option<f64>,
    peak_at_s: f64,
    rms_d: Option<f64>,
}

/// A fault and what it led to; null where it did not come to that.
#[derive(Serialize)]
struct StopFigures {
    fault: &'static str,
    number: u8,
    time_s: f64,
    /// State before it; null if no context was noted, as all that follows.
    state: Option<&'static str>,
    /// What was seen, and what is allowed, in the unit of the table of faults.
    value: Option<f64>,
    limit: Option<f64>,
    position_d: Option<f64>,
    velocity_d_per_tick: Option<f64>,
    setpoint_d: Option<f64>,
    setpoint_velocity_d_per_tick: Option<f64>,
    following_error_d: Option<f64>,
    command: Option<f64>,
    /// Since the last trouble that began.
    detected_after_s: Option<f64>,
    detected_after_mm: Option<f64>,
    zero_output_after_ticks: Option<usize>,
    stopped_after_s: Option<f64>,
    stopped_after_mm: Option<f64>,
}

impl StopFigures {
    fn new(stop: &Stop, tick_hz: f64) -> Self {
        let first = stop.first.as_ref();
        let context = |value: fn(&Context) -> f64| first.map(|first| value(&first.context));
        Self {
            fault: fault_name(stop.fault),
            number: stop.fault as u8,
            time_s: stop.tick as f64 / tick_hz,
            state: first.map(|first| state_name(first.state)),
            value: first.map(|first| first.trip.value.to_num()),
            limit: first.map(|first| first.trip.limit.to_num()),
            position_d: context(|context| context.position.to_num()),
            velocity_d_per_tick: context(|context| context.velocity.to_num()),
            setpoint_d: context(|context| context.setpoint_position.to_num()),
            setpoint_velocity_d_per_tick: context(|context| context.setpoint_velocity.to_num()),
            following_error_d: context(|context| context.following_error.to_num()),
            command: context(|context| context.command.to_num()),
            detected_after_s: stop.detected.map(|detected| detected.0),
            detected_after_mm: stop.detected.map(|detected| detected.1),
            zero_output_after_ticks: stop.zero_output_ticks,
            stopped_after_s: stop.stopped.map(|stopped| stopped.0),
            stopped_after_mm: stop.stopped.map(|stopped| stopped.1),
        }
    }

    fn text(&self) -> String {
        let or_not = |figure: Option<String>| figure.unwrap_or_else(|| "never".to_owned());
        let pair = |time: Option<f64>, way: Option<f64>| {
            time.zip(way)
                .map(|(time, way)| format!("{time:.3} s, {way:.3} mm"))
        };
        let detected = pair(self.detected_after_s, self.detected_after_mm)
            .map(|text| format!("found after {text}; "))
            .unwrap_or_default();
        let seen = self
            .value
            .zip(self.limit)
            .map_or_else(String::new, |(value, limit)| {
                format!(" ({} against {})", short(value), short(limit))
            });
        format!(
            "{}{seen}: {detected}zero output after {}; stopped after {}\n",
            self.fault,
            or_not(
                self.zero_output_after_ticks
                    .map(|ticks| format!("{ticks} ticks"))
            ),
            or_not(pair(self.stopped_after_s, self.stopped_after_mm)),
        )
    }
}

impl EventFigures {
    fn new(event: &Event, file: &ScenarioFile, tick_hz: f64) -> Self {
        let (kind, name, number, refused) = match &event.what {
            What::Action(index, refused) => ("action", file.name(*index), None, refused.clone()),
            What::State(state) => ("state", state_name(*state), None, None),
            What::Fault(fault) => ("fault", fault_name(*fault), Some(*fault as u8), None),
            What::Warning(fault) => ("warning", fault_name(*fault), Some(*fault as u8), None),
            What::Cleared => ("cleared", "fault", None, None),
        };
        Self {
            tick: event.tick,
            time_s: event.tick as f64 / tick_hz,
            event: kind,
            name: name.to_owned(),
            number,
            refused,
        }
    }

    fn text(&self) -> String {
        let refused = match &self.refused {
            Some(reason) => format!(" refused: {reason}"),
            None => String::new(),
        };
        let Self {
            time_s,
            event,
            name,
            ..
        } = self;
        format!("{time_s:9.4}  {event:<8} {name}{refused}\n")
    }
}

impl Report {
    pub(super) fn new(
        path: &Path,
        file: &ScenarioFile,
        record: &Record,
        events: &[Event],
        figures: &Figures,
        expectations: Vec<Verdict>,
    ) -> Self {
        let scenario = file.scenario();
        let tick_hz = record.tick_hz;
        Self {
            schema: "leadscrew/scenario/1",
            scenario: path.display().to_string(),
            description: file.description.clone(),
            tick_hz,
            seed: scenario.seed,
            estimator: scenario.estimator,
            ticks: record.ticks.len(),
            digest: format!("{:016x}", record.digest),
            events: events
                .iter()
                .map(|event| EventFigures::new(event, file, tick_hz))
                .collect(),
            following_error: FollowingError {
                peak_d: figures.following.peak_of_some(),
                peak_at_s: figures.peak_tick as f64 / tick_hz,
                rms_d: figures.following.rms_of_some(),
            },
            standing_error_d: figures.standing.peak_of_some(),
            final_position_mm: figures.final_position_mm,
            travel_mm: figures.travel_mm.into(),
            output_peak: figures.output_peak,
            stops: figures
                .stops
                .iter()
                .map(|stop| StopFigures::new(stop, tick_hz))
                .collect(),
            notes: record.notes.clone(),
            final_state: state_name(figures.final_state),
            passed: expectations.iter().all(|verdict| verdict.met),
            expectations,
        }
    }

    /// The report for people.
    pub(super) fn to_text(&self) -> String {
        let mut text = String::new();
        // Writing to a string cannot fail.
        let _ = self.write(&mut text);
        text
    }

    fn write(&self, text: &mut String) -> std::fmt::Result {
        let Self {
            scenario,
            description,
            ticks,
            tick_hz,
            digest,
            ..
        } = self;
        writeln!(text, "{scenario}: {description}")?;
        writeln!(
            text,
            "{ticks} ticks at {tick_hz} Hz, {} in the loop, seed {}, digest {digest}\n\n   time, s",
            self.estimator, self.seed
        )?;
        self.events
            .iter()
            .for_each(|event| text.push_str(&event.text()));
        let error = &self.following_error;
        writeln!(
            text,
            "\nfollowing error, d: peak {} at {:.4} s, rms {}, standing {}\n\
             setpoint at the end {:.4} mm; shaft between {:.4} and {:.4} mm; largest output {:.1} % of full",
            figure_or_dash(error.peak_d, 1),
            error.peak_at_s,
            figure_or_dash(error.rms_d, 2),
            figure_or_dash(self.standing_error_d, 2),
            self.final_position_mm,
            self.travel_mm[0],
            self.travel_mm[1],
            100.0 * self.output_peak,
        )?;
        self.stops
            .iter()
            .for_each(|stop| text.push_str(&stop.text()));
        self.notes
            .iter()
            .try_for_each(|note| writeln!(text, "{note}"))?;
        text.push('\n');
        for verdict in &self.expectations {
            let word = if verdict.met { "met    " } else { "NOT MET" };
            let Verdict {
                name,
                expected,
                found,
                ..
            } = verdict;
            writeln!(text, "{word} {name}: expected {expected}, found {found}")?;
        }
        Ok(())
    }
}
