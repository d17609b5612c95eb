//! What other lines than the link show and set: the axis as a panel.

use embedded_storage::nor_flash::NorFlash;
use leadscrew::protocol::refusal::Refusal;
use leadscrew::protocol::reply::Reply;

use super::Link;
use crate::modbus::{Panel, Parameter, View};

impl<F: NorFlash> Panel for Link<F> {
    fn view(&self) -> View {
        let Self { service, bench } = self;
        View {
            seen: bench.seen,
            scale: bench.scale,
            percent: service.percent(),
            is_held: service.is_held(),
            is_leased: service.holder().is_some(),
            counts: bench.counters.read(),
            first_fault: bench.first_fault,
            probe: None,
            capabilities: bench.capabilities,
        }
    }

    fn parameter(&mut self, index: u16) -> Option<Parameter> {
        match self.service.parameter(index) {
            Ok(Reply::Parameter {
                value,
                min,
                max,
                default,
                ..
            }) => Some(Parameter {
                value,
                min,
                max,
                default,
            }),
            Ok(Reply::Word { at, words, .. }) => Some(Parameter {
                value: f64::from(at),
                min: 0.0,
                max: f64::from(words.saturating_sub(1)),
                default: 0.0,
            }),
            _ => None,
        }
    }

    fn set_parameters(&mut self, first: u16, values: &[f64]) -> Result<(), Refusal> {
        let Self { service, bench } = self;
        let seen = bench.seen;
        service.set_numbers(first, values, &seen, bench)
    }

    fn save(&mut self) -> Result<(), Refusal> {
        let Self { service, bench } = self;
        bench.save_parameters(service.settings())
    }
}
