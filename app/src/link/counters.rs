//! What the axis counted, and its fault, as the link tells of them.

use embedded_storage::nor_flash::NorFlash;
use leadscrew::probe::{Report, Touch};
use leadscrew::protocol::reply::Reply;
use leadscrew::supervisor::FirstFault;
use leadscrew::units::Position;

use super::bench::Bench;
use crate::safe_state::reason::Reason;

impl<F: NorFlash> Bench<F> {
    pub fn fault_page(&self) -> Reply<'static> {
        let Some(first) = &self.first_fault else {
            return Reply::Fault {
                tick: self.seen.tick,
                fault: self.seen.fault.map_or(0, |fault| fault as u8),
                state: self.seen.state as u8,
                value: 0,
                limit: 0,
                later: 0,
                position: 0,
                velocity: 0,
                setpoint_position: 0,
                setpoint_velocity: 0,
                following_error: 0,
                command: 0,
            };
        };
        let FirstFault {
            trip,
            tick,
            state,
            context,
            later,
        } = first;
        Reply::Fault {
            tick: *tick,
            fault: trip.fault as u8,
            state: *state as u8,
            value: trip.value.to_bits(),
            limit: trip.limit.to_bits(),
            later: later.bits(),
            position: context.position.to_bits(),
            velocity: context.velocity.to_bits(),
            setpoint_position: context.setpoint_position.to_bits(),
            setpoint_velocity: context.setpoint_velocity.to_bits(),
            following_error: context.following_error.to_bits(),
            command: context.command.to_bits(),
        }
    }

    pub fn touch(&self) -> Reply<'static> {
        let Report {
            touches,
            ends,
            end,
            touch,
            glitches,
        } = self.probe;
        let mm = |position: Position| self.scale.mm_from_counts(position.to_num());
        let nm = |position| libm::round(mm(position) * 1e6) as i64;
        let sigma = |touch: Touch| {
            let counts = libm::sqrt(touch.variance.to_num());
            libm::round(self.scale.mm_from_counts(counts) * 1e9) as u32
        };
        let feed = |touch: Touch| self.scale.feed_from_velocity(touch.velocity.to_num());
        Reply::Touch {
            tick: self.seen.tick,
            ends,
            touches,
            glitches,
            end: end.map_or(0, |end| end as u8),
            has_touch: touch.is_some(),
            position_nm: touch.map_or(0, |touch| nm(touch.position)),
            sigma_pm: touch.map_or(0, sigma),
            raw: touch.map_or(0, |touch| touch.raw.to_bits()),
            velocity_um_per_min: touch.map_or(0, |touch| libm::round(feed(touch) * 1e3) as i32),
            touch_tick: touch.map_or(0, |touch| touch.tick),
            time: touch.map_or(0, |touch| touch.time),
            overtravel_nm: touch.map_or(0, |touch| nm(touch.overtravel)),
            edges: touch.map_or(0, |touch| touch.edges),
        }
    }

    pub fn last_reset(&self) -> Reply<'_> {
        let (mut place, mut origin, mut file) = (0, 0, "");
        let [mut cfsr, mut hfsr, mut address] = [0; 3];
        match &self.reset.reason {
            Some(Reason::Panic(panic)) => {
                (place, origin, file) = (panic.line, panic.hash, panic.file());
            }
            Some(Reason::HardFault(fault)) => {
                (place, origin) = (fault.pc, fault.lr);
                [cfsr, hfsr, address] = [fault.cfsr, fault.hfsr, fault.address];
            }
            Some(Reason::LateTicks { tick }) => place = *tick,
            Some(Reason::Watchdog | Reason::StackOverflow) | None => {}
        }
        Reply::Reset {
            reason: self.reset.reason.as_ref().map_or(0, Reason::number),
            resets: self.reset.resets,
            place,
            origin,
            cfsr,
            hfsr,
            address,
            file,
        }
    }

    pub fn counts(&self) -> Reply<'static> {
        let counts = self.counters.read();
        let indexes = self.report.indexes;
        Reply::Counters {
            ticks: counts.ticks,
            late: counts.late,
            overlong: counts.overlong,
            lost_records: counts.lost_records,
            worst_start: counts.worst_start,
            worst_end: counts.worst_end,
            indexes: indexes.number,
            index_count: indexes.count,
            index_distance: indexes.distance,
        }
    }
}
