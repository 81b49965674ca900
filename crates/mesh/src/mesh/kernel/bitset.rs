//! A bitset with summary levels.

use std::ops::Range;

/// A set of places in an array, as bits, quick to change and to read from either end.
///
/// Three layers above the bits say which words below are not empty, 64 bits to one. So an empty set is
/// recognized at once, and iterating over a small set costs no more in a large array than in a small one. The
/// set takes an eighth of a byte for each place.
#[derive(Clone, Debug, Default)]
pub(in crate::mesh) struct Bitset {
    layers: [Vec<u64>; LAYERS],
    count: usize,
    /// No word of bits after this one has any: this makes it cheap to ask for the last place repeatedly.
    last_word: usize,
}

/// Number of layers. With four, the topmost layer has one word for 2²⁴ bits, and is searched word by word.
const LAYERS: usize = 4;

impl Bitset {
    /// Returns how many places are in the set.
    pub(in crate::mesh) fn count(&self) -> usize {
        self.count
    }

    #[inline]
    pub(in crate::mesh) fn contains(&self, place: usize) -> bool {
        self.layers[0].get(place / 64).is_some_and(|word| word >> (place % 64) & 1 == 1)
    }

    /// Adds a place, and returns whether it was new.
    #[inline]
    pub(in crate::mesh) fn insert(&mut self, place: usize) -> bool {
        if place / 64 >= self.layers[0].len() {
            self.make_room(place);
        }
        let word = &mut self.layers[0][place / 64];
        let (before, bit) = (*word, 1 << (place % 64));
        *word |= bit;
        self.last_word = self.last_word.max(place / 64);
        if before == 0 {
            self.note_word(place / 64);
        }
        self.count += usize::from(before & bit == 0);
        before & bit == 0
    }

    #[inline]
    fn note_word(&mut self, mut place: usize) {
        for layer in &mut self.layers[1..] {
            let word = &mut layer[place / 64];
            let before = *word;
            *word |= 1 << (place % 64);
            if before != 0 {
                return;
            }
            place /= 64;
        }
    }

    #[cold]
    fn make_room(&mut self, place: usize) {
        // Doubles, so that growing by one place at a time is cheap.
        let mut words = (place / 64 + 1).max(2 * self.layers[0].len());
        for layer in &mut self.layers {
            layer.resize(words, 0);
            words = words.div_ceil(64);
        }
    }

    /// Takes a place out, and returns whether it was in.
    #[inline]
    pub(in crate::mesh) fn remove(&mut self, place: usize) -> bool {
        let was_in = self.contains(place);
        if was_in {
            self.layers[0][place / 64] &= !(1 << (place % 64));
            self.count -= 1;
            self.forget_empty_word(place / 64);
        }
        was_in
    }

    #[inline]
    fn forget_empty_word(&mut self, mut place: usize) {
        for k in 1..LAYERS {
            if self.layers[k - 1][place] != 0 {
                return;
            }
            self.layers[k][place / 64] &= !(1 << (place % 64));
            place /= 64;
        }
    }

    /// An entry has moved from one place to another: its mark moves with it.
    #[inline]
    pub(in crate::mesh) fn moved(&mut self, from: usize, to: usize) {
        if self.remove(from) {
            self.insert(to);
        } else {
            self.remove(to);
        }
    }

    /// Takes all places from this one on out: the array ends there.
    pub(in crate::mesh) fn truncate(&mut self, end: usize) {
        while let Some(last) = self.last().filter(|&last| last >= end) {
            let word = last / 64;
            // Fewer than 64, because the last place is in this word.
            let kept = self.layers[0][word] & !(u64::MAX << end.saturating_sub(64 * word));
            self.count -= (self.layers[0][word].count_ones() - kept.count_ones()) as usize;
            self.layers[0][word] = kept;
            self.forget_empty_word(word);
        }
    }

