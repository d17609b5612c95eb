//! A control as simple as can be, to read programs again: apart from the code under test, on purpose. What it does not know it
//! says so.

use std::collections::BTreeMap;

use leadscrew_nc::coordinates::{Axis, Coordinates};
use leadscrew_nc::path::arc::Plane;

use super::motion::{Motion, Shape};
use super::plain_words::{Word, words};

/// X, Y, Z.
pub type Place = [f64; 3];

/// The three axes that it has.
pub const LINEAR: [Axis; 3] = [Axis::X, Axis::Y, Axis::Z];
/// Ends of an arc that are nearer than this are one place, mm.
const CLOSED_MM: f64 = 1e-6;

/// How it reads words.
#[derive(Clone, Copy, Debug)]
pub struct Reading {
    /// X and U are diameters, U, V and W are ways, G90 and G91 are unknown.
    pub lathe: bool,
    /// Numbers without a point are so many mm and so many inches.
    pub steps: Option<[f64; 2]>,
    /// How far radii at both ends of an arc may differ, mm.
    pub radius_tolerance_mm: f64,
}

/// What a block brings about.
#[derive(Clone, Debug, PartialEq)]
pub enum Event {
    /// Nothing moves.
    Nothing,
    /// The tool moves.
    Moved(Motion),
    /// A hole with its bottom there.
    Hole(Coordinates),
}

/// Why a block is not run.
#[derive(Clone, Debug, PartialEq)]
pub enum Stop {
    /// This control does not know what it is.
    Unknown(String),
    /// An arc that is none.
    NoArc(String),
}

/// Reads words, moves, and remembers offsets.
#[derive(Clone, Debug)]
pub struct Control {
    pub machine: Coordinates,
    reading: Reading,
    works: BTreeMap<u32, Place>,
    tools: BTreeMap<u32, Place>,
    work: u32,
    tool: u32,
    shift: Place,
    plane: Plane,
    inches: bool,
    incremental: bool,
    centre_absolute: bool,
    motion: Option<u32>,
    to_retract: bool,
    drill_z: f64,
    drill_r: f64,
}

impl Control {
    pub fn new(
        reading: Reading,
        works: BTreeMap<u32, Place>,
        tools: BTreeMap<u32, Place>,
        start: Coordinates,
    ) -> Self {
        Self {
            machine: start,
            reading,
            works,
            tools,
            work: 54,
            tool: 0,
            shift: [0.0; 3],
            plane: if reading.lathe { Plane::Zx } else { Plane::Xy },
            inches: false,
            incremental: false,
            centre_absolute: false,
            motion: None,
            to_retract: false,
            drill_z: f64::NAN,
            drill_r: f64::NAN,
        }
    }

    fn offset(&self, axis: usize) -> f64 {
        let tool = self.tools.get(&self.tool).map_or(0.0, |tool| tool[axis]);
        self.works[&self.work][axis] + self.shift[axis] + tool
    }

    /// mm of a unit of an axis.
    pub fn unit(&self, axis: usize) -> f64 {
        let unit = self.centre_unit();
        if axis == 0 && self.reading.lathe {
            unit / 2.0
        } else {
            unit
        }
    }

    /// mm of a unit of I, J, K and R.
    pub fn centre_unit(&self) -> f64 {
        if self.inches { 25.4 } else { 1.0 }
    }

    pub fn is_inches(&self) -> bool {
        self.inches
    }

    pub fn is_incremental(&self) -> bool {
        self.incremental
    }

    pub fn is_centre_absolute(&self) -> bool {
        self.centre_absolute
    }

    pub fn plane(&self) -> Plane {
        self.plane
    }

    /// The coordinates of the program, mm.
    pub fn program_mm(&self, axis: usize) -> f64 {
        self.machine[LINEAR[axis]] - self.offset(axis)
    }

    /// Runs a block, without its end.
    ///
    /// # Errors
    /// What it does not know; nothing is done then.
    pub fn run(&mut self, block: &str) -> Result<Event, Stop> {
        let words = words(block).ok_or_else(|| Stop::Unknown(block.to_owned()))?;
        let mut next = self.clone();
        let event = next.obey(&words)?;
        *self = next;
        Ok(event)
    }

