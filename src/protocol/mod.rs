//! The link between an axis and a person's tool: frames, messages, and who may move the axis.
//!
//! ```text
//! request ─► client ─► frame ─► bytes ─► decoder ─► session ─► service ─► axis
//!    ▲                                  (CRC, COBS) (sequence) (lease, planner)
//!    └── reply, telemetry ◄─ decoder ◄─ bytes ◄─ frame ◄──────────┘
//! ```
//!
//! [`frame`] makes bytes of a message, [`decoder`] finds frames again in whatever comes, [`request`], [`reply`] and
//! [`refusal`] are what is said, [`session`] takes each request once, [`lease`] says who may move the axis and for how
//! long, [`service`] is the axis's side of it all and [`client`] the tool's. `docs/wire-format.md` is the specification;
//! its tables are made from here.
//!
//! Nothing here knows a board: bytes, ticks and the axis's state come in as values.

pub mod client;
pub mod decoder;
mod describe;
pub mod experiment;
pub mod frame;
pub mod lease;
pub mod parameters;
pub mod record;
pub mod refusal;
pub mod reply;
pub mod request;
pub mod service;
pub mod session;
pub mod stream;

pub use describe::{Described, FieldText};

/// Version of the protocol: raised by every change after which an old tool could misunderstand a new axis.
pub const VERSION: u16 = 1;
