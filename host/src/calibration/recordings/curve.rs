//! What a map leaves on a run that it was not learned from, edge by edge.

use leadscrew::calibration::Requirements;
use leadscrew::encoder_map::Direction;

use super::feed::learn as feed;
use super::{Candidate, Options, timer_hz};
use crate::calibration::{CalibrationError, Memory};
use crate::recording::Recording;

/// The last run alone, and what a map of the others leaves of it.
#[derive(Clone, Debug)]
pub struct Curve {
    /// Errors of the edges as the last run shows them, the four phases apart, d.
    pub before_d: Vec<f64>,
    /// The same less the map of the other runs, d.
    pub after_d: Vec<f64>,
}

/// Learns the last run for itself and the others without it; none unless they have a direction in common.
pub fn learn(
    recordings: &[Recording],
    options: &Options,
    used: &[Candidate],
) -> Result<Option<Curve>, CalibrationError> {
    let same_way = |last: &Candidate, others: &[Candidate]| {
        let mut ways = others.iter().map(|other| other.stretch.backward);
        ways.any(|backward| backward == last.stretch.backward)
    };
    let Some((last, others)) = used
        .split_last()
        .filter(|(last, others)| same_way(last, others))
    else {
        return Ok(None);
    };
    let timer_hz = timer_hz(recordings) as f64;
    let mut memories = [(); 2].map(|()| Memory::new(options.edges));
    let [for_last, for_others] = &mut memories;
    let (mut alone, mut map) = (for_last.learner(timer_hz)?, for_others.learner(timer_hz)?);
    feed(&mut alone, recordings, options, last, None)?;
    for other in others {
        feed(&mut map, recordings, options, other, None)?;
    }
    let (alone, map) = (
        alone.finish(&Requirements::NONE)?,
        map.finish(&Requirements::NONE)?,
    );
    let direction = if last.stretch.backward {
        Direction::Backward
    } else {
        Direction::Forward
    };
    let fronts = alone.index_front(direction).zip(map.index_front(direction));
    let Some((own, of_map)) = fronts else {
        return Ok(None);
    };
    // Both zeros are multiples of 4; a front may come a count early or late.
    let turn = (f64::from(own - of_map) / 4.0).round() as i64 * 4;
    let edges = i64::from(options.edges);
    let own_edge = |edge: i64| (edge + turn).rem_euclid(edges) as usize;
    let before_d: Vec<f64> = (0..edges)
        .map(|edge| alone.error_d(own_edge(edge)))
        .collect();
    let less_map = |(edge, before): (usize, &f64)| before - map.error_d(edge);
    Ok(Some(Curve {
        after_d: before_d.iter().enumerate().map(less_map).collect(),
        before_d,
    }))
}
