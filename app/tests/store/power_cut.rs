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

/// Cuts in how many operations.
#[derive(Clone, Copy, Debug, Default)]
struct Cuts {
    operations: u32,
    erasures: u32,
    old: u32,
    new: u32,
    in_mount: u32,
}

fn cut_everywhere<const SECTOR: usize, const WORD: usize>(
    before: &SimFlash<SECTOR, WORD>,
    task: Task,
) -> Cuts {
    let mut whole = before.powered(None);
    perform(&mut whole, task, 2).unwrap();
    let mut cuts = Cuts {
        operations: whole.operations,
        erasures: whole.erasures.iter().sum::<u32>() - before.erasures.iter().sum::<u32>(),
        ..Cuts::default()
    };
    let old = contents(&mut before.powered(None));
    let new = contents(&mut whole.powered(None));
    assert_ne!(old, new);
    for operation in 0..whole.operations {
        for torn in Torn::ALL {
            let case = format!("{task:?} cut in {operation}, {torn:?}");
            let mut flash = before.powered(Some((operation, torn)));
            let done = perform(&mut flash, task, 2);
            assert!(done.is_err(), "{case}");
            let cut = flash.powered(None);
            let mut flash = cut.powered(None);
            let found = contents(&mut flash);
            assert!(found == old || found == new, "{case}");
            cuts.old += u32::from(found == old);
            cuts.new += u32::from(found == new);
            // Cut again while it is put in order.
            for again in 0..flash.operations {
                let mut flash = cut.powered(Some((again, torn)));
                let end = flash.cells.len() as u32;
                let mount = Store::mount(&mut flash, 0..end, &permission()).err();
                assert!(matches!(mount, Some(Error::Flash(PowerCut))), "{case}");
                let found = contents(&mut flash.powered(None));
                assert!(found == old || found == new, "{case}, then in {again}");
                cuts.in_mount += 1;
            }
            // And it goes on from there.
            let mut flash = flash.powered(None);
            perform(&mut flash, task, 2).unwrap();
            assert_eq!(contents(&mut flash), new, "{case}, and done again");
        }
    }
    cuts
}

/// Stores that were written for a while, so that the save goes over the ends of sectors.
fn used<const SECTOR: usize, const WORD: usize>(
    sectors: usize,
    saves: u32,
) -> SimFlash<SECTOR, WORD> {
    let mut flash = SimFlash::new(sectors);
    for edition in (10..10 + saves).chain([1]) {
        for kind in Kind::ALL {
            perform(&mut flash, Task::Save(kind), edition).unwrap();
        }
    }
    flash
}

fn cut_all<const SECTOR: usize, const WORD: usize>(sectors: usize, saves: u32, tasks: &[Task]) {
    let before = used::<SECTOR, WORD>(sectors, saves);
    thread::scope(|scope| {
        for task in tasks {
            let before = &before;
            scope.spawn(move || {
                let cuts = cut_everywhere(before, *task);
                println!("{SECTOR}/{WORD}, {saves} saves, {task:?}: {cuts:?}");
            });
        }
    });
}

const ALL: [Task; 4] = [
    Task::Save(Kind::Parameters),
    Task::Save(Kind::EncoderMap),
    Task::Save(Kind::ScrewTable),
    Task::Erase(Kind::EncoderMap),
];

#[test]
fn in_a_blank_store() {
    let before = SimFlash::<2048, 8>::new(16);
    let cuts = cut_everywhere(&before, Task::Save(Kind::ScrewTable));
    println!("blank: {cuts:?}");
}

#[test]
fn with_small_sectors() {
    cut_all::<2048, 8>(16, 5, &ALL);
}

#[test]
fn with_few_large_sectors() {
    cut_all::<16384, 4>(5, 4, &ALL);
}
