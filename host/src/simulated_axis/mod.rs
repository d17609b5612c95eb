//! The firmware of an axis with its machine in this process, in virtual time: what a tool talks to where there is no
//! board and no QEMU. It is the app that boards run, on the simulator that QEMU runs; time passes by exchanges on its
//! line alone, so that a session is the same every time.

mod flash;

use std::collections::VecDeque;
use std::io;
use std::time::Duration;

use heapless::spsc::{Consumer, Queue};
use leadscrew::axis::Inputs;
use leadscrew::compensation::table::{POINTS, Stretch};
use leadscrew::estimator::EstimatorConfig;
use leadscrew::protocol::reply::{
    CAN_EXPERIMENT, CAN_HOME, CAN_LEARN, CAN_PROBE, CAN_RECORD, CAN_SAVE, CAN_SCOPE, CAN_SET,
};
use leadscrew::protocol::service::Identity;
use leadscrew::settings::Settings;
use leadscrew::telemetry::Record;
use leadscrew_app::axis_control::{AxisControl, Inlet};
use leadscrew_app::link::{Boot, Link, Loaded, Maps, WORDS, WorkMemory};
use leadscrew_app::modbus::Panel as _;
use leadscrew_app::queues::Queues;
use leadscrew_app::report::Report;
use leadscrew_app::store::Interlock;
use leadscrew_app::tick::{Counters, Runtime, TickTimer};
use leadscrew_client::Line;
use leadscrew_hal_mock::flash::SimulatedFlash;
use leadscrew_hal_mock::scenario::{Base, Scenario, ScenarioError, World, workshop};

pub use flash::{CAPACITY, FlashImage, ImageError};

/// Time that an exchange lets pass, s.
const EXCHANGE_S: f64 = 0.005;
/// Bytes that wait for the line to take them.
const OUTBOX: usize = 4096;
/// Bits a second of the line, 10 of them a byte.
const BAUD: f64 = 921_600.0;
const REPORTS: usize = 64;
/// Estimator of an axis that nobody has set up.
const ESTIMATOR: &str = "exponential";

/// The machine as the tick sees it.
struct Plant(World);

impl Inlet for Plant {
    fn inputs(&self, enable: bool) -> Inputs<'_> {
        self.0.inputs(enable)
    }
}

/// A timer on which every tick is in time.
struct InTime;

impl TickTimer for InTime {
    fn since_due(&self) -> u32 {
        0
    }

    fn is_due_again(&self) -> bool {
        false
    }
}

/// The firmware since it was switched on. Its memory is not given back: a process switches few axes on.
struct Firmware {
    runtime: Runtime<AxisControl<Plant>>,
    reports: Consumer<'static, Report>,
    link: Link<SimulatedFlash<FlashImage>>,
    loaded: Loaded,
    /// A machine is large: on the heap, so that whoever has an axis needs no large stack.
    plant: Box<Plant>,
    put_out: Record,
    tick_hz: f64,
}

/// An axis that is simulated.
pub struct SimulatedAxis {
    scenario: Scenario<'static>,
    flash: FlashImage,
    firmware: Box<Firmware>,
    ticks: u64,
    time_s: f64,
    to_axis: VecDeque<u8>,
    to_tool: VecDeque<u8>,
    /// Bytes that the line may take by now.
    credit: f64,
    watch: Option<Box<Watch>>,
}

/// Looks at every tick: what it put out, and the bytes that came from the tool.
type Watch = dyn FnMut(&Record, &[u8]);

impl SimulatedAxis {
    /// Switches the workshop's machine on: what it is made of, its control rate unless its store says otherwise, and what
    /// draws everything random.
    ///
    /// # Errors
    /// [`ScenarioError`] for a rate out of range.
    pub fn new(
        base: Base,
        tick_hz: f64,
        seed: u64,
        flash: FlashImage,
    ) -> Result<Self, ScenarioError> {
        let scenario = workshop(base, tick_hz, seed);
        Ok(Self {
            firmware: Firmware::start(&scenario, flash.clone())?,
            flash,
            scenario,
            ticks: 0,
            time_s: 0.0,
            to_axis: VecDeque::new(),
            to_tool: VecDeque::new(),
            credit: 0.0,
            watch: None,
        })
    }

    /// What was found in the store when it was switched on.
    #[must_use]
    pub const fn loaded(&self) -> &Loaded {
        &self.firmware.loaded
    }

    /// The machine with its board.
    #[must_use]
    pub const fn world(&self) -> &World {
        &self.firmware.plant.0
    }

    /// The same, for troubles between two ticks.
    pub const fn world_mut(&mut self) -> &mut World {
        &mut self.firmware.plant.0
    }

    /// What the last tick put out.
    #[must_use]
    pub const fn put_out(&self) -> &Record {
        &self.firmware.put_out
    }

    /// Lets `watch` look at every tick from now on: what it put out, and the bytes that came to the axis in it.
    pub fn watch(&mut self, watch: impl FnMut(&Record, &[u8]) + 'static) {
        self.watch = Some(Box::new(watch));
    }

    /// Switches it off and on again: all but the flash is lost, and the machine stands where it stood at first.
    ///
    /// # Errors
    /// As of [`Self::new`].
    pub fn power_cycle(&mut self) -> Result<(), ScenarioError> {
        self.firmware = Firmware::start(&self.scenario, self.flash.clone())?;
        self.to_axis.clear();
        self.to_tool.clear();
        Ok(())
    }

