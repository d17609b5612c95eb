//! Fixed point against the same recursion in `f64`.

use leadscrew::estimator::observer::{Config, Gains, Model, ObserverParams};
use leadscrew::units::{AxisScale, Command};
use proptest::prelude::*;

use crate::evidence::{Hand, Heard};
use crate::seeded::seeded;

const DELAY: usize = 2;
/// Largest errors of position, velocity and acceleration: half an LSB of the output, 7.6e-6, 4.8e-7 and 3e-8, and what
/// the innovation's and the jerk's rounding adds.
const BOUNDS: [f64; 3] = [1e-5, 4e-6, 3e-6];

/// The observer with the drive's model, from its description.
struct Oracle {
    config: Config,
    gains: Gains,
    /// x relative to the count, v, a, δ.
    state: [f64; 4],
    commands: Vec<f64>,
    silence: u32,
    unseen: u32,
    anchored: bool,
}

const REST_TICKS: u32 = 10_000;

impl Oracle {
    fn update(&mut self, heard: &Heard, command: f64) {
        self.commands.push(command);
        let told = self.commands[self.commands.len() - 1 - DELAY];
        let [stiffness, drag] = self.config.jerk_coefficients();
        let [x, v, a, d] = self.state;
        let jerk = stiffness * (160.0 * (told - 0.005) - v) - drag * a + d;
        let resting = self.silence >= REST_TICKS && heard.delta == 0;
        if resting && jerk.abs() <= stiffness * 0.25 {
            self.state = [x, 0.0, 0.0, d - jerk / 32.0];
        } else {
            if resting {
                self.silence = 0;
            }
            self.state = [
                x + v + a / 2.0 + jerk / 6.0 - f64::from(heard.delta),
                v + a + jerk / 2.0,
                a + jerk,
                d,
            ];
        }
        match &heard.sample {
            Some(sample) => {
                let octave = sample.edges.ilog2() as i32 - bits(self.unseen);
                self.anchored &= self.unseen < 128;
                (self.silence, self.unseen) = (0, 0);
                let age = sample.age.to_num::<f64>();
                let edges = f64::from(1_u32 << octave.max(0)) * 2.0_f64.sqrt();
                let spread = if octave > 0 {
                    (1.0 - 1.0 / (edges * edges)) / 12.0
                } else {
                    0.0
                };
                let [x, v, a, _] = self.state;
                let place = sample.position.to_num::<f64>() - heard.count as f64;
                let innovation = place - (x - v * age + a * (age * age + spread) / 2.0);
                if self.anchored {
                    self.correct(innovation, octave);
                } else {
                    self.anchored = true;
                    self.state[0] += innovation;
                }
            }
            None => {
                self.silence = if heard.delta == 0 {
                    self.silence.saturating_add(1)
                } else {
                    0
                };
                let x = self.state[0];
                let outside = (-0.25 - x).max(0.0) + (1.25 - x).min(0.0);
                self.unseen += 1;
                self.correct(outside, -2);
            }
        }
    }

    fn correct(&mut self, innovation: f64, octave: i32) {
        let gains = self.gains.of(Model::Drive, octave);
        for (part, gain) in self.state.iter_mut().zip(gains) {
            *part += gain * innovation;
        }
    }
}

/// Binary digits of a number.
fn bits(number: u32) -> i32 {
    (u32::BITS - number.leading_zeros()) as i32
}

/// A drive with a disturbance of its own, driven by random commands.
fn worst_error(steps: &[(f64, u32)], disturbance: f64) -> [f64; 3] {
    let scale = AxisScale::new(1000.0, 1000.0).unwrap();
    let params = ObserverParams {
        // Never at rest again, and never given up: the recursion alone.
        rest_s: 10.0,
        fallback_s: 1.0,
        ..ObserverParams::default()
    };
    let config = Config::new(&params, scale).unwrap();
    let mut hand = Hand::new(config);
    let mut oracle = Oracle {
        config,
        gains: Gains::solve(&config),
        state: [0.5, 0.0, 0.0, 0.0],
        commands: Vec::new(),
        silence: u32::MAX,
        unseen: 0,
        anchored: false,
    };
    let omega = core::f64::consts::TAU / 90.0;
    let (mut position, mut velocity, mut acceleration) = (0.5, 0.0, 0.0);
    let mut worst = [0.0_f64; 3];
    // At rest until the line is full.
    for _ in 0..DELAY {
        hand.move_to(0.5, Some(Command::from_num(0.005)));
        oracle.commands.push(Command::from_num(0.005).to_num());
        oracle.unseen += 1;
    }
    let mut begun = false;
    let mut run = |command: f64, worst: &mut [f64; 3]| {
        let command = Command::from_num(command);
        let told = command.to_num::<f64>();
        let jerk = omega * omega * (160.0 * told + disturbance - velocity) - omega * acceleration;
        position += velocity + acceleration / 2.0 + jerk / 6.0;
        velocity += acceleration + jerk / 2.0;
        acceleration += jerk;
        let heard = hand.move_to(position, Some(command));
        if !begun {
            // Rest is what the disturbance makes of the command.
            begun = true;
            let [stiffness, _] = config.jerk_coefficients();
            let at_first = oracle.commands[oracle.commands.len() - DELAY];
            oracle.state[3] = -stiffness * 160.0 * (at_first - 0.005);
        }
        oracle.update(&heard, told);
        let [x, v, a, _] = oracle.state;
        let estimate = &heard.estimate;
        let errors = [
            estimate.position.to_num::<f64>() - heard.count as f64 - x,
            estimate.velocity.to_num::<f64>() - v,
            estimate.acceleration.to_num::<f64>() - a,
        ];
        assert_eq!(hand.listener.observer.model(), Model::Drive);
        assert_eq!(hand.listener.observer.restarts(), 0);
        for (worst, error) in worst.iter_mut().zip(errors) {
            *worst = worst.max(error.abs());
        }
    };
    for (command, ticks) in steps {
        for _ in 0..*ticks {
            run(*command, &mut worst);
        }
    }
    worst
}

proptest! {
    #![proptest_config(seeded(48))]

    #[test]
    fn fixed_point_is_the_recursion(
        steps in prop::collection::vec((-0.9..0.9_f64, 1..120_u32), 1..12),
        disturbance in -3.0..3.0_f64,
    ) {
        let worst = worst_error(&steps, disturbance);
        for (worst, bound) in worst.iter().zip(BOUNDS) {
            prop_assert!(*worst <= bound, "{worst:?}");
        }
    }
}
