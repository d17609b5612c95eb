//! Vectors in plain Rust: a host computes the same ones from the same source.
//!
//! A group is a list of words, each of them the digest of many results, so that a difference names its place.

mod configuration;
mod double;
mod fixed_point;
mod motion;

/// Estimators that a configuration is made with. The observer's takes 200 million instructions of the same kind.
const ESTIMATORS: [&str; 5] = [
    "difference",
    "exponential",
    "simple",
    "gaussian",
    "polynomial",
];

/// Makes the words of a group.
pub type Make = fn(&mut Words<'_>);

/// All groups that are the same everywhere.
pub const GROUPS: &[(&str, Make)] = &[
    ("fixed point", fixed_point::run),
    ("double", double::run),
    ("configuration", configuration::run),
    ("motion", motion::run),
];

/// Where the words of a group go.
pub struct Words<'a> {
    memory: &'a mut [u32],
    used: usize,
}

impl<'a> Words<'a> {
    /// Words into a memory.
    pub const fn new(memory: &'a mut [u32]) -> Self {
        Self { memory, used: 0 }
    }

    /// Adds one.
    ///
    /// # Panics
    /// The memory is full: make it larger.
    pub fn push(&mut self, word: u32) {
        self.memory[self.used] = word;
        self.used += 1;
    }

    /// Adds a digest, its low word first.
    pub fn push_digest(&mut self, digest: &Digest) {
        let value = digest.0;
        self.push(value as u32);
        self.push((value >> 32) as u32);
    }

    /// How many there are.
    pub const fn used(&self) -> usize {
        self.used
    }
}

/// A running hash, one to one in both state and word: results that differ in one word differ for certain.
pub struct Digest(u64);

impl Digest {
    /// Of nothing.
    pub const fn new() -> Self {
        // Knuth's multiplier for congruential generators.
        Self(6_364_136_223_846_793_005)
    }

    /// Takes in a word.
    pub const fn take(&mut self, word: u32) {
        let mixed = (self.0 ^ word as u64).wrapping_mul(6_364_136_223_846_793_005);
        self.0 = mixed ^ mixed >> 29;
    }

    /// Takes in two words.
    pub const fn take_long(&mut self, word: u64) {
        self.take(word as u32);
        self.take((word >> 32) as u32);
    }
}

/// Random operands: every other one is a value at which arithmetic turns, or near it.
pub struct Operands(u64);

impl Operands {
    /// The same ones each time.
    pub const fn new() -> Self {
        Self(0x1234_5678_9abc_def1)
    }

    /// Any 64 bits.
    pub const fn any(&mut self) -> u64 {
        // Marsaglia's xorshift.
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    /// One of 32 bits.
    pub fn word(&mut self) -> u32 {
        const TURNS: [u32; 12] = [
            0,
            1,
            2,
            31,
            32,
            0x7fff,
            0x8000,
            0xffff,
            0x7fff_ffff,
            0x8000_0000,
            0x8000_0001,
            0xffff_ffff,
        ];
        let any = self.any();
        let (word, choice) = (any as u32, (any >> 32) as u32);
        if choice & 1 == 0 {
            return word;
        }
        let turn = TURNS[(choice >> 8) as usize % TURNS.len()];
        match choice >> 1 & 3 {
            0 => turn.wrapping_add(word & 3),
            1 => turn.wrapping_sub(word & 3),
            _ => turn,
        }
    }

    /// One of 64 bits.
    pub fn long(&mut self) -> u64 {
        u64::from(self.word()) << 32 | u64::from(self.word())
    }
}
