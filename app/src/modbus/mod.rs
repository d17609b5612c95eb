//! Modbus RTU, for PLCs and other controls on a second UART: status, faults, positions and parameters; no motion.
//!
//! ```text
//! bytes ─► line ─► frame ─► rmodbus ─► map ─► registers, bits ◄─ View ─┐
//!         (silence, CRC)   (functions)  │                              ├─ Panel (the axis's link)
//! bytes ◄───────── reply ◄──────────────┴──► parameters, save ◄────────┘
//! ```
//!
//! [`mod@line`] finds frames in whatever comes, [`registers`] and [`bits`] are the tables of what can be read, [`map`]
//! says what is at which address, [`Panel`] is what the axis gives. `docs/modbus.md` is the page for people; its
//! tables are made from here.
//!
//! Nothing here knows a board: bytes, time and the axis come in as values. There is no register that moves the axis,
//! and parameters are written only while it is off.

pub mod bits;
mod config;
pub mod line;
mod list;
pub mod map;
mod panel;
pub mod registers;
mod words;

pub use config::{Config, ConfigError};
pub use list::{Parameter, ParameterList};
pub use panel::{Panel, ProbeLatch, View};
pub use words::Words;

use heapless::Vec;
use leadscrew::protocol::refusal::Refusal;
use leadscrew::protocol::service::Ticket;
use leadscrew::settings::Settings;
use rmodbus::consts::{ModbusErrorCode, ModbusFunction};
use rmodbus::server::{ModbusFrame, Read, Write};
use rmodbus::{ErrorKind, ModbusProto, guess_request_frame_len};

use line::{Line, MAX_FRAME};
use map::Map;
use registers::LineCounts;

/// Functions from here on are those of exceptions: nobody asks for them.
const EXCEPTIONS: u8 = 0x80;

/// An axis as a unit on a Modbus line.
#[derive(Debug)]
pub struct Modbus {
    unit: u8,
    line: Line,
    server: Server,
}

/// All but the line, whose bytes are looked at meanwhile.
#[derive(Debug)]
struct Server {
    list: ParameterList,
    /// Number of the last refusal of a write, 0 for none.
    last_refusal: u16,
    taken: u32,
    /// The reply waits for the axis.
    waits: Option<Ticket>,
    reply: Vec<u8, MAX_FRAME>,
}

impl Modbus {
    /// The unit of an axis with settings like these; only their names matter here.
    #[must_use]
    pub fn new(config: Config, settings: Settings) -> Self {
        Self {
            unit: config.unit(),
            line: Line::new(config),
            server: Server {
                list: ParameterList::of(settings),
                last_refusal: 0,
                taken: 0,
                waits: None,
                reply: Vec::new(),
            },
        }
    }

    /// Takes bytes that came by `now_us`, any number of them; the clock wraps. Each request to this unit is answered by
    /// a frame to `send`.
    ///
    /// The line must not give back what is sent: on a half-duplex line the receiver is off meanwhile.
    pub fn receive(
        &mut self,
        bytes: &[u8],
        now_us: u32,
        panel: &mut impl Panel,
        send: &mut dyn FnMut(&[u8]),
    ) {
        let Self { unit, line, server } = self;
        line.receive(bytes, now_us, |frame, dropped| {
            server.take(*unit, dropped, frame, panel, send);
        });
    }

    /// Answers a write that the axis has taken meanwhile, and looks whether the line has fallen silent, which ends a frame:
    /// to be called at least every millisecond or so. A frame whose length tells its end does not wait for it.
    pub fn poll(&mut self, now_us: u32, panel: &mut impl Panel, send: &mut dyn FnMut(&[u8])) {
        let Self { unit, line, server } = self;
        server.settle(*unit, panel, send);
        line.poll(now_us, |frame, dropped| {
            server.take(*unit, dropped, frame, panel, send);
        });
    }
}

