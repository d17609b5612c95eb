use std::f64::consts::TAU;

use leadscrew_process::metrology::fitted::Settings;
use leadscrew_process::probing::stylus::{Artefact, Reference, calibrate, read};
use proptest::prelude::*;

use crate::{Noise, cases};

/// A probe with three lobes on its way to a trigger.
#[derive(Clone, Copy, Debug)]
struct Probe {
    radius_mm: f64,
    lobe_mm: f64,
    lobe_phase: f64,
    polar_mm: f64,
}

impl Probe {
    fn radius(&self, towards: [f64; 3]) -> f64 {
        let [x, y, z] = towards;
        let sine = x.hypot(y);
        let lobe = self.lobe_mm * sine.powi(3) * (3.0 * y.atan2(x) - self.lobe_phase).cos();
        self.radius_mm + lobe + self.polar_mm * (z * z - 1.0 / 3.0)
    }
}

const DIAMETER_MM: f64 = 25.0;
const CENTRE: [f64; 3] = [112.3, -40.7, 15.0];

/// Where the middle of the stylus is at the trigger, with the surface outwards of the centre.
fn trigger(artefact: Artefact, probe: &Probe, outwards: [f64; 3], noise_mm: f64) -> [f64; 3] {
    let side = if artefact == Artefact::Ring {
        1.0
    } else {
        -1.0
    };
    let towards = outwards.map(|part| part * side);
    let distance = 0.5 * DIAMETER_MM - side * probe.radius(towards) + noise_mm;
    [0, 1, 2].map(|axis| CENTRE[axis] + outwards[axis] * distance)
}

fn round(touches: usize) -> impl Iterator<Item = [f64; 3]> {
    (0..touches).map(move |number| {
        let (y, x) = (TAU * number as f64 / touches as f64 + 0.1).sin_cos();
        [x, y, 0.0]
    })
}

/// Over the upper half of a sphere.
fn dome() -> impl Iterator<Item = [f64; 3]> {
    [0.0, 0.3, 0.6, 0.85].into_iter().flat_map(|height: f64| {
        round(12).map(move |[x, y, _]| {
            let wide = (1.0 - height * height).sqrt();
            [x * wide, y * wide, height]
        })
    })
}

fn reference(artefact: Artefact, orders: u32) -> Reference {
    Reference {
        artefact,
        diameter_mm: DIAMETER_MM,
        orders,
    }
}

#[test]
fn three_touches_of_a_ring_give_the_effective_radius() {
    let probe = Probe {
        radius_mm: 2.987,
        lobe_mm: 0.0,
        lobe_phase: 0.0,
        polar_mm: 0.0,
    };
    for artefact in [Artefact::Ring, Artefact::Boss] {
        let triggers: Vec<_> = round(3)
            .map(|way| trigger(artefact, &probe, way, 0.0))
            .collect();
        let found = calibrate(&reference(artefact, 0), &triggers, &Settings::default()).unwrap();
        assert!((found.radius_mm.value - 2.987).abs() < 1e-9, "{found:?}");
        assert!((found.centre_mm[0].value - CENTRE[0]).abs() < 1e-9);
        assert_eq!(found.radius_mm.sigma, None);
    }
}

#[test]
fn a_touch_that_is_wrong_is_flagged() {
    let probe = Probe {
        radius_mm: 2.987,
        lobe_mm: 0.003,
        lobe_phase: 1.0,
        polar_mm: 0.0,
    };
    let mut noise = Noise::new(7);
    let mut triggers: Vec<_> = round(24)
        .map(|way| trigger(Artefact::Ring, &probe, way, 2e-4 * noise.next()))
        .collect();
    triggers[5][0] += 0.01;
    let settings = Settings {
        without_outliers: true,
        ..Settings::default()
    };
    let found = calibrate(&reference(Artefact::Ring, 3), &triggers, &settings).unwrap();
    assert_eq!(found.quality.outliers(), [5]);
    assert!((found.radius_mm.value - 2.987).abs() < 3e-4);
}

