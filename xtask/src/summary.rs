//! Reads how many tests ran from what the test runners print.

use std::ops::AddAssign;

/// Tests of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tests {
    /// Ran and passed.
    pub passed: u32,
    /// Ran and failed, timed out or broke off.
    pub failed: u32,
}

impl AddAssign for Tests {
    fn add_assign(&mut self, other: Self) {
        self.passed += other.passed;
        self.failed += other.failed;
    }
}

impl Tests {
    /// Sums the closing lines of `cargo test` and `cargo nextest run` in `text`.
    pub fn read(text: &str) -> Self {
        let mut tests = Self::default();
        for line in text.lines() {
            if let Some(of_line) = libtest(line).or_else(|| nextest(line)) {
                tests += of_line;
            }
        }
        tests
    }
}

/// `test result: ok. 4 passed; 0 failed; 5 ignored; 0 measured; …`
fn libtest(line: &str) -> Option<Tests> {
    // nextest shows what a failed test printed, this line too, but indented: it counts that test itself.
    let (_, counts) = line.strip_prefix("test result: ")?.split_once(". ")?;
    Some(sum(counts, ';'))
}

/// `     Summary [   3.9s] 7 tests run: 5 passed (1 slow), 1 failed, 1 timed out, 5 skipped`
fn nextest(line: &str) -> Option<Tests> {
    let line = line.trim().strip_prefix("Summary [")?;
    let (run, counts) = line.split_once("run: ")?;
    run.contains("test").then(|| sum(counts, ','))
}

fn sum(counts: &str, separator: char) -> Tests {
    let mut tests = Tests::default();
    for part in outside_brackets(counts).split(separator) {
        let mut words = part.split_whitespace();
        let Some(number) = words.next().and_then(|word| word.parse::<u32>().ok()) else {
            continue;
        };
        match words.next() {
            Some("passed") => tests.passed += number,
            // "exec failed", "timed out"
            Some("failed" | "exec" | "timed") => tests.failed += number,
            _ => {}
        }
    }
    tests
}

/// "5 passed (1 slow, 1 leaky)": what is in brackets is counted before them.
fn outside_brackets(text: &str) -> String {
    let mut depth = 0_usize;
    text.chars()
        .filter(|character| match character {
            '(' => {
                depth += 1;
                false
            }
            ')' => {
                depth = depth.saturating_sub(1);
                false
            }
            _ => depth == 0,
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tests(passed: u32, failed: u32) -> Tests {
        Tests { passed, failed }
    }

    #[test]
    fn nextest_summaries() {
        for (line, expected) in [
            (
                "     Summary [   0.012s] 4 tests run: 4 passed, 0 skipped",
                tests(4, 0),
            ),
            (
                "     Summary [   1.2s] 1 test run: 1 passed, 12 skipped",
                tests(1, 0),
            ),
            (
                "     Summary [  10.012s] 8 tests run: 7 passed (2 slow, 1 leaky), 1 failed, 3 skipped",
                tests(7, 1),
            ),
            (
                "     Summary [   9.9s] 9/20 tests run: 6 passed, 1 failed, 1 exec failed, 1 timed out, 0 skipped",
                tests(6, 3),
            ),
            (
                "     Summary [   0.000s] 0 tests run: 0 passed, 5 skipped",
                tests(0, 0),
            ),
        ] {
            assert_eq!(Tests::read(line), expected, "{line}");
        }
    }

    #[test]
    fn libtest_results_are_summed_over_binaries() {
        let text = "\
running 2 tests
test result: ok. 2 passed; 0 failed; 5 ignored; 0 measured; 0 filtered out; finished in 0.00s
test result: FAILED. 3 passed; 1 failed; 0 ignored; 0 measured; 0 filtered out; finished in 0.00s
";
        assert_eq!(Tests::read(text), tests(5, 1));
    }

    #[test]
    fn other_lines_count_nothing() {
        let text = "test a::passed ... ok\n    test result: FAILED. 0 passed; 1 failed; 0 ignored;\n5 passed\n        PASS [   0.004s] 3 passed\nSummary [x]\n";
        assert_eq!(Tests::read(text), tests(0, 0));
    }
}
