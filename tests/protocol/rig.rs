//! A tool, a line of bytes, the service and an axis on its machine.

use leadscrew::axis::{Axis, Outputs, Request as AxisRequest};
use leadscrew::estimator::EstimatorConfig;
use leadscrew::hal::Reference;
use leadscrew::params::AxisConfig;
use leadscrew::protocol::client::{Answer, Client};
use leadscrew::protocol::refusal::Refusal;
use leadscrew::protocol::reply::{CAN_HOME, CAN_SET, Reply};
use leadscrew::protocol::request::Request;
use leadscrew::protocol::service::{Identity, Order, Passed, Port, Seen, Service};
use leadscrew::settings::Settings;
use leadscrew::supervisor::State;
use leadscrew::telemetry::Record;
use leadscrew_hal_mock::board::{Board, BoardParams};
use leadscrew_hal_mock::machine::MachineParams;
use leadscrew_hal_mock::scenario::MoveAndBack;

pub const IDENTITY: Identity = Identity {
    firmware: "0.1.0",
    build: "0123abcd",
    board: "simulated",
    capabilities: CAN_HOME | CAN_SET,
    work_memory: 40_960,
    lead_ticks: 4,
};

/// How an answer ended, for tests.
#[derive(Clone, Debug, PartialEq)]
pub enum Said {
    Ack,
    Refused(Refusal),
    Status {
        flags: u16,
        state: u8,
        position_nm: i64,
        setpoint_nm: i64,
    },
    Parameter(f64),
    Other,
}

impl Said {
    fn of(reply: &Reply<'_>) -> Self {
        match *reply {
            Reply::Ack { .. } => Self::Ack,
            Reply::Refused { reason, .. } => Self::Refused(Refusal::from_number(reason).unwrap()),
            Reply::Status {
                flags,
                state,
                position_nm,
                setpoint_nm,
                ..
            } => Self::Status {
                flags,
                state,
                position_nm,
                setpoint_nm,
            },
            Reply::Parameter { value, .. } => Self::Parameter(value),
            _ => Self::Other,
        }
    }
}

/// The axis as the service reaches it.
pub struct Way {
    pub axis: Axis<'static>,
    pub enable: bool,
    /// Plans that the axis took, and other requests that could move it.
    pub motions: u32,
    /// Enables that were asked for.
    pub enables: u32,
    /// There is no way on.
    pub is_blocked: bool,
    /// Feed at full command that the inputs follow as they are, and that they follow after a restart, mm/min.
    pub followed: Option<(f64, f64)>,
}

impl Port for Way {
    fn order(&mut self, order: &Order) -> Result<Passed, Refusal> {
        if self.is_blocked {
            return Err(Refusal::QueueFull);
        }
        match order {
            Order::Enable(enable) => {
                self.enable = *enable;
                self.enables += u32::from(*enable);
            }
            Order::Axis(request) => {
                self.axis.take(request)?;
                let moves = matches!(request, AxisRequest::Queue { .. } | AxisRequest::Home);
                self.motions += u32::from(moves);
            }
        }
        Ok(Passed::Taken)
    }

    fn reconfigure(&mut self, config: &AxisConfig) -> Result<Passed, Refusal> {
        self.axis.reconfigure(config)?;
        Ok(Passed::Taken)
    }

    fn check(&self, settings: &Settings) -> Result<(), Refusal> {
        let feed = settings.axis.motion.full_command_feed_mm_per_min;
        match self.followed {
            Some((_, at_most)) if feed > at_most => Err(Refusal::TooFastForInputs),
            Some((now, _)) if feed > now => Err(Refusal::RestartNeeded),
            _ => Ok(()),
        }
    }
}

pub fn settings() -> Settings {
    let scenario = MoveAndBack::standard(1000.0);
    let machine = MachineParams::z_16k20f3();
    let estimator = EstimatorConfig::by_name("simple").unwrap().unwrap();
    let estimator = scenario.tuned(&machine, estimator, false).unwrap();
    let axis = scenario.axis_params(&machine, estimator).unwrap();
    Settings {
        axis,
        ..Settings::new(estimator)
    }
}

pub struct Rig {
    pub board: Board,
    pub way: Way,
    pub service: Service,
    pub client: Client,
    /// Bytes on their way to the axis, and to the tool.
    pub to_axis: Vec<u8>,
    pub to_tool: Vec<u8>,
    /// What the tool heard, by sequence.
    pub heard: Vec<(u16, Said)>,
    pub records: Vec<Record>,
    /// The last tick that the axis told of.
    pub told_tick: u32,
    /// The tool renews its lease, so many ticks after the last time.
    pub renew_every: Option<u32>,
    next_nonce: u32,
    /// The service has no time: the axis goes on without it.
    pub is_busy: bool,
}

