//! From the command line and the flash to an axis, its link and its lines.

use board_common::serve::ModbusLine;
use board_mps2_an386::carrier::Carrier;
use board_mps2_an386::exit_failure;
use board_mps2_an386::flash::{self, CAPACITY, Flash};
use board_mps2_an386::simulated::{COUNTERS, INTERLOCK, Plant};
use board_mps2_an386::uart::{self, Line, UART1};
use leadscrew::compensation::Stretch;
use leadscrew::compensation::table::POINTS;
use leadscrew::protocol::reply::{
    CAN_EXPERIMENT, CAN_HOME, CAN_LEARN, CAN_RECORD, CAN_SAVE, CAN_SCOPE, CAN_SET,
};
use leadscrew::protocol::service::Identity;
use leadscrew::settings::Settings;
use leadscrew_app::axis_control::AxisControl;
use leadscrew_app::link::{Boot, Link, Maps, WORDS, WorkMemory};
use leadscrew_app::modbus::{Config, Modbus, Panel as _};
use leadscrew_app::queues::Queues;
use static_cell::{ConstStaticCell, StaticCell};

use crate::words::Words;

/// Bits a second of both UARTs.
const BAUD: u32 = 115_200;
/// Silence that ends a frame on UART 1: QEMU keeps no time between characters.
const SILENCE_US: u32 = 20_000;
/// From an order to the start of its plan, in milliseconds: planning takes most of it.
const LEAD_MS: u32 = 16;

/// The axis, its link, and the tick rate of its settings.
pub fn axis(words: &Words, factory: Settings) -> (AxisControl<Plant>, Link<Flash>, f64) {
    static QUEUES: ConstStaticCell<Queues> = ConstStaticCell::new(Queues::new());
    static WORK: ConstStaticCell<WorkMemory<WORDS, WORDS>> =
        ConstStaticCell::new(WorkMemory::new());
    static MAPS: ConstStaticCell<Maps> = ConstStaticCell::new(Maps::new());
    static SCREW: ConstStaticCell<[Stretch; POINTS.1]> =
        ConstStaticCell::new([Stretch::EMPTY; POINTS.1]);

    let Ok(flash) = flash::open(words.flash.as_deref())
        .inspect_err(|error| defmt::error!("flash={=str}: {}", words.flash_path(), error))
    else {
        exit_failure()
    };
    let boot = Boot {
        flash,
        range: 0..CAPACITY as u32,
        factory,
        identity: identity(words),
        queues: QUEUES.take(),
        work: WORK.take().lend(),
        maps: MAPS.take().places(),
        screw: SCREW.take(),
        interlock: &INTERLOCK,
        counters: &COUNTERS,
    };
    let Ok((control, link, loaded)) = boot.start() else {
        defmt::error!("not even the factory's parameters make an axis");
        exit_failure()
    };
    if loaded.is_storeless {
        defmt::error!("the flash holds no store that can be used: nothing can be saved");
    }
    defmt::info!(
        "store: {}, encoder map {=bool}, screw table {=bool}",
        defmt::Debug2Format(&loaded.report.source),
        loaded.has_map,
        loaded.has_screw
    );
    let tick_hz = link.view().scale.tick_hz();
    (control, link, tick_hz)
}

fn identity(words: &Words) -> Identity {
    Identity {
        firmware: env!("CARGO_PKG_VERSION"),
        build: if cfg!(debug_assertions) {
            "debug"
        } else {
            "release"
        },
        board: "mps2-an386",
        capabilities: CAN_HOME
            | CAN_SET
            | CAN_RECORD
            | CAN_SAVE
            | CAN_EXPERIMENT
            | CAN_SCOPE
            | CAN_LEARN,
        work_memory: (4 * WORDS) as u32,
        lead_ticks: (words.options.tick_hz * LEAD_MS).div_ceil(1000),
    }
}

/// What carries the link, and Modbus on its UART.
pub fn lines(words: &Words, factory: Settings) -> (Carrier, ModbusLine<Line>) {
    static MODBUS: ConstStaticCell<uart::Queues> = ConstStaticCell::new(uart::Queues::new());
    static UNIT: StaticCell<Modbus> = StaticCell::new();
    let Ok(carrier) = Carrier::open(words.lockstep.as_deref(), BAUD)
        .inspect_err(|error| defmt::error!("lockstep: {}", error))
    else {
        exit_failure()
    };
    let Ok(config) = Config::serial(words.modbus_unit, BAUD) else {
        defmt::error!(
            "modbus={=u8} is out of range: allowed 1 to 247",
            words.modbus_unit
        );
        exit_failure()
    };
    let modbus = ModbusLine {
        line: UART1.open(BAUD, MODBUS.take()),
        unit: UNIT.init(Modbus::new(config.with_silence_us(SILENCE_US), factory)),
    };
    (carrier, modbus)
}
