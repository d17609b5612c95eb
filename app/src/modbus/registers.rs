//! Registers that tell how the axis stands: one table, from which the line is answered and the page is made.

use super::bits::status;
use super::{ParameterList, View, Words};

/// Version of the map: raised by every change after which an old master could misunderstand a new axis. New registers
/// are appended without it.
pub const VERSION: u16 = 1;

/// What came over the line.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LineCounts {
    /// Frames to this unit; wraps.
    pub taken: u32,
    /// Bytes that belonged to no frame; wraps.
    pub dropped: u32,
}

/// All that registers tell of.
#[derive(Clone, Copy, Debug)]
pub struct Scene {
    /// The axis.
    pub view: View,
    /// Its parameters.
    pub list: ParameterList,
    /// The line.
    pub counts: LineCounts,
    /// Number of the refusal of the last write, 0 for none.
    pub last_refusal: u16,
}

/// A value in one register or several.
#[derive(Clone, Copy, Debug)]
pub struct Register {
    /// Address of its first register, from 0.
    pub address: u16,
    /// Its name.
    pub name: &'static str,
    /// Its type.
    pub kind: &'static str,
    /// How many registers it takes.
    pub count: u16,
    /// Its unit.
    pub unit: &'static str,
    /// What it is.
    pub what: &'static str,
    /// Reads it.
    pub get: fn(&Scene) -> Words,
}

macro_rules! registers {
    ($($address:literal $name:ident: $kind:ident, $unit:literal, $what:literal, $get:expr;)*) => {
        /// All registers of the status, in order and without a gap. None is used anew for something else.
        pub const REGISTERS: &[Register] = &[$(Register {
            address: $address,
            name: stringify!($name),
            kind: stringify!($kind),
            count: (size_of::<$kind>() / 2) as u16,
            unit: $unit,
            what: $what,
            get: |scene| {
                let get: fn(&Scene) -> $kind = $get;
                Words::of(&get(scene).to_be_bytes())
            },
        },)*];
    };
}

