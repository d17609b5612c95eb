//! Every stage, and the whole step with each estimator, over the moving ticks of the standard move.

use board_mps2_an386::instructions::Counter;
use heapless::spsc::Queue;
use leadscrew::axis::{Axis, Inputs, Outputs};
use leadscrew::estimator::EstimatorConfig;
use leadscrew::hal::Encoder;
use leadscrew::params::{AxisConfig, AxisParams};
use leadscrew::supervisor::SupervisorParams;
use leadscrew::telemetry::Record;
use leadscrew_hal_mock::machine::{Machine, MachineParams};
use leadscrew_hal_mock::scenario::{MoveAndBack, ScenarioError, Script};
use static_cell::ConstStaticCell;

use crate::samples::Samples;
use crate::staged::{ESTIMATORS, StageSamples, Staged};

const TICK_HZ: f64 = 1000.0;
const SEED: u64 = 1;
/// The estimator that closes the loop: exponential.
const IN_LOOP: usize = 1;

struct Table {
    stages: StageSamples,
    steps: [Samples; ESTIMATORS],
    record: Samples,
    queue: Samples,
}

/// The way out of the tick, as the firmware has it.
static RECORDS: ConstStaticCell<Queue<Record, 4>> = ConstStaticCell::new(Queue::new());

static TABLE: ConstStaticCell<Table> = ConstStaticCell::new(Table {
    stages: StageSamples::new(),
    steps: Samples::of_each(EstimatorConfig::NAMES),
    record: Samples::of("record"),
    queue: Samples::of("queue"),
});

/// The standard move on the reference machine with that estimator.
pub fn config(estimator: EstimatorConfig) -> Result<(AxisConfig, Script), ScenarioError> {
    let scenario = MoveAndBack::standard(TICK_HZ);
    let params = scenario.axis_params(&MachineParams::z_16k20f3(), estimator)?;
    let config = params.validate()?;
    let script = Script::new(&scenario, params.motion.counts_per_mm, &config)?;
    Ok((config, script))
}

/// The same for inputs that no machine gives: nothing trips the supervisor.
pub fn permissive(estimator: EstimatorConfig) -> Result<(AxisConfig, Script), ScenarioError> {
    let scenario = MoveAndBack::standard(TICK_HZ);
    let (config, script) = config(estimator)?;
    let params = AxisParams {
        supervisor: SupervisorParams::widest(),
        ..scenario.axis_params(&MachineParams::z_16k20f3(), estimator)?
    };
    let supervisor = params.validate()?.supervisor;
    Ok((
        AxisConfig {
            supervisor,
            ..config
        },
        script,
    ))
}

/// All estimators with their default parameters.
pub fn estimators() -> Result<[EstimatorConfig; ESTIMATORS], ScenarioError> {
    let mut configs = [const { None }; ESTIMATORS];
    for (config, name) in configs.iter_mut().zip(EstimatorConfig::NAMES) {
        *config = EstimatorConfig::by_name(name)?;
    }
    Ok(configs.map(|config| config.expect("they are in the list")))
}

pub fn run(counter: &mut Counter) -> Result<(), ScenarioError> {
    let table = TABLE.take();
    let estimators = estimators()?;
    let (loop_config, script) = config(estimators[IN_LOOP])?;
    let mut axes = [const { None }; ESTIMATORS];
    for (axis, estimator) in axes.iter_mut().zip(estimators) {
        *axis = Some(Axis::new(config(estimator)?.0));
    }
    let mut staged = Staged::new(&loop_config, estimators);
    let mut machine = Machine::new(&MachineParams::z_16k20f3(), TICK_HZ, SEED)?;
    let mut applied = Outputs::default();
    let (mut records, mut taken) = RECORDS.take().split();
    let mut moves = script.moves.iter().peekable();
    for tick in 0..script.ticks {
        if let Some(next) = moves.next_if(|next| next.start == tick) {
            staged.queue(next, tick.wrapping_sub(1));
            for axis in axes.iter_mut().flatten() {
                let _ = axis.queue(&next.profile, next.start);
            }
        }
        machine.step(applied.command, applied.enabled);
        let capture = machine.capture();
        let inputs = Inputs::of(capture, true);
        let (mut record, mut queued) = (0, 0);
        let mut steps = [0; ESTIMATORS];
        for (index, axis) in axes.iter_mut().flatten().enumerate() {
            steps[index] = counter.count(|| Record::new(axis.step(&inputs)));
            let outputs = *axis.outputs();
            if index == IN_LOOP {
                record = counter.count(|| Record::new(&outputs));
                queued = counter.count(|| records.enqueue(Record::new(&outputs)));
                applied = outputs;
            }
            taken.dequeue();
        }
        let samples = applied.moving.then_some(&mut table.stages);
        staged.step(tick, &capture, counter, samples);
        if applied.moving {
            table.record.push(record);
            table.queue.push(queued.saturating_sub(record));
            for (samples, count) in table.steps.iter_mut().zip(steps) {
                samples.push(count);
            }
        }
    }
    table.stages.log();
    table.record.log("telemetry");
    table.queue.log("telemetry");
    table
        .steps
        .iter_mut()
        .for_each(|samples| samples.log("step"));
    Ok(())
}