impl Server {
    /// Answers what was on its way, if there is an outcome.
    fn settle(&mut self, unit: u8, panel: &mut impl Panel, send: &mut dyn FnMut(&[u8])) {
        let Some(outcome) = self.waits.and_then(|ticket| panel.outcome(ticket)) else {
            return;
        };
        self.waits = None;
        let said = outcome.or_else(|refusal| self.refuse(unit, refusal));
        if said.is_ok() {
            send(&self.reply);
        }
    }

    /// Makes the reply one that refuses.
    fn refuse(&mut self, unit: u8, refusal: Refusal) -> Result<(), ErrorKind> {
        self.last_refusal = refusal as u16;
        let function = self.reply.get(1).copied().unwrap_or_default();
        let mut frame = ModbusFrame::new(unit, &[], ModbusProto::Rtu, &mut self.reply);
        frame.responding_to_fn = function;
        frame.error = Some(map::exception(refusal).to_modbus_error()?);
        frame.finalize_response()
    }

    fn take(
        &mut self,
        unit: u8,
        dropped: u32,
        frame: &[u8],
        panel: &mut impl Panel,
        send: &mut dyn FnMut(&[u8]),
    ) {
        self.taken = self.taken.wrapping_add(1);
        self.waits = None;
        let counts = LineCounts {
            taken: self.taken,
            dropped,
        };
        // An error is of a frame that nothing can be said to.
        let is_said = self.answer(unit, counts, frame, panel).is_ok();
        if is_said && self.waits.is_none() && !self.reply.is_empty() {
            send(&self.reply);
        }
    }

    /// Answers a frame to this unit whose CRC is right.
    fn answer(
        &mut self,
        unit: u8,
        counts: LineCounts,
        request: &[u8],
        panel: &mut impl Panel,
    ) -> Result<(), ErrorKind> {
        let Self {
            list,
            last_refusal,
            waits,
            reply,
            ..
        } = self;
        let mut frame = ModbusFrame::new(unit, request, ModbusProto::Rtu, reply);
        let number = request.get(1).copied().unwrap_or(EXCEPTIONS);
        if number >= EXCEPTIONS {
            return Ok(());
        }
        if ModbusFunction::try_from(number).is_ok() && !is_well_formed(request) {
            frame.responding_to_fn = number;
            frame.error = Some(ModbusErrorCode::IllegalDataValue);
            return frame.finalize_response();
        }
        frame.parse()?;
        if frame.processing_required {
            let mut map = Map {
                panel,
                list: *list,
                counts,
                last_refusal,
                waits,
            };
            if frame.readonly {
                let outcome = match frame.get_external_read()? {
                    Read::Words(read) => map.read(read.address, read.count, read.buf),
                    Read::Bits(read) if number == ModbusFunction::GetDiscretes.byte() => {
                        map.read_bits(read.address, read.count, read.buf)
                    }
                    // There are no coils.
                    Read::Bits(_) => Err(ErrorKind::IllegalDataAddress),
                };
                frame.process_external_read(outcome)?;
            } else {
                let outcome = match frame.get_external_write() {
                    Ok(Write::Words(write)) => map.write(write.address, write.data),
                    Ok(Write::Bits(_)) => Err(ErrorKind::IllegalDataAddress),
                    Err(error) => Err(error),
                };
                frame.process_external_write(outcome)?;
            }
        }
        frame.finalize_response()
    }
}

/// True if the length of `request` is what its function has, and its counts go together and are not zero.
fn is_well_formed(request: &[u8]) -> bool {
    let is_whole = guess_request_frame_len(request, ModbusProto::Rtu)
        .is_ok_and(|length| usize::from(length) == request.len());
    let &[_, function, _, _, high, low, ref rest @ ..] = request else {
        return false;
    };
    let count = u16::from_be_bytes([high, low]);
    let bytes = rest.first().copied().map(u16::from);
    is_whole
        && match function {
            5 | 6 => true,
            15 => count > 0 && bytes == Some(count.div_ceil(8)),
            16 => count > 0 && bytes == count.checked_mul(2),
            _ => count > 0,
        }
}
