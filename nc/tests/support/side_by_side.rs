//! A program and what the corrector makes of it, run side by side by two controls: every block ends at its target plus K, and on
//! feeds the way to it stays within the tolerance of the true one.

use leadscrew_nc::coordinates::Coordinates;
use leadscrew_nc::corrector::{Corrector, Refusal};
use leadscrew_nc::terms::{Circumstances, Terms};

use super::control::{Control, Event, LINEAR, Stop};
use super::motion::Motion;
use super::polyline::strays;

/// Two controls and the corrector between them.
pub struct SideBySide {
    /// The same terms as the corrector has.
    pub terms: Terms,
    /// The control that runs what the program says.
    pub meant: Control,
    /// The control that runs what was written.
    pub real: Control,
    pub corrector: Corrector,
    /// Of the corrector, mm.
    pub tolerance_mm: f64,
    /// Step of the words, mm: in mm and in inches.
    pub steps_mm: [f64; 2],
}

/// What became of a block.
#[derive(Debug)]
pub enum Outcome {
    /// Both controls ran it, and it was compared.
    Compared,
    /// The corrector refused it.
    Refused(Refusal),
    /// The simple control does not know it.
    Unknown(String),
}

impl SideBySide {
    /// Runs a block, without its end, through both.
    pub fn run(&mut self, block: &str) -> Outcome {
        let (meant_at, real_at) = (self.meant.machine, self.real.machine);
        let wanted = self.meant.run(block);
        let mut out = Vec::new();
        if let Err(refusal) = self
            .corrector
            .block(format!("{block}\n").as_bytes(), &mut out)
        {
            assert!(out.is_empty(), "{block}: refused, and written all the same");
            return Outcome::Refused(refusal);
        }
        let out = String::from_utf8(out).unwrap();
        let wanted = match wanted {
            Ok(wanted) => wanted,
            Err(Stop::Unknown(what)) => return Outcome::Unknown(what),
            Err(Stop::NoArc(what)) => return Outcome::Unknown(what),
        };
        let mut written = Vec::new();
        let mut got = Event::Nothing;
        for line in out.lines() {
            let event = self.real.run(line);
            let event = event.unwrap_or_else(|stop| panic!("{block} -> {out}{line}: {stop:?}"));
            if let Event::Moved(motion) = &event {
                written.push(motion.clone());
            }
            if event != Event::Nothing {
                got = event;
            }
        }
        match (&wanted, &got) {
            (Event::Nothing, Event::Nothing) => {}
            (Event::Moved(wanted), Event::Moved(got)) => {
                self.ends_at(&wanted.to, &got.to, block, &out);
                let stood = self.is_near(&self.with_k(&meant_at), &real_at);
                if wanted.is_feed && stood {
                    self.keeps_to(wanted, &written, block, &out);
                }
            }
            (Event::Hole(wanted), Event::Hole(got)) => self.ends_at(wanted, got, block, &out),
            (wanted, got) => panic!("{block} -> {out}: {wanted:?} but {got:?}"),
        }
        Outcome::Compared
    }

    fn with_k(&self, place: &Coordinates) -> Coordinates {
        let k = self.terms.correction(place, &Circumstances::default());
        *place + k.unwrap()
    }

    /// Half a step of the words of an axis, mm, and some rounding of the sums.
    fn half_step(&self, axis: usize) -> f64 {
        let step = self.steps_mm[usize::from(self.meant.is_inches())];
        let share = self.meant.unit(axis) / self.meant.centre_unit();
        0.5001 * step * share + 1e-9
    }

    fn is_near(&self, wanted: &Coordinates, got: &Coordinates) -> bool {
        (0..3).all(|axis| {
            let off = wanted[LINEAR[axis]] - got[LINEAR[axis]];
            off.abs() <= self.half_step(axis)
        })
    }

    fn ends_at(&self, wanted: &Coordinates, got: &Coordinates, block: &str, out: &str) {
        let wanted = self.with_k(wanted);
        assert!(
            self.is_near(&wanted, got),
            "{block} -> {out}should end at {wanted:?}, not {got:?}"
        );
    }

    /// Every place of the true way is near the written one, and none of the written one away from the true.
    fn keeps_to(&self, meant: &Motion, written: &[Motion], block: &str, out: &str) {
        let truly: Vec<_> = meant.samples().iter().map(|at| self.with_k(at)).collect();
        let written: Vec<_> = written.iter().flat_map(Motion::samples).collect();
        // Half a step on three axes at the ends, twice that of a centre; and what the lines between samples leave out.
        let step = self.steps_mm[usize::from(self.meant.is_inches())];
        let bound = self.tolerance_mm + 3.0 * step + 2e-4;
        for (places, path) in [(&truly, &written), (&written, &truly)] {
            let ahead = 20 + 4 * path.len() / places.len();
            if let Some((off, at)) = strays(places, path, bound, ahead) {
                panic!("{block} -> {out}{off} mm off at {at:?}");
            }
        }
    }
}
