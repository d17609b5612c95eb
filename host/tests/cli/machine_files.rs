//! Machines as TOML files.

use crate::{Folder, assert_says};

const SHORT: &str = "sim --move-mm 5";

/// The digest of a short run on the machine of a file of that content.
fn digest_of(folder: &Folder, content: &str) -> String {
    folder.write("machine.toml", content);
    digest(folder, "machine.toml")
}

fn digest(folder: &Folder, machine: &str) -> String {
    folder.json(&format!("{SHORT} --machine {machine}"))["digest"].to_string()
}

/// Refuses a file of that content at that line.
#[track_caller]
fn refused(line: u32, content: &str) -> String {
    let folder = Folder::new();
    folder.write("machine.toml", content);
    let message = folder.refused(
        1,
        "sim --machine machine.toml --csv x.csv --plot x.svg --json",
    );
    let place = format!("error: machine.toml:{line}: ");
    assert!(message.starts_with(&place), "{message}");
    assert_eq!(message.trim_end().lines().count(), 1, "{message}");
    message
}

#[test]
fn a_dump_has_a_comment_for_every_key_and_reads_back() {
    let folder = Folder::new();
    for name in ["16k20f3", "16k20f3-bare"] {
        let dump = folder.printed(&format!("sim --machine {name} --dump-machine"));
        let mut comment = "";
        for line in dump.lines() {
            // Unit and range in brackets, such as (s, 0 to 0.1).
            let explained = comment.starts_with("# ") && comment.ends_with(')');
            let explained = explained && comment.contains(" to ") && comment.contains(", ");
            assert!(
                !line.contains(" = ") || line.starts_with("base") || explained,
                "{line}"
            );
            comment = line;
        }
        assert!(dump.contains(&format!("base = \"{name}\"")));
        folder.write("dumped.toml", &dump);
        assert_eq!(
            digest(&folder, "dumped.toml"),
            digest(&folder, name),
            "{name}"
        );
    }
    assert_ne!(digest(&folder, "16k20f3"), digest(&folder, "16k20f3-bare"));
}

#[test]
fn a_dump_of_a_file_has_the_values_of_the_file() {
    let folder = Folder::new();
    let content = "base = \"16k20f3-bare\"\n[drive]\ndamping = 0.625\n";
    let digest_before = digest_of(&folder, content);
    let dump = folder.printed("sim --machine machine.toml --dump-machine");
    assert_says(&dump, &["damping = 0.625\n", "delay_s = 0.0\n"]);
    assert_eq!(digest_of(&folder, &dump), digest_before);
}

#[test]
fn keys_that_are_left_out_are_those_of_the_base() {
    let folder = Folder::new();
    let full = digest(&folder, "16k20f3");
    assert_eq!(digest_of(&folder, ""), full);
    assert_eq!(digest_of(&folder, "base = '16k20f3'"), full);
    assert_eq!(digest_of(&folder, "[drive]\ndamping = 0.5"), full);
    assert_eq!(digest_of(&folder, "[encoder]\n[drive]\n"), full);
    let bare = digest(&folder, "16k20f3-bare");
    assert_eq!(digest_of(&folder, "base = \"16k20f3-bare\""), bare);
    let changed = digest_of(&folder, "base = '16k20f3-bare'\ndrive.damping = 0.6");
    assert!(changed != bare && changed != full);
}

#[test]
fn numbers_are_toml_numbers() {
    let folder = Folder::new();
    let of = |value: &str| digest_of(&folder, &format!("[mount]\ncounts_per_mm = {value}"));
    let expected = of("1000.0");
    for value in ["1000", "1_000", "1e3", "1_0.0e+2", "0x3e8", "+1000"] {
        assert_eq!(of(value), expected, "{value}");
    }
}

#[test]
fn values_out_of_range_name_key_value_range_and_unit() {
    for (value, said) in [
        ("-0.09", "-0.09"),
        ("0", "0"),
        ("1e9", "1000000000"),
        ("nan", "NaN"),
    ] {
        let message = refused(
            3,
            &format!("base = '16k20f3'\n[drive]\nnatural_period_s = {value}\n"),
        );
        assert_says(
            &message,
            &[
                &format!("natural_period_s = {said} is out of range"),
                "0.001 to 10 (s)",
            ],
        );
    }
}

