//! `calibrate-probe`.

use std::fmt::Write as _;

use crate::Folder;

#[test]
fn a_delay_comes_out_of_two_files() {
    let folder = Folder::new();
    // 100 mm/min are 5/3 mm/s: 600 µs are 1 µm.
    let table = |feed: f64| {
        let mut text = String::from("touch,position_mm,velocity_mm_per_min\n");
        for touch in 0..10 {
            let scatter = if touch % 2 == 0 { 1e-5 } else { -1e-5 };
            let _ = writeln!(text, "{touch},{:.6},{feed}", 15.0 + feed * 1e-5 + scatter);
        }
        text
    };
    folder.write("slow.csv", table(100.0));
    folder.write("fast.csv", table(300.0));
    let text = folder.printed("calibrate-probe delay slow.csv fast.csv");
    assert!(text.contains("trigger delay  600.0 ± "), "{text}");
    let json = folder.json("calibrate-probe delay slow.csv fast.csv");
    assert_eq!(json["schema"], "leadscrew/calibrate-probe-delay/1");
    let delay = json["delay_s"]["value"].as_f64().unwrap();
    assert!((delay - 6e-4).abs() < 1e-6, "{delay}");
    let error = folder.refused(1, "calibrate-probe delay slow.csv");
    assert!(error.contains("touch at half of it too"), "{error}");
    folder.write("bad.csv", "position_mm,velocity_mm_per_min\n1,two\n");
    let error = folder.refused(1, "calibrate-probe delay bad.csv");
    assert!(error.contains("bad.csv:2:3: "), "{error}");
}

#[test]
fn a_stylus_comes_out_of_a_ring() {
    let folder = Folder::new();
    let mut text = String::from("x_mm,y_mm\n");
    for touch in 0..24 {
        let angle = f64::from(touch) * std::f64::consts::TAU / 24.0;
        // r = 2.99 + 0.002·cos 3φ.
        let distance = 12.5 - 2.99 - 0.002 * (3.0 * angle).cos();
        let _ = writeln!(
            text,
            "{},{}",
            3.0 + distance * angle.cos(),
            distance * angle.sin()
        );
    }
    folder.write("ring.csv", text);
    let text = folder.printed("calibrate-probe stylus ring.csv --ring 25 --ball-radius 3");
    for expected in [
        "effective radius  2.99000",
        "lobing            0.00400 mm",
        "order 3           cos 0.00200",
        "         0      2.99200          0.00800",
    ] {
        assert!(text.contains(expected), "{expected:?} in {text}");
    }
    folder.refused(2, "calibrate-probe stylus ring.csv");
    for (code, arguments, said) in [
        (
            1,
            "--ring -25",
            "ring.csv: diameter = -25 mm: expected more than 0",
        ),
        (1, "--ring 25 --orders 13", "ring.csv: orders = 13"),
        (
            2,
            "--ring 25 --ball-radius -3",
            "--ball-radius = -3 is out of range",
        ),
    ] {
        let error = folder.refused(
            code,
            &format!("calibrate-probe stylus ring.csv {arguments}"),
        );
        assert!(error.contains(said), "{arguments}: {error}");
    }
    folder.write("few.csv", "x_mm,y_mm\n0,1\n1,0\n");
    let error = folder.refused(1, "calibrate-probe stylus few.csv --ring 25");
    assert!(
        error.contains("few.csv: a stylus needs 7 touches or more, found 2"),
        "{error}"
    );
}

#[test]
fn a_run_out_comes_out_of_half_a_turn() {
    let folder = Folder::new();
    folder.write(
        "turned.csv",
        "along,angle_deg,position_mm\nx,0,9.98\nx,180,10.02\n",
    );
    let text = folder.printed("calibrate-probe run-out turned.csv");
    assert!(text.contains("stylus in x  0.02000 mm"), "{text}");
    assert!(text.contains("stylus in y  not seen"), "{text}");
}
