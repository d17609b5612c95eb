//! The sweep as text, JSON and plot.

use serde::Serialize;

use super::judge::Judge;
use super::sweep::Candidate;
use crate::command::map_figures::MapFigures;
use crate::figures::estimator_series;
use crate::plot::{Colour, Figure, Panel, Series};
use crate::report::text_table;

/// Least bandwidth that a thyristor drive asks for, Hz (P2).
const THYRISTOR_HZ: f64 = 20.0;
/// Least bandwidth that a transistor drive asks for, Hz (P2).
const TRANSISTOR_HZ: f64 = 40.0;
/// The plot shows so many times the largest optimum.
const SHOWN: f64 = 3.0;

/// c_t and c_σ.
#[derive(Clone, Copy, Debug, Serialize)]
pub(super) struct Weights {
    pub(super) lag: f64,
    pub(super) sigma: f64,
}

/// The report of a sweep.
#[derive(Serialize)]
pub(super) struct Report {
    schema: &'static str,
    source: String,
    /// What the error is measured against: `truth` or `trend`.
    pub(super) reference: &'static str,
    tick_hz: f64,
    /// Ticks that all were judged on.
    pub(super) ticks: u64,
    /// The encoder map; null without one.
    pub(super) map: Option<MapFigures>,
    weights: Weights,
    units: Units,
    sweep: Vec<Entry>,
    /// Indices in `sweep`: the best of each estimator, in its order.
    optima: Vec<usize>,
    /// Index in `sweep`: the best of all.
    best: usize,
}

#[derive(Serialize)]
struct Units {
    lag: &'static str,
    sigma: &'static str,
    bandwidth: &'static str,
}

/// A candidate and what it is worth.
#[derive(Clone, Serialize)]
pub(super) struct Entry {
    estimator: &'static str,
    parameter: Option<&'static str>,
    value: Option<f64>,
    t_z_ticks: f64,
    sigma_a: f64,
    phi: f64,
    bandwidth_hz: f64,
    suits_thyristor: bool,
    suits_transistor: bool,
}

impl Entry {
    fn new(candidate: &Candidate, judge: &Judge, tick_hz: f64, weights: Weights) -> Self {
        let (lag, sigma) = (judge.lag(), judge.sigma());
        let bandwidth = tick_hz / (4.0 * lag);
        Self {
            estimator: candidate.config.name(),
            parameter: candidate.parameter.map(|(symbol, _)| symbol),
            value: candidate.parameter.map(|(_, value)| value),
            t_z_ticks: lag,
            sigma_a: sigma,
            phi: weights.lag * lag + weights.sigma * sigma,
            bandwidth_hz: bandwidth,
            suits_thyristor: bandwidth >= THYRISTOR_HZ,
            suits_transistor: bandwidth >= TRANSISTOR_HZ,
        }
    }

    fn label(&self) -> String {
        match (self.parameter, self.value) {
            (Some(symbol), Some(value)) => format!("{symbol} {value}"),
            _ => "-".to_owned(),
        }
    }

    const fn drive(&self) -> &'static str {
        match (self.suits_transistor, self.suits_thyristor) {
            (true, _) => "transistor",
            (false, true) => "thyristor",
            (false, false) => "neither",
        }
    }
}

impl Report {
    /// Of a sweep on `source` against the truth, without a map; what is different is to be set.
    pub(super) fn new(source: String, tick_hz: f64, weights: Weights, sweep: Vec<Entry>) -> Self {
        let optima = optima(&sweep);
        let lowest = |one: &&usize, other: &&usize| sweep[**one].phi.total_cmp(&sweep[**other].phi);
        let best = optima.iter().min_by(lowest).copied().unwrap_or(0);
        Self {
            schema: "leadscrew/tune-filter/1",
            source,
            reference: "truth",
            tick_hz,
            ticks: 0,
            map: None,
            weights,
            units: Units {
                lag: "tick",
                sigma: "d/tick²",
                bandwidth: "Hz",
            },
            sweep,
            optima,
            best,
        }
    }