#[test]
fn unknown_words_suggest_the_nearest() {
    let message = refused(2, "[drive]\ndampin = 0.5");
    assert_says(
        &message,
        &["unknown key `dampin` in [drive]", "did you mean `damping`?"],
    );
    let message = refused(2, "[drive]\nfoo = 0.5");
    assert_says(
        &message,
        &[
            "unknown key `foo`",
            "expected one of full_command_feed_mm_per_min,",
        ],
    );
    let message = refused(3, "\n\n[carrige]\npitch_mm = 5");
    assert_says(
        &message,
        &["unknown section [carrige]", "did you mean `carriage`?"],
    );
    let message = refused(1, "[spindle]");
    assert_says(
        &message,
        &["expected one of drive, carriage, mount, disc, encoder"],
    );
    let message = refused(1, "base = \"16k20\"");
    assert_says(&message, &["unknown base `16k20`", "16k20f3, 16k20f3-bare"]);
}

#[test]
fn keys_above_the_sections_are_told_where_they_belong() {
    let message = refused(1, "damping = 0.5");
    assert_says(
        &message,
        &["`damping`", "only `base`", "[drive]", "[encoder]"],
    );
    let message = refused(1, "bas = '16k20f3'");
    assert_says(&message, &["did you mean `base`?"]);
    let message = refused(1, "drive = 5");
    assert_says(&message, &["write [drive] and its keys below"]);
}

#[test]
fn values_of_another_type_say_what_was_expected() {
    for value in ["\"0.5\"", "true", "[0.5]", "{ ratio = 0.5 }", "2026-01-01"] {
        let message = refused(2, &format!("[drive]\ndamping = {value}"));
        assert_says(&message, &["damping must be a number", "0.01 to 10"]);
    }
    let message = refused(1, "base = 5");
    assert_says(&message, &["base must be a name in quotes", "16k20f3-bare"]);
}

#[test]
fn broken_toml_names_the_line() {
    refused(2, "[drive]\ndamping 0.5\n");
    refused(2, "[drive]\ndamping = \n");
    refused(1, "[drive\ndamping = 0.5\n");
    refused(3, "[drive]\ndamping = 0.5\ndamping = 0.6\n");
}

#[test]
fn files_that_cannot_be_read() {
    let folder = Folder::new();
    let message = folder.refused(1, "sim --machine absent.toml --json");
    assert_says(
        &message,
        &["absent.toml", "cannot be read", "check the path"],
    );
    std::fs::create_dir(folder.path("folder.toml")).expect("a folder");
    folder.refused(1, "sim --machine folder.toml");
    folder.write("latin1.toml", b"# \xe9\n[drive]\n");
    let message = folder.refused(1, "sim --machine latin1.toml");
    assert_says(&message, &["latin1.toml", "UTF-8"]);
}

#[test]
fn rules_beside_the_range_name_the_line() {
    let message = refused(2, "[disc]\nedges_per_revolution = 10001");
    assert_says(
        &message,
        &["edges_per_revolution = 10001", "must be a multiple of 4"],
    );
    let message = refused(3, "[mount]\n\nlinear_scale = 0.4");
    assert_says(&message, &["linear_scale = 0.4", "must be 0 or 1"]);
    let folder = Folder::new();
    digest_of(
        &folder,
        "[disc]\nedges_per_revolution = 8192\n[mount]\nlinear_scale = 1",
    );
}

#[test]
fn a_drive_that_no_loop_can_be_tuned_on_says_which_keys_did_it() {
    let folder = Folder::new();
    for (drive, tick_hz) in [
        ("natural_period_s = 10", 1000),
        ("natural_period_s = 1\ndamping = 10", 40_000),
    ] {
        folder.write("slack.toml", format!("[drive]\n{drive}"));
        let message = folder.refused(1, &format!("sim --machine slack.toml --tick-hz {tick_hz}"));
        let at =
            format!("slack.toml: a loop cannot be tuned on this machine's drive at {tick_hz} Hz");
        assert_says(&message, &[&at, "natural_period_s = 1", "damping = "]);
    }
}

#[test]
fn a_machine_too_slow_for_the_feed_says_so() {
    let folder = Folder::new();
    folder.write("slow.toml", "[drive]\nfull_command_feed_mm_per_min = 1000");
    let message = folder.refused(2, "sim --machine slow.toml");
    assert_says(&message, &["--feed 9000", "950 (95 %"]);
    folder.printed("sim --machine slow.toml --feed 950 --move-mm 2");
}
