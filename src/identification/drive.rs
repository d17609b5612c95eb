//! The drive that a fit looks for, in d and records, and its motion under recorded commands.
//!
//! v″ + 2ζω·v′ + ω²·v = ω²·(G·u + b − friction), u delayed, |v′| limited, standing still for the dead time after a
//! reversal of u + b/G; by the trapezoidal rule, with the command held over a record.

/// Number of parameters.
pub const PARAMETERS: usize = 9;

/// Places of the parameters in a [`Vector`].
pub mod place {
    /// G, d a record at full command.
    pub const GAIN: usize = 0;
    /// b, d a record: what the drive's offset moves it by.
    pub const DRIFT: usize = 1;
    /// Kinetic friction, d a record of command.
    pub const FRICTION: usize = 2;
    /// ln ω.
    pub const LN_OMEGA: usize = 3;
    /// ln ζ.
    pub const LN_DAMPING: usize = 4;
    /// Transport delay, records.
    pub const DELAY: usize = 5;
    /// Dead time at a reversal, records.
    pub const DEAD_TIME: usize = 6;
    /// Largest acceleration, d a record².
    pub const MAX_ACCELERATION: usize = 7;
    /// ln of the Stribeck speed.
    pub const LN_STRIBECK: usize = 8;
}

/// All parameters, at their [`place`]s.
pub type Vector = [f64; PARAMETERS];

/// An acceleration that nothing reaches.
pub const NO_LIMIT: f64 = 1e9;

/// Commands nearer to standstill than this have no direction.
const NO_DIRECTION: f64 = 1e-4;

/// Converts a vector from records of `from` ticks to records of `to` ticks.
#[must_use]
pub fn converted(vector: &Vector, from: u32, to: u32) -> Vector {
    let n = f64::from(to) / f64::from(from);
    let [
        gain,
        drift,
        friction,
        ln_omega,
        ln_damping,
        delay,
        dead,
        limit,
        ln_stribeck,
    ] = *vector;
    let limit = if limit < NO_LIMIT {
        limit * n * n
    } else {
        NO_LIMIT
    };
    [
        gain * n,
        drift * n,
        friction * n,
        ln_omega + libm::log(n),
        ln_damping,
        delay / n,
        dead / n,
        limit,
        ln_stribeck + libm::log(n),
    ]
}

/// The drive and where its shaft is.
#[derive(Clone, Copy, Debug, Default)]
pub struct Drive {
    gain: f64,
    drift: f64,
    friction: f64,
    kept: f64,
    pull: f64,
    max_acceleration: f64,
    /// Static friction, as the aim that breaks away, forward and backward.
    held: [f64; 2],
    sticks: bool,
    per_stribeck: f64,
    dead_time: f64,
    delay_whole: isize,
    delay_part: f64,
    /// Travel since the start, d.
    pub travel: f64,
    velocity: f64,
    acceleration: f64,
    /// Direction of the last command that had one, and records since it changed.
    direction: f64,
    since_reversal: f64,
    /// Share of the last record in which the drive answered.
    alive: f64,
}

impl Drive {
    /// A drive that stands, or drifts where nothing holds it; `held` is static friction as the aim that breaks
    /// away (forward, backward), never below the kinetic one, or none if nothing holds it at rest.
    #[must_use]
    pub fn new(vector: &Vector, held: Option<[f64; 2]>) -> Self {
        let [
            gain,
            drift,
            friction,
            ln_omega,
            ln_damping,
            delay,
            dead_time,
            max_acceleration,
            ln_stribeck,
        ] = *vector;
        let omega = libm::exp(ln_omega);
        let (stiffness, damping) = (0.25 * omega * omega, omega * libm::exp(ln_damping));
        let all = 1.0 + damping + stiffness;
        let whole = libm::floor(delay);
        let mut drive = Self {
            gain,
            drift,
            friction,
            kept: (1.0 - damping - stiffness) / all,
            pull: 4.0 * stiffness / all,
            max_acceleration,
            held: held.map_or([friction; 2], |aims| aims.map(|aim| aim.max(friction))),
            sticks: held.is_some(),
            per_stribeck: libm::exp(-ln_stribeck),
            dead_time,
            delay_whole: whole as isize,
            delay_part: delay - whole,
            since_reversal: 1e6,
            alive: 1.0,
            ..Self::default()
        };
        if libm::fabs(drift) > gain * NO_DIRECTION {
            drive.direction = libm::copysign(1.0, drift);
        }
        if !drive.holds(drift) {
            drive.velocity = drift - libm::copysign(drive.friction_at(drift), drift);
        }
        drive
    }

