//! What is saved is read back; wear; refusals.

use leadscrew::compensation::table::ScrewPoint;
use leadscrew::estimator::EstimatorConfig;
use leadscrew::estimator::exponential;
use leadscrew::estimator::observer::Config;
use leadscrew::estimator::paths::Choice;
use leadscrew::units::AxisScale;
use leadscrew_app::store::{Error, Kind, SET_BYTES, Saved, Source, Store};

use super::contents::{
    bytes, defaults, load, map_image, mounted, permission, screw_points, settings,
};
use super::flash::SimFlash;

/// As of an STM32F4 with 4 KB sectors set apart in an external flash.
type Flash = SimFlash<4096, 4>;

#[test]
fn all_of_it_outlives_the_power() {
    let mut flash = Flash::new(18);
    let (map, points) = (map_image(1, 10_000), screw_points(1, 256));
    let permission = permission();
    let work = &mut [0; SET_BYTES];
    let mut store = mounted(&mut flash);
    assert_eq!(load(&mut store).0, defaults());
    assert_eq!(load(&mut store).1.source, Source::Defaults);
    let saved = [
        store.save_params(&settings(1), work, &permission),
        store.save_map(&map, &permission),
        store.save_screw(&points, &permission),
    ];
    assert_eq!(saved, [Ok(Saved::Written); 3]);

    let mut flash = flash.powered(None);
    let mut store = mounted(&mut flash);
    let (found, report, findings) = load(&mut store);
    assert_eq!(found, settings(1));
    assert!(
        report.is_clean() && findings.is_empty(),
        "{report} {findings:?}"
    );
    let memory = &mut [0; 16 * 1024];
    assert_eq!(store.load_map(memory).unwrap().unwrap().edges(), 10_000);
    assert_eq!(bytes(&mut store, Kind::EncoderMap), Some(map.clone()));
    let memory = &mut [ScrewPoint::default(); 256];
    let found = store.load_screw(memory, &mut [0; 4096]).unwrap();
    assert_eq!(found, Some(points.as_slice()));

    // The same again leaves the flash alone.
    let saved = [
        store.save_params(&settings(1), work, &permission),
        store.save_map(&map, &permission),
        store.save_screw(&points, &permission),
    ];
    assert_eq!(saved, [Ok(Saved::Unchanged); 3]);
    assert_eq!(flash.operations, 0);
    let mut store = mounted(&mut flash);
    let lens = Kind::ALL.map(|kind| store.entry(kind).unwrap().map(|entry| entry.len));
    println!("bytes: {lens:?}");

    let kinds = |store: &mut Store<_>, all| {
        let entries = store.entries(all);
        entries.map(|entry| entry.unwrap().kind).collect::<Vec<_>>()
    };
    assert_eq!(kinds(&mut store, false), [Kind::Parameters]);
    assert_eq!(kinds(&mut store, true), Kind::ALL);
    store.erase(Kind::EncoderMap, &permission).unwrap();
    assert_eq!(bytes(&mut store, Kind::EncoderMap), None);
    assert_eq!(
        kinds(&mut store, true),
        [Kind::Parameters, Kind::ScrewTable]
    );
    assert_eq!(load(&mut store).0, settings(1));
    store.erase_all(&permission).unwrap();
    assert_eq!(kinds(&mut store, true), []);
}

#[test]
fn estimators_and_paths_are_kept() {
    let mut flash = Flash::new(10);
    let mut store = mounted(&mut flash);
    for name in EstimatorConfig::NAMES {
        let mut settings = settings(2);
        settings.observer.natural_period_s = 0.1;
        let scale = AxisScale::new(settings.axis.motion.counts_per_mm, settings.axis.tick_hz);
        let observer = Config::new(&settings.observer, scale.unwrap()).unwrap();
        settings.axis.estimator = match EstimatorConfig::by_name(name) {
            Ok(Some(EstimatorConfig::Observer(_))) => EstimatorConfig::Observer(observer),
            other => other.unwrap().unwrap(),
        };
        settings.axis.second_estimator = Some(EstimatorConfig::Observer(observer));
        settings.axis.paths.display = Choice::Second;
        let saved = store.save_params(&settings, &mut [0; SET_BYTES], &permission());
        assert_eq!(saved, Ok(Saved::Written));
        assert_eq!(load(&mut store).0, settings, "{name}");
    }
    let mut settings = settings(2);
    let custom = exponential::Config::new(0.3).unwrap();
    settings.axis.estimator = EstimatorConfig::Exponential(custom);
    let saved = store.save_params(&settings, &mut [0; SET_BYTES], &permission());
    let name = "exponential";
    assert_eq!(saved, Err(Error::Estimator { name }));
}

