//! Every number of P1 and P3.

use leadscrew::units::{
    AxisScale, discrete_mm, line_frequency_hz, lines_for_feed, lines_for_rotation,
};
use leadscrew_process::plan::cycle::{chord_error_d, frequency_hz, step_d};
use leadscrew_process::plan::{Kinematics, Limit};

use super::{assert_near, axis_of, plan_of};

#[test]
fn p1_velocities_and_accelerations() {
    let scale = AxisScale::new(1000.0, 1000.0).unwrap();
    for (feed, velocity) in [(20_000.0, 333.3), (9000.0, 150.0), (6000.0, 100.0)] {
        assert_near(scale.velocity_from_feed(feed).unwrap(), velocity, 0.05);
        assert_near(step_d(feed, 1000.0, 1000.0), velocity, 0.05);
    }
    assert_near(scale.acceleration_from_overload(2.0).unwrap(), 19.6, 0.05);
    let fast = AxisScale::new(1000.0, 2500.0).unwrap();
    assert_near(fast.acceleration_from_overload(2.0).unwrap(), 3.1392, 1e-9);
    assert_near(scale.overload_from_acceleration(2.1), 0.214, 0.0005);
    assert_near(scale.overload_from_acceleration(0.9), 0.092, 0.0005);
}

#[test]
fn p1_lines_and_discretes() {
    assert_near(lines_for_feed(300e3, 10.0, 7500.0).unwrap(), 24_000.0, 1e-9);
    assert_near(discrete_mm(10.0, 24_000.0).unwrap(), 1.04e-4, 5e-7);
    assert_near(lines_for_feed(300e3, 10.0, 60_000.0).unwrap(), 3000.0, 1e-9);
    assert_near(discrete_mm(10.0, 3000.0).unwrap(), 0.83e-3, 5e-6);
    assert_near(lines_for_rotation(300e3, 2000.0).unwrap(), 9000.0, 1e-9);
    assert_near(lines_for_rotation(300e3, 10_000.0).unwrap(), 1800.0, 1e-9);
}

#[test]
fn p1_the_lathe_of_the_retrofit() {
    let plan = plan_of("16K20F3");
    let z = &plan.axes[0];
    assert_near(z.discrete_mm, 0.001, 1e-12);
    assert_near(z.encoder.largest_lines.unwrap(), 24_000.0, 1e-6);
    assert!(!z.encoder.is_max_line_own);
    assert_near(
        plan.spindles[0].encoder.largest_lines.unwrap(),
        9000.0,
        1e-6,
    );
    assert_near(plan.spindles[0].counts_per_revolution, 10_000.0, 0.0);
    let z = &plan_of("16K20F3 retrofit").axes[0];
    assert_near(z.velocity_d_per_tick, 150.0, 1e-9);
    assert_near(z.acceleration_d_per_tick2, 2.1, 1e-9);
    assert_near(z.overload_g, 0.214, 0.0005);
    // 900 rpm of 2 500 lines.
    assert_near(
        z.encoder.line_hz,
        line_frequency_hz(900.0, 2500.0).unwrap(),
        1e-6,
    );
    assert_near(z.encoder.edge_hz, 150e3, 1e-6);
}

#[test]
fn p3_rational_frequencies_of_today_and_tomorrow() {
    // k, overload, what the closed form gives, what the paper rounds it to.
    for (counts_per_mm, overload, frequency) in [
        (1e3, 0.1, 350.0),
        (1e3, 1.0, 1107.0),
        (1e5, 0.1, 3502.0),
        (1e5, 1.0, 11_074.0),
        (1e5, 10.0, 35_018.0),
    ] {
        let axis = axis_of(1e5, overload, None, counts_per_mm);
        assert_near(axis.closed_form_hz(1.0), frequency, 0.6);
    }
}

#[test]
fn p3_the_full_formula_gives_the_same_where_the_jerk_leaves_it_the_acceleration() {
    // Jerks of figure 4 with the overloads that they belong to. At the 100 m/min of the paper the jerk still holds the axis
    // of 10 g back, below 35 018 Hz.
    for (counts_per_mm, overload, jerk, frequency) in
        [(1e3, 0.1, 50.0, 350.2), (1e5, 10.0, 5000.0, 35_018.0)]
    {
        let cycle = axis_of(1.2e5, overload, Some(jerk), counts_per_mm)
            .rational_cycle(1.0)
            .unwrap();
        assert_near(cycle.frequency_hz, frequency, 0.001 * frequency);
        assert!(cycle.frequency_hz >= cycle.closed_form_hz);
        assert_eq!(cycle.ruled_by, Limit::Acceleration);
    }
}

