//! Connects to an axis, enables it, moves it and reads where it is: `cargo run -p leadscrew-client --example move -- COM3`.

use leadscrew_client::{Axis, DEFAULT_BAUD, Error, Options, Port};

fn main() -> Result<(), Error> {
    let address = std::env::args().nth(1);
    let port: Port = address.as_deref().unwrap_or("/dev/ttyACM0").parse()?;
    let mut axis = Axis::open(port.open(DEFAULT_BAUD)?, Options::default())?;
    println!("{} on {port}", axis.identity().board);

    axis.enable()?;
    let from_mm = axis.status()?.setpoint_mm;
    axis.move_and_wait(from_mm + 10.0, 600.0)?;
    let status = axis.status()?;
    println!(
        "at {:.4} mm, {:+.4} mm off the setpoint",
        status.position_mm, status.following_error_mm
    );
    axis.disable()?;
    axis.close()
}