registers! {
    0 map_version: u16, "", "Version of this map.", |_| VERSION;
    1 status: u16, "bits", "Bits of the status, as the discrete inputs 0 to 15.", |scene| status(&scene.view);
    2 state: u16, "", "Number of the state: 0 Disabled, 1 Enabling, 2 Ready, 3 Moving, 4 Stopping, 5 Fault.",
        |scene| scene.view.seen.state as u16;
    3 fault: u16, "", "Number of the fault that is latched, 0 for none: see [faults](faults.md).",
        |scene| scene.view.seen.fault.map_or(0, |fault| fault as u16);
    4 warnings: u32, "bits", "Bit n: the warning of number n stands.", |scene| scene.view.seen.warnings;
    6 tick: u32, "ticks", "The last tick; wraps. It rises while the axis lives.", |scene| scene.view.seen.tick;
    8 position_nm: i64, "nm", "Where the axis is, from the origin.", |scene| scene.view.nm(scene.view.seen.reported);
    12 setpoint_nm: i64, "nm", "Where it should be, from the origin.",
        |scene| scene.view.coordinate_nm(scene.view.seen.commanded);
    16 velocity_um_per_min: i32, "µm/min", "How fast it is.",
        |scene| scene.view.um_per_min(scene.view.seen.velocity);
    18 following_error_nm: i32, "nm", "Setpoint less position.",
        |scene| scene.view.short_nm(scene.view.seen.following_error);
    20 position_mm: f32, "mm", "As `position_nm`, rounded to 24 bits: to 0.1 µm within 1 m.",
        |scene| mm(scene.view.nm(scene.view.seen.reported));
    22 setpoint_mm: f32, "mm", "As `setpoint_nm`, rounded.",
        |scene| mm(scene.view.coordinate_nm(scene.view.seen.commanded));
    24 velocity_mm_per_min: f32, "mm/min", "As `velocity_um_per_min`, rounded.",
        |scene| (f64::from(scene.view.um_per_min(scene.view.seen.velocity)) / 1e3) as f32;
    26 following_error_mm: f32, "mm", "As `following_error_nm`, rounded.",
        |scene| mm(i64::from(scene.view.short_nm(scene.view.seen.following_error)));
    28 position_um: i32, "µm", "As `position_nm`, rounded; at its end beyond 2.1 km.",
        |scene| um(scene.view.nm(scene.view.seen.reported));
    30 velocity_short: i16, "mm/min", "As `velocity_um_per_min`, rounded, at its end beyond ±32 767: for masters that know \
        single registers only.",
        |scene| short(um(i64::from(scene.view.um_per_min(scene.view.seen.velocity)))) ;
    31 following_error_short: i16, "µm", "As `following_error_nm`, rounded, at its end beyond ±32 767.",
        |scene| short(um(i64::from(scene.view.short_nm(scene.view.seen.following_error))));
    32 override_percent: u16, "%", "Feed override.", |scene| scene.view.percent;
    33 probe_count: u16, "", "Rises with each touch of the probe; wraps. 0 before the first.",
        |scene| scene.view.probe.map_or(0, |probe| probe.count);
    34 probe_nm: i64, "nm", "Position at the last touch of the probe, from the origin; 0 before the first.",
        |scene| scene.view.probe.map_or(0, |probe| probe.position_nm);
    38 probe_mm: f32, "mm", "As `probe_nm`, rounded.",
        |scene| mm(scene.view.probe.map_or(0, |probe| probe.position_nm));
    40 tick_hz: u32, "ticks/s", "Control rate, rounded.", |scene| libm::round(scene.view.scale.tick_hz()) as u32;
    42 late_ticks: u32, "ticks", "Ticks whose inputs were not there.", |scene| scene.view.counts.late;
    44 overlong_ticks: u32, "ticks", "Ticks that ended after their time.", |scene| scene.view.counts.overlong;
    46 lost_records: u32, "ticks", "Ticks that were not told of outside.", |scene| scene.view.counts.lost_records;
    48 fault_tick: u32, "ticks", "Tick of the fault. This and the following are 0 while none is latched.",
        |scene| scene.view.first_fault.map_or(0, |first| first.tick);
    50 fault_state: u16, "", "Number of the state before it.",
        |scene| scene.view.first_fault.map_or(0, |first| first.state as u16);
    51 reserved: u16, "", "0.", |_| 0;
    52 fault_later: u32, "bits", "Bit n: the fault of number n was found since.",
        |scene| scene.view.first_fault.map_or(0, |first| first.later.bits());
    54 fault_value: f64, "", "What was seen, in the unit that the page of faults states.",
        |scene| scene.view.first_fault.map_or(0.0, |first| first.trip.value.to_num());
    58 fault_limit: f64, "", "What is allowed.",
        |scene| scene.view.first_fault.map_or(0.0, |first| first.trip.limit.to_num());
    62 fault_position_nm: i64, "nm", "Where the axis was, from the origin and before the table of the screw.",
        |scene| scene.view.first_fault.map_or(0, |first| scene.view.coordinate_nm(first.context.position));
    66 fault_setpoint_nm: i64, "nm", "Where it should have been.",
        |scene| scene.view.first_fault.map_or(0, |first| scene.view.coordinate_nm(first.context.setpoint_position));
    70 fault_velocity_um_per_min: i32, "µm/min", "How fast it was.",
        |scene| scene.view.first_fault.map_or(0, |first| scene.view.um_per_min(first.context.velocity));
    72 fault_following_error_nm: i32, "nm", "Setpoint less position.", |scene| {
        let error = |context: leadscrew::supervisor::Context| context.following_error.to_bits();
        scene.view.first_fault.map_or(0, |first| scene.view.short_nm(error(first.context)))
    };
    74 fault_command: f32, "of ±10 V", "What was put out last.",
        |scene| scene.view.first_fault.map_or(0.0, |first| first.context.command.to_num());
    76 capabilities: u32, "bits", "What the axis can do: as in the hello of the link, see [wire format](wire-format.md).",
        |scene| scene.view.capabilities;
    78 parameter_list: u32, "", "CRC-32 of the names of all parameters: compare it before parameters are written.",
        |scene| scene.list.checksum;
    80 parameter_count: u16, "", "How many parameters there are.", |scene| scene.list.count;
    81 last_refusal: u16, "", "Number of the refusal of the last write, 0 if it was taken: see [wire format](wire-format.md).",
        |scene| scene.last_refusal;
    82 line_frames: u32, "frames", "Frames to this unit, this one included; wraps.", |scene| scene.counts.taken;
    84 line_dropped: u32, "bytes", "Bytes that belonged to no frame; wraps.", |scene| scene.counts.dropped;
}

/// The value that the register at `address` belongs to.
#[must_use]
pub fn register_at(address: u16) -> Option<&'static Register> {
    let behind = REGISTERS.partition_point(|register| register.address <= address);
    let register = REGISTERS.get(behind.checked_sub(1)?)?;
    (address - register.address < register.count).then_some(register)
}

fn mm(nm: i64) -> f32 {
    (nm as f64 / 1e6) as f32
}

/// Thousandths, saturated: nm in µm, µm/min in mm/min.
fn um(nm: i64) -> i32 {
    libm::round(nm as f64 / 1e3) as i32
}

fn short(value: i32) -> i16 {
    value.clamp(i32::from(i16::MIN), i32::from(i16::MAX)) as i16
}
