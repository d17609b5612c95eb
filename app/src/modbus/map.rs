//! What is at which address, and what a write does.

use leadscrew::protocol::refusal::Refusal;
use leadscrew::protocol::service::{Passed, Ticket};
use rmodbus::ErrorKind;

use super::bits::discrete;
use super::list::with;
use super::registers::{LineCounts, Scene, register_at};
use super::{Panel, Parameter, ParameterList, Words};

/// Registers of a parameter: it is an f64.
pub const WORDS_PER_PARAMETER: u16 = 4;
/// First register of the values of parameters: that of index n is at `VALUES + 4 n`.
pub const VALUES: u16 = 1000;
/// First register of the smallest values allowed.
pub const MINIMA: u16 = 2000;
/// First register of the largest values allowed.
pub const MAXIMA: u16 = 3000;
/// First register of the defaults.
pub const DEFAULTS: u16 = 4000;
/// The register that saves all parameters.
pub const SAVE: u16 = 5000;
/// Registers from one block to the next: room for 250 parameters.
pub const BLOCK: u16 = 1000;
/// What is written to [`SAVE`] to save.
pub const SAVE_KEY: u16 = 0x5A5A;

/// Most parameters in a write: 123 registers.
const MOST_PARAMETERS: usize = 30;

/// The map of an axis, for one request.
pub(super) struct Map<'m, P> {
    pub panel: &'m mut P,
    pub list: ParameterList,
    pub counts: LineCounts,
    pub last_refusal: &'m mut u16,
    /// A write that is on its way: it is answered when the axis has taken it.
    pub waits: &'m mut Option<Ticket>,
}

impl<P: Panel> Map<'_, P> {
    /// Reads registers into `out`, two bytes each.
    pub fn read(&mut self, address: u16, count: u16, out: &mut [u8]) -> Result<(), ErrorKind> {
        let scene = Scene {
            view: self.panel.view(),
            list: self.list,
            counts: self.counts,
            last_refusal: *self.last_refusal,
        };
        let (places, _) = out.as_chunks_mut();
        let mut places = places.iter_mut().take(usize::from(count));
        let mut at = address;
        while places.len() > 0 {
            let (first, words) = self
                .value_at(&scene, at)
                .ok_or(ErrorKind::IllegalDataAddress)?;
            let words = words.as_slice().iter().skip(usize::from(at - first));
            for (word, place) in words.zip(places.by_ref()) {
                *place = word.to_be_bytes();
                at += 1;
            }
        }
        Ok(())
    }

    /// The value that a register belongs to, with its first register.
    fn value_at(&mut self, scene: &Scene, address: u16) -> Option<(u16, Words)> {
        if let Some(register) = register_at(address) {
            return Some((register.address, (register.get)(scene)));
        }
        if address == SAVE {
            return Some((SAVE, Words::of(&[0; 2])));
        }
        let base = address - address % BLOCK;
        let figure: fn(Parameter) -> f64 = match base {
            VALUES => |parameter| parameter.value,
            MINIMA => |parameter| parameter.min,
            MAXIMA => |parameter| parameter.max,
            DEFAULTS => |parameter| parameter.default,
            _ => return None,
        };
        let index = self.index(base, address)?;
        let figure = figure(Parameter::at(self.panel.settings(), index)?);
        let first = base + index * WORDS_PER_PARAMETER;
        Some((first, Words::of(&figure.to_be_bytes())))
    }

    /// The parameter whose figure, in the block at `base`, has a register at `address`.
    fn index(&self, base: u16, address: u16) -> Option<u16> {
        let index = address.checked_sub(base)? / WORDS_PER_PARAMETER;
        (index < self.list.count).then_some(index)
    }

    /// Reads discrete inputs into the bits of `out`, lowest first.
    pub fn read_bits(&mut self, address: u16, count: u16, out: &mut [u8]) -> Result<(), ErrorKind> {
        let view = self.panel.view();
        for number in 0..count {
            let at = address.checked_add(number);
            let bit = at.and_then(|at| discrete(&view, at));
            let bit = bit.ok_or(ErrorKind::IllegalDataAddress)?;
            if let Some(byte) = out.get_mut(usize::from(number / 8)) {
                *byte |= u8::from(bit) << (number % 8);
            }
        }
        Ok(())
    }

    /// Writes registers, two bytes each, by function 16 or 6.
    pub fn write(&mut self, address: u16, data: &[u8]) -> Result<(), ErrorKind> {
        let outcome = self.try_to_write(address, data);
        if let Ok(Passed::OnItsWay(ticket)) = outcome {
            *self.waits = Some(ticket);
        }
        let (number, outcome) = match outcome {
            Ok(_) => (0, Ok(())),
            Err((refusal, error)) => (refusal as u16, Err(error)),
        };
        *self.last_refusal = number;
        outcome
    }

    fn try_to_write(&mut self, address: u16, data: &[u8]) -> Result<Passed, (Refusal, ErrorKind)> {
        if address == SAVE {
            let is_key = data == SAVE_KEY.to_be_bytes();
            return if is_key {
                self.while_off(|panel| panel.save().map(|()| Passed::Taken))
            } else {
                Err((Refusal::ParameterOutOfRange, ErrorKind::IllegalDataValue))
            };
        }
        let illegal = |refusal| (refusal, ErrorKind::IllegalDataAddress);
        let first = self
            .index(VALUES, address)
            .ok_or(illegal(Refusal::UnknownParameter))?;
        let (given, rest) = data.as_chunks();
        let is_whole = (address - VALUES).is_multiple_of(WORDS_PER_PARAMETER) && rest.is_empty();
        if !is_whole || given.len() > MOST_PARAMETERS {
            return Err(illegal(Refusal::NotUnderstood));
        }
        let mut values = [0.0; MOST_PARAMETERS];
        for (value, bytes) in values.iter_mut().zip(given) {
            *value = f64::from_be_bytes(*bytes);
        }
        let values = &values[..given.len()];
        self.while_off(|panel| panel.set(with(panel.settings(), first, values)?))
    }

    /// Does what is not done while the axis is on.
    fn while_off(
        &mut self,
        act: impl FnOnce(&mut P) -> Result<Passed, Refusal>,
    ) -> Result<Passed, (Refusal, ErrorKind)> {
        let outcome = if self.panel.view().is_off() {
            act(self.panel)
        } else {
            Err(Refusal::AxisOn)
        };
        outcome.map_err(|refusal| (refusal, exception(refusal)))
    }
}

/// The exception by which a refusal is told; its number is in the register `last_refusal`.
pub(super) fn exception(refusal: Refusal) -> ErrorKind {
    match refusal {
        Refusal::UnknownParameter => ErrorKind::IllegalDataAddress,
        Refusal::ParameterOutOfRange | Refusal::UnknownWord | Refusal::Inconsistent => {
            ErrorKind::IllegalDataValue
        }
        Refusal::AxisOn
        | Refusal::Busy
        | Refusal::QueueFull
        | Refusal::StillMoving
        | Refusal::ExperimentRuns
        | Refusal::WorkMemoryLent => ErrorKind::SlaveDeviceBusy,
        _ => ErrorKind::SlaveDeviceFailure,
    }
}
