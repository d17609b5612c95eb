//! What an axis answers. Numbers are only ever appended, and a message never changes.

use super::describe::messages;

/// The axis is enabled.
pub const ENABLED: u16 = 1;
/// A motion is commanded.
pub const MOVING: u16 = 1 << 1;
/// The origin is known.
pub const HOMED: u16 = 1 << 2;
/// A feed hold is on.
pub const HELD: u16 = 1 << 3;
/// Somebody holds the control lease.
pub const LEASED: u16 = 1 << 4;
/// It is this session that holds it.
pub const LEASED_HERE: u16 = 1 << 5;
/// Planned moves are what moves the axis, or may.
pub const PLANNED: u16 = 1 << 6;
/// Parameters were set since they were saved, or since the axis was switched on.
pub const UNSAVED: u16 = 1 << 7;

/// The axis can be homed.
pub const CAN_HOME: u32 = 1;
/// Parameters can be read and set.
pub const CAN_SET: u32 = 1 << 1;
/// Records can be subscribed to.
pub const CAN_RECORD: u32 = 1 << 2;
/// What is set can be saved.
pub const CAN_SAVE: u32 = 1 << 3;
/// Experiments can be run.
pub const CAN_EXPERIMENT: u32 = 1 << 4;
/// There is a scope, and signals can be streamed.
pub const CAN_SCOPE: u32 = 1 << 5;
/// The encoder can be learned.
pub const CAN_LEARN: u32 = 1 << 6;
/// There is an input for a touch probe.
pub const CAN_PROBE: u32 = 1 << 7;

