//! What other lines than the link show and set: the axis as a panel.

use embedded_storage::nor_flash::NorFlash;
use leadscrew::probe::{Report, Touch};
use leadscrew::protocol::refusal::Refusal;
use leadscrew::protocol::service::{Passed, Ticket};
use leadscrew::settings::Settings;

use super::Link;
use super::bench::Bench;
use crate::modbus::{Panel, ProbeLatch, View};

impl<F: NorFlash> Panel for Link<F> {
    fn view(&self) -> View {
        let Self { service, bench, .. } = self;
        View {
            seen: bench.seen,
            scale: bench.scale,
            percent: service.percent(),
            is_held: service.is_held(),
            is_leased: service.holder().is_some(),
            counts: bench.counters.read(),
            first_fault: bench.first_fault,
            probe: bench.latch,
            capabilities: bench.capabilities,
        }
    }

    fn settings(&self) -> Settings {
        *self.service.settings()
    }

    fn set(&mut self, settings: Settings) -> Result<Passed, Refusal> {
        let Self { service, bench, .. } = self;
        let seen = bench.seen;
        let passed = service.set_all(settings, &seen, bench);
        if let Ok(Passed::OnItsWay(ticket)) = passed {
            self.asked = Some((ticket, None));
        }
        passed
    }

    fn outcome(&mut self, ticket: Ticket) -> Option<Result<(), Refusal>> {
        let (asked, outcome) = self.asked?;
        outcome.filter(|_| asked == ticket)
    }

    fn save(&mut self) -> Result<(), Refusal> {
        let Self { service, bench, .. } = self;
        bench.save_parameters(service.settings())
    }
}

impl<F: NorFlash> Bench<F> {
    pub(super) fn latch_of(&self, report: &Report, touch: &Touch) -> ProbeLatch {
        let mm = self.scale.mm_from_counts(touch.position.to_num());
        ProbeLatch {
            count: report.touches,
            position_nm: libm::round(mm * 1e6) as i64,
        }
    }
}