    fn obey(&mut self, words: &[Word]) -> Result<Event, Stop> {
        let (mut shifts, mut stands, mut named) = (false, false, 0);
        for (letter, value, _) in words {
            match (letter, (value * 10.0).round() as i64) {
                ('G', g @ (0 | 10 | 20 | 30 | 810)) => {
                    self.motion = u32::try_from(g / 10).ok();
                    named += 1;
                }
                ('G', 800) => self.motion = None,
                ('G', 40) => stands = true,
                ('G', 170) => self.plane = Plane::Xy,
                ('G', 180) => self.plane = Plane::Zx,
                ('G', 190) => self.plane = Plane::Yz,
                ('G', 200) => self.inches = true,
                ('G', 210) => self.inches = false,
                ('G', 490) if !self.reading.lathe => self.tool = 0,
                ('G', g @ (540 | 550)) => self.work = (g / 10) as u32,
                ('G', g @ (900 | 910)) if !self.reading.lathe => self.incremental = g == 910,
                ('G', g @ (901 | 911)) if !self.reading.lathe => self.centre_absolute = g == 901,
                ('G', 980) if !self.reading.lathe => self.to_retract = false,
                ('G', 990) if !self.reading.lathe => self.to_retract = true,
                ('G', 920) if !self.reading.lathe => shifts = true,
                ('G', 921) if !self.reading.lathe => self.shift = [0.0; 3],
                ('H', h) if !self.reading.lathe && self.tools.contains_key(&((h / 10) as u32)) => {
                    self.tool = (h / 10) as u32;
                }
                ('G', 400 | 430 | 940) => {}
                ('X' | 'Y' | 'Z' | 'I' | 'J' | 'K' | 'R' | 'F' | 'N' | 'P' | 'S', _) => {}
                ('U' | 'V' | 'W', _) if self.reading.lathe => {}
                other => return unknown(format!("{other:?}")),
            }
        }
        let value = |letter: char| self.value(words, letter);
        let twice = |word: &Word| words.iter().filter(|other| other.0 == word.0).count() > 1;
        if words.iter().any(|word| word.0 != 'G' && twice(word)) || named > 1 {
            return unknown("words twice".into());
        }
        if stands || shifts {
            if named > 0 || (stands && value('P').is_none()) {
                return unknown("a dwell or a shift with something else".into());
            }
            if shifts {
                self.shift_here(words);
            }
            return Ok(Event::Nothing);
        }
        let (goal, moved) = self.goal(words);
        let has_centre = ['I', 'J', 'K']
            .iter()
            .any(|letter| value(*letter).is_some());
        match self.motion {
            Some(81) if moved => self.drill(goal, words),
            Some(motion @ (2 | 3)) if moved || has_centre => self.arc(motion == 2, goal, words),
            Some(motion @ (0 | 1)) if moved && !has_centre && value('R').is_none() => {
                Ok(self.go(motion == 1, goal, Shape::Line))
            }
            _ if !moved && !has_centre => Ok(Event::Nothing),
            _ => unknown("words without their movement".into()),
        }
    }

    /// What a word says, mm; X and U as radii.
    fn value(&self, words: &[Word], letter: char) -> Option<f64> {
        let (_, number, has_point) = words.iter().find(|word| word.0 == letter)?;
        let unit = match letter {
            'X' | 'U' => self.unit(0),
            _ => self.centre_unit(),
        };
        let step = match self.reading.steps {
            Some([mm, inch]) if !has_point => {
                if self.inches {
                    inch
                } else {
                    mm
                }
            }
            _ => 1.0,
        };
        Some(number * step * unit)
    }

    fn shift_here(&mut self, words: &[Word]) {
        for (axis, letter) in ['X', 'Y', 'Z'].into_iter().enumerate() {
            if let Some(said) = self.value(words, letter) {
                self.shift[axis] = 0.0;
                self.shift[axis] = self.program_mm(axis) - said;
            }
        }
    }

    /// Where the words of the axes lead, and whether there are any.
    fn goal(&self, words: &[Word]) -> (Coordinates, bool) {
        let (mut goal, mut moved) = (self.machine, false);
        for axis in 0..3 {
            if let Some(said) = self.value(words, ['X', 'Y', 'Z'][axis]) {
                moved = true;
                if self.incremental {
                    goal[LINEAR[axis]] += said;
                } else {
                    goal[LINEAR[axis]] = self.offset(axis) + said;
                }
            }
            if let Some(said) = self.value(words, ['U', 'V', 'W'][axis]) {
                moved = true;
                goal[LINEAR[axis]] += said;
            }
        }
        (goal, moved)
    }