#[test]
fn p3_crossovers_of_figure_3() {
    let mikron = plan_of("MIKRON UCP 710");
    let [x, z] = [&mikron.axes[0], &mikron.axes[1]];
    // Jerk rules at every radius shown, 80 mm and less.
    assert!(x.crossover_radius_mm.unwrap() > 80.0);
    assert_near(z.crossover_radius_mm.unwrap(), 3.7, 0.01);
    let ma655 = &plan_of("MA655SM30A").axes[0];
    assert_near(ma655.crossover_radius_mm.unwrap(), 55.0, 0.5);
    assert_near(ma655.full_feed_radius_mm, 40.0, 1e-9);
    assert_eq!(ma655.full_feed_limit, Limit::Jerk);
    // Turned round: what makes 40 and 55 mm of 6 000 mm/min.
    let speed: f64 = 0.1;
    let jerk = speed.powi(3) / (0.04 * 0.04);
    assert_near(jerk, 0.625, 1e-12);
    assert_near((0.055 * jerk * jerk).cbrt() / 9.81, 0.0283, 5e-5);
}

#[test]
fn p3_the_allowed_feed_gives_back_acceleration_and_jerk() {
    let axis = axis_of(1e6, 0.1, Some(5.0), 1000.0);
    for radius in [0.25, 3.7, 80.0] {
        let speed = axis.feed_by_acceleration(radius) / 60.0;
        // P3 (7), (8).
        assert_near(speed * speed / radius / (1000.0 * 9.81), 0.1, 1e-12);
        let speed = axis.feed_by_jerk(radius).unwrap() / 60.0;
        // P3 (10).
        assert_near(speed.powi(3) / (radius * radius), 5000.0, 1e-8);
    }
}

#[test]
fn p3_a_cycle_at_the_frequency_of_formula_4_leaves_the_allowed_error() {
    for (feed, radius, counts_per_mm, allowed) in [
        (6000.0, 5.0, 1000.0, 1.0),
        (100.0, 0.0011, 1000.0, 1.0),
        (30_000.0, 1e6, 1e5, 0.25),
    ] {
        let frequency = frequency_hz(feed, radius, counts_per_mm, allowed);
        let error = chord_error_d(feed, radius, counts_per_mm, frequency).unwrap();
        assert_near(error, allowed, 1e-9 * allowed);
        // An order faster, two orders nearer (P3 after formula 2).
        let error = chord_error_d(feed, radius, counts_per_mm, 10.0 * frequency).unwrap();
        assert!((0.005..0.0101).contains(&(error / allowed)), "{error}");
    }
    // As formula 1 is written, where its two large numbers do not differ too little.
    let [radius, feed, hz]: [f64; 3] = [0.25, 6000.0, 1000.0];
    let (r, half) = (radius * 1000.0, feed * 1000.0 / (120.0 * hz));
    let written = r - (r * r - half * half).sqrt();
    assert_near(
        chord_error_d(feed, radius, 1000.0, hz).unwrap(),
        written,
        1e-9,
    );
    assert_eq!(chord_error_d(6000.0, 0.01, 1000.0, 1000.0), None);
}

#[test]
fn p3_the_machines_of_its_list() {
    for (name, feed, least, most) in [
        ("6R13GN1", 1000.0, 0.006, 0.01),
        ("FP7M", 1500.0, 0.006, 0.012),
        ("FP7SMN", 4500.0, 0.012, 0.02),
        ("MA655SM30A", 6000.0, 0.02, 0.1),
        ("16K20F3", 7500.0, 0.02, 0.08),
    ] {
        let plan = plan_of(name);
        assert_near(plan.largest.max_feed_mm_per_min(), feed, 0.0);
        assert_near(plan.largest.max_acceleration_m_s2() / 9.81, most, 1e-12);
        let least_given = plan.axes.iter().find_map(|axis| axis.least_overload_g);
        assert_eq!(least_given, Some(least));
        // 350 Hz serve all of them at 1 000 d/mm; the cross slide of the lathe is finer.
        let at_1000 = Kinematics::new(
            feed,
            plan.largest.max_acceleration_m_s2(),
            plan.largest.max_jerk_m_s3(),
            1000.0,
        );
        assert!(at_1000.unwrap().rational_cycle(1.0).unwrap().frequency_hz <= 350.2);
    }
}
