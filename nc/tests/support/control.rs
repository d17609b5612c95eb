//! A control as simple as can be, to read programs again: apart from the code under test, on purpose.

use std::collections::BTreeMap;

/// X, Y, Z.
pub type Place = [f64; 3];

/// What a block brings about.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Event {
    /// The tool stands there, machine coordinates; along an arc of this centre.
    Stand(Place, Option<[f64; 2]>),
    /// A hole with its bottom there.
    Hole(Place),
}

/// Reads words, moves, and remembers offsets.
#[derive(Clone, Debug)]
pub struct Control {
    /// X and U are diameters.
    pub diameter: bool,
    /// U, V and W are ways.
    pub ways_by_letter: bool,
    pub works: BTreeMap<u32, Place>,
    pub tools: BTreeMap<u32, Place>,
    pub machine: Place,
    work: u32,
    tool: u32,
    shift: Place,
    inches: bool,
    incremental: bool,
    motion: u32,
    to_retract: bool,
    drill_z: f64,
    drill_r: f64,
}

impl Control {
    pub fn new(works: BTreeMap<u32, Place>, tools: BTreeMap<u32, Place>) -> Self {
        Self {
            diameter: false,
            ways_by_letter: false,
            works,
            tools,
            machine: [0.0; 3],
            work: 54,
            tool: 0,
            shift: [0.0; 3],
            inches: false,
            incremental: false,
            motion: 0,
            to_retract: false,
            drill_z: 0.0,
            drill_r: 0.0,
        }
    }

    fn offset(&self, axis: usize) -> f64 {
        let tool = self.tools.get(&self.tool).map_or(0.0, |tool| tool[axis]);
        self.works[&self.work][axis] + self.shift[axis] + tool
    }

    /// mm of a unit of an axis.
    pub fn unit(&self, axis: usize) -> f64 {
        let unit = if self.inches { 25.4 } else { 1.0 };
        if axis == 0 && self.diameter {
            unit / 2.0
        } else {
            unit
        }
    }

    pub fn is_inches(&self) -> bool {
        self.inches
    }

    pub fn is_incremental(&self) -> bool {
        self.incremental
    }

    /// The coordinates of the program, in its units.
    pub fn program(&self, axis: usize) -> f64 {
        (self.machine[axis] - self.offset(axis)) / self.unit(axis)
    }

    /// Runs a block, without its end.
    pub fn run(&mut self, block: &str) -> Option<Event> {
        let words = words(block);
        let value = |letter: char| {
            words
                .iter()
                .find(|word| word.0 == letter)
                .map(|word| word.1)
        };
        let mut shifts = false;
        for (letter, value) in &words {
            match (letter, (value * 10.0).round() as u32) {
                ('G', g @ (0 | 10 | 20 | 30 | 810)) => self.motion = g / 10,
                ('G', 200) => self.inches = true,
                ('G', 210) => self.inches = false,
                ('G', 900) => self.incremental = false,
                ('G', 910) => self.incremental = true,
                ('G', g @ (540 | 550)) => self.work = g / 10,
                ('G', 980) => self.to_retract = false,
                ('G', 990) => self.to_retract = true,
                ('G', 920) => shifts = true,
                ('G', 921) => self.shift = [0.0; 3],
                ('G', 490) => self.tool = 0,
                ('H', h) => self.tool = h / 10,
                ('G', 430 | 800) | ('F' | 'R' | 'I' | 'J' | 'K', _) => {}
                ('X' | 'Y' | 'Z' | 'U' | 'V' | 'W', _) => {}
                other => panic!("the simple control does not know {other:?} in {block}"),
            }
        }
        let before = self.machine;
        let mut goal = self.machine;
        let mut moved = false;
        for axis in 0..3 {
            let unit = self.unit(axis);
            if let Some(said) = value(['X', 'Y', 'Z'][axis]) {
                moved = true;
                if shifts {
                    self.shift[axis] = 0.0;
                    self.shift[axis] = self.machine[axis] - self.offset(axis) - said * unit;
                } else if self.incremental {
                    goal[axis] += said * unit;
                } else {
                    goal[axis] = self.offset(axis) + said * unit;
                }
            }
            if let Some(said) = value(['U', 'V', 'W'][axis]).filter(|_| self.ways_by_letter) {
                moved = true;
                goal[axis] += said * unit;
            }
        }
        let centre = value('I').or(value('J'));
        if shifts || !(moved || centre.is_some()) {
            return None;
        }
        if self.motion == 81 {
            return Some(self.drill(goal, value('Z'), value('R')));
        }
        self.machine = goal;
        let centre = (self.motion >= 2).then(|| self.centre(before, value('I'), value('J')));
        Some(Event::Stand(goal, centre))
    }

    fn drill(&mut self, over: Place, z: Option<f64>, r: Option<f64>) -> Event {
        assert!(!self.incremental, "drilling by ways");
        let unit = self.unit(2);
        self.drill_z = z.map_or(self.drill_z, |z| z * unit);
        self.drill_r = r.map_or(self.drill_r, |r| r * unit);
        let bottom = [over[0], over[1], self.offset(2) + self.drill_z];
        let retract = self.offset(2) + self.drill_r;
        let height = if self.to_retract {
            retract
        } else {
            self.machine[2].max(retract)
        };
        self.machine = [over[0], over[1], height];
        Event::Hole(bottom)
    }

    /// The centre of an arc in X, Y; panics where it is no arc of this control.
    fn centre(&self, from: Place, i: Option<f64>, j: Option<f64>) -> [f64; 2] {
        let unit = if self.inches { 25.4 } else { 1.0 };
        let centre = [
            from[0] + i.unwrap_or(0.0) * unit,
            from[1] + j.unwrap_or(0.0) * unit,
        ];
        let radius = |place: Place| (place[0] - centre[0]).hypot(place[1] - centre[1]);
        let (start, end) = (radius(from), radius(self.machine));
        assert!((start - end).abs() < 0.01, "radii {start} and {end}");
        centre
    }
}

fn words(block: &str) -> Vec<(char, f64)> {
    let text: String = block.chars().filter(|c| !c.is_whitespace()).collect();
    let mut words = Vec::new();
    let mut rest = text.as_str();
    while let Some(letter) = rest.chars().next() {
        let body = &rest[1..];
        let end = body
            .find(|c: char| c.is_ascii_alphabetic())
            .unwrap_or(body.len());
        words.push((
            letter,
            body[..end].parse().unwrap_or_else(|_| panic!("{block}")),
        ));
        rest = &body[end..];
    }
    words
}
