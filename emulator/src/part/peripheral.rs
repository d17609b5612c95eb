//! An own model as a device of the emulator.

use std::sync::Arc;

use rsemu::core::device::{Device, DeviceClass, RealizeCtx, ResetKind};
use rsemu::core::error::{Error, Result};
use rsemu::core::sched::LazyHandle;
use rsemu::core::space::{MemOps, Region, RegionRef};
use rsemu::core::wire::WireSource;
use rsemu::machine::Instance;

use super::registers::{Model, Timed};

/// Bytes that the registers of an own model take at the most.
const SIZE: u64 = 0x400;

/// A model with its registers.
#[derive(Debug)]
pub struct Peripheral<M> {
    timed: Arc<Timed<M>>,
    region: RegionRef,
    class: &'static DeviceClass,
}

impl<M: Model + 'static> Peripheral<M> {
    /// The device of a model.
    pub fn new(timed: Arc<Timed<M>>, class: &'static DeviceClass) -> Self {
        let registers: Arc<dyn MemOps> = timed.clone();
        Self {
            region: Arc::new(Region::io(class.name, SIZE, registers)),
            timed,
            class,
        }
    }
}

impl<M: Model + 'static> Device for Peripheral<M> {
    fn class(&self) -> &'static DeviceClass {
        self.class
    }

    fn realize(&self, _ctx: &mut RealizeCtx<'_>) -> Result<()> {
        Ok(())
    }

    fn reset(&self, _kind: ResetKind) {
        self.timed.with(M::reset);
    }

    fn region(&self, name: &str) -> Option<RegionRef> {
        name.is_empty().then(|| Arc::clone(&self.region))
    }

    fn connect(&self, port: &str, source: WireSource) -> Result<()> {
        let line = match port {
            "irq" => 0,
            "dma" => 1,
            _ => {
                return Err(Error::Config {
                    at: port.to_owned(),
                    message: "it drives irq and dma".to_owned(),
                });
            }
        };
        self.timed.connect(line, source);
        Ok(())
    }

    fn announce(&self, _port: &str) {
        self.timed.drive();
    }

    fn is_lazy(&self) -> bool {
        true
    }

    fn current_tick(&self) -> u64 {
        self.timed.tick()
    }

    fn advance_to(&self, tick: u64) {
        self.timed.advance(tick);
    }

    fn next_event_tick(&self) -> Option<u64> {
        self.timed.next()
    }

    fn attach_lazy(&self, handle: LazyHandle) {
        self.timed.attach(handle);
    }
}

impl<M: Model + 'static> Instance for Peripheral<M> {}

const fn class(name: &'static str, summary: &'static str) -> DeviceClass {
    DeviceClass {
        name,
        version: 1,
        summary,
        properties: &[],
        construct: |_| {
            Err(Error::Config {
                at: "axis".to_owned(),
                message: "an own device has to be bound".to_owned(),
            })
        },
    }
}

/// Class of the link's port.
pub static LINK: DeviceClass = class("axis.link", "USART1");
/// Class of the Modbus port.
pub static MODBUS: DeviceClass = class("axis.modbus", "USART6");
/// Class of the SPI.
pub static SPI: DeviceClass = class("axis.spi", "SPI1");
/// Class of the ADC.
pub static ADC: DeviceClass = class("axis.adc", "ADC1");
