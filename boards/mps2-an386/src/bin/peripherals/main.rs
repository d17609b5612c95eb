//! The drivers of the board by themselves, for their tests.
//!
//! What comes on the link, in lockstep or on UART 0, and on UART 1 goes back where it came from; [`RESTART`] on the link
//! restarts. With `save=yes` it saves a table to the flash again and again, each with the next number in all its points,
//! and tells every number that was saved. With `flash=PATH` or `save=yes` it says at its start which number the store has.
//!
//! Arguments: `lockstep=FOLDER`, `flash=PATH`, `save=yes`.
#![no_std]
#![no_main]

mod saving;

use board_common::line::Bytes as _;
use board_mps2_an386::carrier::{Carrier, Path};
use board_mps2_an386::lockstep::Turn;
use board_mps2_an386::uart::{Queues, UART0, UART1};
use board_mps2_an386::{arguments, exit_failure, exit_success, restart, simulated, time_driver};
use embassy_executor::Spawner;
use embassy_time::{Duration, Ticker};
use leadscrew_app::store::Interlock;
use static_cell::ConstStaticCell;

use saving::Saving;

/// The byte that restarts: Ctrl-R.
const RESTART: u8 = 0x12;
const BAUD: u32 = 115_200;

#[derive(Default)]
struct Words {
    lockstep: Option<Path>,
    flash: Option<Path>,
    saves: bool,
}

#[embassy_executor::main]
async fn main(_spawner: Spawner) {
    static QUEUES: ConstStaticCell<Queues> = ConstStaticCell::new(Queues::new());
    let words = words();
    let opened = Carrier::open(words.lockstep.as_deref(), BAUD);
    let Ok(mut link) = opened.inspect_err(|error| defmt::error!("lockstep: {}", error)) else {
        exit_failure()
    };
    let mut second = UART1.open(BAUD, QUEUES.take());
    time_driver::start();
    simulated::unmask(&[&UART0, &UART1]);
    let interlock = Interlock::new();
    let has_store = words.saves || words.flash.is_some();
    let mut saving = has_store.then(|| Saving::open(words.flash.as_deref(), &interlock));
    defmt::info!("up");

    let mut ticker = Ticker::every(Duration::from_millis(1));
    for tick in 0.. {
        match link.keep_step(tick) {
            Ok(Turn::Run) => {}
            Ok(Turn::End) => {
                defmt::info!("ended at {=u32}", tick);
                exit_success()
            }
            Err(error) => {
                defmt::error!("lockstep: {}", error);
                exit_failure()
            }
        }
        let mut bytes = [0; 256];
        let count = link.read(&mut bytes);
        if bytes[..count].contains(&RESTART) {
            restart();
        }
        link.send(&bytes[..count]);
        let count = second.read(&mut bytes);
        second.send(&bytes[..count]);
        if words.saves
            && let Some(saving) = &mut saving
        {
            link.send(saving.save_next().as_bytes());
        }
        ticker.next().await;
    }
}

fn words() -> Words {
    let mut words = Words::default();
    let result = arguments(|word| {
        let path = |text: &str| {
            Path::try_from(text)
                .map_err(|_| defmt::error!("{=str}: a path too long", text))
                .map(Some)
        };
        match word.split_once('=') {
            Some(("lockstep", folder)) => words.lockstep = path(folder)?,
            Some(("flash", file)) => words.flash = path(file)?,
            Some(("save", "yes")) => words.saves = true,
            _ => {
                defmt::error!(
                    "argument {=str}: the words are lockstep=FOLDER, flash=PATH, save=yes",
                    word
                );
                return Err(());
            }
        }
        Ok(())
    });
    if result.is_err() {
        exit_failure();
    }
    words
}
