use super::*;

const GOOD: &str = "\
00000100 <tick>:
     100:      \tpush.w\t{r4, r5, r6, lr}
     104:      \tsub\tsp, #0x18
     106:      \tbl\t0x200 <work> @ imm = #246
     10a:      \tb.w\t0x300 <core::fmt::x<T>+0x4> @ imm = #246
00000200 <work>:
     200:      \tbeq\t0x204 <work+0x4> @ imm = #0
     204:      \tvpush\t{d8, d9}
     206:      \tbx\tlr
00000300 <core::fmt::x<T>>:
     300:      \tldr\tpc, [sp], #8
00000400 <core::panicking::panic>:
     400:      \tudf\t#254
00000500 <leaf>:
     500:      \tpush\t{r4, r5, r6, r7, lr}
00000600 <other>:
     600:      \tpush\t{r4, lr}
     602:      \tsub.w\tsp, sp, #0x1000
";

const STRICT: Rules<'_> = Rules {
    is_strict: true,
    through: &[],
    reserved: &[],
    ends: &[],
    families: &[],
    repeated: &[],
};

fn calls(text: &str) -> Calls {
    Calls::read(text, &[0x501, 0x601, 0x504, 0x700]).unwrap()
}

fn planted(instruction: &str) -> Calls {
    calls(&GOOD.replace(
        "     206:",
        &format!("     208:      \t{instruction}\n     206:"),
    ))
}

fn tree(calls: &Calls, rules: Rules<'_>) -> Tree {
    calls.reachable_from("tick", rules).unwrap()
}

#[test]
fn what_is_not_reached_is_no_fault() {
    let expected = Tree {
        functions: 3,
        faults: Vec::new(),
        stack: 16 + 24 + 16,
        deepest: vec![("tick".to_owned(), 40), ("work".to_owned(), 16)],
    };
    assert_eq!(tree(&calls(GOOD), STRICT), expected);
}

#[test]
fn planted_faults_are_found() {
    for instruction in [
        "bl\t0x400 <core::panicking::panic> @ imm = #1",
        "blne\t0x400 <core::panicking::panic> @ imm = #1",
        "beq.w\t0x400 <core::panicking::panic> @ imm = #1",
        "udf\t#254",
        "blx\tr3",
        "bx\tr3",
        "ldr.w\tpc, [r0, r1, lsl #2]",
        "mov\tpc, r3",
        "sub.w\tsp, sp, r12",
        "bl\t0x100 <tick> @ imm = #1",
        "bl\t0x200 <work> @ imm = #1",
        "bl\t0x20 <before> @ imm = #1",
    ] {
        let tree = tree(&planted(instruction), STRICT);
        assert!(!tree.faults.is_empty(), "{instruction}");
    }
}

#[test]
fn who_is_in_the_table_may_call_what_it_names() {
    let through = [Through {
        callers: &["wo"],
        callees: &["=leaf"],
        reason: "a table",
    }];
    let rules = Rules {
        through: &through,
        ..STRICT
    };
    let tree_of = |instruction| tree(&planted(instruction), rules);
    let found = tree_of("blx\tr3");
    assert_eq!((found.faults.len(), found.stack), (0, 40 + 16 + 20));
    assert_eq!(tree_of("udf\t#254").faults.len(), 1);
    // Names begin so, or are just so; what no address is taken of is no callee.
    for (callees, faults) in [(["=lea"], 1), (["lea"], 0), (["core"], 1)] {
        let through = [Through {
            callees: &callees,
            ..through[0]
        }];
        let rules = Rules {
            through: &through,
            ..STRICT
        };
        let found = tree(&planted("blx\tr3"), rules);
        assert_eq!(found.faults.len(), faults, "{callees:?}");
    }
}

