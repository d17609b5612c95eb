//! Steps from the drive's model on: identification, the loop, the encoder's map, the offset, homing.

use leadscrew::tuning::DriveModel;

use super::outcome::{TunedFigures, told};
use super::{ProcedureError, Session};
use crate::axis::tune::followed_now;
use crate::axis::{
    Feeds, TestMove, forget_learning, identify, keep_map, learn_encoder, null_offset,
    read_settings, tune,
};

/// Longest test move, mm.
const TEST_MM: f64 = 100.0;

impl Session<'_> {
    /// Identifies the drive; the model waits for [`Self::tune`].
    pub(super) fn identify(&mut self, name: &str) -> Result<(), ProcedureError> {
        let params = self.experiments();
        self.agreed(&format!(
            "{name}: ramps, steps and waves, loop open, move the axis within {} mm, half of it to either side, with {} mm/min at \
             most, for half a minute.",
            params.window_mm, params.max_feed_mm_per_min
        ))?;
        let Self {
            axis,
            guide,
            settings,
            ..
        } = self;
        let found = identify(axis, settings, &params, &mut |text| guide.progress(text))?;
        let model = found.identified.model();
        self.guide.tell(&format!(
            "{name}: {}; {:.2} d rms between motion and model",
            told(&model),
            found.identified.residual_d
        ));
        self.outcome.full_command_feed_mm_per_min = Some(model.full_command_feed_mm_per_min);
        self.outcome.offset = Some(model.offset);
        self.model = Some(model);
        Ok(())
    }

    fn model(&mut self) -> Result<DriveModel, ProcedureError> {
        if self.model.is_none() {
            self.identify("identify, for the loop")?;
        }
        self.model.ok_or(ProcedureError::Declined)
    }

    /// Makes the loop, tries it and keeps it.
    pub(super) fn tune(&mut self) -> Result<(), ProcedureError> {
        let model = self.model()?;
        let has_map = self.has_map()?;
        self.guide.progress("looking for the loop");
        let wanted = self.answers.known("max_feed_mm_per_min", &self.settings);
        let tuning = tune(self.axis, &self.settings, &model, wanted, has_map)?;
        let max_feed = tuning.settings.axis.motion.max_feed_mm_per_min;
        let at_mm = self.axis.status()?.position_mm;
        let way_mm = TEST_MM.min(self.room.length_mm());
        let (from_mm, to_mm) = self.room.place(at_mm, way_mm, "the test move", "")?;
        let test = TestMove {
            from_mm,
            to_mm,
            feed_mm_per_min: max_feed,
            passes: 2,
        };
        self.agreed(&format!(
            "tune: {} parameters make a loop of {:.0} rad/s with {:.0}° and {:.1} dB to spare. They are set, and tried by moves from \
             {from_mm:.1} to {to_mm:.1} mm and back with {max_feed} mm/min, loop closed.",
            tuning.changes.len(),
            tuning.report.bandwidth_rad_per_s,
            tuning.report.worst.phase_deg,
            tuning.report.worst.gain_db,
        ))?;
        let before = followed_now(self.axis, &self.settings, &test)?;
        let after = tuning.try_on(self.axis, &test, before.as_ref())?;
        self.settings = read_settings(self.axis)?;
        self.save()?;
        let before = before.map_or_else(
            || "no loop before".to_owned(),
            |before| format!("{:.1} d before", before.peak_d),
        );
        self.guide.tell(&format!(
            "tune: follows within {:.1} d ({:.2} d rms, {:.1} d standing; {before}), saved",
            after.peak_d, after.rms_d, after.standing_d
        ));
        self.outcome.tuned = Some(TunedFigures::new(&tuning.report, max_feed));
        self.outcome.follows = Some(after);
        Ok(())
    }

    /// Learns the encoder, then identifies and tunes with its map.
    pub(super) fn encoder(&mut self) -> Result<(), ProcedureError> {
        if self.settings.axis.motion.counts_per_revolution == 0.0 {
            self.guide
                .tell("encoder: without an index there is no map to learn");
            return Ok(());
        }
        let wanted = self.answers.known("revolutions", &self.settings) as u32;
        let at_mm = self.axis.status()?.position_mm;
        let feeds = Feeds::plan(&self.settings, &self.room, at_mm, wanted, None)?;
        self.agreed(&format!("encoder: {feeds}"))?;
        let Self {
            axis,
            guide,
            settings,
            ..
        } = self;
        let found = learn_encoder(axis, settings, &feeds, &mut |text| guide.progress(text));
        if found.is_err() {
            forget_learning(self.axis);
        }
        let found = found?;
        keep_map(self.axis, &self.settings, &found.learned)?;
        self.settings = read_settings(self.axis)?;
        let residual = found.learned.residual.edge_sigma_d;
        self.guide.tell(&format!(
            "encoder: the map leaves {residual:.4} d of an edge; the velocity at {:.0} mm/min trembles by {:.3} d/tick with it, by \
             {:.3} without; saved",
            feeds.feeds_mm_per_min[1], found.ripple.after, found.ripple.before
        ));
        self.outcome.map_edge_d = Some(residual);
        self.outcome.ripple_d_per_tick = Some([found.ripple.before, found.ripple.after]);
        self.identify("identify, with the map")?;
        self.tune()
    }

    /// Nulls the offset.
    pub(super) fn offset(&mut self) -> Result<(), ProcedureError> {
        self.agreed(
            "offset: the axis goes a revolution to and fro, slowly, and stands open-loop for two seconds, twice.",
        )?;
        let Self {
            axis,
            guide,
            settings,
            room,
            ..
        } = self;
        let nulled = null_offset(axis, settings, room, &mut |text| guide.progress(text))?;
        self.settings = read_settings(self.axis)?;
        self.save()?;
        self.guide.tell(&format!(
            "offset: {:.3} % of full command stand the drive still; {:.3} % were left for the loop, {:.3} % are now; saved",
            100.0 * nulled.bias,
            100.0 * nulled.left_before,
            100.0 * nulled.left_after
        ));
        self.outcome.offset_left = Some([nulled.left_before, nulled.left_after]);
        Ok(())
    }

    /// Homes the axis to its switch.
    pub(super) fn home(&mut self) -> Result<(), ProcedureError> {
        let switch = self
            .answers
            .get("home_switch", &self.settings, self.guide)?;
        if switch == 0.0 {
            self.guide.tell(
                "home: left out. With a home switch wired, `setup --from home` goes on here: the axis has no origin and no soft \
                 limits before it is homed",
            );
            return Ok(());
        }
        let end = if switch < 0.0 { "low" } else { "high" };
        self.set([("homing.search_direction".to_owned(), switch.signum())])?;
        let homing = &self.settings.axis.homing;
        self.agreed(&format!(
            "home: the axis seeks its home switch towards the {end} end with {} mm/min, {} mm at most, backs off {} mm and goes to \
             it and to the index behind it with {} mm/min, loop closed.",
            homing.search_feed_mm_per_min,
            homing.max_search_mm,
            homing.back_off_mm,
            homing.approach_feed_mm_per_min,
        ))?;
        self.axis.enable()?;
        let homed = self.axis.home()?;
        self.axis.disable()?;
        self.save()?;
        self.guide.tell(&format!(
            "home: homed, stands at {:.4} mm; saved",
            homed.position_mm
        ));
        self.outcome.homed_at_mm = Some(homed.position_mm);
        Ok(())
    }
}
