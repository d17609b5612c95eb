//! The tables of parameters of an axis, by name: for files, for documentation, for the store.

use super::AxisParams;
use crate::parameter_table::ParameterTable;

/// Whoever goes over the sections of [`AxisParams`]. Sections and fields are known by their names; new ones are added,
/// none is used anew.
pub trait SectionVisitor {
    /// Takes one section.
    fn section<T: ParameterTable>(&mut self, name: &'static str, table: &mut T);
}

impl AxisParams {
    /// Shows every section to `visitor`, which may write to it; [`AxisParams::validate`] then tells whether it may be used.
    pub fn visit_sections(&mut self, visitor: &mut impl SectionVisitor) {
        visitor.section("encoder", &mut self.encoder);
        visitor.section("motion", &mut self.motion);
        visitor.section("controller", &mut self.controller);
        visitor.section("calm", &mut self.calm);
        visitor.section("filter", &mut self.filter);
        visitor.section("friction", &mut self.friction);
        visitor.section("output", &mut self.output);
        visitor.section("step_dir", &mut self.sources.step_dir);
        visitor.section("analog", &mut self.sources.analog);
        visitor.section("master", &mut self.sources.master);
        visitor.section("gearing", &mut self.sources.gearing);
        visitor.section("thread", &mut self.sources.thread);
        visitor.section("compensation", &mut self.compensation);
        visitor.section("homing", &mut self.homing);
        visitor.section("probe", &mut self.probe);
        visitor.section("supervisor", &mut self.supervisor);
    }
}
