//! What a logic analyser would see of the simulated encoder on feeds of the axis.

use leadscrew::hal::Capture;
use leadscrew::units::RangeError;
use leadscrew_hal_mock::encoder::EncoderModel;
use leadscrew_hal_mock::scene::{Motion, Scene};

use crate::recording::{Change, Levels, Recording};

/// Resolution of the recording, Hz.
pub const CLOCK_HZ: u64 = 1_000_000_000;
/// Rate at which velocities are told and the simulation goes on, Hz.
pub const TICK_HZ: f64 = 1000.0;
/// Rest before, between and after the runs, s.
const REST_S: f64 = 0.1;
/// Where the shaft stands at first, a part of a revolution before the index.
const START: f64 = 0.65;
/// Its multiples are spread evenly over a revolution.
const GOLDEN_SECTION: f64 = 0.618_034;
/// Levels of A and B by the two low bits of the count.
const LEVELS: [(bool, bool); 4] = [(false, false), (true, false), (true, true), (false, true)];

/// Runs of the simulated axis.
#[derive(Clone, Debug)]
pub struct Runs {
    /// The encoder.
    pub model: EncoderModel,
    /// What draws its errors and all noise.
    pub seed: u64,
    /// Velocity of each run, d/tick at [`TICK_HZ`]; negative backward.
    pub velocities: Vec<f64>,
    /// Least length of each run, revolutions.
    pub revolutions: f64,
    /// The feed wobbles and drifts as that of a real axis does; otherwise it is steady.
    pub sways: bool,
}

impl Runs {
    /// Records the runs one after the other, with rest between them; speeds change at once.
    ///
    /// # Errors
    /// A parameter out of range.
    pub fn record(&self) -> Result<Recording, RangeError> {
        let edges = self.model.disc.edges_per_revolution;
        let run = |(number, &velocity): (u32, &f64)| {
            let motion = if self.sways {
                Motion::calibration(velocity, edges)
            } else {
                Motion::Steady { velocity }
            };
            // Noise is drawn an edge at a time from the start on: no two runs shall start at one place.
            let revolutions = self.revolutions + (GOLDEN_SECTION * f64::from(number)).fract();
            (motion, (revolutions * edges / velocity.abs()) as u64)
        };
        let motions: Vec<_> = (1..).zip(&self.velocities).map(run).collect();
        record(&self.model, self.seed, &motions)
    }
}

/// Records motions, each for so many ticks, one after the other from where the last one ended, with rest between
/// them; speeds change at once.
///
/// # Errors
/// A parameter out of range.
pub fn record(
    model: &EncoderModel,
    seed: u64,
    motions: &[(Motion, u64)],
) -> Result<Recording, RangeError> {
    let mut position = START * model.disc.edges_per_revolution;
    let mut tape = Tape::new(model);
    tape.rest();
    for &(motion, ticks) in motions {
        let mut scene = Scene::new(motion, model, TICK_HZ, position, seed)?;
        tape.join(&scene.capture());
        for _ in 0..ticks {
            scene.step();
            tape.take(&scene.capture());
        }
        tape.rest();
        position = scene.truth().position;
    }
    Ok(tape.finish())
}

/// A recording under way.
struct Tape {
    revolution: i64,
    index_width: i64,
    timer_hz: f64,
    count: Option<i64>,
    forward: bool,
    /// Start of the scene under way and its end so far, ns.
    scene_start: u64,
    end: u64,
    /// The scene's timer at its last sample, without wrap.
    clocks: u64,
    initial: Levels,
    changes: Vec<Change>,
}

impl Tape {
    fn new(model: &EncoderModel) -> Self {
        Self {
            revolution: model.disc.edges_per_revolution as i64,
            index_width: model.encoder.index_width_d as i64,
            timer_hz: model.encoder.timer_hz,
            count: None,
            forward: true,
            scene_start: 0,
            end: 0,
            clocks: 0,
            initial: Levels::default(),
            changes: Vec::new(),
        }
    }

    /// Time passes.
    fn rest(&mut self) {
        self.end += (REST_S * CLOCK_HZ as f64) as u64;
    }

    /// Begins a scene. Its noise is another: the count may differ by an edge that lies just here.
    fn join(&mut self, capture: &Capture<'_>) {
        let count = i64::from(capture.count.cast_signed());
        match self.count {
            None => {
                self.count = Some(count);
                self.initial = self.levels(count);
            }
            Some(before) => {
                self.forward = count > before;
                for _ in 0..count.abs_diff(before) {
                    self.put_edge(self.end);
                }
            }
        }
        self.scene_start = self.end;
        self.clocks = 0;
    }

    /// Takes what a tick saw. Where the shaft turned round in it, it went on as before at first.
    fn take(&mut self, capture: &Capture<'_>) {
        let count = i64::from(capture.count.cast_signed());
        let moved = count - self.count.unwrap_or(count);
        let [older, newer] = capture.edges;
        let edges = (older.len() + newer.len()) as i64;
        let onward = if self.forward { moved } else { -moved };
        let mut before_turn = (edges + onward) / 2;
        for &time in older.iter().chain(newer) {
            if before_turn == 0 {
                self.forward = !self.forward;
            }
            before_turn -= 1;
            self.put_edge(self.at(time));
        }
        self.clocks += u64::from(capture.sampled_at.wrapping_sub(self.clocks as u32));
        self.end = self.at(capture.sampled_at);
    }

    /// A reading of the scene's timer near its last sample, ns. Noise may stamp an edge a little before it.
    fn at(&self, time: u32) -> u64 {
        let since = time.wrapping_sub(self.clocks as u32).cast_signed();
        let clocks = self.clocks.saturating_add_signed(i64::from(since));
        self.scene_start + (clocks as f64 / self.timer_hz * CLOCK_HZ as f64).round() as u64
    }

    /// An edge in the present direction, each a nanosecond after the last at least.
    fn put_edge(&mut self, time: u64) {
        let count = self.count.unwrap_or_default() + if self.forward { 1 } else { -1 };
        self.count = Some(count);
        let earliest = self.changes.last().map_or(1, |last| last.time + 1);
        let levels = self.levels(count);
        self.changes.push(Change {
            time: time.max(earliest),
            levels,
        });
    }

    const fn levels(&self, count: i64) -> Levels {
        let (a, b) = LEVELS[count.rem_euclid(4) as usize];
        let z = count.rem_euclid(self.revolution) < self.index_width;
        Levels { a, b, z }
    }

    fn finish(self) -> Recording {
        let last = self.changes.last().map_or(0, |last| last.time);
        Recording {
            clock_hz: CLOCK_HZ,
            duration: self.end.max(last + 1),
            initial: self.initial,
            changes: self.changes,
        }
    }
}
