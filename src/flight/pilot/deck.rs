//! Which manoeuvre comes next.

use super::Manoeuvre;
use crate::base::rng::Sequence;
use rand::seq::SliceRandom;

/// Manoeuvres still to be flown.
#[derive(Debug)]
pub struct Deck {
    /// What every further round holds; nothing where there is none.
    kinds: Vec<Manoeuvre>,
    /// Left of this round, last first.
    left: Vec<Manoeuvre>,
}

impl Deck {
    /// Rounds of `kinds` in random order, without end.
    pub fn rounds(kinds: Vec<Manoeuvre>) -> Self {
        Deck { kinds, left: Vec::new() }
    }

    /// These, in this order, and then no more.
    pub fn once(order: &[Manoeuvre]) -> Self {
        Deck { kinds: Vec::new(), left: order.iter().rev().copied().collect() }
    }

    /// The next one.
    pub fn next(&mut self, rng: &mut Sequence) -> Option<Manoeuvre> {
        if self.left.is_empty() {
            let (mut early, mut late): (Vec<_>, Vec<_>) = self.kinds.iter().partition(|kind| kind.early());
            early.shuffle(rng);
            late.shuffle(rng);
            // Drawn from the end.
            self.left = [late, early].concat();
        }
        self.left.pop()
    }
}
