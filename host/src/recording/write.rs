//! Writes a recording as VCD.

use std::io::{self, Write};

use ::vcd::{TimescaleUnit, Value, Writer};

use super::{Levels, Recording};

/// Timescales of VCD from the coarsest on: powers of ten with the unit that they are told in.
const UNITS: [TimescaleUnit; 6] = [
    TimescaleUnit::S,
    TimescaleUnit::MS,
    TimescaleUnit::US,
    TimescaleUnit::NS,
    TimescaleUnit::PS,
    TimescaleUnit::FS,
];

impl Recording {
    /// Writes it as VCD with the signals A, B and Z.
    ///
    /// # Errors
    /// The writer's; a clock that is no power of ten, which VCD cannot tell.
    pub fn write_vcd(&self, out: impl Write) -> io::Result<()> {
        let mut writer = Writer::new(out);
        let (number, unit) = timescale(self.clock_hz)
            .ok_or_else(|| io::Error::other("VCD tells times in powers of ten of a second only"))?;
        writer.timescale(number, unit)?;
        writer.add_module("encoder")?;
        let mut signals = Vec::new();
        for name in ["A", "B", "Z"] {
            signals.push(writer.add_wire(1, name)?);
        }
        writer.upscope()?;
        writer.enddefinitions()?;
        let start = super::Change {
            time: 0,
            levels: self.initial,
        };
        let mut before = None;
        for change in std::iter::once(&start).chain(&self.changes) {
            writer.timestamp(change.time)?;
            let old = before.map(bits);
            for (index, (&signal, level)) in signals.iter().zip(bits(change.levels)).enumerate() {
                if old.is_none_or(|old| old[index] != level) {
                    writer.change_scalar(signal, if level { Value::V1 } else { Value::V0 })?;
                }
            }
            before = Some(change.levels);
        }
        writer.timestamp(self.duration)?;
        writer.flush()
    }
}

const fn bits(levels: Levels) -> [bool; 3] {
    [levels.a, levels.b, levels.z]
}

/// One, ten or a hundred of a unit.
fn timescale(clock_hz: u64) -> Option<(u32, TimescaleUnit)> {
    let decade = clock_hz.checked_ilog10()?;
    let unit = decade.div_ceil(3);
    let exact = 10_u64.checked_pow(decade)? == clock_hz;
    let unit_name = *UNITS.get(unit as usize)?;
    exact.then(|| (10_u32.pow(3 * unit - decade), unit_name))
}
