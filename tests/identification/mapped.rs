//! With a map of its encoder the drive is found more exactly.

use leadscrew::identification::{Figure, IdentifyParams};
use leadscrew_hal_mock::machine::MachineParams;
use leadscrew_host::commissioning::{learned, map_of};
use leadscrew_host::identify::Bench;

#[test]
fn a_tied_map_takes_the_disc_out_of_what_is_found() {
    let machine = MachineParams::z_16k20f3();
    let drive = &machine.drive;
    for seed in 1..=3 {
        let bench = Bench {
            machine,
            params: IdentifyParams::default(),
            tick_hz: 1000.0,
            nominal_feed_mm_per_min: 9600.0,
            reversed: false,
            seed,
        };
        let image = learned(&machine, seed).unwrap();
        let plain = bench.run(None).unwrap().identified;
        let mapped = bench.run(map_of(Some(&image))).unwrap().identified;
        let near = |figure: Figure, truth: f64| {
            let off = (figure.value - truth).abs();
            assert!(off < 3.0 * figure.sigma, "{seed}: {figure:?}, true {truth}");
        };
        near(mapped.natural_period_s, drive.natural_period_s);
        near(mapped.delay_s, drive.delay_s);
        let stribeck = mapped.stribeck.unwrap();
        let truth = mapped
            .scale
            .velocity_from_feed(drive.stribeck_mm_per_min)
            .unwrap();
        near(stribeck, truth);
        assert!(stribeck.sigma < 0.6 * plain.stribeck.unwrap().sigma);
        assert!(mapped.natural_period_s.sigma < 0.5 * plain.natural_period_s.sigma);
        assert!(mapped.residual_d < 0.6 * plain.residual_d);
    }
}
