//! What an axis keeps, read back and written.

mod support;

use std::cell::RefCell;
use std::io;
use std::rc::Rc;
use std::time::Duration;

use leadscrew::params::AxisConfig;
use leadscrew::protocol::frame::checksum;
use leadscrew::protocol::refusal::Refusal;
use leadscrew::protocol::reply::Reply;
use leadscrew::protocol::request::Request;
use leadscrew::protocol::service::{Order, Passed, Port, Seen, Service};
use leadscrew::settings::Settings;
use leadscrew_client::{Axis, Kind, Line, Options};
use support::rig::{IDENTITY, settings};

/// A board without an axis, with room for one thing.
#[derive(Default)]
struct Board {
    work: Vec<u8>,
    stored: Vec<u8>,
    restarts: u32,
    /// Ticks until it answers again.
    away: u32,
}

impl Port for Board {
    fn order(&mut self, _: &Order) -> Result<Passed, Refusal> {
        Ok(Passed::Taken)
    }

    fn reconfigure(&mut self, _: &AxisConfig) -> Result<Passed, Refusal> {
        Ok(Passed::Taken)
    }

    fn serve(
        &mut self,
        request: &Request<'_>,
        _: &Settings,
        say: &mut dyn FnMut(&Reply<'_>),
    ) -> Result<(), Refusal> {
        match *request {
            Request::Stored { kind } => say(&Reply::Stored {
                kind,
                version: 3,
                length: self.stored.len() as u32,
                crc: checksum(&self.stored),
            }),
            Request::ReadStored { offset, .. } => {
                let rest = &self.stored[offset as usize..];
                let bytes = &rest[..rest.len().min(150)];
                say(&Reply::Bytes { offset, bytes });
            }
            Request::WriteBytes { offset, bytes } => {
                let offset = offset as usize;
                assert!(offset.is_multiple_of(4));
                self.work
                    .resize(self.work.len().max(offset + bytes.len()), 0);
                self.work[offset..offset + bytes.len()].copy_from_slice(bytes);
            }
            Request::SaveBytes { length, crc, .. } => {
                let bytes = &self.work[..length as usize];
                if checksum(bytes) != crc {
                    return Err(Refusal::WrongChecksum);
                }
                self.stored = bytes.to_vec();
            }
            Request::Erase { .. } => self.stored.clear(),
            Request::Restart {} => {
                self.restarts += 1;
                self.away = 3000;
            }
            _ => return Err(Refusal::NotSupported),
        }
        Ok(())
    }
}

#[derive(Clone)]
struct BoardLine {
    board: Rc<RefCell<Board>>,
    service: Rc<RefCell<Service>>,
    tick: u32,
}

fn service() -> Service {
    let mut settings = settings();
    let config = settings.validate().unwrap();
    Service::new(IDENTITY, &settings, &config)
}

impl BoardLine {
    fn new() -> Self {
        Self {
            board: Rc::default(),
            service: Rc::new(RefCell::new(service())),
            tick: 0,
        }
    }
}

impl Line for BoardLine {
    fn exchange(&mut self, out: &[u8], received: &mut Vec<u8>) -> io::Result<Duration> {
        self.tick += 1;
        let mut board = self.board.borrow_mut();
        let mut service = self.service.borrow_mut();
        if board.away == 0 {
            let seen = Seen {
                tick: self.tick,
                ..Seen::default()
            };
            service.receive(out, &seen, &mut *board, &mut |frame| {
                received.extend_from_slice(frame);
            });
        } else {
            board.away -= 1;
            *service = self::service();
        }
        Ok(Duration::from_millis(self.tick.into()))
    }

    fn name(&self) -> String {
        "board".to_owned()
    }
}

#[test]
fn what_was_read_back_is_what_was_written() {
    let line = BoardLine::new();
    let mut axis = Axis::open(line.clone(), Options::default()).unwrap();
    for length in [1, 199, 200, 201, 5000] {
        let bytes: Vec<u8> = (0..length).map(|at: u32| (at * 7 % 251) as u8).collect();
        axis.write_stored(Kind::EncoderMap, &bytes).unwrap();
        assert_eq!(line.board.borrow().stored, bytes);
        assert_eq!(axis.stored(Kind::EncoderMap).unwrap().length, length);
        assert_eq!(axis.read_stored(Kind::EncoderMap).unwrap(), bytes);
    }
    axis.erase(None).unwrap();
    assert!(axis.read_stored(Kind::EncoderMap).unwrap().is_empty());
    let error = axis.save_parameters().unwrap_err();
    assert_eq!(error.refusal(), Some(Refusal::NotSupported));
}

#[test]
fn an_axis_that_restarts_is_waited_for() {
    let line = BoardLine::new();
    let mut axis = Axis::open(line.clone(), Options::default()).unwrap();
    axis.set_parameter("motion.max_feed_mm_per_min", 6000.0)
        .unwrap();
    axis.restart().unwrap();
    assert_eq!(
        (line.board.borrow().restarts, line.board.borrow().away),
        (1, 0)
    );
    let feed = axis.parameter("motion.max_feed_mm_per_min").unwrap();
    assert_eq!(feed.number(), Some(9000.0), "it was not saved");
}
