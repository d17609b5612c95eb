//! Which of a file's signals are A, B and Z.

use std::collections::HashSet;
use std::fmt;
use std::hash::Hash;

use super::error::Problem;

/// The channels of a capture to read, each by its exact name or, where no signal has that name, by
/// its zero-based index among the one-bit signals. In a VCD the name is the plain name or the
/// dotted path through the scopes.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct ChannelSelection {
    /// Channel A; by default the first one-bit signal.
    pub a: Option<String>,
    /// Channel B; by default the second one-bit signal.
    pub b: Option<String>,
    /// The index channel; by default none.
    pub z: Option<String>,
}

/// What a channel is to the encoder.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    /// Channel A.
    A,
    /// Channel B.
    B,
    /// The index.
    Z,
}

impl Role {
    pub(super) const ALL: [Role; 3] = [Role::A, Role::B, Role::Z];

    /// The option of the command line that chooses the channel.
    #[must_use]
    pub fn flag(self) -> &'static str {
        match self {
            Role::A => "--a",
            Role::B => "--b",
            Role::Z => "--z",
        }
    }
}

impl fmt::Display for Role {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Role::A => "A",
            Role::B => "B",
            Role::Z => "Z",
        })
    }
}

/// A signal that a file offers.
#[derive(Debug, Clone)]
pub(super) struct Offer<K> {
    /// Full name, through the scopes where the format has them.
    pub path: String,
    /// Plain name.
    pub name: String,
    /// What the reader finds its levels by. Two offers with one key are one signal under two names.
    pub key: K,
    /// Why the signal is no logic level ("is 8 bits wide"); None for a one-bit signal.
    pub obstacle: Option<String>,
}

/// The keys of the channels, by role; Z may be absent.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Chosen<K> {
    keys: [Option<K>; 3],
}

impl<K: Copy + PartialEq> Chosen<K> {
    /// The role of the signal with this key, if it has one.
    pub(super) fn role_of(&self, key: K) -> Option<Role> {
        Role::ALL
            .into_iter()
            .find(|role| self.keys[*role as usize] == Some(key))
    }

    /// The roles that a channel was chosen for.
    pub(super) fn roles(&self) -> impl Iterator<Item = Role> {
        Role::ALL
            .into_iter()
            .filter(|role| self.keys[*role as usize].is_some())
    }
}

/// Chooses the channels out of what the file offers.
pub(super) fn choose<K: Copy + Eq + Hash>(
    selection: &ChannelSelection,
    offers: &[Offer<K>],
) -> Result<Chosen<K>, Problem> {
    let menu = Menu::new(offers);
    if menu.one_bit.len() < 2 {
        return Err(Problem::TooFewChannels {
            found: menu.found(),
        });
    }
    let a = menu.pick_or(Role::A, selection.a.as_deref(), menu.one_bit[0])?;
    let b = menu.pick_or(Role::B, selection.b.as_deref(), menu.one_bit[1])?;
    let z = selection
        .z
        .as_deref()
        .map(|asked| menu.pick(Role::Z, asked))
        .transpose()?;
    refuse_same(Role::A, a, Role::B, Some(b))?;
    refuse_same(Role::A, a, Role::Z, z)?;
    refuse_same(Role::B, b, Role::Z, z)?;
    Ok(Chosen {
        keys: [Some(a.key), Some(b.key), z.map(|offer| offer.key)],
    })
}

fn refuse_same<K: PartialEq>(
    first: Role,
    one: &Offer<K>,
    second: Role,
    other: Option<&Offer<K>>,
) -> Result<(), Problem> {
    match other {
        Some(other) if other.key == one.key => Err(Problem::SameChannel {
            first,
            second,
            name: one.path.clone(),
        }),
        _ => Ok(()),
    }
}

struct Menu<'a, K> {
    offers: &'a [Offer<K>],
    /// Each one-bit signal once, under its first name: what an index counts.
    one_bit: Vec<&'a Offer<K>>,
}