    /// Returns the last place of the set.
    #[inline]
    pub(in crate::mesh) fn last(&mut self) -> Option<usize> {
        if self.count == 0 {
            return None;
        }
        if self.layers[0][self.last_word] == 0 {
            self.last_word = self.find_last_word();
        }
        Some(64 * self.last_word + self.layers[0][self.last_word].ilog2() as usize)
    }

    fn find_last_word(&self) -> usize {
        let top = self.layers[LAYERS - 1].iter().rposition(|&word| word != 0);
        let top = top.expect("a place is noted in every layer");
        let last = |word: usize, layer: &Vec<u64>| 64 * word + layer[word].ilog2() as usize;
        self.layers[1..].iter().rev().fold(top, last)
    }

    /// Takes all places out, a word at a time.
    pub(in crate::mesh) fn clear(&mut self) {
        while let Some(last) = self.last() {
            let word = last / 64;
            self.count -= self.layers[0][word].count_ones() as usize;
            self.layers[0][word] = 0;
            self.forget_empty_word(word);
        }
    }

    /// Takes all places out, as ascending ranges that do not touch.
    pub(in crate::mesh) fn take_ranges(&mut self) -> Vec<Range<usize>> {
        let mut ranges: Vec<Range<usize>> = Vec::new();
        while let Some(last) = self.last() {
            let word = last / 64;
            let mut bits = std::mem::take(&mut self.layers[0][word]);
            self.count -= bits.count_ones() as usize;
            self.forget_empty_word(word);
            while bits != 0 {
                let end = 64 - bits.leading_zeros() as usize;
                let length = (bits << (64 - end)).leading_ones() as usize;
                push_before(&mut ranges, 64 * word + end - length..64 * word + end);
                bits &= !(u64::MAX >> (64 - length) << (end - length));
            }
        }
        ranges.reverse();
        ranges
    }

    /// Returns the memory taken, in bytes.
    pub(in crate::mesh) fn bytes(&self) -> usize {
        self.layers.iter().map(|layer| 8 * layer.capacity()).sum()
    }
}

/// Adds a range that ends at or before the start of the last.
fn push_before(ranges: &mut Vec<Range<usize>>, range: Range<usize>) {
    match ranges.last_mut() {
        Some(last) if last.start == range.end => last.start = range.start,
        _ => ranges.push(range),
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn marks_are_a_set() {
        let mut random = fastrand::Rng::with_seed(5);
        for size in [1, 64, 65, 5000, 300_000, 40_000_000] {
            let (mut marks, mut plain) = (Bitset::default(), BTreeSet::new());
            for _ in 0..5000 {
                let near = plain.last().map_or(0, |&p: &usize| p.saturating_sub(random.usize(..70)));
                let place = if random.bool() { near } else { random.usize(..size) };
                match random.u8(..8) {
                    0..4 => assert_eq!(marks.insert(place), plain.insert(place)),
                    4..6 => assert_eq!(marks.remove(place), plain.remove(&place)),
                    6 => assert_eq!(
                        marks.last().map(|last| marks.remove(last)),
                        plain.pop_last().map(|_| true)
                    ),
                    _ if random.bool() => {
                        let to = random.usize(..=place);
                        marks.moved(place, to);
                        let was_in = plain.remove(&place);
                        if was_in {
                            plain.insert(to)
                        } else {
                            plain.remove(&to)
                        };
                    }
                    _ => {
                        marks.truncate(place);
                        plain.split_off(&place);
                    }
                }
                assert_eq!((marks.last(), marks.count()), (plain.last().copied(), plain.len()));
                assert_eq!(marks.contains(place), plain.contains(&place));
            }
            (0..size.min(1000)).for_each(|place| {
                marks.insert(place);
                plain.insert(place);
            });
            let mut copy = marks.clone();
            copy.clear();
            let ranges = marks.take_ranges();
            for mut rest in [copy, marks] {
                assert_eq!((rest.last(), rest.count()), (None, 0));
                assert!(rest.layers.iter().flatten().all(|&word| word == 0));
            }
            assert!(ranges.windows(2).all(|pair| pair[0].end < pair[1].start));
            assert!(ranges.into_iter().flatten().eq(plain));
        }
    }
}
