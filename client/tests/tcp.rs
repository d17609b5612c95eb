//! An axis behind a TCP server.

mod support;

use std::io::{ErrorKind, Read as _, Write as _};
use std::net::{TcpListener, TcpStream};
use std::thread;
use std::time::Duration;

use leadscrew_client::{Axis, DEFAULT_BAUD, Error, Options, Port};
use support::Bench;

/// Runs a bench for each that connects, some ticks between two looks at the line, for `connections` of them.
fn serve(listener: &TcpListener, connections: usize) {
    for stream in listener.incoming().take(connections) {
        let mut bench = Bench::new();
        while talk(&mut bench, stream.as_ref().unwrap()) {}
    }
}

/// False once the other side has gone.
fn talk(bench: &mut Bench, mut stream: &TcpStream) -> bool {
    stream
        .set_read_timeout(Some(Duration::from_millis(1)))
        .unwrap();
    let mut buffer = [0; 1024];
    let mut bytes: &[u8] = match stream.read(&mut buffer) {
        Ok(0) => return false,
        Ok(count) => &buffer[..count],
        Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) => &[],
        Err(_) => return false,
    };
    let mut answer = Vec::new();
    for _ in 0..5 {
        bench.step(std::mem::take(&mut bytes), &mut answer);
    }
    stream.write_all(&answer).is_ok()
}

#[test]
fn an_axis_is_moved_over_tcp() {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let port: Port = format!("tcp:{}", listener.local_addr().unwrap())
        .parse()
        .unwrap();
    let server = thread::spawn(move || serve(&listener, 1));
    let mut axis = Axis::open(port.open(DEFAULT_BAUD).unwrap(), Options::default()).unwrap();
    assert_eq!(axis.connection().port(), port.to_string());
    // Whether its lease lives through a stall of a busy computer is not for a test to say; that it is reached is.
    let moved = axis.enable().and_then(|_| axis.move_and_wait(2.0, 1200.0));
    match moved {
        Ok(status) => assert!((status.setpoint_mm - 2.0).abs() < 1e-6),
        Err(error) => assert!(
            matches!(error, Error::LeaseLapsed | Error::DisabledMeanwhile { .. }),
            "{error}"
        ),
    }
    assert!(axis.status().unwrap().tick > 0);
    drop(axis);
    server.join().unwrap();
}

#[test]
fn a_server_that_goes_is_told_of() {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = listener.local_addr().unwrap();
    let port: Port = format!("tcp:{address}").parse().unwrap();
    let server = thread::spawn(move || drop(listener.accept().unwrap()));
    let line = port.open(DEFAULT_BAUD).unwrap();
    server.join().unwrap();
    let Err(error) = Axis::open(line, Options::default()) else {
        panic!("opened");
    };
    assert!(
        matches!(error, Error::Line { .. }) && error.is_lost(),
        "{error}"
    );
    let Err(error) = port.open(DEFAULT_BAUD) else {
        panic!("opened");
    };
    let text = error.to_string();
    assert!(
        text.contains(&port.to_string()) && text.contains("Nobody listens there"),
        "{text}"
    );
}