impl<'a, K: Copy + Eq + Hash> Menu<'a, K> {
    fn new(offers: &'a [Offer<K>]) -> Self {
        let mut seen = HashSet::new();
        let one_bit = offers
            .iter()
            .filter(|offer| offer.obstacle.is_none() && seen.insert(offer.key))
            .collect();
        Menu { offers, one_bit }
    }

    fn pick_or(
        &self,
        role: Role,
        asked: Option<&str>,
        default: &'a Offer<K>,
    ) -> Result<&'a Offer<K>, Problem> {
        asked.map_or(Ok(default), |asked| self.pick(role, asked))
    }

    fn pick(&self, role: Role, asked: &str) -> Result<&'a Offer<K>, Problem> {
        if let Some(offer) = self.only(role, asked, |offer| offer.path == asked)? {
            return Ok(offer);
        }
        if let Some(offer) = self.only(role, asked, |offer| offer.name == asked)? {
            return Ok(offer);
        }
        let by_index = asked
            .parse::<usize>()
            .ok()
            .and_then(|index| self.one_bit.get(index));
        by_index.copied().ok_or_else(|| Problem::UnknownChannel {
            role,
            asked: asked.to_owned(),
            available: self.listed(&self.one_bit),
        })
    }

    /// The one signal that fits; None where none does.
    fn only(
        &self,
        role: Role,
        asked: &str,
        fits: impl Fn(&Offer<K>) -> bool,
    ) -> Result<Option<&'a Offer<K>>, Problem> {
        // Not out of `one_bit`: there a signal stands under the first of its names only.
        let fitting: Vec<&Offer<K>> = self.offers.iter().filter(|offer| fits(offer)).collect();
        let is_one_bit = |offer: &&Offer<K>| offer.obstacle.is_none();
        let one_bit: Vec<&Offer<K>> = fitting.iter().copied().filter(is_one_bit).collect();
        let asked = asked.to_owned();
        match (one_bit.first(), fitting.first()) {
            (Some(first), _) if one_bit.iter().all(|offer| offer.key == first.key) => {
                Ok(Some(first))
            }
            (Some(_), _) => {
                let candidates = self.listed(&one_bit);
                Err(Problem::AmbiguousChannel {
                    role,
                    asked,
                    candidates,
                })
            }
            (None, Some(other)) => {
                let obstacle = other.obstacle.clone().unwrap_or_default();
                let available = self.listed(&self.one_bit);
                Err(Problem::NotOneBit {
                    role,
                    asked,
                    obstacle,
                    available,
                })
            }
            (None, None) => Ok(None),
        }
    }

    /// One-bit signals with their indices, for a message.
    fn listed(&self, offers: &[&Offer<K>]) -> String {
        let describe = |offer: &&Offer<K>| {
            let index = self.one_bit.iter().position(|known| known.key == offer.key);
            format!("`{}` (index {})", offer.path, index.unwrap_or_default())
        };
        enumeration(offers.iter().map(describe))
    }

    /// Everything in the file, for the message that there is too little of it.
    fn found(&self) -> String {
        if self.offers.is_empty() {
            return "none".to_owned();
        }
        let describe = |offer: &Offer<K>| match &offer.obstacle {
            Some(obstacle) => format!("`{}` (which {obstacle})", offer.path),
            None => format!("`{}`", offer.path),
        };
        enumeration(self.offers.iter().map(describe))
    }
}

/// A list for a message; a design simulated as a whole has thousands of signals.
fn enumeration(texts: impl ExactSizeIterator<Item = String>) -> String {
    const MOST: usize = 16;
    let rest = texts.len().saturating_sub(MOST);
    let mut list = texts.take(MOST).collect::<Vec<_>>().join(", ");
    if rest > 0 {
        list += &format!(" and {rest} more");
    }
    list
}