#[test]
fn what_does_not_tell_a_stylus_is_refused() {
    let probe = Probe {
        radius_mm: 3.0,
        lobe_mm: 0.0,
        lobe_phase: 0.0,
        polar_mm: 0.0,
    };
    let ring: Vec<_> = round(24)
        .map(|way| trigger(Artefact::Ring, &probe, way, 0.0))
        .collect();
    let message = |reference: Reference, triggers: &[[f64; 3]]| {
        calibrate(&reference, triggers, &Settings::default())
            .unwrap_err()
            .to_string()
    };
    let few = message(reference(Artefact::Ring, 3), &ring[..6]);
    assert!(few.contains("needs 7 touches or more, found 6"), "{few}");
    let one_side = message(
        reference(Artefact::Ring, 5),
        &[&ring[..2], &ring[..2], &ring[..8]].concat(),
    );
    assert!(one_side.contains("more directions"), "{one_side}");
    // A sphere touched at one height does not tell its centre along the stylus.
    let equator: Vec<_> = round(24)
        .map(|way| trigger(Artefact::Sphere, &probe, way, 0.0))
        .collect();
    let flat = message(reference(Artefact::Sphere, 0), &equator);
    assert!(flat.contains("several heights"), "{flat}");
    let none = Reference {
        diameter_mm: -1.0,
        ..reference(Artefact::Ring, 0)
    };
    assert_eq!(
        message(none, &ring),
        "diameter = -1 mm: expected more than 0"
    );
    let orders = message(reference(Artefact::Ring, 13), &ring);
    assert!(orders.contains("0 to 12"), "{orders}");
}

#[test]
fn tables_are_read_and_complained_about() {
    let triggers = read("x_mm,y_mm\n1,2\n", Artefact::Ring).unwrap();
    assert_eq!(triggers, [[1.0, 2.0, 0.0]]);
    let error = read("x_mm,y_mm\n1,2\n", Artefact::Sphere).unwrap_err();
    assert!(
        error.to_string().contains("there is no column \"z_mm\""),
        "{error}"
    );
}

fn probes() -> impl Strategy<Value = Probe> {
    (0.5..5.0, 0.0..0.01, 0.0..TAU, -0.005..0.005).prop_map(
        |(radius_mm, lobe_mm, lobe_phase, polar_mm)| Probe {
            radius_mm,
            lobe_mm,
            lobe_phase,
            polar_mm,
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases()))]

    #[test]
    fn a_random_probe_is_recovered_on_a_ring_and_a_boss(
        probe in probes(),
        seed in any::<u64>(),
        inside in any::<bool>(),
        noise_mm in 1e-5..1e-3,
    ) {
        let artefact = if inside { Artefact::Ring } else { Artefact::Boss };
        let probe = Probe { polar_mm: 0.0, ..probe };
        let mut noise = Noise::new(seed);
        let triggers: Vec<_> = round(36)
            .map(|way| trigger(artefact, &probe, way, noise_mm * noise.next()))
            .collect();
        let found = calibrate(&reference(artefact, 3), &triggers, &Settings::default()).unwrap();
        // Evenly spread, r₀ is a mean of 36 and an amplitude one of 18; 5σ of the two together.
        prop_assert!((found.radius_mm.value - probe.radius_mm).abs() < 5.0 * noise_mm / 6.0);
        for way in round(17) {
            let error = found.radius_towards(way) - probe.radius(way);
            prop_assert!(error.abs() < 5.0 * noise_mm * (5.0_f64 / 36.0).sqrt(), "{}", error);
        }
        for lobe in &found.lobes {
            let [cosine, sine] = [lobe.cosine_mm.value, lobe.sine_mm.value];
            let turns = (0..3600).map(|part| f64::from(part) * TAU / 3600.0);
            let largest = turns.map(|angle| (cosine * angle.cos() + sine * angle.sin()).abs()).fold(0.0, f64::max);
            prop_assert!((lobe.amplitude_mm - largest).abs() <= 1e-6 * lobe.amplitude_mm);
        }
        let sigma = found.radius_mm.sigma.unwrap() / (noise_mm / 6.0);
        prop_assert!(sigma > 0.5 && sigma < 1.6, "{}", sigma);
    }

    #[test]
    fn a_random_probe_is_recovered_on_a_sphere(
        probe in probes(),
        seed in any::<u64>(),
        noise_mm in 1e-5..1e-3,
    ) {
        let mut noise = Noise::new(seed);
        let triggers: Vec<_> = dome()
            .map(|way| trigger(Artefact::Sphere, &probe, way, noise_mm * noise.next()))
            .collect();
        let found = calibrate(&reference(Artefact::Sphere, 3), &triggers, &Settings::default()).unwrap();
        for way in dome() {
            let towards = way.map(|part| -part);
            let error = found.radius_towards(towards) - probe.radius(towards);
            // Half a sphere tells height, radius and polar part apart but weakly.
            prop_assert!(error.abs() < 25.0 * noise_mm, "{}", error);
        }
        let radius = found.radius_mm;
        prop_assert!((radius.value - probe.radius_mm).abs() < 6.0 * radius.sigma.unwrap());
    }
}