    fn go(&mut self, is_feed: bool, to: Coordinates, shape: Shape) -> Event {
        let from = std::mem::replace(&mut self.machine, to);
        Event::Moved(Motion {
            is_feed,
            from,
            to,
            shape,
        })
    }

    fn drill(&mut self, over: Coordinates, words: &[Word]) -> Result<Event, Stop> {
        if self.incremental || self.plane != Plane::Xy || self.reading.lathe {
            return unknown("drilling by ways, or elsewhere than down".into());
        }
        self.drill_z = self.value(words, 'Z').unwrap_or(self.drill_z);
        self.drill_r = self.value(words, 'R').unwrap_or(self.drill_r);
        if self.drill_z.is_nan() || self.drill_r.is_nan() {
            return unknown("drilling without Z or R".into());
        }
        let bottom = over.with(Axis::Z, self.offset(2) + self.drill_z);
        let retract = self.offset(2) + self.drill_r;
        let height = if self.to_retract {
            retract
        } else {
            self.machine[Axis::Z].max(retract)
        };
        self.machine = over.with(Axis::Z, height);
        Ok(Event::Hole(bottom))
    }

    fn arc(&mut self, clockwise: bool, to: Coordinates, words: &[Word]) -> Result<Event, Stop> {
        let from = self.machine;
        let centre_words = ['I', 'J', 'K'].map(|letter| self.value(words, letter));
        let centre = match (self.value(words, 'R'), centre_words) {
            (Some(radius), [None, None, None]) => self.centre_of_radius(clockwise, &to, radius)?,
            (None, words) => {
                let mut centre = self.plane.of(&from);
                for (place, axis) in centre.iter_mut().zip(self.plane.axes()) {
                    let said = words[axis.index()];
                    *place = match (said, self.centre_absolute) {
                        (Some(said), true) => self.offset(axis.index()) + said,
                        (None, true) => return unknown("a centre by halves".into()),
                        (said, false) => *place + said.unwrap_or(0.0),
                    };
                }
                centre
            }
            _ => return unknown("R beside I, J, K".into()),
        };
        if words.iter().any(|word| word.0 == 'P') {
            return unknown("turns".into());
        }
        let radius = |place: &Coordinates| {
            let [x, y] = self.plane.of(place);
            (x - centre[0]).hypot(y - centre[1])
        };
        let (start, end) = (radius(&from), radius(&to));
        let is_arc = start > 0.0 && (start - end).abs() <= self.reading.radius_tolerance_mm;
        if !is_arc {
            return Err(Stop::NoArc(format!("radii {start} and {end}")));
        }
        let shape = Shape::arc(self.plane, &from, &to, centre, clockwise, CLOSED_MM);
        Ok(self.go(true, to, shape))
    }

    /// The centre that lies `radius` from both ends; of the two the one for less than half of a turn, if the radius is positive.
    fn centre_of_radius(
        &self,
        clockwise: bool,
        to: &Coordinates,
        radius: f64,
    ) -> Result<[f64; 2], Stop> {
        let [ax, ay] = self.plane.of(&self.machine);
        let [bx, by] = self.plane.of(to);
        let half = (bx - ax).hypot(by - ay) / 2.0;
        if half < CLOSED_MM || half > radius.abs() + self.reading.radius_tolerance_mm {
            return Err(Stop::NoArc(format!("R {radius} over {half}")));
        }
        let height = (radius * radius - half * half).max(0.0).sqrt();
        // Seen along the chord the centre of a short G3 lies to the left.
        let side = if clockwise == (radius > 0.0) {
            -1.0
        } else {
            1.0
        };
        let (ux, uy) = ((bx - ax) / (2.0 * half), (by - ay) / (2.0 * half));
        Ok([
            f64::midpoint(ax, bx) - side * height * uy,
            f64::midpoint(ay, by) + side * height * ux,
        ])
    }
}

fn unknown<T>(what: String) -> Result<T, Stop> {
    Err(Stop::Unknown(what))
}
