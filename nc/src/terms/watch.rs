//! What terms came to: the largest K of each over a program, for a report.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use super::{Circumstances, Region, Shape, Steepness, Term, TermError, Terms};
use crate::coordinates::{AXES, Axis, AxisSet, Coordinates};

/// Largest |K| of a term so far, an axis each.
#[derive(Clone, Debug)]
pub struct Largest {
    name: String,
    /// Bits of numbers that are not negative, which compare as the numbers do.
    bits: Arc<[AtomicU64; AXES]>,
}

impl Largest {
    /// The term's name.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Largest |K| on each axis, mm or degrees.
    #[must_use]
    pub fn values(&self) -> Coordinates {
        Axis::ALL
            .into_iter()
            .map(|axis| {
                let bits = self.bits[axis.index()].load(Ordering::Relaxed);
                (axis, f64::from_bits(bits))
            })
            .collect()
    }
}

#[derive(Debug)]
struct Watched {
    term: Box<dyn Term>,
    largest: Largest,
}

impl Terms {
    /// The same terms, each watched: wherever K is asked for, also between the ends of a movement that may have to be split.
    #[must_use]
    pub fn watched(self) -> (Self, Vec<Largest>) {
        let mut all = Vec::new();
        let mut terms = Self::none();
        for term in self.list {
            let largest = Largest {
                name: term.name().to_owned(),
                bits: Arc::default(),
            };
            all.push(largest.clone());
            terms.push(Box::new(Watched { term, largest }));
        }
        (terms, all)
    }
}

impl Term for Watched {
    fn name(&self) -> &str {
        self.term.name()
    }

    fn correction(&self, at: &Coordinates, with: &Circumstances) -> Result<Coordinates, TermError> {
        let k = self.term.correction(at, with)?;
        for (axis, value) in k.iter() {
            let bits = value.abs().to_bits();
            let largest = &self.largest.bits[axis.index()];
            if bits > 0 && bits > largest.load(Ordering::Relaxed) {
                largest.fetch_max(bits, Ordering::Relaxed);
            }
        }
        Ok(k)
    }

    fn corrects(&self) -> AxisSet {
        self.term.corrects()
    }

    fn depends_on(&self) -> AxisSet {
        self.term.depends_on()
    }

    fn depends_on_approach_of(&self) -> AxisSet {
        self.term.depends_on_approach_of()
    }

    fn depends_on_tool(&self) -> bool {
        self.term.depends_on_tool()
    }

    fn shape(&self) -> Shape {
        self.term.shape()
    }

    fn breaks(&self, axis: Axis, found: &mut dyn FnMut(&[f64])) {
        self.term.breaks(axis, found);
    }

    fn steepness(&self, within: &Region) -> Steepness {
        self.term.steepness(within)
    }
}
