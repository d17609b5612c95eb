//! Which estimator serves which path: velocity and acceleration of the feedback, its position, and what is shown.
//!
//! ```text
//! edges ─► sample, once a tick ─┬─► first  ─┬─► feedback: velocity, acceleration, position
//!                               └─► second ─┴─► display
//! ```
//!
//! One estimator serves all paths unless a second one is given; a second one costs its own update alone, since
//! the sample of the tick's edges is made once.

use super::observer::Gains;
use super::{Delay, Estimate, Estimator, EstimatorConfig, Evidence, Variances};
use crate::uncertainty::EdgeNoise;
use crate::units::{Position, RangeError, Velocity, checked};

/// One of the estimators.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Choice {
    /// The first, which is always there.
    #[default]
    First,
    /// The second.
    Second,
}

/// What the loop takes for the axis's position.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PositionFeedback {
    /// The middle of the count.
    #[default]
    Count,
    /// The position that the velocity's estimator gives, which is to have no lag: the encoder map is in it.
    Estimate,
}

/// Estimators by path.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Paths {
    /// Velocity of the feedback.
    pub velocity: Choice,
    /// Acceleration of the feedback.
    pub acceleration: Choice,
    /// What the axis gives out.
    pub display: Choice,
    /// Position of the feedback.
    pub position: PositionFeedback,
}

/// The estimators of an axis and their paths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Config {
    first: EstimatorConfig,
    second: Option<EstimatorConfig>,
    paths: Paths,
}

impl Config {
    /// `first` and, where it is given, `second` on `paths`.
    ///
    /// # Errors
    /// [`RangeError`] for a path to a second estimator that is not given, a position that lags, or two observers of
    /// different parameters: there is memory for the gains of one.
    pub fn new(
        first: EstimatorConfig,
        second: Option<EstimatorConfig>,
        paths: Paths,
    ) -> Result<Self, RangeError> {
        let used = [paths.velocity, paths.acceleration, paths.display];
        let seconds = used.iter().filter(|path| **path == Choice::Second).count();
        let most = if second.is_some() { 3.0 } else { 0.0 };
        checked("paths to the second estimator", seconds as f64, 0.0, most)?;
        let observers = match (&first, &second) {
            (EstimatorConfig::Observer(one), Some(EstimatorConfig::Observer(other)))
                if one != other =>
            {
                2.0
            }
            _ => 1.0,
        };
        checked("observers of different parameters", observers, 0.0, 1.0)?;
        if paths.position == PositionFeedback::Estimate {
            let of_velocity = chosen(paths.velocity, &first, second.as_ref());
            let lag: f64 = of_velocity.lags().position.to_num();
            checked("lag of the fed back position, ticks", lag, 0.0, 0.0)?;
        }
        Ok(Self {
            first,
            second,
            paths,
        })
    }

    /// One estimator for all; the position is the count's.
    #[must_use]
    pub fn single(first: EstimatorConfig) -> Self {
        Self {
            first,
            second: None,
            paths: Paths::default(),
        }
    }

    /// Solves for the gains of the observer among them: some million operations, outside the tick. Without one they are
    /// [`Gains::NONE`].
    #[must_use]
    #[inline(never)]
    pub fn gains(&self) -> Gains {
        match (&self.first, &self.second) {
            (EstimatorConfig::Observer(config), _)
            | (_, Some(EstimatorConfig::Observer(config))) => Gains::solve(config),
            _ => Gains::NONE,
        }
    }

    /// The estimator of a path.
    #[must_use]
    pub fn of(&self, choice: Choice) -> &EstimatorConfig {
        chosen(choice, &self.first, self.second.as_ref())
    }

    /// Which estimator serves which path.
    #[must_use]
    pub const fn paths(&self) -> &Paths {
        &self.paths
    }

    /// How the velocity and the acceleration of the feedback lie behind.
    #[must_use]
    pub fn delay(&self) -> Delay {
        let velocity = self.of(self.paths.velocity).delay();
        let acceleration = self.of(self.paths.acceleration).delay();
        Delay {
            acceleration: acceleration.acceleration,
            ..velocity
        }
    }

    /// True if other estimators than those of `other` are there, or other paths: what cannot change in motion.
    #[must_use]
    pub fn differs_in_kind(&self, other: &Self) -> bool {
        self.paths != other.paths || self.second != other.second
    }

    fn is_display_alone(&self) -> bool {
        let Paths {
            velocity,
            acceleration,
            display,
            ..
        } = self.paths;
        [velocity, acceleration, display] == [Choice::First, Choice::First, Choice::Second]
    }

    /// An estimator looks at the edges.
    fn reads_edges(&self) -> bool {
        self.first.reads_edges() || self.second.is_some_and(|second| second.reads_edges())
    }
}

