//! Counts the instructions of a function's calls, exceptions that come meanwhile left out.

/// Where the core is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    pub pc: u32,
    /// The link register.
    pub link: u32,
    /// The exception that is handled, 0 for none.
    pub exception: u16,
    /// Priority of what is executed: lower numbers go before.
    pub priority: i32,
}

/// A call under way.
#[derive(Clone, Copy, Debug)]
struct Call {
    exception: u16,
    returns_to: u32,
    instructions: u32,
}

/// The calls of a function.
#[derive(Debug)]
pub struct Calls {
    function: u32,
    open: Option<Call>,
    counts: Vec<u32>,
}

impl Calls {
    /// Of the function at an address, or of an exception's handler.
    pub const fn of(function: u32) -> Self {
        Self {
            function: function & !1,
            open: None,
            counts: Vec::new(),
        }
    }

    /// The core went from one place to the next: by an instruction, or by taking an exception.
    pub fn step(&mut self, before: Place, after: Place) {
        if self.open.is_none() && before.pc == self.function {
            self.open = Some(Call {
                exception: before.exception,
                returns_to: before.link & !1,
                instructions: 0,
            });
        }
        let Some(call) = &mut self.open else {
            return;
        };
        let is_taken = after.exception != before.exception && after.priority < before.priority;
        if before.exception != call.exception || is_taken {
            return;
        }
        call.instructions += 1;
        if after.exception != before.exception || after.pc == call.returns_to {
            self.counts.push(call.instructions);
            self.open = None;
        }
    }

    /// Instructions of each call that returned, the return among them, since they were taken last.
    pub fn take(&mut self) -> Vec<u32> {
        std::mem::take(&mut self.counts)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const THREAD: i32 = 256;

    fn at(pc: u32, exception: u16, priority: i32) -> Place {
        let link = if exception == 0 { 0x101 } else { 0xffff_fff9 };
        Place {
            pc,
            link,
            exception,
            priority,
        }
    }

    fn count(calls: &mut Calls, places: &[Place]) -> Vec<u32> {
        for pair in places.windows(2) {
            calls.step(pair[0], pair[1]);
        }
        calls.take()
    }

    #[test]
    fn a_function_is_counted_to_its_return() {
        let pcs = [0x80, 0x200, 0x202, 0x300, 0x204, 0x100, 0x102];
        let places = pcs.map(|pc| at(pc, 0, THREAD));
        assert_eq!(count(&mut Calls::of(0x201), &places), [4]);
    }

    #[test]
    fn a_handler_is_counted_without_what_interrupts_it() {
        let places = [
            at(0x80, 0, THREAD),
            // Taken.
            at(0x200, 60, 16),
            at(0x202, 60, 16),
            // Another is taken, does two instructions, and returns.
            at(0x400, 43, 0),
            at(0x402, 43, 0),
            at(0x202, 60, 16),
            at(0x204, 60, 16),
            // Returned to what it had interrupted.
            at(0x82, 0, THREAD),
            at(0x84, 0, THREAD),
        ];
        assert_eq!(count(&mut Calls::of(0x200), &places), [3]);
    }

    #[test]
    fn one_handler_after_the_other_is_the_end_of_the_first() {
        let places = [
            at(0x200, 60, 16),
            at(0x202, 60, 16),
            at(0x600, 53, 48),
            at(0x602, 53, 48),
        ];
        assert_eq!(count(&mut Calls::of(0x200), &places), [2]);
    }
}
