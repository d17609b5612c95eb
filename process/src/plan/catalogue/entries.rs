//! The file as it is written.

use serde::Deserialize;
use toml::Spanned;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct File {
    #[serde(default)]
    pub encoder: Vec<EncoderEntry>,
    #[serde(default)]
    pub machine: Vec<MachineEntry>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct EncoderEntry {
    pub name: Spanned<String>,
    pub maker: Option<String>,
    pub lines: Spanned<[f64; 2]>,
    pub max_rpm: Option<Spanned<f64>>,
    pub max_line_khz: Option<Spanned<f64>>,
    pub source: Option<String>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MachineEntry {
    pub name: Spanned<String>,
    pub source: Option<String>,
    #[serde(default)]
    pub axis: Vec<AxisEntry>,
    #[serde(default)]
    pub spindle: Vec<SpindleEntry>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct AxisEntry {
    pub name: Spanned<String>,
    pub max_feed_mm_per_min: Spanned<f64>,
    pub overload_g: Option<Spanned<f64>>,
    pub least_overload_g: Option<Spanned<f64>>,
    pub acceleration_m_s2: Option<Spanned<f64>>,
    pub max_jerk_m_s3: Option<Spanned<f64>>,
    pub counts_per_mm: Option<Spanned<f64>>,
    pub travel_mm: Option<Spanned<f64>>,
    pub encoder: Option<Spanned<String>>,
    pub lines: Option<Spanned<f64>>,
    pub assumed: Option<String>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SpindleEntry {
    pub name: Spanned<String>,
    pub max_rpm: Spanned<f64>,
    pub encoder: Spanned<String>,
    pub lines: Option<Spanned<f64>>,
    pub assumed: Option<String>,
}
