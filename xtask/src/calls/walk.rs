//! What can be reached from a function, and by how deep a stack.

use std::collections::BTreeMap;

use super::{Calls, Function};
use crate::Result;

/// What panics, by what its names have in common.
const PANICS: &[&str] = &[
    "panicking",
    "unwrap_failed",
    "expect_failed",
    "rust_begin_unwind",
];

/// Who may call whom through a pointer, and why nobody else; names as of [`is`].
#[derive(Clone, Copy)]
pub struct Through<'a> {
    pub callers: &'a [&'a str],
    pub callees: &'a [&'a str],
    pub reason: &'a str,
}

/// What is a fault.
#[derive(Clone, Copy)]
pub struct Rules<'a> {
    /// Panics, traps, and callers through pointers that are not in the table. Else a panic is where the walk ends, and such
    /// callers may call whatever is not reserved.
    pub is_strict: bool,
    pub through: &'a [Through<'a>],
    /// Functions that only callers in the table may call through pointers.
    pub reserved: &'a [&'a str],
    /// Functions at which the walk ends.
    pub ends: &'a [&'a str],
    /// Functions that call one another through pointers, and nobody else does, by what their names have in common; each may be
    /// on the stack twice.
    pub families: &'a [&'a str],
    /// Functions that call themselves, and how often at most.
    pub repeated: &'a [(&'a str, u32)],
}

/// What can be reached from a function.
#[derive(Debug, PartialEq, Eq)]
pub struct Tree {
    pub functions: usize,
    pub faults: Vec<String>,
    /// Bytes of the deepest way.
    pub stack: u32,
    /// Its functions, each with its own bytes.
    pub deepest: Vec<(String, u32)>,
}

impl Calls {
    /// All that `root` can call.
    ///
    /// # Errors
    /// There is no such function.
    pub fn reachable_from(&self, root: &str, rules: Rules<'_>) -> Result<Tree> {
        let mut named = self.functions.iter();
        let named = named.find(|(_, function)| function.name == root);
        let (&start, _) = named.ok_or_else(|| format!("the image has no function {root}"))?;
        let mut walk = Walk {
            calls: self,
            rules,
            done: BTreeMap::new(),
            of_families: BTreeMap::new(),
            way: Vec::new(),
            faults: Vec::new(),
        };
        let stack = walk.visit(start);
        Ok(Tree {
            functions: walk.done.len(),
            deepest: walk.deepest(start),
            faults: walk.faults,
            stack,
        })
    }
}

struct Walk<'c> {
    calls: &'c Calls,
    rules: Rules<'c>,
    /// The functions that are done with, by their addresses.
    done: BTreeMap<u32, Depth>,
    /// Stack of the families that are done with.
    of_families: BTreeMap<&'c str, u32>,
    way: Vec<u32>,
    faults: Vec<String>,
}

/// Stack of a function and all below it.
#[derive(Clone, Copy)]
struct Depth {
    own: u32,
    whole: u32,
    /// Where the deepest way goes on.
    next: Option<u32>,
}

/// Whether the function is one of them: names begin like this; with a `=` in front they are just this.
fn is(names: &[&str], function: &Function) -> bool {
    names.iter().any(|name| match name.strip_prefix('=') {
        Some(name) => function.name == name,
        None => function.name.starts_with(name),
    })
}

impl<'c> Walk<'c> {
    /// Stack of the function around `address` and all below it, bytes.
    fn visit(&mut self, address: u32) -> u32 {
        let Some((start, function)) = self.calls.around(address) else {
            let fault = format!("{address:#x}: called, and no function is there");
            self.faults.push(fault);
            return 0;
        };
        if let Some(depth) = self.done.get(&start) {
            return depth.whole;
        }
        if self.way.contains(&start) {
            self.accuse(function, "calls itself, so that its stack has no bound");
            return 0;
        }
        if is(self.rules.ends, function) {
            return 0;
        }
        let mut families = self.rules.families.iter();
        if let Some(family) = families.find(|family| function.name.contains(**family)) {
            return self.visit_family(family);
        }
        if PANICS.iter().any(|panic| function.name.contains(panic)) {
            if !self.rules.is_strict {
                return 0;
            }
            self.faults
                .push(format!("{}: reached by {}", function.name, self.told_way()));
        }
        self.look_at(function);
        self.way.push(start);
        let below = self.callees(start, function).into_iter();
        let below = below.map(|callee| (self.visit(callee), callee));
        // One that ends the walk returns none, and is no way to go on.
        let deepest = below.filter(|(stack, _)| *stack > 0).max();
        self.way.pop();
        let own = function.stack * self.times(start, function);
        let depth = Depth {
            own,
            whole: own + deepest.map_or(0, |(stack, _)| stack),
            next: deepest.map(|(_, callee)| callee),
        };
        self.done.insert(start, depth);
        depth.whole
    }

