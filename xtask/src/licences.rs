//! Whether a licence expression is met by the licences we accept.

use std::collections::{BTreeMap, BTreeSet};

use serde::Deserialize;
use spdx::{Expression, ParseMode};

/// Section `[licenses]` of deny.toml.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Policy {
    /// SPDX identifiers accepted for every crate.
    pub allow: BTreeSet<String>,
    /// Further identifiers for single crates.
    #[serde(default)]
    pub exceptions: Vec<Exception>,
}

/// Licences accepted for one crate only.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Exception {
    #[serde(rename = "crate")]
    name: String,
    allow: BTreeSet<String>,
}

impl Policy {
    /// Why `expression`, the licence of crate `name`, is not acceptable.
    pub fn objection(&self, name: &str, expression: Option<&str>) -> Option<String> {
        let Some(text) = expression else {
            return Some(format!("{name}: no licence expression"));
        };
        let parsed = match Expression::parse_mode(text, ParseMode::LAX) {
            Ok(parsed) => parsed,
            Err(e) => {
                return Some(format!(
                    "{name}: `{text}` is not an SPDX expression: {}",
                    e.reason
                ));
            }
        };
        let extra = self.extra();
        let accepts = |id: &str| {
            self.allow.contains(id) || extra.get(name).is_some_and(|allow| allow.contains(id))
        };
        let is_met = parsed.evaluate(|requirement| accepts(&requirement.to_string()));
        (!is_met).then(|| format!("{name}: licence `{text}` is not accepted by deny.toml"))
    }

    fn extra(&self) -> BTreeMap<&str, &BTreeSet<String>> {
        self.exceptions
            .iter()
            .map(|exception| (exception.name.as_str(), &exception.allow))
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn policy() -> Policy {
        toml::from_str(
            r#"
            allow = ["MIT", "Apache-2.0", "Apache-2.0 WITH LLVM-exception"]
            exceptions = [{ crate = "fonts", allow = ["OFL-1.1"] }]
            "#,
        )
        .unwrap()
    }

    #[test]
    fn one_side_of_or_is_enough() {
        for expression in [
            "MIT",
            "MIT OR Apache-2.0",
            "MIT/Apache-2.0",
            "GPL-3.0-only OR MIT",
            "(MIT OR GPL-2.0-only) AND Apache-2.0",
            "Apache-2.0 WITH LLVM-exception",
        ] {
            assert_eq!(
                policy().objection("x", Some(expression)),
                None,
                "{expression}"
            );
        }
    }

    #[test]
    fn both_sides_of_and_are_needed() {
        for expression in [
            "GPL-3.0-only",
            "MIT AND GPL-3.0-only",
            "MIT WITH LLVM-exception",
            "MPL-2.0",
        ] {
            let objection = policy().objection("x", Some(expression)).unwrap();
            assert!(objection.contains(expression), "{objection}");
        }
    }

    #[test]
    fn an_exception_holds_for_its_crate_only() {
        assert_eq!(policy().objection("fonts", Some("MIT AND OFL-1.1")), None);
        assert!(
            policy()
                .objection("other", Some("MIT AND OFL-1.1"))
                .is_some()
        );
    }

    #[test]
    fn no_expression_and_nonsense_are_refused() {
        assert!(
            policy()
                .objection("x", None)
                .unwrap()
                .contains("no licence")
        );
        assert!(
            policy()
                .objection("x", Some("do what you like"))
                .unwrap()
                .contains("SPDX")
        );
    }
}
