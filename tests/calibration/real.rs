//! The encoder "real" on a shaft that trembles and drifts.

use leadscrew::calibration::{Direction, Learned, Learner, Requirements, RunPlan, Work};

use crate::generator::{Dice, Motion, Shaft, TIMER_HZ, boundaries, learn, ticks};

/// Map less truth in one direction, d, from boundary 0 on, the constant taken out.
fn off(learned: &Learned<'_>, shaft: &Shaft, direction: Direction) -> Vec<f64> {
    let phases = learned.phases_d(direction);
    let backward = direction == Direction::Backward;
    let mut off: Vec<f64> = (0..shaft.errors.len())
        .map(|edge| {
            let hysteresis = if backward {
                shaft.hysteresis[edge % 2]
            } else {
                0.0
            };
            learned.error_d(edge) + phases[edge % 4] - (shaft.errors[edge] - hysteresis)
        })
        .collect();
    let mean = off.iter().sum::<f64>() / off.len() as f64;
    for off in &mut off {
        *off -= mean;
    }
    off
}

fn rms(values: &[f64]) -> f64 {
    (values.iter().map(|value| value * value).sum::<f64>() / values.len() as f64).sqrt()
}

/// Amplitude of a harmonic of the revolution.
fn amplitude(values: &[f64], order: usize) -> f64 {
    let (mut cosine, mut sine) = (0.0, 0.0);
    for (edge, value) in values.iter().enumerate() {
        let phase = std::f64::consts::TAU * (order * edge) as f64 / values.len() as f64;
        cosine += value * phase.cos();
        sine += value * phase.sin();
    }
    2.0 * f64::hypot(cosine, sine) / values.len() as f64
}

#[test]
fn study() {
    for (acceleration, damping) in [(-0.006, 0.0), (-0.003, 2e-5), (0.0, 4e-5)] {
        for (revolutions, speeds) in [(40, [150.0, 110.0]), (20, [150.0, 75.0])] {
            let seed = 1;
            let shaft = Shaft::real(seed);
            let (mut sums, mut mean) = (vec![0; 10_000], vec![0; 10_000]);
            let work = Work {
                sums: &mut sums,
                mean: &mut mean,
            };
            let mut learner = Learner::new(10_000, TIMER_HZ, work).unwrap();
            let mut dice = Dice::new(seed);
            for speed in speeds {
                for velocity in [speed, -speed] {
                    let motion = Motion {
                        velocity,
                        acceleration: acceleration * f64::signum(velocity),
                        damping,
                        ..Motion::steady(velocity)
                    };
                    let summary = learn(
                        &mut learner,
                        RunPlan::coast(revolutions),
                        ticks(
                            &shaft,
                            motion,
                            boundaries(&shaft, revolutions as usize),
                            seed * 100 + dice.uniform().to_bits() % 100,
                        ),
                    );
                    if let Err(e) = &summary {
                        println!("{e} {e:?}");
                    }
                    if let Ok(s) = &summary {
                        println!("{:?} {:?}", s.speed_d_s, s.less_earlier_runs);
                    }
                }
            }
            let Ok(learned) = learner.finish(&Requirements {
                max_disagreement_d: 10.0,
                two_speeds: false,
                both_directions: false,
                ..Default::default()
            }) else {
                continue;
            };
            let o = off(&learned, &shaft, Direction::Forward);
            println!(
                "{acceleration} {damping} {revolutions} {speeds:?} seed {seed}: rms {:.5} harmonics {:?}",
                rms(&o),
                (1..=10)
                    .map(|h| format!("{:.4}", amplitude(&o, h)))
                    .collect::<Vec<_>>()
            );
            println!(
                "   {:?} {:?} {:?} {:?}",
                learned.report().residual,
                learned.report().disagreement,
                learned.report().noise,
                learned.report().hysteresis_a_less_b_d
            );
        }
    }
}
