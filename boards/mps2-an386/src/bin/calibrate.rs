//! Learns the map of a simulated encoder on the target, with the core's code and in memory that is given
//! beforehand, and logs its image: `map <offset> <32 bytes in hexadecimal>`. It is that of the host, bit for bit.
#![no_std]
#![no_main]

use board_mps2_an386::{exit_failure, exit_success, time_driver};
use cortex_m_rt::entry;
use leadscrew::calibration::{Learner, Requirements, Work};
use leadscrew::encoder_map::Form;
use leadscrew::encoder_map::format::image_len;
use leadscrew_hal_mock::disc::DiscParams;
use leadscrew_hal_mock::encoder::EncoderModel;
use leadscrew_hal_mock::learning::{LearningError, LearningFeed};
use leadscrew_hal_mock::scene::Ripple;
use static_cell::ConstStaticCell;

/// A small encoder, so that the run is short.
const EDGES: usize = 2000;
const SEED: u64 = 7;
const REVOLUTIONS: u32 = 12;
const VELOCITIES: [f64; 4] = [83.3, -83.3, 66.7, -66.7];
const TICK_HZ: f64 = 1000.0;
const IMAGE: usize = image_len(EDGES as u32, Form::Full);
/// Bytes of a line of the log.
const LINE: usize = 32;

static SUMS: ConstStaticCell<[i32; EDGES]> = ConstStaticCell::new([0; EDGES]);
static MEAN: ConstStaticCell<[i16; EDGES]> = ConstStaticCell::new([0; EDGES]);
static IMAGE_BYTES: ConstStaticCell<[u8; IMAGE]> = ConstStaticCell::new([0; IMAGE]);

#[entry]
fn main() -> ! {
    // For the log's timestamps only.
    time_driver::start();
    let image = IMAGE_BYTES.take();
    match learn(image) {
        Ok(length) => log(&image[..length]),
        Err(LearningError::Range(_)) => {
            defmt::error!("the encoder cannot be simulated");
            exit_failure()
        }
        Err(LearningError::Refused(refusal)) => {
            defmt::error!("refused: {}", defmt::Display2Format(&refusal));
            exit_failure()
        }
    }
    exit_success()
}

/// Learns the map and writes its image; gives its length.
fn learn(image: &mut [u8]) -> Result<usize, LearningError> {
    let model = EncoderModel {
        disc: DiscParams {
            edges_per_revolution: EDGES as f64,
            ..DiscParams::default()
        },
        ..EncoderModel::real()
    };
    let work = Work {
        sums: SUMS.take(),
        mean: MEAN.take(),
    };
    let mut learner = Learner::new(EDGES as u32, model.encoder.timer_hz, work)?;
    for (number, velocity) in (1..).zip(VELOCITIES) {
        let feed = LearningFeed {
            model: &model,
            seed: SEED,
            number,
            tick_hz: TICK_HZ,
            velocity,
            revolutions: REVOLUTIONS,
            sways: true,
            ripple: Ripple::NONE,
        };
        feed.learn(&mut learner)?;
        defmt::info!("run {=u32} of {=usize}", number, VELOCITIES.len());
    }
    let learned = learner.finish(&Requirements::default())?;
    match learned.encode(Form::Full, image) {
        Ok(length) => Ok(length),
        Err(error) => {
            defmt::error!("no map: {}", defmt::Display2Format(&error));
            exit_failure()
        }
    }
}

fn log(image: &[u8]) {
    for (line, bytes) in image.chunks(LINE).enumerate() {
        let mut words = [0_u64; LINE / 8];
        for (word, bytes) in words.iter_mut().zip(bytes.chunks(8)) {
            let mut whole = [0; 8];
            whole[..bytes.len()].copy_from_slice(bytes);
            *word = u64::from_be_bytes(whole);
        }
        let [first, second, third, fourth] = words;
        defmt::info!(
            "map {=usize} {=u64:016x}{=u64:016x}{=u64:016x}{=u64:016x}",
            line * LINE,
            first,
            second,
            third,
            fourth
        );
    }
    defmt::info!("map of {=usize} bytes", image.len());
}
