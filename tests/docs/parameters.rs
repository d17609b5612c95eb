//! `docs/parameters.md`: every parameter of an axis, from the tables that validate them.

use std::fmt::Write as _;

use leadscrew::estimator::EstimatorConfig;
use leadscrew::estimator::observer::ObserverParams;
use leadscrew::parameter_table::{Field, ParameterTable};
use leadscrew::params::{AxisParams, SectionVisitor};
use leadscrew::tuning::DriveModel;

use crate::reviewed;

const HEAD: &str = "\
# Parameters

Every parameter of an axis, in the units that people use; validation turns them into the units of the tick, and its
errors name the parameter, its value and the allowed range. Written by `cargo xtask golden` from the tables that
validate them.

A new set is taken between two ticks, all of it or nothing. Beside the sections an axis has its control rate `tick_hz`
(100 to 40 000 Hz), the clock of its edge timer `timer_hz` (1e6 to 250e6 Hz) and its estimator.
";

#[derive(Default)]
struct Page(String);

impl Page {
    fn table<T: ParameterTable>(&mut self, name: &str) {
        let text = &mut self.0;
        let _ = write!(text, "\n## `[{name}]`\n\n");
        for line in T::ABOUT {
            let _ = writeln!(text, "{}", linked(line));
        }
        let _ = write!(
            text,
            "\n| parameter | unit | default | range | |\n| --- | --- | --- | --- | --- |\n"
        );
        let defaults = T::default();
        for field in T::FIELDS {
            let Field {
                name,
                unit,
                description,
                min,
                max,
                get,
                ..
            } = field;
            let default = get(&defaults);
            let _ = writeln!(
                text,
                "| `{name}` | {unit} | {default:?} | {min:?} to {max:?} | {description} |"
            );
        }
    }
}

/// A line of documentation without the brackets of its links.
fn linked(line: &str) -> String {
    line.replace("[`", "`").replace("`]", "`")
}

impl SectionVisitor for Page {
    fn section<T: ParameterTable>(&mut self, name: &'static str, _: &mut T) {
        self.table::<T>(name);
    }
}

#[test]
fn the_page_of_parameters_is_what_the_tables_say() {
    let estimator = EstimatorConfig::by_name("simple").unwrap().unwrap();
    let mut page = Page(HEAD.to_owned());
    AxisParams::new(estimator).visit_sections(&mut page);
    page.0.push_str(
        "\n# What is tuned on\n\nThe observer and the tuning of the loop count on these figures of the machine.\n",
    );
    page.table::<ObserverParams>("observer");
    page.table::<DriveModel>("drive");
    reviewed("parameters.md", &page.0);
}

#[test]
fn every_name_is_used_once() {
    struct Names(Vec<&'static str>);
    impl SectionVisitor for Names {
        fn section<T: ParameterTable>(&mut self, name: &'static str, _: &mut T) {
            self.0.push(name);
        }
    }
    let estimator = EstimatorConfig::by_name("simple").unwrap().unwrap();
    let mut names = Names(Vec::new());
    AxisParams::new(estimator).visit_sections(&mut names);
    let mut unique = names.0.clone();
    unique.sort_unstable();
    unique.dedup();
    assert_eq!(unique.len(), names.0.len(), "{names:?}", names = names.0);
}
