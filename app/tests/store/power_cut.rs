//! The power is cut in every single operation of a save: what was saved before is there, and what was being saved is
//! there as it was or as it is to be.

use std::thread;

use leadscrew_app::store::{Error, Kind, SET_BYTES, Store};

use super::contents::{bytes, map_image, mounted, permission, screw_points, settings};
use super::flash::{PowerCut, SimFlash, Torn};

/// What is done in which the power is cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Task {
    Save(Kind),
    Erase(Kind),
}

fn perform<const SECTOR: usize, const WORD: usize>(
    flash: &mut SimFlash<SECTOR, WORD>,
    task: Task,
    edition: u32,
) -> Result<(), Error<PowerCut>> {
    let permission = permission();
    let end = flash.cells.len() as u32;
    let mut store = Store::mount(flash, 0..end, &permission)?;
    match task {
        Task::Save(Kind::Parameters) => store
            .save_params(&settings(edition), &mut [0; SET_BYTES], &permission)
            .map(drop),
        Task::Save(Kind::EncoderMap) => store
            .save_map(&map_image(edition, 1000), &permission)
            .map(drop),
        Task::Save(Kind::ScrewTable) => store
            .save_screw(&screw_points(edition, 60), &permission)
            .map(drop),
        Task::Erase(kind) => store.erase(kind, &permission),
    }
}

fn contents<const SECTOR: usize, const WORD: usize>(
    flash: &mut SimFlash<SECTOR, WORD>,
) -> [Option<Vec<u8>>; 3] {
    let mut store = mounted(flash);
    Kind::ALL.map(|kind| bytes(&mut store, kind))
}

/// What a task comes to, and what came of its cuts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Cuts {
    /// Words written and sectors erased.
    operations: u32,
    /// Sectors erased.
    erasures: u32,
    /// Cuts after which the old content was there.
    old: u32,
    /// Cuts after which the new content was there.
    new: u32,
    /// Cuts in the repair of a cut.
    in_repair: u32,
}

fn dry_run<const SECTOR: usize, const WORD: usize>(
    before: &SimFlash<SECTOR, WORD>,
    task: Task,
) -> (SimFlash<SECTOR, WORD>, Cuts) {
    let mut after = before.powered(None);
    perform(&mut after, task, 2).unwrap();
    let erasures = |flash: &SimFlash<SECTOR, WORD>| flash.erasures.iter().sum::<u32>();
    let cuts = Cuts {
        operations: after.operations,
        erasures: erasures(&after) - erasures(before),
        ..Cuts::default()
    };
    (after, cuts)
}

fn cut_everywhere<const SECTOR: usize, const WORD: usize>(
    before: &SimFlash<SECTOR, WORD>,
    task: Task,
) -> Cuts {
    let (after, mut cuts) = dry_run(before, task);
    let old = contents(&mut before.powered(None));
    let new = contents(&mut after.powered(None));
    assert!(old != new, "{task:?} of {SECTOR}");
    for operation in 0..cuts.operations {
        for torn in Torn::ALL {
            let case = format!("{task:?} cut in {operation}, {torn:?}");
            let mut flash = before.powered(Some((operation, torn)));
            assert!(perform(&mut flash, task, 2).is_err(), "{case}");
            let is_word = flash.erasures == before.erasures;
            if is_word && matches!(torn, Torn::Back | Torn::Cleared) {
                continue;
            }
            let cut = flash.powered(None);
            let mut flash = cut.powered(None);
            let found = contents(&mut flash);
            assert!(found == old || found == new, "{case}");
            cuts.old += u32::from(found == old);
            cuts.new += u32::from(found == new);
            for again in 0..flash.operations {
                let mut flash = cut.powered(Some((again, torn)));
                let end = flash.cells.len() as u32;
                let mount = Store::mount(&mut flash, 0..end, &permission()).err();
                assert_eq!(mount, Some(Error::Flash(PowerCut)), "{case}");
                let found = contents(&mut flash.powered(None));
                assert!(found == old || found == new, "{case}, then in {again}");
                cuts.in_repair += 1;
            }
            if operation % 5 == 0 || !is_word {
                let mut flash = flash.powered(None);
                perform(&mut flash, task, 2).unwrap();
                assert!(contents(&mut flash) == new, "{case}, and done again");
            }
        }
    }
    cuts
}

/// A store that was written until `task` comes over the end of a sector.
fn used<const SECTOR: usize, const WORD: usize>(
    sectors: usize,
    task: Task,
) -> SimFlash<SECTOR, WORD> {
    let mut flash = SimFlash::new(sectors);
    for edition in 10..200 {
        for kind in Kind::ALL {
            perform(&mut flash, Task::Save(kind), edition).unwrap();
        }
        // Taking a content out writes too little for that to be waited for.
        let is_little = matches!(task, Task::Erase(_));
        if is_little || dry_run(&flash, task).1.erasures > 0 {
            return flash;
        }
    }
    panic!("{task:?} erases nothing");
}

fn cut_all<const SECTOR: usize, const WORD: usize>(sectors: usize, tasks: &[Task]) {
    thread::scope(|scope| {
        for task in tasks {
            scope.spawn(move || {
                let cuts = cut_everywhere(&used::<SECTOR, WORD>(sectors, *task), *task);
                println!("{sectors} x {SECTOR}/{WORD}, {task:?}: {cuts:?}");
                assert_eq!(cuts.erasures > 0, cuts.in_repair > 0);
            });
        }
    });
}

#[test]
fn in_a_blank_store() {
    let before = SimFlash::<2048, 8>::new(16);
    let cuts = cut_everywhere(&before, Task::Save(Kind::ScrewTable));
    println!("blank: {cuts:?}");
}

#[test]
fn with_small_sectors() {
    let tasks = [
        Task::Save(Kind::Parameters),
        Task::Save(Kind::EncoderMap),
        Task::Save(Kind::ScrewTable),
        Task::Erase(Kind::EncoderMap),
    ];
    cut_all::<2048, 8>(16, &tasks);
}

#[test]
fn with_few_large_sectors() {
    let tasks = [Task::Save(Kind::EncoderMap), Task::Save(Kind::ScrewTable)];
    cut_all::<16384, 4>(5, &tasks);
}
