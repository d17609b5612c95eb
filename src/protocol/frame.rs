//! Frames: a header, a body and a checksum, stuffed so that a zero byte only ever ends one.

use crc::{CRC_32_ISO_HDLC, Crc, NoTable};
use serde::Serialize;

/// Bytes of the header: channel, session, sequence.
pub const HEADER: usize = 7;
/// Bytes of the checksum.
pub const CHECKSUM: usize = 4;
/// Largest body.
pub const MAX_BODY: usize = 240;
/// Largest content: header, body and checksum.
pub const MAX_CONTENT: usize = HEADER + MAX_BODY + CHECKSUM;
/// Largest frame: its stuffing adds a byte, the zero at its end another.
pub const MAX_FRAME: usize = cobs::max_encoding_length(MAX_CONTENT) + 1;

/// The checksum of the encoder map too; a table would cost more flash than it is worth.
const CRC: Crc<u32, NoTable> = Crc::<u32, NoTable>::new(&CRC_32_ISO_HDLC);

/// The checksum that frames end with.
#[must_use]
pub const fn checksum(bytes: &[u8]) -> u32 {
    CRC.checksum(bytes)
}

/// What a body is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Channel {
    /// A [`Request`](super::request::Request), from the tool to the axis.
    Request = 1,
    /// A [`Reply`](super::reply::Reply) to the request of the same session and sequence.
    Reply = 2,
    /// A [`Record`](crate::telemetry::Record) of a tick; its sequence counts the records of the session.
    Telemetry = 3,
    /// [`Samples`](super::stream::Samples) of signals; its sequence counts these frames of the session.
    Samples = 4,
}

impl Channel {
    /// All channels, by number.
    pub const ALL: &'static [Self] = &[Self::Request, Self::Reply, Self::Telemetry, Self::Samples];

    /// The channel of that number.
    #[must_use]
    pub const fn from_number(number: u8) -> Option<Self> {
        match number {
            1 => Some(Self::Request),
            2 => Some(Self::Reply),
            3 => Some(Self::Telemetry),
            4 => Some(Self::Samples),
            _ => None,
        }
    }
}

/// What a frame says of its body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Header {
    /// What the body is.
    pub channel: Channel,
    /// The session it belongs to; 0 where there is none yet.
    pub session: u32,
    /// Its place in the session; wraps.
    pub sequence: u16,
}

/// A frame whose checksum was right.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Frame<'a> {
    /// Its header.
    pub header: Header,
    /// Its body, not looked at yet.
    pub body: &'a [u8],
}

/// A body that is larger than [`MAX_BODY`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TooLarge;

impl core::fmt::Display for TooLarge {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(
            f,
            "the message is larger than {MAX_BODY} bytes: shorten its texts"
        )
    }
}

impl core::error::Error for TooLarge {}

/// Room for a frame, and the frame in it.
#[derive(Clone, Debug)]
pub struct FrameBuffer {
    bytes: [u8; MAX_FRAME],
    length: usize,
}

impl Default for FrameBuffer {
    fn default() -> Self {
        Self {
            bytes: [0; MAX_FRAME],
            length: 0,
        }
    }
}

impl FrameBuffer {
    /// The bytes of the frame made last, the zero at its end included.
    #[must_use]
    pub fn bytes(&self) -> &[u8] {
        self.bytes.get(..self.length).unwrap_or_default()
    }

    /// Forgets the frame.
    pub const fn clear(&mut self) {
        self.length = 0;
    }

    /// Makes a frame of a message in the format of postcard.
    ///
    /// # Errors
    /// [`TooLarge`]
    pub fn message(&mut self, header: Header, message: &impl Serialize) -> Result<&[u8], TooLarge> {
        let mut content = [0; MAX_CONTENT];
        let room = content.get_mut(HEADER..HEADER + MAX_BODY).ok_or(TooLarge)?;
        let body = postcard::to_slice(message, room).map_err(|_| TooLarge)?;
        let length = body.len();
        self.close(header, &mut content, length)
    }

    /// Makes a frame of a body as it is.
    ///
    /// # Errors
    /// [`TooLarge`]
    pub fn raw(&mut self, header: Header, body: &[u8]) -> Result<&[u8], TooLarge> {
        let mut content = [0; MAX_CONTENT];
        if body.len() > MAX_BODY {
            return Err(TooLarge);
        }
        let room = content.iter_mut().skip(HEADER);
        room.zip(body).for_each(|(place, byte)| *place = *byte);
        self.close(header, &mut content, body.len())
    }

    /// Header before, checksum behind, and the stuffing.
    fn close(
        &mut self,
        header: Header,
        content: &mut [u8; MAX_CONTENT],
        body: usize,
    ) -> Result<&[u8], TooLarge> {
        self.length = 0;
        let [s0, s1, s2, s3] = header.session.to_le_bytes();
        let [n0, n1] = header.sequence.to_le_bytes();
        let head = [header.channel as u8, s0, s1, s2, s3, n0, n1];
        content
            .iter_mut()
            .zip(head)
            .for_each(|(to, byte)| *to = byte);
        let covered = HEADER.wrapping_add(body);
        let (before, rest) = content.split_at_mut_checked(covered).ok_or(TooLarge)?;
        let sum = CRC.checksum(before).to_le_bytes();
        rest.iter_mut().zip(sum).for_each(|(to, byte)| *to = byte);
        let whole = content
            .get(..covered.wrapping_add(CHECKSUM))
            .ok_or(TooLarge)?;
        let stuffed = cobs::try_encode(whole, &mut self.bytes).map_err(|_| TooLarge)?;
        *self.bytes.get_mut(stuffed).ok_or(TooLarge)? = 0;
        self.length = stuffed.wrapping_add(1);
        Ok(self.bytes())
    }
}

/// Why a content is no frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Broken {
    /// Too short for header and checksum.
    Short,
    /// The checksum is wrong.
    Checksum,
    /// A channel that this side does not know.
    Channel,
}

/// The frame in an unstuffed content.
pub(super) fn open(content: &[u8]) -> Result<Frame<'_>, Broken> {
    let (covered, sum) = content
        .split_last_chunk::<CHECKSUM>()
        .ok_or(Broken::Short)?;
    let (head, body) = covered.split_first_chunk::<HEADER>().ok_or(Broken::Short)?;
    if CRC.checksum(covered) != u32::from_le_bytes(*sum) {
        return Err(Broken::Checksum);
    }
    let [channel, s0, s1, s2, s3, n0, n1] = *head;
    let header = Header {
        channel: Channel::from_number(channel).ok_or(Broken::Channel)?,
        session: u32::from_le_bytes([s0, s1, s2, s3]),
        sequence: u16::from_le_bytes([n0, n1]),
    };
    Ok(Frame { header, body })
}

impl<'a> Frame<'a> {
    /// The message in the body; `None` unless it is one that is known, to the last byte.
    #[must_use]
    pub fn message<M: serde::Deserialize<'a>>(&self) -> Option<M> {
        match postcard::take_from_bytes(self.body) {
            Ok((message, [])) => Some(message),
            _ => None,
        }
    }
}