    /// Twice all members, and below them the deepest function that is none.
    fn visit_family(&mut self, family: &'c str) -> u32 {
        if let Some(stack) = self.of_families.get(family) {
            return *stack;
        }
        // One that is come to from below it is the same that is being added up.
        self.of_families.insert(family, 0);
        let functions = &self.calls.functions;
        let members = functions
            .values()
            .filter(|function| function.name.contains(family));
        let (mut all, mut below) = (0, 0);
        for member in members {
            self.look_at(member);
            all += 2 * member.stack;
            for callee in member.calls.iter().chain(&member.jumps) {
                below = below.max(self.visit(*callee));
            }
        }
        self.of_families.insert(family, all + below);
        all + below
    }

    /// Faults of the function itself.
    fn look_at(&mut self, function: &Function) {
        for instruction in &function.unknown_stack {
            self.accuse(function, instruction);
        }
        if self.rules.is_strict {
            for instruction in &function.traps {
                self.accuse(function, instruction);
            }
        }
    }

    fn callees(&mut self, start: u32, function: &Function) -> Vec<u32> {
        let end = self.calls.functions.range(start + 1..).next();
        let inside = start..end.map_or(u32::MAX, |(next, _)| *next);
        let all = function.calls.iter().chain(&function.jumps);
        let mut callees: Vec<u32> = all
            .copied()
            .filter(|callee| !inside.contains(callee))
            .collect();
        if !function.through_pointers.is_empty() {
            callees.extend(self.pointed_to(function));
        }
        callees
    }

    /// What the function can call through pointers.
    fn pointed_to(&mut self, function: &Function) -> Vec<u32> {
        let named = |address: &u32| &self.calls.functions[address];
        let taken = self.calls.taken.iter().copied();
        let mut of_caller = self.rules.through.iter();
        let of_caller = of_caller.find(|through| is(through.callers, function));
        let found: Vec<u32> = match of_caller {
            Some(through) => taken
                .filter(|callee| is(through.callees, named(callee)))
                .collect(),
            None if self.rules.is_strict => Vec::new(),
            None => {
                let families = self.rules.families;
                let is_of_family = |name: &str| families.iter().any(|part| name.contains(part));
                taken
                    .filter(|callee| !is(self.rules.reserved, named(callee)))
                    .filter(|callee| !is_of_family(&named(callee).name))
                    .collect()
            }
        };
        if found.is_empty() {
            let what = match of_caller {
                Some(_) => "calls through pointers nothing that is in the image",
                None => "calls through pointers, and it is not known whom",
            };
            self.accuse(function, what);
        }
        found
    }

    /// How often it may be on the way; more than once is a fault unless told.
    fn times(&mut self, start: u32, function: &Function) -> u32 {
        let end = self.calls.functions.range(start + 1..).next();
        let inside = start..end.map_or(u32::MAX, |(next, _)| *next);
        if !function.calls.iter().any(|callee| inside.contains(callee)) {
            return 1;
        }
        let mut repeated = self.rules.repeated.iter();
        let told = repeated.find(|(name, _)| function.name == *name);
        if told.is_none() {
            self.accuse(function, "calls itself, so that its stack has no bound");
        }
        told.map_or(1, |(_, times)| *times)
    }

    fn accuse(&mut self, function: &Function, what: &str) {
        self.faults.push(format!("{}: {what}", function.name));
    }

    fn told_way(&self) -> String {
        let functions = self.way.iter().map(|start| &self.calls.functions[start]);
        let names: Vec<&str> = functions.map(|function| function.name.as_str()).collect();
        names.join(" > ")
    }

    fn deepest(&self, start: u32) -> Vec<(String, u32)> {
        let mut way = Vec::new();
        let mut next = Some(start);
        while let Some((start, function)) = next.and_then(|next| self.calls.around(next)) {
            let depth = self.done.get(&start);
            way.push((function.name.clone(), depth.map_or(0, |depth| depth.own)));
            next = depth.and_then(|depth| depth.next);
        }
        way
    }
}
