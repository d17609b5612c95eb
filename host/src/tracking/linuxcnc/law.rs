//! The law of LinuxCNC's `pid`, written from its manual page pid(9), in floating point.
//!
//! Positions in d, times in s; the output is a velocity in d/s, as the manual wants it for a position loop.
//! What the manual leaves open is decided for the peer: nothing kicks in the first tick.

/// Everything that is set on the law. A limit or deadband of zero is none.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PidParams {
    /// Pgain, 1/s.
    pub p: f64,
    /// Igain, 1/s².
    pub i: f64,
    /// Dgain.
    pub d: f64,
    /// FF0, 1/s.
    pub ff0: f64,
    /// FF1.
    pub ff1: f64,
    /// FF2, s.
    pub ff2: f64,
    /// FF3, s².
    pub ff3: f64,
    /// bias, d/s.
    pub bias: f64,
    /// deadband, d.
    pub deadband: f64,
    /// maxerror, d.
    pub max_error: f64,
    /// maxerrorI, d·s.
    pub max_error_i: f64,
    /// maxerrorD, d/s.
    pub max_error_d: f64,
    /// maxcmdD, d/s.
    pub max_command_d: f64,
    /// maxcmdDD, d/s².
    pub max_command_dd: f64,
    /// maxcmdDDD, d/s³.
    pub max_command_ddd: f64,
    /// maxoutput, d/s.
    pub max_output: f64,
}

/// What the law takes in.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PidInputs {
    /// command, d.
    pub command: f64,
    /// feedback, d.
    pub feedback: f64,
    /// feedback-deriv, d/s: the encoder driver's estimate.
    pub feedback_deriv: f64,
}

/// The law with error-previous-target on and feedback-deriv connected, command-deriv not.
#[derive(Clone, Debug)]
pub struct Pid {
    params: PidParams,
    period_s: f64,
    /// command, commandD and commandDD of the tick before; none in the first.
    before: Option<[f64; 3]>,
    error_i: f64,
    saturated: bool,
}

impl Pid {
    /// The law at rest, called every `period_s`.
    #[must_use]
    pub const fn new(params: PidParams, period_s: f64) -> Self {
        Self {
            params,
            period_s,
            before: None,
            error_i: 0.0,
            saturated: false,
        }
    }

    /// The output of a tick, d/s.
    pub fn step(&mut self, inputs: &PidInputs) -> f64 {
        let params = self.params;
        let command = inputs.command;
        let [target, velocity, acceleration] = self.before.unwrap_or([command, 0.0, 0.0]);

        let error = beyond(target - inputs.feedback, params.deadband);
        let error = limited(error, params.max_error);
        if !self.saturated {
            self.error_i = limited(self.error_i + error * self.period_s, params.max_error_i);
        }
        let rate = |now: f64, before: f64| (now - before) / self.period_s;
        let command_d = limited(rate(command, target), params.max_command_d);
        let command_dd = limited(rate(command_d, velocity), params.max_command_dd);
        let command_ddd = limited(rate(command_dd, acceleration), params.max_command_ddd);
        let error_d = limited(command_d - inputs.feedback_deriv, params.max_error_d);
        self.before = Some([command, command_d, command_dd]);

        let output = params.bias
            + params.p * error
            + params.i * self.error_i
            + params.d * error_d
            + params.ff0 * command
            + params.ff1 * command_d
            + params.ff2 * command_dd
            + params.ff3 * command_ddd;
        let within = limited(output, params.max_output);
        self.saturated = within != output;
        within
    }
}

/// `value` within ±`limit`; zero is no limit.
fn limited(value: f64, limit: f64) -> f64 {
    if limit > 0.0 {
        value.clamp(-limit, limit)
    } else {
        value
    }
}

/// What of `error` is beyond ±`deadband`: there is no step at its edge.
fn beyond(error: f64, deadband: f64) -> f64 {
    error - error.clamp(-deadband, deadband)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fed(params: PidParams, inputs: &[(f64, f64, f64)]) -> Vec<f64> {
        let mut pid = Pid::new(params, 0.001);
        let step = |&(command, feedback, feedback_deriv): &(f64, f64, f64)| {
            pid.step(&PidInputs {
                command,
                feedback,
                feedback_deriv,
            })
        };
        inputs.iter().map(step).collect()
    }

    fn assert_close(outputs: &[f64], expected: &[f64]) {
        assert_eq!(outputs.len(), expected.len());
        for (output, expected) in outputs.iter().zip(expected) {
            assert!((output - expected).abs() < 1e-9, "{outputs:?}");
        }
    }

    #[test]
    fn the_error_is_that_against_the_command_of_the_tick_before() {
        let params = PidParams {
            p: 2.0,
            ..PidParams::default()
        };
        let outputs = fed(
            params,
            &[(10.0, 9.0, 0.0), (20.0, 9.0, 0.0), (20.0, 9.0, 0.0)],
        );
        assert_close(&outputs, &[2.0, 2.0, 22.0]);
    }

    #[test]
    fn the_deadband_is_taken_off_and_the_error_limited_after_it() {
        let params = PidParams {
            p: 1.0,
            deadband: 0.6,
            max_error: 2.0,
            ..PidParams::default()
        };
        let outputs = [0.5, -0.5, 1.6, -1.6, 9.0].map(|error| fed(params, &[(error, 0.0, 0.0)])[0]);
        assert_close(&outputs, &[0.0, 0.0, 1.0, -1.0, 2.0]);
    }

    #[test]
    fn the_manual_s_example_of_an_integral() {
        let params = PidParams {
            i: 20.0,
            ..PidParams::default()
        };
        let outputs = fed(params, &vec![(0.02, 0.0, 0.0); 10_000]);
        assert!((outputs[9999] - 4.0).abs() < 1e-6);
    }

    #[test]
    fn the_integral_holds_while_the_output_is_limited() {
        let params = PidParams {
            p: 1.0,
            i: 1000.0,
            max_output: 5.0,
            ..PidParams::default()
        };
        let mut inputs = vec![(10.0, 0.0, 0.0); 1000];
        inputs.extend([(10.0, 10.0, 0.0); 2]);
        let outputs = fed(params, &inputs);
        assert_close(&outputs[998..], &[5.0, 5.0, 5.0, 5.0]);
        // It had taken in the one tick before the output was seen to be limited: 10 d·ms.
        let mut pid = Pid::new(
            PidParams {
                max_output: 50.0,
                ..params
            },
            0.001,
        );
        let inputs = PidInputs {
            command: 10.0,
            feedback: 0.0,
            feedback_deriv: 0.0,
        };
        let seen: Vec<_> = (0..8).map(|_| pid.step(&inputs)).collect();
        assert_close(&seen, &[20.0, 30.0, 40.0, 50.0, 50.0, 50.0, 50.0, 50.0]);
    }

    #[test]
    fn derivatives_are_those_of_the_command_and_of_the_driver() {
        let params = PidParams {
            d: 0.1,
            ff1: 1.0,
            ff2: 0.01,
            ff3: 0.0001,
            ..PidParams::default()
        };
        // Command 0, 1, 4, 9: rates 1000, 3000, 5000; their rates 1e6, 2e6, 2e6; of those 1e9, 1e9, 0.
        let outputs = fed(
            params,
            &[
                (0.0, 0.0, 0.0),
                (1.0, 0.0, 500.0),
                (4.0, 1.0, 3000.0),
                (9.0, 4.0, 5000.0),
            ],
        );
        assert_close(
            &outputs,
            &[0.0, 50.0 + 1e3 + 1e4 + 1e5, 3e3 + 2e4 + 1e5, 5e3 + 2e4],
        );
    }
}
