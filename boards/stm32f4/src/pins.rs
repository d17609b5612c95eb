//! The pin map: what is where, how it is set up, and which level means what.
//!
//! It is data alone, so that a test on the host can hold it against the chip's table of alternate functions. All pins
//! are on the LQFP64 package, and so on all chips of this board. `docs/board.md` has the wiring.

/// How a pin works.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// Of a peripheral: number of the alternate function, and the peripheral's name for the signal.
    Alternate(u8, &'static str),
    /// An input that the program reads.
    Input,
    /// An output, push-pull, with its level from the first moment on.
    Output(bool),
    /// An input of a converter.
    Analog,
}

/// What holds an input that nobody drives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pull {
    /// Nothing.
    None,
    /// Some 40 kΩ to 3.3 V: a wire that is off reads high.
    Up,
    /// Some 40 kΩ to ground.
    Down,
}

/// A pin in its place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pin {
    /// Port, `b'A'` to `b'C'`.
    pub port: u8,
    /// Number within the port, 0 to 15.
    pub number: u8,
    /// How it works.
    pub mode: Mode,
    /// What holds it.
    pub pull: Pull,
}

const fn pin(port: u8, number: u8, mode: Mode, pull: Pull) -> Pin {
    Pin {
        port,
        number,
        mode,
        pull,
    }
}

const fn alternate(port: u8, number: u8, function: u8, signal: &'static str, pull: Pull) -> Pin {
    pin(port, number, Mode::Alternate(function, signal), pull)
}

/// Channel A of the encoder, to the edge timer.
pub const ENCODER_A_TIME: Pin = alternate(b'A', 0, 2, "TIM5_CH1", Pull::Up);
/// Channel B of the encoder, to the edge timer.
pub const ENCODER_B_TIME: Pin = alternate(b'A', 1, 2, "TIM5_CH2", Pull::Up);
/// Channel A of the encoder, to the counter.
pub const ENCODER_A_COUNT: Pin = alternate(b'A', 15, 1, "TIM2_CH1", Pull::None);
/// Channel B of the encoder, to the counter.
pub const ENCODER_B_COUNT: Pin = alternate(b'B', 3, 1, "TIM2_CH2", Pull::None);
/// Index of the encoder, latches the count; its rising edge counts.
pub const INDEX_COUNT: Pin = alternate(b'B', 10, 1, "TIM2_CH3", Pull::None);
/// Index of the encoder, latches the time.
pub const INDEX_TIME: Pin = alternate(b'A', 3, 2, "TIM5_CH4", Pull::Down);
/// Probe, normally closed to ground: high is triggered.
pub const PROBE: Pin = alternate(b'A', 8, 1, "TIM1_CH1", Pull::Up);
/// Home switch, normally closed to ground: high is actuated.
pub const HOME: Pin = alternate(b'A', 11, 1, "TIM1_CH4", Pull::Up);

/// Channel A of the second encoder.
pub const MASTER_A: Pin = alternate(b'B', 4, 2, "TIM3_CH1", Pull::Up);
/// Channel B of the second encoder.
pub const MASTER_B: Pin = alternate(b'B', 5, 2, "TIM3_CH2", Pull::Up);
/// Index of the second encoder; its rising edge counts.
pub const MASTER_INDEX: Pin = alternate(b'B', 0, 2, "TIM3_CH3", Pull::Down);

/// Step input; its rising edge counts.
pub const STEP: Pin = alternate(b'B', 6, 2, "TIM4_CH1", Pull::Down);
/// Direction of steps: high counts up.
pub const DIRECTION: Pin = pin(b'B', 7, Mode::Input, Pull::Down);

/// Converter, /SYNC.
pub const CONVERTER_SYNC: Pin = pin(b'A', 4, Mode::Output(true), Pull::None);
/// Converter, SCLK.
pub const CONVERTER_CLOCK: Pin = alternate(b'A', 5, 5, "SPI1_SCK", Pull::None);
/// Converter, SDO.
pub const CONVERTER_OUT: Pin = alternate(b'A', 6, 5, "SPI1_MISO", Pull::Up);
/// Converter, SDI.
pub const CONVERTER_IN: Pin = alternate(b'A', 7, 5, "SPI1_MOSI", Pull::None);
/// Converter, /LDAC: high for ever. Low, it would put out every pattern that the wires are tried with; the tick's word puts out
/// what it brings whatever this is.
pub const CONVERTER_LOAD: Pin = pin(b'C', 4, Mode::Output(true), Pull::None);
/// Converter, /RESET: low (output clamped to ground) until the converter is set up, and again in the safe state.
pub const CONVERTER_RESET: Pin = pin(b'C', 5, Mode::Output(false), Pull::Down);
/// Converter, /ALERT, open drain: low is a brown-out or too hot.
pub const CONVERTER_ALERT: Pin = pin(b'B', 1, Mode::Input, Pull::Up);

