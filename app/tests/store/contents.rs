//! What is stored in the tests, in two editions that differ everywhere.

use leadscrew::compensation::table::{ScrewError, ScrewPoint};
use leadscrew::encoder_map::encode::{MapContent, encode};
use leadscrew::encoder_map::format::image_len;
use leadscrew::encoder_map::{Form, Residual};
use leadscrew::estimator::EstimatorConfig;
use leadscrew::settings::Settings;
use leadscrew::units::Position;
use leadscrew_app::store::{Finding, Interlock, Kind, Permission, Report, SET_BYTES, Store};

use super::flash::SimFlash;

pub fn estimator(name: &str) -> EstimatorConfig {
    EstimatorConfig::by_name(name).unwrap().unwrap()
}

pub fn defaults() -> Settings {
    Settings::new(estimator("exponential"))
}

pub fn settings(edition: u32) -> Settings {
    let mut settings = Settings::new(estimator("polynomial"));
    let step = f64::from(edition);
    settings.axis.motion.max_feed_mm_per_min = 8000.1 + step / 3.0;
    settings.axis.controller.position_gain_per_s = 11.0 + step / 7000.0;
    settings.axis.homing.back_off_mm = step / 9.0;
    settings
}

pub fn map_image(edition: u32, edges: u32) -> Vec<u8> {
    let error = |edge: u32| (edge.wrapping_mul(7 + edition) % 997) as i32 * 8 - 4000;
    let content = MapContent {
        edges,
        error: &error,
        phases: [[900, -900, 500, -500], [400, -400, 100, -100]],
        fronts: [Some(3), Some(-2)],
        residual: Residual::default(),
    };
    let mut image = vec![0; image_len(edges, Form::Full)];
    encode(&content, Form::Full, &mut image).unwrap();
    image
}

pub fn screw_points(edition: u32, count: u32) -> Vec<ScrewPoint> {
    let point = |at: u32| ScrewPoint {
        position: Position::from_num(at * 5000),
        error: [at + edition, at + 2 * edition]
            .map(|error| ScrewError::from_bits(error as i32 * 977)),
    };
    (0..count).map(point).collect()
}

pub type Mounted<'f, const SECTOR: usize, const WORD: usize> =
    Store<&'f mut SimFlash<SECTOR, WORD>>;

/// A permission that nothing contests.
pub fn permission() -> Permission<'static> {
    let interlock: &'static Interlock = Box::leak(Box::new(Interlock::new()));
    interlock.permit(&Default::default()).unwrap()
}

pub fn mounted<const SECTOR: usize, const WORD: usize>(
    flash: &mut SimFlash<SECTOR, WORD>,
) -> Mounted<'_, SECTOR, WORD> {
    let end = flash.cells.len() as u32;
    Store::mount(flash, 0..end, &permission()).unwrap()
}

/// The settings, the report, and the findings as sentences.
pub fn load<const SECTOR: usize, const WORD: usize>(
    store: &mut Mounted<'_, SECTOR, WORD>,
) -> (Settings, Report, Vec<String>) {
    let mut findings = Vec::new();
    let mut note = |finding: Finding<'_>| findings.push(finding.to_string());
    let (settings, report) = store
        .load(&defaults(), &mut [0; SET_BYTES], &mut note)
        .unwrap();
    (settings, report, findings)
}

pub fn bytes<const SECTOR: usize, const WORD: usize>(
    store: &mut Mounted<'_, SECTOR, WORD>,
    kind: Kind,
) -> Option<Vec<u8>> {
    let mut memory = vec![0; 16 * 1024];
    store.read(kind, &mut memory).unwrap().map(<[u8]>::to_vec)
}