impl Rig {
    pub fn new() -> Self {
        let mut settings = settings();
        let config = settings.validate().unwrap();
        Self {
            board: Board::new(
                &BoardParams::default(),
                &MachineParams::z_16k20f3(),
                1000.0,
                1,
            )
            .unwrap(),
            way: Way {
                axis: Axis::new(config),
                enable: false,
                motions: 0,
                enables: 0,
                is_blocked: false,
                followed: None,
            },
            service: Service::new(IDENTITY, &settings, &config),
            client: Client::new(),
            to_axis: Vec::new(),
            to_tool: Vec::new(),
            heard: Vec::new(),
            records: Vec::new(),
            told_tick: 0,
            renew_every: None,
            next_nonce: 1,
            is_busy: false,
        }
    }

    /// One tick of everything; the line carries all that is on it, byte by byte.
    pub fn step(&mut self) -> Outputs {
        self.board.step(self.way.axis.outputs());
        let inputs = self.board.inputs(self.way.enable, Reference::default());
        let outputs = *self.way.axis.step(&inputs);
        if self.is_busy {
            return outputs;
        }
        let seen = Seen::of(&self.way.axis);
        if self
            .renew_every
            .is_some_and(|every| outputs.tick.is_multiple_of(every))
        {
            self.post(&Request::RenewLease {
                seen: self.told_tick,
            });
        }
        if let Some(frame) = self.service.record(&Record::new(&outputs)) {
            self.to_tool.extend_from_slice(frame);
        }
        self.service.poll(&seen, &mut self.way);
        let to_tool = &mut self.to_tool;
        for byte in std::mem::take(&mut self.to_axis) {
            self.service
                .receive(&[byte], &seen, &mut self.way, &mut |frame| {
                    to_tool.extend_from_slice(frame);
                });
        }
        self.listen();
        outputs
    }

    fn listen(&mut self) {
        let bytes = std::mem::take(&mut self.to_tool);
        self.client.receive(&bytes, |answer| match answer {
            Answer::Reply(sequence, reply) => {
                if let Reply::Ack { tick }
                | Reply::Refused { tick, .. }
                | Reply::Status { tick, .. }
                | Reply::Hello { tick, .. } = reply
                {
                    self.told_tick = tick;
                }
                self.heard.push((sequence, Said::of(&reply)));
            }
            Answer::Record(record) => self.records.push(record),
            Answer::Samples(_) => panic!("nobody asked for samples"),
        });
    }

    pub fn run(&mut self, ticks: u32) -> Outputs {
        (0..ticks).for_each(|_| _ = self.step());
        *self.way.axis.outputs()
    }

    /// Puts a request on the line, and says of which bytes it is.
    pub fn post(&mut self, request: &Request<'_>) -> Vec<u8> {
        let frame = self.client.request(request).unwrap().to_vec();
        self.to_axis.extend_from_slice(&frame);
        frame
    }

    /// Asks and waits for the answer.
    #[track_caller]
    pub fn ask(&mut self, request: &Request<'_>) -> Said {
        self.post(request);
        let sequence = self.client.sequence();
        self.step();
        let answers: Vec<_> = self
            .heard
            .iter()
            .filter(|(of, _)| *of == sequence)
            .collect();
        assert_eq!(answers.len(), 1, "{request:?}");
        answers[0].1.clone()
    }

    #[track_caller]
    pub fn do_(&mut self, request: &Request<'_>) {
        assert_eq!(self.ask(request), Said::Ack, "{request:?}");
    }

    #[track_caller]
    pub fn refused(&mut self, request: &Request<'_>, refusal: Refusal) {
        assert_eq!(self.ask(request), Said::Refused(refusal), "{request:?}");
    }

    /// A session, another one each time.
    #[track_caller]
    pub fn hello(&mut self) {
        let nonce = self.next_nonce;
        self.next_nonce += 1;
        let hello = Request::Hello { protocol: 1, nonce };
        assert_eq!(self.ask(&hello), Said::Other);
        assert_ne!(self.client.session(), 0);
    }

    /// A session with the lease, renewed from now on, and the axis ready.
    #[track_caller]
    pub fn ready(&mut self) {
        self.hello();
        self.enabled();
    }

    /// The same in the session that is open.
    #[track_caller]
    pub fn enabled(&mut self) {
        self.do_(&Request::TakeLease {});
        self.renew_every = Some(30);
        self.do_(&Request::Enable {});
        for _ in 0..2000 {
            if self.step().state == State::Ready {
                return;
            }
        }
        panic!("not ready: {:?}", self.way.axis.outputs());
    }

    /// A move in whole mm at 6 000 mm/min.
    pub fn move_to(target_mm: i64) -> Request<'static> {
        Request::Move {
            target_nm: target_mm * 1_000_000,
            feed_um_per_min: 6_000_000,
        }
    }
}