/// The link, transmits.
pub const LINK_TX: Pin = alternate(b'A', 9, 7, "USART1_TX", Pull::Up);
/// The link, receives.
pub const LINK_RX: Pin = alternate(b'A', 10, 7, "USART1_RX", Pull::Up);
/// Modbus, transmits.
pub const MODBUS_TX: Pin = alternate(b'C', 6, 8, "USART6_TX", Pull::Up);
/// Modbus, receives.
pub const MODBUS_RX: Pin = alternate(b'C', 7, 8, "USART6_RX", Pull::Up);
/// Modbus, driver of the RS-485 line: high sends.
pub const MODBUS_SENDS: Pin = pin(b'C', 8, Mode::Output(false), Pull::Down);

/// Analog command of an outer control, ADC1 channel 10.
pub const COMMAND: Pin = pin(b'C', 0, Mode::Analog, Pull::None);

/// Relay that enables the drive: high enables.
pub const ENABLE: Pin = pin(b'B', 9, Mode::Output(false), Pull::Down);
/// Relay of the brake: high releases.
pub const BRAKE: Pin = pin(b'B', 8, Mode::Output(false), Pull::Down);
/// The drive is ready: contact to ground, low is ready.
pub const DRIVE_READY: Pin = pin(b'B', 12, Mode::Input, Pull::Up);
/// The drive has a fault: normally closed to ground, high is a fault.
pub const DRIVE_FAULT: Pin = pin(b'B', 13, Mode::Input, Pull::Up);
/// The receivers of the encoder see no valid signal: high is lost.
pub const ENCODER_LOST: Pin = pin(b'B', 14, Mode::Input, Pull::Up);
/// The same of the second encoder.
pub const MASTER_LOST: Pin = pin(b'B', 15, Mode::Input, Pull::Up);
/// Emergency-stop chain, closed to ground: high is open.
pub const EMERGENCY_STOP: Pin = pin(b'C', 1, Mode::Input, Pull::Up);
/// Limit switch at the low end, normally closed to ground: high is actuated.
pub const LIMIT_LOW: Pin = pin(b'C', 2, Mode::Input, Pull::Up);
/// Limit switch at the high end, normally closed to ground: high is actuated.
pub const LIMIT_HIGH: Pin = pin(b'C', 3, Mode::Input, Pull::Up);
/// Status light: low is on.
pub const LIGHT: Pin = pin(b'C', 13, Mode::Output(true), Pull::None);

/// All of them, those first on which safety depends. The debugger's (PA13, PA14) stay as they are out of reset. PA2 must not be
/// given to TIM5: its third channel is part of the exclusive or.
pub const ALL: [Pin; 36] = [
    ENABLE,
    BRAKE,
    CONVERTER_RESET,
    CONVERTER_SYNC,
    CONVERTER_LOAD,
    CONVERTER_CLOCK,
    CONVERTER_OUT,
    CONVERTER_IN,
    CONVERTER_ALERT,
    MODBUS_SENDS,
    LIGHT,
    ENCODER_A_TIME,
    ENCODER_B_TIME,
    ENCODER_A_COUNT,
    ENCODER_B_COUNT,
    INDEX_COUNT,
    INDEX_TIME,
    PROBE,
    HOME,
    MASTER_A,
    MASTER_B,
    MASTER_INDEX,
    STEP,
    DIRECTION,
    LINK_TX,
    LINK_RX,
    MODBUS_TX,
    MODBUS_RX,
    COMMAND,
    DRIVE_READY,
    DRIVE_FAULT,
    ENCODER_LOST,
    MASTER_LOST,
    EMERGENCY_STOP,
    LIMIT_LOW,
    LIMIT_HIGH,
];
