//! A NOR flash in memory: writing clears bits, erasing sets a sector's; the power may be cut in any operation.

use embedded_storage::nor_flash::{
    ErrorType, NorFlash, NorFlashError, NorFlashErrorKind, ReadNorFlash,
};

/// What the operation in which the power is cut leaves behind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Torn {
    /// Nothing of it happened.
    Nothing,
    /// Its front half happened.
    Front,
    /// Its back half happened.
    Back,
    /// Any of its bits happened, others did not.
    Noise,
    /// An erasure clears all bits before it sets them: it came that far. A write happened.
    Cleared,
}

impl Torn {
    pub const ALL: [Self; 5] = [
        Self::Nothing,
        Self::Front,
        Self::Back,
        Self::Noise,
        Self::Cleared,
    ];
}

/// The power is cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PowerCut;

impl NorFlashError for PowerCut {
    fn kind(&self) -> NorFlashErrorKind {
        NorFlashErrorKind::Other
    }
}

/// Sectors of `SECTOR` bytes, written in words of `WORD` bytes: each once, and once more with zeros, as flash with
/// checksums of its own allows.
#[derive(Clone)]
pub struct SimFlash<const SECTOR: usize, const WORD: usize> {
    pub cells: Vec<u8>,
    /// Words written and sectors erased.
    pub operations: u32,
    /// Erasures of each sector.
    pub erasures: Vec<u32>,
    cut: Option<(u32, Torn)>,
    is_off: bool,
    seed: u64,
}

impl<const SECTOR: usize, const WORD: usize> SimFlash<SECTOR, WORD> {
    pub fn new(sectors: usize) -> Self {
        Self {
            cells: vec![0xFF; sectors * SECTOR],
            operations: 0,
            erasures: vec![0; sectors],
            cut: None,
            is_off: false,
            seed: 1,
        }
    }

    /// The same cells with the power on; it will be cut in that operation from now.
    pub fn powered(&self, cut: Option<(u32, Torn)>) -> Self {
        Self {
            operations: 0,
            cut,
            is_off: false,
            seed: cut.map_or(1, |(at, _)| u64::from(at) + 1),
            ..self.clone()
        }
    }

    fn noise(&mut self) -> u8 {
        self.seed ^= self.seed << 13;
        self.seed ^= self.seed >> 7;
        self.seed ^= self.seed << 17;
        (self.seed >> 32) as u8
    }

    /// Brings `place` to `new`, or as far as the power lasts.
    fn operate(&mut self, place: usize, new: &[u8]) -> Result<(), PowerCut> {
        if self.is_off {
            return Err(PowerCut);
        }
        let torn = self.cut.filter(|(at, _)| *at == self.operations);
        self.operations += 1;
        let half = new.len() / 2;
        for (at, byte) in new.iter().enumerate() {
            let noise = self.noise();
            let cell = &mut self.cells[place + at];
            *cell = match torn.map(|(_, torn)| torn) {
                None => *byte,
                Some(Torn::Nothing) => *cell,
                Some(Torn::Front) if at < half => *byte,
                Some(Torn::Back) if at >= half => *byte,
                Some(Torn::Front | Torn::Back) => *cell,
                Some(Torn::Noise) => *cell & noise | *byte & !noise,
                Some(Torn::Cleared) if new.len() == SECTOR => 0,
                Some(Torn::Cleared) => *byte,
            };
        }
        self.is_off = torn.is_some();
        if self.is_off { Err(PowerCut) } else { Ok(()) }
    }
}

impl<const SECTOR: usize, const WORD: usize> ErrorType for SimFlash<SECTOR, WORD> {
    type Error = PowerCut;
}

impl<const SECTOR: usize, const WORD: usize> ReadNorFlash for SimFlash<SECTOR, WORD> {
    const READ_SIZE: usize = 1;

    fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), PowerCut> {
        if self.is_off {
            return Err(PowerCut);
        }
        bytes.copy_from_slice(&self.cells[offset as usize..][..bytes.len()]);
        Ok(())
    }

    fn capacity(&self) -> usize {
        self.cells.len()
    }
}

impl<const SECTOR: usize, const WORD: usize> NorFlash for SimFlash<SECTOR, WORD> {
    const WRITE_SIZE: usize = WORD;
    const ERASE_SIZE: usize = SECTOR;

    fn erase(&mut self, from: u32, to: u32) -> Result<(), PowerCut> {
        let (from, to) = (from as usize, to as usize);
        assert!(from.is_multiple_of(SECTOR) && to.is_multiple_of(SECTOR));
        for sector in from / SECTOR..to / SECTOR {
            self.erasures[sector] += u32::from(!self.is_off);
            self.operate(sector * SECTOR, &[0xFF; SECTOR])?;
        }
        Ok(())
    }

    fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), PowerCut> {
        let offset = offset as usize;
        assert!(offset.is_multiple_of(WORD) && bytes.len().is_multiple_of(WORD));
        for (at, word) in bytes.chunks(WORD).enumerate() {
            let place = offset + at * WORD;
            let is_blank = self.cells[place..][..WORD].iter().all(|cell| *cell == 0xFF);
            let is_zeros = word.iter().all(|byte| *byte == 0);
            assert!(
                is_blank || is_zeros || self.is_off,
                "the word at {place} is written twice"
            );
            self.operate(place, word)?;
        }
        Ok(())
    }
}