    /// Ticks since it was first switched on.
    #[must_use]
    pub const fn ticks(&self) -> u64 {
        self.ticks
    }

    /// Time since it was first switched on.
    #[must_use]
    pub fn time(&self) -> Duration {
        Duration::from_secs_f64(self.time_s)
    }

    /// One tick, with what the line brings in it.
    pub fn tick(&mut self) {
        self.ticks += 1;
        self.time_s += 1.0 / self.firmware.tick_hz;
        let of_tick = BAUD / 10.0 / self.firmware.tick_hz;
        let arriving = self.to_axis.len().min(of_tick.ceil() as usize);
        let bytes: Vec<u8> = self.to_axis.drain(..arriving).collect();
        let to_tool = &mut self.to_tool;
        self.firmware.tick(&bytes, &mut |frame| {
            let has_room = to_tool.len() + frame.len() <= OUTBOX;
            if has_room {
                to_tool.extend(frame);
            }
            has_room
        });
        if let Some(watch) = &mut self.watch {
            watch(&self.firmware.put_out, &bytes);
        }
    }

    /// Lets the line take as many bytes as it may in so many ticks.
    fn take(&mut self, ticks: u32, received: &mut Vec<u8>) {
        self.credit += f64::from(ticks) * BAUD / 10.0 / self.firmware.tick_hz;
        let most = self.to_tool.len().min(self.credit as usize);
        received.extend(self.to_tool.drain(..most));
        self.credit = if self.to_tool.is_empty() {
            0.0
        } else {
            self.credit - most as f64
        };
    }
}

#[inline(never)]
fn plant(scenario: &Scenario<'static>, tick_hz: f64) -> Result<Box<Plant>, ScenarioError> {
    let scenario = Scenario {
        tick_hz,
        ..*scenario
    };
    Ok(Box::new(Plant(World::new(&scenario.plant(), &scenario)?)))
}

impl Firmware {
    #[inline(never)]
    fn start(scenario: &Scenario<'static>, flash: FlashImage) -> Result<Box<Self>, ScenarioError> {
        let estimator = EstimatorConfig::by_name(ESTIMATOR)?;
        let mut factory = Settings::new(estimator.ok_or(ScenarioError::NoSuchEstimator)?);
        factory.axis.tick_hz = scenario.tick_hz;
        let counters: &'static Counters = Box::leak(Box::new(Counters::new()));
        let boot = Boot {
            flash: SimulatedFlash(flash),
            range: 0..CAPACITY as u32,
            factory,
            identity: Identity {
                firmware: env!("CARGO_PKG_VERSION"),
                build: "simulated",
                board: "simulated",
                capabilities: CAN_HOME
                    | CAN_SET
                    | CAN_RECORD
                    | CAN_SAVE
                    | CAN_EXPERIMENT
                    | CAN_SCOPE
                    | CAN_LEARN
                    | CAN_PROBE,
                work_memory: 4 * WORDS as u32,
                lead_ticks: 4,
            },
            queues: Box::leak(Box::new(<Queues>::new())),
            work: Box::leak(Box::new(WorkMemory::<WORDS, WORDS>::new())).lend(),
            maps: Box::leak(Box::new(<Maps>::new())).places(),
            screw: Box::leak(Box::new([Stretch::default(); POINTS.1])),
            interlock: Box::leak(Box::new(Interlock::new())),
            counters,
        };
        let (control, link, loaded) = boot.start()?;
        // What is stored comes before what the axis was made for.
        let tick_hz = link.view().scale.tick_hz();
        let reports: &'static mut Queue<Report, REPORTS> = Box::leak(Box::new(Queue::new()));
        let (producer, reports) = reports.split();
        Ok(Box::new(Self {
            runtime: Runtime::new(control, producer, counters, 1),
            reports,
            link,
            loaded,
            plant: plant(scenario, tick_hz)?,
            tick_hz,
            put_out: Record::default(),
        }))
    }

    fn tick(&mut self, bytes: &[u8], send: &mut dyn FnMut(&[u8]) -> bool) {
        self.plant.0.step(&self.put_out.put_out());
        self.put_out = self.runtime.run(&InTime, Some(&self.plant)).record;
        while let Some(report) = self.reports.dequeue() {
            self.link.report(&report, send);
        }
        self.link.poll(send);
        if !bytes.is_empty() {
            self.link.receive(bytes, send);
        }
    }
}

impl Line for SimulatedAxis {
    fn exchange(&mut self, out: &[u8], received: &mut Vec<u8>) -> io::Result<Duration> {
        self.to_axis.extend(out);
        let ticks = (EXCHANGE_S * self.firmware.tick_hz).round().max(1.0) as u32;
        for _ in 0..ticks {
            self.tick();
        }
        self.take(ticks, received);
        if self.firmware.link.wants_restart() && self.to_tool.is_empty() {
            self.power_cycle().map_err(io::Error::other)?;
        }
        Ok(self.time())
    }

    fn name(&self) -> String {
        "sim".to_owned()
    }

    fn is_lockstep(&self) -> bool {
        true
    }
}
