//! The figures: all scenes, all encoders, by our axis and by the peer.

use super::carriage::carriage;
use super::creep::creep;
use super::error::TrackingError;
use super::figures::Figures;
use super::identified::identified;
use super::kit::Kit;
use super::linuxcnc::tunings::tunings;
use super::moves::{backlash, known, moves, there};
use super::peer::{gains, peer};
use super::scene::Scene;
use super::threads::threads;

/// Measures everything.
///
/// # Errors
/// Never with the scenes built in, which a test shows.
pub fn figures() -> Result<Figures, TrackingError> {
    let mut scenes = Scene::of_moves().to_vec();
    scenes.extend(Scene::with_backlash());
    scenes.extend(Scene::commissioned_off_nominal());
    let kit = Kit::new(&scenes)?;
    let moves = moves(&kit)?;
    let tunings = tunings()?;
    Ok(Figures {
        peer_gains: tunings.iter().map(gains).collect(),
        peer: peer(&moves, &tunings)?,
        known: known(&kit)?,
        there: there(&kit)?,
        identified: identified(&kit, &scenes)?,
        backlash: backlash(&kit)?,
        creep: creep(&kit)?,
        carriage: carriage(&kit)?,
        threads: threads(&kit)?,
        moves,
    })
}
