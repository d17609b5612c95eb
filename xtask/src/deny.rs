//! Dependencies against `deny.toml` (a subset of cargo-deny's format): licences, sources, banned
//! crates. Needs no database and, once the dependencies are fetched, no network.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;

use serde::Deserialize;

use crate::Result;
use crate::command::{cargo, root};
use crate::licences::Policy;

const CONFIG: &str = "deny.toml";
/// How cargo names the default registry in its metadata, whatever mirror it fetches from.
const DEFAULT_REGISTRY: &str = "registry+https://github.com/rust-lang/crates.io-index";

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Config {
    licenses: Policy,
    bans: Bans,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Bans {
    deny: Vec<Ban>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Ban {
    #[serde(rename = "crate")]
    name: String,
    reason: String,
}

#[derive(Debug, Deserialize)]
struct Metadata {
    packages: Vec<Package>,
}

#[derive(Debug, Deserialize)]
struct Package {
    name: String,
    version: String,
    license: Option<String>,
    source: Option<String>,
}

#[derive(Debug, Default)]
struct Findings {
    errors: Vec<String>,
    warnings: Vec<String>,
}

/// Prints warnings; fails with all errors at once.
pub fn run() -> Result<()> {
    let text = fs::read_to_string(root().join(CONFIG)).map_err(|e| format!("{CONFIG}: {e}"))?;
    let config: Config = toml::from_str(&text).map_err(|e| format!("{CONFIG}: {e}"))?;
    let json = metadata()?;
    let metadata: Metadata =
        serde_json::from_str(&json).map_err(|e| format!("cargo metadata: {e}"))?;
    let findings = check(&config, &metadata.packages);
    for warning in &findings.warnings {
        println!("warning: {warning}");
    }
    if !findings.errors.is_empty() {
        return Err(format!("dependencies:\n  {}", findings.errors.join("\n  ")));
    }
    println!("{} packages checked", metadata.packages.len());
    Ok(())
}

/// What cargo says of the dependencies; from the network only if they are not all fetched yet.
fn metadata() -> Result<String> {
    let online = || cargo(["metadata", "--format-version", "1", "--locked"]);
    let offline = || online().words(&["--offline"]);
    // Tried quietly first: what cargo says of a crate that is missing would look like our failure.
    if offline().succeeds() {
        offline().output()
    } else {
        online().output()
    }
}

fn check(config: &Config, packages: &[Package]) -> Findings {
    let mut findings = Findings::default();
    for package in packages {
        let licence = package.license.as_deref();
        findings
            .errors
            .extend(config.licenses.objection(&package.name, licence));
        // No source: a path in this workspace.
        if let Some(source) = package.source.as_deref()
            && source != DEFAULT_REGISTRY
        {
            let error = format!("{}: comes from {source}, not from crates.io", package.name);
            findings.errors.push(error);
        }
        if let Some(ban) = config.bans.deny.iter().find(|ban| ban.name == package.name) {
            findings
                .errors
                .push(format!("{}: banned: {}", ban.name, ban.reason));
        }
    }
    findings.warnings = duplicates(packages);
    findings
}

fn duplicates(packages: &[Package]) -> Vec<String> {
    let mut versions = BTreeMap::<&str, BTreeSet<&str>>::new();
    for package in packages {
        versions
            .entry(&package.name)
            .or_default()
            .insert(&package.version);
    }
    versions
        .iter()
        .filter(|(_, versions)| versions.len() > 1)
        .map(|(name, versions)| {
            let versions: Vec<_> = versions.iter().copied().collect();
            format!(
                "{name} in {} versions: {}",
                versions.len(),
                versions.join(", ")
            )
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn package(name: &str, version: &str, source: Option<&str>) -> Package {
        Package {
            name: name.to_owned(),
            version: version.to_owned(),
            license: Some("MIT".to_owned()),
            source: source.map(str::to_owned),
        }
    }

    fn findings(packages: &[Package]) -> Findings {
        let config = toml::from_str(
            r#"
            [licenses]
            allow = ["MIT"]
            [bans]
            deny = [{ crate = "bad", reason = "we have good" }]
            "#,
        );
        check(&config.unwrap(), packages)
    }

    #[test]
    fn paths_and_the_default_registry_pass() {
        let findings = findings(&[
            package("ours", "0.1.0", None),
            package("good", "1.0.0", Some(DEFAULT_REGISTRY)),
        ]);
        assert!(findings.errors.is_empty() && findings.warnings.is_empty());
    }

    #[test]
    fn other_sources_and_banned_crates_are_errors() {
        let findings = findings(&[
            package("forked", "1.0.0", Some("git+https://example.org/forked")),
            package("bad", "1.0.0", Some(DEFAULT_REGISTRY)),
        ]);
        assert_eq!(findings.errors.len(), 2, "{findings:?}");
        assert!(findings.errors[0].contains("example.org"));
        assert!(findings.errors[1].contains("we have good"));
    }

    #[test]
    fn two_versions_are_a_warning() {
        let findings = findings(&[
            package("nb", "0.1.3", Some(DEFAULT_REGISTRY)),
            package("nb", "1.1.0", Some(DEFAULT_REGISTRY)),
        ]);
        assert!(findings.errors.is_empty());
        assert_eq!(findings.warnings, ["nb in 2 versions: 0.1.3, 1.1.0"]);
    }

    #[test]
    fn the_policy_in_the_repository_is_well_formed() {
        let text = fs::read_to_string(root().join(CONFIG)).unwrap();
        toml::from_str::<Config>(&text).unwrap();
    }
}
