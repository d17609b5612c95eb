//! The observer's parameters in physical units.

use crate::parameter_table;

parameter_table! {
    /// What the observer counts on. The default is the longitudinal axis of the 16K20F3 with a learned
    /// encoder map.
    pub struct ObserverParams {
        /// Feed at full command (±10 V)
        full_command_feed_mm_per_min: 9600.0, "mm/min", 0.001..=1e6;
        /// Natural period of the drive's velocity response; 8 ticks at least
        natural_period_s: 0.09, "s", 0.001..=10.0;
        /// Damping ratio of the drive's velocity response
        damping: 0.5, "1", 0.01..=10.0;
        /// Transport delay of the drive, rounded to whole ticks; 63 at most
        delay_s: 0.002, "s", 0.0..=0.1;
        /// Offset of the drive's command input
        offset: -0.005, "of full command", -0.5..=0.5;
        /// What an edge's place is uncertain by, independent of its neighbours: noise and what the map leaves
        edge_noise_d: 0.006, "d", 0.001..=1.0;
        /// Noise of an edge's time
        time_noise_s: 2e-8, "s", 0.0..=1e-5;
        /// Encoder error of long wave that the map leaves, rms; it looks like motion and adds to the stated 1σ
        map_residual_d: 0.007, "d", 0.0..=10.0;
        /// Wavelength that stands for that error
        map_wave_mm: 5.0, "mm", 0.001..=1e4;
        /// White jerk that the drive's model does not explain
        model_noise_m_s3: 0.2, "m/s³/√Hz", 1e-6..=1e6;
        /// Change of the disturbance, white
        disturbance_noise_m_s2: 0.003, "m/s²/√Hz", 1e-6..=1e6;
        /// White jerk of the motion where no command is known
        motion_noise_m_s3: 0.6, "m/s³/√Hz", 1e-6..=1e6;
        /// Silence of the encoder that is taken for rest
        rest_s: 0.1, "s", 0.001..=10.0;
        /// Change of the demanded feed that ends an assumed rest before the first edge
        release_mm_per_min: 15.0, "mm/min", 1e-3..=1e5;
        /// Root mean square of the innovations, over that from the edges' noise alone, that ends the drive's model
        fallback_sigmas: 100.0, "1", 1.0..=100.0;
        /// Time for which it is to be exceeded
        fallback_s: 0.05, "s", 0.0..=1.0;
        /// Error of the predicted acceleration that the model is taken back at
        return_m_s2: 0.1, "m/s²", 1e-4..=1e4;
        /// Time for which the prediction is to be that good; doubled by each fallback, up to 64 times
        return_s: 0.1, "s", 0.0..=10.0;
    }
}