    /// The same with the direction of the last command, for a drive whose offset has none.
    #[must_use]
    pub fn last_driven(mut self, direction: f64) -> Self {
        if self.direction == 0.0 {
            self.direction = direction;
        }
        self
    }

    fn holds(&self, aim: f64) -> bool {
        let [forward, backward] = self.held;
        let held = if aim < 0.0 { backward } else { forward };
        self.sticks && libm::fabs(aim) <= held
    }

    fn friction_at(&self, velocity: f64) -> f64 {
        let [forward, backward] = self.held;
        let held = if velocity < 0.0 { backward } else { forward };
        let relative = velocity * self.per_stribeck;
        self.friction + (held - self.friction) / (1.0 + relative * relative)
    }

    /// Moves through record `index` of commands: for its first part still under the command before the one that is due.
    pub fn step(&mut self, command: impl Fn(isize) -> f64, index: isize) {
        let due = index.wrapping_sub(self.delay_whole);
        let part = self.delay_part;
        let aim = self.gain * command(due) + self.drift;
        let before = self.gain * command(due.wrapping_sub(1)) + self.drift;
        let was_alive = self.alive;
        let reverses = self.reverses(aim);
        if reverses {
            self.since_reversal = 0.0;
        }
        let dead_until = part + self.dead_time;
        self.alive = (self.since_reversal + 1.0 - dead_until).clamp(0.0, 1.0);
        self.since_reversal += 1.0;
        let mean = if reverses {
            part * before * was_alive + self.alive * aim
        } else {
            (aim + part * (before - aim)) * self.alive
        };
        self.drive(mean);
    }

    /// Notes the direction of a command; true where it changes.
    fn reverses(&mut self, aim: f64) -> bool {
        if libm::fabs(aim) <= self.gain * NO_DIRECTION {
            return false;
        }
        let direction = libm::copysign(1.0, aim);
        let reverses = direction * self.direction < 0.0;
        self.direction = direction;
        reverses
    }

    /// Moves through a record at that mean aim.
    fn drive(&mut self, aim: f64) {
        let (velocity, acceleration) = (self.velocity, self.acceleration);
        let stops = velocity == 0.0 || (velocity + acceleration) * velocity <= 0.0;
        if stops && self.holds(aim) {
            self.travel += 0.5 * velocity;
            self.velocity = 0.0;
            self.acceleration = 0.0;
            return;
        }
        let gap = aim - velocity;
        let direction = if velocity == 0.0 { gap } else { velocity };
        let friction = self.friction_at(if velocity == 0.0 { 0.0 } else { velocity });
        let gap = gap - friction * libm::copysign(1.0, direction);
        let next = (self.kept * acceleration + self.pull * gap)
            .clamp(-self.max_acceleration, self.max_acceleration);
        self.travel += velocity + acceleration / 3.0 + next / 6.0;
        self.velocity += 0.5 * (acceleration + next);
        self.acceleration = next;
    }

    /// Acceleration at the end of the last record, d a record².
    #[must_use]
    pub const fn acceleration(&self) -> f64 {
        self.acceleration
    }

    /// Velocity at the end of the last record, d a record.
    #[must_use]
    pub const fn velocity(&self) -> f64 {
        self.velocity
    }
}
