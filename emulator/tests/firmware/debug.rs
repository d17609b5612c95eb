use crate::session::Board;
use leadscrew_emulator::Emulator as _;
#[test]
fn after_reset() {
    let board = Board::blank();
    let show = |board: &Board, what: &str| {
        let frames = board.machine(|m| m.converter().frames());
        board.with(|axis| {
            let p = axis.part();
            let w = |a| p.peek(a).unwrap_or(0xdead);
            println!("TR {what} {} resets {} frames {frames:?} tim8 {:x} cr1 {:x} dier {:x} usart cr1 {:x} sr {:x} brr {:x} nvic {:x} {:x} {}", p.now()/84000, p.resets(), w(0x40010424), w(0x40010400), w(0x4001040c), w(0x4001100c), w(0x40011000), w(0x40011008), w(0xe000e100), w(0xe000e104), p.describe());
        });
    };
    board.run_ms(200); show(&board, "run");
    board.with(|a| a.part().poke(0x4001_0400, 0));
    board.run_ms(30); show(&board, "reset");
    for _ in 0..5 { board.run_ms(50); show(&board, "after"); }
    board.with(|a| a.part().send(leadscrew_emulator::Serial::Link, &[1,2,3,0]));
    board.run_ms(1); show(&board, "sent");
}