    /// The report for people: the optima, then all of the sweep.
    pub(super) fn to_text(&self) -> String {
        let against = match self.reference {
            "truth" => "the truth at the instant of each estimate",
            _ => {
                "the trend, a quadratic through 101 ticks of counts, in steady motion (see --help)"
            }
        };
        let optima = self.optima.iter().map(|index| &self.sweep[*index]);
        format!(
            "{}, {} Hz, {} ticks\n{}\
             Φ = {}·t_z + {}·σ; t_z: computed lag of the acceleration, not read off transients as the paper's 8 ticks\n\
             σ: rms error of the acceleration against {against}\n\
             drive: transistor from {TRANSISTOR_HZ} Hz on, thyristor from {THYRISTOR_HZ} Hz on, f = 1/(4 t_z)\n\n\
             optimum of each estimator; ** of all\n{}\n\n\
             all that was tried\n{}\n",
            self.source,
            self.tick_hz,
            self.ticks,
            self.map
                .as_ref()
                .map(ToString::to_string)
                .unwrap_or_default(),
            self.weights.lag,
            self.weights.sigma,
            self.table(optima),
            self.table(self.sweep.iter()),
        )
    }

    fn table<'a>(&'a self, entries: impl Iterator<Item = &'a Entry>) -> String {
        let mut table = text_table(&[
            "estimator",
            "parameter",
            "t_z\nticks",
            "σ\nd/tick²",
            "Φ\n",
            "f\nHz",
            "drive",
            "",
        ]);
        for entry in entries {
            table.add_row([
                entry.estimator.to_owned(),
                entry.label(),
                format!("{:.2}", entry.t_z_ticks),
                format!("{:.5}", entry.sigma_a),
                format!("{:.4}", entry.phi),
                format!("{:.1}", entry.bandwidth_hz),
                entry.drive().to_owned(),
                self.mark(entry).to_owned(),
            ]);
        }
        table.trim_fmt()
    }

    fn mark(&self, entry: &Entry) -> &'static str {
        let is = |index: &usize| std::ptr::eq(&raw const self.sweep[*index], entry);
        match (is(&self.best), self.optima.iter().any(is)) {
            (true, _) => "**",
            (false, true) => "*",
            (false, false) => "",
        }
    }

    /// σ and Φ over the lag, with the optima.
    pub(super) fn figure(&self) -> Figure {
        let optima = || self.optima.iter().map(|index| &self.sweep[*index]);
        let panel = |label: &str, value: fn(&Entry) -> f64| {
            let points = |entries: &mut dyn Iterator<Item = &Entry>| -> Vec<_> {
                entries
                    .map(|entry| (entry.t_z_ticks, value(entry)))
                    .collect()
            };
            let curve = |name: &&'static str| {
                let mut own = self.sweep.iter().filter(|entry| entry.estimator == *name);
                let series = estimator_series(name, points(&mut own));
                // A single point makes no line.
                if series.points.len() > 1 {
                    series
                } else {
                    series.with_width(8.0)
                }
            };
            let names: Vec<_> = optima().map(|entry| entry.estimator).collect();
            let mut series: Vec<_> = names.iter().map(curve).collect();
            let best = points(&mut optima());
            series.push(Series::dots("optimum", best, Colour::Black).with_width(7.0));
            let largest = optima()
                .filter(|entry| entry.parameter.is_some())
                .map(value)
                .fold(0.0, f64::max);
            let panel = Panel::new("lag of the acceleration t_z, ticks", label, series);
            if largest > 0.0 {
                panel.with_y_limits(0.0, SHOWN * largest)
            } else {
                panel
            }
        };
        Figure::new(
            format!("{}, {} Hz", self.source, self.tick_hz),
            vec![
                panel("σ of the acceleration, d/tick²", |entry| entry.sigma_a),
                panel("Φ", |entry| entry.phi),
            ],
        )
    }
}

/// What each candidate is worth.
pub(super) fn entries(
    candidates: &[Candidate],
    judges: &[Judge],
    tick_hz: f64,
    weights: Weights,
) -> Vec<Entry> {
    let entry =
        |(candidate, judge): (&Candidate, &Judge)| Entry::new(candidate, judge, tick_hz, weights);
    candidates.iter().zip(judges).map(entry).collect()
}

/// The entry of least Φ of each estimator, in their order.
fn optima(sweep: &[Entry]) -> Vec<usize> {
    let mut optima: Vec<usize> = Vec::new();
    for (index, entry) in sweep.iter().enumerate() {
        match optima.last_mut() {
            Some(last) if sweep[*last].estimator == entry.estimator => {
                if entry.phi < sweep[*last].phi {
                    *last = index;
                }
            }
            _ => optima.push(index),
        }
    }
    optima
}
