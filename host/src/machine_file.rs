//! Machines as TOML files: a named base and the keys that differ from it.

use std::fmt::Write as _;
use std::path::Path;

use leadscrew::parameter_table::{Field, ParameterTable};
use leadscrew_hal_mock::machine::MachineParams;
use leadscrew_hal_mock::scenario::{Base, MACHINE_SECTIONS, Visitor, visit_machine};
use leadscrew_nc::source::nearest;
use toml::de::{DeTable, DeValue};

use crate::toml_file::{self, Complaint, TomlFileError, fill, suggestion};

/// The built-in machine of that name.
#[must_use]
pub fn built_in(name: &str) -> Option<MachineParams> {
    let found = Base::ALL.into_iter().find(|base| base.name() == name);
    found.map(Base::params)
}

/// Reads a machine file.
///
/// # Errors
/// [`TomlFileError`] with file, line and what was expected.
pub fn read(path: &Path) -> Result<MachineParams, TomlFileError> {
    toml_file::read(path, parse)
}

fn parse(text: &str) -> Result<MachineParams, Complaint> {
    let document = toml_file::document(text)?;
    let document = document.get_ref();
    let mut machine = base(document)?.params();
    fill_sections(document, MACHINE_SECTIONS, &["base"], |section, fill| {
        visit_machine(&mut machine, section, fill)
    })?;
    Ok(machine)
}

/// Sets what `document` says in `sections`, each by `visit`; keys in `others` are read elsewhere.
pub(crate) fn fill_sections(
    document: &DeTable<'_>,
    sections: &[&str],
    others: &[&str],
    mut visit: impl FnMut(&str, Fill<'_>) -> Option<Result<(), Complaint>>,
) -> Result<(), Complaint> {
    for (key, value) in document {
        let name: &str = key.get_ref();
        if others.contains(&name) {
            continue;
        }
        let DeValue::Table(table) = value.get_ref() else {
            return Err(Complaint::new(
                key.span(),
                stray_key(name, sections, others),
            ));
        };
        let fill = Fill {
            section: name,
            table,
        };
        visit(name, fill).unwrap_or_else(|| {
            let hint = suggestion(name, sections.iter().copied());
            Err(Complaint::new(
                key.span(),
                format!("unknown section [{name}]{hint}"),
            ))
        })?;
    }
    Ok(())
}

/// Sets the keys of a section.
pub(crate) struct Fill<'a> {
    section: &'a str,
    table: &'a DeTable<'a>,
}

impl Visitor for Fill<'_> {
    type Output = Result<(), Complaint>;

    fn visit<T: ParameterTable>(self, params: &mut T) -> Self::Output {
        fill(params, self.section, self.table)
    }
}

/// What to say of a key that stands above the sections.
pub(crate) fn stray_key(name: &str, known: &[&str], others: &[&str]) -> String {
    if known.contains(&name) {
        format!("`{name}` is a section: write [{name}] and its keys below it")
    } else if let Some(near) = nearest(name, others.iter().copied()) {
        format!("unknown key `{name}` above the sections: did you mean `{near}`?")
    } else {
        let alone = others.iter().map(|other| format!("`{other}`"));
        let alone = alone.collect::<Vec<_>>().join(", ");
        let stand = if others.len() > 1 { "stand" } else { "stands" };
        let known = known
            .iter()
            .map(|section| format!("[{section}]"))
            .collect::<Vec<_>>()
            .join(", ");
        format!(
            "unknown key `{name}` above the sections: only {alone} {stand} there, other keys belong in {known}"
        )
    }
}

/// The machine that `base` names.
pub(crate) fn base(document: &DeTable<'_>) -> Result<Base, Complaint> {
    let known = Base::ALL.map(Base::name).join(", ");
    let Some(value) = document.get("base") else {
        return Ok(Base::default());
    };
    let Some(wanted) = value.get_ref().as_str() else {
        return Err(Complaint::new(
            value.span(),
            format!("base must be a name in quotes: one of {known}"),
        ));
    };
    let found = Base::ALL.into_iter().find(|base| base.name() == wanted);
    found.ok_or_else(|| {
        Complaint::new(
            value.span(),
            format!("unknown base `{wanted}`: expected one of {known}"),
        )
    })
}

/// The machine as TOML, every key with its unit, range and meaning.
#[must_use]
pub fn dump(base: &str, machine: &MachineParams) -> String {
    let mut text = format!(
        "# A machine for `leadscrew sim --machine FILE.toml`. Keys that are left out keep the value of the base.\n\
         base = \"{base}\"\n"
    );
    section(&mut text, "drive", &machine.drive);
    section(&mut text, "carriage", &machine.carriage);
    section(&mut text, "mount", &machine.mount);
    section(&mut text, "disc", &machine.encoder.disc);
    section(&mut text, "encoder", &machine.encoder.encoder);
    text
}

pub(crate) fn section<T: ParameterTable>(text: &mut String, name: &str, params: &T) {
    // Writing to a string cannot fail.
    let _ = write!(text, "\n[{name}]\n");
    for Field {
        name,
        unit,
        description,
        min,
        max,
        get,
        ..
    } in T::FIELDS
    {
        let value = get(params);
        let _ = writeln!(
            text,
            "# {description} ({unit}, {min} to {max})\n{name} = {value:?}"
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_dumped_machine_reads_back_the_same() {
        for base in Base::ALL {
            let (name, machine) = (base.name(), base.params());
            assert!(
                parse(&dump(name, &machine)).is_ok_and(|read| read == machine),
                "{name}"
            );
        }
    }
}