#[test]
fn erasures_are_spread_over_the_sectors() {
    let mut flash = Flash::new(18);
    let mut store = mounted(&mut flash);
    let permission = permission();
    let image = map_image(1, 10_000);
    store.save_map(&image, &permission).unwrap();
    let work = &mut [0; SET_BYTES];
    for edition in 0..1000 {
        let saved = store.save_params(&settings(edition), work, &permission);
        assert_eq!(saved, Ok(Saved::Written), "{edition}");
    }
    assert_eq!(load(&mut store).0, settings(999));
    assert_eq!(bytes(&mut store, Kind::EncoderMap), Some(image));
    let (log, content) = flash.erasures.split_at(2);
    println!("erasures: log {log:?}, content {content:?}");
    let (least, most) = (content.iter().min(), content.iter().max());
    assert!(most.unwrap() - least.unwrap() <= 1, "{content:?}");
    assert!(log.iter().max() <= least, "{log:?}");
}

/// Sectors that hold everything at its largest in both slots, and not one too many.
fn needs<const SECTOR: usize, const WORD: usize>(sectors: usize) {
    let permission = permission();
    for (sectors, is_enough) in [(sectors, true), (sectors - 1, false)] {
        let mut flash = SimFlash::<SECTOR, WORD>::new(sectors);
        let mut store = mounted(&mut flash);
        let mut saved = |edition| {
            let map = map_image(edition, 10_000);
            let screw = screw_points(edition, 256);
            let work = &mut [0; SET_BYTES];
            store.save_params(&settings(edition), work, &permission)?;
            store.save_map(&map, &permission)?;
            store.save_screw(&screw, &permission)
        };
        let saved = [1, 2, 3].map(&mut saved);
        let fits = saved == [Ok(Saved::Written); 3];
        assert_eq!(fits, is_enough, "{sectors} of {SECTOR}: {saved:?}");
    }
}

#[test]
fn the_sizes_stated_suffice() {
    needs::<2048, 8>(31);
    needs::<4096, 4>(15);
    needs::<16384, 4>(6);
}

#[test]
fn a_full_store_keeps_what_it_has() {
    let mut flash = Flash::new(8);
    let permission = permission();
    let mut store = mounted(&mut flash);
    let work = &mut [0; SET_BYTES];
    store.save_params(&settings(1), work, &permission).unwrap();
    let image = map_image(1, 40_000);
    assert_eq!(store.save_map(&image, &permission), Err(Error::Full));
    assert_eq!(load(&mut store).0, settings(1));
    let mut flash = flash.powered(None);
    let mut store = mounted(&mut flash);
    assert_eq!(load(&mut store).0, settings(1));
    assert_eq!(bytes(&mut store, Kind::EncoderMap), None);
    // There is still room for what there was room for.
    let saved = store.save_params(&settings(2), work, &permission);
    assert_eq!(saved, Ok(Saved::Written));
    assert_eq!(load(&mut store).0, settings(2));
}

#[test]
fn what_cannot_be_is_refused() {
    let permission = permission();
    let mut flash = Flash::new(5);
    assert!(matches!(
        Store::mount(&mut flash, 0..4 * 4096, &permission),
        Err(Error::Range)
    ));
    assert!(matches!(
        Store::mount(&mut flash, 0..6 * 4096, &permission),
        Err(Error::Range)
    ));
    let mut store = mounted(&mut flash);
    let map = store.save_map(&[1; 100], &permission);
    assert!(matches!(map, Err(Error::Map(_))), "{map:?}");
    let screw = store.save_screw(&screw_points(1, 1), &permission);
    assert_eq!(screw, Err(Error::Points { count: 1 }));
    let params = store.save_params(&settings(1), &mut [0; 99], &permission);
    assert!(matches!(params, Err(Error::Memory { .. })), "{params:?}");
    assert_eq!(flash.operations, 0);
}

#[test]
fn damage_is_told_and_nothing_damaged_is_taken() {
    let mut flash = Flash::new(10);
    let permission = permission();
    let mut store = mounted(&mut flash);
    let work = &mut [0; SET_BYTES];
    store.save_params(&settings(1), work, &permission).unwrap();
    let name = b"motion.counts_per_mm";
    let at = flash
        .cells
        .windows(name.len())
        .position(|cells| cells == name);
    flash.cells[at.unwrap()] ^= 1;
    let mut store = mounted(&mut flash);
    let (found, report, _) = load(&mut store);
    assert_eq!((found, report.source), (defaults(), Source::Damaged));
    assert!(!report.is_clean());
    store.save_params(&settings(2), work, &permission).unwrap();
    assert_eq!(load(&mut store).0, settings(2));
}
