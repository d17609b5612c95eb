//! The part of the prove-out as it is planned: datum faces from an operation before, and what the program cuts.

use leadscrew_nc::coordinates::Coordinates;

/// The program that cuts it, in the coordinates of its work offset: x and y on the middle of its front, z on it.
pub const PROGRAM: &str = include_str!("../../programs/prove_out.ngc");

/// Place of the part's origin in the frame of the rotary table, mm.
pub(super) const PLANNED_MM: [f64; 3] = [0.0, 200.0, 100.0];
/// Radius of the end mill, mm: the program leads its centre.
const END_MILL_MM: f64 = 10.0;
/// Radius of the bores, mm.
pub const BORE_MM: f64 = 12.0;

/// A tool: number, length from the nose of the spindle, and the place of the cutting point from the tip on the axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tool {
    /// Its number.
    pub number: u32,
    /// Its length as the control has it, mm.
    pub length_mm: f64,
    /// The cutting point from the tip, mm.
    pub edge_mm: [f64; 3],
    /// What a first pass leaves for the next, by its offsets, mm.
    pub allowance_mm: [f64; 3],
}

/// The tools of the program.
pub const TOOLS: [Tool; 3] = [
    Tool {
        number: 1,
        length_mm: 150.0,
        edge_mm: [0.0; 3],
        allowance_mm: [0.0, 0.0, 0.3],
    },
    Tool {
        number: 2,
        length_mm: 152.0,
        edge_mm: [0.0; 3],
        allowance_mm: [0.0; 3],
    },
    Tool {
        number: 3,
        length_mm: 148.0,
        edge_mm: [-END_MILL_MM, 0.0, 0.0],
        allowance_mm: [0.3, 0.0, 0.0],
    },
];

/// What is touched.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Feature {
    /// The front, ⟂ z, from before.
    Front,
    /// The top, ⟂ y, from before.
    Top,
    /// The left side, ⟂ x, from before.
    Side,
    /// The face of tool 1, ⟂ z.
    Face,
    /// A bore of tool 2, along z; its number from 0.
    Bore(usize),
    /// The shoulder of tool 3, ⟂ x.
    Shoulder,
}

impl Feature {
    /// What the program cuts, in the order of the reports.
    pub const CUT: [Self; 6] = [
        Self::Face,
        Self::Bore(0),
        Self::Bore(1),
        Self::Bore(2),
        Self::Bore(3),
        Self::Shoulder,
    ];

    /// The faces from before that say where the part lies.
    pub const DATUM: [Self; 3] = [Self::Front, Self::Top, Self::Side];

    /// Number of the tool that cuts it; none for a datum face.
    #[must_use]
    pub const fn tool(self) -> Option<u32> {
        match self {
            Self::Front | Self::Top | Self::Side => None,
            Self::Face => Some(1),
            Self::Bore(_) => Some(2),
            Self::Shoulder => Some(3),
        }
    }

    /// Its touches: planned place and direction out of the material, without allowance.
    #[must_use]
    pub fn touches(self) -> Vec<([f64; 3], [f64; 3])> {
        let facing = |normal: [f64; 3], places: &[[f64; 3]]| {
            places.iter().map(|place| (*place, normal)).collect()
        };
        let (x, y, z) = ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]);
        match self {
            Self::Front => facing(
                z,
                &[
                    [-95.0, -70.0, 0.0],
                    [95.0, -70.0, 0.0],
                    [95.0, 70.0, 0.0],
                    [-95.0, 70.0, 0.0],
                ],
            ),
            Self::Top => facing(
                y,
                &[
                    [-80.0, 80.0, -15.0],
                    [0.0, 80.0, -15.0],
                    [80.0, 80.0, -15.0],
                ],
            ),
            Self::Side => facing(
                x.map(std::ops::Neg::neg),
                &[[-100.0, -50.0, -15.0], [-100.0, 50.0, -15.0]],
            ),
            Self::Face => {
                let rows = [-40.0, 0.0, 40.0];
                let place = |y: f64| [-60.0, 0.0, 60.0].map(|x| [x, y, -5.0]);
                facing(z, &rows.map(place).concat())
            }
            Self::Bore(number) => {
                let [cx, cy] = Self::bore_centre(number);
                let out = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]];
                let touch = |[x, y]: [f64; 2]| {
                    let place = [cx + BORE_MM * x, cy + BORE_MM * y, -15.0];
                    (place, [-x, -y, 0.0])
                };
                out.map(touch).to_vec()
            }
            Self::Shoulder => {
                // Near the mill's end: its flank lies along the spindle, which three axes cannot turn after the part.
                let place = |y: f64| [70.0, y, -17.5];
                facing(x, &[-45.0, -15.0, 15.0, 45.0].map(place))
            }
        }
    }

    /// Planned centre of a bore, mm.
    #[must_use]
    pub const fn bore_centre(number: usize) -> [f64; 2] {
        [[-45.0, -30.0], [45.0, -30.0], [45.0, 30.0], [-45.0, 30.0]][number % 4]
    }
}

/// The tool of that number.
#[must_use]
pub fn tool(number: u32) -> Option<&'static Tool> {
    TOOLS.iter().find(|tool| tool.number == number)
}

/// Machine coordinates that bring the tip of a tool of this length to a place of the part as planned.
pub(super) fn control_point(place: [f64; 3], length_mm: f64) -> Coordinates {
    let [x, y, z] = work_offset();
    Coordinates::xyz(place[0] + x, place[1] + y, place[2] + z + length_mm)
}

/// G54: the machine coordinates of the part's origin for a tool without length.
pub(super) fn work_offset() -> [f64; 3] {
    // The nose of the spindle stands 400 mm before the axis of the table with Z at 0.
    [PLANNED_MM[0], PLANNED_MM[1], PLANNED_MM[2] - 400.0]
}
