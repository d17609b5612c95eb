//! The drive, as the loop counts on it.

use crate::parameter_table;

parameter_table! {
    /// A velocity drive as identified or as its data sheet has it:
    /// v″ + 2ζω·v′ + ω²·v = ω²·(G·(u + offset) − friction) with u delayed, |v′| limited. The default is the
    /// longitudinal axis of the 16K20F3.
    pub struct DriveModel {
        /// G: feed at full command (±10 V)
        full_command_feed_mm_per_min: 9600.0, "mm/min", 0.001..=1e6;
        /// Natural period 2π/ω of the velocity response
        natural_period_s: 0.09, "s", 1e-4..=10.0;
        /// Damping ratio ζ of the velocity response
        damping: 0.5, "1", 0.01..=10.0;
        /// Transport delay from the command put out to the drive
        delay_s: 0.002, "s", 0.0..=0.1;
        /// What the drive's input adds to the command: −offset makes it stand still
        offset: -0.005, "of full command", -0.5..=0.5;
        /// Kinetic friction forward, as the feed that the command loses
        friction_forward_mm_per_min: 90.0, "mm/min", 0.0..=1e5;
        /// Kinetic friction backward, as the feed that the command loses
        friction_backward_mm_per_min: 90.0, "mm/min", 0.0..=1e5;
        /// Static friction forward: the feed that has to be commanded before the axis moves
        breakaway_forward_mm_per_min: 180.0, "mm/min", 0.0..=1e5;
        /// Static friction backward: the feed that has to be commanded before the axis moves
        breakaway_backward_mm_per_min: 180.0, "mm/min", 0.0..=1e5;
        /// Feed at which half of the excess of static over kinetic friction is gone (Stribeck)
        stribeck_mm_per_min: 60.0, "mm/min", 0.001..=1e5;
        /// Time for which a reversal of the command is answered by standstill
        dead_time_s: 0.005, "s", 0.0..=1.0;
        /// Smallest step of command that the drive answers to
        resolution: 1e-4, "of full command", 0.0..=0.1;
        /// Largest acceleration
        max_acceleration_m_s2: 2.1, "m/s²", 0.001..=1e4;
    }
}

impl DriveModel {
    /// A drive of second order and nothing else: no delay, offset, friction, dead time or steps of command.
    #[must_use]
    pub fn second_order(natural_period_s: f64, damping: f64) -> Self {
        Self {
            natural_period_s,
            damping,
            delay_s: 0.0,
            offset: 0.0,
            friction_forward_mm_per_min: 0.0,
            friction_backward_mm_per_min: 0.0,
            breakaway_forward_mm_per_min: 0.0,
            breakaway_backward_mm_per_min: 0.0,
            dead_time_s: 0.0,
            resolution: 0.0,
            ..Self::default()
        }
    }
}
