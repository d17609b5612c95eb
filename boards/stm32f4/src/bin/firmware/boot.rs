//! From the flash to an axis, its link and its lines.

use board_common::serve::ModbusLine;
use board_stm32f4::clocks::FAST_TIMER_HZ;
use board_stm32f4::converter::Output;
use board_stm32f4::encoder;
use board_stm32f4::flash::{CAPACITY, Flash};
use board_stm32f4::machine::Machine;
use board_stm32f4::references::References;
use board_stm32f4::ring::EDGES;
use board_stm32f4::tick::{self, COUNTERS, INTERLOCK};
use board_stm32f4::{latches, memory, uart};
use heapless::spsc::Consumer;
use leadscrew::compensation::Stretch;
use leadscrew::compensation::table::POINTS;
use leadscrew::protocol::reply::{
    CAN_EXPERIMENT, CAN_HOME, CAN_LEARN, CAN_PROBE, CAN_RECORD, CAN_SAVE, CAN_SCOPE, CAN_SET,
};
use leadscrew::protocol::service::Identity;
use leadscrew::settings::Settings;
use leadscrew_app::axis_control::AxisControl;
use leadscrew_app::input_filter::{InputFilter, InputsInForce};
use leadscrew_app::link::{Boot, Link, Maps};
use leadscrew_app::modbus::{Config, Modbus, Panel as _};
use leadscrew_app::queues::Queues;
use leadscrew_app::report::Report;
use leadscrew_app::tick_period::TickPeriod;
use static_cell::{ConstStaticCell, StaticCell};

use crate::factory;
use crate::serve::Server;

/// Bits a second of both UARTs.
const BAUD: u32 = 115_200;
/// Address on the Modbus line.
const MODBUS_UNIT: u8 = 1;
/// From an order to the start of its plan, in ticks: planning takes most of it.
const LEAD_TICKS: u32 = 16;

/// Words of captures on their way: six ticks of 160 edges.
const CAPTURED: usize = 1024;
/// Most edges of one of them.
const LOOKED_AT: usize = 512;

/// Starts axis, link, inputs and output, with the tick masked; gives thread mode's end of it, or why there is none.
pub fn boot() -> Result<(Server, TickPeriod), &'static str> {
    static QUEUES: ConstStaticCell<Queues<CAPTURED, LOOKED_AT>> =
        ConstStaticCell::new(Queues::new());
    static MAPS: ConstStaticCell<Maps<1>> = ConstStaticCell::new(Maps::new());
    static SCREW: ConstStaticCell<[Stretch; POINTS.1]> =
        ConstStaticCell::new([Stretch::EMPTY; POINTS.1]);

    static CONTROL: StaticCell<AxisControl<Machine>> = StaticCell::new();
    static LINK: StaticCell<Link<Flash>> = StaticCell::new();

    let boot = Boot {
        flash: Flash::take().ok_or("the flash is taken")?,
        range: 0..CAPACITY as u32,
        factory: factory::settings().map_err(|_| "the factory's drive cannot be tuned")?,
        identity: identity(),
        queues: QUEUES.take(),
        work: memory::take_work().ok_or("the work memory is taken")?,
        maps: MAPS.take().places(),
        screw: SCREW.take(),
        interlock: &INTERLOCK,
        counters: &COUNTERS,
    };
    let (control, link) = (CONTROL.uninit(), LINK.uninit());
    let started = boot.start_in(|made| control.write(made), |made| link.write(made));
    let (control, link, loaded) = started.map_err(|_| "the factory's parameters make no axis")?;
    if loaded.is_storeless {
        defmt::error!("the flash holds no store that can be used: nothing can be saved");
    }
    let tick_hz = link.view().scale.tick_hz();
    let (machine, inputs) = machine(&link.settings());
    link.set_inputs(inputs);
    let queue = memory::take_reports().ok_or("the reports' queue is taken")?;
    let reports = tick::wire(control, machine, output(), queue, tick_hz);
    let period = TickPeriod::nearest(FAST_TIMER_HZ, tick_hz).ok_or("no timer has that rate")?;
    Ok((server(link, reports)?, period))
}

fn output() -> Output {
    let (output, trouble) = Output::start();
    if let Some(trouble) = trouble {
        defmt::error!("converter: {}", trouble);
    }
    output
}

fn identity() -> Identity {
    Identity {
        firmware: env!("CARGO_PKG_VERSION"),
        build: if cfg!(debug_assertions) {
            "debug"
        } else {
            "release"
        },
        board: "stm32f4",
        capabilities: CAN_HOME
            | CAN_SET
            | CAN_RECORD
            | CAN_SAVE
            | CAN_EXPERIMENT
            | CAN_SCOPE
            | CAN_LEARN
            | CAN_PROBE,
        work_memory: (4 * memory::WORDS) as u32,
        lead_ticks: LEAD_TICKS,
    }
}

/// Starts all inputs, with the filter that the axis at full command asks for.
#[inline(never)]
fn machine(settings: &Settings) -> (Machine, InputsInForce) {
    let chosen = encoder::INPUTS.filter(settings);
    if let Err(error) = &chosen {
        // No axis is enabled then. Without a ring that holds everything no edge times are used.
        defmt::error!("inputs: {}", defmt::Display2Format(error));
    }
    let in_force = chosen.ok();
    let filter = in_force.unwrap_or(InputFilter::shortest());
    encoder::start(EDGES.address(), filter);
    latches::start(filter);
    let machine = Machine::new(filter, in_force.is_some(), References::start());
    let inputs = InputsInForce {
        inputs: encoder::INPUTS,
        filter: in_force,
    };
    (machine, inputs)
}

/// The lines, and all that thread mode works with.
#[inline(never)]
fn server(
    link: &'static mut Link<Flash>,
    reports: Consumer<'static, Report>,
) -> Result<Server, &'static str> {
    static LINK: ConstStaticCell<uart::Queues> = ConstStaticCell::new(uart::Queues::new());
    static MODBUS: ConstStaticCell<uart::Queues> = ConstStaticCell::new(uart::Queues::new());
    static UNIT: StaticCell<Modbus> = StaticCell::new();
    let config = Config::serial(MODBUS_UNIT, BAUD).map_err(|_| "Modbus is set up wrongly")?;
    let modbus = ModbusLine {
        line: uart::MODBUS.open(BAUD, MODBUS.take()),
        // Only the names of the settings matter there.
        unit: UNIT.init(Modbus::new(config, link.settings())),
    };
    let line = uart::LINK.open(BAUD, LINK.take());
    Ok(Server::new(line, modbus, link, reports))
}