/// Puts another estimator in the place of one. On a frame of its own: an estimator is large.
#[inline(never)]
fn restart(place: &mut Estimator, config: &EstimatorConfig, gains: &Gains, velocity: Velocity) {
    *place = Estimator::with_gains(config, gains);
    place.prime(velocity);
}

/// Puts an estimator where there was none.
#[inline(never)]
fn begin(
    place: &mut Option<Estimator>,
    config: &EstimatorConfig,
    gains: &Gains,
    velocity: Velocity,
) {
    place
        .insert(Estimator::with_gains(config, gains))
        .prime(velocity);
}

/// The estimator of a path.
const fn chosen<'c>(
    choice: Choice,
    first: &'c EstimatorConfig,
    second: Option<&'c EstimatorConfig>,
) -> &'c EstimatorConfig {
    match (choice, second) {
        (Choice::Second, Some(second)) => second,
        _ => first,
    }
}

/// The estimators.
// They are large, and so come last.
#[derive(Clone, Debug)]
#[repr(C)]
pub struct Estimators {
    paths: Paths,
    reads_edges: bool,
    /// The second estimator is shown, and the first one serves all else: what a second one is mostly for.
    is_display_alone: bool,
    /// What the feedback gets.
    feedback: Estimate,
    first: Estimator,
    second: Option<Estimator>,
}

impl Estimators {
    /// Estimators that wait for their first sample, with the [gains](Config::gains) solved for them.
    #[must_use]
    pub fn with_gains(config: &Config, gains: &Gains) -> Self {
        Self {
            first: Estimator::with_gains(&config.first, gains),
            second: (config.second.as_ref()).map(|second| Estimator::with_gains(second, gains)),
            paths: config.paths,
            reads_edges: config.reads_edges(),
            is_display_alone: config.is_display_alone(),
            feedback: Estimate::default(),
        }
    }

    /// Takes other estimators, with the [gains](Config::gains) solved for them, which start as after a long motion at
    /// `velocity`.
    pub fn reconfigure(&mut self, config: &Config, gains: &Gains, velocity: Velocity) {
        restart(&mut self.first, &config.first, gains, velocity);
        match (&mut self.second, &config.second) {
            (Some(place), Some(second)) => restart(place, second, gains, velocity),
            (place, None) => *place = None,
            (place, Some(second)) => begin(place, second, gains, velocity),
        }
        self.paths = config.paths;
        self.reads_edges = config.reads_edges();
        self.is_display_alone = config.is_display_alone();
    }

    /// The first estimator.
    #[must_use]
    pub const fn first(&self) -> &Estimator {
        &self.first
    }

    /// Takes what a tick has to tell; gives what is shown.
    #[inline]
    pub fn update(&mut self, evidence: &mut Evidence<'_>, display: &mut Estimate) {
        if self.reads_edges {
            evidence.sample = evidence.edges.sample(evidence.observation);
        }
        let Some(second) = &mut self.second else {
            self.first.update_into(evidence, &mut self.feedback);
            *display = self.feedback;
            return;
        };
        if self.is_display_alone {
            // Each goes where it is wanted, and nothing is parted.
            second.update_into(evidence, display);
            self.first.update_into(evidence, &mut self.feedback);
        } else {
            let second = second.update(evidence);
            let first = self.first.update(evidence);
            self.share([first, second], display);
        }
    }

    /// How uncertain the newest of what is shown is. Outside the tick.
    #[must_use]
    pub fn variances(&self, noise: &EdgeNoise) -> Variances {
        match (self.paths.display, &self.second) {
            (Choice::Second, Some(second)) => second.variances(noise),
            _ => self.first.variances(noise),
        }
    }

    /// Parts two estimates by path.
    #[inline(never)]
    fn share(&mut self, estimates: [Estimate; 2], display: &mut Estimate) {
        let [first, second] = &estimates;
        let of = |choice| match choice {
            Choice::First => first,
            Choice::Second => second,
        };
        let (velocity, acceleration) = (of(self.paths.velocity), of(self.paths.acceleration));
        self.feedback = Estimate {
            acceleration: acceleration.acceleration,
            ..*velocity
        };
        *display = *of(self.paths.display);
    }

    /// The position for the loop; `count` is the middle of the count.
    #[inline]
    #[must_use]
    pub const fn position(&self, count: Position) -> Position {
        match self.paths.position {
            PositionFeedback::Count => count,
            PositionFeedback::Estimate => self.feedback.position,
        }
    }

    /// The estimate for the loop.
    #[inline]
    #[must_use]
    pub const fn fed_back(&self) -> &Estimate {
        &self.feedback
    }
}
