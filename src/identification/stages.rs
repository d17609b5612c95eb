//! What each stage of identification concludes, and what comes after it.

use core::fmt;

use super::conclusion;
use super::drive::{converted, place};
use super::evidence::{Broke, broke_away, pulses};
use super::matrix::part;
use super::plan::Main;
use super::procedure::{Identification, Next};
use super::refusal::Refusal;
use super::seed;

/// Travel in a rest that shows that nothing holds the axis, d.
const DRIFTS_D: f64 = 4.0;

/// Which experiments run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Pulses that prove the sign.
    Proof,
    /// Ramps to what breaks the axis away.
    Ramps,
    /// Steps for a first model.
    Probe,
    /// Steps, reversals and chirps for the model; the number of the program.
    Main(usize),
}

impl fmt::Display for Stage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Proof => f.write_str("proof of the sign"),
            Self::Ramps => f.write_str("break-away ramps"),
            Self::Probe => f.write_str("probing steps"),
            Self::Main(number) => write!(f, "main experiments, part {}", number.wrapping_add(1)),
        }
    }
}

impl Identification<'_> {
    /// The next pulses of the proof.
    pub(super) fn prove(&mut self) -> Result<Next, Refusal> {
        let last = self.stage.map(|_| self.level);
        let Some(level) = self.plan.next_level(last) else {
            let [moved_d, _] = pulses(self.recorder.records());
            return Err(Refusal::NoMotion {
                level: self.level,
                moved_d,
            });
        };
        self.level = level;
        let program = self.plan.proof(level);
        Ok(self.run(Stage::Proof, program, Some(self.plan.first_decimation())))
    }

    /// Judges a pair of pulses.
    pub(super) fn proved(&mut self) -> Result<Next, Refusal> {
        let [difference, drift] = pulses(self.recorder.records());
        let threshold = self.plan.proof_threshold();
        if difference <= -threshold {
            return Err(Refusal::WrongPolarity {
                level: self.level,
                moved_d: -difference,
            });
        }
        if difference < threshold {
            return self.prove();
        }
        self.drifts = libm::fabs(drift) >= DRIFTS_D;
        let program = self.plan.ramps((3.0 * self.level).min(0.5));
        Ok(self.run(Stage::Ramps, program, Some(self.plan.first_decimation())))
    }

    /// Takes from the ramps what broke the axis away.
    pub(super) fn ramped(&mut self, offset: f64) -> Result<Next, Refusal> {
        if !self.drifts {
            let slope = (3.0 * self.level).min(0.5) / f64::from(self.plan.ramp_ticks());
            let decimation = self.recorder.decimation();
            let records = self.recorder.records();
            self.broke = [1.0, -1.0].map(|sign| {
                let ticks = broke_away(records, sign)?.wrapping_mul(decimation);
                Some(Broke { slope, ticks })
            });
        }
        let moving = self.break_command().map_or(self.level, |[a, b]| a.max(b));
        let (program, levels) = self.plan.probe(moving, offset);
        self.probe_levels = levels;
        Ok(self.run(Stage::Probe, program, Some(self.plan.first_decimation())))
    }

    /// Commands at which the ramps moved the axis, forward and backward.
    fn break_command(&self) -> Option<[f64; 2]> {
        let [forward, backward] = self.broke;
        let command = |broke: Broke| broke.slope * f64::from(broke.ticks);
        Some([command(forward?), command(backward?)])
    }

    /// A first model, and what the window allows by it.
    pub(super) fn probed(&mut self, offset: f64) -> Result<Next, Refusal> {
        let not_determined = Refusal::NotDetermined {
            stage: Stage::Probe,
        };
        let decimation = self.recorder.decimation();
        let record_s = f64::from(decimation) / self.plan.tick_hz;
        let fit = seed::fit(
            self.recorder.records(),
            self.probe_levels,
            self.break_command(),
            record_s,
        )
        .ok_or(not_determined)?;
        let probe = converted(&fit.vector, decimation, 1);
        let gain = part(&probe, place::GAIN);
        let loss = part(&probe, place::FRICTION) + libm::fabs(part(&probe, place::DRIFT));
        let moving = self
            .break_command()
            .map_or(0.0, |[a, b]| gain * a.max(b))
            .max(loss);
        let main = self.plan.main(&probe, moving, self.recorder.capacity())?;
        self.probe = Some(probe);
        self.main = Some(main);
        let program = self.plan.main_program(&main, 0, offset);
        Ok(self.run(Stage::Main(0), program, Some(main.decimation)))
    }

    /// The next of the main experiments, or the conclusion.
    pub(super) fn measured(&mut self, number: usize, offset: f64) -> Result<Next, Refusal> {
        let not_determined = Refusal::NotDetermined {
            stage: Stage::Main(number),
        };
        let (Some(main), Some(probe)) = (self.main, self.probe) else {
            return Err(not_determined);
        };
        let next = number.wrapping_add(1);
        if next < Main::PROGRAMS {
            let program = self.plan.main_program(&main, next, offset);
            return Ok(self.run(Stage::Main(next), program, None));
        }
        let evidence = conclusion::Evidence {
            records: self.recorder.records(),
            decimation: main.decimation,
            probe,
            broke: self.broke,
            break_command: self.break_command(),
        };
        let (fit, held) = evidence.solve().ok_or(not_determined)?;
        self.fit = Some((fit, held));
        let limit_d = 0.03 * self.plan.half_window_d;
        if fit.rms_d > limit_d {
            return Err(Refusal::DoesNotFit {
                rms_d: fit.rms_d,
                limit_d,
            });
        }
        Ok(Next::Done(
            evidence.identified(&fit, held, self.scale, self.level),
        ))
    }
}
