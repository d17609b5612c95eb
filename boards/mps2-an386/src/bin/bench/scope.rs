//! What the scope costs beside the step, over the moving ticks of the standard move: eight signals as people choose them,
//! with the trigger there and with one that compares whole values in every tick; eight wide signals; a live view.

use board_mps2_an386::instructions::Counter;
use leadscrew::axis::{Axis, Inputs, Outputs};
use leadscrew::estimator::EstimatorConfig;
use leadscrew::hal::Encoder;
use leadscrew::scope::{MOST_SIGNALS, Scope, Setup, Signal, Signals, Slope, Stream, Trigger};
use leadscrew_hal_mock::machine::{Machine, MachineParams};
use leadscrew_hal_mock::scenario::ScenarioError;
use static_cell::ConstStaticCell;

use crate::samples::Samples;
use crate::standard_move;

const SAMPLES: u32 = 256;
const WORDS: usize = SAMPLES as usize * MOST_SIGNALS;

/// Signals as people choose them.
pub const USUAL: [Signal; MOST_SIGNALS] = [
    Signal::Position,
    Signal::Velocity,
    Signal::Acceleration,
    Signal::SetpointPosition,
    Signal::SetpointVelocity,
    Signal::FollowingError,
    Signal::Command,
    Signal::Flags,
];
const WIDE: [Signal; MOST_SIGNALS] = [
    Signal::Count,
    Signal::Position,
    Signal::SetpointPosition,
    Signal::ReportedPosition,
    Signal::CommandedPosition,
    Signal::ExperimentPosition,
    Signal::MasterCount,
    Signal::Position,
];
/// Never there: it looks on and on.
const EDGE: Trigger = Trigger::Edge {
    signal: Signal::Position,
    level: i64::MAX,
    slope: Slope::Rising,
};

static MEMORY: ConstStaticCell<[[i32; WORDS]; 3]> = ConstStaticCell::new([[0; WORDS]; 3]);
static COUNTS: ConstStaticCell<[Samples; 4]> = ConstStaticCell::new(Samples::of_each(&[
    "8_signals",
    "8_signals_edge",
    "8_wide_signals",
    "stream",
]));

pub fn run(counter: &mut Counter) -> Result<(), ScenarioError> {
    let estimator = EstimatorConfig::by_name("exponential")?.expect("it is one");
    let (config, script) = standard_move::config(estimator)?;
    let mut axis = Axis::new(config);
    let mut machine = Machine::new(&MachineParams::z_16k20f3(), 1000.0, 1)?;
    let [triggered, waiting, wide] = MEMORY.take();
    let mut scopes = [
        scope(triggered, &USUAL, Trigger::Now),
        scope(waiting, &USUAL, EDGE),
        scope(wide, &WIDE, Trigger::Now),
    ];
    let mut stream = Stream::new(signals(&USUAL), 1).expect("it is every tick");
    let counts = COUNTS.take();
    let mut applied = Outputs::default();
    let mut moves = script.moves.iter().peekable();
    for tick in 0..script.ticks {
        if let Some(next) = moves.next_if(|next| next.start == tick) {
            axis.queue(&next.profile, next.start)
                .expect("the axis is ready");
        }
        machine.step(applied.command, applied.enabled);
        applied = *axis.step(&Inputs::of(machine.capture(), true));
        let (of_scopes, of_stream) = counts.split_at_mut(3);
        for (scope, counts) in scopes.iter_mut().zip(of_scopes) {
            let cost = counter.count(|| scope.take(&axis));
            if applied.moving {
                counts.push(cost);
            }
        }
        let cost = counter.count(|| stream.take(&axis));
        if applied.moving {
            of_stream[0].push(cost);
        }
        scopes = scopes.map(again);
    }
    counts.iter_mut().for_each(|counts| counts.log("scope"));
    Ok(())
}

fn signals(signals: &[Signal]) -> Signals {
    Signals::new(signals).expect("they are eight")
}

fn scope<'m>(memory: &'m mut [i32], list: &[Signal], trigger: Trigger) -> Scope<'m> {
    let setup = Setup {
        signals: signals(list),
        every: 1,
        trigger,
        pre: SAMPLES - 1,
        samples: SAMPLES,
    };
    Scope::new(memory, &setup).expect("it fits")
}

/// The same from the beginning, once it is full.
fn again(scope: Scope<'_>) -> Scope<'_> {
    if !scope.is_over() {
        return scope;
    }
    let setup = *scope.setup();
    Scope::new(scope.into_memory(), &setup).expect("it did fit")
}