#[test]
fn for_the_stack_alone_a_pointer_goes_anywhere_and_a_panic_nowhere() {
    let lenient = Rules {
        is_strict: false,
        ..STRICT
    };
    let found = tree(&planted("blx\tr3"), lenient);
    assert_eq!((found.faults.len(), found.stack), (0, 40 + 16 + 8 + 0x1000));
    let rules = Rules {
        reserved: &["other"],
        ..lenient
    };
    assert_eq!(tree(&planted("blx\tr3"), rules).stack, 40 + 16 + 20);
    let rules = Rules {
        ends: &["work"],
        ..lenient
    };
    assert_eq!(tree(&planted("blx\tr3"), rules).stack, 40);
    let panic = tree(&planted("bl\t0x400 <core::panicking::panic>"), lenient);
    assert_eq!((panic.faults.len(), panic.stack), (0, 40 + 16));
}

#[test]
fn one_that_calls_itself_takes_its_stack_as_often_as_told() {
    let rules = Rules {
        repeated: &[("work", 3)],
        ..STRICT
    };
    let found = tree(&planted("bl\t0x200 <work>"), rules);
    assert_eq!((found.faults.len(), found.stack), (0, 40 + 3 * 16));
}

#[test]
fn a_family_takes_the_stack_of_all_its_members_twice() {
    let rules = Rules {
        families: &["work", "other"],
        ..STRICT
    };
    let found = tree(&planted("bl\t0x500 <leaf>"), rules);
    assert_eq!((found.faults.len(), found.stack), (0, 40 + 2 * 16 + 20));
}

#[test]
fn a_family_is_called_through_pointers_by_itself_alone() {
    let rules = Rules {
        is_strict: false,
        families: &["other"],
        ..STRICT
    };
    assert_eq!(tree(&planted("blx\tr3"), rules).stack, 40 + 16 + 20);
}

#[test]
fn addresses_are_taken_by_halves_and_from_words_of_the_image() {
    let code = "\
00010400 <tick>:
   10400:      \tmovw\tr1, #0x501
   10404:      \tmovw\tr2, #0x601
   10408:      \tmovt\tr1, #0x1
   1040c:      \tblx\tr1
   1040e: 01 07 01 00  \t.word\t0x00010701
00010500 <a>:
   10500:      \tbx\tlr
00010600 <b>:
   10600:      \tbx\tlr
00010700 <c>:
   10700:      \tbx\tlr
";
    let dump = "Contents of section .rodata:\n 20000000 01040100 00000000 01  ........\n";
    let calls = Calls::read(code, &words(dump)).unwrap();
    let taken: Vec<u32> = calls.taken.into_iter().collect();
    assert_eq!(taken, [0x10400, 0x10500, 0x10700]);
}

#[test]
fn the_filler_behind_a_function_is_no_jump() {
    let filled = |line: &str| {
        let text = GOOD.replace("00000300 <core", &format!("{line}\n\n00000300 <core"));
        tree(&calls(&text), STRICT).faults.len()
    };
    assert_eq!(
        filled("     208:      \tbmi\t0x100 <tick> @ imm = #-0x58"),
        0
    );
    assert_eq!(
        filled("     208:      \tbmi\t0x100 <tick> @ imm = #-0x5a"),
        1
    );
}

#[test]
fn handlers_are_what_the_vectors_have_beside_the_default() {
    let vectors = [0x2000_0000, 0x401, 0x401, 0x401, 0, 0x101, 0x201, 0x401];
    assert_eq!(calls(GOOD).handlers(&vectors), ["tick", "work"]);
}

#[test]
fn names_are_those_of_the_source() {
    let mangled = "_$LT$a..B$LT$F$GT$$u20$as$u20$c..D$GT$::serve::h00112233445566aa";
    assert_eq!(plain(mangled), "<a::B<F> as c::D>::serve");
    assert_eq!(
        plain("a::_$u7b$$u7b$closure$u7d$$u7d$::h00112233445566aa"),
        "a::{{closure}}"
    );
    assert_eq!(plain("TIM1_CC"), "TIM1_CC");
}

#[test]
fn an_image_without_the_tick_is_an_error() {
    let text = GOOD.replace("<tick>:", "<tock>:");
    assert!(calls(&text).reachable_from("tick", STRICT).is_err());
    assert!(Calls::read("", &[]).is_err());
}
