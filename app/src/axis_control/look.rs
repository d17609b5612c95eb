//! What looks at the axis after its step: scope, stream, captures, faults, indexes.

use crate::queues::enqueue;
use leadscrew::hal::Capture;

use super::AxisControl;
use crate::report::Indexes;

impl<B> AxisControl<B> {
    /// Everything that looks at the axis after its step.
    pub(super) fn look(&mut self, capture: &Capture<'_>) {
        if let Some(scope) = &mut self.scope {
            scope.take(&self.axis);
            if scope.is_over()
                && let Some(scope) = self.scope.take()
                // There is one scope at a time, so there is room.
                && let Err(scope) = enqueue(&mut self.ends.scopes_back, scope)
            {
                self.scope = Some(scope);
            }
        }
        if let Some(stream) = &mut self.stream
            && let Some(sample) = stream.take(&self.axis)
        {
            // One that finds no room leaves a gap in the ticks.
            let _ = enqueue(&mut self.ends.samples, sample);
        }
        self.captures.send(capture);
        if let Some(first) = self.axis.supervisor().first_fault() {
            let told = (first.tick, first.later.bits());
            if self.told_fault != Some(told) && enqueue(&mut self.ends.faults, *first).is_ok() {
                self.told_fault = Some(told);
            }
        }
        let report = self.axis.probe().report();
        let told = (report.touches, report.ends);
        if self.told_touch != told && enqueue(&mut self.ends.touches, *report).is_ok() {
            self.told_touch = told;
        }
    }

    pub(super) fn note_index(&mut self, capture: &Capture<'_>) {
        let Some(latch) = capture.index else {
            return;
        };
        let step = latch.count.wrapping_sub(self.index_count).cast_signed();
        let now = capture.count.wrapping_sub(latch.count).cast_signed();
        let count = self.axis.outputs().count.wrapping_sub(i64::from(now));
        self.indexes = Indexes {
            number: self.indexes.number.wrapping_add(1),
            count,
            distance: if self.indexes.number == 0 {
                0
            } else {
                i64::from(step)
            },
        };
        self.index_count = latch.count;
    }
}