messages! {
    /// A reply.
    pub enum Reply<'a> {
        /// It was done, or is under way.
        Ack = 0 {
            /// The last tick.
            tick: u32,
        }
        /// It was not done, and the axis goes on as it was.
        Refused = 1 {
            /// The last tick.
            tick: u32,
            /// Number of the [`Refusal`](super::refusal::Refusal).
            reason: u16,
        }
        /// What the axis is.
        Hello = 2 {
            /// Version of the protocol that the axis speaks.
            protocol: u16,
            /// The nonce of the request.
            nonce: u32,
            /// The session that is open now.
            session: u32,
            /// Control rate, ticks a second, rounded.
            tick_hz: u32,
            /// How long the control lease lasts, ticks.
            lease_ticks: u32,
            /// The last tick.
            tick: u32,
            /// What it can do: bit 0 homing, 1 parameters, 2 telemetry records, 3 store, 4 experiments, 5 scope and stream,
            /// 6 map learning, 7 probing; other bits are of later versions.
            capabilities: u32,
            /// Room for what is recorded, bytes.
            work_memory: u32,
            /// Version of the firmware.
            firmware: &'a str,
            /// What it was built from.
            build: &'a str,
            /// What it runs on.
            board: &'a str,
        }
        /// How the axis stands.
        Status = 3 {
            /// The last tick.
            tick: u32,
            /// Number of the [`State`](crate::supervisor::State).
            state: u8,
            /// Number of the [`Fault`](crate::supervisor::Fault), 0 for none.
            fault: u8,
            /// Bit n: the warning of number n.
            warnings: u32,
            /// Bit 0 enabled, 1 moving, 2 homed, 3 feed hold, 4 leased, 5 leased by this session, 6 moved by plans, 7 parameters not saved.
            flags: u16,
            /// Feed override, %.
            percent: u16,
            /// Where the axis is, nm from the origin.
            position_nm: i64,
            /// Where it should be, nm from the origin.
            setpoint_nm: i64,
            /// How fast it is, µm/min.
            velocity_um_per_min: i32,
            /// Setpoint less position, nm.
            following_error_nm: i32,
        }
        /// What the axis dropped of this link since it was switched on.
        Link = 4 {
            /// Frames whose stuffing was wrong.
            torn: u32,
            /// Frames too long.
            too_long: u32,
            /// Frames too short.
            too_short: u32,
            /// Frames with a wrong checksum.
            checksum: u32,
            /// Messages not known.
            unknown: u32,
            /// Requests that came twice or too late.
            late: u32,
            /// Records that found no room on their way out.
            records_lost: u32,
        }
        /// A parameter.
        Parameter = 5 {
            /// Its place in the list.
            index: u16,
            /// How many there are.
            count: u16,
            /// Its section.
            section: &'a str,
            /// Its name, unit included.
            name: &'a str,
            /// Its unit, for people.
            unit: &'a str,
            /// Its value.
            value: f64,
            /// Smallest value allowed.
            min: f64,
            /// Largest value allowed.
            max: f64,
            /// What it is if nobody sets it.
            default: f64,
        }
        /// A parameter that is one of a few words.
        Word = 6 {
            /// Its place in the list.
            index: u16,
            /// How many there are.
            count: u16,
            /// Its section; empty where it has none.
            section: &'a str,
            /// Its name.
            name: &'a str,
            /// Its value.
            word: &'a str,
            /// Which of the words it is, from 0.
            at: u8,
            /// How many words there are; a request for the same parameter with another word is refused with them all.
            words: u8,
        }
        /// A fault with its context.
        Fault = 7 {
            /// Tick in which it was found.
            tick: u32,
            /// Its number; 0: none is latched.
            fault: u8,
            /// Number of the [`State`](crate::supervisor::State) before.
            state: u8,
            /// What was seen, 2⁻¹⁶ of the unit that the table of faults states.
            value: i64,
            /// What is allowed.
            limit: i64,
            /// Bit n: the fault of number n came later.
            later: u32,
            /// Where the axis was by the encoder, 2⁻¹⁶ d.
            position: i64,
            /// How fast it was, 2⁻²⁰ d/tick.
            velocity: i32,
            /// Where it should have been, 2⁻¹⁶ d.
            setpoint_position: i64,
            /// How fast it should have been, 2⁻²⁰ d/tick.
            setpoint_velocity: i32,
            /// Setpoint less position, 2⁻¹⁶ d.
            following_error: i32,
            /// What was put out, 2⁻³⁰ of full command.
            command: i32,
        }
        /// What the tick counted since it was switched on.
        Counters = 8 {
            /// Ticks.
            ticks: u32,
            /// Ticks that did not run, or whose inputs came late.
            late: u32,
            /// Ticks that took too long.
            overlong: u32,
            /// Records that found the queue to the link full.
            lost_records: u32,
            /// Latest start of a tick, clocks of its timer.
            worst_start: u32,
            /// Latest end of a tick, clocks of its timer.
            worst_end: u32,
            /// Indexes of the encoder; wraps.
            indexes: u32,
            /// Count at the last index.
            index_count: i64,
            /// Counts from the index before it, along the way that was gone.
            index_distance: i64,
        }
        /// What is saved of a kind.
        Stored = 9 {
            /// As in the request.
            kind: u8,
            /// Version of its format.
            version: u16,
            /// Its length, bytes; 0: nothing is saved.
            length: u32,
            /// Its checksum.
            crc: u32,
        }
        /// Bytes of what is saved.
        Bytes = 10 {
            /// Where they begin.
            offset: u32,
            /// The bytes; fewer than asked for only at the end.
            bytes: &'a [u8],
        }
        /// How the experiment stands.
        Experiment = 11 {
            /// The last tick.
            tick: u32,
            /// 0 none, 1 runs, 2 complete, 3 left its window, 4 too fast, 5 too long, 6 ended from outside, 7 not permitted.
            ending: u8,
            /// Segment under way.
            segment: u8,
            /// Ticks since it began.
            ticks: u32,
            /// Records in the work memory.
            records: u32,
            /// There was no room for a record, or a tick was lost on the way.
            is_torn: bool,
            /// Count now.
            count: i64,
        }
        /// Words of the work memory.
        Words = 12 {
            /// Where they begin.
            offset: u32,
            /// The words, 4 bytes each, the low one first.
            bytes: &'a [u8],
        }
        /// How the scope stands.
        Scope = 13 {
            /// 0 not armed, 1 waits for its trigger, 2 triggered, 3 complete, 4 ended before it was.
            phase: u8,
            /// Numbers of the signals.
            signals: &'a [u8],
            /// Ticks a sample.
            every: u16,
            /// Samples that there are to be read; 0 before the end.
            samples: u32,
            /// The sample at the trigger; none if it was ended before that.
            trigger: Option<u32>,
            /// Tick of the first sample.
            tick: u32,
            /// Whole value of each signal in the first sample.
            bases: [i64; crate::scope::MOST_SIGNALS],
            /// Places where ticks were missed, or a wide signal jumped.
            interruptions: [Option<crate::scope::Interrupted>; crate::scope::MOST_INTERRUPTIONS],
            /// There were more of them: before the last ones time and wide signals are not known.
            is_torn: bool,
        }
        /// Samples of the scope.
        Samples = 14 {
            /// The first of them.
            index: u32,
            /// The samples, signal by signal, 4 bytes each, the low one first.
            bytes: &'a [u8],
        }
        /// How the learning stands.
        Learning = 15 {
            /// 0 none, 1 between runs, 2 waits for the index, 3 measures the speed, 4 averages, 5 the run is complete and to be ended, 6 a map is
            /// there.
            phase: u8,
            /// Whole revolutions in the average.
            revolutions: u32,
            /// Runs that are complete.
            runs: u8,
            /// What the last run showed.
            last: Option<crate::calibration::RunSummary>,
            /// Why the last run was dropped, or no map made.
            refusal: Option<crate::calibration::Refusal>,
        }
        /// What was learned.
        Learned = 16 {
            /// The errors: what stays without a map, d rms.
            errors: crate::calibration::Bands,
            /// Where runs disagree most.
            disagreement: crate::calibration::Disagreement,
            /// Estimated errors of the map.
            residual: crate::calibration::Residual,
            /// Bytes of its image.
            length: u32,
        }
        /// Why the firmware was last started anew without being asked to, since the power came.
        Reset = 17 {
            /// 0 it was not, 1 panic, 2 hard fault, 3 watchdog, 4 watchdog after ticks that ended too late one after another, 5 the
            /// stack reached its end.
            reason: u8,
            /// Such starts since the power came.
            resets: u32,
            /// Of a panic the line, of a hard fault the address of the instruction, of late ticks the first one; else 0.
            place: u32,
            /// Of a panic the FNV-1a of the file's whole path, of a hard fault where it was called from; else 0.
            origin: u32,
            /// Of a hard fault its CFSR; else 0.
            cfsr: u32,
            /// Of a hard fault its HFSR; else 0.
            hfsr: u32,
            /// Of a hard fault the address of the access, if CFSR says that it is valid; else 0.
            address: u32,
            /// Of a panic the end of the file's path; else empty.
            file: &'a str,
        }
        /// What the probe came to since the axis was switched on.
        Touch = 18 {
            /// The last tick.
            tick: u32,
            /// Ends of probing, and touches that nobody sought; wraps.
            ends: u16,
            /// Touches; wraps.
            touches: u16,
            /// Edges of the probe that were none of a touch; wraps.
            glitches: u16,
            /// Number of the last [`ProbeEnd`](crate::probe::ProbeEnd); 0: none yet.
            end: u8,
            /// There was a touch in it, whose figures follow; else they are 0.
            has_touch: bool,
            /// Where the axis was at the contact, nm from the origin.
            position_nm: i64,
            /// 1σ of it by the encoder's edges and the trigger's jitter, pm.
            sigma_pm: u32,
            /// The place of the encoder's shaft, 2⁻¹⁶ d as it counts.
            raw: i64,
            /// Velocity at the contact, µm/min.
            velocity_um_per_min: i32,
            /// Tick that took the probe's edge in.
            touch_tick: u32,
            /// The edge by the timer, clocks since its first tick without wrap.
            time: i64,
            /// How far beyond the contact the axis went, nm.
            overtravel_nm: i64,
            /// Edges that the place was found from; 0: by the count alone.
            edges: u32,
        }
    }
}
