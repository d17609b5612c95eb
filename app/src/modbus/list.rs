//! Which parameters there are, in a number.

use leadscrew::parameter_table::ParameterTable;
use leadscrew::params::{AxisParams, SectionVisitor};

use crc::{CRC_32_ISO_HDLC, Crc, Digest, NoTable};

const CRC: Crc<u32, NoTable> = Crc::<u32, NoTable>::new(&CRC_32_ISO_HDLC);

/// The list of parameters, as far as their places go. Firmware with another list has parameters at other registers; a
/// master compares the checksum before it writes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ParameterList {
    /// How many there are.
    pub count: u16,
    /// CRC-32 (that of zip) of `section.name` of each with a line feed behind, in order.
    pub checksum: u32,
}

struct Names<'c> {
    count: u16,
    digest: Digest<'c, u32, NoTable>,
}

impl SectionVisitor for Names<'_> {
    fn section<T: ParameterTable>(&mut self, section: &'static str, _: &mut T) {
        for field in T::FIELDS {
            for part in [section, ".", field.name, "\n"] {
                self.digest.update(part.as_bytes());
            }
            self.count = self.count.saturating_add(1);
        }
    }
}

impl ParameterList {
    /// The list of `params`.
    #[must_use]
    pub fn of(params: &AxisParams) -> Self {
        let mut names = Names {
            count: 0,
            digest: CRC.digest(),
        };
        let mut params = *params;
        params.visit_sections(&mut names);
        Self {
            count: names.count,
            checksum: names.digest.finalize(),
        }
    }
}
